//! Sessions with the inspector, driven through keyboard and mouse.
//!
//! A session runs in a window that is never shown, and a long test runs it in a real one.

mod hidden;
mod layer_borders;
mod picking;
pub mod session;
mod toolkit;

use std::fs;

use self::{
    hidden::{Drawn, HiddenWindow, Shown},
    session::Session,
};
use image::RgbImage;
use serde_json::Value;

use crate::{
    prelude::*,
    window::{START, Window, changed},
};

/// Size of the window in pixels: 820 x 600 logical pixels. Small, because a CPU may
/// draw it: what takes longest is the scene.
const WIDTH: u32 = 451;
const HEIGHT: u32 = 330;
const SCALE: f64 = 0.55;
/// Width of the picture left of the panel in pixels.
const PICTURE: u32 = 182;
/// Arguments with which nothing is drawn under the panel. The width is `PICTURE`.
const DRAWN: [&str; 2] = ["--viewport", "182"];

/// The teapot, in the style that real windows start with.
fn teapot(cameras: u32, drawn: Drawn) -> Shown {
    Shown {
        scene: BuiltIn::Teapot,
        style: ComicStyle::from_ron(START).expect("it reads"),
        cameras,
        drawn,
    }
}

/// A hidden window like the real one.
fn hidden() -> HiddenWindow {
    let shown = teapot(1, Drawn::Window(PICTURE));
    HiddenWindow::open([WIDTH, HEIGHT], SCALE, &shown)
}

/// The picture left of the panel.
fn picture(window: &impl Session) -> RgbImage {
    let picture = window.picture();
    let height = picture.height();
    image::imageops::crop_imm(&picture, 0, 0, PICTURE, height).to_image()
}

/// The contours of a style, the default ones where it has none.
fn contours(style: &ComicStyle) -> Contours {
    style.get().copied().unwrap_or_default()
}

fn width(window: &impl Session) -> f32 {
    contours(&window.style(0)).width
}

fn until_width(window: &impl Session, wanted: f32) {
    window.until_style("the width", 0, |style| {
        style.get::<Contours>().is_some_and(|c| c.width == wanted)
    });
}

fn open(window: &impl Session) {
    window.key("F10");
    window.until("the panel", |state| {
        state["open"] == true
            && state["panel_cameras"] == 1
            && state["widgets"]["tab.Style"].is_array()
    });
}

/// A whole session: open, change, undo, search, save, edit the file by another
/// program, break it, repair it, compare, take a screenshot, close.
#[ignore = "long: a real window"]
#[test]
fn a_style_is_tuned_in_a_window() {
    let window = Window::open([WIDTH, HEIGHT], SCALE, &DRAWN);
    assert_closed(&window.state());
    open(&window);
    tune(&window);
    turn_effects_off_and_on(&window);
    search(&window);
    copy_as_rust(&window);
    save_and_watch(&window);
    compare(&window);
    compare_views(&window);
    photograph(&window);
    close(&window);
}

#[test]
fn a_style_is_tuned() {
    let window = hidden();
    assert_closed(&window.state());
    open(&window);
    tune(&window);
    close(&window);
}

/// The width of the panel is the user's alone: no page changes it.
#[test]
fn pages_keep_the_width_of_the_panel() {
    let window = hidden();
    open(&window);
    let side = |i: usize| {
        window.state()["widgets"]["panel"][i]
            .as_f64()
            .expect("a side")
    };
    let width = || side(2) - side(0);
    let rests = |page: &str| {
        let chosen = width();
        window.click(&format!("tab.{page}"));
        for frame in 0..2 {
            window.frames(1);
            assert_eq!(width(), chosen, "{page}, frame {frame}");
        }
    };
    // The thumbnails of Presets are drawn from then on, so that frames take long.
    for page in [
        "Style", "Object", "Files", "Views", "Cost", "Photo", "Presets",
    ] {
        rests(page);
    }
}

#[test]
fn effects_are_turned_off_and_on() {
    let window = hidden();
    open(&window);
    widen(&window);
    turn_effects_off_and_on(&window);
}

#[test]
fn settings_are_searched() {
    let window = hidden();
    open(&window);
    widen(&window);
    search(&window);
}

