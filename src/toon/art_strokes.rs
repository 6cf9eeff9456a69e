//! Draws the strokes of a tonal art map.

use bevy::{
    asset::RenderAssetUsages,
    image::Image,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};

use super::TonalArtMap;

const SMALLEST: usize = 16;
/// Tones that are drawn one after the other, up to the darkest; what is left are gaps.
const STEPS: usize = 48;
const DARKEST: f32 = 0.97;
/// Strokes of which the best is drawn.
const CANDIDATES: usize = 12;
/// Places along a stroke that become ink one after the other.
const PLACES: u32 = 2048;

impl TonalArtMap {
    /// Draws the map: an image of one channel with mip levels down to 16 texels.
    #[must_use]
    pub fn image(self) -> Image {
        let map = self.sanitized();
        let levels = levels(&map);
        let mut image = Image::new_uninit(
            Extent3d {
                width: map.size,
                height: map.size,
                depth_or_array_layers: 1,
            },
            TextureDimension::D2,
            TextureFormat::R8Unorm,
            RenderAssetUsages::RENDER_WORLD,
        );
        image.texture_descriptor.mip_level_count = levels.len() as u32;
        image.data = Some(levels.concat());
        image
    }
}

/// Random numbers that are the same everywhere.
struct Dice(u32);

impl Dice {
    /// A number from 0 to 1.
    fn roll(&mut self) -> f32 {
        // PCG: O'Neill 2014.
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((self.0 >> ((self.0 >> 28) + 4)) ^ self.0).wrapping_mul(277_803_737);
        ((word >> 22) ^ word) as f32 / 4_294_967_296.0
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.roll()
    }
}

/// A stroke in fractions of the map: it begins at `from`, goes along an axis, and bends.
struct Stroke {
    from: [f32; 2],
    length: f32,
    /// Steps to the side for each step along the axis.
    slope: f32,
    /// How far the middle is from the line between both ends.
    bend: f32,
    /// Along y.
    upright: bool,
    /// Becomes ink from its other end.
    backwards: bool,
}

impl Stroke {
    fn random(map: &TonalArtMap, tone: f32, dice: &mut Dice) -> Self {
        let most = map.spread.to_radians().tan();
        let length = map.length * dice.between(0.4, 1.0);
        Self {
            from: [dice.roll(), dice.roll()],
            length,
            slope: dice.between(-most, most),
            bend: 0.2 * length * dice.between(-most, most),
            upright: tone > map.crossing && dice.roll() < 0.5,
            backwards: dice.roll() < 0.5,
        }
    }

    /// Calls `visit` with every texel of the stroke, and how far along it that is, 0 to 1.
    fn texels(&self, size: usize, width: f32, mut visit: impl FnMut(usize, f32)) {
        let texels = size as f32;
        let count = (self.length * texels).ceil().max(1.0);
        let steeper = (1.0 + self.slope * self.slope).sqrt();
        let start = (self.from[0] * texels).floor();
        for k in 0..count as usize {
            let along = (k as f32 + 0.5) / count;
            let bend = 4.0 * self.bend * along * (1.0 - along);
            let aside = (self.from[1] + self.slope * self.length * along + bend) * texels;
            // Thinner at both ends.
            let taper = (along.min(1.0 - along) / 0.25).min(1.0);
            let half = (0.5 * width * (0.3 + 0.7 * taper) * steeper).max(0.5);
            let first = (aside - half + 0.5).floor() as i64;
            let last = (aside + half - 0.5).floor() as i64;
            for row in first..=last.max(first) {
                let at = [start as i64 + k as i64, row].map(|i| i.rem_euclid(size as i64) as usize);
                let [x, y] = if self.upright { [at[1], at[0]] } else { at };
                visit(y * size + x, along);
            }
        }
    }
}

/// A mip level while it is drawn.
struct Level {
    size: usize,
    /// When each texel became ink.
    order: Vec<u32>,
    inked: usize,
}

/// The texel is not ink.
const PAPER: u32 = u32::MAX;

