//! Reference of `effect/similarity.wgsl`.

use bevy::math::{DMat4, DQuat, DVec2, DVec3};

/// How something on the page follows an object.
#[derive(Clone, Copy, Debug)]
pub struct Similarity {
    /// Pixels of the render target.
    pub origin: [f64; 2],
    /// Clockwise, in degrees.
    pub turn: f64,
    pub size: f64,
    pub other: f64,
    pub fade: f64,
}

/// The apparent size of an object in octaves, from half the height of the view.
fn octaves(clip_from_world: DMat4, w: f64, size: f64) -> f64 {
    (size * clip_from_world.row(1).truncate().length() / w).log2()
}

/// `None` behind the camera. `viewport`: x, y, width, height.
pub fn similarity_of(
    clip_from_world: DMat4,
    viewport: [f64; 4],
    center: DVec3,
    size: f64,
    rotation: DQuat,
) -> Option<Similarity> {
    let clip = clip_from_world * center.extend(1.0);
    if clip.w <= 0.0 {
        return None;
    }
    let [left, top, width, height] = viewport;
    // Pixels of the page, downwards.
    let page = |v: DVec2| DVec2::new(0.5 * width * v.x, -0.5 * height * v.y);
    let origin = DVec2::new(left + 0.5 * width, top + 0.5 * height)
        + page(clip.truncate().truncate() / clip.w);
    let seen = |axis: DVec3| {
        let seen = clip_from_world * (rotation * axis).extend(0.0);
        page(seen.truncate().truncate())
    };
    let scale = clip_from_world.row(1).truncate().length() * 0.5 * height;
    let upward = seen(DVec3::Y);
    let axis = if upward.length() > 0.1 * scale {
        upward
    } else {
        seen(DVec3::NEG_Z)
    };
    let octave = octaves(clip_from_world, clip.w, size);
    let inside = octave - octave.round();
    let next = if inside > 0.0 {
        inside - 1.0
    } else {
        inside + 1.0
    };
    let beyond = (inside.abs().exp2() - 1.3) / (2f64.sqrt() - 1.3);
    Some(Similarity {
        origin: origin.to_array(),
        turn: axis.x.atan2(-axis.y).to_degrees(),
        size: inside.exp2(),
        other: next.exp2(),
        fade: 0.5 * beyond.clamp(0.0, 1.0),
    })
}
