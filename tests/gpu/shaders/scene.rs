//! Passes that read depth, normals and objects of the scene.

use super::{Variant, check, covering::definitions, subsets};

/// Everything that the tests of this file compose.
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
    [
        range(&[]),
        range(&["BARRIER_FREE"]),
        range(&["SUBGROUP"]),
        with_subsets("depth/smoothing.wgsl", &[], &["HISTOGRAM"]),
        with_subsets("depth/borders.wgsl", &[], &[]),
        with_subsets("depth/ping_pong.wgsl", &[], &first),
    ]
    .concat()
}

fn objects() -> Vec<Variant> {
    let mut all = [
        with_subsets("objects/depths.wgsl", &[], &["VISIBLE_RANGE"]),
        with_subsets("objects/depth_test/count.wgsl", &[], &["MULTISAMPLED"]),
        with_subsets(
            "objects/transparent/copy_normals.wgsl",
            &[],
            &["MULTISAMPLED"],
        ),
        vec![(
            "objects/transparent/copy_normals.wgsl",
            definitions(&["MULTISAMPLED", "SAMPLE_SHADING"]),
        )],
    ]
    .concat();
    for widths in [&[][..], &["LINE_WIDTHS"], &["LINE_WIDTHS", "VERTEX_WIDTHS"]] {
        for depth in [
            &[][..],
            &["TOLERANT"],
            &["TOLERANT", "TOLERANT_MULTISAMPLED"],
            &["TOLERANT", "TOLERANT_MULTISAMPLED", "SAMPLE_SHADING"],
        ] {
            let defs = [widths, depth].concat();
            // `objects/pipeline.rs` builds both.
            for file in ["objects/ids.wgsl", "objects/sections.wgsl"] {
                all.push((file, definitions(&defs)));
            }
        }
    }
    all
}

#[test]
fn every_shape_of_the_reduction_composes_and_validates() {
    check(&depths());
}

#[test]
fn every_pass_that_reads_objects_composes_and_validates() {
    check(&objects());
}
