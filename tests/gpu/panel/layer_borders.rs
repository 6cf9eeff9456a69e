//! The borders of planes in the histogram of the panel.

use serde_json::Value;

use super::{
    SCALE, WIDTH,
    hidden::{Drawn, HiddenWindow, Shown},
    session::Session,
    tab_to,
};
use crate::prelude::*;

/// The histogram is in the window without scrolling.
const HEIGHT: u32 = 550;

fn planes(style: &ComicStyle) -> DepthLayers {
    style.get().copied().unwrap_or_default()
}

/// The middle of a widget in logical pixels.
fn middle(state: &Value, widget: &str) -> f64 {
    let side = |i: usize| state["widgets"][widget][i].as_f64().unwrap_or(f64::NAN);
    0.5 * (side(0) + side(2))
}

const BORDERS: [&str; 2] = ["border.0", "border.1"];

/// The state once the borders stay where they are: those that are found follow the depths slowly.
fn at_rest(window: &impl Session) -> Value {
    let mut before = window.state();
    for _ in 0..100 {
        window.frames(3);
        let state = window.state();
        let moved = |name: &&str| (middle(&state, name) - middle(&before, name)).abs() > 0.1;
        if !BORDERS.iter().any(moved) {
            return state;
        }
        before = state;
    }
    panic!("the borders do not come to rest: {before:#}");
}

#[test]
#[ignore = "long: every border, dragged and by keys"]
fn borders_of_planes_are_dragged_and_moved_by_keys() {
    let shown = Shown {
        scene: BuiltIn::Village,
        style: ComicStyle::new().with(DepthLayers::default()),
        cameras: 1,
        drawn: Drawn::Picture([64, 36]),
    };
    let window = &HiddenWindow::open([WIDTH, HEIGHT], SCALE, &shown);
    super::open(window);
    window.click("tab.Views");
    window.until("the borders", |state| {
        BORDERS.iter().all(|name| state["widgets"][name].is_array())
    });
    let state = at_rest(window);
    let start = planes(&window.style(0));
    assert_eq!(start.borders, LayerBorders::Auto);
    let first = middle(&state, "border.0");
    assert!(first < middle(&state, "border.1"), "near is before far");

    // A border follows the pointer, and the other stays.
    window.drag_between(("border.1", 0.5), ("histogram", 0.9));
    window.until_style("fixed borders", 0, |style| {
        planes(style).borders == LayerBorders::Fixed
    });
    window.frames(3);
    let state = window.state();
    let side = |i: usize| state["widgets"]["histogram"][i].as_f64().expect("a number");
    let pointer = side(0) + 0.9 * (side(2) - side(0));
    // The pointer is at a whole pixel, and its press may be half a grip beside the line.
    let apart = (middle(&state, "border.1") - pointer).abs();
    assert!(apart < 2.0, "the border is {apart} points from the pointer");
    let apart = (middle(&state, "border.0") - first).abs();
    assert!(apart < 2.0, "the other one has moved by {apart} points");
    let moved = planes(&window.style(0));
    assert!(moved.foreground_end < moved.background_start, "{moved:?}");

    // Keys move it by a hundredth of the depth map.
    tab_to(window, "border.0");
    window.key("Right");
    window.until_style("a border farther away", 0, |style| {
        (planes(style).foreground_end - moved.foreground_end - 0.01).abs() < 1e-4
    });
    assert_eq!(
        planes(&window.style(0)).background_start,
        moved.background_start
    );

    // Both steps can be undone.
    window.click("undo");
    window.click("undo");
    window.until_style("borders that are found", 0, |style| planes(style) == start);
}
