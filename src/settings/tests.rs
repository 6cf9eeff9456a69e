//! Every number is clamped to the range that its field documents.

#[cfg(all(feature = "toon", feature = "objects"))]
mod materials;
pub(crate) mod non_finite;
mod page;
mod prints;
mod ranges;

use bevy::color::Color;

use crate::{
    Abstraction, BlackFlats, ColorHarmony, Colorization, Contours, DepthLayers, DepthMap,
    DepthMapping, Desaturation, Effect, Focus, Halftone, Hatching, Misregistration, Outlines,
    Paint, Paper, Sketch, SpeedLines, SteppedAnimation, ToneBands, ToneRamp, TwoTone, Vignette,
    depth::RangeSmoothing,
    effects::DepthLayer,
    lines::{Creases, EdgeColor, EdgeStyle, LineColor, LineWeight, ObjectEdges, Silhouettes},
};
#[cfg(all(feature = "toon", feature = "objects"))]
use crate::{
    OutlineStyle, ToonLight,
    objects::{MeshSections, ObjectSimplification},
    toon::{
        DetailAxis, ProxyShape, Ramp, RampDetail, RampStop, Rim, RimWidth, ShadingProxy,
        StylizedHighlight,
    },
};

/// Floats: hand-picked edge cases, then as many random bit patterns as there are cases, which
/// include NaN and infinities.
fn floats() -> impl Iterator<Item = f32> {
    let edges = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.25,
        4.0,
        f32::NAN,
        -f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        f32::EPSILON,
        1e-45,
        f32::from_bits(0x7f80_0001),
        f32::from_bits(0xffff_ffff),
    ];
    let mut state = 0x2545_f491_4f6c_dd1du64;
    let random = std::iter::repeat_with(move || {
        // xorshift64*, Marsaglia and Vigna.
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        f32::from_bits((state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32) as u32)
    });
    edges.into_iter().chain(random.take(non_finite::cases()))
}

/// Asserts for many values of a field, among them the ends of its range and those beside them, that
/// the clamped value is inside the range, and equal to the value if that was inside.
fn fuzz(field: &str, low: f32, high: f32, through: impl Fn(f32) -> f32) {
    let mut kept = 0;
    let ends = [low, high].into_iter();
    let ends = ends.flat_map(|end| [end.next_down(), end, end.next_up()]);
    for value in ends.chain(floats()) {
        let used = through(value);
        assert!(
            (low..=high).contains(&used),
            "{field}: {value} became {used}"
        );
        if (low..=high).contains(&value) {
            assert_eq!(used, value, "{field} changed a value of its range");
            kept += 1;
        }
    }
    assert!(kept > 0, "{field}: no value was inside its range");
}

#[test]
fn any_number_of_the_colour_effects_is_clamped() {
    fuzz("Desaturation::amount", 0.0, 1.0, |x| {
        Desaturation {
            amount: x,
            ..Default::default()
        }
        .sanitized()
        .amount
    });
    fuzz("Desaturation::exponent", 0.25, 4.0, |x| {
        Desaturation {
            exponent: x,
            ..Default::default()
        }
        .sanitized()
        .exponent
    });
    fuzz("Colorization::amount", 0.0, 1.0, |x| {
        Colorization {
            amount: x,
            ..Default::default()
        }
        .sanitized()
        .amount
    });
    fuzz("Colorization::color", 0.0, 1.0, |x| {
        let color = Color::linear_rgb(x, 0.5, 0.5);
        let used = Colorization {
            color,
            ..Default::default()
        }
        .sanitized()
        .color
        .to_linear();
        assert!(
            [used.green, used.blue]
                .iter()
                .all(|c| (0.0..=1.0).contains(c))
        );
        used.red
    });
}

