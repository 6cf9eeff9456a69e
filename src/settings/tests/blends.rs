//! What lies between two values.

use bevy::prelude::*;

use super::places::{Place, components, is_color, made};
use crate::{
    BlackFlats, Colorization, ComicStyle, DepthLayers, DepthMap, DepthMapping, Effect, Outlines,
    depth::RangeSmoothing,
    effect::{AnyEffect, EffectRegistry, EffectType},
    effects::{DepthLayer, Equations, Granularity},
    lines::{LineBoil, LineColor, LineWeight, Silhouettes},
    settings::BlendField,
};

fn view(effect: &dyn AnyEffect) -> &dyn PartialReflect {
    effect.as_struct().as_partial_reflect()
}

/// Between each default and other numbers and colors, each field is what its attributes say.
#[test]
fn every_number_of_an_effect_is_blended_as_its_field_says() {
    for effect in EffectRegistry::built_in().types() {
        let a = (effect.default)();
        let mut b = a.clone();
        let places = Place::root(effect.name).all_below(view(&*a));
        for place in &places {
            change(place, b.as_struct_mut().as_partial_reflect_mut());
        }
        for t in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let found = (effect.blend)(Some(&*a), Some(&*b), t, false).expect("an effect");
            for place in &places {
                let ends = [&a, &b].map(|end| place.get(view(&**end)));
                assert_between(place, ends, place.get(view(&*found)), t);
            }
        }
    }
}

/// Changes a number, unless that would be another mode, or a color.
fn change(place: &Place, root: &mut dyn PartialReflect) {
    let field = place.get_mut(root);
    if is_color(field) {
        field.apply(&Color::linear_rgb(0.3, 0.3, 0.3));
        return;
    }
    let is_mode = place.blend().is_none() && field.try_downcast_ref::<u32>().is_some();
    let (low, high) = place.range().map_or((0.0, 1.0), |r| (r.min, r.max));
    let info = field.get_represented_type_info().expect("a type");
    if !is_mode && components(field).is_some() {
        let number = made(info, (low + 0.7 * (high - low)) as f32);
        field.apply(&*number.expect("a number"));
    }
}

fn assert_between(
    place: &Place,
    ends: [&dyn PartialReflect; 2],
    found: &dyn PartialReflect,
    t: f32,
) {
    let text = format!("{} at {t}: {found:?} between {ends:?}", place.name);
    if place.blend() == Some(BlendField::Switch) {
        let is = |end: &dyn PartialReflect| found.reflect_partial_eq(end) == Some(true);
        let [a, b] = ends.map(is);
        assert!((t <= 0.5 && a) || (t >= 0.5 && b), "{text}");
        return;
    }
    let is_mixture = is_color(found);
    let numbers = |value: &dyn PartialReflect| {
        let oklab = |color: &Color| Oklaba::from(*color).to_f32_array().to_vec();
        components(value).or_else(|| value.try_downcast_ref::<Color>().map(oklab))
    };
    let (Some(found), [Some(a), Some(b)]) = (numbers(found), ends.map(numbers)) else {
        return;
    };
    let by_ratio = found.len() == 1 && place.range().is_some_and(|range| range.logarithmic);
    for ((a, b), found) in a.into_iter().zip(b).zip(found) {
        let want = if by_ratio && a > 0.0 && b > 0.0 {
            a.powf(1.0 - t) * b.powf(t)
        } else {
            a + (b - a) * t
        };
        // Mixtures of colors are clamped to what a display shows.
        let tolerance = if is_mixture {
            0.02
        } else {
            1e-5 * (a.abs() + b.abs())
        };
        assert!((found - want).abs() <= tolerance, "{text}");
    }
}

fn between<E: Effect>(a: &E, b: &E, t: f32) -> E {
    let found = (EffectType::of::<E>().blend)(Some(a), Some(b), t, false);
    let found = found.expect("an effect").into_any();
    *found.downcast().expect("its type")
}

fn is_near(found: f32, want: f32) -> bool {
    (found - want).abs() < 1e-5 * want.abs()
}

