//! The passes that find, complete and draw lines.

use super::{
    Variant, check,
    covering::{Choice, covering, definitions, has, has_any},
    subsets,
};

/// Everything that the tests of this file compose.
pub fn variants() -> Vec<Variant> {
    [finding(), walking(), completing(), settling(), drawing()].concat()
}

fn add(all: &mut Vec<Variant>, file: &'static str, names: &[&'static str]) {
    all.push((file, definitions(names)));
}

/// Rows with every pair, for one file.
fn pairs(
    file: &'static str,
    lists: &[&[Choice]],
    resolved: fn(Vec<&'static str>) -> Vec<&'static str>,
) -> Vec<Variant> {
    let rows = covering(lists, resolved).rows;
    rows.iter().map(|row| (file, definitions(row))).collect()
}

/// What lines are along: the kinds of a view, and last those of marked objects.
const KINDS: &[Choice] = &[
    &["SILHOUETTES"],
    &["CREASES"],
    &["OBJECT_EDGES"],
    &["SILHOUETTES", "CREASES"],
    &["SILHOUETTES", "OBJECT_EDGES"],
    &["CREASES", "OBJECT_EDGES"],
    &["SILHOUETTES", "CREASES", "OBJECT_EDGES"],
    &["CREASES", "LEDGES"],
    &["SILHOUETTES", "CREASES", "OBJECT_EDGES", "LEDGES"],
    &["CREASES", "SECTIONS"],
    &["SILHOUETTES", "CREASES", "OBJECT_EDGES", "SECTIONS"],
    &[
        "SILHOUETTES",
        "CREASES",
        "OBJECT_EDGES",
        "LEDGES",
        "SECTIONS",
    ],
    &["MARKS", "SILHOUETTES", "OBJECT_EDGES"],
    &[
        "MARKS",
        "SILHOUETTES",
        "OBJECT_EDGES",
        "MULTISAMPLED_PICTURE",
    ],
];

/// What cracks are found by in a view, in all combinations: inputs that they need, and `EXCESS`.
fn finding() -> Vec<Variant> {
    let mut all = Vec::new();
    for view in subsets(&["OBLIQUE", "SAME_SIZE", "FADING"]) {
        let mut view = [&["DEPTH"][..], &view[..]].concat();
        if has(&view, "FADING") {
            view.push("VISIBLE_RANGE");
        }
        for kinds in subsets(&["SILHOUETTES", "CREASES", "OBJECT_EDGES", "OBJECT_STYLES"]) {
            let mut defs = [&view[..], &kinds[..]].concat();
            if has(&kinds, "CREASES") {
                defs.push("NORMALS");
            }
            if has_any(&kinds, &["OBJECT_EDGES", "OBJECT_STYLES"]) {
                defs.push("OBJECT_IDS");
            }
            if has_any(&kinds, &["SILHOUETTES", "CREASES"]) {
                defs.push("EXCESS");
            }
            add(&mut all, "lines/find/find.wgsl", &defs);
            let completed = [&defs[..], &["COMPLETED"]].concat();
            let abstracts = [&completed[..], &["ABSTRACT_LINES"]].concat();
            for defs in [&defs, &completed, &abstracts] {
                add(&mut all, "lines/find/cells.wgsl", defs);
            }
            if has(&kinds, "CREASES") {
                let ledges = [&completed[..], &["LEDGES"]].concat();
                add(&mut all, "lines/find/cells.wgsl", &ledges);
            }
        }
        for forms in subsets(&["FAITHFUL_SILHOUETTES", "FAITHFUL_CREASES", "OBJECT_STYLES"]) {
            let mut defs = [&view[..], &forms[..]].concat();
            if has(&forms, "FAITHFUL_CREASES") {
                defs.push("NORMALS");
            }
            if has(&forms, "OBJECT_STYLES") {
                defs.push("OBJECT_IDS");
            }
            add(&mut all, "lines/find/faithful.wgsl", &defs);
        }
    }
    all.extend(found_pairs());
    all
}

/// The same with sections, marks, and objects that are as abstract as a whole. Without compute shaders,
/// lines are not completed.
fn found_pairs() -> Vec<Variant> {
    const LISTS: &[&[Choice]] = &[
        KINDS,
        &[&[], &["OBLIQUE"]],
        &[&[], &["SAME_SIZE"]],
        &[&[], &["FADING"]],
        &[&[], &["VISIBLE_RANGE"]],
        &[&[], &["COMPLETED"]],
        &[&[], &["OBJECT_STYLES"]],
        &[
            &[],
            &["ABSTRACT_LINES"],
            &["ABSTRACT_LINES", "OBJECT_DEPTHS"],
        ],
    ];
    fn by_fragments(mut names: Vec<&'static str>) -> Vec<&'static str> {
        names.retain(|name| !matches!(*name, "COMPLETED" | "LEDGES" | "OBJECT_DEPTHS"));
        found(names)
    }
    fn completed(mut names: Vec<&'static str>) -> Vec<&'static str> {
        if has_any(&names, &["LEDGES", "MARKS"]) {
            names.push("COMPLETED");
        }
        found(names)
    }
    [
        pairs("lines/find/cells.wgsl", LISTS, completed),
        pairs("lines/find/find.wgsl", LISTS, by_fragments),
    ]
    .concat()
}

fn found(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let marks = has(&names, "MARKS");
    let reads_map = has_any(&names, &["FADING", "ABSTRACT_LINES"]);
    names.retain(|name| match *name {
        "FADING" | "ABSTRACT_LINES" | "OBJECT_DEPTHS" => !marks,
        "VISIBLE_RANGE" => reads_map && !marks,
        _ => true,
    });
    if marks {
        names.push("OBJECT_STYLES");
    }
    let ids = ["OBJECT_EDGES", "OBJECT_STYLES", "SECTIONS", "OBJECT_DEPTHS"];
    if has_any(&names, &ids) {
        names.push("OBJECT_IDS");
    }
    if has(&names, "CREASES") {
        names.push("NORMALS");
    }
    if has_any(&names, &["SILHOUETTES", "CREASES"]) {
        names.push("EXCESS");
    }
    names.push("DEPTH");
    names
}

/// The search for blocks with cracks, with jumps of the depth map, or with both.
fn walking() -> Vec<Variant> {
    const LISTS: &[&[Choice]] = &[
        KINDS,
        &[&[], &["OBLIQUE"]],
        &[&[], &["SAME_SIZE"]],
        &[&[], &["BRIDGED"]],
        &[
            &[],
            &["JUMPS", "MAP_FLAGS=0"],
            &["JUMPS", "MAP_FLAGS=1"],
            &["JUMPS", "MAP_FLAGS=2"],
            &["JUMPS", "MAP_FLAGS=3"],
        ],
        &[&[], &["VISIBLE_RANGE"]],
    ];
    let mut all = pairs("lines/find/walk.wgsl", LISTS, walked);
    for flags in ["MAP_FLAGS=0", "MAP_FLAGS=1", "MAP_FLAGS=2", "MAP_FLAGS=3"] {
        for view in subsets(&["OBLIQUE", "SAME_SIZE", "VISIBLE_RANGE"]) {
            let jumps = ["DEPTH", "BOUNDS", "JUMPS", flags];
            let names = [&jumps[..], &view[..]].concat();
            add(&mut all, "lines/find/walk.wgsl", &names);
        }
    }
    all
}

fn walked(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let [marks, jumps] = ["MARKS", "JUMPS"].map(|name| has(&names, name));
    names.retain(|name| match *name {
        "BRIDGED" | "JUMPS" => !marks,
        "VISIBLE_RANGE" => jumps && !marks,
        _ if name.starts_with("MAP_FLAGS") => !marks,
        _ => true,
    });
    if has_any(&names, &["SILHOUETTES", "LEDGES"]) {
        names.push("EXCESS");
    }
    if has(&names, "CREASES") {
        names.push("NORMALS");
    }
    if has_any(&names, &["OBJECT_EDGES", "SECTIONS"]) {
        names.push("OBJECT_IDS");
    }
    names.extend(["DEPTH", "BOUNDS", "CRACKS"]);
    names
}

/// What links, joins, keeps and extends lines.
fn completing() -> Vec<Variant> {
    let mut all = Vec::new();
    let of_columns: [&[&str]; 6] = [
        &[],
        &["BLOCKS"],
        &["BLOCKS", "COMPLETED"],
        &["BLOCKS", "COMPLETED", "SMOOTH"],
        &["BLOCKS", "COMPLETED", "VARIED"],
        &["BLOCKS", "COMPLETED", "SMOOTH", "VARIED"],
    ];
    for defs in of_columns {
        add(&mut all, "lines/draw/columns.wgsl", defs);
    }
    for last in subsets(&["LAST"]) {
        add(&mut all, "lines/link/link.wgsl", &last);
    }
    add(&mut all, "lines/link/join.wgsl", &[]);
    add(&mut all, "lines/link/bridge.wgsl", &[]);
    add(&mut all, "lines/tiles/tiles.wgsl", &[]);
    add(&mut all, "lines/tiles/tile.wgsl", &[]);
    let motions: [&[&str]; 3] = [&[], &["MOTION", "DEPTH"], &["MOTION", "DEPTH", "OBLIQUE"]];
    for motion in motions {
        add(&mut all, "lines/memory/persist.wgsl", motion);
    }
    for varied in subsets(&["VARIED", "BRIDGED"]) {
        let defs = [&["BLOCKS", "SMOOTH"][..], &varied[..]].concat();
        add(&mut all, "lines/draw/ends.wgsl", &defs);
    }
    all
}

/// What leaves out cracks and makes lines smooth, wide and faint.
fn settling() -> Vec<Variant> {
    let mut all = Vec::new();
    let file = "lines/link/settle.wgsl";
    for smooth in [&[][..], &["SMOOTH"], &["SMOOTH", "FOLDS", "DEPTH"]] {
        for weight in [&[][..], &["WEIGHT", "DEPTH", "BUDGET"]] {
            for bridged in subsets(&["BRIDGED", "LEDGES", "RIMS"]) {
                let mut defs = [smooth, weight, &bridged[..]].concat();
                if !weight.is_empty() || has_any(&defs, &["FOLDS", "RIMS"]) {
                    defs.extend(["DEPTH", "EDITS"]);
                }
                add(&mut all, file, &defs);
            }
        }
        let weights: [&[&str]; 10] = [
            &["IN_LAYERS"],
            &["IN_LAYERS", "DEPTH_BORDERS"],
            &["IN_LAYERS", "VISIBLE_RANGE", "DEPTH_BORDERS"],
            &["IN_LAYERS", "VISIBLE_RANGE", "OBJECT_DEPTHS", "OBJECT_IDS"],
            &["ABSTRACT_CREASES", "VISIBLE_RANGE"],
            &["ABSTRACT_CREASES", "OBJECT_DEPTHS", "OBJECT_IDS"],
            &[
                "ABSTRACT_CREASES",
                "IN_LAYERS",
                "OBJECT_DEPTHS",
                "OBJECT_IDS",
            ],
            &["SURFACE_WEIGHT", "WIDTH_MAP"],
            &["SURFACE_WEIGHT", "LIGHT_WEIGHT", "NORMALS"],
            &["SURFACE_WEIGHT", "WIDTH_MAP", "LIGHT_WEIGHT", "NORMALS"],
        ];
        for weight in weights {
            let always = &["WEIGHT", "EDITS", "DEPTH"];
            add(&mut all, file, &[smooth, &always[..], weight].concat());
        }
    }
    all.extend(settled_pairs());
    all
}

/// Every pair of what completing depends on.
fn settled_pairs() -> Vec<Variant> {
    const LISTS: &[&[Choice]] = &[
        &[&[], &["SMOOTH"], &["SMOOTH", "FOLDS"]],
        &[&[], &["OBLIQUE"]],
        &[&[], &["BRIDGED"]],
        &[&[], &["LEDGES"]],
        &[&[], &["RIMS"]],
        &[&[], &["KIND_WEIGHT"], &["KIND_WEIGHT", "OBJECT_IDS"]],
        &[&[], &["LIGHT_WEIGHT"]],
        &[&[], &["WIDTH_MAP"]],
        &[&[], &["PERSPECTIVE_WEIGHT"]],
        &[&[], &["NIB_WEIGHT"]],
        &[&[], &["TAPER_WEIGHT"]],
        &[&[], &["BUDGET"]],
        &[&[], &["FOG"]],
        &[&[], &["IN_FOCUS"]],
        &[
            &[],
            &["IN_LAYERS"],
            &["IN_LAYERS", "DEPTH_BORDERS"],
            &["IN_LAYERS", "OBJECT_DEPTHS"],
        ],
        &[
            &[],
            &["ABSTRACT_CREASES"],
            &["ABSTRACT_CREASES", "OBJECT_DEPTHS"],
        ],
        &[&[], &["VISIBLE_RANGE"]],
    ];
    pairs("lines/link/settle.wgsl", LISTS, settled)
}

fn settled(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let smooth = has(&names, "SMOOTH");
    let on_map = ["PERSPECTIVE_WEIGHT", "IN_LAYERS", "ABSTRACT_CREASES"];
    let reads_map = has_any(&names, &on_map);
    names.retain(|name| match *name {
        "NIB_WEIGHT" => smooth,
        "VISIBLE_RANGE" => reads_map,
        _ => true,
    });
    let surface = has_any(&names, &["LIGHT_WEIGHT", "WIDTH_MAP"]);
    let along = ["KIND_WEIGHT", "NIB_WEIGHT", "TAPER_WEIGHT", "BUDGET"];
    let around = ["FOG", "IN_FOCUS"];
    let weight = surface || reads_map || has_any(&names, &along) || has_any(&names, &around);
    if surface {
        names.push("SURFACE_WEIGHT");
    }
    if has(&names, "LIGHT_WEIGHT") {
        names.push("NORMALS");
    }
    if has(&names, "OBJECT_DEPTHS") {
        names.push("OBJECT_IDS");
    }
    if weight {
        names.push("WEIGHT");
    }
    if weight || has_any(&names, &["FOLDS", "RIMS"]) {
        names.extend(["DEPTH", "EDITS"]);
    } else {
        names.retain(|name| *name != "OBLIQUE");
    }
    names
}

/// What draws ink, reads samples, and remembers.
fn drawing() -> Vec<Variant> {
    let mut all = Vec::new();
    for styles in [&[][..], &["OBJECT_IDS", "OBJECT_STYLES"]] {
        for more in [&[][..], &["SURFACE"], &["SURFACE", "INWARD"]] {
            for line in subsets(&["BOIL", "TAPER", "SPREAD", "STREAKS"]) {
                let defs = [styles, more, &line[..]].concat();
                add(&mut all, "lines/draw/strokes.wgsl", &defs);
            }
        }
        for search in [&[][..], &["NEIGHBOURS"], &["COLUMNS"]] {
            for store in [
                &[][..],
                &["BLOCKS"],
                &["BLOCKS", "COMPLETED"],
                &["BLOCKS", "COMPLETED", "SMOOTH"],
            ] {
                for sheet in subsets(&["SPREAD", "STREAKS"]) {
                    let defs = [styles, search, store, &sheet[..]].concat();
                    add(&mut all, "lines/draw/draw.wgsl", &defs);
                }
                let bridged = &["OWNERS", "BRIDGED", "SURFACE", "INWARD"];
                if !store.is_empty() {
                    let defs = [styles, search, store, &bridged[..]].concat();
                    add(&mut all, "lines/draw/draw.wgsl", &defs);
                }
            }
        }
    }
    for view in subsets(&["OBLIQUE", "NORMALS", "OBJECT_IDS", "WIDTH_MAP"]) {
        let defs = [&["DEPTH", "MULTISAMPLED"][..], &view[..]].concat();
        add(&mut all, "lines/find/resolve.wgsl", &defs);
    }
    for stored in [&[][..], &["STORED_SRGB"], &["STORED_OKLAB"]] {
        let defs = [&["OBJECT_STYLES"][..], stored].concat();
        add(&mut all, "lines/record/marks.wgsl", &defs);
    }
    for view in subsets(&["OBLIQUE"]) {
        let defs = [&["DEPTH"][..], &view[..]].concat();
        add(&mut all, "lines/memory/remember.wgsl", &defs);
    }
    all.extend(drawn_pairs());
    all
}

/// Every pair of what drawing ink depends on.
fn drawn_pairs() -> Vec<Variant> {
    const LISTS: &[&[Choice]] = &[
        &[&[], &["NEIGHBOURS"], &["COLUMNS"]],
        &[
            &[],
            &["BLOCKS"],
            &["BLOCKS", "COMPLETED"],
            &["BLOCKS", "COMPLETED", "SMOOTH"],
        ],
        &[&[], &["VARIED"]],
        &[&[], &["OBJECT_STYLES"]],
        &[&[], &["SURFACE"], &["SURFACE", "INWARD"]],
        &[&[], &["BRIDGED"]],
        &[&[], &["BOIL"]],
        &[&[], &["SPREAD"]],
        &[&[], &["STREAKS"]],
    ];
    pairs("lines/draw/draw.wgsl", LISTS, drawn)
}

fn drawn(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let columns = has(&names, "COLUMNS");
    let owners = has_any(&names, &["OBJECT_STYLES", "SURFACE"]);
    let [blocks, completed] = ["BLOCKS", "COMPLETED"].map(|name| has(&names, name));
    names.retain(|name| match *name {
        // The columns were searched with them.
        "COMPLETED" | "SMOOTH" => !columns,
        "VARIED" => completed && !columns,
        "BRIDGED" => owners && blocks,
        _ => true,
    });
    if has(&names, "OBJECT_STYLES") {
        names.push("OBJECT_IDS");
    }
    if owners {
        names.push("OWNERS");
    }
    names
}

/// Every pair of what finding depends on.
#[test]
#[ignore = "long: hundreds of shaders"]
fn passes_that_find_lines_compose_and_validate() {
    check(&found_pairs());
    check(&walking());
}

#[test]
#[ignore = "long: every combination of what lines are found by"]
fn every_pass_that_finds_lines_composes_and_validates() {
    check(&finding());
}

#[test]
fn every_pass_that_completes_lines_composes_and_validates() {
    check(&completing());
    check(&settling());
}

#[test]
#[ignore = "long: hundreds of shaders"]
fn every_pass_that_draws_lines_composes_and_validates() {
    check(&drawing());
}
