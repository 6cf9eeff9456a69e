//! The README's first program compiles outside the repository as it stands, and
//! draws contours.

use std::{env, fs, path::Path, process::Command};

use crate::outside::{self, File, ROOT};

/// The first Rust block of the README.
fn readme_lines() -> String {
    let readme = fs::read_to_string(Path::new(ROOT).join("README.md")).expect("the README");
    let (_, rest) = readme.split_once("```rust\n").expect("a block of Rust");
    rest.split_once("```").expect("its end").0.to_owned()
}

/// What the README's `main` does, without a window. The README's camera draws a
/// cube into a picture.
const HEADLESS_MAIN: &str = r#"
fn main() {
    use bevy_comics_testkit::headless::{Headless, HeadlessOptions};
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

/// The README's lines as they stand, as a module of the outside crate, and a binary that runs them
/// without a window.
pub fn files() -> Vec<File> {
    let lines = readme_lines();
    let headless = format!(
        "#![allow(dead_code)]\n{}\n{HEADLESS_MAIN}",
        lines.replace("fn main()", "fn with_a_window()"),
    );
    vec![("readme.rs", lines), ("bin/newcomer.rs", headless)]
}

#[test]
fn the_lines_of_the_readme_compile_and_draw_in_a_crate_of_their_own() {
    let count = readme_lines()
        .lines()
        .filter(|line| !line.trim().is_empty())
        .count();
    assert!(count <= 14, "the README's start has {count} lines");
    outside::run("newcomer");
}

/// The packages that a game compiles: no dev-dependencies.
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

/// Without the feature `inspector` none of its dependencies are compiled.
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
    // Counted on Linux. Update it when a dependency is added on purpose.
    assert_eq!(
        without.len(),
        208,
        "the default build has other crates than before"
    );
}
