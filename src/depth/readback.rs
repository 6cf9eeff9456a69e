//! The visible range as data for the game. The CPU never waits for the copy, so it
//! arrives a few frames late.

use std::sync::{
    Arc, Mutex, PoisonError,
    atomic::{AtomicBool, Ordering},
};

use bevy::{
    ecs::entity::EntityHashMap,
    prelude::*,
    render::{
        render_resource::{Buffer, BufferUsages, CommandEncoder},
        renderer::RenderDevice,
    },
};

use super::{ProjectionKind, frame::DepthProjection};
use crate::{gpu::buffer, readback::map_words};

/// The view depths of the nearest and farthest visible geometry of a camera. Put it
/// on the camera; its value is updated.
///
/// The value is one or a few frames old. The depth prepass and the reduction run for
/// it, even if no effect needs them.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
#[non_exhaustive]
pub enum VisibleDepthRange {
    /// No value has arrived yet.
    #[default]
    Pending,
    /// The view showed nothing in the depth prepass: no opaque or alpha-masked geometry.
    Empty,
    /// The view showed geometry.
    Visible {
        /// View depth of the nearest visible geometry in world units, measured along
        /// the camera's forward axis.
        nearest: f32,
        /// View depth of the farthest visible geometry in world units.
        farthest: f32,
        /// Raw reversed depth of the nearest geometry, as in the depth texture. Under
        /// an oblique projection: 2^-14 world units over view depth.
        raw_nearest: f32,
        /// Raw reversed depth of the farthest geometry, as `raw_nearest`.
        raw_farthest: f32,
    },
}

impl VisibleDepthRange {
    /// Near and far view depth in world units; `None` unless geometry is visible.
    pub fn distances(self) -> Option<(f32, f32)> {
        match self {
            Self::Visible {
                nearest, farthest, ..
            } => Some((nearest, farthest)),
            _ => None,
        }
    }

    fn of_keys(keys: [u32; 2], projection: &DepthProjection) -> Self {
        if keys[0] == 0 {
            return Self::Empty;
        }
        let raw_near = f32::from_bits(keys[0]);
        let raw_far = f32::from_bits(keys[1].wrapping_neg());
        Self::Visible {
            nearest: projection.distance(raw_near) as f32,
            farthest: projection.distance(raw_far) as f32,
            raw_nearest: raw_near,
            raw_farthest: raw_far,
        }
    }
}

/// The distribution of the visible depths of a camera, and its smoothed visible range.
/// Put it on the camera; its value is updated.
///
/// As with [`VisibleDepthRange`], the value is one or a few frames old, and the depth
/// prepass and the reduction run for it. The counts are exact up to rounding at the
/// edges of the bins. Without compute
/// shaders, or with
/// [`ReductionMethod::PingPong`](crate::depth::ReductionMethod::PingPong), it stays empty.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct DepthHistogram {
    /// Bins from near to far, without gaps. Empty if no geometry is visible or no value
    /// has arrived yet.
    ///
    /// In perspective, raw depth doubles over eight bins. Under an orthographic
    /// projection, up to 256 bins divide the visible range of the frame before. They are
    /// narrow at both ends and 0.8 % of that range in its middle; the outermost ones
    /// reach to the nearest and the farthest depth.
    pub bins: Vec<DepthBin>,
    /// Near and far view depth in world units of the visible range after
    /// [`RangeSmoothing`](crate::depth::RangeSmoothing).
    pub drawn: Option<(f32, f32)>,
    /// View depths in world units of the borders between near, middle and far, while an effect
    /// asks for them, as [`DepthLayers`](crate::DepthLayers) does.
    pub borders: Option<(f32, f32)>,
}

/// One bin of a [`DepthHistogram`].
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthBin {
    /// View depth at the near end of the bin, in world units.
    pub near: f32,
    /// View depth at the far end of the bin, in world units. In perspective, the bin of
    /// the smallest raw depths (about 2^-32) also counts what is farther away.
    pub far: f32,
    /// Number of visible depth samples in the bin: one per pixel, or one per sample
    /// with MSAA.
    pub count: u32,
}

