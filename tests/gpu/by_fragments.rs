//! On a device without storage textures, and in views whose lines are larger than a buffer may be, lines are
//! found and drawn by fragment shaders: slower, neither linked nor smooth, without weight, boil, fog and
//! budget, but otherwise the same. The range is still found by compute shaders.

use bevy_comics_testkit::{device::gpu, work::along_cracks};

use crate::prelude::*;

/// No multiple of the widths and heights of blocks, cells and tiles.
const SIZE: UVec2 = UVec2::new(157, 91);

/// An app in which an error of the renderer is a panic.
fn with_limits(size: UVec2, limits: Option<wgpu::Limits>) -> Studio {
    let options = HeadlessOptions {
        size,
        limits,
        ..default()
    };
    let mut studio = Studio::with_plugins(BuiltIn::Teapot, options, Msaa::Off, ComicsPlugin);
    let fails = RenderErrorHandler(|error, _, _| panic!("{}", error.description));
    studio.headless.app.insert_resource(fails);
    studio
}

fn studio(by_fragments: bool) -> Studio {
    let limits = by_fragments.then(|| wgpu::Limits {
        max_storage_textures_per_shader_stage: 0,
        ..gpu().device.limits()
    });
    with_limits(SIZE, limits)
}

/// Whether the lines of the last picture were drawn without compute shaders.
fn is_by_fragments(studio: &Studio) -> bool {
    let world = studio.headless.app.world();
    let diagnostics = world.resource::<ComicsDiagnostics>();
    diagnostics.cameras[&studio.camera].outcome(ComicsStage::SearchTiles)
        == Some(StageOutcome::Skipped(SkipReason::NoComputeShaders))
}

/// Fails unless a picture shows the same lines as another one, and that one shows any.
fn assert_same(
    name: &str,
    plain: &image::RgbaImage,
    wanted: &image::RgbaImage,
    found: &image::RgbaImage,
) {
    let far = (wanted.as_raw().iter().zip(found.as_raw()))
        .filter(|(a, b)| a.abs_diff(**b) > 1)
        .count();
    let inked = (plain.as_raw().iter().zip(wanted.as_raw())).filter(|(a, b)| a != b);
    assert!(inked.count() > 500, "{name} draws nothing");
    // Lines blended over the picture may round differently.
    assert_eq!(far, 0, "{name}: {far} values differ");
}

fn outlines(width: f32) -> ComicStyle {
    ComicStyle::new().with(Outlines {
        width,
        ..along_cracks()
    })
}

fn styles() -> [(&'static str, ComicStyle); 4] {
    [
        ("outlines", outlines(2.0)),
        ("wider outlines", outlines(16.0)),
        ("sketch", outlines(1.5).with(Sketch::default())),
        ("contours", ComicStyle::new().with(Contours::default())),
    ]
}

/// The parts of [`styles`], and lines of a width between theirs.
fn more_styles() -> [(&'static str, ComicStyle); 3] {
    [
        ("wide outlines", outlines(3.0)),
        (
            "creases alone",
            ComicStyle::new().with(Outlines {
                silhouettes: None,
                objects: None,
                width_fade: 0.5,
                ..along_cracks()
            }),
        ),
        (
            "object edges alone",
            ComicStyle::new().with(Outlines {
                silhouettes: None,
                creases: None,
                ..along_cracks()
            }),
        ),
    ]
}

fn check(styles: &[(&str, ComicStyle)]) {
    let mut apps = [false, true].map(studio);
    // Both: sketches change with the clock.
    let [plain, _] = apps.each_mut().map(|app| app.shoot(None));
    let [mut with, mut without] = apps;
    for (name, style) in styles {
        let wanted = with.shoot(Some(style));
        let picture = without.shoot(Some(style));
        assert!(is_by_fragments(&without), "{name}");
        assert_same(name, &plain, &wanted, &picture);
    }
}

#[test]
fn lines_without_compute_passes_are_the_same() {
    check(&styles());
}

#[test]
fn parts_of_lines_without_compute_passes_are_the_same() {
    check(&more_styles());
}

/// Gives a camera a target of another size.
fn resize(studio: &mut Studio, size: UVec2) {
    studio.headless.resize(size, 1.0);
    let target = studio.headless.render_target();
    let world = studio.headless.app.world_mut();
    world.entity_mut(studio.camera).insert(target);
}

/// Eight bytes a pixel are more than the device binds: in this view alone, lines are drawn by fragments.
#[test]
fn lines_of_a_view_larger_than_a_buffer_are_the_same() {
    let large = UVec2::new(229, 151);
    let most: u64 = 1 << 18;
    assert!(8 * u64::from(large.x * large.y) > most && 8 * u64::from(SIZE.x * SIZE.y) < most);
    let limits = wgpu::Limits {
        max_storage_buffer_binding_size: most,
        ..gpu().device.limits()
    };
    let mut without = with_limits(SIZE, Some(limits));
    without.shoot(Some(&outlines(2.0)));
    assert!(!is_by_fragments(&without), "the small view is not searched");
    resize(&mut without, large);
    let mut with = with_limits(large, None);
    let plain = with.shoot(None);
    for width in [2.0, 16.0] {
        let (name, style) = (format!("width {width}"), outlines(width));
        let wanted = with.shoot(Some(&style));
        let picture = without.shoot(Some(&style));
        assert!(is_by_fragments(&without), "{name}");
        assert!(!is_by_fragments(&with), "{name}");
        assert_same(&name, &plain, &wanted, &picture);
    }
}

/// Without compute passes, lines are as if they had no weight, however small it is.
#[test]
fn lines_without_compute_passes_have_no_weight() {
    let mut without = studio(true);
    let even = Outlines {
        width: 8.0,
        ..along_cracks()
    };
    let weighted = |factor| Outlines {
        weight: LineWeight {
            outer: factor,
            inner: factor,
            crease: factor,
            object: factor,
            taper: 12.0,
            ..LineWeight::EVEN
        },
        ..even
    };
    let wanted = without.shoot(Some(&ComicStyle::new().with(even)));
    for factor in [0.0, 0.25, 2.0] {
        let style = ComicStyle::new().with(weighted(factor));
        let picture = without.shoot(Some(&style));
        assert!(picture == wanted, "{factor}");
    }
}
