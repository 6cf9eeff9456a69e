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
//! fn setup(mut commands: Commands, assets: Res<AssetServer>) {
//!     let from = |x, y, z| Transform::from_xyz(x, y, z).looking_at(Vec3::ZERO, Vec3::Y);
//!     let eye = from(0.0, 12.0, 10.0);
//!     commands.spawn((Camera3d::default(), eye, Outlines::default()));
//!     let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
//!     commands.spawn((sun, from(8.0, 9.0, 3.0)));
//!     for i in (0..300).map(|i| i as f32) {
//!         let mesh = Mesh::from(Cylinder::new(0.75, 3.0 + i.sqrt().cos()));
//!         let paint = StandardMaterial::from(Color::oklch(0.72, 0.15, 137.5 * i));
//!         let place = Quat::from_rotation_y(2.4 * i) * Vec3::Z * i.sqrt();
//!         commands.spawn((
//!             Mesh3d(assets.add(mesh)),
//!             MeshMaterial3d(assets.add(paint)),
//!             Transform::from_translation(place),
//!             CartoonScene::default(),
//!         ));
//!     }
//! }
//! ```
//!
//! Add the plugin, put effects on a camera as components, and that camera draws a
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
//!    objects are found along the borders of pixels, and drawn at their width;
//! 5. one full-screen pass after tonemapping applies the effects: [`ToneRamp`], [`ToneBands`],
//!    [`Desaturation`], [`Colorization`], [`ColorHarmony`], [`Planes`], [`Paint`], [`Focus`],
//!    [`PrintOffset`], [`Halftone`], [`Hatching`], [`BlackFlats`], [`Contours`], the outlines or a
//!    [`Sketch`] of them, [`IsoLines`], [`TwoTone`], [`SpeedLines`], [`Paper`] and [`Vignette`], in
//!    this order, and those of the game ([`Effect`]) at the end of their [`EffectStage`].
//!
//! [`Impact`] shows two tones for a few drawings, [`HeldPose`] draws characters "on twos", [`MotionLines`]
//! draw lines behind what moves fast.
//!
//! Whole styles are assets: [`ComicStyle`], with [`presets`]. On meshes, the
//! feature `objects` adds `NoOutlines`, `OutlineStyle` and `OutlineGroup`, and the feature
//! `cartoon` adds `CartoonMaterial` and `CartoonScene`; both are on by default.
//!
//! Equations are those of *Comics stylizations of 3D scenes using GPU*
//! (Suarez, Belhadj, Boyer), cited as \[CS\], and of *Cartoon-Looking Rendering
//! of 3D-Scenes* (Wang, after Decaudin), cited as \[CL\]. Every setting is brought into its
//! documented range before it is used; no value makes a panic or a NaN.
#![warn(missing_docs)]

#[cfg(feature = "cartoon")]
mod cartoon;
mod clock;
mod depth;
mod diagnostics;
mod effect;
mod effects;
mod finish;
#[cfg(feature = "inspector")]
pub mod inspector;
mod lines;
#[cfg(any(feature = "objects", feature = "cartoon"))]
mod motion_lines;
mod objects;
mod plugin;
mod readback;
mod samples;
mod schedule;
mod settings;
mod style;
#[cfg(feature = "inspector")]
mod timing;
mod view;

