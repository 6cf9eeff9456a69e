//! The page of a picked object, laid out without a window.

#[cfg(all(feature = "toon", feature = "objects"))]
mod page;
#[cfg(feature = "toon")]
mod widgets;

use bevy_egui::egui;

use super::*;
use crate::history::{History, Step, Way};

/// The camera that the panel shows.
const CAMERA: Entity = Entity::PLACEHOLDER;

/// The page, and the world whose objects it edits.
struct Page {
    context: egui::Context,
    world: World,
    objects: Objects,
    history: History,
    presses: u64,
    widgets: Widgets,
}

impl Page {
    fn new() -> Self {
        let context = egui::Context::default();
        // Sections open at once, so that the widgets below them do not move.
        context.all_styles_mut(|style| style.animation_time = 0.0);
        let mut world = World::new();
        world.insert_resource(ComicsInspector::new(true, None));
        Self {
            context,
            world,
            objects: Objects::new(PathBuf::from("shadings")),
            history: History::default(),
            presses: 0,
            widgets: Widgets::default(),
        }
    }

    /// Adds an asset.
    fn add<A: Asset>(&mut self, asset: A) -> Handle<A> {
        self.world
            .get_resource_or_init::<Assets<A>>()
            .into_inner()
            .add(asset)
    }

    fn pick(&mut self, object: Entity) {
        self.world.resource_mut::<ComicsInspector>().picked = Some(object);
        self.show();
    }

    /// Lays the page out twice, as sections take a frame to open.
    fn show(&mut self) {
        self.frame(Vec::new());
        self.frame(Vec::new());
    }

    fn frame(&mut self, events: Vec<egui::Event>) {
        let size = egui::vec2(600.0, 9000.0);
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size)),
            events,
            ..egui::RawInput::default()
        };
        self.widgets = Widgets::default();
        let _ = self.context.clone().run_ui(input, |ui| {
            ui.spacing_mut().slider_width = 200.0;
            if ui.input(|input| input.pointer.any_pressed()) {
                self.presses += 1;
            }
            let pressed = ui.input(|input| input.pointer.any_down());
            let gesture = pressed.then_some(self.presses);
            for before in self.objects.show(ui, &mut self.world, &mut self.widgets) {
                self.history.record(Step::Object(before), CAMERA, gesture);
            }
        });
    }

    fn has(&self, widget: &str) -> bool {
        self.widgets.rects.contains_key(widget)
    }

    /// A place at a fraction of a widget's width.
    fn place(&self, widget: &str, fraction: f32) -> egui::Pos2 {
        let [left, top, right, bottom] = *self
            .widgets
            .rects
            .get(widget)
            .unwrap_or_else(|| panic!("{widget} has no widget"));
        egui::pos2(left + fraction * (right - left), 0.5 * (top + bottom))
    }

    fn button(&mut self, pos: egui::Pos2, pressed: bool) {
        self.frame(vec![egui::Event::PointerButton {
            pos,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        }]);
    }

    fn click(&mut self, widget: &str) {
        let pos = self.place(widget, 0.5);
        self.frame(vec![egui::Event::PointerMoved(pos)]);
        self.button(pos, true);
        self.button(pos, false);
        self.show();
    }

    /// Drags from one fraction of a widget's width to another one, in ten steps.
    fn drag(&mut self, widget: &str, from: f32, to: f32) {
        let [from, to] = [from, to].map(|fraction| self.place(widget, fraction));
        self.frame(vec![egui::Event::PointerMoved(from)]);
        self.button(from, true);
        for i in 1..=10 {
            let at = from + (to - from) * (i as f32 / 10.0);
            self.frame(vec![egui::Event::PointerMoved(at)]);
        }
        self.button(to, false);
        self.show();
    }

    fn take(&mut self, way: Way) -> bool {
        let world = &mut self.world;
        let taken = self.history.take(way, CAMERA, |step| match step {
            Step::Object(value) => value.exchange(world).map(Step::Object),
            Step::Style(..) => None,
        });
        self.show();
        taken
    }
}

#[test]
fn an_object_has_the_name_of_the_nearest_one() {
    let mut world = World::new();
    let root = world.spawn(Name::new("Hero")).id();
    let part = world.spawn(ChildOf(root)).id();
    let lone = world.spawn_empty().id();
    assert_eq!(name_of(&world, root), "Hero");
    assert_eq!(name_of(&world, part), format!("Hero, part {part}"));
    assert_eq!(name_of(&world, lone), format!("Object {lone}"));
}

#[test]
fn nothing_is_shown_of_what_is_not_picked() {
    let mut page = Page::new();
    page.show();
    assert!(page.widgets.rects.is_empty());
    let gone = page.world.spawn_empty().id();
    page.pick(gone);
    assert!(page.has("object.name"));
    page.world.despawn(gone);
    page.show();
    assert!(page.widgets.rects.is_empty());
    let object = page.world.spawn_empty().id();
    page.pick(object);
    page.click("object.deselect");
    assert_eq!(page.world.resource::<ComicsInspector>().picked, None);
}
