//! Which passes lines run.

use bevy::render::render_resource::PipelineCache;
use bevy_comics_testkit::{line_work::label, work::along_cracks};

use crate::prelude::*;

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
