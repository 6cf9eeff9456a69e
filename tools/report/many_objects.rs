//! How the time of a frame grows with the number of objects.
//!
//! The picture is small, so that pixels cost little. Times are wall times of whole frames, until
//! the device is done, and of stages of the render schedule on the CPU.

use std::time::Instant;

use bevy::{
    camera::RenderTarget,
    core_pipeline::{
        prepass::{DepthPrepass, NormalPrepass, Opaque3dPrepass, ViewPrepassTextures},
        schedule::{Core3d, Core3dSystems},
    },
    prelude::*,
    render::{
        Render, RenderApp, RenderSystems,
        extract_component::{ExtractComponent, ExtractComponentPlugin},
        render_phase::ViewBinnedRenderPhases,
        render_resource::{RenderPassDescriptor, StoreOp},
        renderer::{RenderContext, ViewQuery},
        view::{ExtractedView, ViewDepthTexture},
    },
};
use bevy_comics::{
    ComicStyle, ComicsPlugin, ToonScene, lines::Outlines, objects::NoOutlines, testing::ObjectWork,
    toon::ToonMaterial,
};
use bevy_comics_testkit::{
    bench,
    headless::{Headless, HeadlessOptions, new_target},
};

use crate::{Run, table::Table};

/// What is drawn of the objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Variant {
    /// An app without the plugin.
    WithoutPlugin,
    /// The plugin, and a camera without a style.
    Idle,
    /// The engine's depth and normal prepass alone.
    Prepasses,
    /// The same, and its meshes drawn once more: the least that a pass of object ids can cost.
    Floor,
    /// Default outlines.
    Outlines,
    /// Outlines without lines between objects, so without object ids.
    WithoutIds,
    /// Default outlines; one object has none.
    NoOutlines,
    /// Default outlines; one object in a hundred moves.
    Moving,
    /// Default outlines; the camera turns, so that objects enter and leave.
    Turning,
    /// Default outlines; the objects have a thousand meshes.
    Meshes,
    /// Default outlines in eight cameras, and in fifty; fifty cameras without a style.
    Cameras,
    ManyCameras,
    IdleCameras,
    /// No object is in view; without the plugin, and with it.
    UnseenWithoutPlugin,
    UnseenIdle,
    /// An empty [`ToonScene`].
    EmptyScene,
    /// Each of a thousand objects is a [`ToonScene`].
    Scenes,
}

impl Variant {
    const ALL: [(Self, &str); 17] = [
        (Self::WithoutPlugin, "without the plugin"),
        (Self::Idle, "idle plugin"),
        (Self::Prepasses, "depth and normal prepass"),
        (Self::Floor, "depth and normal prepass; drawn twice"),
        (Self::WithoutIds, "outlines without object edges"),
        (Self::Outlines, "outlines"),
        (Self::NoOutlines, "outlines; one object without"),
        (Self::Moving, "outlines; 1 % move"),
        (Self::Turning, "outlines; the camera turns"),
        (Self::Meshes, "outlines; 1000 meshes"),
        (Self::Cameras, "outlines; 8 cameras"),
        (Self::ManyCameras, "outlines; 50 cameras"),
        (Self::IdleCameras, "idle plugin; 50 cameras"),
        (
            Self::UnseenWithoutPlugin,
            "without the plugin; none in view",
        ),
        (Self::UnseenIdle, "idle plugin; none in view"),
        (Self::EmptyScene, "idle; an empty toon scene"),
        (Self::Scenes, "idle; 1000 toon scenes"),
    ];

