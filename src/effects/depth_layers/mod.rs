//! Colors and lines of their own for the foreground, the middle and the background.

mod layer;

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

pub use layer::DepthLayer;
use layer::LayerColorsUniform;

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, EffectView, Needs, Variants},
    lines::{LineLayers, LineModifiers},
    settings::{BlendField, FieldRange},
};

/// Divides the picture into foreground, middle and background, and gives each layer its own colors
/// and lines, as comics do to show depth (after Sauvaget and Boyer 2008).
///
/// By default the borders follow the scene: they lie where the visible distances fall into three
/// groups. The sky belongs to the background. [`DepthMap::flip`](crate::DepthMap::flip) exchanges
/// foreground and background.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DepthLayers {
    /// Colors and lines of the foreground. Default: unchanged.
    #[reflect(@BlendField::Fields)]
    pub foreground: DepthLayer,
    /// Colors and lines of the middle layer. Default: a little paler and bluer.
    #[reflect(@BlendField::Fields)]
    pub middle: DepthLayer,
    /// Colors and lines of the background and of the sky. Default: pale, hazy and soft.
    #[reflect(@BlendField::Fields)]
    pub background: DepthLayer,
    /// What belongs to one layer as a whole. Default: [`Granularity::Object`].
    pub granularity: Granularity,
    /// Where the layers meet. Default: [`LayerBorders::Auto`].
    pub borders: LayerBorders,
    /// Place in the depth map (0 near, 1 far) at which the foreground ends, with
    /// [`LayerBorders::Fixed`]. Range 0 to 1, default 0.25.
    #[reflect(@FieldRange::FRACTION)]
    pub foreground_end: f32,
    /// Place in the depth map (0 near, 1 far) at which the background starts, with
    /// [`LayerBorders::Fixed`]; at least `foreground_end`. Range 0 to 1, default 0.65.
    #[reflect(@FieldRange::FRACTION)]
    pub background_start: f32,
    /// Width of both borders, as a fraction of the depth map: over it, one layer turns into the
    /// next. Range 0 to 0.5, default 0.08.
    #[reflect(@FieldRange::linear(0.0, 0.5))]
    pub softness: f32,
    /// Fraction of the change that is applied. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
}

/// Where the [`DepthLayers`] of a picture meet.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum LayerBorders {
    /// At the borders that best divide the visible distances into three groups: those that explain
    /// most of the variance of the logarithm of distance (Otsu 1979). They move only when other
    /// borders explain 5 % more, with the time constant of `RangeSmoothing::shrink`, or at once at
    /// a `CameraCut`. Without compute shaders, as [`LayerBorders::Fixed`].
    #[default]
    Auto,
    /// At `foreground_end` and `background_start` of the depth map.
    Fixed,
}

/// What belongs to one of the [`DepthLayers`], or has one [`Abstraction`](crate::Abstraction), as a
/// whole.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Granularity {
    /// An object, by the depth of its center, so that no figure is cut in two. An object that
    /// extends over more than 0.4 of the depth map, such as the ground, is divided by pixels; one
    /// that extends over less than 0.25 stays whole, and in between the two are blended. An object
    /// changes its layer only when its center has moved by 0.03 of the depth map, or by 15 % of its
    /// depth in it if that is less. The meshes of an `OutlineGroup` are one object. Needs object
    /// ids, which are drawn; without the crate's feature `objects`, as [`Granularity::Pixel`].
    #[default]
    Object,
    /// A pixel.
    Pixel,
}

impl Default for DepthLayers {
    fn default() -> Self {
        let plain = DepthLayer::PLAIN;
        Self {
            middle: DepthLayer {
                line_width: 0.75,
                saturation: 0.8,
                tint_amount: 0.1,
                ..plain
            },
            background: DepthLayer {
                line_width: 0.5,
                line_opacity: 0.6,
                saturation: 0.5,
                tint_amount: 0.6,
                contrast: 0.6,
                brightness: 0.12,
                ..plain
            },
            ..Self::PLAIN
        }
    }
}

impl Effect for DepthLayers {
    const NAME: &'static str = "depth_layers";
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = shader!("depth_layers", "DepthLayers");
    const VIEW: Option<EffectView> = Some(EffectView {
        label: "Depth layers",
        explanation: "The layers of the picture: foreground in red, middle in yellow, background in blue.",
    });
    type Uniform = DepthLayersUniform;

    fades_by!(amount);

    fn needs(&self) -> Needs {
        let mut needs = Needs::MAP | Needs::DEPTH;
        needs.set(
            Needs::OBJECT_DEPTHS,
            self.granularity == Granularity::Object,
        );
        needs.set(Needs::DEPTH_BORDERS, self.borders == LayerBorders::Auto);
        needs.set(Needs::LIGHTNESS_CHANGE | Needs::TONES, self.has_bands());
        needs
    }

    fn line_modifiers(&self, _: &EffectContext) -> LineModifiers {
        LineModifiers {
            layers: self.line_layers(),
            ..LineModifiers::default()
        }
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.flag("OBJECTS", self.granularity == Granularity::Object);
        variants.flag("BANDS", self.has_bands());
    }

    fn uniform(&self, _: &EffectContext) -> DepthLayersUniform {
        DepthLayersUniform {
            foreground: self.foreground.colors(),
            middle: self.middle.colors(),
            background: self.background.colors(),
            borders: self.fixed_borders().into(),
            softness: self.softness,
            amount: self.amount,
        }
    }
}

impl DepthLayers {
    /// Three layers that change nothing.
    pub const PLAIN: Self = Self {
        foreground: DepthLayer::PLAIN,
        middle: DepthLayer::PLAIN,
        background: DepthLayer::PLAIN,
        granularity: Granularity::Object,
        borders: LayerBorders::Auto,
        foreground_end: 0.25,
        background_start: 0.65,
        softness: 0.08,
        amount: 1.0,
    };

    fn has_bands(&self) -> bool {
        self.layers().iter().any(|layer| layer.bands > 0)
    }

    fn layers(&self) -> [DepthLayer; 3] {
        [self.foreground, self.middle, self.background]
    }

    /// Where the layers meet if they do not follow the scene.
    fn fixed_borders(&self) -> [f32; 2] {
        let first = self.foreground_end;
        [first, self.background_start.max(first)]
    }

    fn line_layers(&self) -> Option<LineLayers> {
        let depth_layers = self.layers();
        let part = |factor: f32| 1.0 + (factor - 1.0) * self.amount;
        let widths = depth_layers.map(|layer| part(layer.line_width));
        let opacities = depth_layers.map(|layer| part(layer.line_opacity));
        let color_amounts = depth_layers.map(|layer| layer.line_color_amount * self.amount);
        let differ =
            widths != [1.0; 3] || opacities != [1.0; 3] || color_amounts.iter().any(|a| *a > 0.0);
        differ.then(|| LineLayers {
            widths,
            opacities,
            colors: depth_layers.map(|layer| layer.line_color.to_linear()),
            color_amounts,
            borders: self.fixed_borders(),
            finds_borders: self.borders == LayerBorders::Auto,
            by_objects: self.granularity == Granularity::Object,
            softness: self.softness,
        })
    }
}

/// The uniform: `DepthLayers` in `depth_layers.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthLayersUniform {
    foreground: LayerColorsUniform,
    middle: LayerColorsUniform,
    background: LayerColorsUniform,
    borders: Vec2,
    softness: f32,
    amount: f32,
}
