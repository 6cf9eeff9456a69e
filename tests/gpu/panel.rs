//! Sessions with the inspector, driven through keyboard and mouse.

mod picking;
mod plane_borders;
mod toolkit;

use std::fs;

use bevy_comics::{Colorization, ComicStyle, Contours, Sketch};
use image::RgbImage;
use serde_json::Value;

use crate::window::{Window, changed};

/// Size of the window in pixels: 820 x 600 logical pixels. Small, because a CPU may
/// draw it.
const WIDTH: u32 = 574;
const HEIGHT: u32 = 420;
const SCALE: f64 = 0.7;
/// Width of the picture left of the panel in pixels.
const PICTURE: u32 = 231;
/// Arguments with which nothing is drawn under the panel: frames take half as long. The width is `PICTURE`.
const DRAWN: [&str; 2] = ["--viewport", "231"];

fn picture(window: &Window) -> RgbImage {
    image::imageops::crop_imm(&window.picture(), 0, 0, PICTURE, HEIGHT).to_image()
}

/// The contours of a style, the default ones where it has none.
fn contours(style: &ComicStyle) -> Contours {
    style.get().copied().unwrap_or_default()
}

fn width(window: &Window) -> f32 {
    contours(&window.style(0)).width
}

fn until_width(window: &Window, wanted: f32) {
    window.until_style("the width", 0, |style| {
        style.get::<Contours>().is_some_and(|c| c.width == wanted)
    });
}

/// A whole session: open, change, undo, search, save, edit the file by another
/// program, break it, repair it, compare, take a screenshot, close.
#[test]
fn a_style_is_tuned_in_a_window() {
    let window = Window::open([WIDTH, HEIGHT], SCALE, &[]);
    let state = window.state();
    assert_eq!(state["open"], false);
    assert_eq!(state["panel_cameras"], 0, "a closed panel has no camera");
    assert_eq!(state["widgets"].as_object().map(|w| w.len()), Some(0));
    let start = window.style(0);

    window.key("F10");
    window.until("the panel", |state| {
        state["open"] == true && state["panel_cameras"] == 1
    });
    let before = picture(&window);

    // Change a slider, see the picture change.
    window.click("contours.open");
    window.drag("contours.width", 0.1, 0.75);
    let wide = width(&window);
    assert!(wide > 6.0 && wide <= 16.0, "the slider moved: {wide}");
    let after = picture(&window);
    let ink = changed(&before, &after);
    assert!(ink > 200, "the lines are wider: {ink} pixels");

    // Undo and redo by key: a drag is one step.
    window.chord(&["ctrl"], "z");
    until_width(&window, contours(&start).width);
    let back = picture(&window);
    let left = changed(&before, &back);
    assert!(
        left < ink / 20,
        "the picture is back but for {left} of {ink} pixels"
    );
    window.chord(&["ctrl", "shift"], "z");
    until_width(&window, wide);
    window.click("undo");
    until_width(&window, contours(&start).width);
    window.click("redo");
    until_width(&window, wide);

    // A field goes back to its default.
    window.click("contours.width.reset");
    until_width(&window, Contours::default().width);
    window.chord(&["ctrl"], "z");
    until_width(&window, wide);

    // An effect is added and taken away.
    let has = |state: &Value| {
        let text = state["cameras"][0]["style"].as_str().unwrap_or_default();
        text.contains("colorization:")
    };
    window.click("colorization");
    window.until("the atmosphere", has);
    window.until("its pipeline", |state| {
        state["cameras"][0]["compiling"] == false
    });
    window.click("colorization");
    window.until("the end of the atmosphere", |state| !has(state));

    // An effect that is turned off and on again has its settings back, and
    // undo and redo go through the same styles.
    let has_contours = |style: &ComicStyle| style.get::<Contours>().is_some();
    window.click("contours");
    window.until_style("no contours", 0, |style| !has_contours(style));
    window.click("contours");
    until_width(&window, wide);
    window.click("undo");
    window.until_style("no contours", 0, |style| !has_contours(style));
    window.click("redo");
    until_width(&window, wide);

    search_in(&window, wide);

    // The style as Rust code is not a style file.
    window.click("copy_rust");
    window.until("the message", |state| {
        state["widgets"]["message"].is_array()
    });
    window.click("paste");
    assert_eq!(width(&window), wide);

    // Save under a name, read it back.
    window.click("tab.Files");
    window.click("files.name");
    window.xdotool(&["type", "--delay", "120", "mine"]);
    window.frames(2);
    window.click("files.save_as");
    let path = window.folder.join("styles").join("mine.comic.ron");
    let saved = ComicStyle::from_ron(&fs::read_to_string(&path).expect("saved")).expect("it reads");
    assert_eq!(saved.get::<Contours>(), window.style(0).get::<Contours>());

    // Another program edits the file.
    let edit = |width: f32| {
        saved.clone().with(Contours {
            width,
            ..contours(&saved)
        })
    };
    fs::write(&path, edit(1.25).to_ron().expect("text")).expect("written");
    until_width(&window, 1.25);
    let thin = picture(&window);
    assert!(
        changed(&after, &thin) > 200,
        "a file that is edited is seen at once"
    );

    // Break the file: the last valid style stays, the panel shows the error.
    fs::write(&path, "(version: 2,\n    contours: (widht: 3.0))").expect("written");
    window.until("the error", |state| {
        state["widgets"]["files.error"].is_array()
    });
    assert_eq!(width(&window), 1.25);
    assert!(changed(&thin, &picture(&window)) < 50, "the picture stays");
    // Repair it.
    fs::write(&path, edit(5.0).to_ron().expect("text")).expect("written");
    until_width(&window, 5.0);
    window.until("no error", |state| {
        state["widgets"]["files.error"].is_null()
    });
    // A change from the file can be undone.
    window.click("undo");
    until_width(&window, 1.25);
    window.click("files.load");
    until_width(&window, 5.0);

    // The original beside the style, then in its place.
    window.click("compare.split");
    window.until("the split", |state| state["cameras"][0]["split"] == 0.5);
    window.click("compare.split");
    window.until("no split", |state| state["cameras"][0]["split"].is_null());
    let inked = picture(&window);
    window.point("compare.original", 0.5);
    window.xdotool(&["mousedown", "1"]);
    window.held.set(true);
    window.until("the original", |state| state["cameras"][0]["weight"] == 0.0);
    assert!(changed(&inked, &picture(&window)) > 200);
    window.xdotool(&["mouseup", "1"]);
    window.held.set(false);
    window.until("the style", |state| state["cameras"][0]["weight"].is_null());

    // A debug view and the measurements.
    window.click("tab.Views");
    window.click("view.DepthMap");
    window.until("the view", |state| {
        state["cameras"][0]["view"] == "DepthMap"
    });
    let map = picture(&window);
    assert!(
        map.pixels().all(|p| p[0] == p[1] && p[1] == p[2]),
        "the map is grey"
    );
    window.until("the histogram", |state| {
        state["widgets"]["histogram"].is_array()
    });
    window.click("view.none");
    window.click("tab.Cost");
    window.until("the times", |state| state["widgets"]["times"].is_array());

    // A screenshot, twice as large as the window.
    window.click("tab.Photo");
    window.click("photo.take");
    window.until("the photograph", |state| {
        state["widgets"]["photo.saved"].is_array()
    });
    let photos: Vec<_> = fs::read_dir(window.folder.join("pictures"))
        .expect("a folder of pictures")
        .flatten()
        .collect();
    assert_eq!(photos.len(), 1);
    let photo = image::open(photos[0].path()).expect("a picture").to_rgb8();
    assert_eq!(photo.dimensions(), (2 * WIDTH, 2 * HEIGHT));
    let shades: std::collections::HashSet<_> = photo.pixels().collect();
    assert!(shades.len() > 200, "the photograph shows the scene");

    // Close: the panel leaves nothing behind.
    window.key("F10");
    let state = window.until("the end", |state| state["panel_cameras"] == 0);
    assert_eq!(state["widgets"].as_object().map(|w| w.len()), Some(0));
    assert!(state["cameras"][0]["view"].is_null());
}

