//! The code of `docs/your-own-effect.md` compiles in a crate outside the repository and works there
//! as the page says.

use std::fs;

use crate::{
    guide::blocks,
    outside::{self, File, ROOT},
    prelude::*,
};
use line_effect::Emphasis;

#[expect(dead_code, reason = "of the example, its effect is tested")]
#[path = "../../examples/line_effect.rs"]
mod line_effect;

/// Runs the page's effect without a window and calls the page's functions.
const HEADLESS: &str = r##"
#[path = "printed/page/tint.rs"]
mod tint;

use bevy::{ecs::system::RunSystemOnce, prelude::*};
use bevy_comics::{ComicsDiagnostics, diagnostics::*, effect::*, prelude::*};
use bevy_comics_testkit::headless::{Headless, HeadlessOptions};
use tint::Tint;

const STYLE: &str = include_str!("../assets/styles/amber.comic.ron");

/// Inserts components; returns the picture and whether the effect ran.
fn picture(
    headless: &mut Headless,
    camera: Entity,
    components: impl Bundle,
) -> (image::RgbaImage, bool) {
    headless.app.world_mut().entity_mut(camera).insert(components);
    headless.step(5);
    let diagnostics = headless.app.world().resource::<ComicsDiagnostics>();
    let ran = diagnostics.ran(camera, ComicsStage::of::<Tint>());
    (headless.picture(), ran)
}

pub fn run() {
    let options = HeadlessOptions {
        size: UVec2::new(96, 64),
        assets: "assets".into(),
        ..default()
    };
    let plugins = (ComicsPlugin, EffectPlugin::<Tint>::default());
    let mut headless = Headless::new(options, plugins);
    let target = headless.render_target();
    let world = headless.app.world_mut();
    world.insert_resource(ClearColor(Color::WHITE));
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: Color::WHITE,
        unlit: true,
        ..default()
    });
    let at = Transform::from_xyz(0.0, 0.0, -3.0);
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), at));
    let camera = world.spawn((Camera3d::default(), target)).id();

    // It runs where a camera has it, and changes the picture there.
    let (original, ran) = picture(&mut headless, camera, ());
    assert!(!ran, "no camera has the effect");
    let (tinted, ran) = picture(&mut headless, camera, Tint::default());
    assert!(ran, "the effect did not run");
    let (before, after) = (original.get_pixel(48, 32), tinted.get_pixel(48, 32));
    assert!(after[2] + 20 < before[2], "from {before:?} to {after:?}");

    // Its variant reads the depth map: the cube keeps its color, the sky does not.
    let far_only = Tint { far_only: true, ..default() };
    let (far, ran) = picture(&mut headless, camera, far_only);
    assert!(ran, "the variant did not run");
    assert_eq!(far.get_pixel(48, 32), before, "the nearest thing");
    assert_eq!(far.get_pixel(2, 2), tinted.get_pixel(2, 2), "the sky");

    // A style file has it: for the app, not for the crate alone.
    let registry = headless.app.world().resource::<EffectRegistry>().clone();
    let style = registry.style_from_ron(STYLE).expect("the page's style");
    let tint = style.get::<Tint>().expect("its tint");
    assert_eq!((tint.amount, tint.far_only), (0.6, false));
    let error = ComicStyle::from_ron(STYLE).expect_err("no effect of this crate");
    assert!(error.to_string().contains("`tint`"), "{error}");
    let text = style.to_ron().expect("written");
    let again = registry.style_from_ron(&text).expect("read again");
    assert_eq!(again.get::<Tint>(), style.get());
    let handle = headless.app.world().resource::<AssetServer>().load("styles/amber.comic.ron");
    headless.app.world_mut().entity_mut(camera).insert(Comic(handle));
    for _ in 0..500 {
        headless.step(1);
        if headless.app.world().get::<Tint>(camera) == style.get() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(headless.app.world().get::<Tint>(camera), style.get(), "from the file");
    let (styled, ran) = picture(&mut headless, camera, ());
    assert!(ran && styled != tinted && styled != original);

    // It has a transition, a debug view, and a place in the shader.
    headless.app.world_mut().run_system_once::<_, (), _>(dusk).expect("run");
    let frame = std::time::Duration::from_millis(100);
    headless.app.insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(frame));
    headless.step(25);
    assert_eq!(headless.app.world().get::<Tint>(camera).expect("there").amount, 1.0);
    let half = Tint { amount: 0.5, ..default() };
    let (view, _) = picture(&mut headless, camera, (half, DebugView::Effect("tint")));
    assert!(view.get_pixel(48, 32)[0].abs_diff(128) <= 1, "{:?}", view.get_pixel(48, 32));
    let world = headless.app.world_mut();
    world.run_system_once(log_tint).expect("run");
    world.run_system_once(print_shader).expect("run");
}
"##;

