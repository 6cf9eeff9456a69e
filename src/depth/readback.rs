//! The visible range as data for the game. The CPU never waits for the copy, so it
//! arrives a few frames late.

use std::sync::{
    Arc, Mutex, PoisonError,
    atomic::{AtomicBool, Ordering},
};

use bevy::{
    ecs::{
        change_detection::DetectChangesMut,
        component::Component,
        entity::{Entity, EntityHashMap},
        reflect::ReflectComponent,
        resource::Resource,
        system::{Query, Res},
    },
    reflect::{Reflect, std_traits::ReflectDefault},
    render::{
        render_resource::{Buffer, BufferDescriptor, BufferUsages, CommandEncoder, MapMode},
        renderer::RenderDevice,
    },
};

use super::frame::DepthProjection;

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
        near: f32,
        /// View depth of the farthest visible geometry in world units.
        far: f32,
        /// Raw reversed depth of the nearest geometry, as in the depth texture. Under
        /// an oblique projection: distance of the near plane over view depth.
        raw_near: f32,
        /// Raw reversed depth of the farthest geometry, as `raw_near`.
        raw_far: f32,
    },
}

impl VisibleDepthRange {
    /// Near and far view depth in world units; `None` unless geometry is visible.
    pub fn distances(self) -> Option<(f32, f32)> {
        match self {
            Self::Visible { near, far, .. } => Some((near, far)),
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
            near: projection.distance(raw_near) as f32,
            far: projection.distance(raw_far) as f32,
            raw_near,
            raw_far,
        }
    }
}

/// The distribution of the visible depths of a camera, and its smoothed visible range.
/// Put it on the camera; its value is updated.
///
/// As with [`VisibleDepthRange`], the value is one or a few frames old, and the depth
/// prepass and the reduction run for it. The counts are exact. Without compute
/// shaders, or with
/// [`ReductionMethod::PingPong`](crate::ReductionMethod::PingPong), it stays empty.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct DepthHistogram {
    /// Bins from near to far, without gaps; raw depth doubles over eight bins. Empty
    /// if no geometry is visible or no value has arrived yet.
    pub bins: Vec<DepthBin>,
    /// Near and far view depth in world units of the visible range after
    /// [`RangeSmoothing`](crate::RangeSmoothing).
    pub drawn: Option<(f32, f32)>,
}

/// One bin of a [`DepthHistogram`].
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthBin {
    /// View depth at the near end of the bin, in world units.
    pub near: f32,
    /// View depth at the far end of the bin, in world units. The bin of the smallest
    /// raw depths (about 2^-32) also counts what is farther away.
    pub far: f32,
    /// Number of visible depth samples in the bin: one per pixel, or one per sample
    /// with MSAA.
    pub count: u32,
}

impl DepthHistogram {
    fn of_words(words: &[u32], projection: &DepthProjection) -> Self {
        let (drawn, counts) = words.split_at(DRAWN_WORDS);
        let drawn = VisibleDepthRange::of_keys([drawn[0], drawn[1]], projection).distances();
        let counts = &counts[..BINS];
        let used = |count: &u32| *count > 0;
        let bins = match (counts.iter().position(used), counts.iter().rposition(used)) {
            (Some(first), Some(last)) => (first..=last)
                .rev()
                .map(|bin| {
                    let edge = |bin: usize| f32::from_bits((bin as u32 + FIRST_BIN) << 20);
                    DepthBin {
                        near: projection.distance(edge(bin + 1)) as f32,
                        far: projection.distance(edge(bin)) as f32,
                        count: counts[bin],
                    }
                })
                .collect(),
            _ => Vec::new(),
        };
        Self { bins, drawn }
    }
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
/// `BINS` and `FIRST_BIN` of `smoothing.wgsl`.
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
                    buffer: device.create_buffer(&BufferDescriptor {
                        label: Some("comics_range_readback"),
                        size,
                        usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
                        mapped_at_creation: false,
                    }),
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
            let (buffer, busy) = (slot.buffer.clone(), slot.busy.clone());
            let readings = readings.0.clone();
            slot.buffer
                .slice(..)
                .map_async(MapMode::Read, move |result| {
                    // Mapping fails on a lost device, whose buffers are dropped.
                    if result.is_ok() {
                        let words: Vec<u32> = buffer
                            .slice(..)
                            .get_mapped_range()
                            .chunks_exact(4)
                            .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                            .collect();
                        buffer.unmap();
                        let (keys, rest) = words.split_at((KEYS_SIZE / 4) as usize);
                        let keys = [keys[0], keys[1]];
                        let reading = RangeReading {
                            range: VisibleDepthRange::of_keys(keys, &projection),
                            histogram: (!rest.is_empty())
                                .then(|| DepthHistogram::of_words(rest, &projection)),
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
