//! What effects ask for that treat objects as a whole, and the table that answers it.

use bevy::{
    prelude::*,
    render::render_resource::{
        BindGroupLayoutEntry, Buffer, ShaderStages, ShaderType,
        binding_types::storage_buffer_read_only_sized,
    },
};

use crate::depth::{DepthMapping, view::ViewUniform};

/// `Eye` of `depths.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct ObjectEye {
    pub position: Vec3,
    pub orthographic: u32,
    pub forward: Vec3,
    /// 1: depths of the frames before are not used.
    pub resets: u32,
    pub axis: Vec2,
    pub spare: Vec2,
    pub view: ViewUniform,
}

/// On a view in the render world: a request for the depths of objects in the depth map, written in
/// every frame by [`PrepareComics::Choose`](crate::schedule::PrepareComics::Choose).
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct ObjectDepthRequest {
    pub eye: ObjectEye,
    pub mapping: DepthMapping,
    /// Number of cuts of the camera so far.
    pub cuts: u32,
}

/// On a view whose effects treat objects as a whole: the depths of all objects in the depth map,
/// by id. See `depths.wgsl`.
#[derive(Component)]
pub(crate) struct ObjectDepths {
    pub table: Buffer,
}

/// The number of the binding in `objects.wgsl`: passes of lines and of effects have others.
pub(crate) const OBJECT_DEPTHS_BINDING: u32 = 32;

/// The layout entry of the table.
pub(crate) fn object_depths_entry() -> BindGroupLayoutEntry {
    storage_buffer_read_only_sized(false, None).build(OBJECT_DEPTHS_BINDING, ShaderStages::FRAGMENT)
}