#[test]
fn a_mode_changes_without_strength_and_a_switch_at_once() {
    let layers = |bands, granularity| DepthLayers {
        foreground: DepthLayer {
            bands,
            ..DepthLayer::PLAIN
        },
        granularity,
        ..DepthLayers::PLAIN
    };
    let plain = layers(0, Granularity::Object);
    for (t, bands) in [(0.25, 0), (0.75, 4)] {
        let found = between(&plain, &layers(4, Granularity::Object), t);
        assert_eq!((found.foreground.bands, found.amount), (bands, 1.0));
    }
    for (t, granularity) in [(0.25, Granularity::Object), (0.75, Granularity::Pixel)] {
        let found = between(&plain, &layers(0, Granularity::Pixel), t);
        assert_eq!((found.granularity, found.amount), (granularity, 0.5));
    }
    // Hues of the faithful equations are modes too.
    let colorization = |color| Colorization {
        color,
        equations: Equations::Faithful,
        ..Colorization::default()
    };
    let (red, blue) = (Color::srgb(1.0, 0.0, 0.0), Color::srgb(0.0, 0.0, 1.0));
    for (t, color) in [(0.25, red), (0.75, blue)] {
        let found = between(&colorization(red), &colorization(blue), t);
        assert_eq!((found.color, found.amount), (color, 0.5));
    }
}

#[test]
fn lines_are_blended_kind_by_kind() {
    let outlines = |amplitude, wavelength, color, equations| Outlines {
        silhouettes: Some(Silhouettes {
            equations,
            ..Silhouettes::default()
        }),
        boil: LineBoil {
            amplitude,
            wavelength,
            ..LineBoil::STILL
        },
        color,
        min_length: wavelength as u32,
        weight: LineWeight {
            pressure_length: wavelength,
            ..LineWeight::EVEN
        },
        ..Outlines::default()
    };
    let a = outlines(1.0, 20.0, LineColor::Ink, Equations::Corrected);
    let b = outlines(3.0, 80.0, LineColor::SURFACE, Equations::Faithful);
    for (t, amplitude, end) in [(0.25, 1.5, a), (0.75, 2.5, b)] {
        let found = between(&a, &b, t);
        let silhouettes = found.silhouettes.expect("silhouettes");
        assert_eq!(
            (silhouettes.opacity, found.boil.amplitude),
            (0.5, amplitude)
        );
        let modes = |o: &Outlines| (o.color, o.boil.wavelength, o.min_length);
        assert_eq!(modes(&found), modes(&end), "{t}");
        let equations = end.silhouettes.map(|s| s.equations);
        assert_eq!(Some(silhouettes.equations), equations, "{t}");
        assert_eq!(found.creases, a.creases);
    }
    let length = between(&a, &b, 0.5).weight.pressure_length;
    assert!(is_near(length, 40.0), "{length}");
    let darker = |darken| {
        let saturate = 1.0;
        let color = LineColor::Surface { darken, saturate };
        outlines(0.0, 20.0, color, Equations::Corrected)
    };
    let found = between(&darker(0.2), &darker(0.6), 0.25).color.factors();
    assert!(is_near(found[0], 0.3) && found[1] == 1.0, "{found:?}");
}

#[test]
fn thresholds_of_flats_come_and_go() {
    let flats = |slope, value| BlackFlats {
        slope,
        value,
        ..BlackFlats::default()
    };
    let found = between(&flats(Some(0.01), None), &flats(Some(0.04), Some(0.4)), 0.5);
    let (slope, value) = (found.slope.expect("a slope"), found.value.expect("a value"));
    assert!(is_near(slope, 0.02) && is_near(value, 0.2), "{found:?}");
    assert_eq!(found.opacity, 1.0);
    for (t, slope) in [(0.25, None), (0.75, Some(0.04))] {
        let found = between(&flats(None, None), &flats(Some(0.04), None), t);
        assert_eq!((found.slope, found.opacity), (slope, 0.5));
    }
}

#[test]
fn a_depth_map_is_blended_with_its_smoothing() {
    let style = |mapping, smoothing| {
        ComicStyle::new().with_depth_map(DepthMap {
            mapping,
            smoothing,
            ..DepthMap::default()
        })
    };
    let fixed = |from, to| DepthMapping::Fixed { from, to };
    let a = style(fixed(1.0, 100.0), None);
    let b = style(fixed(4.0, 400.0), Some(RangeSmoothing::default()));
    let map = |b: &ComicStyle, t| a.blend(b, t).depth_map.expect("a map");
    let DepthMapping::Fixed { from, to } = map(&b, 0.5).mapping else {
        panic!("the mapping changed its kind");
    };
    assert!(is_near(from, 2.0) && is_near(to, 200.0), "{from} to {to}");
    for (t, despike) in [(0.25, false), (0.75, true)] {
        let found = map(&b, t).smoothing.expect("smoothing");
        let want = t * RangeSmoothing::default().hysteresis;
        assert!(is_near(found.hysteresis, want), "{found:?}");
        assert_eq!(found.despike, despike);
    }
    let visible = style(DepthMapping::MinMax, None);
    assert_eq!(map(&visible, 0.25).mapping, fixed(1.0, 100.0));
    assert_eq!(map(&visible, 0.75).mapping, DepthMapping::MinMax);
}