/// Searches for a setting in a style with contours of this width.
fn search_in(window: &Window, wide: f32) {
    window.chord(&["ctrl"], "f");
    window.until("the field", |state| state["focused"] == "search");
    window.xdotool(&["type", "--delay", "120", "jitter"]);
    window.until("the sketch alone", |state| {
        state["widgets"]["sketch.jitter"].is_array() && state["widgets"]["contours"].is_null()
    });
    // The shortcuts belong to the field while it has the focus.
    window.chord(&["ctrl"], "z");
    assert_eq!(width(window), wide);
    window.key("Escape");
    window.until("all effects", |state| {
        state["widgets"]["contours"].is_array()
    });
    // The clear button.
    window.click("search");
    window.xdotool(&["type", "--delay", "120", "jitter"]);
    window.until("the sketch alone", |state| {
        state["widgets"]["contours"].is_null()
    });
    window.click("search.clear");
    window.until("all effects", |state| {
        state["widgets"]["contours"].is_array()
    });
}

/// Presses Tab until a widget has the focus.
fn tab_to(window: &Window, widget: &str) {
    const LIMIT: usize = 90;
    let mut passed = Vec::new();
    for _ in 0..LIMIT {
        window.key("Tab");
        let state = window.state();
        let focused = state["focused"].as_str().unwrap_or("-").to_owned();
        if focused == widget {
            // It was scrolled into view.
            let rect = state["widgets"][widget].clone();
            let bottom = rect[3].as_f64().expect("a number");
            assert!(
                bottom <= window.points()[1],
                "{widget} is scrolled to: {rect}"
            );
            return;
        }
        passed.push(focused);
    }
    panic!("{widget} was not reached: {passed:?}");
}

