//! The styles, in the order in which they apply to a pixel: tone bands,
//! desaturation, colorization, black flats, contours, outlines or a sketch of
//! them. Each is a camera component, on while
//! it is present, and imports nothing of the others.

pub(crate) mod black_flats;
mod blend;
pub(crate) mod colorization;
pub(crate) mod contours;
pub(crate) mod desaturation;
mod field;
mod file_color;
mod oklab;
pub(crate) mod outlines;
pub mod presets;
pub(crate) mod sketch;
mod style;
pub(crate) mod tone_bands;
mod transition;

use bevy::reflect::{Reflect, std_traits::ReflectDefault};
use serde::{Deserialize, Serialize};

pub use black_flats::BlackFlats;
pub use colorization::{Colorization, ColorizationMode};
pub use contours::{ContourForm, ContourOperator, Contours};
pub use desaturation::Desaturation;
pub use field::{FieldRange, HueWheel};
pub use outlines::{Creases, EdgeForm, ObjectEdges, Outlines, Silhouettes};
pub use sketch::Sketch;
pub use style::{ComicStyle, ComicStyleError, ComicStyleHandle};
pub(crate) use style::{Look, StyleLoader, apply_styles};
pub use tone_bands::{ToneBandMethod, ToneBands};
pub(crate) use transition::run_transitions;
pub use transition::{StyleTransition, StyleTransitionFinished, TransitionEasing};

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
