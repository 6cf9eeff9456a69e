//! The shaders of the cartoon material compose and validate with every pair of settings, together with
//! the engine's own modules.

use std::{collections::BTreeSet, fs};

use bevy::{prelude::*, render::view::Msaa, shader::Shader};
use bevy_comics_testkit::wgsl::{Definition, Library, files};

use crate::small::{Small, size};

/// One way of something, with its definitions.
type Choice = &'static [&'static str];

/// What views, meshes and materials can be; of each list one choice is compiled. A definition that ends
/// in `=` and a number has that value.
const LISTS: &[&[Choice]] = &[
    &[
        &["VIEW_PROJECTION_PERSPECTIVE"],
        &["VIEW_PROJECTION_ORTHOGRAPHIC"],
        &["VIEW_PROJECTION_NONSTANDARD"],
    ],
    &[&[], &["MULTISAMPLED"]],
    &[
        &[],
        &["DEPTH_PREPASS"],
        &["DEPTH_PREPASS", "NORMAL_PREPASS", "MOTION_VECTOR_PREPASS"],
    ],
    &[
        &[],
        &["ENVIRONMENT_MAP", "ENVIRONMENT"],
        &["IRRADIANCE_VOLUME", "ENVIRONMENT"],
        &["ENVIRONMENT_MAP", "IRRADIANCE_VOLUME", "ENVIRONMENT"],
    ],
    // The engine's shader needs first texture coordinates beside second ones.
    &[
        &[],
        &["LIGHTMAP", "VERTEX_UVS", "VERTEX_UVS_A", "VERTEX_UVS_B"],
    ],
    &[&[], &["CONTACT_SHADOWS"]],
    &[&[], &["ATMOSPHERE"]],
    &[&[], &["SCREEN_SPACE_AMBIENT_OCCLUSION"]],
    &[&[], &["DISTANCE_FOG"]],
    // As the engine sets them on adapters with arrays of textures.
    &[
        &[],
        &[
            "CLUSTERED_DECALS_ARE_USABLE",
            "LIGHT_TEXTURES",
            "MULTIPLE_LIGHT_PROBES_IN_ARRAY",
            "MULTIPLE_LIGHTMAPS_IN_ARRAY",
        ],
    ],
    &[
        &[],
        &[
            "TONEMAP_IN_SHADER",
            "TONEMAP_METHOD_REINHARD",
            "DEBAND_DITHER",
        ],
    ],
    &[
        &["SHADOW_FILTER_METHOD_GAUSSIAN", "SLOPED_SHADOWS"],
        &["SHADOW_FILTER_METHOD_HARDWARE_2X2"],
        &["SHADOW_FILTER_METHOD_TEMPORAL", "TEMPORAL_JITTER"],
    ],
    &[
        &[],
        &["MAY_DISCARD"],
        &["PREMULTIPLY_ALPHA", "BLEND_PREMULTIPLIED_ALPHA"],
        &["ALPHA_TO_COVERAGE"],
    ],
    &[&[], &["VISIBILITY_RANGE_DITHER"]],
    &[
        &[],
        &["VERTEX_UVS", "VERTEX_UVS_A"],
        &["VERTEX_UVS", "VERTEX_UVS_A", "VERTEX_TANGENTS"],
        &[
            "VERTEX_UVS",
            "VERTEX_UVS_A",
            "VERTEX_UVS_B",
            "STANDARD_MATERIAL_BASE_COLOR_UV_B",
        ],
    ],
    &[
        &[],
        &["VERTEX_COLORS"],
        &["VERTEX_COLORS", "VERTEX_THRESHOLD", "THRESHOLD"],
    ],
    &[&[], &["THRESHOLD_MAP", "THRESHOLD"]],
    &[
        &[],
        &["SKINNED"],
        &["MORPH_TARGETS"],
        &["SKINNED", "MORPH_TARGETS"],
    ],
    &[
        &[],
        &["RAMP_SHARE", "RAMP_STOPS=2"],
        &["RAMP_PER_LIGHT", "RAMP_STOPS=3"],
        &["RAMP_BRIGHTEST", "RAMP_STOPS=8"],
    ],
    &[&[], &["RAMP_ABSOLUTE"]],
    &[&[], &["RAMP_MAP"]],
    &[
        &[],
        &["RAMP_DETAIL", "DETAIL_DEPTH"],
        &["RAMP_DETAIL", "DETAIL_FOCUS"],
        &["RAMP_DETAIL", "DETAIL_RIM"],
        &["RAMP_DETAIL", "DETAIL_HIGHLIGHT"],
        &["RAMP_DETAIL", "DETAIL_CONSTANT"],
        &["RAMP_DETAIL", "DETAIL_VISIBLE"],
    ],
    &[
        &[],
        &["KEY_LIGHT", "GLINT", "GLINT_VIEW", "GLINT_SHAPE=0"],
        &["KEY_LIGHT", "GLINT", "GLINT_LIGHT", "GLINT_SHAPE=1"],
        &["KEY_LIGHT", "GLINT", "GLINT_TANGENT", "GLINT_SHAPE=2"],
        &["KEY_LIGHT", "GLINT", "GLINT_WORLD", "GLINT_SHAPE=3"],
        &["KEY_LIGHT", "GLINT", "GLINT_VIEW", "GLINT_SHAPE=4"],
        &["KEY_LIGHT", "GLINT", "GLINT_LIGHT", "GLINT_SHAPE=5"],
    ],
    &[
        &[],
        &["RIM", "KEY_LIGHT"],
        &["RIM", "KEY_LIGHT", "DEPTH_RIM"],
    ],
    &[
        &[],
        &["FORM", "FORM_UP"],
        &["FORM", "FORM_NORMAL"],
        &["FORM", "FORM_NORMAL", "FORM_SMOOTHED"],
    ],
    &[
        &[],
        &["HATCHED"],
        &["HATCHED", "HATCH_DOTS"],
        &["HATCHED", "HATCH_REST"],
        &["HATCHED", "HATCH_REST", "HATCH_DOTS"],
        &["HATCHED", "HATCH_ART_MAP"],
        &["HATCHED", "HATCH_ART_MAP", "NO_TEXTURE_LEVELS"],
        &["HATCHED", "HATCH_REST", "HATCH_ART_MAP"],
    ],
];