#[cfg(feature = "cartoon")]
pub use cartoon::{
    CartoonLight, CartoonMaterial, CartoonScene, DetailAxis, FormShape, Glint, GlintFrame,
    GlintShape, MaterialName, Ramp, RampBlend, RampDetail, RampMap, RampMode, RampStop, Rim,
    RimWidth, ShadedForm, TonalArtMap, ToonLook, ToonLookError, ToonLookHandle,
    ToonLookHandleTemplate,
};
pub use depth::{
    CameraCut, DepthBin, DepthHistogram, DepthMap, DepthMapping, ProjectionKind, RangeSmoothing,
    ReductionMethod, VisibleDepthRange,
};
pub use diagnostics::{
    CameraStages, ComicsDiagnostics, ComicsStage, ImpactCounts, LeftOut, StageOutcome,
};
pub use effect::{
    AnyEffect, Effect, EffectPlugin, EffectRegistry, EffectSet, EffectShader, EffectStage,
    EffectTarget, EffectType, EffectView, Extent, Needs, NoUniform, Variants, ViewFacts,
};
pub use effects::*;
pub use finish::{DebugView, SplitView, StyleWeight};
pub use lines::{
    Creases, LineAbstraction, LineBoil, LineColor, LineFocus, LineFog, LinePlanes, LineResponse,
    LineSettings, LineWeight, MapJumps, ObjectEdges, Sheet, Silhouettes, ViewCracks,
};
#[cfg(any(feature = "objects", feature = "cartoon"))]
pub use motion_lines::MotionLines;
#[cfg(feature = "objects")]
pub use objects::{
    ATTRIBUTE_MESH_SECTION, DepthWrite, LineWidths, MeshSections, NoOutlines, NoStyle,
    ObjectAbstraction, ObjectIdDepthTest, ObjectScreen, OutlineGroup, OutlineKinds, OutlineStyle,
    SelectionOutline, ViewLineWidths, ViewObjectIds, XRayOutline, object_id,
};
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
#[cfg(any(feature = "objects", feature = "cartoon"))]
pub use view::HeldPose;
pub use view::{Impact, KeyLight, ReduceFlashing};

/// The code of the README and of the pages, compiled as doctests. That of
/// `your-own-effect.md` has several files and is compiled by `tests/gpu`.
#[cfg(doctest)]
mod pages {
    macro_rules! pages {
        ($($Page:ident: $path:literal;)*) => {
            $(#[doc = include_str!(concat!("../", $path))] struct $Page;)*
        };
    }

    pages! {
        Readme: "README.md";
        YourOwnStyle: "docs/your-own-style.md";
        StylesAndPresets: "docs/styles-and-presets.md";
        Lines: "docs/lines.md";
        OneObjectsLines: "docs/one-objects-lines.md";
        ExcludeAnObject: "docs/exclude-an-object.md";
        CartoonMaterial: "docs/cartoon-material.md";
        Motion: "docs/motion.md";
        Paper: "docs/paper.md";
        Paint: "docs/paint.md";
        Focus: "docs/focus.md";
        Planes: "docs/planes.md";
        ColorHarmony: "docs/color-harmony.md";
        Abstraction: "docs/abstraction.md";
        Hatching: "docs/hatching.md";
        FixedRange: "docs/fixed-range.md";
        SplitScreen: "docs/split-screen.md";
        TransparentThings: "docs/transparent-things.md";
        Inspector: "docs/inspector.md";
        Print: "docs/print.md";
        Performance: "docs/performance.md";
        Benchmarks: "docs/benchmarks.md";
        Troubleshooting: "docs/troubleshooting.md";
    }
}

/// What most games need: `use bevy_comics::prelude::*;`.
pub mod prelude {
    pub use crate::{
        CameraCut, ComicStyle, ComicStyleHandle, ComicsPlugin, Creases, DepthMap, DepthMapping,
        Effect, EffectPlugin, EffectTarget, Form, Impact, KeyLight, LineBoil, LineColor, LineFog,
        LineResponse, LineWeight, ObjectEdges, RangeSmoothing, ReduceFlashing, Silhouettes,
        SplitView, StyleTransition, StyleTransitionFinished, StyleWeight, VisibleDepthRange,
        effects::*,
    };
    #[cfg(feature = "cartoon")]
    pub use crate::{
        CartoonLight, CartoonMaterial, CartoonScene, DetailAxis, FormShape, Glint, GlintFrame,
        GlintShape, MaterialName, Ramp, RampBlend, RampDetail, RampMap, RampMode, RampStop, Rim,
        RimWidth, ShadedForm, TonalArtMap, ToonLook, ToonLookHandle,
    };
    #[cfg(feature = "objects")]
    pub use crate::{
        DepthWrite, LineWidths, MeshSections, NoOutlines, NoStyle, ObjectAbstraction, ObjectScreen,
        OutlineGroup, OutlineKinds, OutlineStyle, SelectionOutline, XRayOutline,
    };
    #[cfg(any(feature = "objects", feature = "cartoon"))]
    pub use crate::{HeldPose, MotionLines};
}
