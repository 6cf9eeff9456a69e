//! Scenes share copies, and follow what changes.

use super::*;

/// The part of the plugin that shadings and scenes need.
fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default()))
        .init_asset::<StandardMaterial>()
        .init_asset::<ToonMaterial>()
        .init_asset::<ToonShading>()
        .add_systems(
            Update,
            (apply_shadings, find_meshes, follow_materials, convert).chain(),
        );
    build(&mut app);
    app
}

fn add<A: Asset>(app: &mut App, asset: A) -> Handle<A> {
    app.world_mut().resource_mut::<Assets<A>>().add(asset)
}

fn lit(highlight: f32) -> ToonScene {
    ToonScene::new(ToonLight {
        highlight,
        ..ToonLight::default()
    })
}

/// The copies that there are. Dropped ones are gone a frame later.
fn copies(app: &mut App) -> usize {
    app.update();
    app.update();
    app.world().resource::<Assets<ToonMaterial>>().len()
}

fn copy(app: &App, mesh: Entity) -> Option<Handle<ToonMaterial>> {
    let material = app.world().get::<MeshMaterial3d<ToonMaterial>>(mesh);
    material.map(|material| material.0.clone())
}

#[test]
fn scenes_with_equal_settings_share_a_copy() {
    let mut app = app();
    let standard = MeshMaterial3d(add(&mut app, StandardMaterial::default()));
    let scenes: Vec<[Entity; 2]> = (0..100)
        .map(|_| {
            let root = app.world_mut().spawn(lit(0.5)).id();
            let mesh = (ChildOf(root), standard.clone());
            [root, app.world_mut().spawn(mesh).id()]
        })
        .collect();
    assert_eq!(copies(&mut app), 1, "equal scenes");
    let [root, mesh] = scenes[7];
    let shared = copy(&app, scenes[0][1]);
    assert_eq!(copy(&app, mesh), shared);
    app.world_mut().entity_mut(root).insert(lit(0.1));
    assert_eq!(copies(&mut app), 2, "one is tuned");
    let own = copy(&app, mesh);
    assert_ne!(own, shared);
    assert_eq!(copy(&app, scenes[0][1]), shared);
    // A slider changes the copy in place.
    app.world_mut().entity_mut(root).insert(lit(0.2));
    assert_eq!(copies(&mut app), 2);
    assert_eq!(copy(&app, mesh), own);
    let materials = app.world().resource::<Assets<ToonMaterial>>();
    let material = materials.get(&own.expect("converted")).expect("a copy");
    assert_eq!(material.extension.highlight, 0.2);
    app.world_mut().entity_mut(root).insert(lit(0.5));
    assert_eq!(copies(&mut app), 1, "and put back");
    assert_eq!(copy(&app, mesh), shared);
    // All together: their copy changes in place too.
    for [root, _] in &scenes {
        app.world_mut().entity_mut(*root).insert(lit(0.9));
    }
    assert_eq!(copies(&mut app), 1);
    assert_eq!(copy(&app, mesh), shared);
    // A material that is gone takes its copies with it, also while there are scenes.
    let brief = MeshMaterial3d(add(&mut app, StandardMaterial::default()));
    let brief = app.world_mut().spawn((ChildOf(root), brief)).id();
    assert_eq!(copies(&mut app), 2);
    app.world_mut().despawn(brief);
    app.update();
    assert_eq!(copies(&mut app), 1, "of a material that is gone");
    for [root, _] in &scenes {
        app.world_mut().entity_mut(*root).remove::<ToonScene>();
    }
    drop(shared);
    assert_eq!(copies(&mut app), 0, "without scenes");
    let restored = app.world().get::<MeshMaterial3d<StandardMaterial>>(mesh);
    assert_eq!(restored, Some(&standard));
}

#[test]
fn meshes_follow_what_is_above_them() {
    let mut app = app();
    let standard = MeshMaterial3d(add(&mut app, StandardMaterial::default()));
    let roots = [0.1, 0.2].map(|highlight| app.world_mut().spawn(lit(highlight)).id());
    let between = app.world_mut().spawn_empty().id();
    let mesh = app.world_mut().spawn((ChildOf(between), standard)).id();
    app.update();
    assert_eq!(copy(&app, mesh), None);
    let highlight = |app: &mut App| {
        app.update();
        let copy = copy(app, mesh)?;
        let materials = app.world().resource::<Assets<ToonMaterial>>();
        Some(materials.get(&copy)?.extension.highlight)
    };
    for (parent, wanted) in [(Some(0), Some(0.1)), (Some(1), Some(0.2)), (None, None)] {
        let mut between = app.world_mut().entity_mut(between);
        match parent {
            Some(root) => between.insert(ChildOf(roots[root])),
            None => between.remove::<ChildOf>(),
        };
        assert_eq!(highlight(&mut app), wanted);
        app.update();
        let found = &app.world().resource::<SceneChanges>().meshes;
        assert_eq!(*found, [], "a frame without changes looks at no mesh");
    }
    // A scene in between, and a material that loads later.
    app.world_mut()
        .entity_mut(between)
        .insert((ChildOf(roots[0]), lit(0.3)));
    assert_eq!(highlight(&mut app), Some(0.3));
    app.world_mut().entity_mut(between).remove::<ToonScene>();
    assert_eq!(highlight(&mut app), Some(0.1));
    let standard = app
        .world()
        .resource::<Assets<StandardMaterial>>()
        .reserve_handle();
    app.world_mut()
        .entity_mut(mesh)
        .insert(MeshMaterial3d(standard.clone()));
    app.update();
    let mut materials = app.world_mut().resource_mut::<Assets<StandardMaterial>>();
    let metal = StandardMaterial {
        metallic: 0.7,
        ..StandardMaterial::default()
    };
    materials.insert(standard.id(), metal).expect("reserved");
    app.update();
    let copy = copy(&app, mesh).expect("converted");
    let materials = app.world().resource::<Assets<ToonMaterial>>();
    assert_eq!(materials.get(&copy).expect("a copy").base.metallic, 0.7);
}