impl DepthHistogram {
    /// `keys` are those of the reduction; `words` the keys that are drawn, then
    /// `Histogram` of `histogram.wgsl`.
    fn of_words(keys: [u32; 2], words: &[u32], projection: &DepthProjection) -> Self {
        let (drawn, words) = words.split_at(DRAWN_WORDS);
        let borders = (drawn[2] != 0).then(|| {
            let distance = |bits| projection.distance(f32::from_bits(bits)) as f32;
            (distance(drawn[2]), distance(drawn[3]))
        });
        let drawn = VisibleDepthRange::of_keys([drawn[0], drawn[1]], projection).distances();
        let (counts, rest) = words.split_at(BINS);
        let window = [rest[1], rest[2]].map(f32::from_bits);
        let used = |count: &u32| *count > 0;
        let (Some(first), Some(last)) =
            (counts.iter().position(used), counts.iter().rposition(used))
        else {
            return Self {
                bins: Vec::new(),
                drawn,
                borders,
            };
        };
        let (near, far) = (
            f32::from_bits(keys[0]),
            f32::from_bits(keys[1].wrapping_neg()),
        );
        let edge = |bin: usize| match projection.kind() {
            ProjectionKind::Orthographic if bin == first => far,
            ProjectionKind::Orthographic if bin == last + 1 => near,
            ProjectionKind::Orthographic => window_edge(window, bin).max(far).min(near),
            _ => f32::from_bits((bin as u32 + FIRST_BIN) << 20),
        };
        let distance = |bin: usize| projection.distance(edge(bin)) as f32;
        let bins = (first..=last)
            .rev()
            .map(|bin| DepthBin {
                near: distance(bin + 1),
                far: distance(bin),
                count: counts[bin],
            })
            .collect();
        Self {
            bins,
            drawn,
            borders,
        }
    }
}

/// `window_edge` of `histogram.wgsl`: raw depth between `bin - 1` and `bin`.
fn window_edge([near, far]: [f32; 2], bin: usize) -> f32 {
    let far_half = bin <= BINS / 2;
    let i = if far_half { bin } else { BINS - bin } as f64 * 2.0 / BINS as f64;
    let from_end = 0.5 * i * i * (f64::from(near) - f64::from(far));
    (if far_half {
        f64::from(far) + from_end
    } else {
        f64::from(near) - from_end
    }) as f32
}

/// The values of one copy.
#[derive(Clone, Debug)]
pub(crate) struct RangeReading {
    range: VisibleDepthRange,
    histogram: Option<DepthHistogram>,
}

type Readings = Arc<Mutex<EntityHashMap<RangeReading>>>;

/// The values that have arrived from the GPU, by camera. Shared by both worlds.
#[derive(Resource, Clone, Default)]
pub(crate) struct RangeReadings(Readings);

/// A view's buffers for copies to the CPU.
#[derive(Default)]
pub(crate) struct RangeReadback {
    slots: Vec<Slot>,
    /// Whether the buffers have room for a histogram.
    histogram: bool,
}

struct Slot {
    buffer: Buffer,
    /// From the recording of a copy until its values were read.
    busy: Arc<AtomicBool>,
    /// The projection of a copy that was recorded and is not mapped yet.
    copied: Option<DepthProjection>,
}

/// Most copies of a view that can be pending at once.
const SLOTS: usize = 4;
const KEYS_SIZE: u64 = 16;
const DRAWN_SIZE: u64 = 16;
const DRAWN_WORDS: usize = 4;
/// `BINS` and `FIRST_OCTAVE_BIN` of `histogram.wgsl`.
const BINS: usize = 256;
const FIRST_BIN: u32 = 761;

impl RangeReadback {
    /// Records a copy of the keys, and of the smoothed keys and the counts if there is
    /// a histogram. Returns false if all buffers are still busy.
    pub fn copy(
        &mut self,
        device: &RenderDevice,
        encoder: &mut CommandEncoder,
        keys: &Buffer,
        histogram: Option<(&Buffer, &Buffer)>,
        projection: DepthProjection,
    ) -> bool {
        if self.histogram != histogram.is_some() {
            self.slots.clear();
            self.histogram = histogram.is_some();
        }
        let size = match histogram {
            Some((_, counts)) => KEYS_SIZE + DRAWN_SIZE + counts.size(),
            None => KEYS_SIZE,
        };
        let free = self
            .slots
            .iter()
            .position(|slot| !slot.busy.load(Ordering::Acquire));
        let index = match free {
            Some(index) => index,
            None if self.slots.len() < SLOTS => {
                self.slots.push(Slot {
                    buffer: buffer(
                        device,
                        "comics_range_readback",
                        size,
                        BufferUsages::COPY_DST | BufferUsages::MAP_READ,
                    ),
                    busy: Arc::default(),
                    copied: None,
                });
                self.slots.len() - 1
            }
            None => return false,
        };
        let slot = &mut self.slots[index];
        slot.busy.store(true, Ordering::Release);
        slot.copied = Some(projection);
        let into = &slot.buffer;
        encoder.copy_buffer_to_buffer(keys, 0, into, 0, KEYS_SIZE);
        if let Some((drawn, counts)) = histogram {
            let after = KEYS_SIZE + DRAWN_SIZE;
            encoder.copy_buffer_to_buffer(drawn, 0, into, KEYS_SIZE, DRAWN_SIZE);
            encoder.copy_buffer_to_buffer(counts, 0, into, after, counts.size());
        }
        true
    }

