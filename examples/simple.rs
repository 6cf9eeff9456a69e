//! The smallest comic: the first program of the README.

use bevy::prelude::*;
use bevy_comics::prelude::*;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, ComicsPlugin))
        .add_systems(Startup, setup)
        .run();
}

fn setup(mut commands: Commands, assets: Res<AssetServer>) {
    let from = |x, y, z| Transform::from_xyz(x, y, z).looking_at(Vec3::ZERO, Vec3::Y);
    commands.spawn((
        Camera3d::default(),
        from(0.0, 13.0, 11.0),
        Outlines::default(),
    ));
    let sun = DirectionalLight {
        shadow_maps_enabled: true,
        ..default()
    };
    commands.spawn((sun, from(8.0, 9.0, 3.0)));
    for i in (0..300).map(|i| i as f32) {
        let at = Transform::from_translation(Quat::from_rotation_y(2.4 * i) * Vec3::Z * i.sqrt());
        let mesh = assets.add(Cylinder::new(0.75, 3.0 + i.sqrt().cos()).mesh().build());
        let paint = assets.add(StandardMaterial::from(Color::oklch(0.72, 0.15, 137.5 * i)));
        commands.spawn((
            Mesh3d(mesh),
            MeshMaterial3d(paint),
            at,
            CartoonScene::default(),
        ));
    }
}
