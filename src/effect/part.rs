//! What a draw call of the fused pass draws, and what it does with means over boxes.

/// What a pass does with means over boxes of the picture before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Means {
    /// It neither draws nor reads them.
    #[default]
    None,
    /// Draws the means of rows for this effect, and nothing else.
    Across(&'static str),
    /// Draws the means of boxes from those of rows.
    Down(&'static str),
    /// Its effects read them.
    Read,
}

impl Means {
    /// The effect that they are drawn for, in a pass that draws them.
    pub fn effect(self) -> Option<&'static str> {
        match self {
            Self::Across(effect) | Self::Down(effect) => Some(effect),
            Self::None | Self::Read => None,
        }
    }

    /// Whether the pass reads means.
    pub fn reads(self) -> bool {
        matches!(self, Self::Down(_) | Self::Read)
    }
}

/// What a draw call of the fused pass draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Part {
    /// All effects at all pixels.
    #[default]
    Whole,
    /// All pixels, without the effects that change only some of them.
    Base,
    /// All effects in the tiles that those effects may change.
    Tiles,
    /// All effects at all pixels, blended over the picture.
    Overlay,
    /// All effects in these tiles, blended over the picture.
    OverlaidTiles,
}

impl Part {
    /// Whether the pass is blended over the picture.
    pub fn is_overlay(self) -> bool {
        matches!(self, Self::Overlay | Self::OverlaidTiles)
    }

    /// Whether only tiles are drawn.
    pub fn is_tiled(self) -> bool {
        matches!(self, Self::Tiles | Self::OverlaidTiles)
    }
}
