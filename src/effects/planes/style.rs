//! What a plane changes.

use bevy::{
    color::{Color, ColorToComponents, Oklaba},
    math::{FloatExt, Vec2},
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use crate::settings::{FieldRange, HueWheel, blend_color, bounded, displayable, file_color};

/// The look of one of the [`Planes`](crate::Planes). With the defaults, the plane stays as it is.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PlaneStyle {
    /// Factor of the saturation. Range 0 (grey) to 2, default 1.
    #[reflect(@FieldRange::linear(0.0, 2.0))]
    pub saturation: f32,
    /// Colour that the plane is tinted with: its hue and chroma in `OKLab`, at the lightness of the
    /// picture. Default: `#7fa6c9`, a hazy blue. Components are clamped to what a display shows;
    /// alpha is ignored.
    #[serde(with = "file_color")]
    #[reflect(@HueWheel)]
    pub tint: Color,
    /// How much of the colour comes from `tint`: at 1, all of it, and only the lightness is that
    /// of the picture. Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub tint_amount: f32,
    /// Factor of the contrast, about a lightness of 0.5 in `OKLab`. Range 0 to 2, default 1.
    #[reflect(@FieldRange::linear(0.0, 2.0))]
    pub contrast: f32,
    /// Lightness in `OKLab` that is added after that: positive is brighter. Range -0.5 to 0.5,
    /// default 0.
    #[reflect(@FieldRange::linear(-0.5, 0.5))]
    pub brightness: f32,
    /// Number of flat tones that the lightness is divided into, before the contrast. Range 0 (all
    /// tones) to 8, default 0.
    #[reflect(@FieldRange::linear(0.0, 8.0))]
    pub bands: u32,
    /// Factor of the width of lines; below 0.6 physical pixels, they become fainter instead. Lines
    /// belong to the surface in front. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub line_width: f32,
    /// Factor of the opacity of lines. Range 0 (no lines) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub line_opacity: f32,
    /// Colour that lines take instead of theirs, see `line_color_amount`. Lines belong to the
    /// surface in front; those of the faithful forms to what they are drawn on. Objects whose
    /// `OutlineStyle` has a colour keep that. Default: `#000000`. Components are clamped to what a
    /// display shows; alpha is ignored.
    #[serde(with = "file_color")]
    #[reflect(@HueWheel)]
    pub line_color: Color,
    /// How much of the colour of lines comes from `line_color`, mixed in linear light. Range 0 to
    /// 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub line_color_amount: f32,
    /// Factor of the darkness of [`Hatching`](crate::Hatching). Hatching that is drawn after paint,
    /// focus or a print offset does not change. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub hatching: f32,
    /// How much of a [`Halftone`](crate::Halftone) is seen as dots; the rest is printed as plain
    /// tones. Whole dots ([`ScreenSampling::Cell`](crate::ScreenSampling::Cell)), and what is
    /// drawn after paint, focus or a print offset, do not change. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub halftone: f32,
}

const HAZE: Color = Color::srgb(127.0 / 255.0, 166.0 / 255.0, 201.0 / 255.0);

/// The lightness that contrast leaves as it is.
const PIVOT: f32 = 0.5;

impl PlaneStyle {
    /// The plane stays as it is.
    pub const PLAIN: Self = Self {
        saturation: 1.0,
        tint: HAZE,
        tint_amount: 0.0,
        contrast: 1.0,
        brightness: 0.0,
        bands: 0,
        line_width: 1.0,
        line_opacity: 1.0,
        line_color: Color::srgb(0.0, 0.0, 0.0),
        line_color_amount: 0.0,
        hatching: 1.0,
        halftone: 1.0,
    };

    /// The settings that are used.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let plain = Self::PLAIN;
        Self {
            saturation: bounded(self.saturation, plain.saturation, 0.0, 2.0),
            tint: displayable(self.tint, plain.tint),
            tint_amount: bounded(self.tint_amount, plain.tint_amount, 0.0, 1.0),
            contrast: bounded(self.contrast, plain.contrast, 0.0, 2.0),
            brightness: bounded(self.brightness, plain.brightness, -0.5, 0.5),
            bands: self.bands.min(8),
            line_width: bounded(self.line_width, plain.line_width, 0.0, 1.0),
            line_opacity: bounded(self.line_opacity, plain.line_opacity, 0.0, 1.0),
            line_color: displayable(self.line_color, plain.line_color),
            line_color_amount: bounded(self.line_color_amount, plain.line_color_amount, 0.0, 1.0),
            hatching: bounded(self.hatching, plain.hatching, 0.0, 1.0),
            halftone: bounded(self.halftone, plain.halftone, 0.0, 1.0),
        }
    }

    /// Numbers and colours at fraction `t` between the two; the number of tones of `self`.
    pub(super) fn mixed(self, other: Self, t: f32) -> Self {
        Self {
            saturation: self.saturation.lerp(other.saturation, t),
            tint: blend_color(self.tint, other.tint, t),
            tint_amount: self.tint_amount.lerp(other.tint_amount, t),
            contrast: self.contrast.lerp(other.contrast, t),
            brightness: self.brightness.lerp(other.brightness, t),
            bands: self.bands,
            line_width: self.line_width.lerp(other.line_width, t),
            line_opacity: self.line_opacity.lerp(other.line_opacity, t),
            line_color: blend_color(self.line_color, other.line_color, t),
            line_color_amount: self.line_color_amount.lerp(other.line_color_amount, t),
            hatching: self.hatching.lerp(other.hatching, t),
            halftone: self.halftone.lerp(other.halftone, t),
        }
    }

    pub(super) fn colors(&self) -> PlaneColorsUniform {
        let [_, a, b, _] = Oklaba::from(self.tint).to_f32_array();
        PlaneColorsUniform {
            tint: Vec2::new(a, b) * self.tint_amount,
            chroma: self.saturation * (1.0 - self.tint_amount),
            contrast: self.contrast,
            shift: PIVOT * (1.0 - self.contrast) + self.brightness,
            bands: self.bands as f32,
            prints: Vec2::new(self.hatching, self.halftone),
        }
    }
}

impl Default for PlaneStyle {
    fn default() -> Self {
        Self::PLAIN
    }
}

/// `PlaneColors` in `planes.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneColorsUniform {
    tint: Vec2,
    chroma: f32,
    contrast: f32,
    shift: f32,
    bands: f32,
    prints: Vec2,
}