    fn name(self) -> &'static str {
        let named = Self::ALL.iter().find(|(variant, _)| *variant == self);
        named.map_or("", |(_, name)| *name)
    }

    fn has_lines(self) -> bool {
        matches!(
            self,
            Self::Outlines
                | Self::WithoutIds
                | Self::NoOutlines
                | Self::Moving
                | Self::Turning
                | Self::Meshes
                | Self::Cameras
                | Self::ManyCameras
        )
    }

    fn cameras(self) -> usize {
        match self {
            Self::Cameras => 8,
            Self::ManyCameras | Self::IdleCameras => 50,
            _ => 1,
        }
    }

    /// Whether it is timed in turns with others: those that a target compares.
    fn takes_turns(self) -> bool {
        matches!(
            self,
            Self::Prepasses | Self::Floor | Self::WithoutIds | Self::Outlines
        )
    }

    fn has_plugin(self) -> bool {
        !matches!(self, Self::WithoutPlugin | Self::UnseenWithoutPlugin)
    }
}

/// The stages of a frame that are timed. The first begins with the frame, the others with the end
/// of the one before.
const STAGES: [&str; 5] = ["update", "queue", "batch", "bind", "encode"];

/// The part of `queue`, `batch` and `bind` that object ids take.
const OF_IDS: &str = "ids";

/// When the stages of this frame ended.
#[derive(Resource)]
struct Stages([Instant; STAGES.len()]);

fn mark(stage: usize) -> impl FnMut(ResMut<Stages>) {
    move |mut stages| stages.0[stage] = Instant::now()
}

/// On a camera whose prepass is drawn twice.
#[derive(Component, Clone, ExtractComponent)]
struct DrawnTwice;

/// Draws the meshes of the prepass again, over their depth.
fn draw_again(
    world: &World,
    view: ViewQuery<(&ExtractedView, &ViewDepthTexture, &ViewPrepassTextures), With<DrawnTwice>>,
    phases: Res<ViewBinnedRenderPhases<Opaque3dPrepass>>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let (view, depth, textures) = view.into_inner();
    let (Some(phase), Some(normals)) = (
        phases.get(&view.retained_view_entity),
        textures.normal.as_ref(),
    ) else {
        return;
    };
    let mut pass = ctx.begin_tracked_render_pass(RenderPassDescriptor {
        color_attachments: &[Some(normals.get_attachment()), None, None, None],
        depth_stencil_attachment: Some(depth.get_attachment(StoreOp::Store)),
        ..default()
    });
    if let Err(error) = phase.render(&mut pass, world, entity) {
        warn_once!("{error:?}");
    }
}

/// Notes when the stages of a frame end.
struct StagesPlugin;

impl Plugin for StagesPlugin {
    fn build(&self, app: &mut App) {
        use RenderSystems::{PhaseSort, PrepareBindGroups, PrepareResourcesFlush, Queue};
        app.add_plugins(ExtractComponentPlugin::<DrawnTwice>::default());
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app
            .insert_resource(Stages([Instant::now(); STAGES.len()]))
            .add_systems(
                Core3d,
                draw_again
                    .after(Core3dSystems::Prepass)
                    .before(Core3dSystems::MainPass),
            )
            .add_systems(
                Render,
                (
                    mark(0).after(RenderSystems::PrepareViews).before(Queue),
                    mark(1).after(Queue).before(PhaseSort),
                    mark(2)
                        .after(PrepareResourcesFlush)
                        .before(PrepareBindGroups),
                    mark(3)
                        .after(PrepareBindGroups)
                        .before(RenderSystems::Render),
                    mark(4)
                        .after(RenderSystems::Render)
                        .before(RenderSystems::Cleanup),
                ),
            );
    }
}

/// An app with cubes that share a mesh and a material.
struct Crowd {
    headless: Headless,
    variant: Variant,
    cameras: Vec<Entity>,
    cubes: Vec<Entity>,
}

