//! What shadow maps and the object service import of the engine, for their functions in isolation
//! ([`wgsl::module_alone`](crate::wgsl::module_alone)).
//!
//! What the engine binds are private variables, which tests set. Only the shadow maps of
//! directional lights are textures, see
//! [`Gpu::evaluate_shadows`](crate::device::Gpu::evaluate_shadows).

/// Modules by name.
pub const MODULES: [(&str, &str); 9] = [
    ("bevy_pbr::mesh_bindings", MESH_BINDINGS),
    ("bevy_pbr::mesh_view_bindings", VIEW_BINDINGS),
    ("bevy_pbr::mesh_view_types", VIEW_TYPES),
    ("bevy_pbr::shadows", SHADOWS),
    ("bevy_pbr::shadow_sampling", SHADOW_SAMPLING),
    ("bevy_render::maths", MATHS),
    ("bevy_pbr::lighting", LIGHTING),
    ("bevy_pbr::raymarch", RAYMARCH),
    ("bevy_pbr::view_transformations", TRANSFORMATIONS),
];

/// Four meshes.
const MESH_BINDINGS: &str = "#define_import_path bevy_pbr::mesh_bindings
    struct Mesh { world_from_local: mat3x4<f32> }
    var<private> mesh: array<Mesh, 4>;
";

const VIEW_BINDINGS: &str = "#define_import_path bevy_pbr::mesh_view_bindings
    struct View {
        exposure: f32,
        world_position: vec3<f32>,
        viewport: vec4<f32>,
        world_from_view: mat4x4<f32>,
        clip_from_world: mat4x4<f32>,
        clip_from_view: mat4x4<f32>,
    }
    struct DirectionalCascade {
        clip_from_world: mat4x4<f32>,
        texel_size: f32,
        far_bound: f32,
    }
    struct DirectionalLight {
        cascades: array<DirectionalCascade, 2>,
        direction_to_light: vec3<f32>,
        flags: u32,
        shadow_depth_bias: f32,
        shadow_normal_bias: f32,
        num_cascades: u32,
        cascades_overlap_proportion: f32,
        depth_texture_base_index: u32,
    }
    struct Lights {
        directional_lights: array<DirectionalLight, 1>,
        spot_light_shadowmap_offset: i32,
    }
    struct ClusteredLight {
        light_custom_data: vec4<f32>,
        position_radius: vec4<f32>,
        flags: u32,
        shadow_depth_bias: f32,
        shadow_normal_bias: f32,
        spot_light_tan_angle: f32,
    }
    struct ClusteredLights { data: array<ClusteredLight, 1> }
    var<private> view: View;
    var<private> lights: Lights;
    var<private> clustered_lights: ClusteredLights;
    @group(0) @binding(2) var directional_shadow_textures: texture_depth_2d_array;
    @group(0) @binding(3) var directional_shadow_textures_comparison_sampler: sampler_comparison;
";

/// The bit is the engine's.
const VIEW_TYPES: &str = "#define_import_path bevy_pbr::mesh_view_types
    const POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE: u32 = 2u;
";

/// Cascades are found as in the engine.
const SHADOWS: &str = "#define_import_path bevy_pbr::shadows
    #import bevy_pbr::mesh_view_bindings::lights
    fn get_cascade_index(id: u32, view_z: f32) -> u32 {
        let count = lights.directional_lights[id].num_cascades;
        for (var i = 0u; i < count; i++) {
            if -view_z < lights.directional_lights[id].cascades[i].far_bound {
                return i;
            }
        }
        return count;
    }
    fn world_to_directional_light_local(id: u32, index: u32, at: vec4<f32>) -> vec4<f32> {
        let clip = lights.directional_lights[id].cascades[index].clip_from_world * at;
        if clip.w <= 0.0 {
            return vec4(0.0);
        }
        let ndc = clip.xyz / clip.w;
        if any(ndc.xy < vec2<f32>(-1.0)) || ndc.z < 0.0 || any(ndc > vec3<f32>(1.0)) {
            return vec4(0.0);
        }
        return vec4(ndc.xy * vec2(0.5, -0.5) + vec2(0.5), ndc.z, 1.0);
    }
";

/// Readings of cube maps: functions that use them are not run.
const SHADOW_SAMPLING: &str = "#define_import_path bevy_pbr::shadow_sampling
    const POINT_SHADOW_SCALE: f32 = 0.003;
    const D3D_SAMPLE_POINT_COEFFS = array<f32, 8>();
    const D3D_SAMPLE_POINT_POSITIONS = array<vec2<f32>, 8>();
    fn sample_shadow_cubemap_hardware(at: vec3<f32>, depth: f32, id: u32) -> f32 { return 1.0; }
";

const MATHS: &str = "#define_import_path bevy_render::maths
    fn orthonormalize(z: vec3<f32>) -> mat3x3<f32> {
        return mat3x3(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), z);
    }
";

/// Light textures import it, and nothing here runs it.
const LIGHTING: &str = "#define_import_path bevy_pbr::lighting
    fn cubemap_uv(direction: vec3<f32>, order: u32) -> vec2<f32> { return direction.xy; }
";

/// Names that modules import beside the functions that are tested.
const RAYMARCH: &str = "#define_import_path bevy_pbr::raymarch
    struct DepthRayMarchResult { hit: bool, hit_penetration_frac: f32 }
";

const TRANSFORMATIONS: &str = "#define_import_path bevy_pbr::view_transformations
    fn position_world_to_ndc(at: vec3<f32>) -> vec3<f32> { return at; }
";
