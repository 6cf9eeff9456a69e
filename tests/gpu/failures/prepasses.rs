//! Prepasses: when this crate inserts and removes them.

use bevy::{pbr::ScreenSpaceAmbientOcclusion, render::renderer::RenderInstance};

use crate::prelude::*;

fn remove<B: Bundle>(small: &mut Small) {
    small.camera_mut().remove::<B>();
}

/// An app whose pipelines compile in the background, as in a game.
pub fn in_background() -> Small {
    let options = HeadlessOptions {
        background_pipelines: true,
        ..options(size())
    };
    Small::with(options, Msaa::Off)
}

pub fn step(small: &mut Small) {
    small.headless.step(1);
    std::thread::sleep(Duration::from_millis(5));
}

pub fn is_compiling(small: &Small) -> bool {
    let world = small.headless.app.world();
    let diagnostics = world.resource::<ComicsDiagnostics>();
    diagnostics.is_compiling(small.camera)
}

/// Renders until all pipelines are compiled, the style is complete, and the picture
/// no longer changes.
pub fn still(small: &mut Small) -> image::RgbaImage {
    small.headless.step(2);
    let mut last = small.picture();
    let mut unchanged = 0;
    for _ in 0..4000 {
        step(small);
        let now = small.picture();
        let same = now == last && !is_compiling(small) && !small.headless.is_compiling();
        unchanged = if same { unchanged + 1 } else { 0 };
        last = now;
        if unchanged == 10 {
            return last;
        }
    }
    panic!("the picture does not come to rest");
}

/// A change from a style that reads depth to one that does not: the first is drawn
/// until the pipeline of the second is ready. Regression: the prepass was removed
/// at once, and the original picture was shown.
#[test]
fn a_style_keeps_its_prepass_until_the_next_one_is_compiled() {
    let mut small = in_background();
    let bare = still(&mut small);
    small.insert(Desaturation::default());
    let gray = still(&mut small);
    assert_ne!(gray, bare);
    remove::<Desaturation>(&mut small);
    small.insert(Colorization {
        amount: 0.9,
        ..Colorization::SEPIA
    });
    let mut waited = 0;
    for _ in 0..4000 {
        step(&mut small);
        let picture = small.picture();
        assert_ne!(picture, bare, "the bare picture after {waited} frames");
        if picture != gray {
            break;
        }
        waited += 1;
    }
    assert!(waited > 0, "there was nothing to wait for");
    let sepia = still(&mut small);
    assert_ne!(sepia, gray);
    assert!(!small.has::<DepthPrepass>(), "nothing reads depth any more");
}

/// The normal prepass stays as long as creases are drawn.
#[test]
fn creases_keep_their_normals_until_the_next_style_is_compiled() {
    let mut small = in_background();
    small.insert(Outlines {
        creases: Some(Creases::default()),
        objects: None,
        ..default()
    });
    let creased = still(&mut small);
    small.insert(Outlines {
        creases: None,
        objects: None,
        width: 3.0,
        ..default()
    });
    // Without the prepass the engine compiles its mesh pipelines again and draws
    // no mesh until they are ready. This crate has no influence on that.
    let mut frames = vec![];
    for _ in 0..4000 {
        step(&mut small);
        if !small.has::<NormalPrepass>() {
            break;
        }
        frames.push(small.picture());
    }
    let plain = still(&mut small);
    assert_ne!(plain, creased);
    assert!(frames.contains(&creased), "there was nothing to wait for");
    for (i, frame) in frames.iter().enumerate() {
        assert!(
            *frame == creased || *frame == plain,
            "frame {i} shows neither look"
        );
    }
    assert!(!small.has::<NormalPrepass>() && small.has::<DepthPrepass>());
}

/// A prepass that a component of the game requires stays when the style is
/// removed. Regression: it was removed, and the engine panicked.
#[test]
fn a_prepass_that_ambient_occlusion_requires_stays() {
    let mut small = Small::new(size(), Msaa::Off);
    small.insert(Outlines::default()).settle();
    assert!(small.has::<DepthPrepass>() && small.has::<NormalPrepass>());
    small
        .insert(ScreenSpaceAmbientOcclusion::default())
        .settle();
    remove::<Outlines>(&mut small);
    small.settle();
    small.settle();
    assert!(small.has::<DepthPrepass>() && small.has::<NormalPrepass>());
    // Without that component nothing needs the prepass that this crate inserted.
    remove::<ScreenSpaceAmbientOcclusion>(&mut small);
    small.settle();
    assert!(!small.has::<DepthPrepass>() && !small.has::<NormalPrepass>());
}

/// A prepass that the game inserts is never removed, even if this crate had
/// inserted it before.
#[test]
fn a_prepass_of_the_game_stays() {
    for is_first in [true, false] {
        let mut small = Small::new(size(), Msaa::Off);
        if is_first {
            small.insert(DepthPrepass);
        }
        small.insert(Contours::default()).settle();
        small.insert(DepthPrepass).settle();
        remove::<Contours>(&mut small);
        small.settle().settle();
        assert!(small.has::<DepthPrepass>(), "first: {is_first}");
    }
}

