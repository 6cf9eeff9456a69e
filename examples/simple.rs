// The first program of the README.

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
    let eye = from(0.0, 12.0, 10.0);
    commands.spawn((Camera3d::default(), eye, presets::SATURDAY_MORNING.comic()));

    let sun = DirectionalLight {
        shadow_maps_enabled: true,
        ..default()
    };
    commands.spawn((sun, from(8.0, 9.0, 3.0)));

    for i in (0..300).map(|i| i as f32) {
        let mesh = Mesh::from(Cylinder::new(0.75, 3.0 + i.sqrt().cos()));
        let paint = StandardMaterial::from(Color::oklch(0.72, 0.15, 137.5 * i));
        let place = Quat::from_rotation_y(2.4 * i) * Vec3::Z * i.sqrt();
        commands.spawn((
            Mesh3d(assets.add(mesh)),
            MeshMaterial3d(assets.add(paint)),
            Transform::from_translation(place),
        ));
    }
}
