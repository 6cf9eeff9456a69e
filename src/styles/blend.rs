//! What lies between two styles.
//!
//! Numbers are interpolated: ratios where a ratio is what the eye sees, colours
//! in `OKLab`. A mode cannot be: its effect fades out until half of the way,
//! changes its mode where it has no strength, and fades in again. So no picture
//! jumps, and every value of `t` has one style.

use bevy::{
    color::{Color, LinearRgba, Mix, Oklaba},
    math::FloatExt,
};

use super::{
    BlackFlats, ColorMethod, Colorization, ComicStyle, Contours, Creases, Desaturation,
    ObjectEdges, Outlines, Silhouettes, Sketch, ToneBands,
};
use crate::{
    depth::{DepthMap, DepthMapping, RangeSmoothing},
    view::sketched_outlines,
};

/// An effect that can be faded and mixed with another of its kind.
trait Blend: Copy {
    /// The effect with so much of its strength; at 0 it changes nothing.
    fn faded(self, strength: f32) -> Self;

    /// Whether numbers alone tell the two apart.
    fn same_modes(&self, other: &Self) -> bool;

    /// Every number `t` of the way to the other; modes stay.
    fn mixed(self, other: Self, t: f32) -> Self;
}

fn color(a: Color, b: Color, t: f32) -> Color {
    if a == b {
        return a;
    }
    // Between two colours of a display may lie some that it does not show.
    let mixed = LinearRgba::from(Oklaba::from(a).mix(&Oklaba::from(b), t));
    let shown = |part: f32| part.clamp(0.0, 1.0);
    LinearRgba {
        red: shown(mixed.red),
        green: shown(mixed.green),
        blue: shown(mixed.blue),
        alpha: shown(mixed.alpha),
    }
    .into()
}

/// Interpolates a positive number by its ratio.
fn ratio(a: f32, b: f32, t: f32) -> f32 {
    if a == b || a <= 0.0 || b <= 0.0 {
        return a.lerp(b, t);
    }
    let (a, b) = (f64::from(a), f64::from(b));
    (a * (b / a).powf(f64::from(t))) as f32
}

/// The strength of what changes its mode half of the way.
fn dip(t: f32) -> f32 {
    (1.0 - 2.0 * t).abs()
}

/// `must_dip` fades the effect out half of the way, whatever its modes.
fn blend<T: Blend>(a: Option<T>, b: Option<T>, t: f32, must_dip: impl Fn(&T) -> bool) -> Option<T> {
    let (effect, switches) = match (a, b) {
        (None, None) => return None,
        (Some(a), None) => (a.faded(1.0 - t), false),
        (None, Some(b)) => (b.faded(t), false),
        (Some(a), Some(b)) => {
            let mixed = if t < 0.5 {
                a.mixed(b, t)
            } else {
                b.mixed(a, 1.0 - t)
            };
            (mixed, !a.same_modes(&b))
        }
    };
    Some(if switches || must_dip(&effect) {
        effect.faded(dip(t))
    } else {
        effect
    })
}

fn never<T>(_: &T) -> bool {
    false
}

