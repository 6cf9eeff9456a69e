//! The fused pass: the plan of a camera, the choice of a plan whose pipelines are there, what the
//! plan requests of the services, and the full-screen pass that is composed from all effects.

mod blue_noise;
mod choose;
mod compiling;
mod compose;
mod context;
mod device;
mod drawn_area;
mod earlier_passes;
mod errors;
#[cfg(feature = "objects")]
mod highlights;
mod inputs;
mod intermediate;
mod key;
mod lines;
mod missing;
mod pass;
mod passes;
mod plan;
mod plugin;
mod prepare;
mod reasons;
mod requests;
mod scene;
mod view_plan;

pub(crate) use device::DeviceLacks;
pub(crate) use plan::Plan;
pub(crate) use plugin::FusedPlugin;
pub(crate) use requests::set_or_remove;
pub(crate) use view_plan::ViewPlan;