#[test]
fn the_keyboard_alone_tunes_a_style() {
    let window = Window::open([WIDTH, HEIGHT], SCALE, &DRAWN);
    window.key("F10");
    window.until("the panel", |state| {
        state["widgets"]["tab.Style"].is_array()
    });
    let start = width(&window);

    // Keys unfold the effect and move its slider.
    tab_to(&window, "contours.open");
    window.key("space");
    window.until("the settings", |state| {
        state["widgets"]["contours.width"].is_array()
    });
    tab_to(&window, "contours.width");
    for _ in 0..3 {
        window.key("Right");
    }
    window.until_style("wider lines", 0, |style| {
        style.get::<Contours>().is_some_and(|c| c.width > start)
    });
    window.chord(&["ctrl"], "z");
    window.chord(&["ctrl"], "z");
    window.chord(&["ctrl"], "z");
    until_width(&window, start);

    // An effect further down: the panel scrolls to it.
    tab_to(&window, "sketch");
    window.key("space");
    window.until_style("the sketch", 0, |style| style.get::<Sketch>().is_some());

    // Another page, then close.
    tab_to(&window, "tab.Views");
    window.key("space");
    window.until("the views", |state| {
        state["widgets"]["view.DepthMap"].is_array()
    });
    tab_to(&window, "view.DepthMap");
    window.key("space");
    window.until("the map", |state| state["cameras"][0]["view"] == "DepthMap");
    window.key("F10");
    window.until("the end", |state| state["panel_cameras"] == 0);
}

/// Two cameras in a window with scale factor 1.2.
#[test]
fn two_cameras_have_styles_of_their_own() {
    let arguments = ["--cameras", "2", "--viewport", "492"];
    let window = Window::open([984, 672], 1.2, &arguments);
    window.key("F10");
    window.until("the panel", |state| {
        state["widgets"]["tab.Style"].is_array()
    });
    let [wide, high] = window.points();
    let lies_in_the_window = |state: &Value| {
        for (name, rect) in state["widgets"].as_object().expect("widgets") {
            let side = |i: usize| rect[i].as_f64().expect("a number");
            // Widgets that are scrolled out of view lie below.
            assert!(
                side(0) >= 0.0 && side(2) <= wide && side(1) >= 0.0,
                "{name} at {rect} in {wide} x {high}"
            );
        }
    };
    lies_in_the_window(&window.state());

    // Changes go to the chosen camera.
    let first = window.style(0);
    window.click("camera");
    window.click("camera.Second camera");
    window.click("colorization");
    window.until_style("an atmosphere", 1, |style| {
        style.get::<Colorization>().is_some()
    });
    assert_eq!(window.style(0), first);
    window.click("compare.split");
    let state = window.until("the split", |state| state["cameras"][1]["split"] == 0.5);
    assert!(state["cameras"][0]["split"].is_null());
    // Every camera has its own undo history.
    window.click("camera");
    window.click("camera.Main camera");
    window.chord(&["ctrl"], "z");
    window.frames(3);
    assert!(window.style(1).get::<Colorization>().is_some());

    // The clipboard copies a style from one camera to the other.
    window.click("camera");
    window.click("camera.Second camera");
    window.click("copy");
    window.click("camera");
    window.click("camera.Main camera");
    window.click("paste");
    window.until_style("the same atmosphere", 0, |style| {
        style.get::<Colorization>().is_some()
    });
    assert_eq!(
        window.style(0).get::<Colorization>(),
        window.style(1).get::<Colorization>()
    );
    window.chord(&["ctrl"], "z");
    window.until_style("the first style", 0, |style| {
        style.get::<Colorization>().is_none()
    });

    // The panel can be docked elsewhere.
    let left = |state: &Value| state["widgets"]["tab.Style"][0].as_f64();
    assert!(left(&window.state()) > Some(wide / 3.0));
    window.click("dock");
    window.click("dock.Left");
    window.until("the left", |state| left(state) < Some(40.0));
    window.click("dock");
    window.click("dock.Window");
    window.until("a window", |state| {
        state["widgets"]["tab.Style"].is_array() && left(state) != Some(8.0)
    });
    lies_in_the_window(&window.state());
    window.picture();

    // The photograph shows both cameras.
    window.click("tab.Photo");
    window.click("photo.take");
    window.until("the photograph", |state| {
        state["widgets"]["photo.saved"].is_array()
    });
    let photo = fs::read_dir(window.folder.join("pictures"))
        .expect("a folder of pictures")
        .flatten()
        .next()
        .expect("a picture");
    let photo = image::open(photo.path()).expect("a picture").to_rgb8();
    assert_eq!(photo.dimensions(), (2 * 984, 2 * 672));
    for half in [0, 492] {
        let half = image::imageops::crop_imm(&photo, half, 0, 492, 1344).to_image();
        let shades: std::collections::HashSet<_> = half.pixels().collect();
        assert!(shades.len() > 100, "a half has {} shades", shades.len());
    }
}
