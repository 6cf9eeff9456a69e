//! Turns any 3D scene into a comic, in real time.
mod depth;
mod diagnostics;
mod passes;
mod plugin;
mod sanitize;
mod styles;
mod stylize;
mod view;

pub use depth::{DepthMap, DepthMapping, ProjectionKind, ReductionMethod, VisibleDepthRange};
pub use diagnostics::{CameraStages, ComicsDiagnostics, ComicsStage, LeftOut, StageOutcome};
pub use plugin::{ComicsPlugin, ComicsSystems};
pub use styles::{
    BlackFlats, ColorMethod, Colorization, ColorizationMode, ComicStyle, ComicStyleError,
    ComicStyleHandle, ContourForm, ContourOperator, Contours, Desaturation, presets,
};

/// What most games need: `use bevy_comics::prelude::*;`.
pub mod prelude {
    pub use crate::{
        BlackFlats, ColorMethod, Colorization, ColorizationMode, ComicStyle, ComicStyleHandle,
        ComicsPlugin, ContourForm, ContourOperator, Contours, DepthMap, DepthMapping, Desaturation,
        VisibleDepthRange,
    };
}
