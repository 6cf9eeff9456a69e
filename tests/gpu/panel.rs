//! The panel in a real window, driven as a person drives it: keys and mouse
//! through the X server.

use std::{
    cell::Cell,
    env, fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use bevy_comics::{ComicStyle, Contours};
use image::RgbImage;
use serde_json::Value;

use crate::command_line::example_with;

/// Of the window; small, because every pixel is drawn by the CPU.
const WIDTH: u32 = 820;
const HEIGHT: u32 = 600;
/// What lies left of the panel, whatever it shows.
const PICTURE: u32 = 330;

/// How long anything may take on a slow machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// The example in a window of its own X server.
struct Window {
    server: Child,
    app: Child,
    display: String,
    folder: PathBuf,
    /// Whether a button is held, so that the pointer stays where it is.
    held: Cell<bool>,
}

impl Drop for Window {
    fn drop(&mut self) {
        for child in [&mut self.app, &mut self.server] {
            let _ = child.kill();
            let _ = child.wait();
        }
        let _ = fs::remove_dir_all(&self.folder);
    }
}

fn tool(name: &str) -> Command {
    let found = env::split_paths(&env::var_os("PATH").unwrap_or_default())
        .any(|folder| folder.join(name).is_file());
    assert!(
        found,
        "{name} is missing; on Debian: apt-get install xvfb xdotool imagemagick"
    );
    Command::new(name)
}

impl Window {
    fn open(arguments: &[&str]) -> Self {
        let program = example_with("inspector", &["--features", "inspector"]);
        let number = 100 + std::process::id() % 20_000;
        let display = format!(":{number}");
        let server = tool("Xvfb")
            .args([&display, "-screen", "0", &format!("{WIDTH}x{HEIGHT}x24")])
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let folder = env::temp_dir().join(format!("bevy-comics-panel-{number}"));
        fs::create_dir_all(folder.join("styles")).expect("a folder");
        let started = Instant::now();
        while !Path::new(&format!("/tmp/.X11-unix/X{number}")).exists() {
            assert!(started.elapsed() < PATIENCE, "the X server does not start");
            sleep(Duration::from_millis(20));
        }
        let app = Command::new(program)
            .args(["--scene", "teapot", "--memory", "none"])
            .args(["--size", &format!("{WIDTH}x{HEIGHT}")])
            .arg("--state")
            .arg(folder.join("state.json"))
            .arg("--styles")
            .arg(folder.join("styles"))
            .arg("--pictures")
            .arg(folder.join("pictures"))
            .args(arguments)
            .env("DISPLAY", &display)
            .env("WINIT_UNIX_BACKEND", "x11")
            .env_remove("WAYLAND_DISPLAY")
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the example starts");
        let window = Self {
            server,
            app,
            display,
            folder,
            held: Cell::new(false),
        };
        window.until("the first picture", |state| {
            !state["cameras"][0]["compiling"].as_bool().unwrap_or(true)
                && state["frame"].as_u64() > Some(8)
        });
        window.xdotool(&["search", "--sync", "--name", "bevy_comics", "windowfocus"]);
        window
    }

    fn xdotool(&self, arguments: &[&str]) {
        let status = tool("xdotool")
            .args(arguments)
            .env("DISPLAY", &self.display)
            .stdout(Stdio::null())
            .status()
            .expect("xdotool runs");
        assert!(status.success(), "xdotool {arguments:?}");
    }

    fn state(&self) -> Value {
        let text = fs::read_to_string(self.folder.join("state.json")).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or(Value::Null)
    }

    /// Waits for a state, and gives it.
    fn until(&self, what: &str, is_so: impl Fn(&Value) -> bool) -> Value {
        let started = Instant::now();
        loop {
            let state = self.state();
            if is_so(&state) {
                return state;
            }
            assert!(
                started.elapsed() < PATIENCE,
                "{what} does not come: {state:#}"
            );
            sleep(Duration::from_millis(15));
        }
    }

    /// Lets frames go by.
    fn frames(&self, count: u64) {
        let now = self.state()["frame"].as_u64().unwrap_or(0);
        self.until("the next frame", |state| {
            state["frame"].as_u64() >= Some(now + count)
        });
    }

    /// A place in a widget: a share of its width, the middle of its height. What
    /// has just come up is let come to rest.
    fn place(&self, widget: &str, share: f64) -> [String; 2] {
        let mut state = self.until(widget, |state| state["widgets"][widget].is_array());
        loop {
            self.frames(3);
            let now = self.until(widget, |state| state["widgets"][widget].is_array());
            let rests = now["widgets"][widget] == state["widgets"][widget];
            state = now;
            if rests && state["cameras"][0]["compiling"] == false {
                break;
            }
        }
        let side = |i: usize| state["widgets"][widget][i].as_f64().expect("a number");
        let x = side(0) + share * (side(2) - side(0));
        let y = 0.5 * (side(1) + side(3));
        [x, y].map(|v| format!("{}", v.round()))
    }

    fn point(&self, widget: &str, share: f64) {
        let [x, y] = self.place(widget, share);
        self.xdotool(&["mousemove", &x, &y]);
        self.frames(2);
    }

    /// Down and up at once: a press of more than 0.8 s is no click, and frames
    /// are slow here.
    fn click(&self, widget: &str) {
        self.point(widget, 0.5);
        self.xdotool(&["click", "1"]);
        self.frames(3);
    }

    fn drag(&self, widget: &str, from: f64, to: f64) {
        let ends = [self.place(widget, from), self.place(widget, to)];
        self.xdotool(&["mousemove", &ends[0][0], &ends[0][1]]);
        self.frames(2);
        self.xdotool(&["mousedown", "1"]);
        self.frames(2);
        self.xdotool(&["mousemove", &ends[1][0], &ends[1][1]]);
        self.frames(2);
        self.xdotool(&["mouseup", "1"]);
        self.frames(3);
    }

    /// A key with others held. The panel reads what is held once a frame.
    fn chord(&self, held: &[&str], key: &str) {
        for held in held {
            self.xdotool(&["keydown", held]);
        }
        self.frames(2);
        self.xdotool(&["keydown", key]);
        self.frames(2);
        self.xdotool(&["keyup", key]);
        for held in held {
            self.xdotool(&["keyup", held]);
        }
        self.frames(3);
    }

    fn key(&self, key: &str) {
        self.xdotool(&["key", "--delay", "120", key]);
        self.frames(3);
    }

    /// The style of the first camera.
    fn style(&self) -> ComicStyle {
        let state = self.state();
        let text = state["cameras"][0]["style"].as_str().expect("a style");
        ComicStyle::from_ron(text).expect("it reads")
    }

    fn width(&self) -> f32 {
        self.style().contours.unwrap_or_default().width
    }

    fn until_width(&self, wanted: f32) {
        self.until("the width", |state| {
            let text = state["cameras"][0]["style"].as_str().unwrap_or_default();
            ComicStyle::from_ron(text)
                .is_ok_and(|style| style.contours.is_some_and(|c| c.width == wanted))
        });
    }

    /// What is on the screen left of the panel, once it is complete.
    fn picture(&self) -> RgbImage {
        // Where no tooltip comes up.
        if !self.held.get() {
            let [x, y] = [WIDTH - 12, HEIGHT - 12].map(|v| v.to_string());
            self.xdotool(&["mousemove", &x, &y]);
        }
        self.until("the pipelines", |state| {
            state["cameras"][0]["compiling"] == false
        });
        self.frames(6);
        let path = self.folder.join("screen.png");
        let status = tool("import")
            .args(["-window", "root"])
            .arg(&path)
            .env("DISPLAY", &self.display)
            .status()
            .expect("import runs");
        assert!(status.success(), "no picture of the screen");
        let whole = image::open(&path).expect("a picture").to_rgb8();
        // The last one is there to be looked at when a test fails.
        let _ = fs::copy(
            &path,
            Path::new(env!("CARGO_TARGET_TMPDIR")).join("panel.png"),
        );
        image::imageops::crop_imm(&whole, 0, 0, PICTURE, HEIGHT).to_image()
    }
}

/// Pixels that are not the same.
fn changed(a: &RgbImage, b: &RgbImage) -> usize {
    let apart = |a: &image::Rgb<u8>, b: &image::Rgb<u8>| (0..3).any(|i| a[i].abs_diff(b[i]) > 6);
    a.pixels()
        .zip(b.pixels())
        .filter(|(a, b)| apart(a, b))
        .count()
}

/// The whole of a session: open, change, undo, save, edit outside, break, mend,
/// compare, photograph, close.
#[test]
fn a_style_is_tuned_in_a_window() {
    let window = Window::open(&[]);
    let state = window.state();
    assert_eq!(state["open"], false);
    assert_eq!(state["panel_cameras"], 0, "a closed panel has no camera");
    assert_eq!(state["widgets"].as_object().map(|w| w.len()), Some(0));
    let start = window.style();

    window.key("F10");
    window.until("the panel", |state| {
        state["open"] == true && state["panel_cameras"] == 1
    });
    let before = window.picture();

    // Change a slider, see the picture change.
    window.click("contours.open");
    window.drag("contours.width", 0.1, 0.75);
    let wide = window.width();
    assert!(wide > 6.0 && wide <= 16.0, "the slider moved: {wide}");
    let after = window.picture();
    let ink = changed(&before, &after);
    assert!(ink > 400, "the lines are wider: {ink} pixels");

    // Undo and redo by key: a drag is one step.
    window.chord(&["ctrl"], "z");
    window.until_width(start.contours.unwrap_or_default().width);
    let back = window.picture();
    let left = changed(&before, &back);
    assert!(
        left < ink / 20,
        "the picture is back but for {left} of {ink} pixels"
    );
    window.chord(&["ctrl", "shift"], "z");
    window.until_width(wide);
    window.click("undo");
    window.until_width(start.contours.unwrap_or_default().width);
    window.click("redo");
    window.until_width(wide);

    // A field goes back to its default.
    window.click("contours.width.reset");
    window.until_width(Contours::default().width);
    window.chord(&["ctrl"], "z");
    window.until_width(wide);

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

    // Save under a name, read it back.
    window.click("tab.Files");
    window.click("files.name");
    window.xdotool(&["type", "--delay", "120", "mine"]);
    window.frames(2);
    window.click("files.save_as");
    let path = window.folder.join("styles").join("mine.comic.ron");
    let saved = ComicStyle::from_ron(&fs::read_to_string(&path).expect("saved")).expect("it reads");
    assert_eq!(saved.contours, window.style().contours);
    assert_eq!(saved.version, ComicStyle::VERSION);

    // Somebody else edits the file.
    let edit = |width: f32| ComicStyle {
        contours: Some(Contours {
            width,
            ..saved.contours.unwrap_or_default()
        }),
        ..saved.clone()
    };
    fs::write(&path, edit(1.25).to_ron().expect("text")).expect("written");
    window.until_width(1.25);
    let thin = window.picture();
    assert!(
        changed(&after, &thin) > 400,
        "a file that is edited is seen at once"
    );

    // Break it: the last good style stays, the panel says where it is broken.
    fs::write(&path, "(version: 1,\n    contours: (widht: 3.0))").expect("written");
    window.until("the error", |state| {
        state["widgets"]["files.error"].is_array()
    });
    assert_eq!(window.width(), 1.25);
    assert!(changed(&thin, &window.picture()) < 50, "the picture stays");
    // Recover.
    fs::write(&path, edit(5.0).to_ron().expect("text")).expect("written");
    window.until_width(5.0);
    window.until("no error", |state| {
        state["widgets"]["files.error"].is_null()
    });
    // What came from the file can be undone like any change.
    window.click("undo");
    window.until_width(1.25);
    window.click("files.load");
    window.until_width(5.0);

    // The original beside the style, and instead of it.
    window.click("compare.split");
    window.until("the split", |state| state["cameras"][0]["split"] == 0.5);
    window.click("compare.split");
    window.until("no split", |state| state["cameras"][0]["split"].is_null());
    let inked = window.picture();
    window.point("compare.original", 0.5);
    window.xdotool(&["mousedown", "1"]);
    window.held.set(true);
    window.until("the original", |state| state["cameras"][0]["weight"] == 0.0);
    assert!(changed(&inked, &window.picture()) > 400);
    window.xdotool(&["mouseup", "1"]);
    window.held.set(false);
    window.until("the style", |state| state["cameras"][0]["weight"].is_null());

    // A debug view, and what is measured.
    window.click("tab.Views");
    window.click("view.DepthMap");
    window.until("the view", |state| {
        state["cameras"][0]["view"] == "DepthMap"
    });
    let map = window.picture();
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

    // A photograph, twice as large as the window.
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

    // Close: nothing of the panel is left.
    window.key("F10");
    let state = window.until("the end", |state| state["panel_cameras"] == 0);
    assert_eq!(state["widgets"].as_object().map(|w| w.len()), Some(0));
    assert!(state["cameras"][0]["view"].is_null());
}
