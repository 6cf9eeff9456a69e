//! The inspector's example in a window of a virtual X server, driven by keyboard
//! and mouse events of that server.

use std::{
    cell::Cell,
    env, fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::atomic::{AtomicU32, Ordering},
    thread::sleep,
    time::{Duration, Instant},
};

use bevy_comics::ComicStyle;
use image::RgbImage;
use serde_json::Value;

use crate::command_line::example;

/// Time after which an expected state is given up, also on a slow machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// The running example and its X server.
pub struct Window {
    /// Size in physical pixels.
    pub size: [u32; 2],
    /// Physical pixels per logical pixel.
    scale: f64,
    server: Child,
    app: Child,
    display: String,
    pub folder: PathBuf,
    /// Whether a mouse button is held; the pointer is not moved then.
    pub held: Cell<bool>,
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

/// The style that windows start with.
const START: &str = r##"(
    version: 2,
    name: "Contours",
    depth_map: (mapping: MinMaxLogarithmic),
    desaturation: (amount: 0.35, exponent: 0.5),
    contours: (operator: Sobel, threshold: 0.035, width: 2.0, softness: 0.4, color: "#14141c"),
)"##;

impl Window {
    /// Starts the example in a window of a size in physical pixels, with `scale`
    /// physical pixels per logical pixel.
    pub fn open(size: [u32; 2], scale: f64, arguments: &[&str]) -> Self {
        let program = example("inspector");
        // Every window of a test run has its own server.
        static OPENED: AtomicU32 = AtomicU32::new(0);
        let opened = OPENED.fetch_add(1, Ordering::Relaxed);
        let number = 100 + (16 * std::process::id() + opened) % 20_000;
        let display = format!(":{number}");
        let server = tool("Xvfb")
            .args([
                &display,
                "-screen",
                "0",
                &format!("{}x{}x24", size[0], size[1]),
            ])
            // No key repeat: slow frames would make one press several.
            .arg("-r")
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
        let start = folder.join("start.comic.ron");
        fs::write(&start, START).expect("written");
        let app = Command::new(program)
            .args(["--scene", "teapot", "--style"])
            .arg(&start)
            .args(["--memory", "none"])
            .args(["--size", &format!("{}x{}", size[0], size[1])])
            .args(["--scale", &scale.to_string()])
            .arg("--state")
            .arg(folder.join("state.json"))
            .arg("--styles")
            .arg(folder.join("styles"))
            .arg("--looks")
            .arg(folder.join("looks"))
            .arg("--pictures")
            .arg(folder.join("pictures"))
            .args(arguments)
            .env("DISPLAY", &display)
            .env("WINIT_UNIX_BACKEND", "x11")
            .env_remove("WAYLAND_DISPLAY")
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .stdout(Stdio::null())
            .stderr(fs::File::create(folder.join("log")).expect("a log"))
            .spawn()
            .expect("the example starts");
        let window = Self {
            size,
            scale,
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

    /// The window's size in logical pixels.
    pub fn points(&self) -> [f64; 2] {
        self.size.map(|pixels| f64::from(pixels) / self.scale)
    }

    pub fn xdotool(&self, arguments: &[&str]) {
        let status = tool("xdotool")
            .args(arguments)
            .env("DISPLAY", &self.display)
            .stdout(Stdio::null())
            .status()
            .expect("xdotool runs");
        assert!(status.success(), "xdotool {arguments:?}");
    }

    /// The last lines of the app's log.
    fn log(&self) -> String {
        let log = fs::read_to_string(self.folder.join("log")).unwrap_or_default();
        let lines: Vec<&str> = log.lines().collect();
        lines[lines.len().saturating_sub(12)..].join("\n")
    }

    pub fn state(&self) -> Value {
        let text = fs::read_to_string(self.folder.join("state.json")).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or(Value::Null)
    }

    /// Waits for a state and returns it.
    pub fn until(&self, what: &str, is_so: impl Fn(&Value) -> bool) -> Value {
        let started = Instant::now();
        loop {
            let state = self.state();
            if is_so(&state) {
                return state;
            }
            assert!(
                started.elapsed() < PATIENCE,
                "timed out waiting for {what}: {state}\n{}",
                self.log()
            );
            sleep(Duration::from_millis(15));
        }
    }

    /// Waits for this number of frames.
    pub fn frames(&self, count: u64) {
        let now = self.state()["frame"].as_u64().unwrap_or(0);
        self.until("the next frame", |state| {
            state["frame"].as_u64() >= Some(now + count)
        });
    }

    /// A position in a widget in physical pixels: at a fraction of its width, in the
    /// middle of its height. Waits until the widget does not move.
    fn place(&self, widget: &str, fraction: f64) -> [String; 2] {
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
        let x = side(0) + fraction * (side(2) - side(0));
        let y = 0.5 * (side(1) + side(3));
        [x, y].map(|v| format!("{}", (v * self.scale).round()))
    }

    /// Moves the pointer to a widget.
    pub fn point(&self, widget: &str, fraction: f64) {
        let [x, y] = self.place(widget, fraction);
        self.xdotool(&["mousemove", &x, &y]);
        self.frames(2);
    }

    /// Clicks a widget. The button goes down and up at once, because a long press
    /// is not a click and frames may be slow.
    pub fn click(&self, widget: &str) {
        self.point(widget, 0.5);
        self.xdotool(&["click", "1"]);
        self.frames(3);
    }

    /// Clicks a place of the window, in physical pixels.
    pub fn click_at(&self, [x, y]: [u32; 2]) {
        self.xdotool(&["mousemove", &x.to_string(), &y.to_string()]);
        self.frames(2);
        self.xdotool(&["click", "1"]);
        self.frames(3);
    }

    /// Drags the pointer from one fraction of a widget's width to another.
    pub fn drag(&self, widget: &str, from: f64, to: f64) {
        self.drag_between((widget, from), (widget, to));
    }

    /// Drags the pointer from a fraction of a widget's width to one of another widget.
    pub fn drag_between(&self, from: (&str, f64), to: (&str, f64)) {
        let ends = [from, to].map(|(widget, fraction)| self.place(widget, fraction));
        self.xdotool(&["mousemove", &ends[0][0], &ends[0][1]]);
        self.frames(2);
        self.xdotool(&["mousedown", "1"]);
        self.frames(2);
        self.xdotool(&["mousemove", &ends[1][0], &ends[1][1]]);
        self.frames(2);
        self.xdotool(&["mouseup", "1"]);
        self.frames(3);
    }

    /// Presses a key while others are held. The panel reads held keys once per
    /// frame.
    pub fn chord(&self, held: &[&str], key: &str) {
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

    pub fn key(&self, key: &str) {
        self.xdotool(&["key", "--delay", "120", key]);
        self.frames(3);
    }

    /// The style of a camera.
    pub fn style(&self, camera: usize) -> ComicStyle {
        let state = self.state();
        let text = state["cameras"][camera]["style"].as_str().expect("a style");
        ComicStyle::from_ron(text).expect("it reads")
    }

    /// Waits until a camera's style satisfies `is_so`.
    pub fn until_style(&self, what: &str, camera: usize, is_so: impl Fn(&ComicStyle) -> bool) {
        self.until(what, |state| {
            let text = state["cameras"][camera]["style"]
                .as_str()
                .unwrap_or_default();
            ComicStyle::from_ron(text).is_ok_and(|style| is_so(&style))
        });
    }

    /// A picture of the screen when all pipelines are compiled.
    pub fn picture(&self) -> RgbImage {
        // No tooltip is in the picture.
        if !self.held.get() {
            let [x, y] = self.size.map(|v| (v - 12).to_string());
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
        // The last picture is kept, to look at when a test fails.
        let _ = fs::copy(
            &path,
            Path::new(env!("CARGO_TARGET_TMPDIR")).join("panel.png"),
        );
        image::open(&path).expect("a picture").to_rgb8()
    }
}

/// The number of pixels that differ visibly.
pub fn changed(a: &RgbImage, b: &RgbImage) -> usize {
    let apart = |a: &image::Rgb<u8>, b: &image::Rgb<u8>| (0..3).any(|i| a[i].abs_diff(b[i]) > 6);
    a.pixels()
        .zip(b.pixels())
        .filter(|(a, b)| apart(a, b))
        .count()
}
