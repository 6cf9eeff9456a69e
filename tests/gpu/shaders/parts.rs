//! The passes of a plan that is divided, and the parts of its last pass, see `Part` of the crate.

use super::{
    Definitions,
    covering::{Choice, covering, definitions, has},
    effects, flags,
    fused::of_pass,
    optional,
};

pub fn variants() -> Vec<Definitions> {
    [divided(), left_out(), overlays(), bases()].concat()
}

/// The definitions of boxes that reach so many pixels.
fn reaches(pixels: usize) -> Definitions {
    let steps = [
        "REACHES_ONE",
        "REACHES_TWO",
        "REACHES_THREE",
        "REACHES_FOUR",
        "REACHES_FIVE",
        "REACHES_SIX",
    ];
    [flags(&["BOX_REACH"]), flags(&steps[..pixels])].concat()
}

/// Passes that focus, or draw what that reads.
fn focused() -> Vec<Definitions> {
    let focus = |style, names: &[&'static str]| {
        let style = vec![("FOCUS_STYLE", Some(style))];
        [flags(&["FOCUS", "DEPTH"]), style, flags(names)].concat()
    };
    vec![
        focus(0, &[]),
        focus(0, &["AUX_SCALAR", "MULTISAMPLED"]),
        focus(0, &["DRAWS_NUMBERS", "NUMBERS_FOCUS"]),
        [focus(1, &["AUX_SCALAR"]), vec![("FOCUS_PARALLEL", Some(1))]].concat(),
        focus(3, &[]),
        focus(4, &[]),
        focus(2, &["BOX_STATISTICS", "MULTISAMPLED"]),
        focus(
            2,
            &[
                "DRAWS_BOX_STATISTICS",
                "BOX_STATISTICS_DOWN",
                "BOX_STATISTICS",
                "BOXES_FOCUS",
            ],
        ),
    ]
}

/// Passes that paint, or draw what that reads.
fn painted() -> Vec<Definitions> {
    let boxes = flags(&[
        "PAINT",
        "BOX_STATISTICS",
        "DRAWS_BOX_STATISTICS",
        "BOX_STATISTICS_DOWN",
        "BOXES_PAINT",
    ]);
    vec![
        flags(&["PAINT", "BOX_STATISTICS"]),
        flags(&["PAINT", "BOX_STATISTICS", "PAINT_FIGURES", "MULTISAMPLED"]),
        flags(&["PAINT", "PAINT_ANISOTROPIC", "PAINT_FIGURES"]),
        flags(&[
            "PAINT",
            "DRAWS_BOX_STATISTICS",
            "BOXES_PAINT",
            "MAP",
            "DEPTH",
        ]),
        [
            flags(&["PAINT", "BOX_STATISTICS", "PAINT_WHOLE", "PAINT_FIGURES"]),
            vec![("PAINT_EIGHTH", Some(1))],
        ]
        .concat(),
        [
            flags(&["PAINT", "DRAWS_BOX_STATISTICS", "BOXES_PAINT"]),
            reaches(1),
        ]
        .concat(),
        [boxes.clone(), reaches(6)].concat(),
        boxes,
    ]
}

/// The passes of a plan whose effects read the picture at other places.
fn divided() -> Vec<Definitions> {
    let forms = [
        "CONTINUED",
        "LAYER",
        "INSIDE",
        "FINISH",
        "UNSTYLED_COLORS",
        "UNSTYLED_PRINT",
    ];
    let printed = vec![
        vec![],
        flags(&["MISREGISTRATION"]),
        flags(&["MISREGISTRATION", "MISREGISTRATION_BLACK_STAYS"]),
        flags(&["MISREGISTRATION", "WITHOUT_MISREGISTRATION", "TONE_BANDS"]),
        flags(&["HALFTONE", "HALFTONE_CELLS", "LINES", "OUTLINES"]),
        flags(&[
            "OUTLINES",
            "LINES",
            "LINE_OWNERS",
            "SURFACE_LINES",
            "MISREGISTRATION",
        ]),
    ];
    let all_effects = [printed, painted(), focused()].concat();
    let ids = flags(&["OBJECT_STYLES", "OBJECT_IDS", "UNSTYLED"]);
    let mut all = Vec::new();
    for form in optional(&forms) {
        let with = |effects: &Definitions| of_pass(&[&form, effects, &ids]);
        all.extend(all_effects.iter().map(with));
    }
    all
}

/// An earlier pass has the settings of the effects of later ones, but not these effects.
fn left_out() -> Vec<Definitions> {
    let without = |(name, modes): (&'static str, Vec<Definitions>)| {
        let left: &'static str = format!("WITHOUT_{}", name.to_uppercase()).leak();
        of_pass(&[&modes[0], &[("LAYER", None), (left, None)]])
    };
    effects::all().into_iter().map(without).collect()
}

