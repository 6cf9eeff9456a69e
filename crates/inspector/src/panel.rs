//! The panel: its state, its frame, and how its changes reach the cameras.

mod header;
mod pages;
mod picking;
mod search_field;
mod toolbar;

use std::path::PathBuf;

use bevy::{ecs::entity::EntityHashMap, prelude::*, reflect::TypeRegistry};
use bevy_egui::egui::{self, Align2, Color32, ScrollArea, Ui, UiBuilder};

use self::{
    header::{cameras, chosen_camera},
    picking::show_picked,
    search_field::SearchField,
};
use super::{
    ComicsInspector, ComicsInspectorPlugin, Widgets,
    clipboard::Clipboard,
    cost::Costs,
    fields,
    files::{Files, on_camera},
    history::{History, Step},
    memory::{Dock, Memory, Tab},
    note,
    objects::Objects,
    photo::Photo,
    presets::Presets,
    stash::Stash,
    views,
};
use bevy_comics::{
    ComicStyle, StyleTransition, StyleWeight, diagnostics::DebugView, effect::EffectRegistry,
};

/// The panel's state of one camera.
#[derive(Default)]
struct CameraState {
    stash: Stash,
    /// The one of the two styles A and B that is not shown.
    other: Option<ComicStyle>,
    /// Whether style B is shown.
    shows_b: bool,
    /// The game's own weight while the original is shown.
    weight_before: Option<Option<StyleWeight>>,
}

/// The panel's state.
#[derive(Resource)]
pub struct Panel {
    memory: Memory,
    memory_path: Option<PathBuf>,
    cameras: EntityHashMap<CameraState>,
    /// The steps of all cameras and of all objects.
    history: History,
    objects: Objects,
    files: Files,
    presets: Presets,
    costs: Costs,
    photo: Photo,
    clipboard: Clipboard,
    /// The types of the settings, once all effects are registered.
    types: Option<TypeRegistry>,
    search: SearchField,
    /// Whether a text field has the focus.
    is_typing: bool,
    /// Cameras that the panel may have given a debug view.
    debugged: Vec<Entity>,
    message: Option<Message>,
    /// The panel's rectangle in the last frame, in logical pixels of the window.
    place: Option<egui::Rect>,
    /// Number of presses of the pointer: all changes of one press are one step of
    /// the history.
    presses: u64,
    /// Whether the press that picked an object has not ended yet.
    holds_pointer: bool,
}

/// The result of the last action.
enum Message {
    Done(&'static str),
    Failed(String),
}

impl Panel {
    pub fn new(plugin: &ComicsInspectorPlugin, registry: &EffectRegistry) -> Self {
        Self {
            memory: Memory::load(plugin.memory.as_deref()),
            memory_path: plugin.memory.clone(),
            cameras: EntityHashMap::default(),
            history: History::default(),
            objects: Objects::new(plugin.shadings.clone()),
            files: Files::new(plugin.styles.clone(), registry.clone()),
            presets: Presets::new(registry.clone()),
            costs: Costs::default(),
            photo: Photo::new(plugin.pictures.clone()),
            clipboard: Clipboard::default(),
            types: None,
            search: SearchField::default(),
            is_typing: false,
            debugged: Vec::new(),
            message: None,
            place: None,
            presses: 0,
            holds_pointer: false,
        }
    }

    /// Whether the panel covers a position in the window, in logical pixels.
    pub fn covers(&self, at: Vec2) -> bool {
        self.place
            .is_some_and(|place| place.contains(egui::pos2(at.x, at.y)))
    }

    /// Whether a text field of the panel has the focus.
    pub fn is_typing(&self) -> bool {
        self.is_typing
    }

    pub fn set_typing(&mut self, is_typing: bool) {
        self.is_typing = is_typing;
    }

    /// Whether the pointer belongs to the panel until it is released.
    pub fn holds_pointer(&self) -> bool {
        self.holds_pointer
    }

    /// Scale of the panel relative to the window's scale factor.
    pub fn zoom(&self) -> f32 {
        self.memory.zoom
    }

