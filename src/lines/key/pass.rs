//! The passes that have pipelines.

use super::line_key::LineKey;

/// The passes that are compute passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SearchPass {
    /// Looks for blocks with cracks or jumps, and lists the cells with cracks.
    Walk(LineKey),
    /// Lists the tiles near these blocks.
    Tiles,
    /// Finds the cracks in the cells.
    Cells(LineKey),
    /// Continues lines along weak cracks; the last pass by the steps that are left.
    Link { last: bool },
    /// Joins lines over faces that are thinner than a pixel.
    Join,
    /// Keeps the lines of the last frames.
    Hold(LineKey),
    /// Closes gaps in lines.
    CloseGaps,
    /// Measures how densely lines lie in small squares, or in large ones.
    Measure { coarse: bool },
    /// Notes which cracks meet at corners.
    Corners,
    /// Completes the cracks in the cells.
    Settle(LineKey),
    /// Finds the loose ends of lines.
    Ends(LineKey),
}

impl SearchPass {
    /// The passes that find cracks in cells and complete them, in their order. `links`: passes that
    /// continue lines.
    pub fn in_cells(key: LineKey, links: usize) -> impl Iterator<Item = Self> {
        let completing = [
            (LineKey::LEDGES, Self::Join),
            (LineKey::HOLDS, Self::Hold(key.for_hold())),
            (LineKey::CLOSED_GAPS, Self::CloseGaps),
            (LineKey::BUDGET, Self::Measure { coarse: false }),
            (LineKey::BUDGET, Self::Measure { coarse: true }),
            (LineKey::COMPLETED, Self::Corners),
            (LineKey::COMPLETED, Self::Settle(key.for_settle())),
            (LineKey::OVERSHOOTS, Self::Ends(key.for_ends())),
        ];
        let completing = completing.into_iter();
        let completing = completing.filter(move |(flag, _)| key.contains(*flag));
        let linking = (1..=links).map(move |i| Self::Link { last: i == links });
        let cells = [Self::Cells(key.for_find())].into_iter();
        cells.chain(linking).chain(completing.map(|(_, pass)| pass))
    }

    /// The part of the key of a view that the pass depends on.
    pub fn key(self) -> LineKey {
        match self {
            Self::Walk(key)
            | Self::Cells(key)
            | Self::Hold(key)
            | Self::Settle(key)
            | Self::Ends(key) => key,
            _ => LineKey::empty(),
        }
    }

    /// The label of the pass and of what it binds.
    pub fn label(self) -> &'static str {
        match self {
            Self::Walk(_) => "comics_walk",
            Self::Tiles => "comics_list_tiles",
            Self::Cells(_) => "comics_find_in_cells",
            Self::Link { .. } => "comics_link_lines",
            Self::Join => "comics_join_lines",
            Self::Hold(_) => "comics_hold_lines",
            Self::CloseGaps => "comics_close_gaps",
            Self::Measure { .. } => "comics_measure_lines",
            Self::Corners => "comics_line_corners",
            Self::Settle(_) => "comics_settle_lines",
            Self::Ends(_) => "comics_line_ends",
        }
    }
}

/// The passes that are render passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum LinePass {
    /// Picks one of so many samples of every pixel.
    Resolve { samples: u32 },
    /// Finds the cracks of every pixel, without compute shaders.
    Find,
    /// Searches the columns of pixels for cracks.
    Columns,
    /// Draws the ink of the faithful equations.
    Faithful,
    /// Draws the ink of cracks.
    Draw,
    /// Draws the strokes beyond loose ends.
    Strokes,
    /// Blends ink with the history: in the tiles with ink, or in all pixels.
    Accumulate { tiled: bool },
}

impl LinePass {
    /// The part of a key that the pass depends on.
    pub fn part(self, key: LineKey) -> LineKey {
        match self {
            Self::Resolve { .. } => key.for_resolve(),
            Self::Find => key.for_find(),
            Self::Columns => key.for_columns(),
            Self::Faithful => key.for_faithful(),
            Self::Draw => key.for_draw(),
            Self::Strokes => key.for_strokes(),
            Self::Accumulate { .. } => key.for_accumulate(),
        }
    }

    /// The label of the pass and of what it binds.
    pub fn label(self) -> &'static str {
        match self {
            Self::Resolve { .. } => "comics_resolve_samples",
            Self::Find => "comics_find_lines",
            Self::Columns => "comics_line_columns",
            Self::Faithful => "comics_faithful_lines",
            Self::Draw => "comics_draw_lines",
            Self::Strokes => "comics_line_strokes",
            Self::Accumulate { .. } => "comics_accumulate_lines",
        }
    }
}
