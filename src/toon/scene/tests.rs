//! Scenes share copies, and follow what changes.

use super::*;
use crate::toon::StyleScope;

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

/// The highlight of a mesh's toon copy, if it has one.
fn highlight(app: &App, mesh: Entity) -> Option<f32> {
    let materials = app.world().resource::<Assets<ToonMaterial>>();
    let material = materials.get(&copy(app, mesh)?)?;
    Some(material.extension.highlight)
}

/// A camera with a style that lights meshes.
fn styled(app: &mut App, order: isize, highlight: f32) -> Entity {
    let camera = Camera { order, ..default() };
    let scene = CameraScene(StyleScene::new(lit(highlight).light));
    app.world_mut().spawn((camera, scene)).id()
}

#[test]
fn a_camera_lights_the_meshes_that_it_sees() {
    let mut app = app();
    let standard = MeshMaterial3d(add(&mut app, StandardMaterial::default()));
    let root = app.world_mut().spawn(lit(0.1)).id();
    let below = (standard.clone(), ChildOf(root));
    let below = app.world_mut().spawn(below).id();
    let elsewhere = (standard.clone(), RenderLayers::layer(1));
    let elsewhere = app.world_mut().spawn(elsewhere).id();
    let own = MeshMaterial3d(add(&mut app, ToonMaterial::default()));
    let own = app.world_mut().spawn(own).id();
    let plain = app.world_mut().spawn(standard.clone()).id();
    let shading = add(&mut app, ToonShading::new(lit(0.7).light));
    let shaded = (standard.clone(), ToonShadingHandle(shading));
    let shaded = app.world_mut().spawn(shaded).id();
    let camera = styled(&mut app, 0, 0.3);
    app.update();
    let late = app.world_mut().spawn(standard.clone()).id();
    app.update();
    let lights =
        |app: &App| [plain, late, below, shaded, own, elsewhere].map(|mesh| highlight(app, mesh));
    let [one, scene, handle, default] = [0.3, 0.1, 0.7, 1.0].map(Some);
    assert_eq!(lights(&app), [one, one, scene, handle, default, None]);

    // Layers, and the style's file.
    let moved = RenderLayers::layer(1);
    app.world_mut().entity_mut(plain).insert(moved);
    app.world_mut()
        .entity_mut(elsewhere)
        .remove::<RenderLayers>();
    app.update();
    assert_eq!(lights(&app), [None, one, scene, handle, default, one]);
    let before = copy(&app, late);
    let changed = CameraScene(StyleScene::new(lit(0.4).light));
    app.world_mut().entity_mut(camera).insert(changed);
    app.update();
    assert_eq!(highlight(&app, late), Some(0.4));
    assert_eq!(copy(&app, late), before, "its copy changes in place");

    // Without the style, all is as it was.
    app.world_mut().entity_mut(camera).remove::<CameraScene>();
    app.update();
    assert_eq!(lights(&app), [None, None, scene, None, default, None]);
    for mesh in [plain, late, shaded, elsewhere] {
        let restored = app.world().get::<MeshMaterial3d<StandardMaterial>>(mesh);
        assert_eq!(restored, Some(&standard));
    }
}

#[test]
fn a_scope_limits_what_a_camera_lights() {
    let mut app = app();
    let standard = MeshMaterial3d(add(&mut app, StandardMaterial::default()));
    let hero = app.world_mut().spawn(RenderLayers::layer(3)).id();
    let [within, beside] = [Some(hero), None].map(|parent| {
        let mut mesh = app.world_mut().spawn(standard.clone());
        if let Some(parent) = parent {
            mesh.insert((ChildOf(parent), RenderLayers::layer(3)));
        }
        mesh.id()
    });
    let camera = styled(&mut app, 0, 0.3);
    let lights = |app: &mut App, scope: StyleScope| {
        app.world_mut().entity_mut(camera).insert(scope);
        app.update();
        [within, beside].map(|mesh| highlight(app, mesh))
    };
    assert_eq!(lights(&mut app, StyleScope::Layers), [None, Some(0.3)]);
    let roots = StyleScope::Roots(vec![hero]);
    assert_eq!(lights(&mut app, roots), [Some(0.3), None]);
    assert_eq!(lights(&mut app, StyleScope::CameraOnly), [None, None]);
    app.world_mut().entity_mut(camera).remove::<StyleScope>();
    app.update();
    assert_eq!(highlight(&app, beside), Some(0.3));
}

