//! What the passes that complete cracks load, counted in their shaders, and how often they
//! run. A cell has 4 x 8 = 32 pixels, and a word of a plane 32 rows of a column.

use bevy::render::render_resource::PipelineCache;
use bevy_comics_testkit::{line_work::label, link_work, work::along_cracks};

use crate::prelude::*;

const CELL: f64 = 32.0;
/// Words that tell a pass of `link.wgsl` whether a cell has anything to continue: found
/// cracks and lines, to the east and south, of its four columns.
const LOOSE: f64 = 4.0 * 4.0;
/// Words around a cell that has: the same four planes in 20 columns, and in two bands each,
/// because the 32 rows of the window begin anywhere.
const WINDOW: f64 = 20.0 * 4.0 * 2.0;
/// Words of `settle.wgsl` for a cell: found cracks and lines, to the east and south, of its
/// four columns.
const SETTLE: f64 = 4.0 * 4.0;
/// More loads with a budget of ink: the densities of 4 x 4 squares.
const NEAR: f64 = 4.0 * 4.0;

/// Edges between objects: each of their cracks is certain, so that none is left to continue a
/// line, and none is left out.
fn objects(hysteresis: f32, budget: f32) -> ComicStyle {
    ComicStyle::new().with(Outlines {
        silhouettes: None,
        creases: None,
        hysteresis,
        min_length: 1,
        smooth: false,
        ink_budget: budget,
        ..default()
    })
}

/// A pass continues lines by eight cracks. Where there is nothing to continue, it loads no
/// window.
#[test]
#[ignore = "long: two apps with counting shaders; `a_budget_loads_its_neighborhood_and_each_crack_once` has one"]
fn cells_without_weak_cracks_load_no_window() {
    let work = link_work::count(&objects(20.0, 1.0));
    assert!(work.cells > 20, "{work:?}");
    let passes = 3.0;
    assert_eq!(work.dispatches, 3 + 1, "{work:?}");
    assert_eq!(work.link, passes * LOOSE / CELL, "{work:?}");
    assert_eq!(work.settle, SETTLE / CELL, "{work:?}");
}

/// Without hysteresis there are no passes that link. With a budget, the cracks of every pixel
/// that has any are loaded, to be weighed: of one pixel at least, and of all at most.
#[test]
fn a_budget_loads_its_neighborhood_and_each_crack_once() {
    let work = link_work::count(&objects(0.0, 0.35));
    assert_eq!(work.dispatches, 1, "{work:?}");
    assert_eq!(work.link, 0.0, "{work:?}");
    let cracks = work.settle - (SETTLE + NEAR) / CELL;
    assert!(cracks > 0.0 && cracks <= 1.0, "{work:?}");
}

/// Default lines: one pass links, and loads windows in some cells, but not in all.
#[test]
#[ignore = "long: two apps with counting shaders; `a_budget_loads_its_neighborhood_and_each_crack_once` has one"]
fn default_lines_load_some_windows() {
    let work = link_work::count(&ComicStyle::new().with(Outlines::default()));
    assert_eq!(work.dispatches, 1 + 1, "{work:?}");
    let [least, most] = [LOOSE, LOOSE + WINDOW].map(|words| words / CELL);
    assert!(work.link > least && work.link < most, "{work:?}");
    assert!(work.settle > (SETTLE + NEAR) / CELL, "{work:?}");
}

/// The kinds of dispatches and draws of the lines in a style, by the names of their pipelines, and
/// those of the styles before it in the same app. Each runs once in a frame, but for
/// `comics_link_lines`, which continues lines by eight cracks.
fn kernels(small: &mut Small, outlines: Outlines) -> BTreeSet<String> {
    small.style(&ComicStyle::new().with(outlines)).settle();
    let cache = small.render_world().resource::<PipelineCache>();
    let labels = cache.pipelines().map(|p| label(&p.descriptor));
    let names = labels.filter_map(|label| label.strip_prefix("comics_"));
    names.map(str::to_owned).collect()
}

/// Lines along cracks that are neither linked nor weighed are not completed.
#[test]
fn outlines_dispatch_no_more_kernels_than_they_need() {
    assert_kernels(&[
        (along_cracks(), ""),
        (wide_along_cracks(), COLUMNS),
        (Outlines::default(), COMPLETING),
    ]);
}

/// No kernels of another style hide those of wide lines and of default ones.
#[test]
#[ignore = "long: two apps; quick test link_work::outlines_dispatch_no_more_kernels_than_they_need"]
fn outlines_in_apps_of_their_own_dispatch_no_more_kernels_than_they_need() {
    assert_kernels(&[(along_cracks(), ""), (wide_along_cracks(), COLUMNS)]);
    assert_kernels(&[(Outlines::default(), COMPLETING)]);
}

const COMPLETING: &str = "link_lines join_lines measure_lines line_corners settle_lines";
const COLUMNS: &str = "line_columns";

fn wide_along_cracks() -> Outlines {
    Outlines {
        width: 16.0,
        ..along_cracks()
    }
}

/// In one new app: each of the styles adds these kernels.
fn assert_kernels(styles: &[(Outlines, &str)]) {
    // `count_ids` runs now and then: whether pixels of the prepass have no id.
    let always = "object_ids count_ids walk list_tiles find_in_cells draw_lines stylize";
    let mut names: BTreeSet<String> = always.split(' ').map(str::to_owned).collect();
    let mut small = Small::alone(options(UVec2::new(96, 64)), Msaa::Off);
    for (outlines, more) in styles {
        names.extend(more.split_terminator(' ').map(str::to_owned));
        assert_eq!(kernels(&mut small, *outlines), names);
    }
}
