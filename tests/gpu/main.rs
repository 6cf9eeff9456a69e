//! Everything that needs a GPU, or a CPU that plays one, in one binary.

#[path = "../../examples/common/mod.rs"]
mod common;
#[path = "../reference/mod.rs"]
mod reference;

mod blending;
mod cartoon;
mod command_line;
mod device;
mod extremes;
mod failures;
mod finish;
mod flood;
mod fresh_crate;
mod functions;
mod golden;
mod guide;
mod house;
mod ids;
mod left_out;
mod lines;
mod models;
mod outlines;
mod outside;
mod own_effect;
#[cfg(feature = "inspector")]
mod panel;
mod pictures;
mod pipelines;
mod range;
mod range_views;
mod report;
mod scenes;
mod shaders;
mod small;
mod smoothing;
mod smoothing_views;
mod styles;
mod vignette;
mod wgsl;
#[cfg(feature = "inspector")]
mod window;
