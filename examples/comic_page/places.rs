//! The places of the story and the cameras of its panels. Every place is on a render layer of its
//! own, so that all can be at the origin.

use bevy::{
    camera::{ImageRenderTarget, RenderTarget, visibility::RenderLayers},
    ecs::system::RunSystemOnce,
    prelude::*,
    render::{render_resource::TextureFormat, view::Msaa},
};
use bevy_comics::{
    ComicStyle, OutlineGroup, Outlines, SpeedLines, ToonScene, effects::SpeedLineKind, presets,
};
use bevy_comics_testkit::{
    headless::new_target,
    scenes::{BuiltIn, ScenePart, Stage, ToonPart, Vantage, paper_plane::paper_plane},
    studio::set_style,
};

use crate::page::PANELS;

/// What a panel shows.
pub struct View {
    pub scene: BuiltIn,
    /// Position and target of the camera.
    eye: Vec3,
    target: Vec3,
    /// Where the paper plane is, seen from the camera, and how large it is.
    plane: Option<(Vec3, f32)>,
    style: fn() -> ComicStyle,
}

const fn v(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

/// The panels' views, in the order of the page.
pub const VIEWS: [View; PANELS] = [
    View {
        scene: BuiltIn::Village,
        eye: v(2.2, 6.4, 31.0),
        target: v(-0.8, 4.6, -14.0),
        plane: Some((v(2.4, 1.1, -9.0), 0.5)),
        style: || presets::SILVER_AGE.style(),
    },
    View {
        scene: BuiltIn::Figure,
        eye: v(-0.1, -0.05, 9.1),
        target: v(-0.1, -0.12, 0.0),
        plane: None,
        style: || presets::SATURDAY_MORNING.style(),
    },
    View {
        scene: BuiltIn::Village,
        eye: v(-16.0, 26.0, -70.0),
        target: v(-9.0, 7.0, -134.0),
        plane: Some((v(0.85, -0.8, -6.0), 0.8)),
        style: || {
            presets::GRAPHIC_NOVEL.style().with(SpeedLines {
                kind: SpeedLineKind::Radial,
                inner: 0.7,
                width: 4.0,
                ..default()
            })
        },
    },
    View {
        scene: BuiltIn::Mountains,
        eye: v(0.0, 16.0, 20.0),
        target: v(-2.0, 24.0, -60.0),
        plane: Some((v(1.2, 0.9, -9.0), 0.5)),
        style: || presets::GOLDEN_HOUR.style().with(Outlines::default()),
    },
    View {
        scene: BuiltIn::Street,
        eye: v(0.3, 2.5, 10.2),
        target: v(-0.2, 3.4, -8.0),
        plane: Some((v(0.9, 0.75, -5.2), 0.34)),
        style: || presets::COBALT_NIGHT.style().with(Outlines::default()),
    },
];

/// The layer of the first panel's plane.
const PLANES: usize = 16;

/// The pictures of the panels.
#[derive(Resource)]
pub struct Pictures(pub Vec<Handle<Image>>);

/// Builds every place once, and a camera for every panel.
pub fn spawn(world: &mut World) {
    let mut places: Vec<(BuiltIn, Vantage, AmbientLight)> = Vec::new();
    let mut pictures = Vec::new();
    for (panel, view) in VIEWS.iter().enumerate() {
        let known = places.iter().position(|(scene, ..)| *scene == view.scene);
        let place = known.unwrap_or_else(|| {
            places.push(build(world, view.scene, places.len() + 1));
            places.len() - 1
        });
        let (_, vantage, ambient) = &places[place];
        // Every panel has a plane of its own, which the others do not show.
        let own = PLANES + panel;
        let layers = RenderLayers::layer(place + 1).with(own);
        let size = crate::page::picture_size(panel);
        let picture = new_target(world, size, TextureFormat::Rgba8UnormSrgb);
        pictures.push(picture.clone());
        let target = RenderTarget::Image(ImageRenderTarget {
            handle: picture,
            scale_factor: 1.0,
        });
        let at = Transform::from_translation(view.eye).looking_at(view.target, Vec3::Y);
        let order = Camera {
            order: panel as isize - 20,
            ..default()
        };
        let mut camera = world.spawn((vantage.camera(), order, target, Msaa::Sample4));
        camera.insert((at, layers, ambient.clone()));
        let camera = camera.id();
        set_style(&mut world.commands().entity(camera), &(view.style)());
        if let Some((from_eye, size)) = view.plane {
            fold_plane(world, at, from_eye, size, RenderLayers::layer(own));
        }
    }
    world.flush();
    world.insert_resource(Pictures(pictures));
}

/// Builds a scene on a layer, with the toon material.
fn build(world: &mut World, scene: BuiltIn, layer: usize) -> (BuiltIn, Vantage, AmbientLight) {
    let spawned = world.run_system_once(move |mut stage: Stage| stage.spawn(scene));
    let vantage = spawned.expect("the stage is there");
    let mut roots = world
        .query_filtered::<Entity, (With<ScenePart>, Without<ChildOf>, Without<RenderLayers>)>();
    let roots: Vec<Entity> = roots.iter(world).collect();
    // The tiles of the ground are one object: there are no lines between them.
    let whole = (OutlineGroup, Transform::IDENTITY, Visibility::default());
    let whole = (scene == BuiltIn::Mountains).then(|| world.spawn(whole).id());
    for root in roots {
        let look = world.get::<ToonPart>(root).cloned().unwrap_or_default();
        world.entity_mut(root).insert(look.0);
        put_on_layer(world, root, layer);
        if let Some(whole) = whole {
            world.entity_mut(root).insert(ChildOf(whole));
        }
    }
    // Every scene sets the light from all sides: it becomes that of its cameras.
    let all = world.resource::<GlobalAmbientLight>();
    let ambient = AmbientLight {
        color: all.color,
        brightness: all.brightness,
        ..default()
    };
    (scene, vantage, ambient)
}

/// Puts an entity and all below it on a layer.
fn put_on_layer(world: &mut World, entity: Entity, layer: usize) {
    let children = world.get::<Children>(entity);
    let children: Vec<Entity> = children.into_iter().flat_map(|c| c.iter()).collect();
    world.entity_mut(entity).insert(RenderLayers::layer(layer));
    for child in children {
        put_on_layer(world, child, layer);
    }
}

/// The paper plane of the story, which flies away from the camera and to the left.
fn fold_plane(world: &mut World, eye: Transform, from_eye: Vec3, size: f32, layer: RenderLayers) {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(paper_plane());
    let paper = StandardMaterial {
        double_sided: true,
        cull_mode: None,
        perceptual_roughness: 0.9,
        emissive: LinearRgba::gray(0.3),
        ..default()
    };
    let paper = world.resource_mut::<Assets<StandardMaterial>>().add(paper);
    let turn = Quat::from_euler(EulerRot::YXZ, 0.75, 0.2, 0.5);
    let place = Transform::from_translation(from_eye).with_rotation(turn);
    world.spawn((
        Mesh3d(mesh),
        MeshMaterial3d(paper),
        ToonScene::default(),
        eye * place.with_scale(Vec3::splat(size)),
        layer,
    ));
}
