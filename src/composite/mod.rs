//! What comes after the effects: the mix with the original picture, the split view,
//! the debug views, and the pixels that effects change.

mod mask;

use bevy::{prelude::*, render::render_resource::ShaderType, shader::load_shader_library};

use crate::settings::{FieldRange, clamp_or_default};

pub use mask::{BeyondPrepass, StyleMask};
pub(crate) use mask::{DRAWN_DEPTH_BINDING, OwnPixels};

/// Mixes the styled picture of a camera with the original, in linear light: the
/// fraction of the styled picture. Range 0 to 1, default 1.
///
/// 1 has the same result as no component; at 0 no effect runs. A number that is not
/// finite counts as 1.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct StyleWeight(pub f32);

impl Default for StyleWeight {
    fn default() -> Self {
        Self(1.0)
    }
}

/// Shows the original picture left of a vertical line, and the styled picture right
/// of it.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct SplitView {
    /// Position of the line from the left edge of the viewport, as a fraction of its
    /// width. Range 0 (all styled) to 1 (all original), default 0.5.
    #[reflect(@FieldRange::FRACTION)]
    pub at: f32,
}

impl Default for SplitView {
    fn default() -> Self {
        Self { at: 0.5 }
    }
}

/// Shows an intermediate result of a camera's effects instead of the picture.
///
/// The view computes what it shows (the range, silhouettes, ids), even if no effect
/// of the camera needs it; a camera without effects can have a debug view too.
/// [`StyleWeight`] does not apply to a debug view; [`SplitView`] does.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[reflect(Component, Clone, PartialEq, Hash)]
#[non_exhaustive]
pub enum DebugView {
    /// The depth map `D`: black is near, white is far
    /// ([`DepthMap::flip`](crate::DepthMap::flip) exchanges them).
    DepthMap,
    /// Raw depth of the buffer, scaled to the range: white is the near end, black is
    /// the far end and where there is no geometry.
    RawRange,
    /// Ink of the silhouettes before color and opacity: black on white.
    Silhouettes,
    /// Ink of the creases before color and opacity: black on white.
    Creases,
    /// A random color for every object; black is no object. Needs the crate's
    /// feature `objects`.
    ObjectIds,
    /// Saturation that [`Desaturation`](crate::Desaturation) leaves: white is all,
    /// black is none.
    Saturation,
    /// Difference between the styled picture and the original, in display codes,
    /// times four.
    Difference,
    /// The debug view of the effect with this name
    /// ([`Effect::VIEW`](crate::Effect::VIEW)). Of this crate's effects,
    /// `"tone_bands"` has one: the lightness after banding. If the camera does not
    /// have the effect, its default settings are used.
    Effect(&'static str),
}

impl DebugView {
    /// The views that do not belong to an effect, in the order of menus.
    pub const SHARED: &'static [Self] = &[
        Self::DepthMap,
        Self::RawRange,
        Self::Silhouettes,
        Self::Creases,
        Self::ObjectIds,
        Self::Saturation,
        Self::Difference,
    ];

    /// Whether the view itself reads the depth prepass.
    pub(crate) fn needs_depth(self) -> bool {
        !matches!(self, Self::Saturation | Self::Difference | Self::Effect(_))
    }

    pub(crate) fn reads_ids(self) -> bool {
        self == Self::ObjectIds
    }

    /// The view's shader definition.
    pub(crate) fn shader_def(self) -> &'static str {
        match self {
            Self::DepthMap => "VIEW_DEPTH_MAP",
            Self::RawRange => "VIEW_RAW_RANGE",
            Self::Silhouettes => "VIEW_SILHOUETTES",
            Self::Creases => "VIEW_CREASES",
            Self::ObjectIds => "VIEW_OBJECT_IDS",
            Self::Saturation => "VIEW_SATURATION",
            Self::Difference => "VIEW_DIFFERENCE",
            Self::Effect(_) => "VIEW_EFFECT",
        }
    }
}

/// The settings of a camera for the end of its pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Composite {
    pub weight: f32,
    /// Fraction of the viewport's width.
    pub split: f32,
}

impl Default for Composite {
    fn default() -> Self {
        Self {
            weight: 1.0,
            split: 0.0,
        }
    }
}

impl Composite {
    pub fn new(weight: Option<&StyleWeight>, split: Option<&SplitView>) -> Self {
        Self {
            weight: weight.map_or(1.0, |weight| clamp_or_default(weight.0, 1.0, 0.0, 1.0)),
            split: split.map_or(0.0, |split| clamp_or_default(split.at, 0.5, 0.0, 1.0)),
        }
    }

    /// Packs the settings; `width` is that of the viewport in physical pixels.
    pub fn uniform(self, width: u32) -> CompositeUniform {
        CompositeUniform {
            weight: self.weight,
            split: (self.split * width as f32).round(),
            unused: Vec2::ZERO,
        }
    }
}

/// The uniform: `Composite` in `composite.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CompositeUniform {
    pub weight: f32,
    /// Physical pixels from the left edge of the viewport.
    pub split: f32,
    unused: Vec2,
}

/// Registers the components and the WGSL modules of the composite.
pub(crate) struct CompositePlugin;

impl Plugin for CompositePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<StyleWeight>()
            .register_type::<SplitView>()
            .register_type::<StyleMask>()
            .register_type::<BeyondPrepass>()
            .register_type::<DebugView>();
    }
}

impl CompositePlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        load_shader_library!(app, "composite.wgsl");
        load_shader_library!(app, "mask.wgsl");
    }
}
