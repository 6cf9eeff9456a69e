//! A crate of a newcomer, outside the repository: the README's lines compile
//! as they stand, and draw ink.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The first Rust block of the README.
fn readme_lines() -> String {
    let readme = fs::read_to_string(Path::new(ROOT).join("README.md")).expect("the README");
    let (_, rest) = readme.split_once("```rust\n").expect("a block of Rust");
    rest.split_once("```").expect("its end").0.to_owned()
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

/// What the README's `main` does, without a window; the camera of the README
/// draws into a picture, before a cube.
const HEADLESS_MAIN: &str = r#"
#[path = "@ROOT@/examples/common/mod.rs"]
mod common;

fn main() {
    use common::headless::{Headless, HeadlessOptions};
    let options = HeadlessOptions { size: UVec2::new(96, 64), ..default() };
    let mut headless = Headless::new(options, ComicsPlugin);
    headless.app.add_systems(Startup, setup);
    let world = headless.app.world_mut();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: Color::WHITE,
        unlit: true,
        ..default()
    });
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), Transform::from_xyz(0.0, 0.0, -5.0)));
    headless.step(1);
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let camera = world.query_filtered::<Entity, With<Camera3d>>().single(world).expect("its camera");
    world.entity_mut(camera).insert((target, Transform::IDENTITY));
    world.insert_resource(ClearColor(Color::WHITE));
    headless.step(5);
    let picture = headless.picture();
    let ink = picture.pixels().filter(|p| p.0[..3].iter().all(|c| *c < 60)).count();
    println!("{ink} pixels of ink");
    assert!(ink > 20, "no contour was drawn");
}
"#;

fn cargo(folder: &Path, target: &Path, arguments: &[&str]) {
    let output = Command::new(env::var("CARGO").unwrap_or_else(|_| "cargo".into()))
        .args(arguments)
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", target)
        .output()
        .expect("cargo runs");
    assert!(
        output.status.success(),
        "cargo {arguments:?}\n{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn the_lines_of_the_readme_compile_and_draw_in_a_crate_of_their_own() {
    let folder = env::temp_dir().join(format!("bevy-comics-newcomer-{}", std::process::id()));
    fs::create_dir_all(folder.join("src/bin")).expect("a folder");
    let manifest = fs::read_to_string(Path::new(ROOT).join("Cargo.toml")).expect("our manifest");
    // The engine's features, and our tests' other dependencies, are those of
    // our own build, so that the compiled engine is shared and not built twice.
    let features = if cfg!(feature = "inspector") {
        "features = [\"inspector\"], "
    } else {
        ""
    };
    // What the harness of our examples uses besides, as we ask for it.
    let wgpu = section(&manifest, "dependencies")
        .lines()
        .find(|line| line.starts_with("wgpu = "))
        .expect("wgpu")
        .to_owned();
    let text = format!(
        "[package]\nname = \"newcomer\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
         [dependencies]\nbevy_comics = {{ {features}path = {ROOT:?} }}\n{wgpu}\n{}\n\n[profile.dev]\n{}\n\n[profile.dev.package.\"*\"]\n{}\n",
        section(&manifest, "dev-dependencies"),
        section(&manifest, "profile.dev"),
        section(&manifest, "profile.dev.package.\"*\""),
    );
    let lines = readme_lines();
    assert!(
        lines.lines().filter(|l| !l.trim().is_empty()).count() <= 14,
        "the README's start grew"
    );
    fs::write(folder.join("Cargo.toml"), text).expect("written");
    fs::copy(
        Path::new(ROOT).join("Cargo.lock"),
        folder.join("Cargo.lock"),
    )
    .expect("copied");
    fs::write(folder.join("src/main.rs"), &lines).expect("written");
    let headless = format!(
        "#![allow(dead_code)]\n{}\n{}",
        lines.replace("fn main()", "fn with_a_window()"),
        HEADLESS_MAIN.replace("@ROOT@", ROOT)
    );
    fs::write(folder.join("src/bin/render.rs"), headless).expect("written");

    let target: PathBuf = env::current_exe()
        .expect("this test")
        .ancestors()
        .find(|path| path.file_name().is_some_and(|name| name == "debug"))
        .and_then(Path::parent)
        .expect("the target folder")
        .to_owned();
    cargo(&folder, &target, &["build", "--offline", "--bins"]);
    cargo(&folder, &target, &["run", "--offline", "--bin", "render"]);
    fs::remove_dir_all(&folder).expect("the folder goes");
}

/// The packages of a build for a game, without those of examples and tests.
fn packages(features: &[&str]) -> std::collections::BTreeSet<String> {
    let output = Command::new(env::var("CARGO").unwrap_or_else(|_| "cargo".into()))
        .args([
            "tree", "--locked", "--edges", "normal", "--prefix", "none", "--format", "{p}",
        ])
        .args(features)
        .current_dir(ROOT)
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "cargo tree");
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(|line| {
            line.split_whitespace()
                .take(2)
                .collect::<Vec<_>>()
                .join(" ")
        })
        .filter(|package| !package.is_empty())
        .collect()
}

/// Without its feature nothing of the inspector is compiled: on Linux a game
/// builds as many crates as before there was one.
#[test]
#[cfg(target_os = "linux")]
fn the_inspector_is_not_built_unasked() {
    let without = packages(&[]);
    let with = packages(&["--features", "inspector"]);
    assert!(without.is_subset(&with));
    for name in ["bevy_egui", "egui", "egui_plot", "arboard", "dirs"] {
        let named = |packages: &std::collections::BTreeSet<String>| {
            packages
                .iter()
                .any(|package| package.split(' ').next() == Some(name))
        };
        assert!(!named(&without), "{name} is built without the feature");
        assert!(named(&with), "{name} is built with it");
    }
    // `cargo tree --edges normal` of the commit before the inspector: 208.
    assert_eq!(
        without.len(),
        208,
        "the default build has other crates than before"
    );
}