#[test]
fn parts_of_a_camera_are_materials_by_name() {
    let mut app = app();
    let standard = MeshMaterial3d(add(&mut app, StandardMaterial::default()));
    let scene = StyleScene::new(lit(0.3).light).with_part("*eye*", lit(0.5).light);
    let camera = (Camera::default(), CameraScene(scene));
    let camera = app.world_mut().spawn(camera).id();
    let [eye, hair] = ["Left eye", "Hair"].map(|name| {
        let mesh = (standard.clone(), MaterialName::new(name));
        app.world_mut().spawn(mesh).id()
    });
    let shading = add(&mut app, ToonShading::new(lit(0.7).light));
    let lights = |app: &mut App| {
        app.update();
        [eye, hair].map(|mesh| highlight(app, mesh))
    };
    assert_eq!(lights(&mut app), [Some(0.5), Some(0.3)]);
    // A part has another light, another name, and is gone.
    let set = |app: &mut App, scene: StyleScene| {
        app.world_mut()
            .entity_mut(camera)
            .insert(CameraScene(scene));
    };
    let scene = StyleScene::new(lit(0.3).light);
    set(&mut app, scene.clone().with_part("*eye*", lit(0.6).light));
    assert_eq!(lights(&mut app), [Some(0.6), Some(0.3)]);
    set(&mut app, scene.clone().with_part("hair", lit(0.6).light));
    assert_eq!(lights(&mut app), [Some(0.3), Some(0.6)]);
    let own = ToonShadingHandle(shading);
    app.world_mut().entity_mut(hair).insert(own);
    assert_eq!(lights(&mut app), [Some(0.3), Some(0.7)]);
    app.world_mut()
        .entity_mut(hair)
        .remove::<ToonShadingHandle>();
    set(&mut app, scene);
    assert_eq!(lights(&mut app), [Some(0.3), Some(0.3)]);
}

#[test]
fn of_two_cameras_the_one_with_the_lower_order_lights_a_mesh() {
    let mut app = app();
    let standard = MeshMaterial3d(add(&mut app, StandardMaterial::default()));
    let mesh = app.world_mut().spawn(standard).id();
    let [first, second] = [(1, 0.1), (2, 0.2)].map(|(at, light)| styled(&mut app, at, light));
    let set = |app: &mut App, camera: Entity, settings: Camera| {
        app.world_mut().entity_mut(camera).insert(settings);
        app.update();
        highlight(app, mesh)
    };
    let at = |order| Camera { order, ..default() };
    assert_eq!(set(&mut app, first, at(1)), Some(0.1));
    assert_eq!(set(&mut app, first, at(3)), Some(0.2));
    let asleep = Camera {
        is_active: false,
        ..at(2)
    };
    assert_eq!(set(&mut app, second, asleep), Some(0.1));
    assert_eq!(set(&mut app, second, at(2)), Some(0.2));
    app.world_mut().despawn(second);
    app.update();
    assert_eq!(highlight(&app, mesh), Some(0.1));
}

