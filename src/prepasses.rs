//! What cameras get so that their styles can be drawn, and what is said of those
//! that cannot have any.

use bevy::{
    camera::{Camera2d, Camera3d, RenderTarget},
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    ecs::{
        component::Component,
        entity::Entity,
        query::{Has, Or, With},
        system::{Commands, Query},
    },
    log::warn_once,
};

use crate::view::{AnyComics, ComicsComponents, Plan};

/// Marks a depth prepass that this crate asked for and takes away again.
#[derive(Component)]
pub(crate) struct OwnDepthPrepass;

/// Marks a normal prepass that this crate asked for and takes away again.
#[derive(Component)]
pub(crate) struct OwnNormalPrepass;

/// Gives cameras the prepasses that their styles read, and no longer.
pub(crate) fn request_prepasses(
    mut commands: Commands,
    styled: Query<
        (
            Entity,
            ComicsComponents,
            (Has<DepthPrepass>, Has<OwnDepthPrepass>),
            (Has<NormalPrepass>, Has<OwnNormalPrepass>),
        ),
        (
            With<Camera3d>,
            Or<(AnyComics, With<OwnDepthPrepass>, With<OwnNormalPrepass>)>,
        ),
    >,
) {
    for (camera, components, (has_depth, own_depth), (has_normals, own_normals)) in &styled {
        let plan = Plan::new(&components, false);
        let mut camera = commands.entity(camera);
        match (plan.needs_depth(), has_depth) {
            (true, false) => {
                camera.insert((DepthPrepass, OwnDepthPrepass));
            }
            (false, _) if own_depth => {
                camera.remove::<(DepthPrepass, OwnDepthPrepass)>();
            }
            _ => {}
        }
        match (plan.needs_normals(), has_normals) {
            (true, false) => {
                camera.insert((NormalPrepass, OwnNormalPrepass));
            }
            (false, _) if own_normals => {
                camera.remove::<(NormalPrepass, OwnNormalPrepass)>();
            }
            _ => {}
        }
    }
}

/// Says once what will not work, instead of doing nothing in silence.
pub(crate) fn warn_unsupported(
    flat: Query<Entity, (With<Camera2d>, AnyComics)>,
    targets: Query<(Entity, &RenderTarget), (With<Camera3d>, AnyComics)>,
) {
    if let Some(camera) = flat.iter().next() {
        warn_once!("{camera} is a Camera2d: comics styles need a Camera3d and leave it alone");
    }
    for (camera, target) in &targets {
        if matches!(target, RenderTarget::None { .. }) {
            warn_once!("{camera} has no colour target: comics styles leave it alone");
        }
    }
}
