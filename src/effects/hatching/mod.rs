//! Shades with strokes that lie on things.

use std::f32::consts::FRAC_PI_4;

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{
        Effect, EffectContext, EffectShader, EffectStage, Needs, Strokes, Variants, dot_eyes,
        stroke_eyes,
    },
    settings::{BlendField, FieldRange, color_serde, linear_rgb},
};

/// Shades with strokes: hatching in the half tones, crossed in the shadows, bare where it is light.
///
/// Strokes lie where surfaces meet families of parallel planes, as in an engraving: they follow the
/// form of things, without texture coordinates. They stay on things that stand still, and on moving
/// objects that have a [`PatternAnchor`](crate::objects::PatternAnchor). Their width on the screen
/// stays the same: when a thing comes nearer, new strokes grow between the old ones. The mean of an
/// area has the darkness that is asked for.
///
/// Strokes are drawn on the geometry of the prepasses, in multisampled views on that of the first
/// sample; transparent things are hatched by what lies behind them. Skinned and morphed meshes move
/// under their strokes. The views of cameras with this effect are styled after FXAA and SMAA.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Hatching {
    /// What hatching is drawn with. Default: [`HatchingKind::Strokes`].
    pub kind: HatchingKind,
    /// What strokes are fixed to. Default: [`HatchingAnchor::Object`].
    pub anchor: HatchingAnchor,
    /// What decides how dark the hatching is. Default: [`HatchingSource::Picture`].
    pub source: HatchingSource,
    /// Lightness (0 black, 1 white) up to which hatching is darkest. Range 0 to 0.9, default 0.15.
    #[reflect(@FieldRange::linear(0.0, 0.9))]
    pub solid_below: f32,
    /// Lightness from which there are no strokes, at least 0.05 more than `solid_below`. Range 0.05
    /// to 1, default 0.7.
    #[reflect(@FieldRange::linear(0.05, 1.0))]
    pub bare_above: f32,
    /// Exponent of the darkness between the two: above 1, middle tones have fewer strokes. Range
    /// 0.25 to 4, default 1.
    #[reflect(@FieldRange::logarithmic(0.25, 4.0))]
    pub gamma: f32,
    /// Number of tones of the hatching, in equal steps. Range 0 (all tones) to 12, default 0.
    #[reflect(@FieldRange::linear(0.0, 12.0), @BlendField::Switch)]
    pub tones: u32,
    /// Least distance of neighboring strokes in logical pixels. It grows to twice this as the
    /// camera comes nearer, while new strokes grow in between. Dots are this far apart at
    /// `layer_darkness`; they are three quarters of it wide by default. Range 2 to 24, default 4.
    #[reflect(@FieldRange::logarithmic(2.0, 24.0).unit("px"))]
    pub spacing: f32,
    /// Number of directions of strokes: crossing ones begin where the first has
    /// `layer_darkness`. Dots take as many layers as the tone needs, up to five, then a plain tone.
    /// Range 1 to 3, default 2.
    #[reflect(@FieldRange::linear(1.0, 3.0), @BlendField::Switch)]
    pub layers: u32,
    /// Darkness of one direction of strokes at which the next direction begins. The last direction
    /// darkens to black. Dots clamp it to 0.3 to 0.5, because denser dots would touch. Range 0.1 to
    /// 0.9, default 0.45.
    #[reflect(@FieldRange::linear(0.1, 0.9))]
    pub layer_darkness: f32,
    /// Turn of all strokes in degrees: about the vertical axis of the world or the object, or on
    /// the page. Range -90 to 90, default 0.
    #[reflect(@FieldRange::linear(-90.0, 90.0).unit("°"))]
    pub angle: f32,
    /// Average length of a stroke in logical pixels. Dots ignore it. Range 10 to 400, default 80.
    #[reflect(@FieldRange::logarithmic(10.0, 400.0).unit("px"))]
    pub length: f32,
    /// How thin strokes become at their ends, from 0 (lines without ends) to 1 (gaps between
    /// strokes). Dots ignore it. Range 0 to 1, default 0.6.
    #[reflect(@FieldRange::FRACTION)]
    pub breaks: f32,
    /// How far strokes stray from their lines, and dots from their rows, as a fraction of the
    /// distance at which they would meet their neighbors. Range 0 to 1, default 0.3.
    #[reflect(@FieldRange::FRACTION)]
    pub wobble: f32,
    /// How much the width of a stroke, or the area of a dot, varies. Range 0 to 1, default 0.3.
    #[reflect(@FieldRange::FRACTION)]
    pub pressure: f32,
    /// How often `wobble` and `pressure` change, in drawings per second. Strokes stay where they
    /// are. Range 0 (never) to 60, default 0.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("/ s"))]
    pub rate: f32,
    /// How far strokes turn into a plain tone of the same darkness on details that are narrower
    /// than the gap between two strokes, such as grass, leaves and distant things. Reads the depth
    /// at four more places. Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub simplify_small: f32,
    /// Color of the strokes. Default: black. Components are clamped to what a display shows;
    /// alpha is ignored.
    #[serde(with = "color_serde")]
    pub ink: Color,
    /// What is between strokes. Default: [`HatchingGround::Color`].
    pub ground: HatchingGround,
    /// The paper of [`HatchingGround::Paper`]. Default: white.
    #[serde(with = "color_serde")]
    pub paper: Color,
    /// Factor of the darkness at the near end of the depth map. Range 0 to 1, default 1. The depth
    /// map is read if `at_near` and `at_far` differ.
    #[reflect(@FieldRange::FRACTION)]
    pub at_near: f32,
    /// The same at the far end. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub at_far: f32,
    /// How much of the hatching and its ground is seen over the picture. Range 0 (the effect is
    /// left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

