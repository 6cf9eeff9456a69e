//! The styles, in the order in which they apply to a pixel: desaturation,
//! colorization, black flats, contours. Each is a camera component, on while
//! it is present, and imports nothing of the others.

pub(crate) mod black_flats;
pub(crate) mod colorization;
pub(crate) mod contours;
pub(crate) mod desaturation;
mod file_color;
mod oklab;
pub mod presets;
mod style;

use bevy::reflect::{Reflect, std_traits::ReflectDefault};
use serde::{Deserialize, Serialize};

pub use black_flats::BlackFlats;
pub use colorization::{Colorization, ColorizationMode};
pub use contours::{ContourForm, ContourOperator, Contours};
pub use desaturation::Desaturation;
pub use style::{ComicStyle, ComicStyleError, ComicStyleHandle};
pub(crate) use style::{StyleLoader, apply_styles};

/// Which form of a colour style is computed.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash)]
pub enum ColorMethod {
    /// The paper's intention without its flaws: luminance is kept, hues blend
    /// without wrapping, greys take the atmosphere.
    #[default]
    Corrected,
    /// The paper's equations as printed, on HSV of the display codes.
    Faithful,
}