fn rows(
    lists: &[&[Choice]],
    resolved: fn(Vec<&'static str>) -> Vec<&'static str>,
) -> Vec<Definitions> {
    let found = covering(lists, resolved);
    let of_row = |names: &Vec<&'static str>| of_pass(&[&definitions(names)]);
    found.rows.iter().map(of_row).collect()
}

/// Passes that are blended over the picture: all of their effects draw over it.
fn overlays() -> Vec<Definitions> {
    const LISTS: &[&[Choice]] = &[
        &[
            &["OUTLINES", "LINES"],
            &["CONTOURS"],
            &["OUTLINES", "LINES", "CONTOURS"],
            &["FOCUS"],
            &["FOCUS", "OUTLINES", "LINES", "CONTOURS"],
        ],
        &[
            &["CONTOURS_OPERATOR=0"],
            &["CONTOURS_OPERATOR=1"],
            &["CONTOURS_OPERATOR=2"],
            &["CONTOURS_OPERATOR=3"],
        ],
        &[
            &[],
            &["CONTOURS_WHOLE"],
            &["CONTOURS_WHOLE", "CONTOURS_SINGLE_RING"],
        ],
        &[&[], &["CONTOURS_STEADY"]],
        &[&["FOCUS_PARALLEL=0"], &["FOCUS_PARALLEL=1"]],
        // The styles of lines, and objects that colour effects leave alone.
        &[&[], &["OBJECT_STYLES"], &["OBJECT_STYLES", "OBJECT_IDS"]],
        &[&[], &["INSIDE"]],
        &[&[], &["SAME_SIZE"]],
        &[&[], &["MULTISAMPLED"]],
        &[&[], &["OBLIQUE"]],
        &[&[], &["VISIBLE_RANGE"]],
        &[
            &["MAP_FLAGS=0"],
            &["MAP_FLAGS=1"],
            &["MAP_FLAGS=2"],
            &["MAP_FLAGS=3"],
        ],
    ];
    rows(LISTS, overlay)
}

fn overlay(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let [contours, focus, lines, ids] =
        ["CONTOURS", "FOCUS", "LINES", "OBJECT_IDS"].map(|name| has(&names, name));
    names.retain(|name| match *name {
        "SAME_SIZE" | "MULTISAMPLED" => contours || ids,
        "OBLIQUE" | "VISIBLE_RANGE" => contours,
        "OBJECT_STYLES" => lines || ids,
        _ if name.starts_with("CONTOURS_") || name.starts_with("MAP_FLAGS") => contours,
        _ if name.starts_with("FOCUS_") => focus,
        _ => true,
    });
    names.push("OVERLAY");
    if contours {
        names.extend(["MAP", "DEPTH", "CONTOURS_FAITHFUL=0"]);
    }
    if focus {
        names.push("FOCUS_STYLE=4");
    }
    // Of these effects, the focus alone is one that changes colours.
    if ids && focus {
        names.extend(["UNSTYLED", "UNSTYLED_COLORS"]);
    }
    names
}

/// All pixels, before tiles with all effects: without those effects that change only tiles.
fn bases() -> Vec<Definitions> {
    const LISTS: &[&[Choice]] = &[
        &[
            &["SKETCH"],
            &["SKETCH", "CONTOURS"],
            &["CONTOURS", "TONE_BANDS"],
            &["CONTOURS", "OUTLINES"],
        ],
        // An effect of a game may not know how far it reads lines.
        &[&[], &["WITHOUT_LINES"]],
        &[&[], &["SKETCH_FADES"]],
        &[&[], &["OBJECT_STYLES"]],
        &[
            &[],
            &["LINE_OWNERS"],
            &["LINE_OWNERS", "IN_LAYERS"],
            &["LINE_OWNERS", "IN_LAYERS", "DEPTH_BORDERS"],
        ],
        &[&[], &["CONTINUED"]],
        &[&[], &["FINISH"]],
        &[&[], &["INSIDE"]],
        &[&[], &["SAME_SIZE"]],
        &[&[], &["MULTISAMPLED"]],
        &[&[], &["OBLIQUE"]],
        &[&[], &["VISIBLE_RANGE"]],
        &[&[], &["STORED_SRGB"], &["STORED_OKLAB"]],
    ];
    rows(LISTS, base)
}

fn base(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let [contours, outlines, sketch] =
        ["CONTOURS", "OUTLINES", "SKETCH"].map(|name| has(&names, name));
    let lines = outlines || sketch;
    names.retain(|name| match *name {
        "SKETCH_FADES" => sketch,
        "OBJECT_STYLES" | "LINE_OWNERS" | "IN_LAYERS" | "DEPTH_BORDERS" => lines,
        // Jumps of the depth map are looked for where it has the pixels of the view.
        "MULTISAMPLED" => !contours,
        _ => true,
    });
    if lines {
        names.push("LINES");
    }
    if sketch {
        names.push("LINES_ANYWHERE");
    }
    if outlines {
        names.push("WITHOUT_OUTLINES");
    }
    if contours {
        names.extend(["WITHOUT_CONTOURS", "MAP", "DEPTH", "SAME_SIZE"]);
        names.extend(["CONTOURS_OPERATOR=1", "CONTOURS_FAITHFUL=0"]);
    } else {
        // Without jumps, tiles save nothing but the search for lines.
        names.push("WITHOUT_LINES");
    }
    if has(&names, "TONE_BANDS") {
        names.extend(["LIGHTNESS_CHANGE", "TONE_BANDS_FAITHFUL=0"]);
    }
    if has(&names, "IN_LAYERS") {
        names.extend(["DEPTH_LAYERS", "DEPTH_LAYERS_BANDS=0", "MAP", "DEPTH"]);
    }
    if !has(&names, "DEPTH") {
        names.retain(|name| !matches!(*name, "SAME_SIZE" | "MULTISAMPLED" | "OBLIQUE"));
    }
    if !has(&names, "MAP") {
        names.retain(|name| *name != "VISIBLE_RANGE");
    }
    names
}