impl Level {
    fn new(size: usize) -> Self {
        Self {
            size,
            order: vec![PAPER; size * size],
            inked: 0,
        }
    }

    fn is_lighter_than(&self, tone: f32) -> bool {
        (self.inked as f32) < tone * self.order.len() as f32
    }

    /// Texels that a stroke would make ink, for each texel of its length.
    fn gain(&self, stroke: &Stroke, width: f32) -> f32 {
        let mut gained = 0;
        stroke.texels(self.size, width, |texel, _| {
            gained += usize::from(self.order[texel] == PAPER);
        });
        gained as f32 / stroke.length
    }

    fn draw(&mut self, stroke: &Stroke, width: f32, number: u32) {
        let Self { order, inked, .. } = self;
        stroke.texels(self.size, width, |texel, along| {
            if order[texel] == PAPER {
                let along = if stroke.backwards { 1.0 - along } else { along };
                let place = (along * PLACES as f32) as u32;
                order[texel] = number * PLACES + place.min(PLACES - 1);
                *inked += 1;
            }
        });
    }

    /// The tone from which each texel is ink: as many texels as the tone says are.
    fn thresholds(&self, dice: &mut Dice) -> Vec<u8> {
        let mut texels: Vec<(u32, u32, usize)> = (self.order.iter().enumerate())
            .map(|(texel, order)| (*order, (dice.roll() * 1e9) as u32, texel))
            .collect();
        texels.sort_unstable();
        let mut thresholds = vec![0; texels.len()];
        for (rank, (.., texel)) in texels.iter().enumerate() {
            thresholds[*texel] = (rank * 256 / texels.len()) as u8;
        }
        thresholds
    }
}

/// The thresholds of all mip levels of a map, the finest first. `map` is sanitized.
pub(super) fn levels(map: &TonalArtMap) -> Vec<Vec<u8>> {
    let sizes = std::iter::successors(Some(map.size as usize), |size| Some(size / 2));
    let mut levels: Vec<Level> = (sizes.take_while(|size| *size >= SMALLEST))
        .map(Level::new)
        .collect();
    let mut dice = Dice(map.seed);
    let mut number = 0;
    for step in 1..=STEPS {
        let tone = DARKEST * step as f32 / STEPS as f32;
        // A stroke of a coarse level is also one of all finer levels.
        for coarsest in (0..levels.len()).rev() {
            while levels[coarsest].is_lighter_than(tone) {
                let stroke = best(map, &levels[coarsest], tone, &mut dice);
                for level in &mut levels[..=coarsest] {
                    level.draw(&stroke, map.width, number);
                }
                number += 1;
            }
        }
    }
    levels
        .iter()
        .map(|level| level.thresholds(&mut dice))
        .collect()
}

