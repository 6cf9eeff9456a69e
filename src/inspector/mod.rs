//! A panel to tune a comic while the game runs: every setting of every effect,
//! style files, presets, what the styles are made of, what they cost, pictures.
//!
//! The panel is drawn by a camera of its own, above everything and after every
//! style, which exists only while the panel is open. Closed, nothing of it is
//! drawn, laid out or timed.

mod clipboard;
mod cost;
mod fields;
mod files;
mod history;
mod hue_wheel;
mod known;
mod memory;
mod panel;
mod photo;
mod presets;
mod views;

use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use bevy::{
    app::{App, Plugin, PostUpdate, PreUpdate},
    camera::{
        Camera, Camera2d, CameraOutputMode, ClearColorConfig, RenderTarget,
        visibility::RenderLayers,
    },
    ecs::{
        component::Component,
        entity::Entity,
        name::Name,
        query::With,
        resource::Resource,
        schedule::IntoScheduleConfigs,
        system::{Query, Res, ResMut},
        world::{Mut, World},
    },
    input::{ButtonInput, InputSystems, keyboard::KeyCode},
    platform::collections::HashMap,
    render::{
        Render, RenderApp, RenderSystems,
        render_resource::{BlendState, PipelineCache},
        view::Msaa,
    },
    window::{PrimaryWindow, Window, WindowRef},
};
use bevy_egui::{
    EguiContext, EguiContextSettings, EguiFullOutput, EguiGlobalSettings, EguiInput, EguiOutput,
    EguiPlugin, EguiPostUpdateSet, egui,
};

use crate::{EffectRegistry, timing::PassTimesPlugin};
use panel::Panel;

/// Adds the inspector: a key opens a panel in the primary window.
///
/// The app needs `bevy_winit`'s window and the keyboard. The panel uses
/// `bevy_egui`, which is added where the game has not done so.
///
/// ```no_run
/// use bevy::prelude::*;
/// use bevy_comics::{inspector::ComicsInspectorPlugin, prelude::*};
///
/// App::new()
///     .add_plugins((DefaultPlugins, ComicsPlugin, ComicsInspectorPlugin::default()))
///     .run();
/// ```
#[derive(Clone, Debug)]
pub struct ComicsInspectorPlugin {
    /// The key that opens and closes the panel. Default: F10.
    pub toggle: KeyCode,
    /// Where `*.comic.ron` files are listed and saved. Default: `assets/styles`
    /// under the working folder.
    pub styles: PathBuf,
    /// Where pictures are put. Default: `screenshots` under the working folder.
    pub pictures: PathBuf,
    /// The file in which the panel remembers where it stands. `None` remembers
    /// nothing. Default: `bevy_comics/inspector.ron` in the user's folder of
    /// settings.
    pub memory: Option<PathBuf>,
}

impl Default for ComicsInspectorPlugin {
    fn default() -> Self {
        Self {
            toggle: KeyCode::F10,
            styles: PathBuf::from("assets/styles"),
            pictures: PathBuf::from("screenshots"),
            memory: dirs::config_dir().map(|dir| dir.join("bevy_comics").join("inspector.ron")),
        }
    }
}

/// The inspector, for the game.
#[derive(Resource, Debug)]
pub struct ComicsInspector {
    /// Whether the panel is there: set it to open or close it.
    pub open: bool,
    /// The key that opens and closes it; `None` leaves that to the game.
    pub toggle: Option<KeyCode>,
    /// The camera whose style is shown; the first one where it is `None` or
    /// gone.
    pub camera: Option<Entity>,
    /// Whether the pointer is over the panel, or held by it: a game that turns
    /// its camera with the mouse asks this first.
    pub wants_pointer: bool,
    /// Whether the panel takes what is typed.
    pub wants_keyboard: bool,
    /// Where the panel's widgets were drawn in the last frame, in logical
    /// points of the window (left, top, right, bottom), by name: what a test
    /// or a tutorial points at. Settings are named by their path in
    /// [`ComicStyle`](crate::ComicStyle), such as `contours.width`.
    pub widgets: HashMap<String, [f32; 4]>,
    /// The widget that has the keyboard's focus, by the same names.
    pub focused: Option<String>,
}

/// What is known of the widgets of a frame.
#[derive(Default)]
struct Widgets {
    rects: HashMap<String, [f32; 4]>,
    focused: Option<String>,
}

/// Remembers a widget by its name.
fn note(widgets: &mut Widgets, name: impl Into<String>, response: &egui::Response) {
    let name = name.into();
    if response.has_focus() {
        widgets.focused = Some(name.clone());
    }
    // Whoever comes with the keyboard sees where he is.
    if response.gained_focus() && !response.ctx.input(|input| input.pointer.any_down()) {
        response.scroll_to_me(None);
    }
    // Parts of the panel's own points, which are larger or smaller than the
    // window's when the text is zoomed.
    let zoom = response.ctx.zoom_factor();
    let rect = response.rect * zoom;
    widgets
        .rects
        .insert(name, [rect.min.x, rect.min.y, rect.max.x, rect.max.y]);
}

/// The camera that draws the panel, and nothing else.
#[derive(Component)]
struct PanelCamera;

/// A camera of the inspector itself, which it does not list.
#[derive(Component)]
struct Helper;

