//! Looks of their own for the foreground, the middle distance and the background.

mod style;

use bevy::{
    ecs::{component::Component, reflect::ReflectComponent},
    math::{FloatExt, Vec2},
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use style::PlaneColorsUniform;
pub use style::PlaneStyle;

use crate::{
    effect::{Effect, EffectShader, EffectStage, EffectView, Needs, Variants, ViewFacts},
    lines::LinePlanes,
    settings::{FieldRange, bounded},
};

/// Divides the picture into near, middle and far, and gives each plane colours and lines of its
/// own: the oldest way of comics to show depth (after Sauvaget and Boyer 2008).
///
/// The borders are those of the scene, wherever the camera is: where the visible distances fall
/// into three groups. The sky belongs to the far plane. With [`DepthMap::flip`](crate::DepthMap::flip),
/// near and far are exchanged.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Planes {
    /// Look of the foreground. Default: as it is.
    pub near: PlaneStyle,
    /// Look of the middle distance. Default: a little paler and bluer.
    pub middle: PlaneStyle,
    /// Look of the background, and of the sky. Default: pale, hazy and soft.
    pub far: PlaneStyle,
    /// What is in a plane as a whole. Default: [`PlaneUnit::Object`].
    pub by: PlaneUnit,
    /// Where the planes meet. Default: [`PlaneBorders::Auto`].
    pub borders: PlaneBorders,
    /// Place in the depth map (0 near, 1 far) at which the foreground ends, with
    /// [`PlaneBorders::Fixed`]. Range 0 to 1, default 0.25.
    #[reflect(@FieldRange::FRACTION)]
    pub near_end: f32,
    /// Place in the depth map (0 near, 1 far) at which the background starts, with
    /// [`PlaneBorders::Fixed`]; at least `near_end`. Range 0 to 1, default 0.65.
    #[reflect(@FieldRange::FRACTION)]
    pub far_start: f32,
    /// Width of both borders, as a fraction of the depth map: over it, one plane turns into the
    /// next. Range 0 to 0.5, default 0.08.
    #[reflect(@FieldRange::linear(0.0, 0.5))]
    pub softness: f32,
    /// Fraction of the change that is applied. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
}

/// Where the [`Planes`] of a picture meet.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum PlaneBorders {
    /// Where the visible distances fall into three groups (Otsu 1979): the borders explain as much
    /// as possible of the variance of the logarithm of distance. They move when others explain 5 %
    /// more, over the time constant of `RangeSmoothing::shrink`, and at once at a `CameraCut`.
    /// Without compute shaders, as [`PlaneBorders::Fixed`].
    #[default]
    Auto,
    /// At `near_end` and `far_start` of the depth map.
    Fixed,
}

/// What is in one of the [`Planes`] as a whole.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum PlaneUnit {
    /// An object: no figure is cut in two. It is where its centre is. What extends over more than
    /// 0.4 of the depth map, as the ground does, is divided by pixels; below 0.25, not at all; and
    /// between the two, in part. An object changes its plane only when its centre has moved by
    /// 0.03 of the depth map, or 15 % of its place in it if that is less. The meshes of an `OutlineGroup` are one object. Object ids are drawn;
    /// without the crate's feature `objects`, as [`PlaneUnit::Pixel`].
    #[default]
    Object,
    /// A pixel.
    Pixel,
}

