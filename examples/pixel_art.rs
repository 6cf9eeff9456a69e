//! Pixel art: a comic of 320x180 pixels with lines of whole pixels, shown with hard pixels, as
//! large as fits.

use bevy::{
    camera::{OrthographicProjection, RenderTarget, ScalingMode},
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    image::{Image, ImagePlugin},
    prelude::*,
    render::{render_resource::TextureFormat, view::Msaa},
};
use bevy_comics::prelude::*;

/// Width and height of the picture in its own pixels.
const SIZE: UVec2 = UVec2::new(320, 180);
/// Pixels per unit of the world.
const PIXELS: f32 = 24.0;

/// What turns, in radians per second.
#[derive(Component)]
struct Turns(f32);

fn main() {
    App::new()
        .add_plugins((
            DefaultPlugins.set(ImagePlugin::default_nearest()),
            ComicsPlugin,
        ))
        .insert_resource(ClearColor(Color::BLACK))
        .add_systems(Startup, (picture, scene))
        .add_systems(Update, (fit, turn, pan))
        .run();
}

/// The camera that draws the picture, and the one that shows it.
fn picture(mut commands: Commands, mut images: ResMut<Assets<Image>>, assets: Res<AssetServer>) {
    let format = TextureFormat::Rgba8UnormSrgb;
    let image = images.add(Image::new_target_texture(SIZE.x, SIZE.y, format, None));
    commands.spawn((
        Camera3d::default(),
        Camera {
            order: -1,
            clear_color: Color::srgb(0.44, 0.6, 0.75).into(),
            ..default()
        },
        RenderTarget::from(image.clone()),
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: SIZE.y as f32 / PIXELS,
            },
            ..OrthographicProjection::default_3d()
        }),
        // No grays at edges, and no dither between two tones.
        (Msaa::Off, Tonemapping::None, DebandDither::Disabled),
        Comic(assets.load(presets::PIXEL.path())),
    ));
    commands.spawn((Camera2d, Msaa::Off));
    commands.spawn(Sprite::from_image(image));
}

/// Shows every pixel of the picture as a square of whole pixels of the window.
fn fit(window: Single<&Window>, mut sprite: Single<&mut Transform, With<Sprite>>) {
    let times = (window.physical_size().as_vec2() / SIZE.as_vec2()).min_element();
    let scale = times.floor().max(1.0) / window.scale_factor();
    sprite.scale = Vec3::new(scale, scale, 1.0);
}

/// Moves the camera to and fro, by whole pixels of the picture, so that nothing at rest changes.
fn pan(time: Res<Time>, mut camera: Single<&mut Transform, With<Camera3d>>) {
    let view = Transform::from_xyz(6.0, 6.0, 9.0).looking_at(Vec3::Y, Vec3::Y);
    let pixels = (PIXELS * (0.4 * time.elapsed_secs()).sin()).round();
    **camera = view.with_translation(view.translation + pixels / PIXELS * view.right());
}

fn turn(time: Res<Time>, mut turning: Query<(&Turns, &mut Transform)>) {
    for (turns, mut at) in &mut turning {
        at.rotate_y(turns.0 * time.delta_secs());
    }
}

fn scene(mut commands: Commands, assets: Res<AssetServer>) {
    commands.spawn((
        DirectionalLight {
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_xyz(2.0, 8.0, 6.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let mut put = |mesh: Mesh, color: Color, at: Vec3, turns: f32| {
        commands.spawn((
            Mesh3d(assets.add(mesh)),
            MeshMaterial3d(assets.add(StandardMaterial::from(color))),
            Transform::from_translation(at),
            Turns(turns),
        ));
    };
    let green = Color::srgb(0.45, 0.7, 0.35);
    put(
        Cuboid::new(9.0, 0.4, 7.0).into(),
        green,
        -0.2 * Vec3::Y,
        0.0,
    );
    let red = Color::srgb(0.85, 0.3, 0.25);
    put(
        Cuboid::new(1.6, 1.6, 1.6).into(),
        red,
        Vec3::new(-2.4, 0.8, 0.6),
        0.5,
    );
    let blue = Color::srgb(0.3, 0.45, 0.85);
    put(Sphere::new(0.9).into(), blue, Vec3::new(0.2, 0.9, 1.4), 0.0);
    let yellow = Color::srgb(0.95, 0.75, 0.3);
    put(
        Torus::new(0.5, 1.1).into(),
        yellow,
        Vec3::new(0.4, 1.9, -1.6),
        0.8,
    );
}
