//! Draws focus lines and speed lines.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Variants},
    settings::{BlendField, FieldRange, color_serde, linear_rgb},
};

/// Draws lines that run towards a point (focus lines) or alongside each other (speed lines),
/// over the picture. Around the point, an ellipse with the viewport's aspect ratio stays
/// clear.
///
/// Each line tapers like a pen stroke: it widens from a point at its inner end towards the farthest
/// corner of the picture. Places, lengths and widths are random and change with every drawing. The
/// point is a place of the viewport, or follows the camera's
/// [`EffectTarget`](crate::effect::EffectTarget). Reads no texture.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SpeedLines {
    /// How the lines run. Default: [`SpeedLineKind::Radial`].
    pub kind: SpeedLineKind,
    /// Position of the point, as fractions of the viewport's width and height from its top left
    /// corner. Range of each component -1 to 2, default 0.5.
    #[reflect(@FieldRange::linear(-1.0, 2.0))]
    pub center: Vec2,
    /// Direction of parallel lines in degrees: 0 is horizontal, and lines of positive angles
    /// rise to the right. Range -180 to 180, default 0.
    #[reflect(@FieldRange::linear(-180.0, 180.0).unit("°"))]
    pub angle: f32,
    /// Number of lines: around the point, or across the viewport. Range 20 to 400, default
    /// 120.
    #[reflect(@FieldRange::linear(20.0, 400.0), @BlendField::Switch)]
    pub count: u32,
    /// Size of the ellipse that stays clear, as a fraction of the viewport's. Range 0 to
    /// 1.5, default 0.45. Single lines begin up to 80 % further out.
    #[reflect(@FieldRange::linear(0.0, 1.5))]
    pub inner: f32,
    /// Width of the widest lines at the border of the picture, in logical pixels. Range 1 to
    /// 40, default 12. The narrowest have a fifth of it. Lines are at most about twice as
    /// wide as they are apart.
    #[reflect(@FieldRange::linear(1.0, 40.0).unit("px"))]
    pub width: f32,
    /// How dry the brush is: it leaves streaks of the lines out. Range 0 (wet: whole lines) to
    /// 1 (almost nothing is left), default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub dry_brush: f32,
    /// Drawings per second. Range 0 (one drawing for all time) to 60, default 12.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("/ s"))]
    pub rate: f32,
    /// Seed of the random lines. Default: 0.
    #[reflect(@FieldRange::linear(0.0, 65535.0), @BlendField::Switch)]
    pub seed: u32,
    /// Color of the lines. Default: black. Components are clamped to what a display shows;
    /// alpha is ignored.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Opacity of the lines. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

/// How [`SpeedLines`] run.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum SpeedLineKind {
    /// Towards the point: focus lines.
    #[default]
    Radial,
    /// Alongside each other, from both sides towards the point: speed lines.
    Parallel,
}

impl Default for SpeedLines {
    fn default() -> Self {
        Self {
            kind: SpeedLineKind::Radial,
            center: Vec2::splat(0.5),
            angle: 0.0,
            count: 120,
            inner: 0.45,
            width: 12.0,
            dry_brush: 0.0,
            rate: 12.0,
            seed: 0,
            color: Color::BLACK,
            opacity: 1.0,
        }
    }
}

impl Effect for SpeedLines {
    const NAME: &'static str = "speed_lines";
    const STAGE: EffectStage = EffectStage::Ink;
    const SHADER: EffectShader = shader!("speed_lines", "SpeedLines");
    type Uniform = SpeedLinesUniform;

    fades_by!(opacity);

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.number("KIND", self.kind as u32);
        variants.flag("DRY", self.dry_brush > 0.0);
    }

    fn uniform(&self, view: &EffectContext) -> SpeedLinesUniform {
        let size = Vec2::new(view.viewport.z as f32, view.viewport.w as f32).max(Vec2::ONE);
        let own = self.center * size;
        let center = view.target.unwrap_or(own).clamp(-size, 2.0 * size);
        let (sin, cos) = self.angle.to_radians().sin_cos();
        let axis = Vec2::new(cos, -sin);
        // From the point to the farthest corner, and along the lines to the farthest one.
        let corner = center.abs().max((size - center).abs());
        let (far, across) = match self.kind {
            SpeedLineKind::Radial => (corner.length(), 0.0),
            SpeedLineKind::Parallel => (
                corner.dot(axis.abs()),
                size.dot(Vec2::new(axis.y, axis.x).abs()),
            ),
        };
        SpeedLinesUniform {
            color: linear_rgb(self.color),
            opacity: self.opacity,
            center,
            // Not 0: places are divided by it.
            hole: (0.5 * self.inner * size).max(Vec2::splat(1e-3)),
            axis,
            far,
            half_width: 0.5 * self.width * view.scale_factor,
            count: self.count as i32,
            seed: (self.seed << 16) | view.animation_seed(self.rate),
            spacing: across / self.count as f32,
            kind: self.kind as u32,
            dry_brush: self.dry_brush,
            unit: view.scale_factor,
        }
    }
}

/// The uniform: `SpeedLines` in `speed_lines.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct SpeedLinesUniform {
    color: Vec3,
    opacity: f32,
    center: Vec2,
    hole: Vec2,
    axis: Vec2,
    far: f32,
    half_width: f32,
    count: i32,
    seed: u32,
    spacing: f32,
    kind: u32,
    dry_brush: f32,
    unit: f32,
}
