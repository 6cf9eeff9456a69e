//! The passes that find, complete and draw lines.

use super::{
    Variant, check,
    covering::{also, each, has, has_any, pairs, push_if},
};

pub fn variants() -> Vec<Variant> {
    [finding(), walking(), completing(), settling(), drawing()].concat()
}

/// What lines are along: the kinds of a view, and last those of highlighted objects.
const KINDS: &str = "
    | SILHOUETTES | CREASES | OBJECT_EDGES | SILHOUETTES CREASES | SILHOUETTES OBJECT_EDGES
    | CREASES OBJECT_EDGES | SILHOUETTES CREASES OBJECT_EDGES
    | CREASES BENDS | SILHOUETTES CREASES OBJECT_EDGES SECTIONS LEDGES BENDS
    | CREASES LEDGES | SILHOUETTES CREASES OBJECT_EDGES LEDGES
    | CREASES SECTIONS | SILHOUETTES CREASES OBJECT_EDGES SECTIONS
    | SILHOUETTES CREASES OBJECT_EDGES LEDGES SECTIONS
    | HIGHLIGHTS SILHOUETTES OBJECT_EDGES | HIGHLIGHTS SILHOUETTES OBJECT_EDGES MULTISAMPLED_PICTURE";

/// What cracks are found by. Without compute shaders, lines are not completed.
fn finding() -> Vec<Variant> {
    const LISTS: &[&str] = &[
        KINDS,
        "| OBLIQUE",
        "| SKY_BEYOND",
        "| SAME_SIZE",
        "| FADING",
        "| VISIBLE_RANGE",
        "| COMPLETED",
        "| OBJECT_STYLES",
        "| SIMPLIFIED_LINES | SIMPLIFIED_LINES OBJECT_DEPTHS",
        "| HARD",
    ];
    const FAITHFUL: &[&str] = &[
        "| OBLIQUE",
        "| SAME_SIZE",
        "| FADING VISIBLE_RANGE",
        "| FAITHFUL_SILHOUETTES",
        "| FAITHFUL_CREASES NORMALS",
        "| OBJECT_STYLES",
    ];
    fn by_fragments(mut names: Vec<&'static str>) -> Vec<&'static str> {
        names.retain(|name| !matches!(*name, "COMPLETED" | "LEDGES" | "OBJECT_DEPTHS"));
        found(names)
    }
    fn completed(mut names: Vec<&'static str>) -> Vec<&'static str> {
        also(&mut names, &["LEDGES", "HIGHLIGHTS"], "COMPLETED");
        found(names)
    }
    [
        pairs("lines/find/cells.wgsl", LISTS, completed),
        pairs("lines/find/find.wgsl", LISTS, by_fragments),
        pairs("lines/find/faithful.wgsl", FAITHFUL, found),
    ]
    .concat()
}

fn found(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let highlights = has(&names, "HIGHLIGHTS");
    let reads_map = has_any(&names, &["FADING", "SIMPLIFIED_LINES"]);
    names.retain(|name| match *name {
        "FADING" | "SIMPLIFIED_LINES" | "OBJECT_DEPTHS" => !highlights,
        "VISIBLE_RANGE" => reads_map && !highlights,
        _ => true,
    });
    push_if(highlights, &mut names, "OBJECT_STYLES");
    let ids = ["OBJECT_EDGES", "OBJECT_STYLES", "SECTIONS", "OBJECT_DEPTHS"];
    also(&mut names, &ids, "OBJECT_IDS");
    also(&mut names, &["CREASES"], "NORMALS");
    also(&mut names, &["SILHOUETTES", "CREASES"], "EXCESS");
    names.push("DEPTH");
    names
}

/// The search for blocks with cracks, with jumps of the depth map, or with both.
fn walking() -> Vec<Variant> {
    const LISTS: &[&str] = &[
        KINDS,
        "| OBLIQUE",
        "| SKY_BEYOND",
        "| SAME_SIZE",
        "| CLOSED_GAPS",
        "| JUMPS MAP_FLAGS=0 | JUMPS MAP_FLAGS=1 | JUMPS MAP_FLAGS=2 | JUMPS MAP_FLAGS=3",
        "| VISIBLE_RANGE",
    ];
    pairs("lines/find/walk.wgsl", LISTS, walked)
}

fn walked(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let [highlights, jumps] = ["HIGHLIGHTS", "JUMPS"].map(|name| has(&names, name));
    let lines = has_any(&names, &["SILHOUETTES", "CREASES", "OBJECT_EDGES"]);
    names.retain(|name| match *name {
        "BENDS" => false,
        "CLOSED_GAPS" => lines && !highlights,
        "JUMPS" => !highlights,
        "VISIBLE_RANGE" => jumps && !highlights,
        _ if name.starts_with("MAP_FLAGS") => !highlights,
        _ => true,
    });
    if lines {
        names.push("CRACKS");
    } else if !jumps {
        names.extend(["JUMPS", "MAP_FLAGS=0"]);
    }
    also(&mut names, &["SILHOUETTES", "LEDGES"], "EXCESS");
    also(&mut names, &["CREASES"], "NORMALS");
    also(&mut names, &["OBJECT_EDGES", "SECTIONS"], "OBJECT_IDS");
    names.extend(["DEPTH", "BOUNDS"]);
    names
}

/// What links, joins, keeps and extends lines.
fn completing() -> Vec<Variant> {
    const STORES: &[&str] = &[
        "",
        "BLOCKS",
        "BLOCKS COMPLETED",
        "BLOCKS COMPLETED SMOOTH",
        "BLOCKS COMPLETED VARIED",
        "BLOCKS COMPLETED SMOOTH VARIED",
    ];
    [
        each("lines/draw/columns.wgsl", STORES),
        each("lines/link/link.wgsl", &["", "LAST"]),
        each("lines/link/density.wgsl", &["", "COARSE"]),
        each("lines/link/join.wgsl", &[""]),
        each("lines/link/corners.wgsl", &[""]),
        each("lines/link/close_gaps.wgsl", &[""]),
        each("lines/tiles/tiles.wgsl", &[""]),
        each("lines/tiles/tile.wgsl", &[""]),
        each(
            "lines/history/hold.wgsl",
            &["", "MOTION DEPTH", "MOTION DEPTH OBLIQUE"],
        ),
        pairs(
            "lines/draw/ends.wgsl",
            &["BLOCKS SMOOTH", "| VARIED", "| CLOSED_GAPS"],
            |names| names,
        ),
    ]
    .concat()
}

/// What leaves out cracks and makes lines smooth, wide and faint.
fn settling() -> Vec<Variant> {
    const LISTS: &[&str] = &[
        "| SMOOTH | SMOOTH FOLDS",
        "| OBLIQUE",
        "| CLOSED_GAPS",
        "| LEDGES",
        "| RIMS",
        "| KIND_WEIGHT | KIND_WEIGHT OBJECT_IDS",
        "| LIGHT_WEIGHT",
        "| WIDTH_MAP",
        "| PERSPECTIVE_WEIGHT",
        "| NIB_WEIGHT",
        "| TAPER_WEIGHT",
        "| BUDGET",
        "| EDGE_STYLES | EDGE_STYLES LIT_EDGES | EDGE_STYLES LIT_EDGES HARD",
        "| FOG",
        "| DISTANCE_FADE | DISTANCE_FADE MIDDLE_DEPTH",
        "| IN_LAYERS | IN_LAYERS DEPTH_BORDERS | IN_LAYERS OBJECT_DEPTHS",
        "| SIMPLIFIED_CREASES | SIMPLIFIED_CREASES OBJECT_DEPTHS",
        "| VISIBLE_RANGE",
    ];
    pairs("lines/link/settle.wgsl", LISTS, settled)
}

fn settled(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let smooth = has(&names, "SMOOTH");
    let on_map = ["PERSPECTIVE_WEIGHT", "IN_LAYERS", "SIMPLIFIED_CREASES"];
    let reads_map = has_any(&names, &on_map);
    names.retain(|name| match *name {
        "NIB_WEIGHT" => smooth,
        "VISIBLE_RANGE" => reads_map,
        _ => true,
    });
    let surface = has_any(&names, &["LIGHT_WEIGHT", "WIDTH_MAP"]);
    let along = [
        "KIND_WEIGHT",
        "NIB_WEIGHT",
        "TAPER_WEIGHT",
        "BUDGET",
        "EDGE_STYLES",
    ];
    let around = ["FOG", "DISTANCE_FADE"];
    let weight = surface || reads_map || has_any(&names, &along) || has_any(&names, &around);
    push_if(surface, &mut names, "SURFACE_WEIGHT");
    also(&mut names, &["LIGHT_WEIGHT", "LIT_EDGES"], "NORMALS");
    also(&mut names, &["OBJECT_DEPTHS"], "OBJECT_IDS");
    push_if(weight, &mut names, "WEIGHT");
    if weight || has_any(&names, &["FOLDS", "RIMS"]) {
        names.extend(["DEPTH", "EDITS"]);
    } else {
        names.retain(|name| *name != "OBLIQUE");
    }
    names
}

/// What draws ink, reads samples, and keeps the history.
fn drawing() -> Vec<Variant> {
    const STROKES: &[&str] = &[
        "| OBJECT_STYLES",
        "| SURFACE | SURFACE INWARD | SURFACE EDGE_STYLES",
        "| BOIL",
        "| TAPER_WEIGHT",
        "| INK_BLEED",
        "| STREAKS",
    ];
    const LISTS: &[&str] = &[
        "| NEIGHBORS | COLUMNS | HARD",
        "| BLOCKS | BLOCKS COMPLETED | BLOCKS COMPLETED SMOOTH",
        "| VARIED",
        "| OBJECT_STYLES",
        "| SURFACE | SURFACE INWARD | SURFACE EDGE_STYLES",
        "| CLOSED_GAPS",
        "| BOIL",
        "| INK_BLEED",
        "| STREAKS",
    ];
    const RESOLVED: &[&str] = &[
        "DEPTH MULTISAMPLED",
        "| OBLIQUE",
        "| NORMALS",
        "| OBJECT_IDS | OBJECT_IDS SILHOUETTES",
        "| WIDTH_MAP",
    ];
    const STORED: &str = "| STORED_SRGB | STORED_OKLAB";
    [
        pairs("lines/draw/draw.wgsl", LISTS, drawn),
        pairs("lines/draw/strokes.wgsl", STROKES, with_ids),
        pairs("lines/find/resolve.wgsl", RESOLVED, |names| names),
        pairs(
            "lines/record/highlights.wgsl",
            &["OBJECT_STYLES", STORED],
            |names| names,
        ),
        each("lines/history/accumulate.wgsl", &["DEPTH", "DEPTH OBLIQUE"]),
    ]
    .concat()
}

fn with_ids(mut names: Vec<&'static str>) -> Vec<&'static str> {
    also(&mut names, &["OBJECT_STYLES"], "OBJECT_IDS");
    names
}

fn drawn(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let [columns, hard] = ["COLUMNS", "HARD"].map(|name| has(&names, name));
    let owners = has_any(&names, &["OBJECT_STYLES", "SURFACE"]);
    let [blocks, completed] = ["BLOCKS", "COMPLETED"].map(|name| has(&names, name));
    names.retain(|name| match *name {
        // The columns were searched with them.
        "COMPLETED" => !columns,
        "SMOOTH" => !columns && !hard,
        "VARIED" => completed && !columns,
        "CLOSED_GAPS" => owners && blocks,
        _ => true,
    });
    push_if(owners, &mut names, "OWNERS");
    with_ids(names)
}

#[test]
fn passes_that_find_lines_compose_and_validate() {
    check(&finding());
}

#[test]
fn the_search_for_blocks_composes_and_validates() {
    check(&walking());
}

#[test]
fn passes_that_complete_lines_compose_and_validate() {
    check(&completing());
    check(&settling());
}

#[test]
fn passes_that_draw_lines_compose_and_validate() {
    check(&drawing());
}
