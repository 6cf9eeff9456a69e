//! Every number is clamped to the range that its field documents, and blended as it says.

mod blends;
mod clamps;
pub(crate) mod non_finite;
mod places;
mod values;
