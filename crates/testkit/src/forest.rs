//! A forest that is seen from afar: hundreds of trees, each of some pixels.

use bevy::prelude::*;

use crate::scenes::{
    mountains::{broadleaf, conifer},
    noise::Random,
    shape::rgb,
};

/// Meters between a camera and the forest in its pictures.
pub const DISTANCE: f32 = 500.0;
/// Half of the width and of the depth of the forest, in meters.
const HALF: Vec2 = Vec2::new(150.0, 60.0);
const TREES: usize = 1500;

/// The meshes of six kinds of tree, and where trees of each kind stand, on the ground around the
/// origin. Trees are 5 to 9 meters high, as the forest of a far hill, and the same in every run.
pub fn forest() -> Vec<(Mesh, Vec<Transform>)> {
    let mut random = Random::new(14);
    let leaf = rgb(0x4f8f3a);
    let kinds = (0..6).map(|i| match i {
        0..4 => conifer(&mut random),
        _ => broadleaf(&mut random, leaf),
    });
    let kinds: Vec<Mesh> = kinds.map(|shape| shape.into_mesh()).collect();
    let mut places = vec![Vec::new(); kinds.len()];
    for i in 0..TREES {
        let x = random.range(-HALF.x, HALF.x);
        let z = random.range(-HALF.y, HALF.y);
        let turn = Quat::from_rotation_y(random.range(0.0, 6.0));
        let at = Transform::from_xyz(x, 0.0, z)
            .with_rotation(turn)
            .with_scale(Vec3::splat(random.range(0.9, 1.6)));
        places[i % kinds.len()].push(at);
    }
    kinds.into_iter().zip(places).collect()
}

/// A view of the forest from its distance, slightly from above, and its field of view in radians:
/// the forest fills the width of a picture of 16:9.
pub fn view() -> (Transform, f32) {
    let eye = Vec3::new(0.0, 70.0, DISTANCE);
    (
        Transform::from_translation(eye).looking_at(Vec3::Y * 3.0, Vec3::Y),
        0.3,
    )
}
