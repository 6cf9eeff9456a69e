#define_import_path bevy_comics::toon::indirect

// Light that arrives from all around: ambient light, lightmaps, irradiance volumes and
// environment maps. Of the last three the first that there is counts, as in the engine.

#import bevy_pbr::{
    clustered_forward::ClusterableObjectIndexRanges,
    mesh_view_bindings as view_bindings,
}
#ifdef IRRADIANCE_VOLUME
#import bevy_pbr::irradiance_volume
#else ifdef ENVIRONMENT_MAP
#import bevy_pbr::{environment_map, lighting::LayerLightingInput}
#endif
#import bevy_comics::toon::{
    light::ToonLight,
    surface::Surface,
    ambient::{AxisLight, TwoTones, two_tones},
}

// Light of the environment at a surface that faces along `normal`, without ambient light
// and lightmaps. Materials of meshes with a lightmap are compiled without it.
fn environment_light(
    s: Surface,
    normal: vec3<f32>,
    ranges: ptr<function, ClusterableObjectIndexRanges>,
) -> vec3<f32> {
#ifdef IRRADIANCE_VOLUME
    return irradiance_volume::irradiance_volume_light(s.position, normal, ranges);
#else ifdef ENVIRONMENT_MAP
    var layer: LayerLightingInput;
    layer.N = normal;
    layer.R = normal;
    layer.NdotV = 1.0;
    layer.perceptual_roughness = 1.0;
    layer.roughness = 1.0;
    return environment_map::compute_radiances(layer, ranges, s.position, false).irradiance;
#else
    return vec3(0.0);
#endif
}

// Light of the environment: `shade` everywhere, and `more` of it from one direction. The
// more of `ToonLight::environment`, the more of it is in these two tones; the rest
// changes with every normal, and is part of `shade`.
fn light_around(
    s: Surface,
    settings: ToonLight,
    ranges: ptr<function, ClusterableObjectIndexRanges>,
) -> TwoTones {
    var tones = TwoTones(vec3(0.0), vec3(0.0), vec3(0.0, 1.0, 0.0));
    if settings.environment > 0.0 {
        var axes: AxisLight;
        axes.right = environment_light(s, vec3(1.0, 0.0, 0.0), ranges);
        axes.left = environment_light(s, vec3(-1.0, 0.0, 0.0), ranges);
        axes.up = environment_light(s, vec3(0.0, 1.0, 0.0), ranges);
        axes.down = environment_light(s, vec3(0.0, -1.0, 0.0), ranges);
        axes.back = environment_light(s, vec3(0.0, 0.0, 1.0), ranges);
        axes.front = environment_light(s, vec3(0.0, 0.0, -1.0), ranges);
        tones = two_tones(axes);
        tones.shade *= settings.environment;
        tones.more *= settings.environment;
    }
    if settings.environment < 1.0 {
        tones.shade += (1.0 - settings.environment) * environment_light(s, s.normal, ranges);
    }
    return tones;
}

// Ambient light, unless it is baked into the lightmap of the mesh.
fn ambient() -> vec3<f32> {
#ifdef LIGHTMAP
    if view_bindings::lights.ambient_light_affects_lightmapped_meshes == 0u {
        return vec3(0.0);
    }
#endif
    return view_bindings::lights.ambient_color.rgb;
}
