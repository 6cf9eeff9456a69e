//! What effects change about lines.

mod abstraction;
mod focus;
mod layer_lines;
mod sheet;

pub use abstraction::LineAbstraction;
pub use focus::LineFocus;
pub use layer_lines::LineLayers;
pub use sheet::Sheet;

pub(crate) use abstraction::LineAbstractionUniform;
pub(crate) use focus::LineFocusUniform;
pub(crate) use layer_lines::LineLayersUniform;
pub(crate) use sheet::{SheetKey, SheetUniform};

/// What an effect changes about the lines of its camera
/// ([`Effect::line_modifiers`](crate::Effect::line_modifiers)).
///
/// Faithful lines are not changed, and `focus`, `layers` and `abstraction` need compute shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineModifiers {
    /// The distance at which lines are in focus; farther from it they fade. Default: none.
    pub focus: Option<LineFocus>,
    /// Width, opacity and colour of lines in foreground, middle and background. Default: none.
    pub layers: Option<LineLayers>,
    /// How lines follow the abstraction of the view. Default: none.
    pub abstraction: Option<LineAbstraction>,
    /// The sheet of paper that lines are drawn on: their edges are rough, and wide lines have
    /// streaks. Default: none.
    pub sheet: Option<Sheet>,
}

impl LineModifiers {
    /// Both together: of each kind, the one of `self` if it has one, otherwise that of `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            focus: self.focus.or(other.focus),
            layers: self.layers.or(other.layers),
            abstraction: self.abstraction.or(other.abstraction),
            sheet: self.sheet.or(other.sheet),
        }
    }
}
