//! Turns any 3D scene into a comic, in real time.
//!
//! Add [`ComicsPlugin`] to the app and a style to a camera:
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
//!     let at = |x, y, z| Transform::from_xyz(x, y, z).looking_at(Vec3::Y, Vec3::Y);
//!     let style = presets::SATURDAY_MORNING.comic();
//!     commands.spawn((Camera3d::default(), at(2.0, 2.0, 5.0), style));
//!     let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
//!     commands.spawn((sun, at(4.0, 8.0, 3.0)));
//!     let mesh = assets.add(Mesh::from(Torus::default()));
//!     let material = assets.add(StandardMaterial::from(Color::oklch(0.72, 0.15, 30.0)));
//!     commands.spawn((Mesh3d(mesh), MeshMaterial3d(material), Transform::from_xyz(0.0, 1.0, 0.0)));
//! }
//! ```
//!
//! # How it works
//!
//! Effects are components on a camera. A style ([`ComicStyle`]) is a set of effects in a file, with
//! a light for the materials of the scene, and [`Comic`] puts one on a camera. Every frame, for each camera with effects:
//!
//! 1. The components become a plan. An effect that changes nothing is left out of it, of the passes
//!    and of the shader; [`ComicsDiagnostics`] reports what ran and why the rest did not.
//! 2. A compute shader finds the nearest and the farthest visible depth in the depth prepass.
//! 3. Depth is mapped to `D`, which is 0 at the near end of that range and 1 at its far end
//!    ([`DepthMap`]).
//! 4. If the camera has [`Outlines`], silhouettes, creases and edges between objects are found
//!    along the borders between pixels, linked to lines and drawn.
//! 5. One full-screen pass after tonemapping applies the effects, stage by stage
//!    ([`EffectStage`](effect::EffectStage)).
//!
//! # Where to find what
//!
//! | Module | Contents |
//! |---|---|
//! | crate root | the plugin, styles, all effects, and the components that most games use |
//! | [`presets`] | styles that come with the crate |
//! | [`style`] | errors and events of styles, transitions, pages |
//! | [`effects`] | modes of the effects, such as [`HalftoneMode`](effects::HalftoneMode) |
//! | [`lines`] | settings of outlines, such as [`LineWeight`](lines::LineWeight) |
//! | [`cameras`] | several cameras: overlays, masks; floating origins |
//! | [`depth`] | the depth map, its smoothing and its reduction |
//! | `objects` | components for single meshes (feature `objects`, on by default) |
//! | `toon` | the toon material (feature `toon`, on by default) |
//! | [`effect`] | the trait for effects of your own, and what it needs |
//! | [`diagnostics`] | which stages ran on which camera, and debug views |
//!
//! The crate `bevy_comics_inspector` is a panel that edits styles while the game runs.
//!
//! Equations are those of *Comics stylizations of 3D scenes using GPU* (Suarez, Belhadj, Boyer),
//! cited as \[CS\], and of *Cartoon-Looking Rendering of 3D-Scenes* (Wang, after Decaudin), cited
//! as \[CL\]. Every setting is clamped to its documented range before it is used; no value causes a
//! panic or a NaN.
#![warn(missing_docs)]

mod animation;
mod bind_groups;
mod camera;
mod clock;
mod composite;
pub mod depth;
pub mod diagnostics;
pub mod effect;
pub mod effects;
mod files;
mod fused;
mod gpu;
pub mod lines;
#[cfg(any(feature = "objects", feature = "toon"))]
mod motion_lines;
#[cfg(feature = "objects")]
pub mod objects;
#[cfg(not(feature = "objects"))]
mod objects;
mod origin;
mod page;
mod plugin;
mod readback;
mod samples;
mod schedule;
mod settings;
pub mod style;
mod tones;
#[cfg(feature = "toon")]
pub mod toon;

#[cfg(any(feature = "objects", feature = "toon"))]
pub use animation::SteppedAnimation;
pub use animation::{Impact, ReduceFlashing};
pub use camera::KeyLight;
pub use composite::{SplitView, StyleWeight};
pub use depth::{CameraCut, DepthMap, DepthMapping};
pub use diagnostics::ComicsDiagnostics;
pub use effect::{Effect, EffectPlugin};
pub use effects::{
    Abstraction, BlackFlats, ColorHarmony, Colorization, Contours, DepthLayers, Desaturation,
    Focus, Halftone, Hatching, IsoLines, Misregistration, Outlines, Paint, Paper, Sketch,
    SpeedLines, ToneBands, ToneRamp, ToneRange, TwoTone, Vignette,
};
#[cfg(any(feature = "objects", feature = "toon"))]
pub use motion_lines::MotionLines;
#[cfg(feature = "objects")]
pub use objects::{NoOutlines, NoStyle, OutlineGroup, OutlineStyle, SelectionOutline, XRayOutline};
pub use plugin::ComicsPlugin;
pub use schedule::ComicsSystems;
pub use style::{Comic, ComicStyle, StyleTransition, presets};
#[cfg(feature = "toon")]
pub use toon::{ToonLight, ToonMaterial, ToonScene, ToonShadingHandle};

/// Several cameras: pictures over pictures. Cameras in big worlds.
pub mod cameras {
    pub use crate::camera::{ComicOverlay, RangeOf, overlay_camera};
    pub use crate::composite::{BeyondPrepass, StyleMask};
    pub use crate::origin::WorldOrigin;
}

/// What the crate's own tests read; not part of its interface.
#[doc(hidden)]
pub mod testing {
    pub use crate::lines::ViewCracks;
    #[cfg(feature = "objects")]
    pub use crate::objects::{ObjectIds, ObjectWork, ViewLineWidths, ViewObjectIds};
}

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
        ToonMaterial: "docs/toon-material.md";
        Motion: "docs/motion.md";
        Paper: "docs/paper.md";
        Paint: "docs/paint.md";
        Focus: "docs/focus.md";
        DepthLayers: "docs/depth-layers.md";
        ColorHarmony: "docs/color-harmony.md";
        Abstraction: "docs/abstraction.md";
        Hatching: "docs/hatching.md";
        ToneRange: "docs/tone-range.md";
        FixedRange: "docs/fixed-range.md";
        Cameras: "docs/cameras.md";
        BigWorlds: "docs/big-worlds.md";
        TransparentThings: "docs/transparent-things.md";
        Print: "docs/print.md";
        Performance: "docs/performance.md";
        Benchmarks: "docs/benchmarks.md";
        Troubleshooting: "docs/troubleshooting.md";
    }
}

/// What most games need: `use bevy_comics::prelude::*;`.
pub mod prelude {
    #[cfg(any(feature = "objects", feature = "toon"))]
    pub use crate::SteppedAnimation;
    pub use crate::{
        CameraCut, Comic, ComicStyle, ComicsPlugin, DepthMap, DepthMapping, Impact, SplitView,
        StyleTransition, StyleWeight,
        effects::{
            Abstraction, BlackFlats, ColorHarmony, Colorization, Contours, DepthLayers,
            Desaturation, Focus, Halftone, Hatching, Outlines, Paint, Paper, Sketch, SpeedLines,
            ToneBands, ToneRamp, Vignette,
        },
        presets,
    };
    #[cfg(feature = "objects")]
    pub use crate::{
        NoOutlines, NoStyle, OutlineGroup, OutlineStyle, SelectionOutline, XRayOutline,
    };
    #[cfg(feature = "toon")]
    pub use crate::{ToonLight, ToonMaterial, ToonScene, ToonShadingHandle};
}
