//! Whether an equation of a paper is computed as printed.

use bevy::reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault};
use serde::{Deserialize, Serialize};

/// Which form of a paper's equations an effect computes.
///
/// Every effect with a `form` field documents what its two forms do.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
pub enum Form {
    /// What the paper intends, without the flaws of its equations.
    #[default]
    Corrected,
    /// The paper's equations as printed, flaws included.
    Faithful,
}