/// What the strokes of a [`Hatching`] are fixed to.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HatchingAnchor {
    /// The surfaces of things: strokes follow their shape. They are fixed to the world, or to an
    /// object that has a [`PatternAnchor`](crate::objects::PatternAnchor). Needs depth and normals;
    /// without them, strokes are fixed to the page.
    #[default]
    Object,
    /// The page: strokes are parallel, and stand still while things move under them (Lake et al.
    /// 2000). The sky is hatched too.
    Page,
}

/// What a [`Hatching`] is drawn with.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HatchingKind {
    /// Strokes.
    #[default]
    Strokes,
    /// Dots of one size, as many as the tone asks for: stipple. They lie on surfaces as strokes do,
    /// are anchored as strokes are, and grow one by one between the others when a thing comes
    /// nearer. On surfaces that are seen at an angle, they are ellipses.
    Dots,
}

/// What is between the strokes of a [`Hatching`].
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HatchingGround {
    /// The colors of the picture, brighter under strokes, so that the mean of an area keeps its
    /// color as far as the display can show that.
    #[default]
    Color,
    /// A sheet of one color: [`Hatching::paper`].
    Paper,
}

/// What decides how dark a [`Hatching`] is.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HatchingSource {
    /// The lightness of the picture, so dark colors are hatched as well as shadows.
    #[default]
    Picture,
    /// The direction in which a surface faces: lightness 1 towards the
    /// [`KeyLight`](crate::KeyLight), a half beside it, 0 away from it. Colors and cast shadows
    /// have no effect. With [`HatchingAnchor::Page`], the same as [`HatchingSource::Picture`].
    Facing,
}

impl Default for Hatching {
    fn default() -> Self {
        Self {
            kind: HatchingKind::Strokes,
            anchor: HatchingAnchor::Object,
            source: HatchingSource::Picture,
            solid_below: 0.15,
            bare_above: 0.7,
            gamma: 1.0,
            tones: 0,
            spacing: 4.0,
            layers: 2,
            layer_darkness: 0.45,
            angle: 0.0,
            length: 80.0,
            breaks: 0.6,
            wobble: 0.3,
            pressure: 0.3,
            rate: 0.0,
            simplify_small: 0.0,
            ink: Color::srgb(0.0, 0.0, 0.0),
            ground: HatchingGround::Color,
            paper: Color::srgb(1.0, 1.0, 1.0),
            at_near: 1.0,
            at_far: 1.0,
            opacity: 1.0,
        }
    }
}

impl Effect for Hatching {
    const NAME: &'static str = "hatching";
    const STAGE: EffectStage = EffectStage::Print;
    const SHADER: EffectShader = shader!("hatching", "Hatching");
    type Uniform = HatchingUniform;

    fades_by!(opacity);

    fn needs(&self) -> Needs {
        let mut needs = Needs::empty();
        needs.set(Needs::MAP, self.at_near != self.at_far);
        needs.set(Needs::TONES, !self.faces());
        if self.anchor == HatchingAnchor::Object {
            needs |= Needs::DEPTH | Needs::NORMALS | Needs::OBJECT_ANCHORS | Needs::WORLD_ORIGIN;
        }
        needs
    }

