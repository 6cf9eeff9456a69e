//! Moves colors to opposite hues.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    settings::{Equations, FieldRange, HueWheel, color_serde},
};

/// Brings the colors of the picture into harmony: two opposite hues for everything, or
/// opposite hues for what is far away or in the shade.
///
/// Lightness and grays stay as they are. A new color that the display cannot show is paler.
/// Complementary colors are future work in \[CS\].
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ColorHarmony {
    /// Which colors change, and to which others. Default: [`HarmonyMode::TwoHues`].
    pub mode: HarmonyMode,
    /// How the change grows with the depth map in the modes [`HarmonyMode::Distance`] and
    /// [`HarmonyMode::Rotation`]. Default: [`HarmonyCurve::Linear`].
    pub curve: HarmonyCurve,
    /// Saturation of the opposite hue as a fraction of what the color had, in the modes
    /// [`HarmonyMode::Distance`] and [`HarmonyMode::Shade`] of [`Equations::Corrected`]. At 0 colors
    /// become gray. Range 0 to 1.5, default 0.8.
    #[reflect(@FieldRange::linear(0.0, 1.5))]
    pub complement: f32,
    /// How far the darkest colors move towards their opposite, in the mode [`HarmonyMode::Shade`].
    /// Lighter colors move less, by the square of their darkness. Range 0 to 1, default 0.35.
    #[reflect(@FieldRange::FRACTION)]
    pub shade: f32,
    /// One of the two hues of [`HarmonyMode::TwoHues`]; the other is its opposite. Only the hue
    /// is used; a gray has none, and colors become paler. Default: `#e38b4b`, an orange, whose
    /// opposite is a teal blue. Components are clamped to what a display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    #[reflect(@HueWheel)]
    pub color: Color,
    /// How far other hues are drawn to the two of [`HarmonyMode::TwoHues`]; at 1 there are no
    /// others. Range 0 to 1, default 0.7.
    #[reflect(@FieldRange::FRACTION)]
    pub pull: f32,
    /// Chroma in `OKLab` that is added to everything in the mode [`HarmonyMode::TwoHues`]: towards
    /// `color` at the near end of the depth map, and towards its opposite at the far end. Grays are
    /// tinted too. The depth map is read if it is not 0. Range -0.1 to 0.1, default 0.03.
    #[reflect(@FieldRange::linear(-0.1, 0.1))]
    pub offset: f32,
    /// Fraction of the change that is applied. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
    /// Selects how colors go to their opposite. [`Equations::Corrected`] changes the chroma in
    /// `OKLab`.
    /// [`Equations::Faithful`] turns the HSV hue by up to half a turn, as \[CS\] Eq. 9 to 11 do, and
    /// keeps value and saturation: `complement` is not used, [`HarmonyMode::Distance`] is as
    /// [`HarmonyMode::Rotation`], and [`HarmonyMode::TwoHues`] does not change. Default:
    /// [`Equations::Corrected`].
    pub equations: Equations,
}

/// Which colors a [`ColorHarmony`] changes, and to which others.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HarmonyMode {
    /// All hues move towards two opposite hues, one stronger in the foreground, the other in the
    /// distance.
    #[default]
    TwoHues,
    /// Near things keep their hues, and far things take the opposite ones; in between they are
    /// gray.
    Distance,
    /// Near things keep their hues, and far things take the opposite ones; in between, hues turn
    /// around the color wheel.
    Rotation,
    /// Dark colors take some of their opposite, as in the shadows of painters.
    Shade,
}

/// How a [`ColorHarmony`] grows with the depth map.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
pub enum HarmonyCurve {
    /// In proportion to the depth map.
    #[default]
    Linear,
    /// With the square root of the depth map, fast in the foreground.
    SquareRoot,
}

const DEFAULT_COLOR: Color = Color::srgb(227.0 / 255.0, 139.0 / 255.0, 75.0 / 255.0);

/// Chroma below which a color has no hue.
const GRAY: f32 = 1e-4;

impl Default for ColorHarmony {
    fn default() -> Self {
        Self {
            mode: HarmonyMode::TwoHues,
            curve: HarmonyCurve::Linear,
            complement: 0.8,
            shade: 0.35,
            color: DEFAULT_COLOR,
            pull: 0.7,
            offset: 0.03,
            amount: 1.0,
            equations: Equations::Corrected,
        }
    }
}

impl Effect for ColorHarmony {
    const NAME: &'static str = "color_harmony";
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = shader!("color_harmony", "ColorHarmony");
    type Uniform = ColorHarmonyUniform;

    fades_by!(amount);

    fn needs(&self) -> Needs {
        let reads_map = match self.mode {
            HarmonyMode::TwoHues => self.offset != 0.0,
            HarmonyMode::Distance | HarmonyMode::Rotation => true,
            HarmonyMode::Shade => false,
        };
        if reads_map {
            Needs::MAP
        } else {
            Needs::empty()
        }
    }

    fn without(self, missing: Needs) -> Option<Self> {
        let left = if self.mode == HarmonyMode::TwoHues && missing.contains(Needs::MAP) {
            Self {
                offset: 0.0,
                ..self
            }
        } else {
            self
        };
        (!left.needs().intersects(missing)).then_some(left)
    }

    fn map_faded(self, fraction: f32) -> Self {
        match self.mode {
            HarmonyMode::TwoHues => {
                let offset = self.offset * fraction;
                Self { offset, ..self }
            }
            HarmonyMode::Distance | HarmonyMode::Rotation => self.faded(fraction),
            HarmonyMode::Shade => self,
        }
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.number("MODE", self.mode as u32);
        variants.number("SQUARE_ROOT", u32::from(self.is_square_root()));
        variants.flag("FAITHFUL", self.is_faithful());
    }

    fn uniform(&self, _: &EffectContext) -> ColorHarmonyUniform {
        let [_, a, b, _] = Oklaba::from(self.color).to_f32_array();
        let hue = Vec2::new(a, b);
        ColorHarmonyUniform {
            hue: if hue.length() > GRAY {
                hue.normalize()
            } else {
                Vec2::ZERO
            },
            complement: self.complement,
            shade: self.shade,
            pull: self.pull,
            offset: self.offset,
            amount: self.amount,
            mode: self.mode as u32,
            square_root: u32::from(self.is_square_root()),
        }
    }
}

impl ColorHarmony {
    /// Whether the compiled curve is the square root: only in modes that have a curve.
    fn is_square_root(&self) -> bool {
        let follows_depth = matches!(self.mode, HarmonyMode::Distance | HarmonyMode::Rotation);
        follows_depth && self.curve == HarmonyCurve::SquareRoot
    }

    fn is_faithful(&self) -> bool {
        self.mode != HarmonyMode::TwoHues && self.equations.is_faithful()
    }
}

/// The uniform: `ColorHarmony` in `color_harmony.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct ColorHarmonyUniform {
    hue: Vec2,
    complement: f32,
    shade: f32,
    pull: f32,
    offset: f32,
    amount: f32,
    mode: u32,
    square_root: u32,
}
