//! Cameras that draw over the picture of another camera.

use bevy::{
    camera::{
        Camera3dDepthLoadOp, CameraOutputMode, CameraUpdateSystems, Exposure, Hdr, RenderTarget,
        visibility::RenderLayers,
    },
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    prelude::*,
    render::{render_resource::BlendState, view::ColorGrading},
};

/// The settings of a camera that draws over the finished picture of the cameras before it, and may
/// have a style of its own: for view models and inspected items.
///
/// The camera clears its picture to transparent, and blends it over the target in the end. Its
/// effects change only what it has drawn, by the opacity of each pixel: multisampled rims, blended
/// meshes and particles included. Materials with [`AlphaMode::Multiply`] and transmission do not
/// see the picture below. Bevy's depth of field and its other effects on the whole picture make it opaque.
///
/// With [`Camera3dDepthLoadOp::Load`] on its `Camera3d`, the geometry of the camera before hides what this
/// one draws.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_comics::{cameras::overlay_camera, prelude::*};
/// fn spawn_view_model(mut commands: Commands) {
///     commands.spawn((Camera3d::default(), overlay_camera(1), Outlines::default()));
/// }
/// ```
#[must_use]
pub fn overlay_camera(order: isize) -> Camera {
    Camera {
        order,
        clear_color: Color::NONE.into(),
        msaa_writeback: MsaaWriteback::Off,
        output_mode: CameraOutputMode::Write {
            blend_state: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            clear_color: ClearColorConfig::None,
        },
        ..Camera::default()
    }
}

/// On a camera with effects: entities of these layers are drawn over its comic without any effect, hidden by
/// its geometry. For gizmos, markers and particles.
///
/// A child of the camera draws them: an [`overlay_camera`] with the next order and the same
/// projection, viewport, target, exposure, color grading, tonemapping, `Hdr` and `Msaa`. It is
/// despawned when the component is removed. What is drawn has to be in these layers, and not in
/// those of the camera itself: for gizmos, by `GizmoConfig::render_layers`.
///
/// A query for a single camera then matches two: give the game's own camera a marker component.
/// Bevy UI is drawn by the camera of the highest order, unless one has `IsDefaultUiCamera`.
///
/// Default: layer 1.
#[derive(Component, Reflect, Clone, Debug, PartialEq, Eq)]
#[require(Camera3d)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct ComicOverlay(pub RenderLayers);

impl Default for ComicOverlay {
    fn default() -> Self {
        Self(RenderLayers::layer(1))
    }
}

/// On the camera that draws what a [`ComicOverlay`] names.
#[derive(Component)]
struct OverlayOf(Entity);

/// What an overlay has in common with its camera.
type Copied<'w> = (
    &'w Camera,
    Ref<'w, Projection>,
    Ref<'w, RenderTarget>,
    &'w Msaa,
    Option<&'w Hdr>,
    (Option<&'w Tonemapping>, Option<&'w DebandDither>),
    (Option<Ref<'w, Exposure>>, Option<Ref<'w, ColorGrading>>),
);

fn spawn_overlays(
    mut commands: Commands,
    comics: Query<(Entity, &ComicOverlay)>,
    overlays: Query<&OverlayOf>,
) {
    for (camera, layers) in &comics {
        if overlays.iter().any(|overlay| overlay.0 == camera) {
            continue;
        }
        let depth = Camera3d {
            depth_load_op: Camera3dDepthLoadOp::Load,
            ..Camera3d::default()
        };
        let settings = (overlay_camera(0), depth, layers.0.clone());
        commands.spawn((
            OverlayOf(camera),
            ChildOf(camera),
            Transform::IDENTITY,
            settings,
        ));
    }
}

fn update_overlays(
    mut commands: Commands,
    comics: Query<(Copied, &ComicOverlay), Without<OverlayOf>>,
    mut overlays: Query<
        (
            Entity,
            Ref<OverlayOf>,
            (&mut Camera, &mut Projection, &mut RenderTarget),
            (&mut Msaa, &mut RenderLayers, Option<&Hdr>),
            (&mut Tonemapping, &mut DebandDither),
            (&mut Exposure, &mut ColorGrading),
        ),
        With<OverlayOf>,
    >,
) {
    for (entity, of, (mut camera, mut projection, mut target), copies, mut color, light) in
        &mut overlays
    {
        let (mut exposure, mut grading) = light;
        let (mut msaa, mut layers, hdr) = copies;
        let Ok((copied, overlay)) = comics.get(of.0) else {
            commands.entity(entity).despawn();
            continue;
        };
        let (own, own_projection, own_target, own_msaa, own_hdr, own_color, own_light) = copied;
        let (tonemapping, dither) = own_color;
        let (own_exposure, own_grading) = own_light;
        camera.order = own.order.saturating_add(1);
        camera.is_active = own.is_active;
        camera.viewport.clone_from(&own.viewport);
        camera.sub_camera_view.clone_from(&own.sub_camera_view);
        camera.invert_culling = own.invert_culling;
        if own_projection.is_changed() || of.is_added() {
            projection.clone_from(&own_projection);
        }
        if own_target.is_changed() || of.is_added() {
            target.clone_from(&own_target);
        }
        if let Some(own) = own_exposure.filter(|own| own.is_changed() || of.is_added()) {
            *exposure = *own;
        }
        if let Some(own) = own_grading.filter(|own| own.is_changed() || of.is_added()) {
            grading.clone_from(&own);
        }
        msaa.set_if_neq(*own_msaa);
        layers.set_if_neq(overlay.0.clone());
        color.0.set_if_neq(tonemapping.copied().unwrap_or_default());
        color.1.set_if_neq(dither.copied().unwrap_or_default());
        let mut entity = commands.entity(entity);
        if hdr.is_some() != own_hdr.is_some() {
            match own_hdr {
                Some(hdr) => entity.insert(*hdr),
                None => entity.remove::<Hdr>(),
            };
        }
    }
}

fn remove_overlay(
    removed: On<Remove, ComicOverlay>,
    mut commands: Commands,
    overlays: Query<(Entity, &OverlayOf)>,
) {
    for (entity, of) in &overlays {
        if of.0 == removed.entity {
            commands.entity(entity).try_despawn();
        }
    }
}

pub(super) fn build(app: &mut App) {
    app.register_type::<ComicOverlay>()
        .add_observer(remove_overlay)
        .add_systems(
            PostUpdate,
            (spawn_overlays, update_overlays)
                .chain()
                .before(CameraUpdateSystems)
                .before(TransformSystems::Propagate),
        );
}
