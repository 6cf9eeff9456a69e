//! Every entry point in every combination of what may be compiled in.

use std::fs;

use crate::wgsl::{files, module};

fn shader(name: &str) -> String {
    let path = files()
        .into_iter()
        .find(|path| path.ends_with(name))
        .expect("a shader of the crate");
    fs::read_to_string(path).expect("readable")
}

/// Every subset of `choices`.
fn subsets<'a>(choices: &[&'a str]) -> Vec<Vec<&'a str>> {
    (0..1u32 << choices.len())
        .map(|bits| {
            choices
                .iter()
                .enumerate()
                .filter(|(i, _)| bits >> i & 1 == 1)
                .map(|(_, c)| *c)
                .collect()
        })
        .collect()
}

#[test]
fn every_combination_of_styles_composes_and_validates() {
    let source = shader("stylize/stylize.wgsl");
    let styles = subsets(&["DESATURATION", "COLORIZATION", "BLACK_FLATS", "CONTOURS"]);
    let depths: [&[&str]; 5] = [
        &[],
        &["DEPTH"],
        &["DEPTH", "VISIBLE_RANGE"],
        &["DEPTH", "VISIBLE_RANGE", "MULTISAMPLED"],
        &[
            "DEPTH",
            "VISIBLE_RANGE",
            "OBLIQUE",
            "STEEP_FLATS",
            "STORED_SRGB",
        ],
    ];
    for style in &styles {
        for depth in depths {
            if depth.is_empty() && style.contains(&"CONTOURS") {
                continue;
            }
            let defs: Vec<_> = style.iter().chain(depth).copied().collect();
            if let Err(error) = module(&source, &defs) {
                panic!("{defs:?}: {error}");
            }
        }
    }
    module(&source, &["COLORIZATION", "STORED_OKLAB"]).expect("the OKLab store");
}

#[test]
fn every_shape_of_the_reduction_composes_and_validates() {
    let source = shader("depth/range.wgsl");
    for shape in [&[][..], &["BARRIER_FREE"], &["SUBGROUP"]] {
        for view in subsets(&["MULTISAMPLED", "OBLIQUE"]) {
            let defs: Vec<_> = shape.iter().chain(&view).copied().collect();
            module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
        }
    }
    let source = shader("depth/ping_pong.wgsl");
    for defs in subsets(&["FIRST", "MULTISAMPLED", "OBLIQUE"]) {
        module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
    }
}
