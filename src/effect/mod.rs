//! What an effect is: the trait, the registry, the plan of a camera, and the
//! fused pass that is composed from the registered effects.

mod any;
mod blend;
mod choose;
mod compose;
mod errors;
mod facts;
mod key;
mod pass;
pub(crate) mod plan;
mod plugin;
mod prepare;
mod registry;
mod requests;
mod set;

use std::fmt::Debug;

use bevy::{
    ecs::component::{Component, Mutable},
    reflect::{FromReflect, GetTypeRegistration, Typed, structs::Struct},
    render::render_resource::{ShaderType, encase::internal::WriteInto},
};
use bitflags::bitflags;
use serde::{Serialize, de::DeserializeOwned};

pub use any::AnyEffect;
pub use facts::ViewFacts;
pub use key::Variants;
pub(crate) use plugin::FusedPlugin;
pub use registry::{EffectPlugin, EffectRegistry, EffectType};
pub use set::EffectSet;
pub(crate) use {choose::ViewPlan, plan::Plan};

use crate::{diagnostics::ComicsStage, lines::LineSettings};

/// A camera component that changes the picture: one function of a pixel, in
/// WGSL, with the settings that it takes.
///
/// All effects of a camera run in one full-screen pass. [`EffectPlugin`] registers
/// an effect; from that one line follow its place in the pass, its entry in style
/// files, transitions between styles, diagnostics and the inspector's panel. The
/// effects of this crate use the same trait. A guide with a complete example is in
/// `docs/your-own-effect.md`.
///
/// The component derives `Component`, `Reflect`, `Clone`, `Debug`, `PartialEq`,
/// `Serialize` and `Deserialize`, with `#[reflect(Default)]` and
/// `#[serde(default, deny_unknown_fields)]`, and implements `Default`. Its numbers
/// say their range by `#[reflect(@FieldRange::linear(0.0, 1.0))]`.
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
    /// The effect's name in `snake_case`, unique in the app: its key in style
    /// files, the name of its WGSL function and, in capitals, its shader
    /// definition.
    const NAME: &'static str;

    /// Where in the chain the effect applies. Within a stage, effects apply in
    /// the order in which they are registered.
    const STAGE: EffectStage;

    /// The effect's WGSL.
    const SHADER: EffectShader;

    /// Names of effects that this one draws in place of, where a camera has both.
    const REPLACES: &'static [&'static str] = &[];

    /// A debug view that shows what the effect computes, if it has one. Its WGSL
    /// function is called `NAME_view`; it takes the settings and the pixel as the
    /// effect left it, and returns a display-encoded colour.
    const VIEW: Option<EffectView> = None;

    /// The settings as the shader takes them; [`NoUniform`] if it takes none. On
    /// the GPU it starts at a multiple of 16 bytes.
    type Uniform: ShaderType + WriteInto;

    /// The settings that are used: every number in its documented range, what is
    /// not finite replaced by its default. Must return what is already in range
    /// unchanged.
    #[must_use]
    fn sanitized(self) -> Self;

    /// How much the effect changes, 0 to 1. An effect of strength 0 changes
    /// nothing, and is neither compiled, packed nor run.
    fn strength(&self) -> f32;

    /// The same effect with this fraction (0 to 1) of its strength: at 0 it
    /// changes nothing. Transitions between styles fade effects with it.
    #[must_use]
    fn faded(self, fraction: f32) -> Self;

    /// What the effect's WGSL reads besides its pixel's colour. Default: nothing.
    fn needs(&self) -> Needs {
        Needs::empty()
    }

    /// The effect on a view that lacks what is `missing`: a form of it that does
    /// not read that, or `None`. Default: `None` if the effect needs any of it.
    fn without(self, missing: Needs) -> Option<Self> {
        (!self.needs().intersects(missing)).then_some(self)
    }

    /// Lines that this effect requests. Of several effects of a camera the first one
    /// in the chain decides. Default: none.
    fn lines(&self) -> Option<LineSettings> {
        None
    }

    /// An effect that this one draws with, where the camera has none of that
    /// type. Default: none.
    fn implied(&self) -> Option<Box<dyn AnyEffect>> {
        None
    }

    /// Modes that select a shader variant. A change of them compiles a pipeline,
    /// so they should not follow a slider. Default: none.
    fn variants(&self, view: &ViewFacts, variants: &mut Variants) {
        let _ = (view, variants);
    }

    /// Packs the settings for the shader.
    fn uniform(&self, view: &ViewFacts) -> Self::Uniform;

    /// The effect `t` (0 to 1) of the way to another of equal modes. Default: by
    /// the fields; `f32` fields are interpolated (by ratio where their
    /// [`FieldRange`](crate::FieldRange) is logarithmic), colours in `OKLab`, and
    /// the rest is this effect's own.
    #[must_use]
    fn mixed(&self, other: &Self, t: f32) -> Self {
        blend::mixed(self, other, t)
    }

    /// Whether [`Effect::mixed`] leads from this effect to the other without a
    /// jump. If not, a transition fades the effect out, changes it half of the
    /// way, and fades it in. Default: by the fields; whatever is no number, no
    /// colour and not marked by [`BlendField`](crate::BlendField) is equal.
    fn same_modes(&self, other: &Self) -> bool {
        blend::same_modes(self, other)
    }

    /// The same effect with this fraction (0 to 1) of what depends on the depth
    /// map; a transition that changes the mapping fades it with this. Default:
    /// [`Effect::faded`] if the effect needs the map.
    #[must_use]
    fn map_faded(self, fraction: f32) -> Self {
        if self.needs().contains(Needs::MAP) {
            self.faded(fraction)
        } else {
            self
        }
    }

    /// Under which name `docs/report` has measured what the effect finds, if it
    /// has: the panel shows the error beside the time. Default: none.
    fn report_name(&self) -> Option<String> {
        None
    }
}

