//! Apps that tests use one after another. A new app compiles every pipeline again, about a second
//! on a CPU.
//!
//! What a test spawned is removed after it, and resources that tests commonly replace are set back.
//! An app that a test changed otherwise is not used again: one with another number of systems, or
//! in whose main world other resources were added or changed than those that change in every frame.
//! Not seen: assets that are changed in place, and what the renderer keeps for as long as the app
//! runs. Tests of those need an app of their own. The renderer keeps pipelines, so an app with many of
//! them is not used again either.

use std::{
    collections::HashMap,
    sync::{Mutex, MutexGuard, PoisonError},
    time::Instant,
};

use bevy::{
    app::SubApps,
    diagnostic::FrameCount,
    ecs::{component::ComponentId, resource::IsResource},
    light::DirectionalLightShadowMap,
    pbr::DefaultOpaqueRendererMethod,
    prelude::*,
    render::{RenderApp, render_resource::PipelineCache},
    time::TimeUpdateStrategy,
};
use bevy_comics::{
    ReduceFlashing, cameras::WorldOrigin, objects::ObjectIdDepthTest, style::PageScale,
};

use crate::{
    headless::{self, Headless, HeadlessOptions},
    validation,
};

/// The most pipelines of an app that is used again: a driver on the CPU keeps compiled code of each.
const MOST_PIPELINES: usize = 300;

/// Apps with the same plugins and the default options, but for their targets.
pub struct Pool {
    new: fn(HeadlessOptions) -> Headless,
    draw: fn(&mut Headless),
    idle: Mutex<Vec<Idle>>,
}

/// An app that no test uses at the moment.
struct Idle {
    apps: SubApps,
    baseline: Baseline,
}

impl Pool {
    /// A pool of the apps that `new` makes. `draw` draws what tests commonly do.
    pub const fn new(new: fn(HeadlessOptions) -> Headless, draw: fn(&mut Headless)) -> Self {
        let idle = Mutex::new(Vec::new());
        Self { new, draw, idle }
    }

    /// An app that a test gave back, else a new one. With other options than the default ones,
    /// always a new one, which is not given back.
    pub fn take(&'static self, options: HeadlessOptions) -> Headless {
        let usual = HeadlessOptions {
            size: options.size,
            format: options.format,
            scale_factor: options.scale_factor,
            ..default()
        };
        // The validation layer speaks of an app until it ends.
        if options != usual || validation::is_wanted() {
            return (self.new)(options);
        }
        let idle = self.idle().pop();
        let mut headless =
            idle.map_or_else(|| self.start(&options), |idle| self.resume(idle, &options));
        restore(headless.app.world_mut());
        headless
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Idle>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn start(&'static self, options: &HeadlessOptions) -> Headless {
        let mut headless = (self.new)(options.clone());
        let baseline = Baseline::of(&mut headless, self.draw);
        remove_spawned(&mut headless, &baseline);
        headless.lent = Some((self, baseline));
        headless
    }

    fn resume(&'static self, idle: Idle, options: &HeadlessOptions) -> Headless {
        let mut app = App::empty();
        *app.sub_apps_mut() = idle.apps;
        let target = headless::new_target(app.world_mut(), options.size, options.format);
        Headless {
            app,
            target,
            options: options.clone(),
            lent: Some((self, idle.baseline)),
        }
    }
}

/// Takes an app back after a test, if it came from a pool and is as it was.
pub(crate) fn give_back(headless: &mut Headless) {
    let Some((pool, baseline)) = headless.lent.take() else {
        return;
    };
    if std::thread::panicking() {
        return;
    }
    restore(headless.app.world_mut());
    remove_spawned(headless, &baseline);
    let pipelines = headless.in_render_world::<PipelineCache>();
    let count = pipelines.map_or(0, |cache| cache.pipelines().count());
    if count > MOST_PIPELINES || !baseline.is_of(&headless.app) {
        return;
    }
    let apps = std::mem::take(headless.app.sub_apps_mut());
    pool.idle().push(Idle { apps, baseline });
}

/// The state of an app before each test.
pub(crate) struct Baseline {
    entities: Vec<Entity>,
    /// The tick of the last change of each resource of the main world; `None` for those that frames
    /// change, those that [`restore`] sets, and those that go with the scene.
    resources: HashMap<ComponentId, Option<u32>>,
    /// How many systems the game and the renderer have.
    systems: [usize; 2],
}

impl Baseline {
    /// Notes the state of a new app. `draw` tells which resources change in every frame.
    fn of(headless: &mut Headless, draw: fn(&mut Headless)) -> Self {
        headless.step(1);
        restore(headless.app.world_mut());
        let entities = entities(headless.app.world());
        let before = changes(headless.app.world());
        draw(headless);
        // The fixed schedule has its turn, too.
        headless.step(3);
        restore(headless.app.world_mut());
        let world = headless.app.world();
        let unless_changed = |(id, tick)| {
            let left_alone = before.get(&id) == Some(&tick) && !goes_with_the_scene(world, id);
            (id, left_alone.then_some(tick))
        };
        Self {
            entities,
            resources: changes(world).into_iter().map(unless_changed).collect(),
            systems: systems(&headless.app),
        }
    }

