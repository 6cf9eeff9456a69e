//! The table of outline styles that shaders read, and the slot of each object in it.

use bevy::{
    ecs::{entity::EntityHashMap, resource::Resource},
    math::{Vec3, Vec4},
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
    pub opacity: f32,
    /// World units per unit of an object that screens follow; 0: they do not.
    pub anchor_size: f32,
    /// Its centre in world space.
    pub anchor_centre: Vec3,
    pub unused: f32,
    /// Its rotation, a unit quaternion.
    pub anchor_rotation: Vec4,
}

impl Default for ObjectStyleUniform {
    fn default() -> Self {
        Self {
            color: Vec3::ZERO,
            has_color: 0.0,
            half_width: -1.0,
            kinds: 7,
            opacity: 1.0,
            anchor_size: 0.0,
            anchor_centre: Vec3::ZERO,
            unused: 0.0,
            anchor_rotation: Vec4::W,
        }
    }
}

/// Most outline styles that can be told apart: a slot is packed in 8 bits. Further ones
/// are drawn like the last, with a warning.
#[cfg(feature = "objects")]
pub(crate) const MOST_STYLES: usize = 255;

/// The objects that are drawn in another way than the others. Both worlds have a copy.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub(crate) struct ObjectStyles {
    /// The table, by slot. Slot 0 is for objects without a style.
    pub entries: Vec<ObjectStyleUniform>,
    /// The slot of each object, by main-world entity.
    pub slots: EntityHashMap<u8>,
    /// Some mesh is divided into sections.
    pub sections: bool,
    /// Some object has a `SelectionOutline` or `XRayOutline`.
    pub marks: bool,
    /// The vertices of some mesh say how wide its lines are.
    pub widths: bool,
    /// Some mesh fades at some distance.
    pub fades: bool,
}

/// The bit of `ObjectStyleUniform::kinds` of objects of which only hidden parts have lines.
#[cfg(feature = "objects")]
pub(crate) const HIDDEN_ONLY: u32 = 16;

/// The bit of `ObjectStyleUniform::kinds` of objects that the colour effects leave alone.
#[cfg(feature = "objects")]
pub(crate) const UNSTYLED: u32 = 8;

/// The transparent meshes that draw into the depth of effects. Both worlds have a copy.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub(crate) struct DepthWrites {
    /// The least alpha that is drawn, by main-world entity.
    pub cutoffs: EntityHashMap<f32>,
}

/// Which components of objects there are in a world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ObjectChanges {
    /// Some object has its own line style, or no lines, or [`UNSTYLED`].
    pub any: bool,
    /// Some mesh is divided into sections.
    pub sections: bool,
    /// The vertices of some mesh say how wide its lines are.
    pub widths: bool,
    /// The colour effects leave some object alone.
    pub unstyled: bool,
    /// Some object has a `SelectionOutline` or `XRayOutline`.
    pub marks: bool,
    /// Screens follow some object.
    pub anchored: bool,
    /// Some mesh fades at some distance.
    pub fades: bool,
}

impl ObjectStyles {
    pub fn any(&self) -> bool {
        !self.slots.is_empty()
    }

    pub fn changes(&self) -> ObjectChanges {
        #[cfg(feature = "objects")]
        let unstyled = self.entries.iter().any(|e| e.kinds & UNSTYLED != 0);
        #[cfg(not(feature = "objects"))]
        let unstyled = false;
        ObjectChanges {
            any: self.any(),
            sections: self.sections,
            widths: self.widths,
            unstyled,
            marks: self.marks,
            fades: self.fades,
            anchored: self.entries.iter().any(|e| e.anchor_size > 0.0),
        }
    }

    /// Width of the widest line of any style, in logical pixels; 0 if no style sets it.
    pub fn max_width(&self) -> f32 {
        self.entries
            .iter()
            .map(|e| 2.0 * e.half_width)
            .fold(0.0, f32::max)
    }

    /// The slot of a style, added to the table if it is new. Equal styles have the same
    /// slot.
    #[cfg(feature = "objects")]
    pub fn slot(&mut self, style: ObjectStyleUniform) -> u8 {
        if self.entries.is_empty() {
            self.entries.push(ObjectStyleUniform::default());
        }
        let known = self.entries.iter().skip(1).position(|e| *e == style);
        let slot = known.map_or(self.entries.len(), |at| at + 1);
        if slot > MOST_STYLES {
            bevy::log::warn_once!(
                "more than {MOST_STYLES} different outline styles: the others are drawn like the last"
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
    mut changed: bevy::ecs::system::ResMut<super::changes::ChangedObjects>,
) {
    use bevy::ecs::change_detection::DetectChanges;
    if main.is_changed() {
        changed.note(&styles.slots, &main.slots);
        styles.clone_from(&main);
    }
}

/// The table of outline styles on the GPU.
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
