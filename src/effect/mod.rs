//! Effects of your own: the trait [`Effect`], its registration, and what an effect is written with.
//!
//! `docs/your-own-effect.md` is a guide with a complete example.

mod any;
mod context;
pub(crate) mod names;
mod needs;
mod registry;
mod set;
mod strokes;
mod target;
mod variants;

use std::fmt::Debug;

use bevy::{
    app::App,
    ecs::component::{Component, Mutable},
    reflect::{FromReflect, GetTypeRegistration, Typed, structs::Struct},
    render::render_resource::{ShaderType, encase::internal::WriteInto},
    shader::load_shader_library,
};
use serde::{Serialize, de::DeserializeOwned};

pub use crate::settings::{
    BlendField, FieldRange, HueWheel, blend_color, blend_ratio, clamp_color,
    clamp_option_or_default, clamp_or_default, clamp_vec2_or_default, color_serde, linear_rgb,
};
pub(crate) use any::encode;
pub use any::{AnyEffect, EffectType};
pub use context::EffectContext;
pub use needs::Needs;
pub use registry::{EffectPlugin, EffectRegistry};
pub use set::EffectSet;
pub(crate) use strokes::{Strokes, dot_eyes, stroke_eyes};
pub use target::EffectTarget;
pub(crate) use target::place_in;
pub use variants::Variants;
pub(crate) use variants::definition;

use crate::{
    diagnostics::ComicsStage,
    lines::{LineModifiers, MapJumps, Outlines},
    settings::{clamp_fields, mix_fields, same_modes},
    tones::ToneRange,
};