impl Crowd {
    fn new(variant: Variant, count: usize) -> Self {
        let options = HeadlessOptions {
            size: UVec2::splat(64),
            parallel_systems: true,
            ..default()
        };
        let mut headless = if variant.has_plugin() {
            Headless::new(options.clone(), (ComicsPlugin, StagesPlugin))
        } else {
            Headless::new(options.clone(), StagesPlugin)
        };
        let target = headless.render_target();
        let world = headless.app.world_mut();
        let meshes = if variant == Variant::Meshes { 1000 } else { 1 };
        let mut assets = world.resource_mut::<Assets<Mesh>>();
        let meshes: Vec<_> = (0..meshes).map(|_| assets.add(Cuboid::default())).collect();
        let material = world
            .resource_mut::<Assets<StandardMaterial>>()
            .add(StandardMaterial {
                unlit: true,
                ..default()
            });
        // A cube of cubes, all in view.
        let side = (count as f32).cbrt().ceil();
        let place = |at: usize| {
            let at = at as f32;
            2.0 * Vec3::new(
                at % side,
                (at / side).floor() % side,
                (at / side / side).floor(),
            )
        };
        let cube = |index: usize| {
            let at = Transform::from_translation(place(index) - side)
                .with_rotation(Quat::from_rotation_y(index as f32));
            let mesh = meshes[index % meshes.len()].clone();
            (Mesh3d(mesh), MeshMaterial3d(material.clone()), at)
        };
        let cubes = (0..count).map(|at| world.spawn(cube(at)).id()).collect();
        let unseen = matches!(variant, Variant::UnseenWithoutPlugin | Variant::UnseenIdle);
        let ahead = if unseen { Vec3::Z } else { Vec3::NEG_Z };
        let at = Transform::from_xyz(0.0, 0.0, 4.0 * side).looking_to(ahead, Vec3::Y);
        let mut targets = vec![target];
        let new = |_| new_target(world, options.size, options.format).into();
        targets.extend((1..variant.cameras()).map(new));
        let camera = |target: RenderTarget| (Camera3d::default(), target, Msaa::Off, at);
        let cameras = targets
            .into_iter()
            .map(|target| world.spawn(camera(target)).id())
            .collect();
        let mut crowd = Self {
            headless,
            variant,
            cameras,
            cubes,
        };
        crowd.dress();
        crowd
    }

    /// Adds what the variant is about.
    fn dress(&mut self) {
        let (cameras, cubes) = (&self.cameras, &self.cubes);
        let world = self.headless.app.world_mut();
        if self.variant.has_lines() {
            let mut outlines = Outlines::default();
            if self.variant == Variant::WithoutIds {
                outlines.objects = None;
            }
            let style = ComicStyle::new().with(outlines);
            for camera in cameras {
                style.apply(&mut world.commands().entity(*camera));
            }
            world.flush();
        }
        match self.variant {
            Variant::Prepasses | Variant::Floor => {
                world
                    .entity_mut(cameras[0])
                    .insert((DepthPrepass, NormalPrepass));
                if self.variant == Variant::Floor {
                    world.entity_mut(cameras[0]).insert(DrawnTwice);
                }
            }
            Variant::NoOutlines => {
                world.entity_mut(cubes[0]).insert(NoOutlines::default());
            }
            Variant::EmptyScene => {
                world.spawn(ToonScene::default());
            }
            Variant::Scenes => {
                for cube in cubes.iter().take(1000) {
                    world.entity_mut(*cube).insert(ToonScene::default());
                }
            }
            _ => {}
        }
    }

    /// Moves what the variant moves.
    fn advance(&mut self, frame: usize) {
        let world = self.headless.app.world_mut();
        match self.variant {
            Variant::Moving => {
                for cube in self.cubes.iter().step_by(100) {
                    if let Some(mut at) = world.get_mut::<Transform>(*cube) {
                        at.translation.y += if frame.is_multiple_of(2) { 0.1 } else { -0.1 };
                    }
                }
            }
            Variant::Turning => {
                if let Some(mut at) = world.get_mut::<Transform>(self.cameras[0]) {
                    let angle = if frame.is_multiple_of(2) { 0.1 } else { -0.1 };
                    at.rotate_y(angle);
                }
            }
            _ => {}
        }
    }

    /// Milliseconds of a frame, of its stages, and of object ids on the CPU.
    fn frame(&mut self, frame: usize) -> (f64, [f64; STAGES.len()], f64) {
        self.advance(frame);
        let start = Instant::now();
        let whole = bench::whole_frame(&mut self.headless);
        let world = self.headless.app.sub_app(RenderApp).world();
        let ends = world.resource::<Stages>().0;
        let mut last = start;
        let stages = ends.map(|end| {
            let took = end.saturating_duration_since(last);
            last = end;
            took.as_secs_f64() * 1e3
        });
        (whole, stages, self.of_ids())
    }

