//! An app with the inspector whose window is never shown. Its panel is laid out, and is given the
//! messages that a window would send. Nothing is drawn of it, and frames pass only when a session
//! waits.

use std::{
    cell::{Cell, RefCell},
    fs,
    sync::atomic::{AtomicU32, Ordering},
};

use bevy::{
    input::{
        ButtonState,
        keyboard::{Key, KeyboardInput},
        mouse::MouseButtonInput,
    },
    light::DirectionalLightShadowMap,
    time::TimeUpdateStrategy,
    window::{CursorMoved, PrimaryWindow, Window, WindowRef, WindowResolution},
};
use bevy_comics_inspector::ComicsInspectorPlugin;
use bevy_comics_testkit::{panel_state::panel_state, studio::set_style};
use image::{DynamicImage, RgbImage};
use serde_json::Value;

use super::session::Session;
use crate::prelude::*;

/// Frames after which an expected state is given up. The panel looks at its files four times a
/// second.
const PATIENCE: usize = 500;

/// The time of a frame in the app: animations of the toolkit are over after one.
const FRAME: Duration = Duration::from_millis(100);

/// What the cameras draw to.
#[derive(Clone, Copy)]
pub enum Drawn {
    /// A picture of this size.
    Picture([u32; 2]),
    /// The window, from its left side to this width, which two cameras share. Nothing is drawn but
    /// photographs and pictures.
    Window(u32),
}

/// What a hidden window shows.
pub struct Shown {
    pub scene: BuiltIn,
    pub style: ComicStyle,
    pub cameras: u32,
    pub drawn: Drawn,
}

pub struct HiddenWindow {
    studio: RefCell<Studio>,
    window: Entity,
    cameras: Vec<Entity>,
    size: [u32; 2],
    scale: f64,
    folder: PathBuf,
    drawn: Drawn,
    is_shift_held: Cell<bool>,
}

impl HiddenWindow {
    /// Starts an app with a window of a size in physical pixels, with `scale` physical pixels per
    /// logical pixel.
    pub fn open(size: [u32; 2], scale: f64, shown: &Shown) -> Self {
        static OPENED: AtomicU32 = AtomicU32::new(0);
        let number = OPENED.fetch_add(1, Ordering::Relaxed);
        let name = format!("bevy-comics-hidden-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(folder.join("styles")).expect("a folder");
        let inspector = ComicsInspectorPlugin {
            styles: folder.join("styles"),
            shadings: folder.join("shadings"),
            pictures: folder.join("pictures"),
            memory: None,
            ..default()
        };
        let (picture, scale_factor) = match shown.drawn {
            Drawn::Picture(size) => (size, 1.0),
            Drawn::Window(_) => (size, scale as f32),
        };
        let is_in_window = matches!(shown.drawn, Drawn::Window(_));
        let options = HeadlessOptions {
            // The first frames are not looked at.
            size: if is_in_window {
                UVec2::splat(16)
            } else {
                picture.into()
            },
            scale_factor,
            ..default()
        };
        let plugins = (ComicsPlugin, inspector, small_shadow_maps);
        let mut studio = Studio::with_plugins(shown.scene, options, Msaa::Off, plugins);
        if is_in_window {
            studio.headless.resize(picture.into(), scale_factor);
        }
        studio
            .headless
            .app
            .insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
        let vantage = studio.vantage.clone();
        let target = studio.headless.render_target();
        let world = studio.headless.app.world_mut();
        let resolution =
            WindowResolution::new(size[0], size[1]).with_scale_factor_override(scale as f32);
        let hidden = Window {
            resolution,
            ..default()
        };
        let window = world.spawn((hidden, PrimaryWindow)).id();
        let mut cameras = vec![studio.camera];
        for _ in 1..shown.cameras {
            cameras.push(
                world
                    .spawn((vantage.camera(), target.clone(), Msaa::Off))
                    .id(),
            );
        }
        let names = ["Main camera", "Second camera"];
        for (k, (&camera, name)) in cameras.iter().zip(names).enumerate() {
            let viewport = match shown.drawn {
                Drawn::Picture(_) => None,
                Drawn::Window(width) => {
                    let part = width / shown.cameras;
                    Some(Viewport {
                        physical_position: UVec2::new(k as u32 * part, 0),
                        physical_size: UVec2::new(part, size[1]),
                        ..default()
                    })
                }
            };
            let view = Camera {
                order: k as isize,
                viewport,
                ..default()
            };
            let mut commands = world.commands();
            let mut camera = commands.entity(camera);
            camera.insert((Name::new(name), view));
            set_style(&mut camera, &shown.style);
        }
        world.flush();
        let hidden = Self {
            studio: RefCell::new(studio),
            window,
            cameras,
            size,
            scale,
            folder,
            drawn: shown.drawn,
            is_shift_held: Cell::new(false),
        };
        hidden.aim(&match shown.drawn {
            Drawn::Picture(_) => target,
            Drawn::Window(_) => RenderTarget::Window(WindowRef::Primary),
        });
        hidden.frames(2);
        hidden
    }

    /// Lets the cameras draw to a target.
    fn aim(&self, target: &RenderTarget) {
        self.with_world(|world| {
            for &camera in &self.cameras {
                let mut camera = world.entity_mut(camera);
                camera.insert(target.clone());
                // The engine reads the size of a target when the projection changes.
                if let Some(mut projection) = camera.get_mut::<Projection>() {
                    projection.set_changed();
                }
            }
        });
    }

    fn with_world<T>(&self, act: impl FnOnce(&mut World) -> T) -> T {
        act(self.studio.borrow_mut().headless.app.world_mut())
    }
}

impl Drop for HiddenWindow {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// No test looks at shadows.
fn small_shadow_maps(app: &mut App) {
    app.insert_resource(DirectionalLightShadowMap { size: 256 });
}

/// The key with a name of X: what it is on the keyboard, and what it means.
fn key_of(name: &str, is_shift_held: bool) -> (KeyCode, Key) {
    let letter = |code| {
        let text = if is_shift_held {
            name.to_uppercase()
        } else {
            name.to_owned()
        };
        (code, Key::Character(text.as_str().into()))
    };
    match name {
        "F10" => (KeyCode::F10, Key::F10),
        "Tab" => (KeyCode::Tab, Key::Tab),
        "Escape" => (KeyCode::Escape, Key::Escape),
        "Right" => (KeyCode::ArrowRight, Key::ArrowRight),
        "space" => (KeyCode::Space, Key::Space),
        "ctrl" => (KeyCode::ControlLeft, Key::Control),
        "shift" => (KeyCode::ShiftLeft, Key::Shift),
        "f" => letter(KeyCode::KeyF),
        "z" => letter(KeyCode::KeyZ),
        // Of typed texts, only the characters are read.
        _ => letter(KeyCode::KeyX),
    }
}

impl Session for HiddenWindow {
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
        self.with_world(|world| panel_state(world, &self.cameras))
    }