    /// Removes from the cameras what only an open panel needs.
    pub fn close(&mut self, world: &mut World) {
        if let Some(path) = &self.memory_path {
            self.memory.save(path);
        }
        let cameras: Vec<Entity> = self.cameras.keys().copied().collect();
        for camera in cameras {
            self.show_original(world, camera, false);
        }
        views::leave(world);
        let shown: Vec<Entity> = self.debugged.drain(..).collect();
        for camera in shown {
            if let Ok(mut camera) = world.get_entity_mut(camera) {
                camera.remove::<DebugView>();
            }
        }
        self.costs.close(world);
        self.presets.close(world);
        self.message = None;
        self.place = None;
        self.is_typing = false;
        self.holds_pointer = false;
    }

    /// Runs before the engine reads the cameras' targets, so that it sees a
    /// changed target in the same frame.
    pub fn take_pictures(&mut self, world: &mut World) {
        self.photo.step(world);
    }

    /// Draws the panel and applies what was done with it.
    pub fn show(&mut self, ui: &mut Ui, world: &mut World) {
        let mut widgets = Widgets::default();
        let before = self.memory.clone();
        self.memory.zoom = ui.ctx().zoom_factor();
        set_toolkit_options(ui);
        if ui.input(|input| input.pointer.any_pressed()) {
            self.presses += 1;
        }
        self.place = None;
        // While a screenshot is taken, the cameras do not draw to the window.
        if !self.photo.is_under_way() {
            show_picked(ui, world, &mut widgets);
            let place = if self.memory.dock == Dock::Floating {
                self.show_window(ui, world, &mut widgets)
            } else {
                Some(self.show_docked(ui, world, &mut widgets))
            };
            self.place = place.map(|place| place * ui.ctx().zoom_factor());
            if let Some(place) = self.place {
                let [left, top] = [place.min.x, place.min.y];
                widgets
                    .rects
                    .insert("panel".into(), [left, top, place.max.x, place.max.y]);
            }
            self.pick(ui, world);
        }
        if self.memory != before
            && !ui.input(|input| input.pointer.any_down())
            && let Some(path) = &self.memory_path
        {
            self.memory.save(path);
        }
        self.presets.step(world);
        let mut inspector = world.resource_mut::<ComicsInspector>();
        inspector.widgets = widgets.rects;
        inspector.focused = widgets.focused;
    }

    /// The panel as a window that can be moved; its rectangle.
    fn show_window(
        &mut self,
        ui: &Ui,
        world: &mut World,
        widgets: &mut Widgets,
    ) -> Option<egui::Rect> {
        let shown = egui::Window::new("Comics")
            .id(egui::Id::new("comics_inspector"))
            .default_width(self.memory.width)
            .default_height(560.0)
            .pivot(Align2::LEFT_TOP)
            .default_pos([16.0, 16.0])
            .show(ui.ctx(), |ui| {
                in_given_room(ui, |ui| self.contents(ui, world, widgets));
            });
        shown.map(|shown| shown.response.rect)
    }

    /// The panel at the left or right edge of the window; its rectangle.
    fn show_docked(&mut self, ui: &mut Ui, world: &mut World, widgets: &mut Widgets) -> egui::Rect {
        let panel = if self.memory.dock == Dock::Left {
            egui::Panel::left("comics_inspector_left")
        } else {
            egui::Panel::right("comics_inspector_right")
        };
        let frame = egui::Frame::side_top_panel(ui.style()).inner_margin(8.0);
        let shown = panel
            .frame(frame)
            .resizable(true)
            .default_size(self.memory.width)
            .min_size(240.0)
            .show_inside(ui, |ui| {
                in_given_room(ui, |ui| self.contents(ui, world, widgets));
            });
        self.memory.width = shown.response.rect.width().round();
        shown.response.rect
    }

