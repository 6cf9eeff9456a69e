//! The factors of the matrix, and rows that contain every allowed pair of their levels.

use super::effects::GROUPS;
use crate::shaders::covering::{all_pairs, cover};

/// Samples, HDR, projection, renderer, anti-aliasing, area, effects.
const FACTORS: usize = 7;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum View {
    Perspective,
    Orthographic,
    /// A perspective with an oblique near plane.
    ClipPlane,
    /// A part of a larger perspective view, whose axis is not in its middle.
    OffCenter,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AntiAliasing {
    Off,
    Fxaa,
    Smaa,
    Taa,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    Whole,
    /// A viewport that is a part of the target.
    Part,
    /// The main pass has half of the picture's width and height.
    SmallMainPass,
}

/// One configuration of a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    pub samples: u32,
    pub hdr: bool,
    pub view: View,
    pub deferred: bool,
    pub anti_aliasing: AntiAliasing,
    pub area: Area,
    /// An index of [`GROUPS`].
    pub effects: usize,
}

const VIEWS: [View; 4] = [
    View::Perspective,
    View::Orthographic,
    View::ClipPlane,
    View::OffCenter,
];
const ANTI_ALIASING: [AntiAliasing; 4] = [
    AntiAliasing::Off,
    AntiAliasing::Fxaa,
    AntiAliasing::Smaa,
    AntiAliasing::Taa,
];
const AREAS: [Area; 3] = [Area::Whole, Area::Part, Area::SmallMainPass];

/// How many levels each factor has; `samples` are the sample counts of the adapter.
fn sizes(samples: &[u32]) -> [usize; FACTORS] {
    [
        samples.len(),
        2,
        VIEWS.len(),
        2,
        ANTI_ALIASING.len(),
        AREAS.len(),
        GROUPS.len(),
    ]
}

impl Row {
    fn new(levels: &[usize], samples: &[u32]) -> Self {
        Self {
            samples: samples[levels[0]],
            hdr: levels[1] == 1,
            view: VIEWS[levels[2]],
            deferred: levels[3] == 1,
            anti_aliasing: ANTI_ALIASING[levels[4]],
            area: AREAS[levels[5]],
            effects: levels[6],
        }
    }

    pub fn is_temporal(&self) -> bool {
        self.anti_aliasing == AntiAliasing::Taa
    }

    /// Whether the engine supports the row. Every rule excludes a pair, so that a row is allowed if
    /// all of its pairs are.
    pub fn is_allowed(&self) -> bool {
        let multisampled = self.samples > 1;
        // The engine's deferred pass has one sample: `check_msaa` of `core_3d` turns MSAA off.
        let deferred = !(multisampled && self.deferred);
        // The engine leaves TAA out of multisampled views, with a warning.
        let temporal = !(multisampled && self.is_temporal());
        // The engine's TAA (0.19.1) draws inside the viewport, but reads the whole texture: it
        // shrinks the picture into the viewport again in every frame.
        let part = !(self.area == Area::Part && self.is_temporal());
        deferred && temporal && part
    }
}

/// Rows that contain every pair of levels that the engine supports.
pub fn rows(samples: &[u32]) -> Vec<Row> {
    let is_allowed = |levels: &[usize]| Row::new(levels, samples).is_allowed();
    let (rows, _) = cover(&sizes(samples), |levels| vec![is_allowed(levels); FACTORS]);
    rows.iter()
        .map(|levels| Row::new(levels, samples))
        .collect()
}

/// A sample count that the adapter of this machine may lack adds pairs as well.
#[test]
fn rows_contain_every_allowed_pair_and_no_other() {
    for samples in [&[1, 4][..], &[1, 2, 4, 8]] {
        let sizes = sizes(samples);
        let (rows, never) = cover(&sizes, |levels| {
            vec![Row::new(levels, samples).is_allowed(); FACTORS]
        });
        // Each row adds a pair at least; the time of the tests grows with the rows. The least is
        // the product of the two largest factors.
        let least = GROUPS.len() * VIEWS.len();
        println!("{samples:?}: {} rows, at least {least}", rows.len());
        assert!((least..=2 * least).contains(&rows.len()), "{}", rows.len());
        for pair in all_pairs(&sizes) {
            // Written anew, from the page of failures: what the engine does not support.
            let excluded = match pair {
                [(0, samples), (3, 1)] | [(0, samples), (4, 3)] => samples > 0,
                [(4, 3), (5, 1)] => true,
                _ => false,
            };
            let has = |row: &Vec<usize>| pair.iter().all(|(factor, level)| row[*factor] == *level);
            assert_eq!(rows.iter().any(has), !excluded, "{pair:?}");
            assert_eq!(never.contains(&pair), excluded, "{pair:?}");
        }
    }
}
