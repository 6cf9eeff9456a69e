//! What a layer changes.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::settings::{BlendField, FieldRange, HueWheel, NotFinite, color_serde, impl_sanitized};

/// Colors and lines of one of the [`DepthLayers`](crate::DepthLayers). The default changes
/// nothing.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DepthLayer {
    /// Factor of the saturation. Range 0 (gray) to 2, default 1.
    #[reflect(@FieldRange::linear(0.0, 2.0), @NotFinite(1.0))]
    pub saturation: f32,
    /// Color that the layer is tinted with: its hue and chroma in `OKLab`, at the lightness of the
    /// picture. Default: `#7fa6c9`, a hazy blue. Components are clamped to what a display shows;
    /// alpha is ignored.
    #[serde(with = "color_serde")]
    #[reflect(@HueWheel)]
    pub tint: Color,
    /// How much of the color comes from `tint`. At 1, only the lightness of the picture is left.
    /// Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION, @NotFinite(0.0))]
    pub tint_amount: f32,
    /// Factor of the contrast, about a lightness of 0.5 in `OKLab`. Range 0 to 2, default 1.
    #[reflect(@FieldRange::linear(0.0, 2.0), @NotFinite(1.0))]
    pub contrast: f32,
    /// Lightness in `OKLab` that is added after that: positive is brighter. Range -0.5 to 0.5,
    /// default 0.
    #[reflect(@FieldRange::linear(-0.5, 0.5), @NotFinite(0.0))]
    pub brightness: f32,
    /// Number of flat tones that the lightness is divided into, before the contrast. Range 0 (all
    /// tones) to 8, default 0.
    #[reflect(@FieldRange::linear(0.0, 8.0), @BlendField::Switch)]
    pub bands: u32,
    /// Factor of the width of lines; below 0.6 physical pixels, they become fainter instead. Lines
    /// belong to the surface in front. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION, @NotFinite(1.0))]
    pub line_width: f32,
    /// Factor of the opacity of lines. Range 0 (no lines) to 1, default 1.
    #[reflect(@FieldRange::FRACTION, @NotFinite(1.0))]
    pub line_opacity: f32,
    /// Color that lines take instead of theirs, see `line_color_amount`. Lines belong to the
    /// surface in front; those of the faithful equations to what they are drawn on. Objects whose
    /// `OutlineStyle` has a color keep that. Default: `#000000`. Components are clamped to what a
    /// display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    #[reflect(@HueWheel)]
    pub line_color: Color,
    /// How much of the color of lines comes from `line_color`, mixed in linear light. Range 0 to
    /// 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub line_color_amount: f32,
    /// Factor of the darkness of [`Hatching`](crate::Hatching). Hatching that is drawn after paint,
    /// focus or a misregistration does not change. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub hatching: f32,
    /// How much of a [`Halftone`](crate::Halftone) is seen as dots; the rest is printed as plain
    /// tones. Whole dots ([`ScreenSampling::Cell`](crate::effects::ScreenSampling::Cell)), and what
    /// is drawn after paint, focus or a misregistration, do not change. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub halftone: f32,
}

const HAZE: Color = Color::srgb(127.0 / 255.0, 166.0 / 255.0, 201.0 / 255.0);

/// The lightness that contrast leaves as it is.
const PIVOT: f32 = 0.5;

impl DepthLayer {
    /// The layer stays as it is.
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

    pub(super) fn colors(&self) -> LayerColorsUniform {
        let [_, a, b, _] = Oklaba::from(self.tint).to_f32_array();
        LayerColorsUniform {
            tint: Vec2::new(a, b) * self.tint_amount,
            chroma: self.saturation * (1.0 - self.tint_amount),
            contrast: self.contrast,
            shift: PIVOT * (1.0 - self.contrast) + self.brightness,
            bands: self.bands as f32,
            print_factors: Vec2::new(self.hatching, self.halftone),
        }
    }
}

impl_sanitized!(DepthLayer);

impl Default for DepthLayer {
    fn default() -> Self {
        Self::PLAIN
    }
}

/// `LayerColors` in `depth_layers.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct LayerColorsUniform {
    tint: Vec2,
    chroma: f32,
    contrast: f32,
    shift: f32,
    bands: f32,
    print_factors: Vec2,
}
