//! Odd numbers in every field of a material.

use std::fmt::Write;

use bevy::{asset::Handle, shader::ShaderDefVal};

use super::{
    TonalArtMap, ToonLight,
    hatch::HatchUniform,
    uniform::{ToonKey, ToonUniform},
};
use crate::settings::tests::non_finite::{Numbers, cases, in_time, scramble, wrong};

/// Whatever the numbers of a material are, those that are used are in their ranges, and those that
/// are packed for the GPU are finite and the same.
#[test]
fn any_number_of_a_material_is_clamped() {
    let mut numbers = Numbers::new(2);
    let mut text = String::new();
    let others = ["VERTEX_UVS_A", "VERTEX_COLORS", "DEPTH_PREPASS"].map(ShaderDefVal::from);
    for _ in 0..cases() {
        let mut light = ToonLight {
            art_map: Some(Handle::default()),
            ..ToonLight::default()
        };
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
