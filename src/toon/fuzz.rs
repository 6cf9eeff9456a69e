//! Odd numbers in every field of a material.

use std::fmt::Write;

use bevy::{asset::Handle, math::Vec3, shader::ShaderDefVal};

use super::{
    DetailAxis, ProxyShape, Ramp, RampDetail, RampStop, Rim, RimWidth, ShadingProxy,
    StylizedHighlight, TonalArtMap, ToonLight,
    hatch::HatchUniform,
    uniform::{ToonKey, ToonUniform},
};
use crate::{
    effects::Hatching,
    settings::tests::non_finite::{Numbers, cases, in_time, scramble, wrong},
};

fn axis(numbers: &mut Numbers) -> DetailAxis {
    match numbers.below(6) {
        0 => DetailAxis::default(),
        1 => DetailAxis::Focus {
            distance: 5.0,
            clear: 0.15,
            ratio: 3.0,
        },
        2 => DetailAxis::Rim { power: 1.0 },
        3 => DetailAxis::Highlight { power: 20.0 },
        4 => DetailAxis::Constant(1.0),
        _ => DetailAxis::VisibleRange,
    }
}

fn shape(numbers: &mut Numbers) -> ProxyShape {
    let (center, half_size) = (Vec3::ZERO, Vec3::ONE);
    match numbers.below(4) {
        0 => ProxyShape::Up,
        1 => ProxyShape::Ellipsoid { center, half_size },
        2 => ProxyShape::Cylinder { center, half_size },
        _ => ProxyShape::Smoothed { rounds: 1 },
    }
}

fn stops(numbers: &mut Numbers) -> Vec<RampStop> {
    vec![RampStop::default(); numbers.below(20)]
}

/// A light with everything that a light can have, of any kind.
fn everything(numbers: &mut Numbers) -> ToonLight {
    let detail = (numbers.below(2) == 0).then(|| RampDetail {
        plain: stops(numbers),
        axis: axis(numbers),
    });
    let width = match numbers.below(2) {
        0 => RimWidth::Pixels(3.0),
        _ => RimWidth::default(),
    };
    ToonLight {
        ramp: Some(Ramp {
            stops: stops(numbers),
            detail,
            ..Ramp::default()
        }),
        stylized_highlight: Some(StylizedHighlight::default()),
        proxy: Some(ShadingProxy {
            shape: shape(numbers),
            ..ShadingProxy::default()
        }),
        rim: Some(Rim {
            width,
            ..Rim::default()
        }),
        hatching: Some(Hatching::default()),
        art_map: (numbers.below(2) == 0).then(Handle::default),
        ..ToonLight::default()
    }
}

/// Whatever the numbers of a material are, those that are used are in their ranges, and those that
/// are packed for the GPU are finite and the same.
#[test]
fn any_number_of_a_material_is_clamped() {
    let mut numbers = Numbers::new(2);
    let mut text = String::new();
    let others = ["VERTEX_UVS_A", "VERTEX_COLORS", "DEPTH_PREPASS"].map(ShaderDefVal::from);
    for _ in 0..cases() {
        let mut light = everything(&mut numbers);
        scramble(&mut light, &mut numbers);
        let (used, uniform, strokes, key, definitions) = in_time(&light, || {
            let key = ToonKey::from(&light);
            let definitions = key.definitions(&others, true);
            (
                light.clone().sanitized(),
                ToonUniform::from(&light),
                HatchUniform::from(&light),
                key,
                definitions,
            )
        });
        assert_eq!(wrong(&used, None), None, "{light:?}");
        assert_eq!(used, used.clone().sanitized(), "{light:?}");
        assert_eq!(uniform, ToonUniform::from(&used), "{light:?}");
        assert_eq!(strokes, HatchUniform::from(&used), "{light:?}");
        assert_eq!(key, ToonKey::from(&used), "{light:?}");
        assert!(definitions.len() < 40, "{definitions:?}");
        text.clear();
        write!(text, "{uniform:?} {strokes:?}").expect("a String can always be written to");
        let is_finite = !text.contains("NaN") && !text.contains("inf");
        assert!(is_finite, "{light:?}: {text}");
    }
}

#[test]
fn any_number_of_an_art_map_is_clamped() {
    let mut numbers = Numbers::new(3);
    for _ in 0..cases() {
        let mut map = TonalArtMap::default();
        scramble(&mut map, &mut numbers);
        let used = in_time(&map, || map.sanitized());
        assert_eq!(wrong(&used, None), None, "{map:?}");
        assert_eq!(used, used.sanitized(), "{map:?}");
        assert!((16..=1024).contains(&used.size), "{map:?}");
    }
}
