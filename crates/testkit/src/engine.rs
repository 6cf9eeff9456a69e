//! The engine's modules as far as the toon material and the object service use them, for their
//! functions in isolation
//! ([`wgsl::module_alone`](crate::wgsl::module_alone)).
//!
//! What the engine binds are private variables, and what it reads from textures are simple
//! functions of such variables, which tests set and know. Only the shadow maps of directional
//! lights are textures, see [`Gpu::evaluate_shadows`](crate::device::Gpu::evaluate_shadows).

/// Modules by name.
pub const MODULES: [(&str, &str); 14] = [
    ("bevy_pbr::mesh_bindings", MESH_BINDINGS),
    ("bevy_pbr::mesh_view_bindings", VIEW_BINDINGS),
    ("bevy_pbr::mesh_view_types", VIEW_TYPES),
    ("bevy_pbr::shadows", SHADOWS),
    ("bevy_pbr::shadow_sampling", SHADOW_SAMPLING),
    ("bevy_render::maths", MATHS),
    ("bevy_pbr::lighting", LIGHTING),
    ("bevy_pbr::atmosphere::functions", ATMOSPHERE),
    ("bevy_pbr::clustered_forward", CLUSTERS),
    ("bevy_pbr::irradiance_volume", IRRADIANCE_VOLUME),
    ("bevy_pbr::environment_map", ENVIRONMENT_MAP),
    ("bevy_pbr::raymarch", RAYMARCH),
    ("bevy_pbr::view_transformations", TRANSFORMATIONS),
    ("bevy_pbr::prepass_utils", PREPASS),
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
        view_from_world: mat4x4<f32>,
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
        color: vec4<f32>,
        direction_to_light: vec3<f32>,
        flags: u32,
        shadow_depth_bias: f32,
        shadow_normal_bias: f32,
        num_cascades: u32,
        cascades_overlap_proportion: f32,
        depth_texture_base_index: u32,
        decal_index: u32,
        sun_disk_angular_size: f32,
    }
    struct RectLight {
        color: vec4<f32>,
        position: vec3<f32>,
        width: f32,
        right: vec3<f32>,
        height: f32,
        up: vec3<f32>,
        range: f32,
    }
    struct Lights {
        directional_lights: array<DirectionalLight, 1>,
        rect_lights: array<RectLight, 1>,
        ambient_color: vec4<f32>,
        spot_light_shadowmap_offset: i32,
        ambient_light_affects_lightmapped_meshes: u32,
    }
    struct ClusteredLight {
        light_custom_data: vec4<f32>,
        color_inverse_square_range: vec4<f32>,
        position_radius: vec4<f32>,
        flags: u32,
        shadow_depth_bias: f32,
        shadow_normal_bias: f32,
        spot_light_tan_angle: f32,
        shadow_map_near_z: f32,
        decal_index: u32,
    }
    struct ClusteredLights { data: array<ClusteredLight, 1> }
    struct Atmosphere { world_to_atmosphere: mat4x4<f32>, inner_radius: f32 }
    struct Globals { time: f32 }
    var<private> view: View;
    var<private> lights: Lights;
    var<private> clustered_lights: ClusteredLights;
    var<private> atmosphere: Atmosphere;
    var<private> globals: Globals;
    @group(0) @binding(2) var directional_shadow_textures: texture_depth_2d_array;
    @group(0) @binding(3) var directional_shadow_textures_comparison_sampler: sampler_comparison;
";

/// The bits are the engine's.
const VIEW_TYPES: &str = "#define_import_path bevy_pbr::mesh_view_types
    const POINT_LIGHT_FLAGS_SHADOWS_ENABLED_BIT: u32 = 1u;
    const POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE: u32 = 2u;
    const POINT_LIGHT_FLAGS_AFFECTS_LIGHTMAPPED_MESH_DIFFUSE_BIT: u32 = 8u;
    const POINT_LIGHT_FLAGS_CONTACT_SHADOWS_ENABLED_BIT: u32 = 16u;
    const DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT: u32 = 1u;
    const DIRECTIONAL_LIGHT_FLAGS_AFFECTS_LIGHTMAPPED_MESH_DIFFUSE_BIT: u32 = 4u;
    const DIRECTIONAL_LIGHT_FLAGS_CONTACT_SHADOWS_ENABLED_BIT: u32 = 8u;
";

