//! What effects change about lines.

mod fade;
mod layer_lines;
mod sheet;
mod simplification;

pub use fade::LineFade;
pub use layer_lines::LineLayers;
pub use sheet::Sheet;
pub use simplification::LineSimplification;

pub(crate) use fade::LineFadeUniform;
pub(crate) use layer_lines::LineLayersUniform;
pub(crate) use sheet::SheetUniform;
pub(crate) use simplification::LineSimplificationUniform;

/// What an effect changes about the lines of its camera
/// ([`Effect::line_modifiers`](crate::Effect::line_modifiers)).
///
/// Faithful lines do not change. Without compute shaders, `fade`, `layers` and the opacity of
/// creases have no effect, and lines are simplified by their own depth instead of their object's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineModifiers {
    /// The distance at which lines are whole; farther from it they fade. Default: none.
    pub fade: Option<LineFade>,
    /// Width, opacity and color of lines in foreground, middle and background. Default: none.
    pub layers: Option<LineLayers>,
    /// How lines are simplified by the depth map. Default: not.
    pub simplification: Option<LineSimplification>,
    /// The sheet of paper that lines are drawn on: their edges are rough, and wide lines have
    /// streaks. Default: none.
    pub sheet: Option<Sheet>,
}

impl LineModifiers {
    /// Both together: of each kind, the one of `self` if it has one, otherwise that of `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            fade: self.fade.or(other.fade),
            layers: self.layers.or(other.layers),
            simplification: self.simplification.or(other.simplification),
            sheet: self.sheet.or(other.sheet),
        }
    }
}