#[test]
fn any_number_of_the_ink_effects_is_clamped() {
    let contours = |edit: fn(&mut Contours, f32)| {
        move |x| {
            let mut c = Contours::default();
            edit(&mut c, x);
            c.sanitized()
        }
    };
    let threshold = contours(|c, x| c.threshold = x);
    fuzz("Contours::threshold", 1e-6, 100.0, |x| {
        threshold(x).threshold
    });
    let width = contours(|c, x| c.width = x);
    fuzz("Contours::width", 0.5, 16.0, |x| width(x).width);
    let softness = contours(|c, x| c.softness = x);
    fuzz("Contours::softness", 0.0, 1.0, |x| softness(x).softness);
    let opacity = contours(|c, x| c.opacity = x);
    fuzz("Contours::opacity", 0.0, 1.0, |x| opacity(x).opacity);
    let fade = contours(|c, x| c.opacity_fade = x);
    fuzz("Contours::opacity_fade", 0.0, 1.0, |x| fade(x).opacity_fade);

    let flats = |edit: fn(&mut BlackFlats, f32)| {
        move |x| {
            let mut b = BlackFlats::default();
            edit(&mut b, x);
            b.sanitized()
        }
    };
    let slope = flats(|b, x| b.slope = Some(x));
    fuzz("BlackFlats::slope", 1e-6, 100.0, |x| {
        slope(x).slope.unwrap_or(f32::NAN)
    });
    let value = flats(|b, x| b.value = Some(x));
    fuzz("BlackFlats::value", 0.0, 1.0, |x| {
        value(x).value.unwrap_or(f32::NAN)
    });
    let weight = flats(|b, x| b.depth_weight = x);
    fuzz("BlackFlats::depth_weight", 0.0, 1.0, |x| {
        weight(x).depth_weight
    });
    let softness = flats(|b, x| b.softness = x);
    fuzz("BlackFlats::softness", 0.0, 1.0, |x| softness(x).softness);
    let opacity = flats(|b, x| b.opacity = x);
    fuzz("BlackFlats::opacity", 0.0, 1.0, |x| opacity(x).opacity);
}

#[test]
fn any_number_of_the_depth_map_is_clamped() {
    let map = |edit: fn(&mut DepthMap, f32)| {
        move |x| {
            let mut m = DepthMap::default();
            edit(&mut m, x);
            m.sanitized()
        }
    };
    let gap = map(|m, x| m.sky_gap = x);
    fuzz("DepthMap::sky_gap", 0.0, 10.0, |x| gap(x).sky_gap);
    let floor = map(|m, x| m.floor = x);
    fuzz("DepthMap::floor", 0.0, 1.0, |x| floor(x).floor);
    let floor = map(|m, x| m.orthographic_floor = x);
    let smoothing = |edit: fn(&mut RangeSmoothing, f32)| {
        move |x| {
            let mut s = RangeSmoothing::default();
            edit(&mut s, x);
            s.sanitized()
        }
    };
    let outliers = smoothing(|s, x| s.outliers = x);
    fuzz("RangeSmoothing::outliers", 0.0, 0.2, |x| {
        outliers(x).outliers
    });
    let hysteresis = smoothing(|s, x| s.hysteresis = x);
    fuzz("RangeSmoothing::hysteresis", 0.0, 4.0, |x| {
        hysteresis(x).hysteresis
    });
    let expand = smoothing(|s, x| s.expand = x);
    fuzz("RangeSmoothing::expand", 0.0, 60.0, |x| expand(x).expand);
    let shrink = smoothing(|s, x| s.shrink = x);
    fuzz("RangeSmoothing::shrink", 0.0, 60.0, |x| shrink(x).shrink);
    fuzz("DepthMap::orthographic_floor", 0.0, 1e6, |x| {
        floor(x).orthographic_floor
    });
    for (a, b) in floats().zip(floats().skip(7)) {
        let mapping = DepthMapping::Fixed { from: a, to: b };
        let DepthMapping::Fixed { from, to } = DepthMap {
            mapping,
            ..Default::default()
        }
        .sanitized()
        .mapping
        else {
            panic!("the mapping changed its kind");
        };
        assert!(
            from > 0.0 && to > from && to.is_finite(),
            "{a}, {b}: {from}, {to}"
        );
    }
}

