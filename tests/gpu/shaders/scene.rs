//! Passes that read depth, normals and objects of the scene.

use super::{
    Variant, check,
    covering::{definitions, each, pairs},
    subsets,
};

pub fn variants() -> Vec<Variant> {
    [depths(), objects()].concat()
}

/// A file with every subset of flags, beside others that are always set.
fn with_subsets(
    file: &'static str,
    always: &[&'static str],
    names: &[&'static str],
) -> Vec<Variant> {
    let of = |chosen: &Vec<&'static str>| (file, definitions(&[always, &chosen[..]].concat()));
    subsets(names).iter().map(of).collect()
}

fn depths() -> Vec<Variant> {
    let view = ["MULTISAMPLED", "OBLIQUE", "HISTOGRAM", "ORTHOGRAPHIC"];
    let range = |shape: &[&'static str]| with_subsets("depth/range.wgsl", shape, &view);
    let first = ["FIRST", "MULTISAMPLED", "OBLIQUE"];
    let tones = [
        "TONES HISTOGRAM",
        "TONES HISTOGRAM BARRIER_FREE STORED_SRGB",
        "TONES HISTOGRAM SUBGROUP STORED_OKLAB",
    ];
    [
        range(&[]),
        range(&["BARRIER_FREE"]),
        range(&["SUBGROUP"]),
        each("depth/range.wgsl", &tones),
        with_subsets("depth/smoothing.wgsl", &[], &["HISTOGRAM"]),
        with_subsets("depth/borders.wgsl", &[], &[]),
        with_subsets("depth/middle.wgsl", &[], &["MULTISAMPLED", "OBLIQUE"]),
        with_subsets("depth/range_of.wgsl", &[], &[]),
        with_subsets("depth/ping_pong.wgsl", &[], &first),
    ]
    .concat()
}

fn objects() -> Vec<Variant> {
    const WIDTHS: &str = "| LINE_WIDTHS | LINE_WIDTHS VERTEX_WIDTHS";
    const DEPTHS: &str = "| TOLERANT | TOLERANT TOLERANT_MULTISAMPLED \
        | TOLERANT TOLERANT_MULTISAMPLED SAMPLE_SHADING";
    let same = |names| names;
    [
        each("objects/depths.wgsl", &["", "VISIBLE_RANGE"]),
        each("objects/depth_test/count.wgsl", &["", "MULTISAMPLED"]),
        each(
            "objects/transparent/copy_normals.wgsl",
            &["", "MULTISAMPLED", "MULTISAMPLED SAMPLE_SHADING"],
        ),
        // `objects/items.rs` builds both.
        pairs("objects/ids.wgsl", &[WIDTHS, DEPTHS], same),
        pairs("objects/sections.wgsl", &[WIDTHS, DEPTHS], same),
    ]
    .concat()
}

#[test]
fn every_shape_of_the_reduction_composes_and_validates() {
    check(&depths());
}

#[test]
fn every_pass_that_reads_objects_composes_and_validates() {
    check(&objects());
}
