//! A panel to tune styles while the game runs: every setting of every effect,
//! style files, presets, debug views, times, and screenshots.
//!
//! The panel is drawn by its own camera, above everything else and after every
//! effect. The camera exists only while the panel is open: a closed panel is not
//! drawn, laid out or timed.

#![warn(missing_docs)]

mod camera;
mod clipboard;
mod cost;
mod fields;
mod files;
#[cfg(test)]
mod fuzz;
#[cfg_attr(
    not(all(feature = "toon", feature = "objects")),
    allow(
        dead_code,
        reason = "only these features have something to edit of an object"
    )
)]
mod history;
mod hue_wheel;
mod layer_borders;
mod memory;
#[cfg_attr(
    not(all(feature = "toon", feature = "objects")),
    allow(
        dead_code,
        reason = "only these features have something to edit of an object"
    )
)]
mod objects;
mod panel;
mod photo;
mod presets;
mod rust_code;
mod search;
mod stash;
pub mod timing;
mod toolkit;
mod tooltip;
mod views;

use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use bevy::{
    ecs::message::MessageCursor,
    input::{InputPlugin, InputSystems, keyboard::KeyboardInput},
    platform::collections::HashMap,
    prelude::*,
    render::{Render, RenderApp, RenderSystems, render_resource::PipelineCache},
    window::PrimaryWindow,
};
use bevy_egui::{EguiPostUpdateSet, egui};

use bevy_comics::{ComicsPlugin, effect::EffectRegistry};
use camera::window_size;
use panel::Panel;
pub use rust_code::rust_code;
use timing::PassTimesPlugin;

/// Adds the inspector: a key opens a panel in the primary window.
///
/// ```no_run
/// use bevy::prelude::*;
/// use bevy_comics::prelude::*;
/// use bevy_comics_inspector::ComicsInspectorPlugin;
///
/// App::new()
///     .add_plugins((DefaultPlugins, ComicsPlugin, ComicsInspectorPlugin::default()))
///     .run();
/// ```
///
/// The order of the plugins does not matter. If the app lacks something that the
/// panel needs (`ComicsPlugin`, a renderer, windows, input), an error in the log
/// names it when the app starts, and there is no panel.
///
/// # A game that uses `bevy_egui`
///
/// The panel is drawn with `bevy_egui`. A game with its own egui windows adds
/// `EguiPlugin` itself, before or after this plugin, and its windows work as
/// without the panel. If no plugin of the app adds `EguiPlugin`, this one does so
/// when all plugins are built (in [`Plugin::finish`]); it then turns
/// `EguiGlobalSettings::auto_create_primary_context` off, unless the game has
/// systems in the schedule `EguiPrimaryContextPass` or has inserted
/// `EguiGlobalSettings`. So a closed panel costs no egui pass.
///
/// A plugin that expects `EguiPlugin` while it is built itself, such as one with
/// `assert!(app.is_plugin_added::<EguiPlugin>())`, needs
/// `app.add_plugins(EguiPlugin::default())` before it.
#[derive(Clone, Debug)]
pub struct ComicsInspectorPlugin {
    /// The key that opens and closes the panel. While text is typed into the
    /// panel, a key that types a character does not close it. Default: F10.
    pub toggle: KeyCode,
    /// Folder in which `*.comic.ron` files are listed and saved. Default:
    /// `assets/styles` in the working directory.
    pub styles: PathBuf,
    /// Folder in which the lights of materials are saved as `*.toon.ron` files. Default:
    /// `assets/shading` in the working directory.
    pub shadings: PathBuf,
    /// Folder for screenshots. Default: `screenshots` in the working directory.
    pub pictures: PathBuf,
    /// File that stores the panel's place, page and sizes from one run to the
    /// next; `None` stores nothing. Default: `bevy_comics/inspector.ron` in the
    /// user's configuration directory.
    pub memory: Option<PathBuf>,
}

