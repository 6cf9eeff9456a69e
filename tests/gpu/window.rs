//! The inspector's example in a window of a virtual X server, driven by keyboard
//! and mouse events of that server.

use std::{
    cell::Cell,
    env, fs,
    process::{Child, Stdio},
    sync::atomic::{AtomicU32, Ordering},
    thread::sleep,
    time::Instant,
};

use image::RgbImage;
use serde_json::Value;

use crate::{command_line::example, panel::session::Session, prelude::*};

/// Time after which an expected state is given up, also on a slow machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// The running example and its X server.
pub struct Window {
    /// Size in physical pixels.
    size: [u32; 2],
    /// Physical pixels per logical pixel.
    scale: f64,
    server: Child,
    app: Child,
    display: String,
    folder: PathBuf,
    /// Whether a mouse button is held; the pointer is not moved then.
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

/// The style that windows start with.
pub const START: &str = r##"(
    version: 3,
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
            .args(["--memory", "none", "--closed"])
            .args(["--size", &format!("{}x{}", size[0], size[1])])
            .args(["--scale", &scale.to_string()])
            .arg("--state")
            .arg(folder.join("state.json"))
            .arg("--styles")
            .arg(folder.join("styles"))
            .arg("--shadings")
            .arg(folder.join("shadings"))
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

    fn xdotool(&self, arguments: &[&str]) {
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
}

/// A place in physical pixels as arguments.
fn arguments(at: [f64; 2]) -> [String; 2] {
    at.map(|v| format!("{}", v.round()))
}

impl Session for Window {
    fn size(&self) -> [u32; 2] {
        self.size
    }

    fn scale(&self) -> f64 {
        self.scale
    }

    fn folder(&self) -> &Path {
        &self.folder
    }

    fn state(&self) -> Value {
        let text = fs::read_to_string(self.folder.join("state.json")).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or(Value::Null)
    }

    fn until(&self, what: &str, is_so: impl Fn(&Value) -> bool) -> Value {
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
            sleep(Duration::from_millis(5));
        }
    }

    fn frames(&self, count: u64) {
        let now = self.state()["frame"].as_u64().unwrap_or(0);
        self.until("the next frame", |state| {
            state["frame"].as_u64() >= Some(now + count)
        });
    }

    /// The next frame may have begun before the input came.
    fn seen(&self) {
        self.frames(2);
    }

    fn move_to(&self, at: [f64; 2]) {
        let [x, y] = arguments(at);
        self.xdotool(&["mousemove", &x, &y]);
    }

    fn hold(&self, down: bool) {
        self.xdotool(&[if down { "mousedown" } else { "mouseup" }, "1"]);
        self.held.set(down);
    }

    /// At once, because a long press is not a click and frames may be slow.
    fn press_and_release(&self) {
        self.xdotool(&["click", "1"]);
    }

    fn hold_key(&self, key: &str, down: bool) {
        self.xdotool(&[if down { "keydown" } else { "keyup" }, key]);
    }

    fn press_key(&self, key: &str) {
        self.xdotool(&["key", key]);
    }

    fn type_text(&self, text: &str) {
        self.xdotool(&["type", "--delay", "40", text]);
    }

    fn picture(&self) -> RgbImage {
        // No tooltip is in the picture.
        if !self.held.get() {
            self.move_to(self.size.map(|v| f64::from(v - 12)));
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