    fn without(self, missing: Needs) -> Option<Self> {
        let at_near = if missing.contains(Needs::MAP) {
            self.at_far
        } else {
            self.at_near
        };
        let anchor = if missing.intersects(Needs::DEPTH | Needs::NORMALS) {
            HatchingAnchor::Page
        } else {
            self.anchor
        };
        Some(Self {
            at_near,
            anchor,
            ..self
        })
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        let on_things = self.anchor == HatchingAnchor::Object;
        variants.flag("DOTS", self.kind == HatchingKind::Dots);
        variants.flag("ON_THINGS", on_things);
        variants.flag("SIMPLIFY_SMALL", on_things && self.simplify_small > 0.0);
        variants.flag("FACES", self.faces());
    }

    fn map_faded(self, fraction: f32) -> Self {
        let at_near = self.at_far + (self.at_near - self.at_far) * fraction;
        Self { at_near, ..self }
    }

    fn uniform(&self, view: &EffectContext) -> HatchingUniform {
        let eyes = match self.kind {
            HatchingKind::Strokes => stroke_eyes,
            HatchingKind::Dots => dot_eyes,
        };
        let axes = self.axes().map(|axis| axis.as_dvec3().normalize());
        HatchingUniform {
            relative_from_clip: view.relative_from_clip,
            strokes: self.strokes(view.scale_factor, view.animation_seed(self.rate)),
            eye: view.eye,
            at_near: self.at_near,
            to_light: view.to_light,
            at_far: self.at_far,
            simplify_small: self.simplify_small,
            eyes: eyes(axes, view.world_origin + view.eye.as_dvec3()),
        }
    }
}

impl Hatching {
    /// Whether the direction of surfaces decides how dark it is, not the picture.
    fn faces(&self) -> bool {
        self.anchor == HatchingAnchor::Object && self.source == HatchingSource::Facing
    }

    /// The strokes of a drawing. `scale`: physical pixels per unit of length.
    pub(crate) fn strokes(&self, scale: f32, seed: u32) -> Strokes {
        let [x, y, z] = self.axes();
        Strokes {
            axes: Mat3::from_cols(x, y, z),
            ink: linear_rgb(self.ink),
            opacity: self.opacity,
            paper: linear_rgb(self.paper),
            spacing: self.spacing * scale,
            length: self.length * scale,
            layers: self.layers,
            layer_darkness: self.layer_darkness,
            solid_below: self.solid_below,
            bare_above: self.bare_above.max(self.solid_below + 0.05),
            gamma: self.gamma,
            levels: self.tones as f32,
            breaks: self.breaks,
            wobble: self.wobble,
            pressure: self.pressure,
            seed,
            ground: u32::from(self.ground == HatchingGround::Paper),
        }
    }

    /// Unit normals of the families of planes, at right angles; of dots, normals of the planes that
    /// they lie in.
    pub fn axes(&self) -> [Vec3; 3] {
        let turn = self.angle.to_radians();
        let axes = match (self.anchor, self.kind) {
            (HatchingAnchor::Page, HatchingKind::Strokes) => {
                Mat3::from_rotation_z(turn + FRAC_PI_4)
            }
            (HatchingAnchor::Page, HatchingKind::Dots) => Mat3::from_rotation_z(turn),
            // No side of a box sees one of them from its end.
            (HatchingAnchor::Object, HatchingKind::Strokes) => {
                Mat3::from_rotation_y(turn)
                    * Mat3::from_cols(
                        Vec3::new(2.0, 2.0, -1.0) / 3.0,
                        Vec3::new(-1.0, 2.0, 2.0) / 3.0,
                        Vec3::new(2.0, -1.0, 2.0) / 3.0,
                    )
            }
            (HatchingAnchor::Object, HatchingKind::Dots) => Mat3::from_rotation_y(turn),
        };
        [axes.x_axis, axes.y_axis, axes.z_axis]
    }
}

/// The uniform: `Hatching` in `hatching.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, PartialEq)]
pub struct HatchingUniform {
    relative_from_clip: Mat4,
    strokes: Strokes,
    eye: Vec3,
    at_near: f32,
    to_light: Vec3,
    at_far: f32,
    simplify_small: f32,
    eyes: [IVec4; 15],
}
