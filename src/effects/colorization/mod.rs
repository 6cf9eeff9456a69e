//! Colors the picture with the hue of an atmosphere, everywhere or increasingly
//! with distance (\[CS\] Eq. 8 to 11).

mod oklab;

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    settings::{Equations, FieldRange, HueWheel, color_serde, mix_fields, same_modes},
};

/// Colors the picture with the hue of an atmosphere, everywhere or increasingly
/// with distance (\[CS\] Eq. 8 to 11).
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Colorization {
    /// Selects where the picture takes the hue of the atmosphere: nowhere,
    /// everywhere, or increasingly with distance. Default:
    /// [`ColorizationMode::SquareRoot`].
    pub mode: ColorizationMode,
    /// Color of the atmosphere. [`Equations::Corrected`] uses its hue and saturation: at
    /// full effect, a gray of the same lightness becomes this color.
    /// [`Equations::Faithful`] uses only its hue, `a_h` in \[CS\]. Default: `#c8413a`, a
    /// warm red. Components are clamped to what a display shows; alpha is ignored; a
    /// color that is not finite becomes the default.
    #[serde(with = "color_serde")]
    #[reflect(@HueWheel)]
    pub color: Color,
    /// Fraction of the change that is applied. Range 0 (the effect is left out) to
    /// 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
    /// Selects how colors change. [`Equations::Corrected`] blends chroma in `OKLab` and
    /// keeps the lightness; grays are tinted too. [`Equations::Faithful`] changes the HSV
    /// hue and keeps value and saturation; grays stay gray, and a hue between two
    /// others can be unrelated to both. Default: [`Equations::Corrected`]. Source of the
    /// faithful equations: \[CS\] Eq. 9 to 11 as printed.
    pub equations: Equations,
}

/// How the atmosphere depends on distance (\[CS\] Eq. 8 to 11).
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ColorizationMode {
    /// The picture keeps its hues; the effect is left out (Eq. 8).
    KeepHue,
    /// The whole picture takes the hue of the atmosphere, near and far (Eq. 9).
    Atmosphere,
    /// Near things keep their hues; the atmosphere increases linearly with the depth
    /// map (Eq. 10).
    Linear,
    /// Near things keep their hues; the atmosphere increases with the square root of
    /// the depth map, fast in the foreground (Eq. 11).
    #[default]
    SquareRoot,
}

const DEFAULT_COLOR: Color = Color::srgb(200.0 / 255.0, 65.0 / 255.0, 58.0 / 255.0);

impl Default for Colorization {
    fn default() -> Self {
        Self {
            mode: ColorizationMode::default(),
            color: DEFAULT_COLOR,
            amount: 1.0,
            equations: Equations::Corrected,
        }
    }
}

impl Colorization {
    /// The whole picture in the brown of a faded photograph (\[CS\] Figure 3).
    pub const SEPIA: Self = Self {
        mode: ColorizationMode::Atmosphere,
        color: Color::srgb(0.62, 0.50, 0.34),
        amount: 1.0,
        equations: Equations::Corrected,
    };

    /// Whether the atmosphere depends on the depth map.
    pub fn depends_on_depth(&self) -> bool {
        matches!(
            self.mode,
            ColorizationMode::Linear | ColorizationMode::SquareRoot
        )
    }
}

impl Effect for Colorization {
    const NAME: &'static str = "colorization";
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = shader!("colorization", "Colorization");
    type Uniform = ColorizationUniform;

    fn strength(&self) -> f32 {
        if self.mode == ColorizationMode::KeepHue {
            0.0
        } else {
            self.amount
        }
    }

    fn faded(self, fraction: f32) -> Self {
        let amount = self.amount * fraction;
        Self { amount, ..self }
    }

    fn needs(&self) -> Needs {
        if self.depends_on_depth() {
            Needs::MAP
        } else {
            Needs::empty()
        }
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.number("MODE", self.mode as u32);
        variants.flag("FAITHFUL", self.equations.is_faithful());
    }

    fn uniform(&self, _: &EffectContext) -> ColorizationUniform {
        let hue = Hsva::from(self.color).hue / 360.0;
        let [lightness, a, b, _] = Oklaba::from(self.color).to_f32_array().map(f64::from);
        let chroma = a.hypot(b);
        // A gray atmosphere has no hue: the blend only removes color.
        let direction = if chroma > 1e-4 {
            [a / chroma, b / chroma]
        } else {
            [1.0, 0.0]
        };
        let cusp = oklab::cusp(direction);
        let room = oklab::room(lightness, cusp);
        let saturation = if chroma > 1e-4 && room > 1e-6 {
            (chroma / room).min(1.0)
        } else {
            0.0
        };
        ColorizationUniform {
            direction: Vec2::new(direction[0] as f32, direction[1] as f32),
            cusp_lightness: cusp.0 as f32,
            cusp_chroma: (cusp.1 * saturation) as f32,
            hue: if hue.is_finite() {
                hue.rem_euclid(1.0)
            } else {
                0.0
            },
            amount: self.amount,
            mode: self.mode as u32,
        }
    }

    fn same_modes(&self, other: &Self) -> bool {
        // With the faithful equations, hues between two colors are unrelated to both, so
        // colors are not interpolated but count as modes.
        let colors_mix = !self.equations.is_faithful() || self.color == other.color;
        colors_mix && same_modes(self, other)
    }

    fn mixed(&self, other: &Self, t: f32) -> Self {
        let mixed = mix_fields(self, other, t);
        if self.equations.is_faithful() {
            Self {
                color: self.color,
                ..mixed
            }
        } else {
            mixed
        }
    }
}

/// The uniform: `Colorization` in `colorization.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct ColorizationUniform {
    direction: Vec2,
    cusp_lightness: f32,
    cusp_chroma: f32,
    hue: f32,
    amount: f32,
    mode: u32,
}
