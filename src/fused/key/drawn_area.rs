//! What a draw call of the fused pass draws.

/// What a draw call of the fused pass draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum DrawnArea {
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

impl DrawnArea {
    /// Whether the pass is blended over the picture.
    pub fn is_overlay(self) -> bool {
        matches!(self, Self::Overlay | Self::OverlaidTiles)
    }

    /// Whether only tiles are drawn.
    pub fn is_tiled(self) -> bool {
        matches!(self, Self::Tiles | Self::OverlaidTiles)
    }
}
