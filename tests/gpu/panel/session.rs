//! A session with the inspector: a window, and the mouse and the keyboard in front of it.

use image::RgbImage;
use serde_json::Value;

use crate::prelude::*;

/// A window with the inspector, real or hidden, and what hands do there.
pub trait Session {
    /// Size in physical pixels.
    fn size(&self) -> [u32; 2];

    /// Physical pixels per logical pixel.
    fn scale(&self) -> f64;

    /// The folder of the session, with the folders `styles`, `shadings` and `pictures`.
    fn folder(&self) -> &Path;

    fn state(&self) -> Value;

    /// Waits for a state and returns it.
    fn until(&self, what: &str, is_so: impl Fn(&Value) -> bool) -> Value;

    /// Waits until a widget is there.
    fn until_there(&self, widget: &str) -> Value {
        self.until(widget, |state| state["widgets"][widget].is_array())
    }

    /// Waits for this number of frames.
    fn frames(&self, count: u64);

    /// Waits until a frame has seen the input so far.
    fn seen(&self);

    /// Moves the pointer to a place in physical pixels.
    fn move_to(&self, at: [f64; 2]);

    /// Presses the primary button of the mouse, or releases it.
    fn hold(&self, down: bool);

    /// Presses the button and releases it.
    fn press_and_release(&self);

    /// Presses a key, or releases it. Keys have the names that they have with X.
    fn hold_key(&self, key: &str, down: bool);

    /// Presses a key and releases it.
    fn press_key(&self, key: &str);

    /// Types a text of small letters.
    fn type_text(&self, text: &str);

    /// A picture when all pipelines are compiled: of the window, or of what the cameras draw.
    fn picture(&self) -> RgbImage;

    /// The window's size in logical pixels.
    fn points(&self) -> [f64; 2] {
        self.size().map(|pixels| f64::from(pixels) / self.scale())
    }

    /// A position in a widget in physical pixels: at a fraction of its width, in the
    /// middle of its height. Waits until the widget does not move.
    fn place(&self, widget: &str, fraction: f64) -> [f64; 2] {
        let mut state = self.until_there(widget);
        loop {
            self.seen();
            let now = self.until_there(widget);
            let rests = now["widgets"][widget] == state["widgets"][widget];
            state = now;
            if rests && state["cameras"][0]["compiling"] == false {
                break;
            }
        }
        let side = |i: usize| state["widgets"][widget][i].as_f64().expect("a number");
        let x = side(0) + fraction * (side(2) - side(0));
        let y = 0.5 * (side(1) + side(3));
        [x, y].map(|v| v * self.scale())
    }

    /// Moves the pointer to a widget.
    fn point(&self, widget: &str, fraction: f64) {
        let at = self.place(widget, fraction);
        self.move_to(at);
        self.seen();
    }

    /// Clicks a widget.
    fn click(&self, widget: &str) {
        let at = self.place(widget, 0.5);
        self.click_at(at);
    }

    /// Clicks a place of the window, in physical pixels.
    fn click_at(&self, at: [f64; 2]) {
        self.move_to(at);
        self.press_and_release();
        self.seen();
        // Layouts follow a frame later.
        self.frames(1);
    }

    /// Drags the pointer from one fraction of a widget's width to another.
    fn drag(&self, widget: &str, from: f64, to: f64) {
        self.drag_between((widget, from), (widget, to));
    }

    /// Drags the pointer from a fraction of a widget's width to one of another widget.
    fn drag_between(&self, from: (&str, f64), to: (&str, f64)) {
        let ends = [from, to].map(|(widget, fraction)| self.place(widget, fraction));
        self.move_to(ends[0]);
        self.seen();
        self.hold(true);
        self.seen();
        self.move_to(ends[1]);
        self.seen();
        self.hold(false);
        self.seen();
        self.frames(1);
    }

    /// Presses a key while others are held. The panel reads held keys once per
    /// frame.
    fn chord(&self, held: &[&str], key: &str) {
        for held in held {
            self.hold_key(held, true);
        }
        self.seen();
        self.hold_key(key, true);
        self.seen();
        self.hold_key(key, false);
        for held in held {
            self.hold_key(held, false);
        }
        self.seen();
        self.frames(1);
    }

    fn key(&self, key: &str) {
        self.press_key(key);
        self.seen();
        self.frames(1);
    }

    /// The style of a camera.
    fn style(&self, camera: usize) -> ComicStyle {
        let state = self.state();
        let text = state["cameras"][camera]["style"].as_str().expect("a style");
        ComicStyle::from_ron(text).expect("it reads")
    }

    /// Waits until a camera's style satisfies `is_so`.
    fn until_style(&self, what: &str, camera: usize, is_so: impl Fn(&ComicStyle) -> bool) {
        self.until(what, |state| {
            let text = state["cameras"][camera]["style"]
                .as_str()
                .unwrap_or_default();
            ComicStyle::from_ron(text).is_ok_and(|style| is_so(&style))
        });
    }
}
