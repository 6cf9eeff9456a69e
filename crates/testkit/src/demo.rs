//! A small example: a window, or with `--out FILE` a picture without one.

use std::{ffi::OsString, path::PathBuf, process::ExitCode};

use bevy::{camera::RenderTarget, prelude::*, window::WindowResolution};
use bevy_comics::ComicsPlugin;

use crate::headless::{Headless, HeadlessOptions};

/// What an example shows.
pub struct Demo {
    pub title: &'static str,
    /// Keys, for the help on the command line.
    pub keys: &'static str,
    /// Size of the window, and of the picture unless `--size` says otherwise.
    pub size: UVec2,
    /// Frames before the picture is taken.
    pub frames: usize,
}

/// Where the cameras of an example draw to: its window, or the picture.
#[derive(Resource, Clone, Default)]
pub struct Screen {
    pub target: RenderTarget,
    /// Where the picture is saved; `None` for a window.
    pub out: Option<PathBuf>,
}

impl Demo {
    /// Adds the example to an app and runs it. `add` gets the app before the engine starts; the
    /// resource [`Screen`] is there when systems run.
    pub fn run(self, add: impl Fn(&mut App) + Send + Sync + 'static) -> ExitCode {
        self.run_with(add, Headless::picture)
    }

    /// The same with another picture than that of the screen.
    pub fn run_with(
        self,
        add: impl Fn(&mut App) + Send + Sync + 'static,
        picture: impl FnOnce(&mut Headless) -> image::RgbaImage,
    ) -> ExitCode {
        let (size, out) = match self.arguments(std::env::args_os().skip(1)) {
            Ok(Some(wanted)) => wanted,
            Ok(None) => {
                println!("{}", self.help());
                return ExitCode::SUCCESS;
            }
            Err(message) => {
                eprintln!("{message}\n\n{}", self.help());
                return ExitCode::from(2);
            }
        };
        let Some(path) = out else {
            self.open_window(size, add);
            return ExitCode::SUCCESS;
        };
        let options = HeadlessOptions { size, ..default() };
        let mut headless = Headless::new(options, move |app: &mut App| {
            app.add_plugins(ComicsPlugin).init_resource::<Screen>();
            add(app);
        });
        let target = headless.render_target();
        let out = Some(path.clone());
        headless.app.insert_resource(Screen { target, out });
        headless.step(self.frames);
        let shot = image::DynamicImage::ImageRgba8(picture(&mut headless)).into_rgb8();
        match shot.save(&path) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{}: {error}", path.display());
                ExitCode::from(2)
            }
        }
    }

    fn open_window(&self, size: UVec2, add: impl Fn(&mut App) + Send + Sync + 'static) {
        let mut app = App::new();
        app.add_plugins(DefaultPlugins.set(WindowPlugin {
            primary_window: Some(Window {
                title: self.title.into(),
                resolution: WindowResolution::new(size.x, size.y),
                ..default()
            }),
            ..default()
        }))
        .add_plugins(ComicsPlugin)
        .init_resource::<Screen>();
        add(&mut app);
        app.run();
    }

    fn help(&self) -> String {
        let (title, UVec2 { x, y }) = (self.title, self.size);
        format!(
            "{title}. Without arguments it opens a window.\n\n{}\n\n    \
             --out FILE.png   save a picture without a window, and exit\n    \
             --size WxH       size in pixels (default {x}x{y})\n    \
             --help           print this help",
            self.keys
        )
    }

    /// The size and the picture's path; `None` if only help was asked for.
    fn arguments(
        &self,
        mut given: impl Iterator<Item = OsString>,
    ) -> Result<Option<(UVec2, Option<PathBuf>)>, String> {
        let (mut size, mut out) = (self.size, None);
        while let Some(argument) = given.next() {
            match &*argument.to_string_lossy() {
                "--out" => out = Some(given.next().ok_or("--out needs a file")?.into()),
                "--size" => {
                    let text = given.next().unwrap_or_default();
                    size = parse_size(&text.to_string_lossy())
                        .ok_or("--size: possible are 16x16 to 4096x4096")?;
                }
                "--help" | "-h" => return Ok(None),
                other => return Err(format!("unknown argument {other}")),
            }
        }
        Ok(Some((size, out)))
    }
}

/// A size such as `960x540`, within what an adapter can draw.
pub fn parse_size(text: &str) -> Option<UVec2> {
    let (width, height) = text.split_once('x')?;
    let size = UVec2::new(width.parse().ok()?, height.parse().ok()?);
    (size.min_element() >= 16 && size.max_element() <= 4096).then_some(size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::{Counting, check_command_lines};

    #[global_allocator]
    static ALLOCATOR: Counting = Counting;

    const DEMO: Demo = Demo {
        title: "Photo mode",
        keys: "",
        size: UVec2::new(480, 360),
        frames: 4,
    };

    /// Every command line is read, or refused with a message.
    #[test]
    fn parsing_a_command_line_never_panics() {
        // Command lines of the photo mode and its like, with an argument on each line.
        let right = [
            "--out\nphoto.png",
            "--size\n480x360",
            "--size\n4096x16\n--out\nfolder/photo.png",
            "--out\na.png\n--size\n960x540",
            "--help",
        ];
        check_command_lines(
            4,
            &right,
            |given| DEMO.arguments(given.map(OsString::from)),
            |(size, _)| assert!(size.min_element() >= 16 && size.max_element() <= 4096),
        );
    }

    /// Bytes that are no text are an argument, too.
    #[cfg(unix)]
    #[test]
    fn arguments_may_be_no_text() {
        use std::os::unix::ffi::OsStringExt;
        let odd = || OsString::from_vec(vec![0xff, b'.', b'p', b'n', b'g']);
        assert!(DEMO.arguments([odd()].into_iter()).is_err());
        let named = ["--out".into(), odd()];
        let read = DEMO.arguments(named.into_iter()).expect("read");
        assert_eq!(read, Some((DEMO.size, Some(odd().into()))));
        let sized = ["--size".into(), odd()];
        assert!(DEMO.arguments(sized.into_iter()).is_err());
    }
}