#[test]
fn a_frame_without_changes_looks_at_no_mesh() {
    let mut app = App::new();
    app.add_systems(Update, find_meshes);
    build(&mut app);
    let camera = styled(&mut app, 0, 0.3);
    let material = MeshMaterial3d::<StandardMaterial>::default();
    let meshes: Vec<Entity> = (0..1000)
        .map(|_| app.world_mut().spawn(material.clone()).id())
        .collect();
    let found = |app: &mut App| {
        app.update();
        app.world().resource::<SceneChanges>().meshes.len()
    };
    assert_eq!(found(&mut app), 1000);
    assert_eq!(found(&mut app), 0);
    let changed = CameraScene(StyleScene::new(lit(0.4).light));
    app.world_mut().entity_mut(camera).insert(changed);
    assert_eq!(found(&mut app), 0, "a light is that of materials");
    let layer = RenderLayers::layer(2);
    app.world_mut().entity_mut(meshes[7]).insert(layer);
    assert_eq!(found(&mut app), 1);
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

#[cfg(feature = "objects")]
#[test]
fn the_first_camera_that_lights_any_mesh_of_a_hierarchy_gives_it_sections() {
    use crate::objects::MeshSections;

    let mut app = app();
    let after_search = add_components.after(find_meshes).before(follow_materials);
    app.add_systems(Update, after_search);
    let standard = MeshMaterial3d(add(&mut app, StandardMaterial::default()));
    let [first, second] = [(0, 45.0), (1, 60.0)].map(|(layer, angle)| {
        let order = layer as isize;
        let scene = StyleScene {
            sections: Some(angle),
            ..StyleScene::default()
        };
        let camera = Camera { order, ..default() };
        let layers = RenderLayers::layer(layer);
        let camera = (camera, layers, CameraScene(scene));
        app.world_mut().spawn(camera).id()
    });
    // A mesh and its two children.
    let unseen = 5;
    let mut hierarchy = |layers: [usize; 3]| {
        let [root, one, two] = layers.map(|layer| {
            let mesh = (standard.clone(), RenderLayers::layer(layer));
            app.world_mut().spawn(mesh).id()
        });
        app.world_mut().entity_mut(root).add_children(&[one, two]);
        [root, one, two]
    };
    let figures = [
        hierarchy([unseen, 0, 1]),
        hierarchy([unseen, 1, 0]),
        hierarchy([1, 1, unseen]),
        hierarchy([unseen, unseen, unseen]),
    ];
    let angles = |app: &mut App| {
        app.update();
        figures.map(|[root, ..]| {
            let sections = app.world().get::<MeshSections>(root);
            sections.map(|sections| sections.angle)
        })
    };
    let [low, high] = [45.0, 60.0].map(Some);
    assert_eq!(angles(&mut app), [low, low, high, None]);
    let put = |app: &mut App, mesh: Entity, layer: usize| {
        let layers = RenderLayers::layer(layer);
        app.world_mut().entity_mut(mesh).insert(layers);
    };

    // Single meshes are on other layers.
    put(&mut app, figures[0][0], unseen + 1);
    put(&mut app, figures[1][2], unseen);
    put(&mut app, figures[2][0], unseen);
    put(&mut app, figures[3][1], 1);
    assert_eq!(angles(&mut app), [low, high, high, high]);
    put(&mut app, figures[0][2], unseen);
    put(&mut app, figures[2][1], unseen);
    put(&mut app, figures[3][2], 0);
    assert_eq!(angles(&mut app), [low, high, None, low]);

    // The other camera comes first.
    let camera = Camera {
        order: -1,
        ..default()
    };
    app.world_mut().entity_mut(second).insert(camera);
    assert_eq!(angles(&mut app), [low, high, None, high]);
    app.world_mut().despawn(second);
    assert_eq!(angles(&mut app), [low, None, None, low]);
    app.world_mut().despawn(first);
    assert_eq!(angles(&mut app), [None; 4]);
}

#[cfg(feature = "objects")]
#[test]
fn sections_and_anchors_come_and_go_with_a_style() {
    use crate::objects::{MeshSections, PatternAnchor};

    let mut app = app();
    let after_search = add_components.after(find_meshes).before(follow_materials);
    app.add_systems(Update, after_search);
    let standard = MeshMaterial3d(add(&mut app, StandardMaterial::default()));
    let own = MeshSections { angle: 30.0 };
    let [root, sharp] = [None, Some(own)].map(|sections| {
        let mut root = app.world_mut().spawn_empty();
        if let Some(sections) = sections {
            root.insert(sections);
        }
        root.with_child(standard.clone()).id()
    });
    let scene = StyleScene {
        sections: Some(45.0),
        screens: true,
        ..StyleScene::default()
    };
    let camera = (Camera::default(), CameraScene(scene.clone()));
    let camera = app.world_mut().spawn(camera).id();
    app.update();
    let found = |app: &App, root: Entity| {
        let root = app.world().entity(root);
        let angle = root.get::<MeshSections>().map(|sections| sections.angle);
        (angle, root.get::<PatternAnchor>().copied())
    };
    let anchor = Some(PatternAnchor::default());
    assert_eq!(found(&app, root), (Some(45.0), anchor));
    assert_eq!(found(&app, sharp), (Some(30.0), anchor), "its own angle");

    // The style changes, an object comes, and one is put below another.
    let plain = StyleScene {
        sections: None,
        ..scene.clone()
    };
    app.world_mut()
        .entity_mut(camera)
        .insert(CameraScene(plain));
    app.update();
    assert_eq!(found(&app, root), (None, anchor));
    let late = app.world_mut().spawn(standard.clone()).id();
    app.update();
    assert_eq!(found(&app, late), (None, anchor));
    app.world_mut().entity_mut(late).insert(ChildOf(root));
    app.update();
    assert_eq!(found(&app, late), (None, None), "its figure has one");

    // What the game has changed stays when the style goes.
    let moved = PatternAnchor {
        center: Vec3::X,
        ..PatternAnchor::default()
    };
    app.world_mut().entity_mut(root).insert(moved);
    app.world_mut().entity_mut(camera).remove::<CameraScene>();
    app.update();
    assert_eq!(found(&app, root), (None, Some(moved)));
    assert_eq!(found(&app, sharp), (Some(30.0), None));
    let mut added = app.world_mut().query::<&AddedByStyle>();
    assert_eq!(added.iter(app.world()).count(), 0);
}