    fn until(&self, what: &str, is_so: impl Fn(&Value) -> bool) -> Value {
        for _ in 0..PATIENCE {
            let state = self.state();
            if is_so(&state) {
                return state;
            }
            self.frames(1);
        }
        panic!("waited in vain for {what}: {:#}", self.state());
    }

    fn frames(&self, count: u64) {
        self.studio.borrow_mut().headless.step(count as usize);
    }

    fn seen(&self) {
        self.frames(1);
    }

    fn move_to(&self, at: [f64; 2]) {
        let [x, y] = at.map(|v| v / self.scale);
        self.with_world(|world| {
            let mut window = world.entity_mut(self.window);
            let mut window = window.get_mut::<Window>().expect("a window");
            window.set_physical_cursor_position(Some(DVec2::from_array(at)));
            world.write_message(CursorMoved {
                window: self.window,
                position: Vec2::new(x as f32, y as f32),
                delta: None,
            });
        });
    }

    fn hold(&self, down: bool) {
        let state = if down {
            ButtonState::Pressed
        } else {
            ButtonState::Released
        };
        self.with_world(|world| {
            world.write_message(MouseButtonInput {
                button: MouseButton::Left,
                state,
                window: self.window,
            });
        });
    }

    fn press_and_release(&self) {
        self.hold(true);
        self.hold(false);
    }

    fn hold_key(&self, key: &str, down: bool) {
        if key == "shift" {
            self.is_shift_held.set(down);
        }
        let (key_code, logical_key) = key_of(key, self.is_shift_held.get());
        let text = match &logical_key {
            Key::Character(text) if down => Some(text.clone()),
            _ => None,
        };
        let state = if down {
            ButtonState::Pressed
        } else {
            ButtonState::Released
        };
        self.with_world(|world| {
            world.write_message(KeyboardInput {
                key_code,
                logical_key,
                state,
                text,
                repeat: false,
                window: self.window,
            });
        });
    }

    fn press_key(&self, key: &str) {
        self.hold_key(key, true);
        self.hold_key(key, false);
    }

    fn type_text(&self, text: &str) {
        for letter in text.chars() {
            self.press_key(&letter.to_string());
        }
        self.seen();
    }

    fn picture(&self) -> RgbImage {
        let is_in_window = matches!(self.drawn, Drawn::Window(_));
        if is_in_window {
            let target = self.studio.borrow().headless.render_target();
            self.aim(&target);
        }
        // The first draws with what has changed, the second with what follows from it.
        self.frames(2);
        let picture = self.studio.borrow_mut().headless.picture();
        if is_in_window {
            self.aim(&RenderTarget::Window(WindowRef::Primary));
            self.frames(1);
        }
        DynamicImage::from(picture).to_rgb8()
    }
}
