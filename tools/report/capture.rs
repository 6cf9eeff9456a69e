//! Depth and picture of a view, for what is computed on the CPU.

use bevy::render::RenderApp;
use bevy_comics::{Colorization, ComicStyle, Desaturation, effects::Equations};

use bevy_comics_testkit::{
    read_back,
    reference::{
        color::{srgb_decode, srgb_encode},
        colorization, desaturation,
        map::{Frame, Projection as MapProjection},
    },
};

use crate::rig::Rig;

pub struct Shot {
    /// Raw reversed depth of an infinite perspective view, row by row.
    pub depth: Vec<f32>,
    /// The unstyled, tonemapped picture in linear light, row by row.
    pub picture: Vec<[f64; 3]>,
}

impl Shot {
    /// Raw depth of the nearest and farthest geometry; `None` without any.
    pub fn ends(&self) -> Option<[f32; 2]> {
        bevy_comics_testkit::reference::range::scan(self.depth.iter().copied())
            .map(|bits| bits.map(f32::from_bits))
    }
}

/// Renders a frame and reads it back.
pub fn shoot(rig: &mut Rig) -> Shot {
    rig.headless.step(1);
    let view = rig.view();
    let picture = rig.headless.picture();
    let world = rig.headless.app.sub_app(RenderApp).world();
    let depth = read_back::depth(world, view).expect("a prepass");
    Shot {
        depth: depth.bits.iter().map(|b| f32::from_bits(*b)).collect(),
        picture: picture
            .pixels()
            .map(|p| srgb_decode([0, 1, 2].map(|i| f64::from(p.0[i]) / 255.0)))
            .collect(),
    }
}

/// The linear min-max map between two raw depths of an infinite perspective view.
pub fn frame(ends: [f64; 2]) -> Frame {
    Frame {
        projection: MapProjection::Perspective { offset: 0.0 },
        ends: Some(ends),
        logarithmic: false,
        floor: 1.0 / 16384.0,
        sky_gap: 0.05,
    }
}

/// The style in which errors of the map are judged: the corrected equations of [CS] Eq. 6 and
/// 11 at full strength.
pub fn look() -> ComicStyle {
    ComicStyle::new()
        .with(Desaturation {
            equations: Equations::Corrected,
            ..Desaturation::default()
        })
        .with(Colorization::default())
}

/// Display codes of a pixel in that style. `light`: linear; then D and its complement.
pub fn styled(style: &ComicStyle, light: [f64; 3], [d, l]: [f64; 2]) -> [u8; 3] {
    let mut linear = light;
    let mut saturation = 1.0;
    if let Some(s) = style.get::<Desaturation>() {
        saturation = desaturation::saturation_left(s, l);
        linear = desaturation::desaturate(s, linear, saturation);
    }
    if let Some(s) = style.get::<Colorization>() {
        linear = colorization::colorize(s, linear, d, l, saturation);
    }
    srgb_encode(linear).map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}
