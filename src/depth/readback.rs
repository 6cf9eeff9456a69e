//! The visible range as data for the game: copied a few frames late, never
//! waited for.

use std::sync::{
    Arc, Mutex, PoisonError,
    atomic::{AtomicBool, Ordering},
};

use bevy::{
    ecs::{
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

type Readings = Arc<Mutex<EntityHashMap<VisibleDepthRange>>>;

/// What has arrived from the GPU; both worlds hold it.
#[derive(Resource, Clone, Default)]
pub(crate) struct RangeReadings(Readings);

/// A view's buffers on their way to the CPU.
#[derive(Default)]
pub(crate) struct RangeReadback {
    slots: Vec<Slot>,
}

struct Slot {
    buffer: Buffer,
    busy: Arc<AtomicBool>,
    copied: Option<DepthProjection>,
}

/// So many copies may be under way at once.
const SLOTS: usize = 4;
const KEYS_SIZE: u64 = 8;

impl RangeReadback {
    /// Records a copy of the range; false if every buffer is still under way.
    pub fn copy(
        &mut self,
        device: &RenderDevice,
        encoder: &mut CommandEncoder,
        keys: &Buffer,
        projection: DepthProjection,
    ) -> bool {
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
                        size: KEYS_SIZE,
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
        encoder.copy_buffer_to_buffer(keys, 0, &slot.buffer, 0, KEYS_SIZE);
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
                        let keys = {
                            let bytes = buffer.slice(..).get_mapped_range();
                            let word = |i: usize| {
                                u32::from_le_bytes([
                                    bytes[i],
                                    bytes[i + 1],
                                    bytes[i + 2],
                                    bytes[i + 3],
                                ])
                            };
                            [word(0), word(4)]
                        };
                        buffer.unmap();
                        readings
                            .lock()
                            .unwrap_or_else(PoisonError::into_inner)
                            .insert(camera, VisibleDepthRange::of_keys(keys, &projection));
                    }
                    busy.store(false, Ordering::Release);
                });
        }
    }
}

pub(crate) fn receive_ranges(
    readings: Res<RangeReadings>,
    mut cameras: Query<&mut VisibleDepthRange>,
) {
    let mut readings = readings.0.lock().unwrap_or_else(PoisonError::into_inner);
    for (camera, reading) in readings.drain() {
        if let Ok(mut range) = cameras.get_mut(camera)
            && *range != reading
        {
            *range = reading;
        }
    }
}