#[test]
fn any_number_of_the_lines_is_clamped() {
    let outlines = |edit: fn(&mut Outlines, f32)| {
        move |x| {
            let mut o = Outlines::default();
            edit(&mut o, x);
            o.sanitized()
        }
    };
    let width = outlines(|o, x| o.width = x);
    fuzz("Outlines::width", 0.5, 16.0, |x| width(x).width);
    let fade = outlines(|o, x| o.width_fade = x);
    fuzz("Outlines::width_fade", 0.0, 1.0, |x| fade(x).width_fade);
    let fade = outlines(|o, x| o.opacity_fade = x);
    fuzz("Outlines::opacity_fade", 0.0, 1.0, |x| fade(x).opacity_fade);
    let continuity = outlines(|o, x| o.hysteresis = x);
    let continuity = |x| continuity(x).hysteresis;
    fuzz("Outlines::hysteresis", 0.0, 32.0, continuity);
    let over = outlines(|o, x| o.overshoot = x);
    fuzz("Outlines::overshoot", 0.0, 16.0, |x| over(x).overshoot);
    let level = outlines(|o, x| o.hysteresis_ratio = x);
    fuzz("Outlines::hysteresis_ratio", 0.1, 1.0, |x| {
        level(x).hysteresis_ratio
    });
    let budget = outlines(|o, x| o.ink_budget = x);
    fuzz("Outlines::ink_budget", 0.05, 1.0, |x| budget(x).ink_budget);
    let history = outlines(|o, x| o.history_weight = x);
    fuzz("Outlines::history_weight", 0.0, 0.96875, |x| {
        history(x).history_weight
    });
    let color = |darken, saturate| {
        LineColor::Surface { darken, saturate }
            .sanitized()
            .factors()
    };
    fuzz("LineColor::Surface::darken", 0.0, 1.0, |x| color(x, x)[0]);
    fuzz("LineColor::Surface::saturate", 0.0, 2.0, |x| color(x, x)[1]);
    let boil = outlines(|o, x| o.boil.amplitude = x);
    fuzz("LineBoil::amplitude", 0.0, 3.0, |x| boil(x).boil.amplitude);
    let boil = outlines(|o, x| o.boil.wavelength = x);
    let wavelength = |x| boil(x).boil.wavelength;
    fuzz("LineBoil::wavelength", 20.0, 120.0, wavelength);
    let boil = outlines(|o, x| o.boil.rate = x);
    fuzz("LineBoil::rate", 0.0, 60.0, |x| boil(x).boil.rate);
    type Field = fn(&mut LineWeight) -> &mut f32;
    let weights: [(&str, f32, f32, Field); 12] = [
        ("outer", 0.0, 4.0, |w| &mut w.outer),
        ("inner", 0.0, 4.0, |w| &mut w.inner),
        ("crease", 0.0, 4.0, |w| &mut w.crease),
        ("object", 0.0, 4.0, |w| &mut w.object),
        ("shade", 0.0, 2.0, |w| &mut w.shade),
        ("lit", 0.0, 1.0, |w| &mut w.lit),
        ("perspective", 0.0, 1.0, |w| &mut w.perspective),
        ("nib_roundness", 0.1, 1.0, |w| &mut w.nib_roundness),
        ("nib_angle", 0.0, 180.0, |w| &mut w.nib_angle),
        ("taper", 0.0, 48.0, |w| &mut w.taper),
        ("pressure", 0.0, 1.0, |w| &mut w.pressure),
        ("pressure_length", 10.0, 500.0, |w| &mut w.pressure_length),
    ];
    for (name, low, high, field) in weights {
        fuzz(&format!("LineWeight::{name}"), low, high, |x| {
            let mut weight = LineWeight::EVEN;
            *field(&mut weight) = x;
            *field(&mut weight.sanitized())
        });
    }
    let silhouettes = |edit: fn(&mut Silhouettes, f32)| {
        move |x| {
            let mut s = Silhouettes::default();
            edit(&mut s, x);
            s.sanitized()
        }
    };
    let silhouette = silhouettes(|s, x| s.threshold = x);
    let threshold = |x| silhouette(x).threshold;
    fuzz("Silhouettes::threshold", 1e-6, 1.0, threshold);
    let limit = silhouettes(|s, x| s.edge_limit = x);
    fuzz("Silhouettes::edge_limit", 0.01, 0.99, |x| {
        limit(x).edge_limit
    });
    let softness = silhouettes(|s, x| s.softness = x);
    fuzz("Silhouettes::softness", 0.0, 1.0, |x| softness(x).softness);
    fuzz("Creases::angle", 3.0, 180.0, |x| {
        Creases {
            angle: x,
            ..Default::default()
        }
        .sanitized()
        .angle
    });
    let edge = |edit: fn(&mut EdgeStyle, f32)| {
        move |x| {
            let mut style = EdgeStyle::default();
            edit(&mut style, x);
            // As a part of creases.
            let creases = Creases {
                convex: Some(style),
                ..Default::default()
            };
            creases.sanitized().convex.expect("a style")
        }
    };
    let width = edge(|e, x| e.width = x);
    fuzz("EdgeStyle::width", 0.0, 4.0, |x| width(x).width);
    let opacity = edge(|e, x| e.opacity = x);
    fuzz("EdgeStyle::opacity", 0.0, 1.0, |x| opacity(x).opacity);
    let unlit = edge(|e, x| e.unlit_opacity = x);
    fuzz("EdgeStyle::unlit_opacity", 0.0, 1.0, |x| {
        unlit(x).unlit_opacity
    });
    let surface = edge(|e, x| {
        let (lighten, saturate) = (x, x);
        e.color = EdgeColor::Surface { lighten, saturate };
    });
    let parts = |x| match surface(x).color {
        EdgeColor::Surface { lighten, saturate } => [lighten, saturate],
        EdgeColor::Ink { .. } => unreachable!("a surface"),
    };
    fuzz("EdgeColor::Surface::lighten", -1.0, 1.0, |x| parts(x)[0]);
    fuzz("EdgeColor::Surface::saturate", 0.0, 2.0, |x| parts(x)[1]);
    fuzz("ObjectEdges::opacity", 0.0, 1.0, |x| {
        ObjectEdges {
            opacity: x,
            ..Default::default()
        }
        .sanitized()
        .opacity
    });
}

