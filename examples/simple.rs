//! The smallest comic: the README's lines and something to look at.

use bevy::prelude::*;
use bevy_comics::prelude::*;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, ComicsPlugin))
        .add_systems(Startup, setup)
        .run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        Camera3d::default(),
        Transform::from_xyz(4.0, 3.0, 7.0).looking_at(Vec3::Y, Vec3::Y),
        Contours::default(),
        Desaturation::default(),
    ));
    commands.spawn((
        DirectionalLight {
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_xyz(3.0, 6.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let ground = meshes.add(Plane3d::default().mesh().size(30.0, 30.0));
    commands.spawn((
        Mesh3d(ground),
        MeshMaterial3d(materials.add(Color::srgb(0.85, 0.75, 0.5))),
    ));
    for i in 0..12 {
        let (angle, hue) = (i as f32 * 1.9, i as f32 * 30.0);
        let at = Vec3::new(angle.sin() * i as f32 * 0.8, 0.75, 2.0 - i as f32);
        commands.spawn((
            Mesh3d(meshes.add(Sphere::new(0.75))),
            MeshMaterial3d(materials.add(Color::hsl(hue, 0.8, 0.55))),
            Transform::from_translation(at),
        ));
    }
}
