//! A crate of a newcomer, outside the repository: the README's lines compile
//! as they stand, and draw ink.

use std::{env, fmt::Write, fs, path::Path, process::Command};

use bevy_comics::{
    BlackFlats, ComicStyle, ContourOperator, Contours, DepthMap, DepthMapping, Outlines,
    ReductionMethod, presets,
};

use crate::outside::{OutsideCrate, ROOT};

/// The first Rust block of the README.
fn readme_lines() -> String {
    let readme = fs::read_to_string(Path::new(ROOT).join("README.md")).expect("the README");
    let (_, rest) = readme.split_once("```rust\n").expect("a block of Rust");
    rest.split_once("```").expect("its end").0.to_owned()
}

/// What the README's `main` does, without a window; the camera of the README
/// draws into a picture, before a cube. Before that, the Rust code of the presets
/// is run.
const HEADLESS_MAIN: &str = r#"
#[path = "../styles.rs"]
mod styles;

fn main() {
    styles::check();
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

/// A module with a function for every preset, which is the preset's Rust code,
/// and a check that they build the presets. A last one builds a style with the
/// types that no preset has.
fn styles_as_rust() -> String {
    let other = ComicStyle {
        name: "A \"quoted\" name".into(),
        ..ComicStyle::new()
    }
    .with_depth_map(DepthMap {
        mapping: DepthMapping::Fixed {
            near: 0.5,
            far: 1e6,
        },
        reduction: ReductionMethod::PingPong,
        smoothing: None,
        ..DepthMap::default()
    })
    .with(BlackFlats {
        slope: Some(1e-6),
        value: None,
        ..BlackFlats::default()
    })
    .with(Contours {
        operator: ContourOperator::Roberts,
        ..Contours::default()
    })
    .turn_off::<Outlines>()
    .partial();
    let mut styles: Vec<(String, ComicStyle)> = presets::ALL
        .iter()
        .map(|preset| (preset.name().replace('-', "_"), preset.style()))
        .collect();
    styles.push(("other".into(), other));
    let mut code = String::from("use bevy::prelude::*;\nuse bevy_comics::prelude::*;\n");
    let mut checks = String::new();
    for (name, style) in styles {
        let built = style.to_rust();
        let file = style.to_ron().expect("text");
        writeln!(code, "fn {name}() -> ComicStyle {{\n{built}\n}}").expect("written");
        writeln!(
            checks,
            "assert_eq!({name}(), ComicStyle::from_ron({file:?}).unwrap(), {name:?});"
        )
        .expect("written");
    }
    format!("{code}pub fn check() {{\n{checks}}}\n")
}

#[test]
fn the_lines_of_the_readme_and_exported_styles_work_in_a_crate_of_their_own() {
    let lines = readme_lines();
    assert!(
        lines.lines().filter(|l| !l.trim().is_empty()).count() <= 14,
        "the README's start grew"
    );
    let headless = format!(
        "#![allow(dead_code)]\n{}\n{HEADLESS_MAIN}",
        lines.replace("fn main()", "fn with_a_window()"),
    );
    let files = [
        ("main.rs", &*lines),
        ("bin/newcomer_headless.rs", &headless),
        ("styles.rs", &styles_as_rust()),
    ];
    let newcomer = OutsideCrate::new("newcomer", &[], &files);
    newcomer.cargo(&["build", "--offline", "--bins"]);
    newcomer.cargo(&["run", "--offline", "--bin", "newcomer_headless"]);
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