/// What is always set.
const ALWAYS: &[&str] = &[
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

/// A row has the number of one choice of every list.
type Row = Vec<usize>;

/// The pairs of choices that a row has and that are compiled.
fn pairs(row: &Row) -> Vec<(usize, usize, usize, usize)> {
    let names = names(row);
    let is_compiled =
        |(i, a): &(usize, usize)| LISTS[*i][*a].iter().all(|name| names.contains(name));
    let kept: Vec<(usize, usize)> = row
        .iter()
        .copied()
        .enumerate()
        .filter(is_compiled)
        .collect();
    let mut found = Vec::new();
    for (k, (i, a)) in kept.iter().enumerate() {
        found.extend(kept[k + 1..].iter().map(|(j, b)| (*i, *a, *j, *b)));
    }
    found
}

/// Rows that together have every pair of choices that can be, and the pairs that cannot. Each row is the
/// best of several random ones.
fn rows() -> (Vec<Row>, Vec<(usize, usize, usize, usize)>) {
    let mut missing: BTreeSet<_> = (0..LISTS.len())
        .flat_map(|i| (i + 1..LISTS.len()).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let choices =
                (0..LISTS[i].len()).flat_map(move |a| (0..LISTS[j].len()).map(move |b| (a, b)));
            choices.map(move |(a, b)| (i, a, j, b))
        })
        .collect();
    let mut state = 1u64;
    let mut random = move |below: usize| {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as usize % below
    };
    let (mut rows, mut never) = (Vec::new(), Vec::new());
    while let Some(wanted) = missing.first().copied() {
        let (i, a, j, b) = wanted;
        // A pair may need a third choice: one of many random rows has it.
        let candidates = (0..120).map(|_| {
            let mut row: Row = LISTS.iter().map(|list| random(list.len())).collect();
            (row[i], row[j]) = (a, b);
            let pairs = pairs(&row);
            (row, pairs)
        });
        let candidates = candidates.filter(|(_, pairs)| pairs.contains(&wanted));
        let new = |(_, pairs): &(Row, Vec<_>)| pairs.iter().filter(|p| missing.contains(p)).count();
        let Some((row, pairs)) = candidates.max_by_key(new) else {
            missing.remove(&wanted);
            never.push(wanted);
            continue;
        };
        for pair in &pairs {
            missing.remove(pair);
        }
        rows.push(row);
    }
    (rows, never)
}

