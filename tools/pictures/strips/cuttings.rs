//! The figures of the pages about lines: parts of frames of strips, pixel for pixel.

use std::{collections::HashMap, path::Path};

use bevy::math::UVec2;
use image::{RgbaImage, imageops};

use super::{GAP, SIZE};
use crate::{save, sheet::in_rows};

/// A part of a frame: the strip, which of its frames, and the top left corner of the part.
type Cutting = (&'static str, usize, [u32; 2]);

/// A figure: its name, the size of its parts, and how many are in a row.
struct Figure {
    name: &'static str,
    part: UVec2,
    columns: usize,
    cuttings: &'static [Cutting],
}

/// Two parts in a row.
const HALF: UVec2 = UVec2::new(470, 264);
/// Four frames of a motion in a row.
const QUARTER: UVec2 = UVec2::new(233, 160);

const FIGURES: [Figure; 7] = [
    Figure {
        name: "lines",
        part: HALF,
        columns: 2,
        cuttings: &[
            ("kinds", 3, [125, 70]),
            ("light", 3, [125, 70]),
            ("brush", 0, [125, 110]),
            ("boil", 0, [125, 110]),
        ],
    },
    Figure {
        name: "lines-color",
        part: HALF,
        columns: 2,
        cuttings: &[
            ("surface", 0, [0, 100]),
            ("fog", 0, [0, 100]),
            ("iso-lines", 0, [125, 60]),
            ("x-ray", 0, [125, 70]),
        ],
    },
    Figure {
        name: "lines-whole",
        part: HALF,
        columns: 2,
        cuttings: &[
            ("no-bridge", 1, [125, 70]),
            ("bridge", 1, [125, 70]),
            ("normals", 0, [0, 141]),
            ("default", 0, [0, 141]),
            ("no-overshoot", 1, [125, 70]),
            ("overshoot", 1, [125, 70]),
        ],
    },
    Figure {
        name: "lines-edges",
        part: HALF,
        columns: 2,
        cuttings: &[("default", 0, [125, 141]), ("edges", 0, [125, 141])],
    },
    Figure {
        name: "lines-budget",
        part: HALF,
        columns: 2,
        cuttings: &[("no-budget", 0, [125, 141]), ("budget", 0, [125, 141])],
    },
    Figure {
        name: "lines-motion",
        part: QUARTER,
        columns: 4,
        cuttings: &[
            ("brush", 0, [243, 134]),
            ("brush", 1, [243, 134]),
            ("brush", 2, [243, 134]),
            ("brush", 3, [243, 134]),
            ("budget", 0, [243, 134]),
            ("budget", 1, [243, 134]),
            ("budget", 3, [243, 134]),
            ("budget", 5, [243, 134]),
            ("default", 0, [243, 134]),
            ("default", 1, [243, 134]),
            ("default", 3, [243, 134]),
            ("default", 5, [243, 134]),
        ],
    },
    Figure {
        name: "depth-write",
        part: SIZE,
        columns: 1,
        cuttings: &[("transparent", 0, [0, 0])],
    },
];

/// The strips' frames that figures have parts of.
#[derive(Default)]
pub struct Figures {
    frames: HashMap<(&'static str, usize), RgbaImage>,
}

impl Figures {
    /// Keeps what figures have of a strip.
    pub fn add(&mut self, name: &str, frames: &[RgbaImage]) {
        for (strip, index, _) in FIGURES.iter().flat_map(|figure| figure.cuttings) {
            if *strip == name {
                self.frames.insert((*strip, *index), frames[*index].clone());
            }
        }
    }

    /// Writes the figures of which all strips were drawn.
    pub fn write(&self, folder: &Path) -> Result<(), String> {
        for figure in FIGURES {
            let cut = |(strip, index, [x, y]): &Cutting| {
                let frame = self.frames.get(&(*strip, *index))?;
                let part = imageops::crop_imm(frame, *x, *y, figure.part.x, figure.part.y);
                Some(part.to_image())
            };
            let parts: Option<Vec<RgbaImage>> = figure.cuttings.iter().map(cut).collect();
            let Some(parts) = parts else { continue };
            let out = folder.join(format!("figure-{}.png", figure.name));
            let picture = in_rows(&parts, figure.columns, figure.part, GAP);
            save(&picture, &out)?;
        }
        Ok(())
    }
}
