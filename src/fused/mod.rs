//! The fused pass: the plan of a camera, the choice of a plan whose pipelines are there, what the
//! plan requests of the services, and the full-screen pass that is composed from all effects.

mod compose;
mod key;
mod pass;
mod plan;
mod plugin;
mod requests;

pub(crate) use plan::{Plan, device::DeviceLacks, view_plan::ViewPlan};
pub(crate) use plugin::FusedPlugin;
pub(crate) use requests::set_or_remove;
