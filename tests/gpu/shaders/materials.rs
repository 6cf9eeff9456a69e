//! Shaders that are composed with the engine's own modules: those of motion lines and of
//! transparent meshes. Those of the toon material are in `toon_shaders`.

use bevy::shader::Shader;
use bevy_comics_testkit::wgsl::Library;

use super::{
    Variant,
    covering::{also, has, pairs, push_if},
    shader,
};
use crate::{prelude::*, toon_shaders::ALWAYS};

/// The crate's modules and the engine's, as an app loads them.
pub fn library() -> Library {
    let mut small = Small::alone(options(size()), Msaa::Off);
    small.headless.step(2);
    let shaders = small.world().resource::<Assets<Shader>>();
    Library::new(shaders.iter().map(|(_, shader)| shader))
}

pub fn variants() -> Vec<Variant> {
    [ink(), transparent()].concat()
}

const PROJECTIONS: &str = "VIEW_PROJECTION_PERSPECTIVE | VIEW_PROJECTION_ORTHOGRAPHIC
    | VIEW_PROJECTION_NONSTANDARD";

/// The ribbons of motion lines, which are in no prepass.
fn ink() -> Vec<Variant> {
    const LISTS: &[&str] = &[
        PROJECTIONS,
        "| MULTISAMPLED",
        "| DEPTH_PREPASS | DEPTH_PREPASS NORMAL_PREPASS MOTION_VECTOR_PREPASS",
        "| TONEMAP_IN_SHADER TONEMAP_METHOD_REINHARD DEBAND_DITHER \
         | TONEMAP_IN_SHADER TONEMAP_METHOD_TONY_MC_MAPFACE",
        "| DISTANCE_FOG",
    ];
    pairs("motion_lines/ink.wgsl", LISTS, in_main_pass)
}

/// Transparent meshes that write depth, with the definitions of the engine's prepass. Materials
/// without bind groups (`BINDLESS`) are known where pixels below an alpha are left out.
fn transparent() -> Vec<Variant> {
    const LISTS: &[&str] = &[
        PROJECTIONS,
        "| NORMAL_PREPASS VERTEX_NORMALS | NORMAL_PREPASS VERTEX_NORMALS VERTEX_TANGENTS",
        "| MOTION_VECTOR_PREPASS",
        "| ALPHA_CUTOFF | ALPHA_CUTOFF BINDLESS",
        "| VERTEX_UVS VERTEX_UVS_A | VERTEX_UVS VERTEX_UVS_B \
         | VERTEX_UVS VERTEX_UVS_A VERTEX_UVS_B STANDARD_MATERIAL_BASE_COLOR_UV_B",
        "| VERTEX_COLORS",
        "| VISIBILITY_RANGE_DITHER",
    ];
    pairs("objects/transparent/transparent.wgsl", LISTS, in_prepass)
}

fn in_main_pass(mut names: Vec<&'static str>) -> Vec<&'static str> {
    names.extend(ALWAYS);
    names.extend(["VERTEX_UVS", "VERTEX_UVS_A"]);
    names
}

fn in_prepass(mut names: Vec<&'static str>) -> Vec<&'static str> {
    const PREPASS: [&str; 6] = [
        "PREPASS_PIPELINE",
        "DEPTH_PREPASS",
        "VERTEX_POSITIONS",
        "VERTEX_OUTPUT_INSTANCE_INDEX",
        "MATERIAL_BIND_GROUP=3",
        "AVAILABLE_STORAGE_BUFFER_BINDINGS=8",
    ];
    names.extend(PREPASS);
    let [normals, motion] = ["NORMAL_PREPASS", "MOTION_VECTOR_PREPASS"].map(|n| has(&names, n));
    push_if(normals, &mut names, "NORMAL_PREPASS_OR_DEFERRED_PREPASS");
    push_if(
        motion,
        &mut names,
        "MOTION_VECTOR_PREPASS_OR_DEFERRED_PREPASS",
    );
    push_if(normals || motion, &mut names, "PREPASS_FRAGMENT");
    also(&mut names, &["ALPHA_CUTOFF"], "MAY_DISCARD");
    names
}

#[test]
fn every_shader_among_the_engines_composes_and_validates() {
    let mut library = library();
    for (file, definitions) in variants() {
        let source = shader(file);
        // Only native devices have arrays of bindings.
        let composed = if definitions.contains(&("BINDLESS", None)) {
            library.check(&source, &definitions)
        } else {
            library.compose(&source, &definitions)
        };
        if let Err(error) = composed {
            panic!("{file}, {definitions:?}: {error}");
        }
    }
}
