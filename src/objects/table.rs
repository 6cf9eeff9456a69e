//! The styles of objects as the shaders read them: a short table, and for every
//! object its slot in it.

use bevy::{
    ecs::{entity::EntityHashMap, resource::Resource},
    math::Vec3,
    render::{
        render_resource::{Buffer, ShaderType, StorageBuffer},
        renderer::{RenderDevice, RenderQueue},
    },
};

/// `ObjectStyle` of `objects.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, PartialEq)]
pub(crate) struct ObjectStyleUniform {
    pub color: Vec3,
    pub has_color: f32,
    pub half_width: f32,
    pub kinds: u32,
}

impl Default for ObjectStyleUniform {
    fn default() -> Self {
        Self {
            color: Vec3::ZERO,
            has_color: 0.0,
            half_width: -1.0,
            kinds: 7,
        }
    }
}

/// The most styles that differ from one another; further ones are drawn like
/// the last, with a warning.
#[cfg(feature = "objects")]
pub(crate) const MOST_STYLES: usize = 255;

/// The objects with a style of their own, in both worlds.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub(crate) struct ObjectStyles {
    /// Slot 0 is an object without a style.
    pub entries: Vec<ObjectStyleUniform>,
    /// By main-world entity.
    pub slots: EntityHashMap<u8>,
}

impl ObjectStyles {
    pub fn any(&self) -> bool {
        !self.slots.is_empty()
    }

    /// The widest line of any object, logical pixels.
    pub fn max_width(&self) -> f32 {
        self.entries
            .iter()
            .map(|e| 2.0 * e.half_width)
            .fold(0.0, f32::max)
    }

    /// The slot of a style; styles that are equal share one.
    #[cfg(feature = "objects")]
    pub fn slot(&mut self, style: ObjectStyleUniform) -> u8 {
        if self.entries.is_empty() {
            self.entries.push(ObjectStyleUniform::default());
        }
        let known = self.entries.iter().skip(1).position(|e| *e == style);
        let slot = known.map_or(self.entries.len(), |at| at + 1);
        if slot > MOST_STYLES {
            bevy::log::warn_once!(
                "more than {MOST_STYLES} different contour styles: the others are drawn like the last"
            );
            return MOST_STYLES as u8;
        }
        if known.is_none() {
            self.entries.push(style);
        }
        slot as u8
    }
}

#[cfg(feature = "objects")]
pub(crate) fn extract_object_styles(
    main: bevy::render::Extract<bevy::ecs::system::Res<ObjectStyles>>,
    mut styles: bevy::ecs::system::ResMut<ObjectStyles>,
) {
    if *styles != **main {
        styles.clone_from(&main);
    }
}

/// The table on the GPU.
#[derive(Resource, Default)]
pub(crate) struct ObjectStyleBuffer {
    buffer: StorageBuffer<Vec<ObjectStyleUniform>>,
}

impl ObjectStyleBuffer {
    pub fn update(&mut self, styles: &ObjectStyles, device: &RenderDevice, queue: &RenderQueue) {
        if styles.any() && *self.buffer.get() != styles.entries {
            self.buffer.set(styles.entries.clone());
            self.buffer.write_buffer(device, queue);
        }
    }

    pub fn buffer(&self) -> Option<&Buffer> {
        self.buffer.buffer()
    }
}