#[test]
fn a_style_file_is_saved_and_watched() {
    let window = hidden();
    open(&window);
    widen(&window);
    save_and_watch(&window);
}

#[test]
fn a_style_is_compared_with_the_original() {
    let window = hidden();
    open(&window);
    compare(&window);
}

#[test]
fn debug_views_and_times_are_shown() {
    let window = hidden();
    open(&window);
    compare_views(&window);
    close(&window);
}

fn assert_closed(state: &Value) {
    assert_eq!(state["open"], false);
    assert_eq!(state["panel_cameras"], 0, "a closed panel has no camera");
    assert_eq!(state["widgets"].as_object().map(|w| w.len()), Some(0));
}

/// Makes the contours wider, and returns their width.
fn widen(window: &impl Session) -> f32 {
    window.click("contours.open");
    window.drag("contours.width", 0.1, 0.75);
    let wide = width(window);
    assert!(wide > 6.0 && wide <= 16.0, "the slider moved: {wide}");
    wide
}

/// Changes a setting, and takes it back and again.
fn tune(window: &impl Session) {
    let start = window.style(0);
    let before = picture(window);

    // Change a slider, see the picture change.
    let wide = widen(window);
    let after = picture(window);
    let ink = changed(&before, &after);
    assert!(ink > 200, "the lines are wider: {ink} pixels");

    // Undo and redo by key: a drag is one step.
    window.chord(&["ctrl"], "z");
    until_width(window, contours(&start).width);
    let back = picture(window);
    let left = changed(&before, &back);
    assert!(
        left < ink / 20,
        "the picture is back but for {left} of {ink} pixels"
    );
    window.chord(&["ctrl", "shift"], "z");
    until_width(window, wide);
    window.click("undo");
    until_width(window, contours(&start).width);
    window.click("redo");
    until_width(window, wide);

    // A field goes back to its default.
    window.click("contours.width.reset");
    until_width(window, Contours::default().width);
    window.chord(&["ctrl"], "z");
    until_width(window, wide);
}

fn turn_effects_off_and_on(window: &impl Session) {
    // An effect is added and taken away.
    let before = width(window);
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
    until_width(window, before);
    window.click("undo");
    window.until_style("no contours", 0, |style| !has_contours(style));
    window.click("redo");
    until_width(window, before);
}

/// Searches for a setting.
fn search(window: &impl Session) {
    let before = width(window);
    window.chord(&["ctrl"], "f");
    window.until("the field", |state| state["focused"] == "search");
    window.type_text("jitter");
    window.until("the sketch alone", |state| {
        state["widgets"]["sketch.jitter"].is_array() && state["widgets"]["contours"].is_null()
    });
    // The shortcuts belong to the field while it has the focus.
    window.chord(&["ctrl"], "z");
    assert_eq!(width(window), before);
    window.key("Escape");
    window.until_there("contours");
    // The clear button.
    window.click("search");
    window.type_text("jitter");
    window.until("the sketch alone", |state| {
        state["widgets"]["contours"].is_null()
    });
    window.click("search.clear");
    window.until_there("contours");
}

/// The style as Rust code is not a style file.
fn copy_as_rust(window: &impl Session) {
    let before = width(window);
    window.click("copy_rust");
    window.until_there("message");
    window.click("paste");
    assert_eq!(width(window), before);
}

/// Saves under a name, reads it back, and lets another program edit the file.
fn save_and_watch(window: &impl Session) {
    let before = picture(window);
    window.click("tab.Files");
    window.click("files.name");
    window.type_text("mine");
    window.frames(2);
    window.click("files.save_as");
    let path = window.folder().join("styles").join("mine.comic.ron");
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
    until_width(window, 1.25);
    let thin = picture(window);
    assert!(
        changed(&before, &thin) > 200,
        "a file that is edited is seen at once"
    );

    // Break the file: the last valid style stays, the panel shows the error.
    fs::write(&path, "(version: 3,\n    contours: (widht: 3.0))").expect("written");
    window.until_there("files.error");
    assert_eq!(width(window), 1.25);
    assert!(changed(&thin, &picture(window)) < 50, "the picture stays");
    // Repair it.
    fs::write(&path, edit(5.0).to_ron().expect("text")).expect("written");
    until_width(window, 5.0);
    window.until("no error", |state| {
        state["widgets"]["files.error"].is_null()
    });
    // A change from the file can be undone.
    window.click("undo");
    until_width(window, 1.25);
    window.click("files.load");
    until_width(window, 5.0);
}

