//! The sheet of the page about lines: a part of one frame of some strips, pixel for pixel.

use std::{collections::HashMap, path::Path};

use bevy::math::UVec2;
use image::{RgbaImage, imageops};

use super::GAP;
use crate::{save, sheet::grid};

const SIZE: UVec2 = UVec2::new(232, 130);

/// A part of a frame: the strip, which of its frames, and the top left corner of the part.
type Cutting = (&'static str, usize, [u32; 2]);

/// Rows of four; strips that are opposites are side by side.
const CUTTINGS: [[Cutting; 4]; 4] = [
    [
        ("kinds", 3, [84, 40]),
        ("light", 3, [84, 40]),
        ("brush", 0, [84, 60]),
        ("boil", 0, [84, 60]),
    ],
    [
        ("surface", 0, [0, 70]),
        ("fog", 0, [0, 70]),
        ("iso-lines", 0, [84, 30]),
        ("x-ray", 0, [84, 60]),
    ],
    [
        ("no-budget", 0, [84, 95]),
        ("budget", 0, [84, 95]),
        ("no-overshoot", 1, [84, 60]),
        ("overshoot", 1, [84, 60]),
    ],
    [
        ("no-bridge", 1, [84, 50]),
        ("bridge", 1, [84, 50]),
        ("no-sections", 0, [168, 90]),
        ("sections", 0, [168, 90]),
    ],
];

/// The parts that have been cut out so far.
#[derive(Default)]
pub struct Sheet {
    parts: HashMap<&'static str, RgbaImage>,
}

impl Sheet {
    /// Cuts out what the sheet has of a strip.
    pub fn add(&mut self, name: &str, frames: &[RgbaImage]) {
        for (strip, frame, [x, y]) in CUTTINGS.iter().flatten() {
            if *strip == name {
                let part = imageops::crop_imm(&frames[*frame], *x, *y, SIZE.x, SIZE.y);
                self.parts.insert(*strip, part.to_image());
            }
        }
    }

    /// Writes the sheet, if all strips that it has parts of were drawn.
    pub fn write(&self, folder: &Path) -> Result<(), String> {
        let rows = CUTTINGS
            .iter()
            .map(|row| row.iter().map(|(name, ..)| self.parts.get(name)).collect());
        let Some(rows) = rows.collect::<Option<Vec<Vec<&RgbaImage>>>>() else {
            return Ok(());
        };
        save(&grid(&rows, SIZE, GAP), &folder.join("lines.png"))
    }
}