impl Default for ComicsInspectorPlugin {
    fn default() -> Self {
        Self {
            toggle: KeyCode::F10,
            styles: PathBuf::from("assets/styles"),
            shadings: PathBuf::from("assets/shading"),
            pictures: PathBuf::from("screenshots"),
            memory: dirs::config_dir().map(|dir| dir.join("bevy_comics").join("inspector.ron")),
        }
    }
}

/// The state of the inspector, for the game to read and to set.
#[derive(Resource, Debug)]
pub struct ComicsInspector {
    /// Whether the panel is open. Set it to open or close the panel.
    pub open: bool,
    /// The key that opens and closes the panel; `None` leaves that to the game.
    pub toggle: Option<KeyCode>,
    /// The camera whose style is shown. If `None` or despawned, the first 3D
    /// camera.
    pub camera: Option<Entity>,
    /// Whether the next press of the primary button in a view picks the object there, as
    /// after the button Pick. A press on the sky picks nothing. Ends with the press, or with
    /// Escape.
    pub picking: bool,
    /// The picked object: an entity with a mesh. The page Object shows its light, its lines and
    /// its sections, and the panel draws a box around it. A game may set it.
    pub picked: Option<Entity>,
    /// Whether the pointer is over the panel, drags one of its widgets, or picks an object. A
    /// game that turns its camera with the mouse does not do so while this is set.
    pub wants_pointer: bool,
    /// Whether a widget of the panel has the keyboard focus.
    pub wants_keyboard: bool,
    /// The rectangles of the panel's widgets in the last frame, in logical pixels
    /// of the window (left, top, right, bottom), by name: for tests and
    /// tutorials. Settings are named by their path in
    /// [`ComicStyle`](bevy_comics::ComicStyle), such as `contours.width`.
    pub widgets: HashMap<String, [f32; 4]>,
    /// Name of the widget that has the keyboard focus.
    pub focused: Option<String>,
}

impl ComicsInspector {
    fn new(open: bool, toggle: Option<KeyCode>) -> Self {
        Self {
            open,
            toggle,
            camera: None,
            picking: false,
            picked: None,
            wants_pointer: false,
            wants_keyboard: false,
            widgets: HashMap::default(),
            focused: None,
        }
    }
}

/// The widgets of a frame.
#[derive(Default)]
struct Widgets {
    rects: HashMap<String, [f32; 4]>,
    focused: Option<String>,
}

/// Publishes a widget's rectangle and focus under a name.
fn note(widgets: &mut Widgets, name: impl Into<String>, response: &egui::Response) {
    let name = name.into();
    if response.has_focus() {
        widgets.focused = Some(name.clone());
    }
    // A widget that gets the focus by keyboard may be scrolled out of view.
    if response.gained_focus() && !response.ctx.input(|input| input.pointer.any_down()) {
        response.scroll_to_me(None);
    }
    // The panel's points differ from the window's logical pixels when its text
    // is zoomed.
    let zoom = response.ctx.zoom_factor();
    let rect = response.rect * zoom;
    widgets
        .rects
        .insert(name, [rect.min.x, rect.min.y, rect.max.x, rect.max.y]);
}

/// A camera of the inspector itself, which it does not list.
#[derive(Component)]
struct Helper;

impl Plugin for ComicsInspectorPlugin {
    fn build(&self, app: &mut App) {
        // The registry is shared with `ComicsPlugin`, whichever comes first.
        let registry = app
            .world_mut()
            .get_resource_or_init::<EffectRegistry>()
            .clone();
        app.insert_resource(ComicsInspector::new(false, Some(self.toggle)))
            .insert_resource(Panel::new(self, &registry));
    }

