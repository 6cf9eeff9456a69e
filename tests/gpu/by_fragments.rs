//! On a device without storage textures, and in views whose lines are larger than a buffer may be,
//! lines are found and drawn by fragment shaders: slower, neither linked nor smooth, without
//! weight, boil, fog and budget, but otherwise the same. The range is still found by compute
//! shaders.

use bevy_comics::lines::EdgeStyle;
use bevy_comics_testkit::{device::gpu, work::along_cracks};

use image::RgbaImage;

use crate::prelude::*;

/// No multiple of the widths and heights of blocks, cells and tiles.
const SIZE: UVec2 = UVec2::new(157, 91);

/// The small scene, with round things and another box.
fn scene(size: UVec2, limits: Option<wgpu::Limits>) -> Small {
    let options = HeadlessOptions {
        size,
        limits,
        ..default()
    };
    let mut small = Small::with(options, Msaa::Off);
    let blue = || unlit(Color::srgb(0.3, 0.4, 0.8));
    let ball = Sphere::new(0.6).mesh().uv(32, 18);
    small.put(ball, blue(), Transform::from_xyz(0.3, 0.9, 2.2));
    let turned = Quat::from_euler(EulerRot::YXZ, 0.4, 0.9, 0.0);
    let ring = Transform::from_xyz(-1.2, 1.8, 0.4).with_rotation(turned);
    small.put(Torus::new(0.3, 0.8), blue(), ring);
    let aside = Transform::from_xyz(1.9, 1.6, 0.6).with_rotation(turned);
    small.put(Cuboid::from_length(1.2), blue(), aside);
    small
}

fn limited() -> Small {
    let limits = wgpu::Limits {
        max_storage_textures_per_shader_stage: 0,
        ..gpu().device.limits()
    };
    scene(SIZE, Some(limits))
}

/// Whether the lines of the last picture were drawn without compute shaders.
fn is_by_fragments(small: &Small) -> bool {
    let world = small.headless.app.world();
    let diagnostics = world.resource::<ComicsDiagnostics>();
    diagnostics.cameras[&small.camera].outcome(ComicsStage::SearchTiles)
        == Some(StageOutcome::Skipped(SkipReason::NoComputeShaders))
}

/// Fails unless the app without compute passes draws the same lines as the other one, and these
/// any.
fn assert_same(with: &mut Small, without: &mut Small, plain: &RgbaImage, named: &Named) {
    let (name, style) = named;
    let [wanted, found] = [&mut *with, &mut *without].map(|small| small.shot(style));
    assert!(is_by_fragments(without) && !is_by_fragments(with), "{name}");
    let far = (wanted.as_raw().iter().zip(found.as_raw()))
        .filter(|(a, b)| a.abs_diff(**b) > 1)
        .count();
    let inked = (plain.as_raw().iter().zip(wanted.as_raw())).filter(|(a, b)| a != b);
    let inked = inked.count();
    assert!(inked > 500, "{name} draws {inked} values");
    // Lines blended over the picture may round differently.
    assert_eq!(far, 0, "{name}: {far} values differ");
}

/// A style and its name.
type Named = (&'static str, ComicStyle);

fn outlines(width: f32) -> ComicStyle {
    ComicStyle::new().with(Outlines {
        width,
        ..along_cracks()
    })
}

fn check(styles: &[Named]) -> Small {
    let (mut with, mut without) = (scene(SIZE, None), limited());
    let plain = with.shot(&ComicStyle::new());
    for named in styles {
        assert_same(&mut with, &mut without, &plain, named);
    }
    without
}

#[test]
fn lines_without_compute_passes_are_the_same() {
    let still = Sketch {
        rate: 0.0,
        ..default()
    };
    check(&[
        ("outlines", outlines(2.0)),
        ("wider outlines", outlines(16.0)),
        ("sketch", outlines(1.5).with(still)),
        ("contours", ComicStyle::new().with(Contours::default())),
    ]);
}

/// Lines are also as if they had no weight, however small it is.
#[test]
fn parts_of_lines_without_compute_passes_are_the_same() {
    let creases = Outlines {
        silhouettes: None,
        objects: None,
        width_fade: 0.5,
        ..along_cracks()
    };
    let object_edges = Outlines {
        silhouettes: None,
        creases: None,
        ..along_cracks()
    };
    // Convex and concave creases have no styles of their own.
    let signs = Outlines {
        creases: creases.creases.map(|creases| Creases {
            convex: Some(EdgeStyle::default()),
            ..creases
        }),
        ..creases
    };
    let mut without = check(&[
        ("creases alone", ComicStyle::new().with(creases)),
        ("object edges alone", ComicStyle::new().with(object_edges)),
    ]);
    let pictures = [creases, signs].map(|lines| without.shot(&ComicStyle::new().with(lines)));
    assert!(pictures[0] == pictures[1]);
    let even = Outlines {
        width: 8.0,
        ..along_cracks()
    };
    let wanted = without.shot(&ComicStyle::new().with(even));
    for factor in [0.0, 0.25, 2.0] {
        let weight = LineWeight {
            outer: factor,
            inner: factor,
            crease: factor,
            object: factor,
            taper: 12.0,
            ..LineWeight::EVEN
        };
        let style = ComicStyle::new().with(Outlines { weight, ..even });
        assert!(without.shot(&style) == wanted, "{factor}");
    }
}

/// Eight bytes a pixel are more than the device binds: in this view alone, lines are drawn by
/// fragments.
#[test]
fn lines_of_a_view_larger_than_a_buffer_are_the_same() {
    let large = UVec2::new(229, 151);
    let most: u64 = 1 << 18;
    assert!(8 * u64::from(large.x * large.y) > most && 8 * u64::from(SIZE.x * SIZE.y) < most);
    let limits = wgpu::Limits {
        max_storage_buffer_binding_size: most,
        ..gpu().device.limits()
    };
    let mut without = scene(SIZE, Some(limits));
    without.shot(&outlines(2.0));
    assert!(!is_by_fragments(&without), "the small view is not searched");
    without.headless.resize(large, 1.0);
    let target = without.headless.render_target();
    without.insert(target);
    let mut with = scene(large, None);
    let plain = with.shot(&ComicStyle::new());
    for (name, width) in [("2 px", 2.0), ("16 px", 16.0)] {
        assert_same(&mut with, &mut without, &plain, &(name, outlines(width)));
    }
}
