//! Properties of the built-in scenes.

use bevy_comics_testkit::scenes::teapot;

#[test]
fn the_teapot_is_32_patches_that_close() {
    let patches = teapot::patches();
    assert_eq!(patches.len(), 32);
    // The signed volume is positive: all triangles face outwards.
    let shape = teapot::mesh(6, [1.0; 4]);
    let volume: f32 = shape
        .indices
        .chunks_exact(3)
        .map(|t| {
            let [a, b, c] =
                [t[0], t[1], t[2]].map(|i| bevy::math::Vec3::from(shape.positions[i as usize]));
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    assert!(volume > 20.0, "{volume}");
}
