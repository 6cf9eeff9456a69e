//! Scenes of white walls before the sky.

use crate::prelude::*;

/// An orthographic projection with one unit per pixel.
pub fn unit_per_pixel(size: UVec2) -> OrthographicProjection {
    OrthographicProjection {
        scaling_mode: ScalingMode::Fixed {
            width: size.x as f32,
            height: size.y as f32,
        },
        ..OrthographicProjection::default_3d()
    }
}

/// An orthographic view towards the sky, one unit per pixel, its origin in the middle.
pub fn towards_the_sky(size: UVec2) -> Small {
    let mut small = Small::new(size, Msaa::Off);
    face_the_sky(&mut small);
    small
}

/// The same view in an app that has drawn something else, by a new camera.
pub fn towards_the_sky_again(small: &mut Small, msaa: Msaa) {
    small.restart(msaa);
    face_the_sky(small);
}

fn face_the_sky(small: &mut Small) {
    small.clear();
    let size = small.headless.options.size;
    small.insert((
        Transform::IDENTITY,
        Projection::Orthographic(unit_per_pixel(size)),
    ));
}

/// A wall at a distance, from its left and lower to its right and upper end.
pub fn wall(
    small: &mut Small,
    [left, bottom]: [f32; 2],
    [right, top]: [f32; 2],
    distance: f32,
) -> Entity {
    let middle = Vec3::new(0.5 * (left + right), 0.5 * (bottom + top), -distance);
    small.put(
        Rectangle::new(right - left, top - bottom),
        unlit(Color::WHITE),
        Transform::from_translation(middle),
    )
}