    fn work(&self) -> ObjectWork {
        ObjectWork::of(self.headless.app.sub_app(RenderApp).world())
    }

    /// Milliseconds of the CPU that object ids took in the last frame.
    fn of_ids(&self) -> f64 {
        let world = self.headless.app.sub_app(RenderApp).world();
        ObjectWork::elapsed(world).as_secs_f64() * 1e3
    }

    fn materials(&self) -> usize {
        let world = self.headless.app.world();
        world
            .get_resource::<Assets<ToonMaterial>>()
            .map_or(0, Assets::len)
    }
}

pub fn measure(run: &Run) -> Result<(), String> {
    let mut table = Table::new(&format!(
        "objects,variant,round,toon_materials,id_draws,uploaded_bytes,whole,{},{OF_IDS}",
        STAGES.join(",")
    ));
    let all = [1, 1_000, 10_000, 20_000, 60_000, 100_000];
    let counts = run.pick(vec![1, 100], all.to_vec());
    let frames = run.pick(1, 9);
    // The apps without the plugin are timed once more in the end: that shows the noise.
    let again = [Variant::WithoutPlugin, Variant::UnseenWithoutPlugin].map(|again| (again, true));
    let variants = Variant::ALL.map(|(variant, _)| (variant, false));
    let variants = run.some(6, variants.into_iter().chain(again));
    // Those that are compared take turns, so that a slower minute of the machine slows all of them.
    let groups: Vec<_> = variants
        .chunk_by(|(a, _), (b, _)| a.takes_turns() && b.takes_turns())
        .collect();
    for count in counts {
        for group in &groups {
            measure_group(run, &mut table, count, group, frames);
        }
    }
    run.save("many_objects_times", &table)
}

/// Measures variants in turns; those with `true` once more.
fn measure_group(
    run: &Run,
    table: &mut Table,
    count: usize,
    group: &[(Variant, bool)],
    frames: usize,
) {
    // A frame of many cameras takes many times as long.
    let is_timed = |variant: Variant| variant.cameras() == 1 || count * variant.cameras() <= 80_000;
    let timed = group.iter().filter(|(variant, _)| is_timed(*variant));
    let mut crowds: Vec<_> = timed
        .map(|&(variant, again)| (Crowd::new(variant, count), again))
        .collect();
    for (crowd, _) in &mut crowds {
        // Pipelines compile, and textures and buffers get their size.
        crowd.headless.step(4);
    }
    for round in 0..run.rounds.min(3) {
        for (crowd, again) in &mut crowds {
            let before = crowd.work().uploaded;
            let mut all: Vec<_> = (0..frames).map(|frame| crowd.frame(frame)).collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (whole, stages, _) = all[all.len() / 2];
            all.sort_by(|a, b| a.2.total_cmp(&b.2));
            let ids = format!("{:.3}", all[all.len() / 2].2);
            let [update, queue, batch, bind, encode] = stages.map(|ms| format!("{ms:.3}"));
            let whole = format!("{whole:.3}");
            let name = crowd.variant.name();
            let name = if *again {
                format!("{name}; again")
            } else {
                name.to_owned()
            };
            let materials = crowd.materials();
            let ObjectWork {
                draw_calls,
                uploaded,
                ..
            } = crowd.work();
            let uploaded = (uploaded - before) / frames;
            table.push(&[
                &count,
                &name,
                &round,
                &materials,
                &draw_calls,
                &uploaded,
                &whole,
                &update,
                &queue,
                &batch,
                &bind,
                &encode,
                &ids,
            ]);
            if round == 0 {
                run.say(&format!(
                    "{count} objects, {name}: {whole} ms, {materials} materials, \
                     {draw_calls} draws of ids in {ids} ms of the CPU, {uploaded} B"
                ));
            }
        }
    }
}