/// Mean difference of two pictures in display codes.
fn mean_apart(a: &image::RgbaImage, b: &image::RgbaImage) -> f64 {
    let codes = a.as_raw().iter().zip(b.as_raw());
    codes.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.as_raw().len() as f64
}

/// How many buffers and textures the renderer has.
pub fn allocated(small: &Small) -> [usize; 2] {
    let instance = small.render_world().resource::<RenderInstance>();
    let report = instance.generate_report();
    let report = report.expect("wgpu's own backends report");
    let hub = report.hub_report();
    [hub.buffers.num_allocated, hub.textures.num_allocated]
}

/// A change of style keeps the state of the smoothed range and allocates nothing
/// while the new pipeline compiles.
#[test]
fn a_switch_keeps_the_range_and_allocates_nothing_while_it_compiles() {
    let mut small = in_background();
    // The smoothed range needs minutes to follow.
    let slow = DepthMap {
        smoothing: Some(RangeSmoothing {
            expand: 60.0,
            shrink: 60.0,
            ..default()
        }),
        ..default()
    };
    small.insert((slow, Desaturation::default()));
    let before_move = still(&mut small);
    // The camera moves back: the range lags, so everything is far.
    let mut camera = small.camera_mut();
    let mut transform = camera.get_mut::<Transform>().expect("placed");
    let back = transform.back() * 12.0;
    transform.translation += back;
    small.headless.step(4);
    let lagging = small.picture();
    assert!(mean_apart(&lagging, &before_move) > 1.0);

    small.headless.step(8);
    let [buffers, textures] = allocated(&small);
    small.insert(ToneBands {
        amount: 0.01,
        ..default()
    });
    let mut waited = 0;
    for _ in 0..4000 {
        small.headless.step(1);
        if !is_compiling(&small) && small.ran(ComicsStage::of::<ToneBands>()) {
            break;
        }
        if is_compiling(&small) {
            waited += 1;
            let now = allocated(&small);
            // Reading the picture back, and the engine, may hold a few more
            // buffers for a frame or two.
            assert!(
                now[0] <= buffers + 4 && now[1] <= textures + 1,
                "{buffers} and {textures} grew to {now:?} after {waited} frames"
            );
        }
    }
    assert!(waited > 0, "there was nothing to wait for");
    remove::<ToneBands>(&mut small);
    small.headless.step(6);
    let after = small.picture();
    // For comparison: the picture with a range that was just found.
    small.insert(DepthMap {
        smoothing: None,
        ..slow
    });
    small.headless.step(6);
    let anew = small.picture();
    let kept = mean_apart(&after, &lagging);
    let lost = mean_apart(&anew, &lagging);
    assert!(
        kept < 0.25 * lost,
        "the range jumped: {kept} codes, {lost} for a range found anew"
    );
}

/// A style that is removed before its first pipeline is ready leaves nothing
/// behind. Regression: its requests stayed and were drawn when the pipeline came.
#[test]
fn a_style_that_goes_before_its_pipeline_comes_leaves_nothing() {
    let mut small = in_background();
    let bare = still(&mut small);
    small.insert(Colorization {
        amount: 0.87,
        ..Colorization::SEPIA
    });
    small.headless.step(1);
    assert!(is_compiling(&small) || small.picture() == bare);
    remove::<Colorization>(&mut small);
    assert_eq!(still(&mut small), bare);
    let world = small.headless.app.world();
    let diagnostics = world.resource::<ComicsDiagnostics>();
    assert!(!diagnostics.cameras.contains_key(&small.camera));
}

/// A prepass that the game removes is inserted again while a style reads it.
#[test]
fn a_prepass_that_is_taken_away_comes_back() {
    let mut small = Small::new(size(), Msaa::Off);
    small.insert(Contours::default()).settle();
    let inked = small.picture();
    remove::<DepthPrepass>(&mut small);
    small.settle();
    assert!(small.has::<DepthPrepass>());
    assert_eq!(small.picture(), inked);
    // This crate still removes it when no style reads it.
    remove::<Contours>(&mut small);
    small.settle();
    assert!(!small.has::<DepthPrepass>());
}

/// Ids are drawn in the first frame that reads them: once pipelines are compiled,
/// the first picture equals the last one.
#[test]
fn the_first_frame_with_ids_has_them() {
    let mut small = Small::new(size(), Msaa::Off);
    small.insert(Outlines::default()).settle();
    let lined = small.picture();
    remove::<Outlines>(&mut small);
    small.settle();
    small.insert(Outlines::default());
    small.headless.step(1);
    assert_eq!(small.picture(), lined);
}