fn definition(text: &'static str) -> Definition<'static> {
    match text.split_once('=') {
        Some((name, number)) => (name, Some(number.parse().expect("a number"))),
        None => (text, None),
    }
}

/// The definitions of a row, without those that need others that it lacks.
fn names(row: &Row) -> Vec<&'static str> {
    let chosen = LISTS.iter().zip(row).flat_map(|(list, k)| list[*k]);
    let mut names: Vec<&str> = ALWAYS.iter().chain(chosen).copied().collect();
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
        // The material leaves them out, see `CartoonLight::specialize`.
        "ENVIRONMENT_MAP" | "IRRADIANCE_VOLUME" | "ENVIRONMENT" => !in_lightmap,
        _ => true,
    });
    // Strokes of a map lie at rest on meshes without coordinates.
    if names.contains(&"HATCH_ART_MAP") && !uvs && !names.contains(&"HATCH_REST") {
        names.push("HATCH_REST");
    }
    names
}

/// Every definition that the shaders of the material ask for is compiled here.
#[test]
fn the_lists_have_every_definition() {
    let all: Vec<&str> = (LISTS.iter().flat_map(|list| list.iter().copied().flatten()))
        .chain(ALWAYS)
        .map(|text| definition(text).0)
        .collect();
    for path in files() {
        if !path.to_string_lossy().contains("/cartoon/") {
            continue;
        }
        let text = fs::read_to_string(&path).expect("readable");
        let asks = |line: &&str| {
            ["#ifdef", "#ifndef", "#else ifdef"]
                .iter()
                .any(|word| line.starts_with(word))
        };
        for line in text.lines().filter(asks) {
            let name = line.split_whitespace().last().expect("a name");
            assert!(all.contains(&name), "{}: {name}", path.display());
        }
    }
}

#[test]
fn every_pair_of_settings_composes_and_validates() {
    let mut small = Small::new(size(), Msaa::Off);
    small.headless.step(2);
    let shaders = small.world().resource::<Assets<Shader>>();
    let mut library = Library::new(shaders.iter().map(|(_, shader)| shader));
    let entry = |name: &str| {
        let mut paths = files().into_iter();
        let path = paths.find(|path| path.ends_with(name)).expect("a shader");
        fs::read_to_string(path).expect("readable")
    };
    let (vertex, fragment) = (entry("cartoon/vertex.wgsl"), entry("cartoon/cartoon.wgsl"));
    let (rows, never) = rows();
    println!("{} rows, {} pairs that cannot be", rows.len(), never.len());
    for (i, a, j, b) in never {
        let both = [LISTS[i][a], LISTS[j][b]].concat();
        let needs = |names: &[&str]| both.iter().any(|name| names.contains(name));
        let has_reason = needs(&["LIGHTMAP", "THRESHOLD_MAP", "DEPTH_RIM"])
            || needs(&["RAMP_ABSOLUTE", "RAMP_MAP", "RAMP_DETAIL", "THRESHOLD"]);
        assert!(has_reason, "{both:?} are never compiled together");
    }
    for row in &rows {
        let definitions: Vec<_> = names(row).into_iter().map(definition).collect();
        for source in [&vertex, &fragment] {
            if let Err(error) = library.compose(source, &definitions) {
                panic!("{definitions:?}: {error}");
            }
        }
    }
}