/// Half planes with a soft border: those of spot lights are moved by the near plane. Cascades are
/// found as in the engine.
const SHADOWS: &str = "#define_import_path bevy_pbr::shadows
    #import bevy_pbr::mesh_view_bindings::lights
    var<private> border: vec4<f32>;
    fn fetch_spot_shadow(id: u32, at: vec4<f32>, normal: vec3<f32>, near: f32, pixel: vec2<f32>) -> f32 {
        return clamp(dot(at, border) + near, 0.0, 1.0);
    }
    fn fetch_point_shadow(id: u32, at: vec4<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> f32 {
        return clamp(dot(at, border), 0.0, 1.0);
    }
    fn fetch_directional_shadow(
        id: u32, at: vec4<f32>, normal: vec3<f32>, view_z: f32, pixel: vec2<f32>,
    ) -> f32 {
        return clamp(dot(at, border), 0.0, 1.0);
    }
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
    const D3D_SAMPLE_POINT_COEFFS: array<f32, 8> = array(
        0.157112, 0.157112, 0.138651, 0.130251, 0.114946, 0.114946, 0.107982, 0.079001,
    );
    const D3D_SAMPLE_POINT_POSITIONS: array<vec2<f32>, 8> = array(
        vec2(0.125, -0.375), vec2(-0.125, 0.375), vec2(0.625, 0.125), vec2(-0.375, -0.625),
        vec2(-0.625, 0.625), vec2(-0.875, -0.125), vec2(0.375, 0.875), vec2(0.875, -0.875),
    );
    fn sample_shadow_cubemap_hardware(at: vec3<f32>, depth: f32, id: u32) -> f32 { return 1.0; }
";

const MATHS: &str = "#define_import_path bevy_render::maths
    fn orthonormalize(z: vec3<f32>) -> mat3x3<f32> {
        return mat3x3(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), z);
    }
";

const LIGHTING: &str = "#define_import_path bevy_pbr::lighting
    struct LayerLightingInput {
        N: vec3<f32>,
        R: vec3<f32>,
        NdotV: f32,
        perceptual_roughness: f32,
        roughness: f32,
    }
    fn cubemap_uv(direction: vec3<f32>, order: u32) -> vec2<f32> { return direction.xy; }
    fn sample_transmittance_lut(radius: f32, height: f32) -> vec3<f32> {
        return vec3(1.0, 0.5 + 0.5 * height, 1.0 / (1.0 + radius));
    }
";

const ATMOSPHERE: &str = "#define_import_path bevy_pbr::atmosphere::functions
    #import bevy_pbr::mesh_view_bindings::Atmosphere
    fn clamp_to_surface(air: Atmosphere, at: vec3<f32>) -> vec3<f32> {
        return at * max(air.inner_radius / length(at), 1.0);
    }
    fn calculate_visible_sun_ratio(air: Atmosphere, radius: f32, height: f32, disk: f32) -> f32 {
        return clamp(0.5 + height / disk, 0.0, 1.0);
    }
";

const CLUSTERS: &str = "#define_import_path bevy_pbr::clustered_forward
    struct ClusterableObjectIndexRanges { first: u32 }
";

/// Light that changes with the normal: an ambient light, and a sum over the axes.
const IRRADIANCE_VOLUME: &str = "#define_import_path bevy_pbr::irradiance_volume
    #import bevy_pbr::clustered_forward::ClusterableObjectIndexRanges
    var<private> sides: array<vec3<f32>, 6>;
    fn irradiance_volume_light(
        at: vec3<f32>, n: vec3<f32>, ranges: ptr<function, ClusterableObjectIndexRanges>,
    ) -> vec3<f32> {
        let x = select(sides[1], sides[0], n.x > 0.0);
        let y = select(sides[3], sides[2], n.y > 0.0);
        let z = select(sides[5], sides[4], n.z > 0.0);
        return n.x * n.x * x + n.y * n.y * y + n.z * n.z * z;
    }
";

const ENVIRONMENT_MAP: &str = "#define_import_path bevy_pbr::environment_map
    #import bevy_pbr::clustered_forward::ClusterableObjectIndexRanges
    #import bevy_pbr::lighting::LayerLightingInput
    #import bevy_pbr::irradiance_volume::irradiance_volume_light
    struct EnvironmentMapRadiances { irradiance: vec3<f32>, radiance: vec3<f32> }
    // Twice that of the volume, so that the two differ.
    fn compute_radiances(
        layer: LayerLightingInput,
        ranges: ptr<function, ClusterableObjectIndexRanges>,
        at: vec3<f32>,
        found: bool,
    ) -> EnvironmentMapRadiances {
        let light = irradiance_volume_light(at, layer.N, ranges);
        return EnvironmentMapRadiances(2.0 * light, vec3(0.0));
    }
";

/// A march whose end is known.
const RAYMARCH: &str = "#define_import_path bevy_pbr::raymarch
    struct DepthRayMarchResult { hit: bool, hit_penetration_frac: f32 }
";

/// A view without perspective: clip space is the world.
const TRANSFORMATIONS: &str = "#define_import_path bevy_pbr::view_transformations
    fn position_world_to_clip(at: vec3<f32>) -> vec4<f32> { return vec4(at, 1.0); }
    fn position_world_to_ndc(at: vec3<f32>) -> vec3<f32> { return at; }
    fn depth_ndc_to_view_z(depth: f32) -> f32 { return -1.0 / depth; }
";

/// A depth prepass with nothing in it: functions that read it are not run.
const PREPASS: &str = "#define_import_path bevy_pbr::prepass_utils
    fn prepass_depth(at: vec4<f32>, sample_index: u32) -> f32 { return 0.0; }
";
