//! The ids of objects.

use bevy::ecs::entity::Entity;

/// The id of an object in [`ViewObjectIds`](super::ViewObjectIds), 1 to 65535.
///
/// | mesh | entity whose id it has |
/// |---|---|
/// | below an [`OutlineGroup`](crate::OutlineGroup), or with one | the entity with the nearest group |
/// | one of several primitives of a glTF node, in no group | the first of these primitives, in the order of the node's children |
/// | any other | the entity with the mesh |
///
/// Primitives of a glTF node are meshes of one parent whose asset paths end in
/// `#MeshM/PrimitiveP` with the same file and the same `M`, as the engine's glTF loader
/// spawns them. A second mesh with the same `P` begins a second object.
///
/// Entities whose indices differ by a multiple of 65535 have the same id, and no
/// [object edge](crate::lines::ObjectEdges) between them.
pub fn object_id(entity: Entity) -> u16 {
    (entity.index_u32() % 65535 + 1) as u16
}
