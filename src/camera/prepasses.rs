//! Adds to cameras the prepasses that their plans read, and removes those that it
//! added once nothing reads them.

use std::marker::PhantomData;

use bevy::{
    camera::RenderTarget,
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    ecs::{
        component::{ComponentId, Components},
        entity::EntityHashSet,
    },
    platform::collections::HashMap,
    prelude::*,
    render::render_resource::TextureUsages,
    window::PrimaryWindow,
};

use super::CameraPlan;
use crate::{composite::BeyondPrepass, diagnostics::ComicsDiagnostics, fused::Plan};

/// On a camera: a claim that this crate added the prepass `P`.
#[derive(Component)]
pub(super) struct OwnPrepass<P: Component> {
    /// Number of the plan since which no plan has read the prepass; `None` if the
    /// current plan reads it.
    unread_since: Option<u64>,
    prepass: PhantomData<fn() -> P>,
}

/// Removes the claim when the game inserts the prepass itself: this crate then never
/// removes it.
pub(super) fn give_up_claims<P: Component>(
    inserted: On<Insert, P>,
    owned: Query<(), With<OwnPrepass<P>>>,
    mut commands: Commands,
) {
    // This crate inserts its claim after the prepass, so its own insertion of the
    // prepass does not get here.
    if owned.contains(inserted.entity) {
        commands.entity(inserted.entity).remove::<OwnPrepass<P>>();
    }
}

/// Whether a camera has a prepass that this crate did not add.
fn is_given<P: Component>(camera: EntityRef) -> bool {
    camera.contains::<P>() && !camera.contains::<OwnPrepass<P>>()
}

/// Cameras that can have no prepass of this crate. The engine has one prepass for all cameras of a
/// target, with the samples of one of them, and its renderer fails where another one has other
/// samples.
fn refused(
    cameras: &Query<EntityRef, With<Camera3d>>,
    primary_window: Option<Entity>,
) -> EntityHashSet {
    let mut sharing: Vec<_> = cameras
        .iter()
        .filter_map(|camera| {
            let has = camera.contains::<DepthPrepass>() || camera.contains::<NormalPrepass>();
            let wanted = camera.get::<CameraPlan>();
            let is_wanted =
                wanted.is_some_and(|own| own.plan.needs_depth() || own.plan.needs_normals());
            let settings = camera.get::<Camera>()?;
            let target = camera.get::<RenderTarget>()?.normalize(primary_window)?;
            let msaa = camera.get::<Msaa>()?;
            // Those that the game has given prepasses come first.
            let is_given = is_given::<DepthPrepass>(camera) || is_given::<NormalPrepass>(camera);
            let key = (!is_given, settings.order, camera.id());
            (settings.is_active && (has || is_wanted)).then_some((key, target, *msaa))
        })
        .collect();
    sharing.sort_by_key(|(key, ..)| *key);
    let mut samples = HashMap::<_, Msaa>::default();
    let mut refused = EntityHashSet::default();
    for ((.., camera), target, msaa) in sharing {
        if *samples.entry(target).or_insert(msaa) != msaa {
            refused.insert(camera);
        }
    }
    refused
}

/// Whether the prepasses of a camera cannot be read: wgpu 29 binds no multisampled textures with
/// OpenGL.
fn is_unreadable(camera: EntityRef) -> bool {
    let plan = camera.get::<CameraPlan>();
    let lacks = plan.is_some_and(|own| own.plan.lacks.depth_copies && own.plan.needs_depth());
    lacks && camera.get::<Msaa>().is_some_and(|msaa| *msaa != Msaa::Off)
}

pub(super) fn request_prepasses(
    mut commands: Commands,
    cameras: Query<EntityRef, With<Camera3d>>,
    primary_window: Query<Entity, With<PrimaryWindow>>,
    components: &Components,
    diagnostics: Res<ComicsDiagnostics>,
) {
    let refused = refused(&cameras, primary_window.single().ok());
    if !refused.is_empty() {
        warn_once!(
            "a camera shares its target with another one of other samples (`Msaa`): the engine cannot give \
             both a prepass, so that one is drawn without lines and without effects by depth"
        );
    }
    let multisampled = cameras.iter().any(is_unreadable);
    if multisampled {
        warn_once!(
            "wgpu cannot read multisampled textures with OpenGL: a camera is drawn without lines and without \
             effects by depth; give it `Msaa::Off`"
        );
    }
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
            is_refused: refused.contains(&camera.id()) || is_unreadable(camera),
        };
        request.handle::<DepthPrepass>(Plan::needs_depth, &mut commands);
        request.handle::<NormalPrepass>(Plan::needs_normals, &mut commands);
    }
}

/// Some effects read the depth that the engine draws with; with OpenGL, all do.
pub(super) fn read_drawn_depth(mut cameras: Query<(&CameraPlan, &mut Camera3d)>) {
    for (plan, mut camera) in &mut cameras {
        let usage = TextureUsages::from(camera.depth_texture_usages);
        let wanted = usage | TextureUsages::TEXTURE_BINDING;
        let reads = plan.plan.lacks.depth_copies || plan.plan.beyond != BeyondPrepass::Styled;
        if reads && usage != wanted {
            camera.depth_texture_usages = wanted.into();
        }
    }
}

struct Request<'a> {
    camera: EntityRef<'a>,
    components: &'a Components,
    /// Number of the newest plan that the render world is known to draw.
    drawn: Option<u64>,
    /// Whether it can have no prepass.
    is_refused: bool,
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
        let Some(plan) = plan.filter(|_| !self.is_refused) else {
            // The camera draws no effects, or none with a prepass.
            if own.is_some() && !self.is_required::<P>() {
                commands.remove::<(P, OwnPrepass<P>)>();
            }
            return;
        };
        let is_read = reads(&plan.plan);
        match (own, is_read) {
            (_, true) if !self.camera.contains::<P>() => {
                // `give_up_claims` would remove a claim that is older than the prepass.
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
                // While a pipeline compiles, an older plan is drawn, which may read
                // the prepass. Wait until this one is drawn.
                Some(since) if self.drawn >= Some(since) && !self.is_required::<P>() => {
                    commands.remove::<(P, OwnPrepass<P>)>();
                }
                Some(_) => {}
            },
            _ => {}
        }
    }

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