/// The page's program as it stands, as a module of the outside crate, and a module that runs it
/// without a window.
pub fn files() -> Vec<File> {
    let page = Path::new(ROOT).join("docs/your-own-effect.md");
    let page = fs::read_to_string(page).expect("the page");
    let rust = blocks(&page, "rust");
    let [effect, main, functions @ ..] = rust.as_slice() else {
        panic!("{} blocks of Rust", rust.len());
    };
    let wgsl = blocks(&page, "wgsl");
    let style = blocks(&page, "ron");
    let headless = format!("{HEADLESS}\n{}", functions.join("\n"));
    vec![
        ("src/printed/page/mod.rs", (*main).to_owned()),
        ("src/printed/page/tint.rs", (*effect).to_owned()),
        ("src/printed/page/tint.wgsl", wgsl[0].to_owned()),
        ("assets/styles/amber.comic.ron", style[0].to_owned()),
        ("src/own_effect.rs", headless),
    ]
}

#[test]
#[ignore = "long: compiles and links a crate"]
fn the_effect_of_the_page_runs_in_a_crate_of_its_own() {
    let shader = outside::run("own_effect");
    for part in [
        "#ifdef EFFECT_TINT\n",
        "#ifdef VIEW_EFFECT_TINT\n",
        "my_game::tint",
    ] {
        assert!(shader.contains(part), "{part:?} is not in\n{shader}");
    }
}

/// The example's effect leaves the lines at its distance as they are, and takes ink from all
/// others.
#[test]
fn an_effect_of_a_game_thins_lines() {
    let size = UVec2::new(96, 64);
    let plugin = EffectPlugin::<Emphasis>::default();
    let mut small = Small::with_plugins(options(size), Msaa::Off, plugin);
    small.clear();
    small.insert((Transform::IDENTITY, Projection::default()));
    for (side, z) in [(-1.0, 4.0), (1.0, 20.0)] {
        let at = Transform::from_xyz(0.3 * side * z, 0.0, -z).with_scale(Vec3::splat(0.3 * z));
        small.put(Rectangle::new(1.0, 1.0), unlit(Color::WHITE), at);
    }
    // Of the left and of the right half.
    let ink = |small: &mut Small, style: ComicStyle| {
        let picture = small.shot(&style);
        [0..size.x / 2, size.x / 2..size.x].map(|columns| {
            let pixels = columns.flat_map(|x| (0..size.y).map(move |y| (x, y)));
            black_ink(&picture, pixels)
        })
    };
    let none = ink(&mut small, ComicStyle::new());
    let mut ink = |style| {
        let found = ink(&mut small, style);
        [found[0] - none[0], found[1] - none[1]]
    };
    let lines = ComicStyle::new().with(Outlines::default());
    let whole = ink(lines.clone());
    let near = lines.with(Emphasis {
        amount: 0.9,
        distance: 4.0,
    });
    let left = ink(near);
    assert!(whole[1] > 20.0, "{whole:?}");
    assert_eq!(left[0], whole[0]);
    assert!(left[1] < 0.2 * whole[1], "{left:?} of {whole:?}");
}
