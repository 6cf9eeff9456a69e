//! An edit in a place is what the mesh is drawn with, and stays.

use bevy::{mesh::MeshPlugin, pbr::PbrPlugin};

use super::*;
use bevy_comics::{ComicsPlugin, toon::MaterialName};

/// An app with materials, without a renderer.
fn app() -> App {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        AssetPlugin::default(),
        ImagePlugin::default(),
        MeshPlugin,
    ))
    .init_asset::<Shader>()
    .add_plugins((
        PbrPlugin {
            gltf_enable_standard_materials: false,
            ..PbrPlugin::default()
        },
        ComicsPlugin,
    ));
    app
}

fn add<A: Asset>(app: &mut App, asset: A) -> Handle<A> {
    app.world_mut().resource_mut::<Assets<A>>().add(asset)
}

fn lit(highlight: f32) -> ToonLight {
    ToonLight {
        highlight,
        ..ToonLight::default()
    }
}

fn shading(app: &mut App, highlight: f32) -> Handle<ToonShading> {
    add(app, ToonShading::new(lit(highlight)))
}

/// The highlight of what a mesh is drawn with.
fn drawn(app: &App, mesh: Entity) -> f32 {
    let material = app.world().get::<MeshMaterial3d<ToonMaterial>>(mesh);
    let materials = app.world().resource::<Assets<ToonMaterial>>();
    let material = materials.get(&material.expect("toon").0);
    material.expect("a material").extension.highlight
}

fn place(app: &App, mesh: Entity) -> LightOwner {
    LightOwner::of(app.world(), mesh).expect("a place")
}

/// Edits the light of the first mesh: it is drawn with the edit, also later, and so are exactly
/// the meshes that the place counts.
fn check_edit(app: &mut App, meshes: &[Entity]) {
    for _ in 0..3 {
        app.update();
    }
    let before: Vec<f32> = meshes.iter().map(|mesh| drawn(app, *mesh)).collect();
    let place = place(app, meshes[0]);
    assert_eq!(
        place.light(app.world()).expect("light").highlight,
        before[0]
    );
    let edit = 0.5 * before[0] + 0.0625;
    assert!(place.set(app.world_mut(), lit(edit)).is_some());
    for _ in 0..4 {
        app.update();
    }
    assert_eq!(drawn(app, meshes[0]), edit, "{place:?}");
    let changed = meshes.iter().zip(&before);
    let is_changed = |(mesh, before): &(&Entity, &f32)| drawn(app, **mesh) != **before;
    let changed = changed.filter(is_changed).count();
    assert_eq!(place.meshes(app.world_mut()), changed, "{place:?}");
}

#[test]
fn a_material_of_its_own_is_edited_itself() {
    let mut app = app();
    let [one, other] = [1.5, 2.5].map(|highlight| {
        let extension = lit(highlight);
        let base = StandardMaterial::default();
        add(&mut app, ToonMaterial { base, extension })
    });
    let meshes = [&one, &one, &other]
        .map(|material| app.world_mut().spawn(MeshMaterial3d(material.clone())).id());
    check_edit(&mut app, &meshes);
    assert_eq!(place(&app, meshes[0]), LightOwner::Material(one));
}

#[test]
fn a_shading_that_has_loaded_comes_before_its_material() {
    let mut app = app();
    let skin = shading(&mut app, 3.0);
    let material = |app: &mut App, highlight| {
        let extension = lit(highlight);
        let base = StandardMaterial::default();
        MeshMaterial3d(add(app, ToonMaterial { base, extension }))
    };
    let materials = [1.5, 2.5, 3.5].map(|highlight| material(&mut app, highlight));
    let [a, b, c] = materials;
    let meshes = [
        app.world_mut()
            .spawn((a, ToonShadingHandle(skin.clone())))
            .id(),
        app.world_mut()
            .spawn((b, ToonShadingHandle(skin.clone())))
            .id(),
        app.world_mut().spawn(c).id(),
    ];
    check_edit(&mut app, &meshes);
    assert_eq!(place(&app, meshes[0]), LightOwner::Shading(skin));
    // One that never loads says nothing.
    let missing = app
        .world()
        .resource::<Assets<ToonShading>>()
        .reserve_handle();
    let own = material(&mut app, 0.75);
    let mesh = app
        .world_mut()
        .spawn((own, ToonShadingHandle(missing)))
        .id();
    check_edit(&mut app, &[mesh]);
    assert!(matches!(place(&app, mesh), LightOwner::Material(_)));
}

/// Below a scene: the mesh's own shading, that of its name, that of the scene, the scene's light.
#[test]
fn meshes_of_a_scene_are_edited_where_the_scene_says() {
    let mut app = app();
    let [own, named, whole] = [0.25, 0.5, 0.75].map(|highlight| shading(&mut app, highlight));
    let standard = add(&mut app, StandardMaterial::default());
    let part = || MeshMaterial3d(standard.clone());
    let lights = ToonScene::new(lit(3.0)).with_override("Skin", named.clone());
    let root = app.world_mut().spawn(lights.clone()).id();
    let below = || ChildOf(root);
    let skin = MaterialName::new("Skin");
    let [with_own, with_name, plain, plain_too] = [
        app.world_mut()
            .spawn((
                part(),
                below(),
                skin.clone(),
                ToonShadingHandle(own.clone()),
            ))
            .id(),
        app.world_mut().spawn((part(), below(), skin)).id(),
        app.world_mut().spawn((part(), below())).id(),
        app.world_mut().spawn((part(), below())).id(),
    ];
    check_edit(&mut app, &[with_own, with_name, plain, plain_too]);
    check_edit(&mut app, &[with_name, with_own, plain, plain_too]);
    check_edit(&mut app, &[plain, plain_too, with_own, with_name]);
    assert_eq!(place(&app, with_own), LightOwner::Shading(own));
    assert_eq!(place(&app, with_name), LightOwner::Shading(named));
    assert_eq!(place(&app, plain), LightOwner::Scene(root));
    // The scene's shading comes before its light.
    let scene = lights.with_shading(whole.clone());
    app.world_mut().entity_mut(root).insert(scene);
    check_edit(&mut app, &[plain, plain_too, with_own, with_name]);
    assert_eq!(place(&app, plain), LightOwner::Shading(whole));
}

#[test]
fn places_that_are_gone_are_left_alone() {
    let mut app = app();
    let root = app.world_mut().spawn(ToonScene::new(lit(3.0))).id();
    let gone = LightOwner::Scene(root);
    app.world_mut().despawn(root);
    assert!(gone.set(app.world_mut(), lit(1.0)).is_none());
    assert_eq!(gone.light(app.world()), None);
    let standard = add(&mut app, StandardMaterial::default());
    let mesh = app.world_mut().spawn(MeshMaterial3d(standard)).id();
    assert_eq!(LightOwner::of(app.world(), mesh), None);
    let material = app
        .world()
        .resource::<Assets<ToonMaterial>>()
        .reserve_handle();
    let mesh = app.world_mut().spawn(MeshMaterial3d(material)).id();
    assert_eq!(LightOwner::of(app.world(), mesh), None, "not loaded");
}
