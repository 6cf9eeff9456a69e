//! Counts what the passes that complete cracks load, `link.wgsl` and `settle.wgsl`: see
//! [`line_work`](crate::line_work). The first adds its count to a word of the planes, and the
//! second hands it on; then the second stores its own count in place of each cell's cracks.

use bevy::render::{RenderApp, render_resource::PipelineCache};
use bevy_comics::ComicStyle;

use crate::{
    line_work::{CELLS, LINK, READ_PLANES, SETTLE, draw, edited, edited_teapot, label, numbers},
    studio::Studio,
    work::counting,
};

/// What completing the cracks of a style loads. Pixels are those of the listed cells; a texel,
/// a word of a plane, a density and the two cracks of a pixel count as one load each.
#[derive(Clone, Copy, Debug)]
pub struct LinkWork {
    /// The cells of 4 x 8 pixels that the passes run for.
    pub cells: usize,
    /// Loads per pixel of all passes that continue lines, together.
    pub link: f64,
    /// Loads per pixel of the pass that completes cracks.
    pub settle: f64,
    /// Dispatches of these passes.
    pub dispatches: usize,
}

/// Pixels of a cell.
const CELL: usize = 32;

/// While `link.wgsl` is counted, the loads of all its cells and passes are added up in the first
/// word of the plane by rows, which it does not read: cracks are no longer written there. The
/// upper four bits of the word are the number of passes.
const ADD_COUNT: &str = "
fn add_count(cell: vec2<i32>, group: vec3<u32>, place: u32) {
    let counts_pass = place == 0u && all(group == vec3(0u));
    if cell.x >= 0 {
        let loads = u32(fetched_so_far().x) + select(0u, 1u << 28u, counts_pass);
        atomicAdd(&linked[row_word(line_pass.grid, 0, 0)], loads);
    }
}
";
/// The first bit of the number of passes.
const PASS_SHIFT: u32 = 28;

/// Replaces the cracks of a cell: those of its first pixel by a number, the others by 0.
const FILL_CELL: &str = "
fn fill_cell(cell: vec2<i32>, number: u32) {
    let size = line_pass.grid.rect.zw;
    for (var i = 0; i < 8 * COLUMNS; i++) {
        let p = cell + vec2(i % COLUMNS, i / COLUMNS);
        if all(p < size) {
            crack_words[p.y * size.x + p.x] = vec2(select(0u, number, i == 0), 0u);
        }
    }
}
";

/// The text with one part replaced.
fn swapped(text: &str, part: &str, other: &str) -> String {
    assert_eq!(text.matches(part).count(), 1, "{part:?} has moved");
    text.replace(part, other)
}

/// The text with a statement at the end of its last function, an entry point.
fn ended(text: &str, entry: &str, statement: &str) -> String {
    let body = text.trim_end().strip_suffix('}').expect("a function");
    let last = body.rfind("\nfn ").expect("a function");
    assert!(body[last..].starts_with(entry), "{entry:?} has moved");
    format!("{body}    {statement}\n}}\n")
}

/// Adds a call of the counter before every line for each load from a buffer. A line that
/// begins with the buffer stores to it.
fn tallied(text: &str, buffer: &str, bytes: usize) -> String {
    let call = format!("tally(1.0, {bytes}.0);");
    let mut lines = Vec::new();
    for line in text.lines() {
        let stores = usize::from(line.trim_start().starts_with(buffer));
        let loads = line.matches(buffer).count() - stores;
        lines.extend(std::iter::repeat_n(call.clone(), loads));
        lines.push(line.to_owned());
    }
    lines.join("\n") + "\n"
}

/// The text of a file while one of the passes that complete cracks is counted.
fn completing(counted: &str, path: &str, text: &str) -> String {
    match path {
        READ_PLANES => counting(path, text),
        CELLS if counted == LINK => swapped(text, "if bits != 0u {", "if false {"),
        LINK if counted == LINK => {
            let end = "add_count(cell, group, place);";
            let text = swapped(text, "if rows_south[row] != 0u {", "if false {");
            let idle = "        return;\n    }\n    load_window(g, cell);";
            let text = swapped(&text, idle, &format!("        {end}\n{idle}"));
            counting(path, &(ended(&text, "\nfn link(", end) + ADD_COUNT))
        }
        CELLS | LINK => text.to_owned(),
        SETTLE if counted == LINK => {
            let start = "    if cell.x < 0 {\n        return;\n    }\n";
            let hand_on = "fill_cell(cell, cracks_from(line_pass.grid, vec3(0, 0, 1)));";
            let skip = format!("{start}    {hand_on}\n    if true {{ return; }}\n");
            swapped(text, start, &skip) + FILL_CELL
        }
        SETTLE => {
            let text = tallied(&tallied(text, "crack_words[", 8), "densities[", 4);
            let end = "fill_cell(cell, u32(fetched_so_far().x));";
            counting(path, &(ended(&text, "\nfn settle(", end) + FILL_CELL))
        }
        // The passes after these hand on what they find in place of cracks.
        _ => edited(CELLS, path, text),
    }
}

/// Whether a pass has run.
fn ran(studio: &Studio, name: &str) -> bool {
    let render_world = studio.headless.app.sub_app(RenderApp).world();
    let mut pipelines = render_world.resource::<PipelineCache>().pipelines();
    pipelines.any(|pipeline| label(&pipeline.descriptor) == name)
}

/// Counts what completing the cracks of a style loads, on the teapot at 160 x 90 pixels. It draws
/// it once more if lines are continued, so the work of styles is counted without it.
pub fn count(style: &ComicStyle) -> LinkWork {
    let counted = |file: &str| {
        let mut studio = edited_teapot(|path, text| completing(file, path, text));
        draw(&mut studio, style);
        studio
    };
    let studio = counted(SETTLE);
    // Without this pass, cracks are handed on instead.
    assert!(ran(&studio, "comics_settle_lines"), "nothing is completed");
    let settled = numbers(&studio);
    let linked = if ran(&studio, "comics_link_lines") {
        numbers(&counted(LINK))
    } else {
        vec![]
    };
    let all = linked.iter().copied().max().unwrap_or(0);
    assert!(linked.iter().all(|number| [0, all].contains(number)));
    let cells = settled.iter().filter(|number| **number > 0).count();
    let pixels = (CELL * cells).max(1) as f64;
    let loads: f64 = settled.into_iter().map(f64::from).sum();
    LinkWork {
        cells,
        link: f64::from(all & ((1 << PASS_SHIFT) - 1)) / pixels,
        settle: loads / pixels,
        dispatches: (all >> PASS_SHIFT) as usize + usize::from(cells > 0),
    }
}
