//! What games set about lines.

mod boil;
mod color;
mod edges;
mod fog;
mod kinds;
mod map_jumps;
mod outlines;
mod uniform;
mod weight;

pub use boil::LineBoil;
pub use color::LineColor;
pub use edges::{EdgeColor, EdgeStyle};
pub use fog::LineFog;
pub use kinds::{CreaseSource, Creases, LineEdge, LineResponse, ObjectEdges, Silhouettes};
pub use map_jumps::MapJumps;
pub use outlines::Outlines;
pub use weight::LineWeight;

pub(crate) use boil::BoilUniform;
pub(crate) use fog::{FogUniform, ViewFog, has_fog};
pub(crate) use uniform::LinesUniform;
pub(crate) use weight::WeightUniform;
