//! The shaders of the toon material compose and validate with every pair of settings, together with
//! the engine's own modules.

use crate::shaders::{
    Definitions,
    covering::{Choice, covering, definitions, fewest, parsed},
    materials::library,
    shader,
};

/// The files of its entry points.
const FILES: [&str; 2] = ["toon/vertex.wgsl", "toon/toon.wgsl"];

/// What views, meshes and materials can be; of each list one choice is compiled.
const LISTS: &[&str] = &[
    "VIEW_PROJECTION_PERSPECTIVE | VIEW_PROJECTION_ORTHOGRAPHIC | VIEW_PROJECTION_NONSTANDARD",
    "| MULTISAMPLED",
    "| DEPTH_PREPASS | DEPTH_PREPASS NORMAL_PREPASS MOTION_VECTOR_PREPASS",
    "| ENVIRONMENT_MAP ENVIRONMENT | IRRADIANCE_VOLUME ENVIRONMENT \
     | ENVIRONMENT_MAP IRRADIANCE_VOLUME ENVIRONMENT",
    // The engine's shader needs first texture coordinates beside second ones.
    "| LIGHTMAP VERTEX_UVS VERTEX_UVS_A VERTEX_UVS_B",
    "| CONTACT_SHADOWS",
    "| ATMOSPHERE",
    "| SCREEN_SPACE_AMBIENT_OCCLUSION",
    "| DISTANCE_FOG",
    // As the engine sets them on adapters with arrays of textures.
    "| CLUSTERED_DECALS_ARE_USABLE LIGHT_TEXTURES MULTIPLE_LIGHT_PROBES_IN_ARRAY \
     MULTIPLE_LIGHTMAPS_IN_ARRAY",
    "| TONEMAP_IN_SHADER TONEMAP_METHOD_REINHARD DEBAND_DITHER",
    "SHADOW_FILTER_METHOD_GAUSSIAN SLOPED_SHADOWS | SHADOW_FILTER_METHOD_HARDWARE_2X2 \
     | SHADOW_FILTER_METHOD_TEMPORAL TEMPORAL_JITTER",
    "| MAY_DISCARD | PREMULTIPLY_ALPHA BLEND_PREMULTIPLIED_ALPHA | ALPHA_TO_COVERAGE",
    "| VISIBILITY_RANGE_DITHER",
    "| VERTEX_UVS VERTEX_UVS_A | VERTEX_UVS VERTEX_UVS_A VERTEX_TANGENTS \
     | VERTEX_UVS VERTEX_UVS_A VERTEX_UVS_B STANDARD_MATERIAL_BASE_COLOR_UV_B",
    "| VERTEX_COLORS | VERTEX_COLORS VERTEX_THRESHOLD THRESHOLD",
    "| THRESHOLD_MAP THRESHOLD",
    "| SKINNED | MORPH_TARGETS | SKINNED MORPH_TARGETS",
    "| RAMP_LIGHT_FRACTION RAMP_STOPS=2 | RAMP_PER_LIGHT RAMP_STOPS=3 \
     | RAMP_BRIGHTEST RAMP_STOPS=8",
    "| RAMP_ABSOLUTE",
    "| RAMP_MAP",
    "| RAMP_DETAIL DETAIL_DEPTH | RAMP_DETAIL DETAIL_FOCUS | RAMP_DETAIL DETAIL_RIM \
     | RAMP_DETAIL DETAIL_HIGHLIGHT | RAMP_DETAIL DETAIL_CONSTANT | RAMP_DETAIL DETAIL_VISIBLE",
    "| STYLIZED_HIGHLIGHT STYLIZED_HIGHLIGHT_VIEW | STYLIZED_HIGHLIGHT STYLIZED_HIGHLIGHT_LIGHT \
     | STYLIZED_HIGHLIGHT STYLIZED_HIGHLIGHT_TANGENT \
     | STYLIZED_HIGHLIGHT STYLIZED_HIGHLIGHT_WORLD",
    "STYLIZED_HIGHLIGHT_SHAPE=0 | STYLIZED_HIGHLIGHT_SHAPE=1 | STYLIZED_HIGHLIGHT_SHAPE=2 \
     | STYLIZED_HIGHLIGHT_SHAPE=3 | STYLIZED_HIGHLIGHT_SHAPE=4 | STYLIZED_HIGHLIGHT_SHAPE=5",
    // As an app with OpenGL sets the last one.
    "| RIM KEY_LIGHT | RIM KEY_LIGHT DEPTH_RIM VIEW_SCALE \
     | RIM KEY_LIGHT DEPTH_RIM VIEW_SCALE NO_DEPTH_LOADS",
    "| PROXY PROXY_UP | PROXY PROXY_NORMAL | PROXY PROXY_NORMAL PROXY_SMOOTHED",
    "| HATCHED VIEW_SCALE | HATCHED VIEW_SCALE HATCH_DOTS | HATCHED VIEW_SCALE HATCH_REST \
     | HATCHED VIEW_SCALE HATCH_REST HATCH_DOTS | HATCHED VIEW_SCALE HATCH_ART_MAP \
     | HATCHED VIEW_SCALE HATCH_ART_MAP NO_TEXTURE_LEVELS \
     | HATCHED VIEW_SCALE HATCH_REST HATCH_ART_MAP",
];