    fn contents(&mut self, ui: &mut Ui, world: &mut World, widgets: &mut Widgets) {
        let cameras = cameras(world);
        let exists = |camera: Entity| cameras.iter().any(|(c, _)| *c == camera);
        self.cameras.retain(|camera, _| exists(*camera));
        self.history.keep_cameras(exists);
        let mut camera = chosen_camera(world, &cameras);

        self.head(ui, world, &cameras, &mut camera, widgets);
        ui.separator();
        let Some(camera) = camera else {
            ui.label("There is no 3D camera to style.");
            return;
        };
        world.resource_mut::<ComicsInspector>().camera = Some(camera);

        let registry = world.resource::<EffectRegistry>().clone();
        let mut before = ComicStyle::of(world.entity(camera), &registry);
        let mut style = before.clone();
        if self.toolbar(ui, world, camera, &mut style, widgets) {
            // Undo and redo are not recorded as new steps.
            before = style.clone();
        }
        if let Some(message) = &self.message {
            let shown = match message {
                Message::Done(text) => ui.label(*text),
                Message::Failed(text) => fields::error(ui, text),
            };
            note(widgets, "message", &shown);
        }
        ui.separator();
        if self.memory.tab == Tab::Style {
            self.search.show(ui, widgets);
        }
        ScrollArea::vertical()
            .auto_shrink([false, false])
            .id_salt(self.memory.tab.name())
            .show(ui, |ui| {
                ui.spacing_mut().slider_width = (ui.available_width() - 240.0).clamp(60.0, 400.0);
                self.page(ui, world, camera, &mut style, widgets);
            });
        self.leave_other_pages(world);
        if let Some(preset) = self.presets.chosen.take() {
            // The transition goes on if the panel is closed.
            let after = on_camera(&preset, &before);
            self.record(camera, before.clone(), &after, None);
            self.files.forget(camera);
            let fade = StyleTransition::to(preset, self.memory.fade);
            world.entity_mut(camera).insert(fade);
            return;
        }
        if let Some(reloaded) = self.files.watch(camera, &style) {
            style = reloaded;
        }
        self.change(ui, world, camera, before, style);
    }

    /// Puts a changed style on its camera, as a step of the history.
    fn change(
        &mut self,
        ui: &Ui,
        world: &mut World,
        camera: Entity,
        before: ComicStyle,
        style: ComicStyle,
    ) {
        let style = style.sanitized();
        // Values that the game has set out of range are not a change by the panel.
        if style == before.sanitized() {
            return;
        }
        let gesture = self.gesture(ui);
        self.record(camera, before, &style, gesture);
        put(world, camera, &style);
    }

    /// Records a step of the history, and the settings of what it turns off.
    fn record(
        &mut self,
        camera: Entity,
        before: ComicStyle,
        after: &ComicStyle,
        gesture: Option<u64>,
    ) {
        let state = self.cameras.entry(camera).or_default();
        state.stash.keep(&before, after);
        let step = Step::Style(camera, before);
        self.history.record(step, camera, gesture);
        self.message = None;
    }

    /// What all changes while the pointer is pressed have in common.
    fn gesture(&self, ui: &Ui) -> Option<u64> {
        let pressed = ui.input(|input| input.pointer.any_down());
        pressed.then_some(self.presses)
    }
}

/// Draws contents that do not change the size of what they are in: a row that is too wide is cut
/// off, and the width stays what the user chose.
fn in_given_room(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let room = ui.available_rect_before_wrap();
    let mut inside = ui.new_child(UiBuilder::new().max_rect(room));
    inside.shrink_clip_rect(room.expand(ui.visuals().clip_rect_margin));
    contents(&mut inside);
    ui.advance_cursor_after_rect(room);
}

/// The toolkit's options that differ from its defaults.
fn set_toolkit_options(ui: &Ui) {
    ui.ctx().all_styles_mut(|style| {
        // Rows come and go with their settings; the toolkit takes that for a
        // mistake in debug builds.
        style.debug.warn_if_rect_changes_id = false;
        if style.visuals.dark_mode {
            // The default colors have too little contrast on the dark panel.
            style.visuals.weak_text_color = Some(Color32::from_gray(145));
            style.visuals.error_fg_color = Color32::from_rgb(255, 128, 110);
            style.visuals.disabled_alpha = 0.65;
        }
    });
    // A click in a frame that takes a second is still a click.
    ui.ctx()
        .options_mut(|options| options.input_options.max_click_duration = f64::INFINITY);
}

/// Puts a style on a camera and ends its transition, if one is running.
fn put(world: &mut World, camera: Entity, style: &ComicStyle) {
    let mut commands = world.commands();
    let mut camera = commands.entity(camera);
    camera.remove::<StyleTransition>();
    style.edit(&mut camera);
    world.flush();
}