impl Default for Planes {
    fn default() -> Self {
        let plain = PlaneStyle::PLAIN;
        Self {
            middle: PlaneStyle {
                line_width: 0.75,
                saturation: 0.8,
                tint_amount: 0.1,
                ..plain
            },
            far: PlaneStyle {
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

impl Effect for Planes {
    const NAME: &'static str = "planes";
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = EffectShader {
        path: "bevy_comics::effects::planes",
        source: include_str!("planes.wgsl"),
        settings: Some("Planes"),
    };
    const VIEW: Option<EffectView> = Some(EffectView {
        label: "Planes",
        explanation: "The planes of the picture: near in red, the middle in yellow, far in blue.",
    });
    type Uniform = PlanesUniform;

    fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            near: self.near.sanitized(),
            middle: self.middle.sanitized(),
            far: self.far.sanitized(),
            near_end: bounded(self.near_end, default.near_end, 0.0, 1.0),
            far_start: bounded(self.far_start, default.far_start, 0.0, 1.0),
            softness: bounded(self.softness, default.softness, 0.0, 0.5),
            amount: bounded(self.amount, default.amount, 0.0, 1.0),
            ..self
        }
    }

    fn strength(&self) -> f32 {
        self.amount
    }

    fn faded(self, fraction: f32) -> Self {
        let amount = self.amount * fraction;
        Self { amount, ..self }
    }

    fn needs(&self) -> Needs {
        let mut needs = Needs::MAP | Needs::DEPTH;
        needs.set(Needs::OBJECT_DEPTHS, self.by == PlaneUnit::Object);
        needs.set(Needs::DEPTH_BORDERS, self.borders == PlaneBorders::Auto);
        needs.set(Needs::LIGHTNESS_CHANGE, self.has_bands());
        needs
    }

    fn line_planes(&self, _: &ViewFacts) -> Option<LinePlanes> {
        let planes = [self.near, self.middle, self.far];
        let part = |factor: f32| 1.0 + (factor - 1.0) * self.amount;
        let widths = planes.map(|plane| part(plane.line_width));
        let opacities = planes.map(|plane| part(plane.line_opacity));
        let color_amounts = planes.map(|plane| plane.line_color_amount * self.amount);
        let differ =
            widths != [1.0; 3] || opacities != [1.0; 3] || color_amounts.iter().any(|a| *a > 0.0);
        differ.then(|| LinePlanes {
            widths,
            opacities,
            colors: planes.map(|plane| plane.line_color.to_linear()),
            color_amounts,
            borders: [self.near_end, self.far_start.max(self.near_end)],
            finds_borders: self.borders == PlaneBorders::Auto,
            by_objects: self.by == PlaneUnit::Object,
            softness: self.softness,
        })
    }

    fn variants(&self, _: &ViewFacts, variants: &mut Variants) {
        variants.flag("OBJECTS", self.by == PlaneUnit::Object);
        variants.number("BANDS", u32::from(self.has_bands()));
    }

    fn uniform(&self, _: &ViewFacts) -> PlanesUniform {
        PlanesUniform {
            near: self.near.colors(),
            middle: self.middle.colors(),
            far: self.far.colors(),
            borders: Vec2::new(self.near_end, self.far_start.max(self.near_end)),
            softness: self.softness,
            amount: self.amount,
        }
    }

    fn mixed(&self, other: &Self, t: f32) -> Self {
        Self {
            near: self.near.mixed(other.near, t),
            middle: self.middle.mixed(other.middle, t),
            far: self.far.mixed(other.far, t),
            by: self.by,
            borders: self.borders,
            near_end: self.near_end.lerp(other.near_end, t),
            far_start: self.far_start.lerp(other.far_start, t),
            softness: self.softness.lerp(other.softness, t),
            amount: self.amount.lerp(other.amount, t),
        }
    }

    fn same_modes(&self, other: &Self) -> bool {
        (self.by, self.borders) == (other.by, other.borders)
    }
}

impl Planes {
    /// Three planes without a look of their own.
    pub const PLAIN: Self = Self {
        near: PlaneStyle::PLAIN,
        middle: PlaneStyle::PLAIN,
        far: PlaneStyle::PLAIN,
        by: PlaneUnit::Object,
        borders: PlaneBorders::Auto,
        near_end: 0.25,
        far_start: 0.65,
        softness: 0.08,
        amount: 1.0,
    };

    fn has_bands(&self) -> bool {
        [self.near, self.middle, self.far]
            .iter()
            .any(|plane| plane.bands > 0)
    }
}

/// The uniform: `Planes` in `planes.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanesUniform {
    near: PlaneColorsUniform,
    middle: PlaneColorsUniform,
    far: PlaneColorsUniform,
    borders: Vec2,
    softness: f32,
    amount: f32,
}