/// What is always set.
pub const ALWAYS: &[&str] = &[
    "MESH_PIPELINE",
    "VERTEX_OUTPUT_INSTANCE_INDEX",
    "VERTEX_POSITIONS",
    "VERTEX_NORMALS",
    "IRRADIANCE_VOLUMES_ARE_USABLE",
    "MATERIAL_BIND_GROUP=3",
    "TONEMAPPING_LUT_TEXTURE_BINDING_INDEX=18",
    "TONEMAPPING_LUT_SAMPLER_BINDING_INDEX=19",
    "SCREEN_SPACE_SPECULAR_TRANSMISSION_BLUR_TAPS=8",
    "MAX_DIRECTIONAL_LIGHTS=10",
    "MAX_CASCADES_PER_LIGHT=4",
    "AVAILABLE_STORAGE_BUFFER_BINDINGS=8",
];

/// All definitions of these lists.
pub fn listed() -> Definitions {
    let all = [parsed(LISTS).concat().concat(), ALWAYS.to_vec()];
    definitions(&all.concat())
}

/// The definitions of a row, without those that need others that it lacks.
fn names(mut names: Vec<&'static str>) -> Vec<&'static str> {
    names.extend(ALWAYS);
    names.sort_unstable();
    names.dedup();
    let has = |name: &str| names.contains(&name);
    let (uvs, depth) = (has("VERTEX_UVS_A"), has("DEPTH_PREPASS"));
    let ramp = names.iter().any(|name| name.starts_with("RAMP_STOPS"));
    let maps = has("VERTEX_THRESHOLD") || uvs;
    let in_lightmap = has("LIGHTMAP");
    names.retain(|name| match *name {
        "THRESHOLD_MAP" => uvs,
        "THRESHOLD" => maps,
        "DEPTH_RIM" => depth,
        "RAMP_ABSOLUTE" | "RAMP_MAP" => ramp,
        _ if name.starts_with("RAMP_DETAIL") || name.starts_with("DETAIL_") => ramp,
        // The engine binds no lightmaps for such meshes.
        "SKINNED" | "MORPH_TARGETS" => !in_lightmap,
        // The material leaves them out, see `ToonLight::specialize`.
        "ENVIRONMENT_MAP" | "IRRADIANCE_VOLUME" | "ENVIRONMENT" => !in_lightmap,
        _ => true,
    });
    if names.contains(&"STYLIZED_HIGHLIGHT") && !names.contains(&"KEY_LIGHT") {
        names.push("KEY_LIGHT");
    }
    // Strokes of a map lie at rest on meshes without coordinates.
    if names.contains(&"HATCH_ART_MAP") && !uvs && !names.contains(&"HATCH_REST") {
        names.push("HATCH_REST");
    }
    names
}

fn check(rows: &[Definitions]) {
    let mut library = library();
    let sources = FILES.map(shader);
    for definitions in rows {
        for source in &sources {
            if let Err(error) = library.compose(source, definitions) {
                panic!("{definitions:?}: {error}");
            }
        }
    }
}

/// Every setting, among some of the others.
#[test]
fn every_setting_composes_and_validates() {
    let lists = parsed(LISTS);
    let mut rows = Vec::new();
    for (k, list) in lists.iter().enumerate() {
        // A choice may need one of another list, which one of three rows has.
        for (choice, turn) in
            (0..list.len()).flat_map(|choice| [0, 1, 2].map(|turn| (choice, turn)))
        {
            let of = |(i, list): (usize, &&[Choice])| {
                let other = (choice + i + turn) % list.len();
                list[if i == k { choice } else { other }]
            };
            let chosen = lists.iter().enumerate().flat_map(of).copied();
            rows.push(definitions(&names(chosen.collect())));
        }
    }
    let rows = fewest(rows);
    let all: Vec<&str> = lists.concat().concat();
    for definition in definitions(&all) {
        let is_set = rows.iter().any(|row| row.contains(&definition));
        assert!(is_set, "{definition:?} is in no row");
    }
    check(&rows);
}

#[test]
#[ignore = "long: every pair of settings"]
fn every_pair_of_settings_composes_and_validates() {
    let found = covering(&parsed(LISTS), names);
    let counts = [found.rows.len(), found.never.len()];
    println!("{} rows, {} pairs that cannot be", counts[0], counts[1]);
    for both in found.never {
        let both = both.concat();
        let needs = |names: &[&str]| both.iter().any(|name| names.contains(name));
        let has_reason = needs(&["LIGHTMAP", "THRESHOLD_MAP", "DEPTH_RIM"])
            || needs(&["RAMP_ABSOLUTE", "RAMP_MAP", "RAMP_DETAIL", "THRESHOLD"]);
        assert!(has_reason, "{both:?} are never compiled together");
    }
    let rows: Vec<Definitions> = found.rows.iter().map(|row| definitions(row)).collect();
    check(&rows);
}
