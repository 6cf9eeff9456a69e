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
    let styles = subsets(&[
        "TONE_BANDS",
        "DESATURATION",
        "COLORIZATION",
        "BLACK_FLATS",
        "CONTOURS",
    ]);
    let lines: [&[&str]; 5] = [
        &[],
        &["EDGES"],
        &["EDGES", "FLOOD"],
        &["EDGES", "OBJECT_STYLES"],
        &["EDGES", "FLOOD", "OBJECT_STYLES", "SKETCH"],
    ];
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
            // Lines are read apart from depth: every form of them with some
            // combinations is every combination of what meets in the code.
            for lines in lines.iter().take(if style.len() < 2 { 5 } else { 1 }) {
                let defs: Vec<_> = style.iter().chain(depth).chain(*lines).copied().collect();
                if let Err(error) = module(&source, &defs) {
                    panic!("{defs:?}: {error}");
                }
            }
        }
    }
    module(&source, &["COLORIZATION", "STORED_OKLAB"]).expect("the OKLab store");
    for view in [
        "VIEW_DEPTH_MAP",
        "VIEW_RAW_RANGE",
        "VIEW_SILHOUETTES",
        "VIEW_CREASES",
        "VIEW_OBJECT_IDS",
        "VIEW_TONE_BANDS",
        "VIEW_SATURATION",
        "VIEW_DIFFERENCE",
        "SKETCH_FADES",
    ] {
        for samples in subsets(&["MULTISAMPLED", "OBLIQUE", "FINISH"]) {
            let mut defs = vec![
                view,
                "DEPTH",
                "VISIBLE_RANGE",
                "TONE_BANDS",
                "DESATURATION",
                "EDGES",
                "FLOOD",
                "SKETCH",
            ];
            defs.extend(&samples);
            if view == "VIEW_OBJECT_IDS" {
                defs.push("OBJECT_IDS");
            }
            if let Err(error) = module(&source, &defs) {
                panic!("{defs:?}: {error}");
            }
        }
    }
}

#[test]
fn every_shape_of_the_reduction_composes_and_validates() {
    let source = shader("depth/range.wgsl");
    for shape in [&[][..], &["BARRIER_FREE"], &["SUBGROUP"]] {
        for view in subsets(&["MULTISAMPLED", "OBLIQUE", "HISTOGRAM"]) {
            let defs: Vec<_> = shape.iter().chain(&view).copied().collect();
            module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
        }
    }
    let source = shader("depth/smoothing.wgsl");
    for defs in subsets(&["HISTOGRAM"]) {
        module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
    }
    let source = shader("depth/ping_pong.wgsl");
    for defs in subsets(&["FIRST", "MULTISAMPLED", "OBLIQUE"]) {
        module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
    }
}

#[test]
fn every_kind_of_outline_composes_and_validates() {
    let source = shader("outlining/detect.wgsl");
    for kinds in subsets(&["SILHOUETTES", "CREASES", "OBJECT_EDGES", "OBJECT_STYLES"]) {
        for view in subsets(&["MULTISAMPLED", "OBLIQUE", "FADING"]) {
            let mut defs = vec!["DEPTH"];
            defs.extend(kinds.iter().chain(&view));
            if kinds.contains(&"OBJECT_EDGES") || kinds.contains(&"OBJECT_STYLES") {
                defs.push("OBJECT_IDS");
            }
            if view.contains(&"FADING") {
                defs.push("VISIBLE_RANGE");
            }
            module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
        }
    }
    let source = shader("outlining/flood.wgsl");
    for defs in [&["EDGES", "FIRST"][..], &["FLOOD"]] {
        module(&source, defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
    }
    module(&shader("objects/ids.wgsl"), &[]).expect("the ids");
}