    /// Whether an app has nothing but this, and pipelines.
    fn is_of(&self, app: &App) -> bool {
        let now = changes(app.world());
        let is_same = |(id, now): (&ComponentId, &u32)| {
            let known = self.resources.get(id);
            known.is_some_and(|tick| tick.is_none_or(|tick| tick == *now))
        };
        now.len() == self.resources.len()
            && now.iter().all(is_same)
            && entities(app.world()) == self.entities
            && systems(app) == self.systems
    }
}

/// Removes what a test spawned, and draws until the renderer has forgotten it: the engine keeps
/// textures for three frames.
fn remove_spawned(headless: &mut Headless, baseline: &Baseline) {
    let world = headless.app.world_mut();
    for entity in entities(world) {
        // An entity that has a resource may not be despawned.
        let is_kept = baseline.entities.binary_search(&entity).is_ok()
            || world.get::<IsResource>(entity).is_some();
        if !is_kept {
            world.try_despawn(entity).ok();
        }
    }
    headless.step(3);
}

/// Whether a resource holds assets, messages, or what this crate keeps of materials and objects.
fn goes_with_the_scene(world: &World, resource: ComponentId) -> bool {
    const CONTENTS: [&str; 6] = [
        "bevy_asset::",
        "bevy_ecs::message::",
        "bevy_comics::animation::flashes::",
        "bevy_comics::depth::",
        "bevy_comics::objects::",
        "bevy_comics::toon::",
    ];
    let name = world.components().get_name(resource);
    name.is_some_and(|name| CONTENTS.iter().any(|start| name.starts_with(start)))
}

/// Sets the clocks back, and the resources that tests commonly replace.
fn restore(world: &mut World) {
    world.insert_resource(Time::<Real>::new(Instant::now()));
    world.insert_resource(Time::<Virtual>::default());
    world.insert_resource(Time::<Fixed>::default());
    world.insert_resource(Time::<()>::default());
    world.insert_resource(TimeUpdateStrategy::ManualDuration(headless::FRAME));
    world.insert_resource(FrameCount(0));
    world.insert_resource(ClearColor::default());
    world.insert_resource(GlobalAmbientLight::default());
    world.insert_resource(DirectionalLightShadowMap::default());
    world.insert_resource(DefaultOpaqueRendererMethod::default());
    world.insert_resource(ObjectIdDepthTest::default());
    world.insert_resource(ReduceFlashing::default());
    world.insert_resource(PageScale::default());
    // Known to an app from the start, so that one in which a test inserts it is as it was.
    world.insert_resource(WorldOrigin::default());
    world.remove_resource::<WorldOrigin>();
}

/// All entities, ordered.
fn entities(world: &World) -> Vec<Entity> {
    let archetypes = world.archetypes().iter();
    let mut entities: Vec<Entity> = archetypes
        .flat_map(|archetype| archetype.entities().iter().map(|entity| entity.id()))
        .collect();
    entities.sort_unstable();
    entities
}

/// When each resource changed last.
fn changes(world: &World) -> HashMap<ComponentId, u32> {
    let ids = world.resource_entities().iter().map(|(id, _)| id);
    ids.filter_map(|id| Some((id, world.get_resource_change_ticks_by_id(id)?.changed.get())))
        .collect()
}

fn systems(app: &App) -> [usize; 2] {
    let count = |world: &World| {
        let schedules = world.resource::<Schedules>();
        schedules
            .iter()
            .map(|(_, schedule)| schedule.graph().systems.len())
            .sum()
    };
    let renderer = app.get_sub_app(RenderApp);
    [
        count(app.world()),
        renderer.map_or(0, |renderer| count(renderer.world())),
    ]
}