impl ComicStyle {
    /// The style that lies `t` of the way from this one to another: this one
    /// at 0 and below, the other at 1 and above. As a picture it is continuous
    /// in `t`.
    ///
    /// * Numbers are interpolated, colours in `OKLab`; an effect that only one
    ///   of the two has fades in or out.
    /// * An effect whose mode changes (an operator, a method, the number of
    ///   tone bands) fades out until `t = 0.5`, changes there, and fades in.
    /// * When the mapping of the depth map changes, every effect that reads
    ///   the map does so.
    /// * What has no strength of its own changes at `t = 0.5`: the strokes of
    ///   a sketch and how often they are drawn anew, `despike`, `locked`.
    #[must_use]
    pub fn blend(&self, other: &Self, t: f32) -> Self {
        if t.is_nan() || t <= 0.0 {
            return self.clone();
        }
        if t >= 1.0 {
            return other.clone();
        }
        let (a, b) = (self.sanitized(), other.sanitized());
        let (map_a, map_b) = (
            a.depth_map.unwrap_or_default(),
            b.depth_map.unwrap_or_default(),
        );
        let remapped = map_a.flip != map_b.flip
            || std::mem::discriminant(&map_a.mapping) != std::mem::discriminant(&map_b.mapping);
        let named = if t < 0.5 { &a } else { &b };
        let outlines = blend(own_outlines(&a), own_outlines(&b), t, never);
        Self {
            version: Self::VERSION,
            name: named.name.clone(),
            depth_map: (a.depth_map.is_some() || b.depth_map.is_some())
                .then(|| mixed_map(map_a, map_b, t)),
            tone_bands: blend(a.tone_bands, b.tone_bands, t, never),
            desaturation: blend(a.desaturation, b.desaturation, t, |_| remapped),
            colorization: blend(a.colorization, b.colorization, t, |c| {
                remapped && c.depends_on_depth()
            }),
            black_flats: blend(a.black_flats, b.black_flats, t, |f| {
                remapped && f.depends_on_depth()
            }),
            contours: blend(a.contours, b.contours, t, |_| remapped),
            outlines: outlines.map(|lines| {
                let fade = if remapped { dip(t) } else { 1.0 };
                Outlines {
                    width_fade: lines.width_fade * fade,
                    opacity_fade: lines.opacity_fade * fade,
                    ..lines
                }
            }),
            sketch: blend(a.sketch, b.sketch, t, never),
        }
    }
}

/// The outlines of a style, those that only its sketch draws among them.
fn own_outlines(style: &ComicStyle) -> Option<Outlines> {
    style
        .outlines
        .or_else(|| style.sketch.map(|_| sketched_outlines()))
}

fn mixed_map(a: DepthMap, b: DepthMap, t: f32) -> DepthMap {
    let modes = if t < 0.5 { a } else { b };
    let mapping = match (a.mapping, b.mapping) {
        (
            DepthMapping::Fixed { near, far },
            DepthMapping::Fixed {
                near: near_b,
                far: far_b,
            },
        ) => DepthMapping::Fixed {
            near: ratio(near, near_b, t),
            far: ratio(far, far_b, t),
        },
        (
            DepthMapping::FixedLogarithmic { near, far },
            DepthMapping::FixedLogarithmic {
                near: near_b,
                far: far_b,
            },
        ) => DepthMapping::FixedLogarithmic {
            near: ratio(near, near_b, t),
            far: ratio(far, far_b, t),
        },
        _ => modes.mapping,
    };
    let [s_a, s_b] = [a, b].map(|map| map.smoothing.unwrap_or(RangeSmoothing::OFF));
    let smoothing = (a.smoothing.is_some() || b.smoothing.is_some()).then(|| RangeSmoothing {
        outliers: s_a.outliers.lerp(s_b.outliers, t),
        despike: if t < 0.5 { s_a.despike } else { s_b.despike },
        hysteresis: s_a.hysteresis.lerp(s_b.hysteresis, t),
        expand: s_a.expand.lerp(s_b.expand, t),
        shrink: s_a.shrink.lerp(s_b.shrink, t),
    });
    DepthMap {
        mapping,
        sky_gap: a.sky_gap.lerp(b.sky_gap, t),
        floor: ratio(a.floor, b.floor, t),
        orthographic_floor: ratio(a.orthographic_floor, b.orthographic_floor, t),
        smoothing,
        ..modes
    }
}

/// How the fields of an effect are mixed. A field that has no line here does not
/// compile.
macro_rules! blend_fields {
    ($($Effect:ident {
        strength: $strength:ident,
        $(modes: [$($mode:ident),*],)?
        $(linear: [$($linear:ident),*],)?
        $(ratios: [$($ratio:ident),*],)?
        $(colors: [$($color:ident),*],)?
        $(switched: [$($switched:ident),*],)?
    })*) => {
        $(impl Blend for $Effect {
            fn faded(self, strength: f32) -> Self {
                Self {
                    $strength: self.$strength * strength,
                    ..self
                }
            }

            fn same_modes(&self, _other: &Self) -> bool {
                true $($(&& self.$mode == _other.$mode)*)?
            }

            fn mixed(self, other: Self, t: f32) -> Self {
                Self {
                    $strength: self.$strength.lerp(other.$strength, t),
                    $($($mode: self.$mode,)*)?
                    $($($linear: self.$linear.lerp(other.$linear, t),)*)?
                    $($($ratio: ratio(self.$ratio, other.$ratio, t),)*)?
                    $($($color: color(self.$color, other.$color, t),)*)?
                    $($($switched: self.$switched,)*)?
                }
            }
        })*
    };
}

