//! On a device without storage textures, lines are found and drawn by fragment shaders:
//! slower, neither linked nor smooth, without weight, boil, fog and budget, but otherwise the
//! same. The range is still found by compute shaders.

use bevy::{prelude::*, render::view::Msaa};
use bevy_comics::{
    ComicStyle, ComicsDiagnostics, ComicsPlugin, ComicsStage, Contours, LeftOut, LineWeight,
    Outlines, Sketch, StageOutcome,
};
use bevy_comics_testkit::{
    device::gpu, headless::HeadlessOptions, scenes::BuiltIn, studio::Studio, work::along_cracks,
};

fn studio(by_fragments: bool) -> Studio {
    let limits = by_fragments.then(|| wgpu::Limits {
        max_storage_textures_per_shader_stage: 0,
        ..gpu().device.limits()
    });
    let options = HeadlessOptions {
        // No multiple of the widths and heights of blocks, cells and tiles.
        size: UVec2::new(157, 91),
        limits,
        ..default()
    };
    Studio::with_plugins(BuiltIn::Teapot, options, Msaa::Off, ComicsPlugin)
}

#[test]
fn lines_without_compute_passes_are_the_same() {
    let outlines = |width: f32| {
        ComicStyle::new().with(Outlines {
            width,
            ..along_cracks()
        })
    };
    let styles = [
        ("outlines", outlines(2.0)),
        ("wide outlines", outlines(3.0)),
        ("wider outlines", outlines(16.0)),
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
        ("sketch", outlines(1.5).with(Sketch::default())),
        ("contours", ComicStyle::new().with(Contours::default())),
    ];
    let [mut with, mut without] = [false, true].map(studio);
    let plain = with.shoot(None);
    for (name, style) in &styles {
        let wanted = with.shoot(Some(style));
        let picture = without.shoot(Some(style));
        let world = without.headless.app.world();
        let diagnostics = world.resource::<ComicsDiagnostics>();
        assert_eq!(
            diagnostics.cameras[&without.camera].outcome(ComicsStage::SearchTiles),
            Some(StageOutcome::LeftOut(LeftOut::NoComputeShaders)),
            "{name}"
        );
        let far: Vec<u8> = (wanted.as_raw().iter().zip(picture.as_raw()))
            .map(|(a, b)| a.abs_diff(*b))
            .filter(|d| *d > 1)
            .collect();
        let inked = (plain.as_raw().iter().zip(wanted.as_raw())).filter(|(a, b)| a != b);
        assert!(inked.count() > 500, "{name} draws nothing");
        // Lines blended over the picture may round differently.
        assert!(far.is_empty(), "{name}: {} values differ", far.len());
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
