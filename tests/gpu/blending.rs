//! Transitions between styles: numbers, pictures, time.

use bevy::asset::Assets;
use bevy_comics::{
    StyleTransition,
    depth::RangeSmoothing,
    style::{StyleTransitionFinished, TransitionEasing},
};
use image::RgbaImage;
use proptest::{prelude::ProptestConfig, test_runner::TestRunner};

use crate::{failures::prepasses::still, prelude::*, styles::styles};

fn preset(name: &str) -> ComicStyle {
    let mut style = presets::find(name).expect(name).style();
    if let Some(sketch) = style.get_mut::<Sketch>() {
        // A new drawing of the sketch is not part of the transition.
        sketch.rate = 0.0;
    }
    style
}

#[test]
fn whatever_lies_between_two_styles_is_a_style() {
    let config = ProptestConfig {
        cases: 256,
        ..default()
    };
    let ways = (styles(), styles(), -0.5f32..1.5);
    TestRunner::new(config)
        .run(&ways, |(a, b, t)| {
            let between = a.blend(&b, t);
            if t <= 0.0 {
                assert_eq!(format!("{between:?}"), format!("{a:?}"));
            } else if t >= 1.0 {
                assert_eq!(format!("{between:?}"), format!("{b:?}"));
            } else {
                assert_eq!(between, between.sanitized(), "in its ranges at {t}");
            }
            assert_eq!(
                format!("{:?}", a.blend(&b, f32::NAN)),
                format!("{a:?}"),
                "no number is no way"
            );
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_rounded_number_and_a_smoothing_of_nothing_are_in_their_ranges() {
    let smoothing = |outliers| {
        ComicStyle::new().with_depth_map(DepthMap {
            smoothing: Some(RangeSmoothing {
                outliers,
                ..RangeSmoothing::OFF
            }),
            ..default()
        })
    };
    let iso_lines = |x| {
        ComicStyle::new().with(IsoLines {
            center: Vec3::new(x, 0.0, 0.0),
            ..default()
        })
    };
    for (a, b, t) in [
        (smoothing(f32::from_bits(1)), ComicStyle::new(), 0.9),
        (iso_lines(-1e6), iso_lines(-1e6), 0.006_012_224_6),
    ] {
        let between = a.blend(&b, t);
        assert_eq!(between, between.sanitized(), "{t}");
    }
}

fn mean_apart(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let sum: u64 = a
        .pixels()
        .zip(b.pixels())
        .map(|(a, b)| (0..3).map(|i| u64::from(a[i].abs_diff(b[i]))).sum::<u64>())
        .sum();
    sum as f64 / f64::from(a.width() * a.height() * 3)
}

/// At the ends, where effects begin and end, and in the middle, where modes
/// change, a small step changes the picture little: 0.001 of the transition moves
/// no pixel by more than that fraction plus the rounding of a code.
fn check_ways(size: UVec2, ways: &[(&str, &str)]) {
    let mut small = Small::new(size, Msaa::Off);
    for (from, to) in ways.iter().copied() {
        let (a, b) = (preset(from), preset(to));
        let whole = mean_apart(&small.shot(&a), &small.shot(&b));
        assert!(whole > 4.0, "{from} and {to} differ: {whole}");
        let step = 1.0 / 1024.0;
        for (before, after) in [
            (0.0, step),
            (0.5 - 0.5 * step, 0.5 + 0.5 * step),
            (1.0 - step, 1.0),
        ] {
            let pictures = [before, after].map(|t| small.shot(&a.blend(&b, t)));
            let apart = mean_apart(&pictures[0], &pictures[1]);
            assert!(
                apart < 1.0,
                "{from} to {to}: {apart} codes from {before} to {after}, of {whole} in all"
            );
        }
    }
}

/// From lines to a sketch: effects end, begin and take the place of others.
#[test]
fn no_picture_jumps_on_the_way() {
    check_ways(UVec2::new(64, 40), &[("ligne-claire", "pencil-sketch")]);
}

#[test]
#[ignore = "long: seven transitions"]
fn no_picture_jumps_on_any_way() {
    check_ways(
        UVec2::new(128, 80),
        &[
            ("ligne-claire", "pencil-sketch"),
            ("graphic-novel", "cobalt-night"),
            ("noir", "watercolor"),
            ("figure-7a", "figure-8b"),
            ("crimson-dusk", "twilight-toon"),
            ("blueprint", "clear-bands"),
            ("sepia", "misty-morning"),
        ],
    );
}

fn look(small: &Small) -> ComicStyle {
    let world = small.headless.app.world();
    ComicStyle::of(
        world.entity(small.camera),
        world.resource::<EffectRegistry>(),
    )
}

fn unnamed(style: &ComicStyle) -> ComicStyle {
    ComicStyle {
        name: String::new(),
        ..style.clone()
    }
}

/// Where styles are looked at, not pictures.
const TINY: UVec2 = UVec2::new(24, 16);

/// Styles with few pipelines, for tests of when a transition begins and ends.
fn three_styles() -> [ComicStyle; 3] {
    let style = |name: &str, width: f32| {
        let contours = Contours { width, ..default() };
        let mut style = ComicStyle::new().with(contours);
        style.name = name.into();
        style.with_depth_map(DepthMap::default())
    };
    [
        style("first", 1.5),
        style("second", 3.5).with(Desaturation::default()),
        style("third", 2.5).with(Colorization::SEPIA),
    ]
}

#[derive(Resource, Default)]
struct Arrivals(Vec<Entity>);

#[test]
fn a_transition_takes_its_time_and_arrives() {
    let mut small = Small::new(TINY, Msaa::Off);
    small.headless.app.init_resource::<Arrivals>().add_observer(
        |arrived: On<StyleTransitionFinished>, mut arrivals: ResMut<Arrivals>| {
            arrivals.0.push(arrived.entity);
        },
    );
    let arrivals = |small: &Small| small.headless.app.world().resource::<Arrivals>().0.len();
    let [a, b, c] = three_styles();
    small.style(&a).settle();
    // The test clock advances 1/60 s per frame.
    let slow = StyleTransition::to(b.clone(), 1.0).with_easing(TransitionEasing::Linear);
    small.insert(slow);
    small.headless.step(31);
    let half = look(&small);
    assert!(small.has::<StyleTransition>() && half != unnamed(&a) && half != unnamed(&b));
    let want = unnamed(&a).blend(&b, 0.5);
    let [found, want] = [&half, &want].map(|s| s.get::<Contours>().expect("contours").width);
    assert!((found - want).abs() < 0.05, "{found}, {want}");

    // A second transition starts from the current state.
    small.insert(StyleTransition::to(c.clone(), 0.5));
    small.headless.step(1);
    assert_eq!(
        look(&small).get::<Contours>(),
        half.get::<Contours>(),
        "it starts where the last one was"
    );
    small.headless.step(40);
    assert!(!small.has::<StyleTransition>());
    assert_eq!(look(&small), unnamed(&c), "it arrives exactly");
    assert_eq!(
        arrivals(&small),
        1,
        "the one that was replaced did not arrive"
    );

    // A duration of zero, and NaN.
    for seconds in [0.0, -1.0, f32::NAN] {
        small.insert(StyleTransition::to(a.clone(), seconds));
        small.headless.step(2);
        assert_eq!(look(&small), unnamed(&a), "{seconds}");
        small.insert(StyleTransition::to(b.clone(), 0.0));
        small.headless.step(2);
    }
    // A despawned camera ends its transition.
    small.insert(StyleTransition::to(a, 1.0));
    small.headless.step(2);
    let camera = small.camera;
    small.world().despawn(camera);
    small.headless.step(3);
}

/// A paused game pauses its transitions, except for those in real time.
#[test]
fn a_transition_in_real_time_runs_while_the_game_is_paused() {
    let mut small = Small::new(TINY, Msaa::Off);
    let [a, b, _] = three_styles();
    small.style(&a).settle();
    small.world().resource_mut::<Time<Virtual>>().pause();
    small.insert(StyleTransition::to(b.clone(), 0.5));
    small.headless.step(40);
    assert!(small.has::<StyleTransition>());
    small.insert(StyleTransition::to(b.clone(), 0.5).in_real_time());
    // The clock of the test advances by 1/60 s a frame.
    small.headless.step(30);
    assert!(small.has::<StyleTransition>());
    small.headless.step(4);
    assert_eq!(look(&small), unnamed(&b));
}

#[test]
fn a_transition_and_the_cameras_file_agree() {
    let mut small = Small::new(TINY, Msaa::Off);
    let [a, b, c] = three_styles();
    let mut files = small.world().resource_mut::<Assets<ComicStyle>>();
    let [first, second] = [a, b.clone()].map(|style| files.add(style));
    small.insert(Comic(first)).settle();
    small.insert(StyleTransition::to_asset(second.clone(), 0.1));
    small.headless.step(12);
    assert_eq!(look(&small), unnamed(&b));
    let handle = small.headless.app.world().get::<Comic>(small.camera);
    assert_eq!(handle, Some(&Comic(second.clone())));

    // A transition to a style without a file: the old file no longer applies.
    small.insert(StyleTransition::to(c.clone(), 0.0));
    small.headless.step(3);
    assert_eq!(look(&small), unnamed(&c));
    let mut files = small.world().resource_mut::<Assets<ComicStyle>>();
    let mut style = files.get_mut(&second).expect("the second file");
    style.remove::<Desaturation>();
    style.remove::<Contours>();
    drop(style);
    small.headless.step(4);
    assert_eq!(look(&small), unnamed(&c), "a file that it left is not read");

    // A file that cannot be read ends the transition at its current state.
    let server = small.world().resource::<AssetServer>();
    let missing = server.load("styles/no-such-file.comic.ron");
    small.insert(StyleTransition::to_asset(missing, 0.1));
    for _ in 0..200 {
        small.headless.step(1);
        std::thread::sleep(Duration::from_millis(2));
        if !small.has::<StyleTransition>() {
            break;
        }
    }
    assert!(!small.has::<StyleTransition>());
    assert_eq!(look(&small), unnamed(&c));
}

/// While pipelines compile in the background, as in a game, a change of style
/// never shows the original picture.
#[test]
fn a_style_stays_until_the_next_one_is_compiled() {
    let background = HeadlessOptions {
        background_pipelines: true,
        ..options(size())
    };
    let mut small = Small::with(background, Msaa::Off);
    let until_complete = |small: &mut Small| {
        for _ in 0..2000 {
            small.headless.step(1);
            let diagnostics = small.headless.app.world().resource::<ComicsDiagnostics>();
            if small.ran(ComicsStage::Stylize) && !diagnostics.is_compiling(small.camera) {
                return;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        panic!("the pipelines do not compile");
    };
    small.insert(Desaturation::default());
    until_complete(&mut small);
    let gray = still(&mut small);
    small.insert(Contours {
        width: 3.3,
        opacity_fade: 0.2,
        ..default()
    });
    let mut frames = Vec::new();
    for _ in 0..4000 {
        small.headless.step(1);
        frames.push(small.picture());
        if frames.last() != Some(&gray) {
            break;
        }
    }
    until_complete(&mut small);
    let inked = still(&mut small);
    assert_ne!(inked, gray);
    let waited = frames.iter().filter(|frame| **frame == gray).count();
    for (i, frame) in frames.iter().enumerate() {
        assert!(
            *frame == gray || *frame == inked,
            "frame {i} shows neither look: {:.3} codes from the old, {:.3} from the new",
            mean_apart(frame, &gray),
            mean_apart(frame, &inked)
        );
    }
    assert!(waited > 0, "there was something to wait for");
}
