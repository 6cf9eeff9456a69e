//! The camera that draws the panel, and the panel's part of a frame.

use bevy::{
    camera::{CameraOutputMode, RenderTarget, visibility::RenderLayers},
    prelude::*,
    render::render_resource::BlendState,
    window::{PrimaryWindow, WindowRef},
};
use bevy_egui::{EguiContext, EguiContextSettings, EguiFullOutput, EguiInput, EguiOutput, egui};

use super::{ComicsInspector, Helper, panel::Panel, toolkit};

/// The camera that draws the panel, and nothing else.
#[derive(Component)]
pub struct PanelCamera;

/// Spawns the panel's camera when the panel opens, and despawns it when the panel
/// closes.
pub fn show_or_hide(world: &mut World, mut had_camera: Local<bool>) {
    let open = world.resource::<ComicsInspector>().open;
    let camera = world
        .query_filtered::<Entity, With<PanelCamera>>()
        .iter(world)
        .next();
    let has_chosen_camera = toolkit::has_chosen_camera(world, &mut had_camera);
    match (open, camera) {
        (true, None) => match window_size(world) {
            Some((_, scale)) if has_chosen_camera => show(world, scale),
            Some(_) => {}
            None => error_once!(
                "the comics panel cannot be shown: it needs a primary window \
                 (WindowPlugin::primary_window)"
            ),
        },
        (false, Some(camera)) => {
            world.despawn(camera);
            world.resource_scope(|world, mut panel: Mut<Panel>| panel.close(world));
            let mut inspector = world.resource_mut::<ComicsInspector>();
            inspector.picking = false;
            inspector.wants_pointer = false;
            inspector.wants_keyboard = false;
            inspector.widgets.clear();
            inspector.focused = None;
        }
        _ => {}
    }
}

/// Spawns the panel's camera; `scale` is physical pixels per logical pixel.
fn show(world: &mut World, scale: f32) {
    let zoom = world.resource::<Panel>().zoom();
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
            clear_color: ClearColorConfig::Custom(Color::NONE),
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
        // The scale of the first layout.
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

/// Lays the panel out and applies what was done with it.
pub fn run_panel(world: &mut World) {
    let mut cameras = world.query_filtered::<(
        &mut EguiContext,
        &mut EguiInput,
        &EguiOutput,
        &mut EguiFullOutput,
    ), With<PanelCamera>>();
    let Ok((mut context, mut input, output, mut full)) = cameras.single_mut(world) else {
        return;
    };
    // The toolkit learns the window of a new camera a frame later.
    let knows_its_window = input.screen_rect.is_some()
        && input
            .viewports
            .get(&egui::ViewportId::ROOT)
            .is_some_and(|viewport| viewport.native_pixels_per_point.is_some());
    let context = context.get_mut().clone();
    if !knows_its_window {
        // The toolkit expects the output of a pass in every frame.
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
    let mut panel = world.resource_mut::<Panel>();
    panel.set_typing(context.text_edit_focused());
    let holds = panel.holds_pointer();
    let mut inspector = world.resource_mut::<ComicsInspector>();
    let picks = inspector.picking || holds;
    inspector.wants_pointer = context.egui_wants_pointer_input() || picks;
    inspector.wants_keyboard = context.egui_wants_keyboard_input();
}

/// The primary window's size in physical pixels and its scale factor.
pub fn window_size(world: &mut World) -> Option<(UVec2, f32)> {
    world
        .query_filtered::<&Window, With<PrimaryWindow>>()
        .single(world)
        .ok()
        .map(|window| (window.physical_size(), window.scale_factor()))
}
