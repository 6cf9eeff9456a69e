//! A crate outside the repository, built with the engine that our own tests are built with.
//!
//! Tests add their files to one crate, so that `bevy_comics` is compiled once for all of them.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
    sync::OnceLock,
};

use crate::{fresh_crate, own_effect};

pub const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// A file of the crate: its path under `src`, and its text. Each `bin/NAME.rs` is a binary.
pub type File = (&'static str, String);

/// To test a program from outside, add its files here and call [`run`] with the binary's name.
fn files() -> Vec<File> {
    let lib = "#![allow(dead_code)]\nmod guide;\nmod page;\nmod readme;\nmod styles;\n";
    let mut files = vec![("lib.rs", lib.to_owned())];
    files.extend(fresh_crate::files());
    files.extend(own_effect::files());
    files
}

/// Runs a binary of the outside crate with these arguments, in the crate's folder. It must succeed.
/// Returns what it printed. The first call builds the crate.
pub fn run(name: &str, arguments: &[&str]) -> String {
    static BUILT: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    let folder = BUILT
        .get_or_init(build)
        .as_ref()
        .unwrap_or_else(|error| panic!("{error}"));
    let command = [&["run", "--quiet", "--bin", name, "--"], arguments].concat();
    cargo(folder, &command).unwrap_or_else(|error| panic!("{error}"))
}

/// The folder of the crate.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("outside")
}

/// Writes and builds the crate. Its path is always the same: a second build is incremental.
fn build() -> Result<PathBuf, String> {
    let folder = folder();
    let files = files();
    write(&folder.join("Cargo.toml"), &manifest(&files));
    let lock = fs::read_to_string(Path::new(ROOT).join("Cargo.lock")).expect("our lock file");
    write(&folder.join("Cargo.lock"), &lock);
    for (path, text) in &files {
        write(&folder.join("src").join(path), text);
    }
    cargo(&folder, &["build", "--lib", "--bins"])?;
    Ok(folder)
}

/// The crate depends on everything that our tests depend on, so that the engine has the same
/// features and is not built a second time.
fn manifest(files: &[File]) -> String {
    let ours = fs::read_to_string(Path::new(ROOT).join("Cargo.toml")).expect("our manifest");
    let line = |name: &str| {
        let start = format!("{name} = ");
        let own = section(&ours, "dependencies");
        let line = own.lines().find(|line| line.starts_with(&start));
        line.unwrap_or_else(|| panic!("we do not depend on {name}"))
            .to_owned()
    };
    let mut text = format!(
        "[package]\nname = \"outside\"\nversion = \"0.1.0\"\nedition = \"2024\"\nautobins = false\n\n\
         [workspace]\n\n\
         [dependencies]\nbevy = {{ version = \"*\", default-features = false }}\n{}\n{}\n\n\
         [profile.dev]\nopt-level = 0\ndebug = false\n\n\
         [profile.dev.package.bevy_comics]\nopt-level = 0\n\n\
         [profile.dev.package.bevy_comics_testkit]\nopt-level = 0\n\n\
         [profile.dev.package.\"*\"]\n{}\n",
        line("serde"),
        section(&ours, "dev-dependencies").replace("path = \"", &format!("path = \"{ROOT}/")),
        section(&ours, "profile.dev.package.\"*\""),
    );
    for (path, _) in files {
        if let Some(name) = path.strip_prefix("bin/") {
            let name = name.trim_end_matches(".rs");
            text += &format!("\n[[bin]]\nname = {name:?}\npath = \"src/{path}\"\n");
        }
    }
    text
}

fn cargo(folder: &Path, arguments: &[&str]) -> Result<String, String> {
    let target = env::current_exe()
        .expect("this test")
        .ancestors()
        .find(|path| path.file_name().is_some_and(|name| name == "debug"))
        .and_then(Path::parent)
        .expect("the target folder")
        .to_owned();
    let output = Command::new(env::var("CARGO").unwrap_or_else(|_| "cargo".into()))
        .arg(arguments[0])
        .arg("--offline")
        .args(&arguments[1..])
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", target)
        // The panel must not read the settings of whoever runs the tests.
        .env("XDG_CONFIG_HOME", folder.join("config"))
        // `scripts/test` sets it for the test binary; build scripts would see it and run again.
        .env_remove("RUSTC_BOOTSTRAP")
        .output()
        .expect("cargo runs");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(printed);
    }
    let errors = String::from_utf8_lossy(&output.stderr);
    Err(format!("cargo {arguments:?}\n{printed}{errors}"))
}

/// Files that have not changed are not written: cargo compares times.
fn write(path: &Path, text: &str) {
    if fs::read_to_string(path).is_ok_and(|old| old == text) {
        return;
    }
    fs::create_dir_all(path.parent().expect("a folder")).expect("created");
    fs::write(path, text).expect("written");
}

/// The section of our manifest under a heading.
fn section(manifest: &str, heading: &str) -> String {
    let (_, rest) = manifest
        .split_once(&format!("[{heading}]\n"))
        .expect("the section");
    rest.lines()
        .take_while(|line| !line.starts_with('['))
        .collect::<Vec<_>>()
        .join("\n")
}