/// The original beside the style, then in its place.
fn compare(window: &impl Session) {
    window.click("compare.split");
    window.until("the split", |state| state["cameras"][0]["split"] == 0.5);
    window.click("compare.split");
    window.until("no split", |state| state["cameras"][0]["split"].is_null());
    let inked = picture(window);
    window.point("compare.original", 0.5);
    window.hold(true);
    window.until("the original", |state| state["cameras"][0]["weight"] == 0.0);
    assert!(changed(&inked, &picture(window)) > 200);
    window.hold(false);
    window.until("the style", |state| state["cameras"][0]["weight"].is_null());
}

/// A debug view and the measurements.
fn compare_views(window: &impl Session) {
    window.click("tab.Views");
    window.click("view.DepthMap");
    until_map(window);
    let map = picture(window);
    assert!(
        map.pixels().all(|p| p[0] == p[1] && p[1] == p[2]),
        "the map is gray"
    );
    window.until_there("histogram");
    window.click("view.none");
    window.click("tab.Cost");
    window.until_there("times");
}

/// A screenshot, twice as large as the window.
fn photograph(window: &impl Session) {
    let photo = take_photo(window);
    let shades: HashSet<_> = photo.pixels().collect();
    assert!(shades.len() > 200, "the photograph shows the scene");
}

fn take_photo(window: &impl Session) -> RgbImage {
    window.click("tab.Photo");
    window.click("photo.take");
    window.until_there("photo.saved");
    let photos: Vec<_> = fs::read_dir(window.folder().join("pictures"))
        .expect("a folder of pictures")
        .flatten()
        .collect();
    assert_eq!(photos.len(), 1);
    let photo = image::open(photos[0].path()).expect("a picture").to_rgb8();
    let [width, height] = window.size();
    assert_eq!(photo.dimensions(), (2 * width, 2 * height));
    photo
}

/// Closes the panel, which leaves nothing behind.
fn close(window: &impl Session) {
    window.key("F10");
    let state = window.until("the end", |state| state["panel_cameras"] == 0);
    assert_eq!(state["widgets"].as_object().map(|w| w.len()), Some(0));
    assert!(state["cameras"][0]["view"].is_null());
}

