//! Gives meshes the names that their materials have in a glTF file.

use bevy::{prelude::*, reflect::TypeRegistry};

use super::{
    name::MaterialName,
    scene::{Original, SceneChanges, SceneRoots},
};

/// The engine's component with the name of a glTF material. This crate does not depend on the
/// engine's loader, so it is read by reflection.
const GLTF_NAME: &str = "bevy_gltf::assets::GltfMaterialName";

/// The meshes that a scene converts or has converted, without a name.
type Nameless = (
    Or<(With<MeshMaterial3d<StandardMaterial>>, With<Original>)>,
    Without<MaterialName>,
);

/// Names the meshes that are lit by the names of their materials.
pub(super) fn name_meshes(
    mut commands: Commands,
    (roots, changes): (SceneRoots, Res<SceneChanges>),
    meshes: Query<EntityRef, Nameless>,
    types: Option<Res<AppTypeRegistry>>,
) {
    let Some(types) = types.filter(|_| roots.any_reads_names()) else {
        return;
    };
    let types = types.read();
    for mesh in meshes.iter_many(&changes.meshes) {
        let lit_by = roots.of(mesh.id(), None);
        if lit_by.is_some_and(|(_, lit_by)| lit_by.reads_names())
            && let Some(name) = gltf_name(mesh, &types)
        {
            name_mesh(&mut commands, mesh.id(), name);
        }
    }
}

fn name_mesh(commands: &mut Commands, mesh: Entity, name: String) {
    if let Ok(mut mesh) = commands.get_entity(mesh) {
        mesh.insert(MaterialName(name));
    }
}

fn gltf_name(mesh: EntityRef, types: &TypeRegistry) -> Option<String> {
    let registration = types.get_with_type_path(GLTF_NAME)?;
    let component = registration.data::<ReflectComponent>()?.reflect(mesh)?;
    let name = component.reflect_ref().as_tuple_struct().ok()?.field(0)?;
    name.try_downcast_ref::<String>().cloned()
}
