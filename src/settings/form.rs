//! Whether a paper's equation is used as printed.

use bevy::reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault};
use serde::{Deserialize, Serialize};

/// Which form of a paper's equation is computed.
///
/// Every effect with a `form` field documents what its two forms do.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
pub enum Form {
    /// The paper's intention without its flaws.
    #[default]
    Corrected,
    /// The paper's equations as printed, flaws included.
    Faithful,
}