blend_fields! {
    ToneBands {
        strength: amount,
        modes: [method, levels],
        linear: [feather],
    }
    Desaturation {
        strength: amount,
        modes: [method],
        ratios: [exponent],
    }
    Contours {
        strength: opacity,
        modes: [operator, form],
        linear: [width, softness, fade],
        ratios: [threshold],
        colors: [color],
    }
    Silhouettes {
        strength: opacity,
        modes: [form],
        linear: [edge_limit, softness],
        ratios: [threshold],
        colors: [color],
    }
    Creases {
        strength: opacity,
        modes: [form],
        linear: [angle, edge_limit, softness],
        colors: [color],
    }
    ObjectEdges {
        strength: opacity,
        colors: [color],
    }
    // A drawing that changes its strokes, which move all at once, does not fade
    // away for it.
    Sketch {
        strength: amount,
        linear: [wash, jitter, pressure],
        ratios: [gamma],
        colors: [paper, ink],
        switched: [strokes, wavelength, rate],
    }
}

impl Blend for Colorization {
    fn faded(self, strength: f32) -> Self {
        Self {
            amount: self.amount * strength,
            ..self
        }
    }

    fn same_modes(&self, other: &Self) -> bool {
        // The faithful method turns hues the long way round: between two of
        // them there is no way.
        let hues = self.method == ColorMethod::Corrected || self.color == other.color;
        (self.mode, self.method) == (other.mode, other.method) && hues
    }

    fn mixed(self, other: Self, t: f32) -> Self {
        let color = if self.method == ColorMethod::Corrected {
            color(self.color, other.color, t)
        } else {
            self.color
        };
        Self {
            color,
            amount: self.amount.lerp(other.amount, t),
            ..self
        }
    }
}

impl Blend for BlackFlats {
    fn faded(self, strength: f32) -> Self {
        Self {
            opacity: self.opacity * strength,
            ..self
        }
    }

    fn same_modes(&self, other: &Self) -> bool {
        self.slope.is_some() == other.slope.is_some()
    }

    fn mixed(self, other: Self, t: f32) -> Self {
        let values = [self.value, other.value].map(|value| value.unwrap_or(0.0));
        let slopes = self.slope.zip(other.slope);
        Self {
            slope: slopes.map_or(self.slope, |(a, b)| Some(ratio(a, b, t))),
            value: (self.value.is_some() || other.value.is_some())
                .then(|| values[0].lerp(values[1], t)),
            depth_weight: self.depth_weight.lerp(other.depth_weight, t),
            feather: self.feather.lerp(other.feather, t),
            color: color(self.color, other.color, t),
            opacity: self.opacity.lerp(other.opacity, t),
        }
    }
}

impl Blend for Outlines {
    fn faded(self, strength: f32) -> Self {
        Self {
            silhouettes: self.silhouettes.map(|s| s.faded(strength)),
            creases: self.creases.map(|c| c.faded(strength)),
            objects: self.objects.map(|o| o.faded(strength)),
            ..self
        }
    }

    /// The kinds have modes of their own.
    fn same_modes(&self, _: &Self) -> bool {
        true
    }

    fn mixed(self, other: Self, t: f32) -> Self {
        Self {
            silhouettes: blend(self.silhouettes, other.silhouettes, t, never),
            creases: blend(self.creases, other.creases, t, never),
            objects: blend(self.objects, other.objects, t, never),
            width: self.width.lerp(other.width, t),
            width_fade: self.width_fade.lerp(other.width_fade, t),
            opacity_fade: self.opacity_fade.lerp(other.opacity_fade, t),
        }
    }
}
