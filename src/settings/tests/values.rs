//! Clamps that do not follow from the range of a field alone, and expected values by hand.

use bevy::prelude::*;

use super::non_finite::{Numbers, cases};
use crate::{
    BlackFlats, DepthLayers, DepthMap, DepthMapping, Effect, IsoLines, Outlines, SpeedLines,
    effects::DepthLayer,
    lines::{Creases, EdgeColor, EdgeStyle, LineColor, LineFog},
};

const NAN: f32 = f32::NAN;

#[test]
fn components_of_vectors_are_clamped_each() {
    let lines = SpeedLines {
        center: Vec2::new(-7.0, NAN),
        ..SpeedLines::default()
    };
    let center = Vec2::new(-1.0, SpeedLines::default().center.y);
    assert_eq!(lines.sanitized().center, center);
    let iso_lines = IsoLines {
        center: Vec3::new(-1e9, NAN, 1e9),
        ..IsoLines::default()
    };
    assert_eq!(iso_lines.sanitized().center, Vec3::new(-1e6, 0.0, 1e6));
}

#[test]
fn numbers_of_variants_and_options_become_their_defaults() {
    let lines = |darken, saturate, distance, edge: EdgeStyle| Outlines {
        color: LineColor::Surface { darken, saturate },
        fog: LineFog::Visibility { distance },
        creases: Some(Creases {
            convex: Some(edge),
            ..Creases::default()
        }),
        ..Outlines::default()
    };
    let edge = |lighten, saturate, rest| EdgeStyle {
        color: EdgeColor::Surface { lighten, saturate },
        width: rest,
        opacity: rest,
        unlit_opacity: rest,
    };
    assert_eq!(
        lines(NAN, NAN, NAN, edge(NAN, NAN, NAN)).sanitized(),
        lines(0.35, 1.2, 1000.0, edge(0.35, 1.0, 1.0))
    );
    let ink = |red| EdgeStyle {
        color: EdgeColor::Ink {
            color: Color::linear_rgb(red, 0.0, 0.0),
        },
        ..EdgeStyle::HIGHLIGHT
    };
    assert_eq!(ink(2.0).sanitized(), ink(1.0));
    let flats = |slope, value| BlackFlats {
        slope: Some(slope),
        value: Some(value),
        ..BlackFlats::default()
    };
    assert_eq!(flats(NAN, NAN).sanitized(), flats(0.02, 0.25));
    let layer = DepthLayer {
        saturation: NAN,
        tint_amount: NAN,
        contrast: NAN,
        brightness: NAN,
        line_width: NAN,
        line_opacity: NAN,
        line_color_amount: NAN,
        hatching: NAN,
        halftone: NAN,
        ..DepthLayer::PLAIN
    };
    let layers = DepthLayers {
        background: layer,
        ..DepthLayers::default()
    };
    assert_eq!(layers.sanitized().background, DepthLayer::PLAIN);
}

fn fixed(from: f32, to: f32) -> DepthMap {
    DepthMap {
        mapping: DepthMapping::Fixed { from, to },
        ..DepthMap::default()
    }
}

#[test]
fn a_sky_at_no_distance_is_nowhere() {
    for (distance, used) in [(NAN, None), (f32::INFINITY, None), (-1.0, Some(0.001))] {
        let map = DepthMap {
            sky_beyond: Some(distance),
            ..DepthMap::default()
        };
        assert_eq!(map.sanitized().sky_beyond, used, "{distance}");
    }
}

#[test]
fn near_and_far_are_in_order_and_apart() {
    assert_eq!(fixed(NAN, NAN).sanitized(), fixed(0.1, 1000.0));
    assert_eq!(fixed(8.0, 2.0).sanitized(), fixed(2.0, 8.0));
    assert_eq!(fixed(-1.0, f32::MAX).sanitized(), fixed(1e-6, 1e36));
    assert_eq!(fixed(1.0, 1.0).sanitized(), fixed(1.0, 1.001));
    let mut numbers = Numbers::new(4);
    for _ in 0..cases() {
        let [a, b] = [numbers.float(), numbers.float()];
        let DepthMapping::Fixed { from, to } = fixed(a, b).sanitized().mapping else {
            panic!("the mapping changed its kind");
        };
        let is_ordered = from > 0.0 && to > from && to.is_finite();
        assert!(is_ordered, "{a}, {b}: {from}, {to}");
    }
}

#[cfg(all(feature = "toon", feature = "objects"))]
mod components_and_materials {
    use super::*;
    use crate::{
        MotionLines, OutlineStyle,
        objects::ObjectSimplification,
        toon::{DetailAxis, ProxyShape, Ramp, RampDetail, Rim, RimWidth, ShadingProxy},
    };

    #[test]
    fn numbers_of_variants_and_options_become_their_defaults() {
        let odd = OutlineStyle {
            color: Some(Color::linear_rgb(NAN, 1.0, 1.0)),
            width: Some(NAN),
            opacity: Some(NAN),
            ..OutlineStyle::default()
        };
        let used = OutlineStyle {
            color: Some(Color::BLACK),
            width: Some(2.0),
            opacity: Some(1.0),
            ..OutlineStyle::default()
        };
        assert_eq!(odd.sanitized(), used);
        let lines = MotionLines {
            points: u32::MAX,
            ..MotionLines::default()
        };
        assert_eq!(lines.sanitized().points, MotionLines::MOST_POINTS);
        let level = ObjectSimplification::fixed(NAN).sanitized().level;
        assert_eq!(level, Some(0.0));
        let width = |width| Rim {
            width,
            ..Rim::default()
        };
        assert_eq!(
            width(RimWidth::Pixels(NAN)).sanitized(),
            width(RimWidth::Pixels(3.0))
        );
        let shape = |center, half_size| ShadingProxy {
            shape: ProxyShape::Cylinder { center, half_size },
            ..ShadingProxy::default()
        };
        assert_eq!(
            shape(Vec3::NAN, Vec3::NAN).sanitized(),
            shape(Vec3::ZERO, Vec3::ONE)
        );
        let depth = |from, ratio| DetailAxis::Depth { from, ratio };
        let focus = |distance, clear, ratio| DetailAxis::Focus {
            distance,
            clear,
            ratio,
        };
        for (odd, used) in [
            (depth(NAN, NAN), depth(1.0, 10.0)),
            (focus(NAN, NAN, NAN), focus(5.0, 0.15, 3.0)),
            (
                DetailAxis::Rim { power: NAN },
                DetailAxis::Rim { power: 1.0 },
            ),
            (
                DetailAxis::Highlight { power: NAN },
                DetailAxis::Highlight { power: 20.0 },
            ),
            (DetailAxis::Constant(NAN), DetailAxis::Constant(1.0)),
        ] {
            let ramp = Ramp {
                detail: Some(RampDetail {
                    axis: odd,
                    ..RampDetail::default()
                }),
                ..Ramp::default()
            };
            let detail = ramp.sanitized().detail.expect("a second ramp");
            assert_eq!(detail.axis, used);
        }
    }
}
