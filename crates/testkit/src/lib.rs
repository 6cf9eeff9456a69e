//! Shared by the tests, the examples and the report: scenes made by code, an app
//! that renders without a window, a bare GPU device, the shipped WGSL, and the
//! shaders' references in double precision.

pub mod before;
pub mod bench;
pub mod demo;
pub mod device;
pub mod drawing;
pub mod engine;
pub mod forest;
pub mod fuzz;
pub mod headless;
pub mod line_work;
pub mod orbit;
pub mod page_work;
pub mod painting;
pub mod panel_state;
pub mod pool;
pub mod read_back;
pub mod reference;
pub mod scenes;
pub mod screens;
pub mod soak;
pub mod specimens;
pub mod style_work;
// The panel's stopwatch, included because it is private there.
#[path = "../../inspector/src/timing/stopwatch.rs"]
mod stopwatch;
pub mod straight_edges;
pub mod strokes;
pub mod studio;
pub mod truth;
pub mod validation;
#[cfg(test)]
mod void_and_cluster;
pub mod wgsl;
pub mod work;

/// The root of the repository.
pub const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
