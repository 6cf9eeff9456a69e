//! Apps that tests use one after another. A new app compiles every pipeline again, about a second on a CPU.
//!
//! What a test spawned is removed after it, and resources that tests commonly replace are set back. An app that
//! a test changed otherwise is not used again: by a system, by a resource of its own, or by another value of a
//! resource that frames leave alone.

use std::{
    collections::HashMap,
    sync::{Mutex, MutexGuard, PoisonError},
    time::Instant,
};

use bevy::{
    app::SubApps,
    diagnostic::FrameCount,
    ecs::{component::ComponentId, schedule::Schedules},
    light::DirectionalLightShadowMap,
    pbr::DefaultOpaqueRendererMethod,
    prelude::*,
    render::RenderApp,
    time::{Fixed, Real, TimeUpdateStrategy, Virtual},
};

use bevy_comics::{ObjectIdDepthTest, ReduceFlashing};

use crate::headless::{self, Headless, HeadlessOptions};

/// An app that no test uses at the moment.
struct Idle {
    apps: SubApps,
    start: Start,
}

static IDLE: Mutex<Vec<Idle>> = Mutex::new(Vec::new());

fn idle() -> MutexGuard<'static, Vec<Idle>> {
    IDLE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The state of an app before each test.
pub struct Start {
    entities: Vec<Entity>,
    /// The tick of the last change of each resource; `None` for those that frames change, and those that
    /// [`restore`] sets.
    resources: HashMap<ComponentId, Option<u32>>,
    /// The numbers of systems of the game and of the renderer.
    systems: [usize; 2],
}

impl Start {
    /// Notes the state of an app. `draw` draws what tests commonly do, and so tells which resources change
    /// in every frame.
    fn of(headless: &mut Headless, draw: impl FnOnce(&mut Headless)) -> Self {
        headless.step(1);
        let entities = entities(headless.app.world());
        let before = changes(headless.app.world());
        draw(headless);
        restore(headless.app.world_mut());
        let world = headless.app.world();
        let after = changes(world);
        let unless_changed = |(id, tick)| {
            let left_alone = before.get(&id) == Some(&tick) && !follows_the_scene(world, id);
            (id, left_alone.then_some(tick))
        };
        Self {
            entities,
            resources: after.into_iter().map(unless_changed).collect(),
            systems: systems(&headless.app),
        }
    }

    /// Whether a test left more behind than entities and pipelines.
    fn has_changed(&self, app: &App) -> bool {
        let world = app.world();
        let now = changes(world);
        let as_before = |(id, tick): (&ComponentId, &u32)| {
            let before = self.resources.get(id);
            before.is_some_and(|before| before.is_none_or(|before| before == *tick))
        };
        now.len() != self.resources.len()
            || !now.iter().all(as_before)
            || !self
                .entities
                .iter()
                .all(|entity| world.get_entity(*entity).is_ok())
            || systems(app) != self.systems
    }

    /// Removes what a test spawned, the youngest first, and lets the renderer see it.
    fn remove_others(&self, headless: &mut Headless) {
        let world = headless.app.world_mut();
        let mut others = entities(world);
        others.retain(|entity| self.entities.binary_search(entity).is_err());
        for entity in others.into_iter().rev() {
            world.try_despawn(entity).ok();
        }
        headless.step(1);
    }
}

/// An app that a test gave back, else a `new` one. Only apps with the default options are given back; their
/// targets may differ. `draw` draws what tests commonly do.
pub fn take(
    options: HeadlessOptions,
    new: impl FnOnce(HeadlessOptions) -> Headless,
    draw: impl FnOnce(&mut Headless),
) -> Headless {
    let usual = HeadlessOptions {
        size: options.size,
        format: options.format,
        scale_factor: options.scale_factor,
        ..default()
    };
    if options != usual {
        return new(options);
    }
    let known = idle().pop();
    let mut headless = known.map_or_else(
        || {
            let mut headless = new(options.clone());
            let start = Start::of(&mut headless, draw);
            start.remove_others(&mut headless);
            headless.start = Some(start);
            headless
        },
        |known| {
            let mut app = App::empty();
            *app.sub_apps_mut() = known.apps;
            let target = headless::new_target(app.world_mut(), options.size, options.format);
            Headless {
                app,
                target,
                options: options.clone(),
                start: Some(known.start),
            }
        },
    );
    restore(headless.app.world_mut());
    headless
}

/// Takes an app back after a test.
pub(crate) fn give_back(headless: &mut Headless) {
    let Some(start) = headless.start.take() else {
        return;
    };
    if std::thread::panicking() || start.has_changed(&headless.app) {
        return;
    }
    restore(headless.app.world_mut());
    start.remove_others(headless);
    let apps = std::mem::take(headless.app.sub_apps_mut());
    idle().push(Idle { apps, start });
}

/// Whether a resource holds what belongs to assets and entities, and goes with them.
fn follows_the_scene(world: &World, resource: ComponentId) -> bool {
    const CONTENTS: [&str; 4] = [
        "bevy_asset::",
        "bevy_ecs::message::",
        "bevy_comics::cartoon::",
        "bevy_comics::objects::",
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
