//! What comes after the styles: how much of them is seen, where the original
//! is shown beside them, and the views that show what they are made of.

use bevy::{
    app::{App, Plugin},
    ecs::{component::Component, reflect::ReflectComponent},
    math::Vec2,
    reflect::{Reflect, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
    shader::load_shader_library,
};

use crate::settings::{FieldRange, bounded};

/// How much of a camera's style is seen: the styled picture is mixed with the
/// original, in linear light. 1 is as without this component; at 0 nothing of
/// the style runs.
///
/// Range 0 to 1; what is not a finite number counts as 1.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct StyleWeight(pub f32);

impl Default for StyleWeight {
    fn default() -> Self {
        Self(1.0)
    }
}

impl StyleWeight {
    pub(crate) fn sanitized(self) -> f32 {
        bounded(self.0, 1.0, 0.0, 1.0)
    }
}

/// Shows the original left of a vertical line, and the styled picture right of
/// it.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct SplitView {
    /// Where the line is, as a share of the viewport's width from the left.
    /// Range 0 (all styled) to 1 (all original), default 0.5.
    #[reflect(@FieldRange::FRACTION)]
    pub at: f32,
}

impl Default for SplitView {
    fn default() -> Self {
        Self { at: 0.5 }
    }
}

impl SplitView {
    pub(crate) fn sanitized(self) -> f32 {
        bounded(self.at, 0.5, 0.0, 1.0)
    }
}

/// Shows on a camera what its styles are made of, instead of the picture.
///
/// What a view needs is computed for it, even where no style asks for it: the
/// range, silhouettes, ids. A camera with this component and no style shows
/// the view alone. [`StyleWeight`] does not apply; [`SplitView`] does.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[reflect(Component, Clone, PartialEq, Hash)]
#[non_exhaustive]
pub enum DebugView {
    /// The depth map `D`: black is near, white is far.
    DepthMap,
    /// Raw depth as the buffer holds it, spread between the two ends of the
    /// range: white is near, black is far.
    RawRange,
    /// Response of the silhouettes, black on white.
    Silhouettes,
    /// Response of the creases, black on white.
    Creases,
    /// A colour of its own for every object; black has none. Needs the feature
    /// `objects`.
    ObjectIds,
    /// What desaturation leaves: white keeps its colours, black loses them.
    Saturation,
    /// How far the styled picture is from the original, in display codes,
    /// four times as bright.
    Difference,
    /// What an effect computes, by the effect's name: of the effects of this
    /// crate, `"tone_bands"` shows the lightness after the bands, alone. An
    /// effect that the camera has not got is shown with its default settings.
    Effect(&'static str),
}

impl DebugView {
    /// The views that belong to no effect, in the order of a menu.
    pub const SHARED: &'static [Self] = &[
        Self::DepthMap,
        Self::RawRange,
        Self::Silhouettes,
        Self::Creases,
        Self::ObjectIds,
        Self::Saturation,
        Self::Difference,
    ];

    /// Whether there is nothing to show without a depth prepass.
    pub(crate) fn needs_depth(self) -> bool {
        !matches!(self, Self::Saturation | Self::Difference | Self::Effect(_))
    }

    pub(crate) fn reads_ids(self) -> bool {
        self == Self::ObjectIds
    }

    /// The name that the shader knows it by.
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

/// What a camera's components say about the end of its pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Finish {
    pub weight: f32,
    /// Share of the viewport's width.
    pub split: f32,
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            weight: 1.0,
            split: 0.0,
        }
    }
}

impl Finish {
    pub fn new(weight: Option<&StyleWeight>, split: Option<&SplitView>) -> Self {
        Self {
            weight: weight.copied().unwrap_or_default().sanitized(),
            split: split.map_or(0.0, |split| split.sanitized()),
        }
    }

    /// `width` is that of the viewport in pixels.
    pub fn uniform(self, width: u32) -> FinishUniform {
        FinishUniform {
            weight: self.weight,
            split: (self.split * width as f32).round(),
            unused: Vec2::ZERO,
        }
    }
}

/// `Finish` of `finish.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FinishUniform {
    pub weight: f32,
    /// Pixels from the left edge of the viewport.
    pub split: f32,
    unused: Vec2,
}

/// The components and the WGSL of what comes after the effects.
pub(crate) struct FinishPlugin;

impl Plugin for FinishPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<StyleWeight>()
            .register_type::<SplitView>()
            .register_type::<DebugView>();
    }
}

impl FinishPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        load_shader_library!(app, "finish.wgsl");
    }
}
