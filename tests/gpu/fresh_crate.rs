//! A newcomer, from an empty folder: the programs of the README and of the first guide are built in
//! a crate outside the repository as they are printed, and draw a comic.

use std::{env, fmt::Write, fs, path::Path};

use bevy_comics::{
    BlackFlats, ComicStyle, Contours, DepthMap, DepthMapping, Outlines, depth::ReductionMethod,
    effects::ContourOperator, presets,
};
use bevy_comics_inspector::rust_code;

use image::{Rgb, RgbImage};

use crate::{
    guide::{blocks, page},
    outside::{self, File, ROOT},
};

/// Runs a printed program from its own `main`, with the engine's plugins without a window in place
/// of `DefaultPlugins`. Saves the picture with the outlines and the one without, and says whether
/// there is a panel.
const CHECK: &str = r#"
use bevy::{app::PluginGroupBuilder, prelude::*};
use bevy_comics::Outlines;
use bevy_comics_inspector::ComicsInspector;
use bevy_comics_testkit::headless::{Headless, HeadlessOptions, plugins};

pub mod readme {
    // Stronger than the prelude's glob.
    use super::Windowless as DefaultPlugins;
    include!("printed/readme.rs");
    pub fn run() {
        main();
    }
}

pub mod guide {
    use super::Windowless as DefaultPlugins;
    include!("printed/guide.rs");
    pub fn run() {
        main();
    }
}

fn options() -> HeadlessOptions {
    HeadlessOptions { size: UVec2::new(480, 270), assets: "assets".into(), log: true, ..default() }
}

pub struct Windowless;

impl PluginGroup for Windowless {
    fn build(self) -> PluginGroupBuilder {
        plugins(&options()).add(|app: &mut App| {
            app.set_runner(check);
        })
    }
}

fn check(app: App) -> AppExit {
    let mut headless = Headless::of(app, options());
    headless.step(1);
    // The engine overlooks that a camera's target changes, unless the image is new.
    headless.resize(options().size, 1.0);
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let camera = world.query_filtered::<Entity, With<Camera3d>>().single(world).expect("a camera");
    world.entity_mut(camera).insert(target);
    // A style file takes a while to load.
    for _ in 0..500 {
        headless.step(1);
        if headless.app.world().get::<Outlines>(camera).is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    headless.step(2);
    headless.picture().save("comic.png").expect("saved");
    println!("panel: {}", headless.app.world().contains_resource::<ComicsInspector>());
    headless.app.world_mut().entity_mut(camera).remove::<Outlines>();
    headless.step(2);
    headless.picture().save("plain.png").expect("saved");
    AppExit::Success
}
"#;

/// What two programs are compared by: rustfmt breaks lines where the README does not.
fn program(text: &str) -> String {
    let start = text.find("use bevy").expect("a program");
    let text: String = text[start..].split_whitespace().collect();
    text.replace(",)", ")").replace(",}", "}")
}

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join(path)).expect("it is there")
}

/// Where the outlines have made the picture darker by a good deal.
struct Ink<'a> {
    comic: &'a RgbImage,
    plain: &'a RgbImage,
}

impl Ink<'_> {
    fn is_at(&self, (x, y): (u32, u32)) -> bool {
        let sum = |p: &Rgb<u8>| p.0.iter().map(|c| i32::from(*c)).sum::<i32>();
        sum(self.plain.get_pixel(x, y)) - sum(self.comic.get_pixel(x, y)) > 120
    }

    /// The square of pixels around a place, as far as the picture goes.
    fn around(&self, (x, y): (u32, u32), reach: u32) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (width, height) = self.plain.dimensions();
        let rows = y.saturating_sub(reach)..(y + reach + 1).min(height);
        let columns = x.saturating_sub(reach)..(x + reach + 1).min(width);
        rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
    }

    /// The fraction of the pixels with ink.
    fn fraction(&self) -> f64 {
        let places = self.plain.enumerate_pixels();
        let ink = places.filter(|(x, y, _)| self.is_at((*x, *y)));
        ink.count() as f64 / self.plain.pixels().len() as f64
    }

    /// How many pixels differ from their right neighbor by more than 25 degrees of hue, and the
    /// fraction of these that have ink within a pixel. Light and shadow keep the hue, so two
    /// objects meet there.
    fn borders(&self) -> (usize, f64) {
        let (mut borders, mut inked) = (0, 0);
        for (x, y, left) in self.plain.enumerate_pixels() {
            if x + 1 == self.plain.width() {
                continue;
            }
            let right = self.plain.get_pixel(x + 1, y);
            let (Some(a), Some(b)) = (hue(left), hue(right)) else {
                continue;
            };
            let apart = (a - b).abs();
            if apart.min(360.0 - apart) > 25.0 {
                borders += 1;
                inked += usize::from(self.around((x, y), 1).any(|at| self.is_at(at)));
            }
        }
        (borders, inked as f64 / borders.max(1) as f64)
    }
}

