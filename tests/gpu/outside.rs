//! A crate outside the repository, compiled with the libraries that the tests are linked with.
//! Cargo would compile `bevy_comics` again, because a path outside of the workspace makes it
//! another crate.
//!
//! Tests add their files to one crate, so that it is compiled and linked once for all of them.

use std::{env, fs, sync::Once};

use serde_json::Value;

use crate::{command_line::build, fresh_crate, own_effect, prelude::*};

pub const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// A file of the crate: its path in the crate's folder, and its text.
pub type File = (&'static str, String);

/// The modules `printed` hold what the pages print, and nothing else.
const MAIN: &str = r#"
#![allow(dead_code)]

mod check;
mod own_effect;
mod printed {
    mod guide;
    mod page;
    mod readme;
}
mod styles;

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("readme") => check::readme::run(),
        Some("guide") => check::guide::run(),
        Some("styles") => styles::check(),
        Some("own_effect") => own_effect::run(),
        other => panic!("no program {other:?}"),
    }
}
"#;

/// The crates that the printed programs and their checks name.
const CRATES: [&str; 6] = [
    "bevy",
    "bevy_comics",
    "bevy_comics_inspector",
    "bevy_comics_testkit",
    "image",
    "serde",
];

/// To test a program from outside, add its files here, and its name to [`MAIN`].
fn files() -> Vec<File> {
    let mut files = vec![("src/main.rs", MAIN.to_owned())];
    files.extend(fresh_crate::files());
    files.extend(own_effect::files());
    files
}

/// Runs a program of the crate in the crate's folder. It must succeed. Returns what it printed. The
/// first call compiles the crate.
pub fn run(program: &str) -> String {
    static BUILT: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    let binary = BUILT
        .get_or_init(|| {
            let binary = folder().join("outside");
            let name = binary.to_str().expect("a path in UTF-8");
            compile(&["-C", "opt-level=0", "-C", "debuginfo=0", "-o", name])?;
            Ok(binary)
        })
        .as_ref()
        .unwrap_or_else(|error| panic!("{error}"));
    succeed(
        Command::new(binary)
            .arg(program)
            // The panel must not read the settings of whoever runs the tests.
            .env("XDG_CONFIG_HOME", folder().join("config")),
    )
    .unwrap_or_else(|error| panic!("{error}"))
}

/// The folder of the crate.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("outside")
}

/// Compiles the crate, with more arguments.
fn compile(more: &[&str]) -> Result<(), String> {
    // Tests compile it at the same time.
    static WRITTEN: Once = Once::new();
    WRITTEN.call_once(|| {
        for (path, text) in files() {
            let path = folder().join(path);
            fs::create_dir_all(path.parent().expect("a folder")).expect("created");
            fs::write(path, text).expect("written");
        }
    });
    let program = env::current_exe().expect("this test");
    let libraries = program.parent().expect("the folder of the libraries");
    let mut rustc = Command::new(env::var("RUSTC").unwrap_or_else(|_| "rustc".into()));
    rustc
        .args(["src/main.rs", "--crate-name", "outside"])
        .args(["--edition", "2024", "-L"])
        .arg(format!("dependency={}", libraries.display()))
        .args(more);
    // Built for `command_line` too: its libraries are those of this test.
    let messages = build("render");
    for name in CRATES {
        let library = library(&messages, name);
        rustc.args(["--extern", &format!("{name}={library}")]);
    }
    succeed(&mut rustc).map(drop)
}

/// The file of a library.
fn library<'a>(messages: &'a [Value], name: &str) -> &'a str {
    let files: Vec<&str> = messages
        .iter()
        .filter(|message| message["target"]["name"] == name)
        .filter_map(|message| message["filenames"].as_array())
        .flatten()
        .filter_map(Value::as_str)
        .filter(|file| file.ends_with(".rlib"))
        .collect();
    let [file] = files[..] else {
        panic!("{name} is in {} files: {files:?}", files.len());
    };
    file
}

/// Runs a command in the crate's folder, as cargo would. Returns what it printed.
fn succeed(command: &mut Command) -> Result<String, String> {
    let output = command
        .current_dir(folder())
        // The engine's macros and its asset server read it.
        .env("CARGO_MANIFEST_DIR", folder())
        .output()
        .expect("it starts");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(printed);
    }
    let errors = String::from_utf8_lossy(&output.stderr);
    Err(format!("{command:?}\n{printed}{errors}"))
}

/// What the pages print and what the panel exports compiles as it stands.
#[test]
fn printed_programs_and_exported_styles_compile() {
    let checked = compile(&["--emit", "metadata", "-o", "checked.rmeta"]);
    checked.unwrap_or_else(|error| panic!("{error}"));
}