/// A camera component that changes the picture: one WGSL function of a pixel, and
/// its settings.
///
/// All effects of a camera run in one full-screen pass. [`EffectPlugin`] registers an effect: it
/// adds the effect to the pass, to style files, to transitions between styles, to the diagnostics
/// and to the inspector's panel. The effects of this crate use the same trait.
/// `docs/your-own-effect.md` is a guide with a complete example.
///
/// The component derives `Component`, `Reflect`, `Clone`, `Debug`, `PartialEq`, `Serialize` and
/// `Deserialize`, with `#[reflect(Component, Default)]` and
/// `#[serde(default, deny_unknown_fields)]`, and implements `Default`. The attribute
/// `#[reflect(@FieldRange::linear(0.0, 1.0))]` on a number states its range.
pub trait Effect:
    Component<Mutability = Mutable>
    + Struct
    + FromReflect
    + Typed
    + GetTypeRegistration
    + Default
    + Clone
    + PartialEq
    + Debug
    + Serialize
    + DeserializeOwned
{
    /// The effect's name, unique in the app: its key in style files, the name of its WGSL function
    /// and, in capitals after `EFFECT_`, its shader definition. In `snake_case`; the last character
    /// is a letter.
    const NAME: &'static str;

    /// When the effect applies. Stages run in the order of [`EffectStage`]; within
    /// a stage, effects run in the order in which they are registered.
    const STAGE: EffectStage;

    /// The effect's WGSL module.
    const SHADER: EffectShader;

    /// Names of the effects that this one replaces: on a camera that has both, only
    /// this one is drawn. Default: none.
    const REPLACES: &'static [&'static str] = &[];

    /// A debug view that shows what the effect computes, if it has one. Its WGSL function is called
    /// `NAME_view`. It takes the settings and the pixel that the effect returned, and returns a
    /// display-encoded (sRGB) color. Default: none.
    const VIEW: Option<EffectView> = None;

    /// Whether the module has a function `NAME_half_box` for [`Needs::BOX_STATISTICS`]: it takes
    /// the settings and a pixel, of which only the places and the depth are set, and returns half
    /// the side of the box around it in physical pixels. Default: false.
    const HALF_BOX: bool = false;

    /// Whether the module has a function `NAME_aux_scalar` for [`Needs::AUX_SCALAR`]: it takes the
    /// settings and a pixel, of which only the places and the depth are set, and returns any
    /// number. Default: false.
    const AUX_SCALAR: bool = false;

    /// Whether the effect divides the picture into few tones, where the engine's dither shows as
    /// dots: [`StyleDither::Auto`](crate::style::StyleDither::Auto) then turns it off. Default:
    /// false.
    const DIVIDES_TONES: bool = false;

    /// The settings in the layout of the WGSL struct; [`NoUniform`] if the function
    /// takes none. In the uniform buffer it starts at a multiple of 16 bytes.
    type Uniform: ShaderType + WriteInto;

    /// The settings that are used. Values in range must be returned unchanged. Default: every
    /// `f32`, `u32`, `Vec2` and `Vec3` with a [`FieldRange`] is clamped to it, and every `Color` to
    /// what a display shows, also in structs, options and variants of enums. What is not finite
    /// becomes that of [`Default`]; if this has another variant there, the least number of the
    /// range, or black. Lists and fields without a range are not changed.
    #[must_use]
    fn sanitized(self) -> Self {
        clamp_fields(self)
    }

    /// How much the effect changes the picture, 0 to 1. An effect of strength 0 is not run.
    fn strength(&self) -> f32;

    /// The same effect at a fraction (0 to 1) of its strength; at 0 it changes
    /// nothing. Transitions between styles use it to fade effects in and out.
    #[must_use]
    fn faded(self, fraction: f32) -> Self;

    /// The inputs that the effect's WGSL reads besides its pixel's color. Default: none.
    fn needs(&self) -> Needs {
        Needs::empty()
    }

    /// The effect on a view that cannot provide the `missing` inputs: a version of
    /// it that does not read them, or `None` to leave it out. Default: `None` if the
    /// effect needs any of them.
    fn without(self, missing: Needs) -> Option<Self> {
        (!self.needs().intersects(missing)).then_some(self)
    }

    /// The lines that this effect requests; every number must be in its range. If several effects
    /// of a camera request lines, the request of the first one in the chain is used. Default: none.
    fn lines(&self) -> Option<Outlines> {
        None
    }

    /// The range of tones that this effect requests; every number must be in its range. In WGSL,
    /// `Pixel::toned` is then the unstyled picture in that range, and
    /// `bevy_comics::tones::in_tone_range` brings other colors into it. If several effects of a camera
    /// request one, that of the first one in the chain is used. The effect is left out while no
    /// effect of the camera has [`Needs::TONES`], and without compute shaders. Default: none.
    fn tones(&self) -> Option<ToneRange> {
        None
    }

    /// Another effect that this one depends on. It is added to the camera's plan if
    /// the camera has no effect of that type. Default: none.
    fn implied(&self) -> Option<Box<dyn AnyEffect>> {
        None
    }

    /// Modes that select a shader variant. Every new combination compiles a
    /// pipeline, so modes should not depend on a slider. Default: none.
    fn variants(&self, view: &EffectContext, variants: &mut Variants) {
        let _ = (view, variants);
    }

    /// For [`Needs::BOX_STATISTICS`]: how many pixels the boxes reach from their middle at most. Up
    /// to 6 are compiled in, which is faster where most boxes reach as far. Default: boxes of any
    /// size.
    fn max_radius(&self, view: &EffectContext) -> Option<u32> {
        let _ = view;
        None
    }

    /// Where the effect can change the picture. The fused pass leaves it out of the rest.
    /// Default: [`AffectedArea::Everywhere`].
    fn affected_area(&self, view: &EffectContext) -> AffectedArea {
        let _ = view;
        AffectedArea::Everywhere
    }

    /// How far from its pixel the effect's WGSL reads lines, in physical pixels per axis; `None` if
    /// that is not known. If all effects that read lines state it, the fused pass defines
    /// `WITHOUT_LINES` where no line is that near, and `lines_at` finds no ink there. Default:
    /// `None`.
    fn line_reach(&self, view: &EffectContext) -> Option<f32> {
        let _ = view;
        None
    }

    /// What the effect changes about the lines of its camera. Where several effects of a camera
    /// make the same kind of change, that of the first one in the chain applies. Default: nothing.
    fn line_modifiers(&self, view: &EffectContext) -> LineModifiers {
        let _ = view;
        LineModifiers::default()
    }

    /// Whether the view is styled after FXAA and SMAA, because the effect draws dots or grain that
    /// these would smear. Default: for effects of the stage [`EffectStage::Print`].
    fn runs_after_anti_aliasing(&self) -> bool {
        Self::STAGE == EffectStage::Print
    }

    /// Packs the settings for the shader.
    fn uniform(&self, view: &EffectContext) -> Self::Uniform;

    /// Interpolates between this effect (`t` = 0) and `other` (`t` = 1). Default:
    /// numbers (`f32`, `Vec2`, `Vec3`) are interpolated linearly, or by ratio if their
    /// [`FieldRange`] is logarithmic; colors are interpolated in
    /// `OKLab`; fields marked by [`BlendField::Fields`] are interpolated field by field; all others
    /// keep this effect's values.
    #[must_use]
    fn mixed(&self, other: &Self, t: f32) -> Self {
        mix_fields(self, other, t)
    }

    /// Whether [`Effect::mixed`] leads from this effect to the other without a
    /// jump. If not, a transition fades the effect out, exchanges the settings at
    /// half time, and fades the effect in. Default: true if all fields are equal
    /// that are neither interpolated nor marked by [`BlendField::Switch`].
    fn same_modes(&self, other: &Self) -> bool {
        same_modes(self, other)
    }

    /// The same effect with only a fraction (0 to 1) of its dependence on the depth
    /// map. Transitions that change the map's mapping use it to fade that part out
    /// and in. Default: [`Effect::faded`] if the effect needs the map, otherwise the
    /// effect itself.
    #[must_use]
    fn map_faded(self, fraction: f32) -> Self {
        if self.needs().contains(Needs::MAP) {
            self.faded(fraction)
        } else {
            self
        }
    }
}

