//! The groups after changes, against a scan of the whole hierarchy.

use bevy::ecs::entity::EntityHashMap;

use super::*;

#[test]
fn only_labels_of_primitives_are_primitives() {
    for (path, mesh) in [
        ("a.glb#Mesh3/Primitive0", Some("Mesh3")),
        ("folder/a.gltf#Mesh12/Primitive34", Some("Mesh12")),
        ("a.glb#Mesh3/Primitive0/MorphTargets", None),
        ("a.glb#Mesh3", None),
        ("a.glb#Mesh/Primitive", None),
        ("a.glb#Node0/Primitive0", None),
        ("a.mesh", None),
    ] {
        assert_eq!(primitive(&AssetPath::parse(path)), mesh, "{path}");
    }
}

/// The object of every mesh, from the whole hierarchy.
fn scan(world: &mut World) -> EntityHashMap<Entity> {
    let mut meshes = world.query::<(Entity, &Mesh3d)>();
    let found: Vec<_> = meshes.iter(world).map(|(e, m)| (e, m.clone())).collect();
    let mut objects = EntityHashMap::default();
    for (mesh, _) in &found {
        let mut at = Some(*mesh);
        while let Some(entity) = at {
            if world.get::<OutlineGroup>(entity).is_some() {
                objects.insert(*mesh, entity);
                break;
            }
            at = world.get::<ChildOf>(entity).map(ChildOf::parent);
        }
    }
    let grouped = objects.clone();
    let siblings = |mesh: Entity| -> Vec<Entity> {
        let parent = world.get::<ChildOf>(mesh).map(ChildOf::parent);
        let children = parent.and_then(|parent| world.get::<Children>(parent));
        let children = children.into_iter().flatten().copied();
        children.filter(|c| !grouped.contains_key(c)).collect()
    };
    let path = |mesh: Entity| world.get::<Mesh3d>(mesh)?.0.path().cloned();
    let object = |mesh: Entity| {
        let own = path(mesh)?;
        let before = siblings(mesh).into_iter().take_while(|s| *s != mesh);
        let copy = before.filter(|s| path(*s).as_ref() == Some(&own)).count();
        Some((
            own.without_label().into_owned(),
            primitive(&own)?.to_string(),
            copy,
        ))
    };
    for (mesh, _) in &found {
        if !grouped.contains_key(mesh) {
            let mut same = siblings(*mesh).into_iter();
            let first = same.find(|s| object(*mesh).is_some() && object(*s) == object(*mesh));
            objects.insert(*mesh, first.unwrap_or(*mesh));
        }
    }
    objects
}

/// After any changes, the groups are those of a scan of the whole hierarchy.
#[test]
fn updates_agree_with_a_scan() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default()))
        .init_asset::<Mesh>();
    build(&mut app);
    let server = app.world().resource::<AssetServer>().clone();
    let mut handles: Vec<Handle<Mesh>> = ["a.x#Mesh0", "a.x#Mesh1", "b.x#Mesh0"]
        .iter()
        .flat_map(|mesh| (0..2).map(move |p| format!("{mesh}/Primitive{p}")))
        .map(|path| server.load(path))
        .collect();
    handles.push(Handle::default());
    let mut state = 1u64;
    let mut random = |below: usize| {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as usize % below
    };
    let mut entities = Vec::new();
    for round in 0..1500 {
        for _ in 0..random(4) {
            let world = app.world_mut();
            entities.retain(|entity| world.get_entity(*entity).is_ok());
            let action = if entities.len() < 12 { 0 } else { random(9) };
            if action == 0 {
                let mesh = Mesh3d(handles[random(handles.len())].clone());
                entities.push(world.spawn(mesh).id());
                continue;
            }
            let entity = entities[random(entities.len())];
            let other = entities[random(entities.len())];
            let circle = std::iter::successors(Some(other), |at| {
                world.get::<ChildOf>(*at).map(ChildOf::parent)
            });
            let is_circle = circle.into_iter().any(|at| at == entity);
            let mut entity = world.entity_mut(entity);
            match action {
                1..=3 if !is_circle => {
                    entity.insert(ChildOf(other));
                }
                4 => {
                    entity.remove::<ChildOf>();
                }
                5 => {
                    entity.insert(OutlineGroup);
                }
                6 => {
                    entity.remove::<OutlineGroup>();
                }
                7 => {
                    entity.insert(Mesh3d(handles[random(handles.len())].clone()));
                }
                8 if random(4) == 0 => entity.despawn(),
                8 => {
                    entity.remove::<Mesh3d>();
                }
                _ => {}
            }
        }
        app.update();
        let wanted = scan(app.world_mut());
        let groups = app.world().resource::<ObjectGroups>();
        for (mesh, object) in &wanted {
            assert_eq!(groups.object(*mesh), *object, "round {round}, {mesh}");
        }
        let kept = (groups.roots.values().keys()).chain(groups.primitives.values().keys());
        assert!(
            kept.into_iter().all(|mesh| wanted.contains_key(mesh)),
            "round {round}"
        );
    }
}

/// A hierarchy in a circle, which the engine does not prevent, ends the walk.
#[test]
fn a_circle_of_parents_does_no_harm() {
    let mut app = App::new();
    build(&mut app);
    let world = app.world_mut();
    let [a, b, c] = std::array::from_fn(|_| world.spawn(Mesh3d(Handle::default())).id());
    world.entity_mut(a).insert(ChildOf(b));
    world.entity_mut(b).insert(ChildOf(c));
    world.entity_mut(c).insert(ChildOf(a));
    app.update();
    assert_eq!(app.world().resource::<ObjectGroups>().object(a), a);
}