/// The stroke of several that covers most of the paper.
fn best(map: &TonalArtMap, level: &Level, tone: f32, dice: &mut Dice) -> Stroke {
    let mut best = Stroke::random(map, tone, dice);
    let mut most = level.gain(&best, map.width);
    for _ in 1..CANDIDATES {
        let other = Stroke::random(map, tone, dice);
        let gain = level.gain(&other, map.width);
        if gain > most {
            (best, most) = (other, gain);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(seed: u32) -> TonalArtMap {
        TonalArtMap {
            size: 128,
            seed,
            ..TonalArtMap::default()
        }
    }

    fn size_of(level: &[u8]) -> usize {
        level.len().isqrt()
    }

    /// At every level, as many texels are ink as the tone says: thresholds are stored in 256 steps.
    #[test]
    fn every_level_has_every_tone() {
        let levels = levels(&map(0));
        let sizes: Vec<usize> = levels.iter().map(|level| size_of(level)).collect();
        assert_eq!(sizes, [128, 64, 32, 16]);
        for level in &levels {
            for tone in [0.0, 0.12, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0] {
                let ink = level.iter().filter(|h| f64::from(**h) < 256.0 * tone);
                let mean = ink.count() as f64 / level.len() as f64;
                let off = (mean - tone).abs();
                assert!(off <= 1.0 / 256.0, "{} texels, {tone}: {mean}", level.len());
            }
        }
    }

    /// A texel of a stroke of a coarse level has ink in the next finer one, at about the same tone:
    /// a level is darker than its step by less than a stroke.
    #[test]
    fn coarse_strokes_are_part_of_finer_levels() {
        let map = map(3);
        let levels = levels(&map);
        for pair in levels.windows(2) {
            let [fine, coarse] = [&pair[0], &pair[1]];
            let [wide, small] = [fine, coarse].map(|level| size_of(level));
            let stroke = (map.width + 1.0) * map.length / small as f32;
            let most = DARKEST / STEPS as f32 + stroke + 1.0 / 256.0;
            for (texel, threshold) in coarse.iter().enumerate() {
                let tone = f32::from(*threshold) / 256.0;
                if tone > DARKEST - 0.05 {
                    continue;
                }
                // The middle of a stroke is up to its width from a texel's own place.
                let reach = map.width.ceil() as i64 + 1;
                let [x, y] = [texel % small, texel / small].map(|i| 2 * i as i64);
                let rows = (-reach..=reach + 1)
                    .flat_map(|v| (-reach..=reach + 1).map(move |u| [x + u, y + v]));
                let found = rows.map(|place| {
                    let [x, y] = place.map(|i| i.rem_euclid(wide as i64) as usize);
                    fine[y * wide + x]
                });
                let least = f32::from(found.min().expect("texels")) / 256.0;
                assert!(least <= tone + most, "{small}, {texel}: {tone}, {least}");
            }
        }
    }

    /// The step over the border is like those between other rows and columns.
    #[test]
    fn levels_repeat_without_a_seam() {
        let levels = levels(&map(1));
        let size = 128;
        let step = |upright: bool, line: usize| -> f64 {
            let at = |along: usize, line: usize| {
                let [x, y] = if upright {
                    [line, along]
                } else {
                    [along, line]
                };
                f64::from(levels[0][(y % size) * size + x % size])
            };
            let steps = (0..size).map(|k| (at(k, line) - at(k, line + 1)).abs());
            steps.sum::<f64>() / size as f64
        };
        for upright in [false, true] {
            let seam = step(upright, size - 1);
            let inside: Vec<f64> = (0..size - 1).map(|line| step(upright, line)).collect();
            let [low, high] = [f64::min, f64::max].map(|of| {
                let all = inside.iter().copied();
                all.reduce(of).expect("lines")
            });
            assert!((low..=high).contains(&seam), "{low} to {high}: {seam}");
        }
    }

    #[test]
    fn seeds_give_maps_of_their_own() {
        let [a, again, b] = [0, 0, 1].map(|seed| levels(&map(seed)));
        assert_eq!(a, again);
        let pairs = a[0].iter().zip(&b[0]);
        let apart = pairs.filter(|(a, b)| a.abs_diff(**b) > 25).count();
        assert!(apart > a[0].len() / 2, "{apart}");
    }

    /// Every number in range, and maps of the extreme ones have all tones.
    #[test]
    fn extreme_maps_are_drawn() {
        for x in [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e30] {
            for size in [0, 17, u32::MAX] {
                let wild = TonalArtMap {
                    size,
                    length: x,
                    width: x,
                    spread: x,
                    crossing: x,
                    seed: u32::MAX,
                };
                let map = wild.sanitized();
                assert!([16, 32, 1024].contains(&map.size));
                assert_eq!(map, map.sanitized());
                let small = TonalArtMap { size: 32, ..map };
                for level in levels(&small) {
                    let [least, most] = [level.iter().min(), level.iter().max()];
                    assert_eq!((least, most), (Some(&0), Some(&255)));
                }
            }
        }
    }

    #[test]
    fn an_image_has_all_levels() {
        let image = map(0).image();
        let bytes = image.data.as_ref().map(Vec::len);
        assert_eq!(bytes, Some(128 * 128 + 64 * 64 + 32 * 32 + 16 * 16));
        assert_eq!(image.texture_descriptor.mip_level_count, 4);
    }
}
