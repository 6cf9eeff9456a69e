//! The shader of rims, which loads depth where the adapter of its app can.

use bevy::{
    asset::{AssetEventSystems, embedded_asset, load_embedded_asset},
    prelude::*,
    render::renderer::RenderAdapterInfo,
    shader::ShaderDefVal,
};

use crate::depth::surfaces::prepass_is_empty;

/// The definition of a shader that must not load depth.
const NO_DEPTH_LOADS: &str = "NO_DEPTH_LOADS";

#[derive(Resource)]
struct RimShader(Handle<Shader>);

/// The part that needs the engine's renderer.
pub(super) fn build_render(app: &mut App) {
    embedded_asset!(app, "rim_light.wgsl");
    let shader = load_embedded_asset!(app, "rim_light.wgsl");
    app.insert_resource(RimShader(shader)).add_systems(
        PostUpdate,
        follow_adapter
            .run_if(resource_exists::<RenderAdapterInfo>)
            // The renderer takes what has changed until then, so that it never has the wrong
            // shader.
            .before(AssetEventSystems),
    );
}

/// Sets or removes [`NO_DEPTH_LOADS`] when the shader is loaded, or loaded again, and when the
/// app gets another adapter after a lost device.
///
/// The function that specializes pipelines of materials does not know the adapter, but each app has a
/// shader of its own.
fn follow_adapter(
    adapter: Res<RenderAdapterInfo>,
    shader: Res<RimShader>,
    mut shaders: ResMut<Assets<Shader>>,
) {
    // A pipeline of a material that loads depth is not valid there.
    let wanted = prepass_is_empty(&adapter).then(|| ShaderDefVal::from(NO_DEPTH_LOADS));
    let is_wrong = |shader: &Shader| shader.shader_defs.first() != wanted.as_ref();
    if shaders.get(&shader.0).is_some_and(is_wrong)
        && let Some(mut shader) = shaders.get_mut(&shader.0)
    {
        shader.shader_defs = wanted.into_iter().collect();
    }
}

#[cfg(test)]
mod tests {
    use bevy::{ecs::system::RunSystemOnce, render::renderer::WgpuWrapper};
    use wgpu_types::{AdapterInfo, Backend, DeviceType};

    use super::*;

    fn adapter(backend: Backend) -> RenderAdapterInfo {
        RenderAdapterInfo(WgpuWrapper::new(AdapterInfo {
            name: String::new(),
            vendor: 0,
            device: 0,
            device_type: DeviceType::Cpu,
            device_pci_bus_id: String::new(),
            driver: String::new(),
            driver_info: String::new(),
            backend,
            subgroup_min_size: 4,
            subgroup_max_size: 128,
            transient_saves_memory: false,
        }))
    }

    /// Whether the shader loads depth after a frame.
    fn loads_depth(world: &mut World) -> bool {
        world.run_system_once(follow_adapter).expect("it runs");
        let handle = &world.resource::<RimShader>().0;
        let shader = world.resource::<Assets<Shader>>().get(handle);
        !(shader.expect("a shader").shader_defs).contains(&NO_DEPTH_LOADS.into())
    }

    #[test]
    fn the_shader_follows_the_adapter_and_its_file() {
        let file = || Shader::from_wgsl("", "rim_light.wgsl");
        let mut world = World::new();
        let mut shaders = Assets::<Shader>::default();
        let handle = shaders.add(file());
        world.insert_resource(shaders);
        world.insert_resource(RimShader(handle.clone()));
        world.insert_resource(adapter(Backend::Gl));
        assert!(!loads_depth(&mut world));
        let mut shaders = world.resource_mut::<Assets<Shader>>();
        let _ = shaders.insert(&handle, file());
        assert!(!loads_depth(&mut world), "its file has changed");
        world.insert_resource(adapter(Backend::Vulkan));
        assert!(loads_depth(&mut world), "it has another adapter");
    }
}
