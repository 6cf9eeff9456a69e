//! Turns any 3D scene into a comic, in real time.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_comics::prelude::*;
//!
//! fn main() {
//!     App::new().add_plugins((DefaultPlugins, ComicsPlugin)).add_systems(Startup, setup).run();
//! }
//!
//! fn setup(mut commands: Commands) {
//!     commands.spawn((Camera3d::default(), Contours::default(), Desaturation::default()));
//! }
//! ```
//!
//! Add the plugin, put a style component on a camera, and that camera draws a
//! comic. In every frame:
//!
//! 1. the components of a camera become a plan; what is absent, or changes
//!    nothing, is left out, down to the shader ([`ComicsDiagnostics`] says what
//!    and why);
//! 2. a compute shader finds the nearest and farthest depth that is visible
//!    ([`ReductionMethod`], [`VisibleDepthRange`]);
//! 3. depth becomes the map `D`, 0 at the near end and 1 at the far end of the
//!    range ([`DepthMap`]);
//! 4. where [`Outlines`] are asked for, silhouettes, creases and edges between
//!    objects are found, and wide lines carried by a jump flood;
//! 5. one full-screen pass after tonemapping applies the effects: [`ToneBands`],
//!    [`Desaturation`], [`Colorization`], [`BlackFlats`], [`Contours`], the
//!    outlines or a [`Sketch`] of them, and [`Vignette`], in this order, and those
//!    of the game ([`Effect`]) at the end of their [`EffectStage`].
//!
//! Whole looks are assets: [`ComicStyle`], with [`presets`]. On meshes, the
//! feature `objects` adds `NoOutlines` and `OutlineStyle`, and the feature
//! `cartoon` adds `CartoonMaterial` and `CartoonScene`; both are on by default.
//!
//! Equations are those of *Comics stylizations of 3D scenes using GPU*
//! (Suarez, Belhadj, Boyer), cited as \[CS\], and of *Cartoon-Looking Rendering
//! of 3D-Scenes* (Wang, after Decaudin), cited as \[CL\]. Every setting is brought into its
//! documented range before it is used; no value makes a panic or a NaN.
#![warn(missing_docs)]

#[cfg(feature = "cartoon")]
mod cartoon;
mod depth;
mod diagnostics;
mod effect;
mod effects;
mod finish;
#[cfg(feature = "inspector")]
pub mod inspector;
mod lines;
mod objects;
mod plugin;
mod schedule;
mod settings;
mod style;
#[cfg(feature = "inspector")]
mod timing;
mod view;

#[cfg(feature = "cartoon")]
pub use cartoon::{CartoonLight, CartoonMaterial, CartoonScene};
pub use depth::{
    CameraCut, DepthBin, DepthHistogram, DepthMap, DepthMapping, ProjectionKind, RangeSmoothing,
    ReductionMethod, VisibleDepthRange,
};
pub use diagnostics::{CameraStages, ComicsDiagnostics, ComicsStage, LeftOut, StageOutcome};
pub use effect::{
    AnyEffect, Effect, EffectPlugin, EffectRegistry, EffectSet, EffectShader, EffectStage,
    EffectType, EffectView, Needs, NoUniform, Variants, ViewFacts,
};
pub use effects::*;
pub use finish::{DebugView, SplitView, StyleWeight};
pub use lines::{Creases, LineSettings, ObjectEdges, Silhouettes};
#[cfg(feature = "objects")]
pub use objects::{NoOutlines, OutlineKinds, OutlineStyle, ViewObjectIds, object_id};
pub use plugin::ComicsPlugin;
pub use schedule::ComicsSystems;
pub use settings::{
    BlendField, FieldRange, Form, HueWheel, blend_color, blend_ratio, bounded, bounded_option,
    displayable, file_color, linear_rgb,
};
pub use style::{
    ComicStyle, ComicStyleError, ComicStyleHandle, ComicStyleHandleTemplate, Preset,
    StyleTransition, StyleTransitionFinished, TransitionEasing, presets,
};

/// The guide's code, compiled.
#[cfg(doctest)]
#[doc = include_str!("../docs/your-own-style.md")]
struct Guide;

/// What most games need: `use bevy_comics::prelude::*;`.
pub mod prelude {
    pub use crate::{
        CameraCut, ComicStyle, ComicStyleHandle, ComicsPlugin, Creases, DepthMap, DepthMapping,
        Effect, EffectPlugin, Form, ObjectEdges, RangeSmoothing, Silhouettes, SplitView,
        StyleTransition, StyleTransitionFinished, StyleWeight, VisibleDepthRange, effects::*,
    };
    #[cfg(feature = "cartoon")]
    pub use crate::{CartoonLight, CartoonMaterial, CartoonScene};
    #[cfg(feature = "objects")]
    pub use crate::{NoOutlines, OutlineKinds, OutlineStyle};
}
