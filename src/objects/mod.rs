//! What single objects ask of the lines: no lines, or lines of their own. And
//! the ids by which lines know where one object ends and another begins.

#[cfg(feature = "objects")]
pub(crate) mod ids;
#[cfg(feature = "objects")]
mod phase;
pub(crate) mod table;

#[cfg(feature = "objects")]
mod components;
#[cfg(feature = "objects")]
pub(crate) use components::assign_object_styles;
#[cfg(feature = "objects")]
pub use components::{ContourStyle, LineKinds, NoContours};
#[cfg(feature = "objects")]
pub use ids::{ViewObjectIds, object_id};

pub(crate) use table::{ObjectStyleBuffer, ObjectStyles};

/// The ids' texture: (id, style slot).
pub(crate) const ID_FORMAT: bevy::render::render_resource::TextureFormat =
    bevy::render::render_resource::TextureFormat::Rg16Uint;
