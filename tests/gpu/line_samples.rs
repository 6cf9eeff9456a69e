//! Lines of multisampled views: the sample of a pixel that they read.

use bevy_comics_testkit::reference::resolve::STANDARD_4;

use crate::{
    outlines::{ink, look, put, removed},
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
    walls::unit_per_pixel,
};

const SIZE: u32 = 120;

/// An empty orthographic view with one unit per pixel, and its origin in the middle.
fn empty(small: &mut Small) {
    small.clear();
    look(small, Vec3::ZERO, Vec3::NEG_Z, 0.1);
    let projection = unit_per_pixel(UVec2::splat(SIZE));
    small.insert(Projection::Orthographic(projection));
}

/// A white rectangle with silhouettes, for [`strip`].
fn rectangle() -> (Small, Entity) {
    let mut small = Small::new(UVec2::splat(SIZE), Msaa::Sample4);
    empty(&mut small);
    let square = Rectangle::new(1.0, 1.0);
    let square = put(&mut small, square, Color::WHITE, Transform::IDENTITY);
    ink(&mut small, Outlines::SILHOUETTES);
    (small, square)
}

/// The ink of a white rectangle below the line of this angle through a point in pixels from the
/// middle, y up.
fn strip(
    (small, square): &mut (Small, Entity),
    angle: f32,
    through: Vec2,
    [length, width]: [f32; 2],
) -> Vec<f32> {
    let turn = Quat::from_rotation_z(angle);
    let middle = through.extend(-10.0) + turn * Vec3::new(0.0, -0.5 * width, 0.0);
    let at = Transform::from_translation(middle).with_rotation(turn);
    let at = at.with_scale(Vec3::new(length, width, 1.0));
    small.world().entity_mut(*square).insert(at);
    small.headless.step(1);
    removed(small)
}

/// A wire of 0.4 pixels has a line without gaps at every angle. The widest strip between
/// samples is 1 / sqrt(8) = 0.354 pixels, at 45 degrees: thinner wires can be missed. At a
/// fixed sample, a wire of 0.4 pixels is cut into five dashes on average.
#[test]
fn a_line_along_a_wire_is_whole() {
    assert_wires_are_whole(&[0.05, 0.55]);
}

#[test]
#[ignore = "long: more places between pixels"]
fn a_line_along_a_wire_is_whole_wherever_it_is() {
    assert_wires_are_whole(&[0.05, 0.3, 0.55, 0.8]);
}

fn assert_wires_are_whole(shifts: &[f32]) {
    let mut scene = rectangle();
    for width in [0.4, 0.6, 0.9] {
        for degrees in [
            0.0f32, 3.0, 10.0, 20.0, 33.0, 45.0, 60.0, 80.0, 100.0, 135.0, 177.0,
        ] {
            for &shift in shifts {
                let along = Vec2::from_angle(degrees.to_radians());
                let through = along.perp() * shift;
                let all = strip(&mut scene, degrees.to_radians(), through, [100.0, width]);
                // Ink within one pixel of the wire, at every pixel along it.
                let inked = (-48..=48).map(|t| {
                    let at = through + along * t as f32;
                    let [x, y] = [60.0 + at.x, 60.0 - at.y].map(|v| v.floor() as usize);
                    let near = |x: usize, y: usize| all[y * SIZE as usize + x] > 0.5;
                    (y - 1..=y + 1).any(|y| (x - 1..=x + 1).any(|x| near(x, y)))
                });
                let inked: Vec<bool> = inked.collect();
                let gaps = inked.iter().filter(|inked| !**inked).count();
                assert_eq!(gaps, 0, "{width} px, {degrees} degrees, {shift}: {inked:?}");
            }
        }
    }
}

/// A silhouette is drawn as far outwards in every direction as the outermost sample: 0.35
/// to 0.4 pixels. At a fixed sample, it would be moved by that much to one side: inwards
/// at one end of an object, outwards at the other.
#[test]
fn a_silhouette_moves_outwards_alike_in_every_direction() {
    const STEPS: u32 = 8;
    let mut scene = rectangle();
    for degrees in (0..360).step_by(45) {
        let along = Vec2::from_angle((degrees as f32).to_radians());
        let normal = along.perp();
        // Distance between two rows of pixels across the edge: its place in between does
        // not count.
        let rows = if degrees % 90 == 0 {
            1.0
        } else {
            0.5f32.sqrt()
        };
        let (mut sum, mut weight) = (0.0f64, 0.0f64);
        for step in 0..STEPS {
            let through = normal * rows * (step as f32 + 0.5) / STEPS as f32;
            let angle = (degrees as f32).to_radians();
            let all = strip(&mut scene, angle, through, [800.0, 400.0]);
            for (i, ink) in all.into_iter().enumerate() {
                let [x, y] = [i as u32 % SIZE, i as u32 / SIZE].map(|v| v as f32 + 0.5);
                let at = Vec2::new(x - 60.0, 60.0 - y);
                if at.length() < 50.0 {
                    sum += f64::from(ink * normal.dot(at - through));
                    weight += f64::from(ink);
                }
            }
        }
        let outermost = STANDARD_4
            .map(|[x, y]| normal.dot(Vec2::new(x as f32, -y as f32)) / 16.0)
            .into_iter()
            .fold(0.0, f32::max);
        let moved = sum / weight;
        println!("{degrees} degrees: {moved:.3} px, outermost sample {outermost:.3} px");
        // The mean over eighths of a row is off by half an eighth at most.
        let apart = (moved - f64::from(outermost)).abs();
        assert!(
            apart <= 0.5 / f64::from(STEPS),
            "{degrees} degrees: {moved}"
        );
    }
}

/// In a viewport of a larger target, in both forms.
#[test]
fn a_multisampled_viewport_matches_the_reference() {
    let mut small = Small::new(UVec2::new(90, 60), Msaa::Sample4);
    small.insert(Camera {
        viewport: Some(Viewport {
            physical_position: UVec2::new(13, 7),
            physical_size: UVec2::new(51, 41),
            ..default()
        }),
        ..default()
    });
    let faithful = Outlines {
        silhouettes: Some(Silhouettes {
            equations: Equations::Faithful,
            threshold: 0.0008,
            ..default()
        }),
        ..default()
    };
    for outlines in [Outlines::default(), faithful] {
        let viewport = Some([13, 7, 51, 41]);
        assert_pass_matches_the_reference(&mut small, &outlined(outlines), viewport, "viewport");
    }
    assert_eq!(small.errors(), 0);
}

/// Samples are picked only where there are several, and for lines alone.
#[test]
fn samples_are_picked_only_for_lines_of_multisampled_views() {
    let outcome = |small: &mut Small, style: &ComicStyle| {
        small.style(style);
        small.settle();
        let diagnostics = small.headless.app.world().resource::<ComicsDiagnostics>();
        diagnostics.cameras[&small.camera].outcome(ComicsStage::ResolveSamples)
    };
    let lines = outlined(Outlines::default());
    let contours = ComicStyle::default().with(Contours::default());
    let left_out = |reason| Some(StageOutcome::Skipped(reason));
    let mut small = Small::new(size(), Msaa::Sample4);
    assert_eq!(outcome(&mut small, &lines), Some(StageOutcome::Ran));
    let none = outcome(&mut small, &contours);
    assert_eq!(none, left_out(SkipReason::NoSuchLines));
    small.restart(Msaa::Off);
    let single = outcome(&mut small, &lines);
    assert_eq!(single, left_out(SkipReason::SingleSampled));
    assert_eq!(small.errors(), 0);
}
