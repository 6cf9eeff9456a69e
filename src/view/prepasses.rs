//! Gives cameras the prepasses that their plans read, and takes back what it gave
//! when nothing needs it any more.

use std::marker::PhantomData;

use bevy::{
    camera::Camera3d,
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    ecs::{
        component::{Component, ComponentId, Components},
        lifecycle::Insert,
        observer::On,
        query::With,
        system::{Commands, EntityCommands, Query, Res},
        world::EntityRef,
    },
};

use super::CameraPlan;
use crate::{diagnostics::ComicsDiagnostics, effect::Plan};

/// On a camera: this crate has put the prepass `P` there.
#[derive(Component)]
pub(super) struct OwnPrepass<P: Component> {
    /// The number of the first plan in a row that does not read it.
    unread_since: Option<u64>,
    prepass: PhantomData<fn() -> P>,
}

/// A prepass that the game inserts itself is the game's from then on.
pub(super) fn give_up_claims<P: Component>(
    inserted: On<Insert, P>,
    owned: Query<(), With<OwnPrepass<P>>>,
    mut commands: Commands,
) {
    // This crate's own claim comes after the prepass, so it is not seen here.
    if owned.contains(inserted.entity) {
        commands.entity(inserted.entity).remove::<OwnPrepass<P>>();
    }
}

pub(super) fn request_prepasses(
    mut commands: Commands,
    cameras: Query<EntityRef, With<Camera3d>>,
    components: &Components,
    diagnostics: Res<ComicsDiagnostics>,
) {
    for camera in &cameras {
        let drawn = diagnostics
            .cameras
            .get(&camera.id())
            .and_then(|stages| stages.drawn);
        let mut commands = commands.entity(camera.id());
        let request = Request {
            camera,
            components,
            drawn,
        };
        request.handle::<DepthPrepass>(Plan::needs_depth, &mut commands);
        request.handle::<NormalPrepass>(Plan::needs_normals, &mut commands);
    }
}

struct Request<'a> {
    camera: EntityRef<'a>,
    components: &'a Components,
    /// The newest plan that is known to be drawn as it was asked for.
    drawn: Option<u64>,
}

impl Request<'_> {
    fn handle<P: Component + Default>(
        &self,
        reads: fn(&Plan) -> bool,
        commands: &mut EntityCommands,
    ) {
        let plan = self.camera.get::<CameraPlan>();
        let own = self.camera.get::<OwnPrepass<P>>();
        let claim = |unread_since| OwnPrepass::<P> {
            unread_since,
            prepass: PhantomData,
        };
        let Some(plan) = plan else {
            // Nothing is drawn, so nothing reads it.
            if own.is_some() && !self.is_required::<P>() {
                commands.remove::<(P, OwnPrepass<P>)>();
            }
            return;
        };
        let is_read = reads(&plan.plan);
        match (own, is_read) {
            (_, true) if !self.camera.contains::<P>() => {
                // A claim that is there when the prepass comes would be given up.
                commands.remove::<OwnPrepass<P>>();
                commands.insert(P::default());
                commands.insert(claim(None));
            }
            (Some(own), true) if own.unread_since.is_some() => {
                commands.insert(claim(None));
            }
            (Some(own), false) => match own.unread_since {
                None => {
                    commands.insert(claim(Some(plan.number)));
                }
                // While a pipeline compiles, an older plan is drawn that may
                // read it.
                Some(since) if self.drawn >= Some(since) && !self.is_required::<P>() => {
                    commands.remove::<(P, OwnPrepass<P>)>();
                }
                Some(_) => {}
            },
            _ => {}
        }
    }

    /// Whether a component of the camera requires the prepass `P`.
    fn is_required<P: Component>(&self) -> bool {
        let Some(prepass) = self.components.component_id::<P>() else {
            return false;
        };
        let requires = |id: ComponentId| {
            self.components.get_info(id).is_some_and(|info| {
                let mut required = info.required_components().iter_ids();
                required.any(|required| required == prepass)
            })
        };
        self.camera
            .archetype()
            .components()
            .iter()
            .any(|id| requires(*id))
    }
}
