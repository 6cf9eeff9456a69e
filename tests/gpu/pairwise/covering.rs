//! The factors of the matrix, and rows that contain every allowed pair of their levels.

use super::effects::GROUPS;

/// Samples, HDR, projection, renderer, anti-aliasing, area, effects.
const FACTORS: usize = 7;

/// The level of every factor.
pub type Levels = [usize; FACTORS];

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum View {
    Perspective,
    Orthographic,
    /// A perspective with an oblique near plane.
    ClipPlane,
    /// A part of a larger perspective view, whose axis is not in its middle.
    OffCentre,
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
    View::OffCentre,
];
const ANTI_ALIASING: [AntiAliasing; 4] = [
    AntiAliasing::Off,
    AntiAliasing::Fxaa,
    AntiAliasing::Smaa,
    AntiAliasing::Taa,
];
const AREAS: [Area; 3] = [Area::Whole, Area::Part, Area::SmallMainPass];

/// How many levels each factor has; `samples` are the sample counts of the adapter.
fn sizes(samples: &[u32]) -> Levels {
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
    pub fn new(levels: Levels, samples: &[u32]) -> Self {
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
        // The engine's TAA (0.19.1) draws inside the viewport, but reads the whole texture: it shrinks
        // the picture into the viewport again in every frame.
        let part = !(self.area == Area::Part && self.is_temporal());
        deferred && temporal && part
    }
}

/// Two factors with a level each; the first factor has the smaller index.
type Pair = [(usize, usize); 2];

/// Level 0 is that of the plainest camera, which excludes nothing.
const PLAIN: Levels = [0; FACTORS];

fn with(mut levels: Levels, set: &[(usize, usize)]) -> Levels {
    for (factor, level) in set {
        levels[*factor] = *level;
    }
    levels
}

/// All pairs that the engine supports, those of the last factor first.
fn allowed_pairs(samples: &[u32]) -> Vec<Pair> {
    let sizes = sizes(samples);
    let mut pairs = Vec::new();
    for second in (1..FACTORS).rev() {
        for first in 0..second {
            for (a, b) in (0..sizes[first]).flat_map(|a| (0..sizes[second]).map(move |b| (a, b))) {
                let pair = [(first, a), (second, b)];
                if Row::new(with(PLAIN, &pair), samples).is_allowed() {
                    pairs.push(pair);
                }
            }
        }
    }
    pairs
}

fn contains(levels: &Levels, pair: &Pair) -> bool {
    pair.iter().all(|(factor, level)| levels[*factor] == *level)
}

/// The level of a factor that adds most pairs to those factors that are set already; of equal ones, the
/// level that is in most of the missing pairs, then the first one.
fn best_level(
    (levels, set): (&Levels, &[usize]),
    factor: usize,
    missing: &[Pair],
    samples: &[u32],
) -> usize {
    let score = |level: usize| {
        let levels = with(*levels, &[(factor, level)]);
        let mine = |pair: &&Pair| pair.contains(&(factor, level));
        let is_set = |f: &usize| *f == factor || set.contains(f);
        let added = (missing.iter().filter(mine))
            .filter(|pair| contains(&levels, pair) && pair.iter().all(|(f, _)| is_set(f)));
        (added.count(), missing.iter().filter(mine).count())
    };
    let is_allowed =
        |level: &usize| Row::new(with(*levels, &[(factor, *level)]), samples).is_allowed();
    let allowed = (0..sizes(samples)[factor]).filter(is_allowed);
    allowed
        .rev()
        .max_by_key(|level| score(*level))
        .expect("level 0 excludes nothing")
}

/// Rows that contain every allowed pair, by a greedy algorithm without chance: each row begins with the
/// first missing pair, and every other factor gets the level that adds most. Factors that are not
/// set yet have level 0, which excludes nothing.
pub fn rows(samples: &[u32]) -> Vec<Levels> {
    let mut missing = allowed_pairs(samples);
    let mut rows = Vec::new();
    while let Some(first) = missing.first() {
        let mut levels = with(PLAIN, first);
        let mut set: Vec<usize> = first.iter().map(|(factor, _)| *factor).collect();
        // Factors with many levels first: they have most pairs.
        for factor in [6, 2, 4, 5, 0, 1, 3] {
            if !set.contains(&factor) {
                levels[factor] = best_level((&levels, set.as_slice()), factor, &missing, samples);
                set.push(factor);
            }
        }
        missing.retain(|pair| !contains(&levels, pair));
        rows.push(levels);
    }
    rows
}

/// A sample count that the adapter of this machine may lack adds pairs as well.
#[test]
fn rows_contain_every_allowed_pair_and_no_other() {
    for samples in [&[1, 4][..], &[1, 2, 4, 8]] {
        let rows = rows(samples);
        // Each row adds a pair at least; the time of the tests grows with the rows. The least is the
        // product of the two largest factors.
        let least = GROUPS.len() * VIEWS.len();
        println!("{samples:?}: {} rows, at least {least}", rows.len());
        assert!((least..=2 * least).contains(&rows.len()), "{}", rows.len());
        let sizes = sizes(samples);
        for first in 0..FACTORS {
            for second in first + 1..FACTORS {
                for (a, b) in
                    (0..sizes[first]).flat_map(|a| (0..sizes[second]).map(move |b| (a, b)))
                {
                    // Written anew, from the page of failures: what the engine does not support.
                    let excluded = match (first, second) {
                        (0, 3) => a > 0 && b == 1,
                        (0, 4) => a > 0 && b == 3,
                        (4, 5) => a == 3 && b == 1,
                        _ => false,
                    };
                    let found = (rows.iter()).any(|row| row[first] == a && row[second] == b);
                    assert_eq!(found, !excluded, "{first}: {a}, {second}: {b}");
                }
            }
        }
    }
}