    /// Every other plugin is built by now, whatever their order.
    fn finish(&self, app: &mut App) {
        if let Some(missing) = missing(app) {
            error!("there is no comics panel: {missing}");
            return;
        }
        toolkit::add(app);
        if !app.is_plugin_added::<PassTimesPlugin>() {
            app.add_plugins(PassTimesPlugin);
        }
        app.add_systems(
            PreUpdate,
            (
                toggle.after(InputSystems),
                claim_pointer.after(InputSystems),
                take_pictures,
            ),
        )
        .add_systems(
            PostUpdate,
            (camera::show_or_hide, camera::run_panel.run_if(is_open))
                .chain()
                .in_set(EguiPostUpdateSet::EndPass),
        );
        let busy = PipelinesBusy::default();
        app.insert_resource(busy.clone());
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app
                .insert_resource(busy)
                .add_systems(Render, watch_pipelines.in_set(RenderSystems::Cleanup));
        }
    }

    fn cleanup(&self, app: &mut App) {
        toolkit::finish(app);
    }
}

/// What the app lacks for the panel, and how to add it.
fn missing(app: &App) -> Option<&'static str> {
    if !app.is_plugin_added::<ComicsPlugin>() {
        return Some(
            "ComicsInspectorPlugin needs ComicsPlugin; use \
             app.add_plugins((DefaultPlugins, ComicsPlugin, ComicsInspectorPlugin::default()))",
        );
    }
    let has_renderer =
        app.get_sub_app(RenderApp).is_some() && app.world().contains_resource::<Assets<Shader>>();
    if !has_renderer {
        return Some("the app has no renderer; add bevy's RenderPlugin, or DefaultPlugins");
    }
    if !app.is_plugin_added::<WindowPlugin>() || !app.is_plugin_added::<InputPlugin>() {
        return Some("the app has no windows or no input; add bevy's WindowPlugin and InputPlugin");
    }
    None
}

/// Whether the renderer compiles any pipeline. A camera with another target needs
/// pipelines of the engine's own, and its picture is black until they are there.
/// Shared by both worlds.
#[derive(Resource, Clone, Default)]
struct PipelinesBusy(Arc<AtomicBool>);

impl PipelinesBusy {
    fn get(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

fn watch_pipelines(cache: Res<PipelineCache>, busy: Res<PipelinesBusy>) {
    let waiting = cache.waiting_pipelines().next().is_some();
    busy.0.store(waiting, Ordering::Relaxed);
}

fn is_open(inspector: Res<ComicsInspector>) -> bool {
    inspector.open
}

fn toggle(
    keys: Option<Res<ButtonInput<KeyCode>>>,
    presses: Option<Res<Messages<KeyboardInput>>>,
    mut read: Local<MessageCursor<KeyboardInput>>,
    panel: Res<Panel>,
    mut inspector: ResMut<ComicsInspector>,
) {
    let (Some(keys), Some(presses)) = (keys, presses) else {
        return;
    };
    let Some(key) = inspector.toggle else {
        return;
    };
    let types_text = |press: &KeyboardInput| {
        press.key_code == key
            && press
                .text
                .as_ref()
                .is_some_and(|text| !text.chars().any(char::is_control))
    };
    let types_text = read
        .read(&presses)
        .filter(|press| types_text(press))
        .count()
        > 0;
    if keys.just_pressed(key) && !(types_text && panel.is_typing()) {
        inspector.open = !inspector.open;
    }
}

/// Claims the pointer before the game's systems run: the pointer input of this
/// frame, such as a turn of the wheel, belongs to what is under the pointer now.
fn claim_pointer(
    mut inspector: ResMut<ComicsInspector>,
    panel: Res<Panel>,
    window: Query<&Window, With<PrimaryWindow>>,
) {
    let Some(pointer) = window.single().ok().and_then(Window::cursor_position) else {
        return;
    };
    let over = inspector.open && (panel.covers(pointer) || inspector.picking);
    if over && !inspector.wants_pointer {
        inspector.wants_pointer = true;
    }
}

fn take_pictures(world: &mut World) {
    world.resource_scope(|world, mut panel: Mut<Panel>| panel.take_pictures(world));
}

/// The code of the panel's page, compiled as doctests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/inspector.md")]
struct Page;