impl Plugin for ComicsInspectorPlugin {
    fn build(&self, app: &mut App) {
        if !app.is_plugin_added::<EguiPlugin>() {
            app.add_plugins(EguiPlugin::default());
            if let Some(mut settings) = app.world_mut().get_resource_mut::<EguiGlobalSettings>() {
                settings.auto_create_primary_context = false;
            }
        }
        // One list for both, whichever plugin comes first.
        let registry = app
            .world_mut()
            .get_resource_or_init::<EffectRegistry>()
            .clone();
        app.add_plugins(PassTimesPlugin)
            .insert_resource(ComicsInspector {
                open: false,
                toggle: Some(self.toggle),
                camera: None,
                wants_pointer: false,
                wants_keyboard: false,
                widgets: HashMap::default(),
                focused: None,
            })
            .insert_resource(Panel::new(self, &registry))
            .add_systems(
                PreUpdate,
                (
                    toggle.after(InputSystems),
                    point.after(InputSystems),
                    take_pictures,
                ),
            )
            .add_systems(
                PostUpdate,
                (show_or_hide, run_panel.run_if(is_open))
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
}

/// Whether any pipeline of the whole renderer is still on its way: a camera with
/// another target needs the engine's anew, and its picture is black until then.
/// Both worlds hold it.
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

fn toggle(keys: Option<Res<ButtonInput<KeyCode>>>, mut inspector: ResMut<ComicsInspector>) {
    if let (Some(keys), Some(key)) = (keys, inspector.toggle)
        && keys.just_pressed(key)
    {
        inspector.open = !inspector.open;
    }
}

/// The game is asked before the panel is: what came with this frame's pointer,
/// a turn of the wheel say, belongs to whoever lies under it now.
fn point(
    mut inspector: ResMut<ComicsInspector>,
    panel: Res<Panel>,
    window: Query<&Window, With<PrimaryWindow>>,
) {
    let Some(pointer) = window.single().ok().and_then(Window::cursor_position) else {
        return;
    };
    let over = inspector.open && panel.covers(pointer);
    if over && !inspector.wants_pointer {
        inspector.wants_pointer = true;
    }
}

/// The panel's camera is there exactly while the panel is open.
fn show_or_hide(world: &mut World) {
    let open = world.resource::<ComicsInspector>().open;
    let camera = world
        .query_filtered::<Entity, With<PanelCamera>>()
        .iter(world)
        .next();
    match (open, camera) {
        (true, None) => {
            let zoom = world.resource::<Panel>().zoom();
            let scale = window_size(world).map_or(1.0, |(_, scale)| scale);
            let mut context = EguiContext::default();
            context.get_mut().set_zoom_factor(zoom);
            world.spawn((
                Name::new("comics inspector"),
                PanelCamera,
                Helper,
                Camera2d,
                Camera {
                    // After whatever the game draws in this window.
                    order: isize::MAX / 2,
                    clear_color: ClearColorConfig::Custom(bevy::color::Color::NONE),
                    output_mode: CameraOutputMode::Write {
                        blend_state: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                        clear_color: ClearColorConfig::None,
                    },
                    ..Camera::default()
                },
                RenderTarget::Window(WindowRef::Primary),
                Msaa::Off,
                RenderLayers::none(),
                context,
                // What the first layout is measured with.
                EguiOutput {
                    pixels_per_point: scale * zoom,
                    ..EguiOutput::default()
                },
                EguiContextSettings {
                    run_manually: true,
                    ..EguiContextSettings::default()
                },
            ));
        }
        (false, Some(camera)) => {
            world.despawn(camera);
            world.resource_scope(|world, mut panel: Mut<Panel>| panel.close(world));
            let mut inspector = world.resource_mut::<ComicsInspector>();
            inspector.wants_pointer = false;
            inspector.wants_keyboard = false;
            inspector.widgets.clear();
            inspector.focused = None;
        }
        _ => {}
    }
}

fn take_pictures(world: &mut World) {
    world.resource_scope(|world, mut panel: Mut<Panel>| panel.take_pictures(world));
}

/// Lays the panel out and acts on what was done with it.
fn run_panel(world: &mut World) {
    let mut cameras = world.query_filtered::<(
        &mut EguiContext,
        &mut EguiInput,
        &EguiOutput,
        &mut EguiFullOutput,
    ), With<PanelCamera>>();
    let Ok((mut context, mut input, output, mut full)) = cameras.single_mut(world) else {
        return;
    };
    // A camera that has just come does not know its window yet.
    let knows_its_window = input.screen_rect.is_some()
        && input
            .viewports
            .get(&egui::ViewportId::ROOT)
            .is_some_and(|viewport| viewport.native_pixels_per_point.is_some());
    let context = context.get_mut().clone();
    if !knows_its_window {
        // The toolkit wants a pass in every frame: one without anything in it.
        let mut nothing = egui::RawInput::default();
        nothing
            .viewports
            .entry(egui::ViewportId::ROOT)
            .or_default()
            .native_pixels_per_point = Some(output.pixels_per_point / context.zoom_factor());
        **full = Some(context.run_ui(nothing, |_| {}));
        return;
    }
    let input = input.take();
    let output = world.resource_scope(|world, mut panel: Mut<Panel>| {
        context.run_ui(input, |ui| panel.show(ui, world))
    });
    let mut outputs = world.query_filtered::<&mut EguiFullOutput, With<PanelCamera>>();
    if let Ok(mut full) = outputs.single_mut(world) {
        **full = Some(output);
    }
    let mut inspector = world.resource_mut::<ComicsInspector>();
    inspector.wants_pointer = context.egui_wants_pointer_input();
    inspector.wants_keyboard = context.egui_wants_keyboard_input();
}

/// The primary window's size in physical pixels and its scale factor.
fn window_size(world: &mut World) -> Option<(bevy::math::UVec2, f32)> {
    world
        .query_filtered::<&Window, With<PrimaryWindow>>()
        .single(world)
        .ok()
        .map(|window| (window.physical_size(), window.scale_factor()))
}