/// Where an effect can change the picture.
///
/// An effect that is not [`Everywhere`](Self::Everywhere) only draws over the picture:
/// the color and alpha that it returns are
/// `mix(vec4(p.color, p.alpha), vec4(ink, 1.0), opacity)`, and neither `ink` nor
/// `opacity` depends on the picture. If all effects of a camera are of this kind, the
/// fused pass is blended over the picture instead of copying it, unless the camera is HDR.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum AffectedArea {
    /// At any pixel.
    Everywhere,
    /// Where the lines of the camera have ink.
    AtLines,
    /// Where the depth map departs from planes.
    AtJumps(MapJumps),
}

/// When an effect applies. The stages run in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum EffectStage {
    /// Changes the lightness of the picture, before colors and ink are added.
    Tone,
    /// Changes the colors of the picture.
    Color,
    /// Prints the colors: plates and screens. A view with such an effect is styled after
    /// FXAA and SMAA instead of before: these would smear dots.
    Print,
    /// Draws lines and areas of ink over the colors.
    Ink,
    /// Changes the whole picture, ink included, as paper and print do.
    Page,
}

/// An effect's WGSL module.
///
/// The module defines its own import path, a struct of settings, and the function
/// that applies the effect. The struct must have the layout of
/// [`Effect::Uniform`]: if the uniform is smaller, the shader reads the bytes that
/// follow it.
///
/// ```wgsl
/// #define_import_path my_game::tint
/// #import bevy_comics::effect::pixel::Pixel
///
/// struct Tint { color: vec3<f32>, amount: f32 }
///
/// fn tint(s: Tint, p: Pixel) -> Pixel {
///     var out = p;
///     out.color = mix(p.color, p.color * s.color, s.amount);
///     return out;
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct EffectShader {
    /// The import path that the module defines with `#define_import_path`.
    pub path: &'static str,
    /// The WGSL text of the module.
    pub source: &'static str,
    /// The name of the struct of settings; `None` if the function takes only the
    /// pixel.
    pub settings: Option<&'static str>,
}

/// The texts of an effect's debug view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EffectView {
    /// The name in menus.
    pub label: &'static str,
    /// One sentence that says what the view shows.
    pub explanation: &'static str,
}

/// The uniform of an effect whose WGSL function takes no settings.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub struct NoUniform {
    unused: u32,
}

impl ComicsStage {
    /// The stage that reports on an effect of this type.
    pub const fn of<E: Effect>() -> Self {
        Self::Effect(E::NAME)
    }
}

/// Loads the WGSL modules that effects import.
pub(crate) fn load_shaders(app: &mut App) {
    load_shader_library!(app, "aux_scalar.wgsl");
    load_shader_library!(app, "blue_noise.wgsl");
    load_shader_library!(app, "box_statistics.wgsl");
    load_shader_library!(app, "color.wgsl");
    load_shader_library!(app, "footprint.wgsl");
    load_shader_library!(app, "nested.wgsl");
    load_shader_library!(app, "noise.wgsl");
    load_shader_library!(app, "picture.wgsl");
    load_shader_library!(app, "pixel.wgsl");
    load_shader_library!(app, "screen.wgsl");
    load_shader_library!(app, "sheet.wgsl");
    load_shader_library!(app, "similarity.wgsl");
    load_shader_library!(app, "stipple.wgsl");
    load_shader_library!(app, "strokes.wgsl");
}