/// Degrees; `None` for grays.
fn hue(color: &Rgb<u8>) -> Option<f32> {
    let [r, g, b] = color.0.map(f32::from);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let chroma = most - least;
    if chroma < 30.0 {
        return None;
    }
    let sextant = match most {
        _ if most == r => (g - b) / chroma,
        _ if most == g => 2.0 + (b - r) / chroma,
        _ => 4.0 + (r - g) / chroma,
    };
    Some((60.0 * sextant).rem_euclid(360.0))
}

/// Runs a program of the crate, and holds its picture to what the page promises: lines where
/// objects meet. What it printed.
fn assert_it_draws_a_comic(name: &str) -> String {
    let printed = outside::run(name);
    let [comic, plain] = ["comic.png", "plain.png"].map(|file| {
        let picture = image::open(outside::folder().join(file)).expect("a picture");
        picture.to_rgb8()
    });
    let ink = Ink {
        comic: &comic,
        plain: &plain,
    };
    let fraction = ink.fraction();
    assert!((0.05..0.5).contains(&fraction), "{name}: {fraction} is ink");
    let (borders, inked) = ink.borders();
    assert!(
        borders > 100 && inked > 0.9,
        "{name}: {inked} of {borders} places where objects meet have ink"
    );
    printed
}

/// The lines that Cargo.toml needs. They are compared as text, not built: with Bevy's default
/// features they would build the engine another time, so the crate outside has a path in place of
/// the address, and the engine of the tests.
fn assert_dependencies(text: &str, crates: &[&str]) {
    let address = env!("CARGO_PKG_REPOSITORY");
    for name in crates {
        let ours = format!("{name} = {{ git = \"{address}\" }}");
        assert!(text.lines().any(|line| line == ours), "{ours}\n{text}");
    }
    let engine = read("Cargo.toml");
    let (_, engine) = engine
        .split_once("\nbevy = { version = \"")
        .expect("the engine");
    let version = engine.split('"').next().expect("a version");
    let minor = version.rsplit_once('.').expect("three numbers").0;
    assert!(
        text.lines()
            .any(|line| line.starts_with("bevy = ") && line.contains(&format!("\"{minor}\""))),
        "Bevy {minor}\n{text}"
    );
}

/// A module with a function for every preset, which is the preset's Rust code,
/// and a check that they build the presets. A last one builds a style with the
/// types that no preset has.
fn styles_as_rust() -> String {
    let other = ComicStyle {
        name: "A \"quoted\" name".into(),
        ..ComicStyle::new()
    }
    .with_depth_map(DepthMap {
        mapping: DepthMapping::Fixed { from: 0.5, to: 1e6 },
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
    let mut code = String::from("use bevy::prelude::*;\nuse bevy_comics::{prelude::*, presets};\n");
    let mut checks = String::new();
    let mut add = |function: &str, style: &ComicStyle, check: &str| {
        let built = rust_code(style);
        let file = style.to_ron().expect("text");
        writeln!(code, "fn {function}() -> ComicStyle {{\n{built}\n}}").expect("written");
        writeln!(
            checks,
            "assert_eq!({function}().to_ron().unwrap(), {file:?});\n{check}"
        )
        .expect("written");
    };
    add("other", &other, "");
    for preset in presets::ALL {
        let name = preset.name();
        let function = name.replace('-', "_");
        let check = format!("assert_eq!({function}(), presets::find({name:?}).unwrap().style());");
        add(&function, &preset.style(), &check);
    }
    format!("{code}pub fn check() {{\n{checks}}}\n")
}

/// The printed programs as they stand, as modules of the outside crate, and a module that runs them
/// without a window.
pub fn files() -> Vec<File> {
    let readme = read("README.md");
    let guide = page("your-own-style.md");
    let program = |page: &str| blocks(page, "rust,no_run")[0].to_owned();
    vec![
        ("Cargo.toml", blocks(&readme, "toml")[0].to_owned()),
        ("src/printed/readme.rs", program(&readme)),
        ("src/printed/guide.rs", program(&guide)),
        ("src/styles.rs", styles_as_rust()),
        ("src/check.rs", CHECK.to_owned()),
        (
            "assets/styles/mine.comic.ron",
            blocks(&guide, "ron")[0].to_owned(),
        ),
    ]
}

/// The first program is an example, too.
#[test]
fn what_the_readme_and_the_guide_print_is_what_is_compiled() {
    let readme = read("README.md");
    let guide = page("your-own-style.md");
    let first = blocks(&readme, "rust,no_run")[0];
    assert_eq!(program(first), program(&read("examples/simple.rs")));
    assert_dependencies(blocks(&readme, "toml")[0], &["bevy_comics"]);
    let with_panel = ["bevy_comics", "bevy_comics_inspector"];
    assert_dependencies(blocks(&guide, "toml")[0], &with_panel);
}

#[test]
#[ignore = "long: compiles and links a crate"]
fn the_readme_and_the_guide_work_as_printed_from_an_empty_folder() {
    for (name, panel) in [("readme", "panel: false"), ("guide", "panel: true")] {
        let printed = assert_it_draws_a_comic(name);
        assert!(
            printed.lines().any(|line| line == panel),
            "{name}: {printed}"
        );
    }
}

/// `rust_code` writes code that builds the style.
#[test]
#[ignore = "long: compiles and links a crate"]
fn exported_styles_build_the_same_style() {
    outside::run("styles");
}
