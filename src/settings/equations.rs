//! Whether an equation of a paper is computed as printed.

use bevy::reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault};
use serde::{Deserialize, Serialize};

/// Whether an effect computes the equations of a paper as printed or corrected.
///
/// Every effect with a field `equations` documents what the two do.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
pub enum Equations {
    /// What the paper intends, without the flaws of its equations.
    #[default]
    Corrected,
    /// The paper's equations as printed, flaws included.
    Faithful,
}

impl Equations {
    pub(crate) fn is_faithful(self) -> bool {
        self == Self::Faithful
    }
}