/// Presses Tab until a widget has the focus.
fn tab_to(window: &impl Session, widget: &str) {
    const LIMIT: usize = 90;
    let mut passed = Vec::new();
    for _ in 0..LIMIT {
        window.press_key("Tab");
        window.seen();
        let focused = window.state()["focused"].as_str().unwrap_or("-").to_owned();
        if focused == widget {
            // It is scrolled into view.
            window.frames(2);
            let rect = &window.state()["widgets"][widget];
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
    let window = hidden();
    open(&window);
    tune_by_keys(&window);
}

#[test]
fn the_keyboard_alone_reaches_other_effects_and_pages() {
    let window = hidden();
    open(&window);
    leaf_by_keys(&window);
    close(&window);
}

#[ignore = "long: a real window"]
#[test]
fn the_keyboard_alone_tunes_a_style_in_a_window() {
    let window = Window::open([WIDTH, HEIGHT], SCALE, &DRAWN);
    open(&window);
    tune_by_keys(&window);
    leaf_by_keys(&window);
    close(&window);
}

fn until_map(window: &impl Session) {
    window.until("the map", |state| state["cameras"][0]["view"] == "DepthMap");
}

fn tune_by_keys(window: &impl Session) {
    let start = width(window);

    // Keys unfold the effect and move its slider.
    tab_to(window, "contours.open");
    window.key("space");
    window.until_there("contours.width");
    tab_to(window, "contours.width");
    for _ in 0..3 {
        window.key("Right");
    }
    window.until_style("wider lines", 0, |style| {
        style.get::<Contours>().is_some_and(|c| c.width > start)
    });
    window.chord(&["ctrl"], "z");
    window.chord(&["ctrl"], "z");
    window.chord(&["ctrl"], "z");
    until_width(window, start);
}

fn leaf_by_keys(window: &impl Session) {
    // An effect further down: the panel scrolls to it.
    tab_to(window, "sketch");
    window.key("space");
    window.until_style("the sketch", 0, |style| style.get::<Sketch>().is_some());

    // Another page.
    tab_to(window, "tab.Views");
    window.key("space");
    window.until_there("view.DepthMap");
    tab_to(window, "view.DepthMap");
    window.key("space");
    until_map(window);
}

/// Two cameras in a window with scale factor 1.2.
fn two_cameras() -> HiddenWindow {
    let window = HiddenWindow::open([984, 672], 1.2, &teapot(2, Drawn::Window(984)));
    open(&window);
    window
}

#[test]
fn two_cameras_have_styles_of_their_own() {
    style_two_cameras(&two_cameras());
}

/// The only test with a hidden window that copies: the clipboard may be that of the system.
#[test]
fn the_clipboard_copies_styles() {
    let window = two_cameras();
    copy_between_cameras(&window);
    copy_as_rust(&window);
}

#[test]
fn the_panel_is_docked_elsewhere() {
    dock(&two_cameras());
}

/// The photograph shows both cameras.
#[test]
fn two_cameras_are_photographed() {
    let shown = teapot(2, Drawn::Window(200));
    let window = HiddenWindow::open([200, 140], 0.25, &shown);
    open(&window);
    photograph_both(&window, 200);
}

#[ignore = "long: a real window"]
#[test]
fn two_cameras_have_styles_of_their_own_in_a_window() {
    let arguments = ["--cameras", "2", "--viewport", "160"];
    let window = Window::open([492, 336], 0.6, &arguments);
    open(&window);
    style_two_cameras(&window);
    copy_between_cameras(&window);
    dock(&window);
    window.picture();
    photograph_both(&window, 160);
}

fn assert_in_the_window(window: &impl Session) {
    let [wide, high] = window.points();
    let state = window.state();
    let widgets = state["widgets"].as_object().expect("widgets");
    assert!(widgets.len() > 10, "{} widgets", widgets.len());
    for (name, rect) in widgets {
        let side = |i: usize| rect[i].as_f64().expect("a number");
        // Widgets that are scrolled out of view lie below.
        assert!(
            side(0) >= 0.0 && side(2) <= wide && side(1) >= 0.0,
            "{name} at {rect} in {wide} x {high}"
        );
    }
}

fn choose(window: &impl Session, camera: &str) {
    window.click("camera");
    window.click(&format!("camera.{camera}"));
}

fn style_two_cameras(window: &impl Session) {
    // Changes go to the chosen camera.
    let first = window.style(0);
    choose(window, "Second camera");
    window.click("colorization");
    window.until_style("an atmosphere", 1, |style| {
        style.get::<Colorization>().is_some()
    });
    assert_eq!(window.style(0), first);
    window.click("compare.split");
    let state = window.until("the split", |state| state["cameras"][1]["split"] == 0.5);
    assert!(state["cameras"][0]["split"].is_null());
    // Every camera has its own undo history.
    choose(window, "Main camera");
    window.chord(&["ctrl"], "z");
    window.frames(3);
    assert!(window.style(1).get::<Colorization>().is_some());
}

/// Copies the style of the second camera to the first one.
fn copy_between_cameras(window: &impl Session) {
    choose(window, "Second camera");
    if window.style(1).get::<Colorization>().is_none() {
        window.click("colorization");
    }
    window.click("copy");
    choose(window, "Main camera");
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
}

fn dock(window: &impl Session) {
    assert_in_the_window(window);
    let [wide, _] = window.points();
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
    assert_in_the_window(window);
}

/// Both cameras are in the photograph, whose left half begins at 0 and whose right half at `right`.
fn photograph_both(window: &impl Session, right: u32) {
    let photo = take_photo(window);
    for half in [0, right] {
        let half = image::imageops::crop_imm(&photo, half, 0, right, photo.height()).to_image();
        let shades: HashSet<_> = half.pixels().collect();
        assert!(shades.len() > 100, "a half has {} shades", shades.len());
    }
}