#[test]
fn any_number_of_sketch_and_bands_is_clamped() {
    let sketch = |edit: fn(&mut Sketch, f32)| {
        move |x| {
            let mut s = Sketch::default();
            edit(&mut s, x);
            s.sanitized()
        }
    };
    let jitter = sketch(|s, x| s.jitter = x);
    fuzz("Sketch::jitter", 0.0, 8.0, |x| jitter(x).jitter);
    let wave = sketch(|s, x| s.wavelength = x);
    fuzz("Sketch::wavelength", 2.0, 256.0, |x| wave(x).wavelength);
    let gamma = sketch(|s, x| s.gamma = x);
    fuzz("Sketch::gamma", 0.25, 4.0, |x| gamma(x).gamma);
    let rate = sketch(|s, x| s.rate = x);
    fuzz("Sketch::rate", 0.0, 60.0, |x| rate(x).rate);
    let amount = sketch(|s, x| s.amount = x);
    fuzz("Sketch::amount", 0.0, 1.0, |x| amount(x).amount);
    let wash = sketch(|s, x| s.wash = x);
    fuzz("Sketch::wash", 0.0, 1.0, |x| wash(x).wash);
    let pressure = sketch(|s, x| s.pressure = x);
    fuzz("Sketch::pressure", 0.0, 1.0, |x| pressure(x).pressure);
    fuzz("ToneBands::softness", 0.0, 16.0, |x| {
        ToneBands {
            softness: x,
            ..Default::default()
        }
        .sanitized()
        .softness
    });
    fuzz("ToneBands::amount", 0.0, 1.0, |x| {
        ToneBands {
            amount: x,
            ..Default::default()
        }
        .sanitized()
        .amount
    });
}

#[cfg(feature = "toon")]
#[test]
fn any_number_of_the_toon_light_is_clamped() {
    use crate::ToonLight;
    let light = |edit: fn(&mut ToonLight, f32)| {
        move |x| {
            let mut l = ToonLight::default();
            edit(&mut l, x);
            l.sanitized()
        }
    };
    let shadow_threshold = light(|l, x| l.shadow_threshold = x);
    fuzz("ToonLight::shadow_threshold", 0.0, 0.9, |x| {
        shadow_threshold(x).shadow_threshold
    });
    let strength = light(|l, x| l.shadow_strength = x);
    fuzz("ToonLight::shadow_strength", 0.0, 1.0, |x| {
        strength(x).shadow_strength
    });
    let highlight = light(|l, x| l.highlight = x);
    fuzz("ToonLight::highlight", 0.0, 4.0, |x| highlight(x).highlight);
    let edge = light(|l, x| l.highlight_edge = x);
    fuzz("ToonLight::highlight_edge", 0.01, 0.99, |x| {
        edge(x).highlight_edge
    });
    let falloff = light(|l, x| l.falloff = x);
    fuzz("ToonLight::falloff", 0.0, 4.0, |x| falloff(x).falloff);
    let environment = light(|l, x| l.flat_environment = x);
    fuzz("ToonLight::flat_environment", 0.0, 1.0, |x| {
        environment(x).flat_environment
    });
}
