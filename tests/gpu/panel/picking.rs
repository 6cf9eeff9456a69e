//! An object is picked in the view, and edited.

use std::fs;

use serde_json::Value;

use super::{
    hidden::{Drawn, HiddenWindow},
    session::Session,
    teapot,
};
use crate::{
    prelude::*,
    window::{Window, changed},
};

/// 1285 x 1000 logical pixels: all that is edited is in the window without scrolling.
const WIDTH: u32 = 514;
const HEIGHT: u32 = 400;
const SCALE: f64 = 0.4;
/// Width of the picture left of the panel.
const PICTURE: u32 = 286;
/// Nothing is drawn under the panel. The width is `PICTURE`.
const DRAWN: [&str; 2] = ["--viewport", "286"];
/// Pixels on the teapot, on its cube and on the sky.
const TEAPOT: [f64; 2] = [143.0, 143.0];
const SKY: [f64; 2] = [34.0, 34.0];

fn picture(window: &impl Session) -> image::RgbImage {
    image::imageops::crop_imm(&window.picture(), 0, 0, PICTURE, HEIGHT).to_image()
}

/// The light of the picked object.
fn light(state: &Value) -> Option<ToonShading> {
    ToonShading::from_ron(state["picked"]["light"].as_str()?).ok()
}

fn pick(window: &impl Session, at: [f64; 2]) {
    window.click("pick");
    window.until("the pick", |state| state["picking"] == true);
    window.click_at(at);
    window.until("the end of the pick", |state| state["picking"] == false);
}

/// Whether the box that the panel draws is around a place in the window.
fn is_around(state: &Value, at: [f64; 2]) -> bool {
    let side = |i: usize| state["widgets"]["object.highlight"][i].as_f64();
    let at = at.map(|v| Some(v / SCALE));
    side(0) < at[0] && at[0] < side(2) && side(1) < at[1] && at[1] < side(3)
}

fn hidden() -> HiddenWindow {
    let window = HiddenWindow::open([WIDTH, HEIGHT], SCALE, &teapot(1, Drawn::Window(PICTURE)));
    super::open(&window);
    window
}

#[test]
fn an_object_is_picked() {
    pick_and_let_go(&hidden());
}

#[test]
fn a_picked_object_is_edited() {
    let window = hidden();
    pick(&window, TEAPOT);
    edit(&window);
}

#[test]
fn the_light_of_a_picked_object_is_saved() {
    let window = hidden();
    pick(&window, TEAPOT);
    window.click("light.convert");
    window.until("the material", |state| light(state).is_some());
    save(&window);
    close(&window);
}

#[ignore = "long: a real window"]
#[test]
fn an_object_is_picked_and_edited_in_a_window() {
    let window = Window::open([WIDTH, HEIGHT], SCALE, &DRAWN);
    super::open(&window);
    let before = picture(&window);
    pick(&window, TEAPOT);
    let marked = changed(&before, &picture(&window));
    assert!((50..20_000).contains(&marked), "the box: {marked} pixels");
    window.key("Escape");
    window.until("nothing", |state| state["picked"].is_null());
    let left = changed(&before, &picture(&window));
    assert!(left < 50, "the box is gone but for {left} pixels");
    pick_and_let_go(&window);
    pick(&window, TEAPOT);
    edit(&window);
    save(&window);
    close(&window);
}

/// How high the picked object is in the world.
fn height(state: &Value) -> Option<f64> {
    state["picked"]["at"][1].as_f64()
}

/// Picks the teapot and the sky, and ends a pick with Escape.
fn pick_and_let_go(window: &impl Session) {
    // Without the button, a click belongs to the game.
    window.click_at(TEAPOT);
    assert!(window.state()["picked"].is_null());

    pick(window, TEAPOT);
    let state = window.state();
    assert_eq!(
        height(&state),
        Some(4.0),
        "the teapot stands on its cube: {state}"
    );
    assert!(is_around(&state, TEAPOT), "{state}");
    assert!(!is_around(&state, SKY));

    // The sky, and Escape.
    pick(window, SKY);
    assert!(window.state()["picked"].is_null());
    pick(window, TEAPOT);
    window.key("Escape");
    window.until("nothing", |state| state["picked"].is_null());
    // Escape ends a pick.
    window.click("pick");
    window.until("the pick", |state| state["picking"] == true);
    window.key("Escape");
    window.until("no pick", |state| state["picking"] == false);
}

/// The box goes with the panel, and the object stays picked.
fn close(window: &impl Session) {
    super::close(window);
    assert_eq!(height(&window.state()), Some(4.0));
}

/// Makes the picked object a toon, gives it a ramp and lines of its own, and takes all of it
/// back and again.
fn edit(window: &impl Session) {
    let plain = picture(window);
    window.click("light.convert");
    window.until("the material", |state| light(state).is_some());
    window.click("light.ramp.on");
    let ramp = |state: &Value| light(state)?.light.ramp;
    let stops = |state: &Value| {
        let stops = ramp(state).map(|ramp| ramp.stops).unwrap_or_default();
        stops.iter().map(|stop| stop.at).collect::<Vec<_>>()
    };
    window.until("a ramp", |state| stops(state) == [0.0, 0.25]);
    let shaded = picture(window);
    let apart = changed(&plain, &shaded);
    assert!(apart > 500, "the teapot has other tones: {apart} pixels");
    window.click("light.ramp.stops.add");
    window.until("a stop", |state| stops(state) == [0.0, 0.25, 0.625]);
    window.drag("light.ramp.stops.2.at", 0.32, 0.05);
    window.until(
        "the stop on the left",
        |state| matches!(stops(state)[..], [0.0, 0.25, moved] if moved < 0.2),
    );
    window.click("outline_style");
    window.until("lines of its own", |state| {
        state["picked"]["has_style"] == true
    });

    // One history for all of it.
    for _ in 0..5 {
        window.chord(&["ctrl"], "z");
    }
    window.until("the standard material", |state| {
        state["picked"]["is_standard"] == true
    });
    assert!(changed(&plain, &picture(window)) < 50, "as before");
    for _ in 0..5 {
        window.chord(&["ctrl", "shift"], "z");
    }
    window.until("all of it again", |state| {
        stops(state).len() == 3 && state["picked"]["has_style"] == true
    });
}

/// Saves the light as a shading.
fn save(window: &impl Session) {
    window.click("shading.name");
    window.type_text("glaze");
    window.frames(2);
    window.click("shading.save");
    window.until_there("shading.saved");
    let path = window.folder().join("shadings").join("glaze.toon.ron");
    let text = fs::read_to_string(path).expect("saved");
    let saved = ToonShading::from_ron(&text).expect("it reads");
    let now = light(&window.state()).expect("a light");
    assert_eq!(saved.light, now.light.sanitized());
}
