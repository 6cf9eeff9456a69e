//! The visible range as data for the game: copied a few frames late, never
//! waited for.

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

/// Put it on a camera to learn how near and how far the visible geometry is.
///
/// The value is that of a frame or a few ago: the copy is never waited for.
/// Asking for it makes the depth prepass and the reduction run, even where no
/// style needs them.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
#[non_exhaustive]
pub enum VisibleDepthRange {
    /// No frame has been read yet.
    #[default]
    Pending,
    /// The view showed no opaque geometry.
    Empty,
    /// The range of what the view showed.
    Visible {
        /// View depth of the nearest visible geometry, world units: measured
        /// along the camera's forward axis.
        near: f32,
        /// View depth of the farthest visible geometry, world units.
        far: f32,
        /// Raw reversed depth of the nearest geometry, as the depth texture
        /// holds it.
        raw_near: f32,
        /// Raw reversed depth of the farthest geometry.
        raw_far: f32,
    },
}

impl VisibleDepthRange {
    /// Near and far view depth in world units, where there is geometry.
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

/// Put it on a camera to learn how the visible depths are distributed, and
/// which range its styles are drawn with.
///
/// As with [`VisibleDepthRange`], the value is that of a frame or a few ago,
/// and asking for it makes the depth prepass and the reduction run. The counts
/// are exact. Without compute shaders, or with
/// [`ReductionMethod::PingPong`](crate::ReductionMethod::PingPong), it stays
/// empty.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct DepthHistogram {
    /// From near to far, without gaps; eight bins double the raw depth. Empty
    /// where nothing is visible or nothing was read yet.
    pub bins: Vec<DepthBin>,
    /// Near and far view depth that the styles are drawn with, world units:
    /// the visible range after [`RangeSmoothing`](crate::RangeSmoothing).
    pub drawn: Option<(f32, f32)>,
}

/// One bin of a [`DepthHistogram`].
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthBin {
    /// View depth at which the bin begins, world units.
    pub near: f32,
    /// View depth at which it ends, world units; infinite in the last bin of
    /// what lies too far to be told apart.
    pub far: f32,
    /// Visible depth samples in it: pixels, times the samples of a pixel.
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

/// What one copy brings.
#[derive(Clone, Debug)]
pub(crate) struct RangeReading {
    range: VisibleDepthRange,
    histogram: Option<DepthHistogram>,
}

type Readings = Arc<Mutex<EntityHashMap<RangeReading>>>;

/// What has arrived from the GPU; both worlds hold it.
#[derive(Resource, Clone, Default)]
pub(crate) struct RangeReadings(Readings);

/// A view's buffers on their way to the CPU.
#[derive(Default)]
pub(crate) struct RangeReadback {
    slots: Vec<Slot>,
    /// Whether the slots have room for a histogram.
    histogram: bool,
}

struct Slot {
    buffer: Buffer,
    busy: Arc<AtomicBool>,
    copied: Option<DepthProjection>,
}

/// So many copies may be under way at once.
const SLOTS: usize = 4;
const KEYS_SIZE: u64 = 16;
const DRAWN_SIZE: u64 = 16;
const DRAWN_WORDS: usize = 4;
/// Of `smoothing.wgsl`.
const BINS: usize = 256;
const FIRST_BIN: u32 = 761;

impl RangeReadback {
    /// Records a copy of the range; false if every buffer is still under way.
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

    /// Asks for the copies of this frame, once they have been submitted.
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
                    // A lost device maps nothing; the buffers go with it.
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