/// Where in the chain an effect applies: stages run in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum EffectStage {
    /// Tones of the unstyled picture.
    Tone,
    /// Colours.
    Color,
    /// Lines and areas of ink.
    Ink,
    /// The page on which the picture is printed.
    Page,
}

/// An effect's WGSL module.
///
/// Its struct of settings must be laid out as [`Effect::Uniform`]: where that is
/// smaller, the shader reads what lies behind it.
///
/// The module defines its own import path, a struct of settings, and the function
/// that applies the effect:
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
    /// The path by which the module is imported, as its `#define_import_path`
    /// says.
    pub path: &'static str,
    /// The module's text.
    pub source: &'static str,
    /// Name of the struct of settings, laid out as [`Effect::Uniform`]; `None` if
    /// the function takes the pixel alone.
    pub settings: Option<&'static str>,
}

/// A debug view of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EffectView {
    /// What a menu calls it.
    pub label: &'static str,
    /// What it shows, one sentence.
    pub explanation: &'static str,
}

bitflags! {
    /// What an effect's WGSL reads besides the colour of its pixel.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct Needs: u32 {
        /// The depth map: `Pixel::depth`. Runs the depth prepass, and the
        /// reduction if the map follows the visible range.
        const MAP = 1;
        /// Raw depth of any pixel: `bevy_comics::depth::view::load_depth`. Runs
        /// the depth prepass.
        const DEPTH = 1 << 1;
        /// World-space normals: `bevy_comics::depth::normal::load_normal`. Runs
        /// the normal prepass.
        const NORMALS = 1 << 2;
        /// Ids of objects: `bevy_comics::objects::load_object`. Needs the crate's
        /// feature `objects`.
        const IDS = 1 << 3;
        /// The lines at the pixel: `bevy_comics::lines::read::lines_at`. An effect
        /// with this need is left out where no effect asks for lines.
        const LINES = 1 << 4;
        /// The lines at other places than the pixel, several times per pixel.
        const LINES_ANYWHERE = 1 << 5;
        /// How much the lightness of the unstyled picture changes over a pixel:
        /// `Pixel::change`.
        const LIGHTNESS_CHANGE = 1 << 6;
    }
}

/// The uniform of an effect whose WGSL takes no settings.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub struct NoUniform {
    unused: u32,
}

impl ComicsStage {
    /// The stage of an effect.
    pub const fn of<E: Effect>() -> Self {
        Self::Effect(E::NAME)
    }
}