    /// Maps the copies of this frame. Call it after they were submitted.
    pub fn map(&mut self, camera: Entity, readings: &RangeReadings) {
        for slot in &mut self.slots {
            let Some(projection) = slot.copied.take() else {
                continue;
            };
            let busy = slot.busy.clone();
            let readings = readings.0.clone();
            map_words(&slot.buffer, move |words| {
                if let Some(words) = words {
                    let (keys, rest) = words.split_at((KEYS_SIZE / 4) as usize);
                    let keys = [keys[0], keys[1]];
                    let reading = RangeReading {
                        range: VisibleDepthRange::of_keys(keys, &projection),
                        histogram: (!rest.is_empty())
                            .then(|| DepthHistogram::of_words(keys, rest, &projection)),
                    };
                    readings
                        .lock()
                        .unwrap_or_else(PoisonError::into_inner)
                        .insert(camera, reading);
                }
                busy.store(false, Ordering::Release);
            });
        }
    }
}

pub(crate) fn receive_ranges(
    readings: Res<RangeReadings>,
    mut ranges: Query<&mut VisibleDepthRange>,
    mut histograms: Query<&mut DepthHistogram>,
) {
    let mut readings = readings.0.lock().unwrap_or_else(PoisonError::into_inner);
    for (camera, reading) in readings.drain() {
        if let Ok(mut range) = ranges.get_mut(camera) {
            range.set_if_neq(reading.range);
        }
        if let (Ok(mut histogram), Some(reading)) = (histograms.get_mut(camera), reading.histogram)
        {
            histogram.set_if_neq(reading);
        }
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    /// The words that the GPU copies: drawn keys, counts, total, window.
    fn words(counts: &[(usize, u32)], window: [f32; 2]) -> Vec<u32> {
        let mut words = vec![0; DRAWN_WORDS + BINS];
        for (bin, count) in counts {
            words[DRAWN_WORDS + bin] = *count;
        }
        words.push(counts.iter().map(|(_, count)| count).sum());
        words.extend(window.map(f32::to_bits));
        words
    }

    fn keys(near: f32, far: f32) -> [u32; 2] {
        [near.to_bits(), far.to_bits().wrapping_neg()]
    }

    #[test]
    fn orthographic_bins_cover_what_is_visible_without_gaps() {
        let orthographic = OrthographicProjection {
            near: -10.0,
            far: 1e5,
            ..OrthographicProjection::default_3d()
        };
        let matrix = Mat4::orthographic_rh(-1.0, 1.0, -1.0, 1.0, 1e5, -10.0);
        let projection =
            DepthProjection::new(&matrix, Some(&Projection::Orthographic(orthographic)));
        let raw = |distance: f64| projection.raw_depth(distance) as f32;
        // The window is the range of the frame before; this one reaches beyond it.
        let window = [raw(500.0), raw(600.0)];
        let visible = [raw(490.0), raw(610.0)];
        let read = |counts| {
            DepthHistogram::of_words(
                keys(visible[0], visible[1]),
                &words(counts, window),
                &projection,
            )
        };
        for counts in [
            &[(0, 3), (100, 7), (255, 1)][..],
            &[(255, 11)],
            &[(0, 11)],
            &[(127, 4), (128, 5)],
        ] {
            let bins = read(counts).bins;
            let ends = [bins[0].near, bins[bins.len() - 1].far];
            // Raw depth has steps of 2^-24 of 1e5 units: 0.006.
            assert!((ends[0] - 490.0).abs() < 0.01 && (ends[1] - 610.0).abs() < 0.01);
            assert!(bins.windows(2).all(|b| b[0].far == b[1].near), "{bins:?}");
            assert!(bins.iter().all(|b| b.near <= b.far), "{bins:?}");
            let counted: u32 = bins.iter().map(|b| b.count).sum();
            assert_eq!(counted, counts.iter().map(|(_, count)| count).sum::<u32>());
        }
        // Bin 100 lies 100^2 to 101^2 / 128^2 of half of the window from its far end.
        let bins = read(&[(0, 3), (100, 7), (255, 1)]).bins;
        let bin = bins.iter().find(|bin| bin.count == 7).expect("counted");
        let at = |i: f64| 600.0 - 50.0 * i * i / 16384.0;
        for (got, want) in [(bin.near, at(101.0)), (bin.far, at(100.0))] {
            assert!((f64::from(got) - want).abs() < 0.01, "{got} for {want}");
        }
    }
}
