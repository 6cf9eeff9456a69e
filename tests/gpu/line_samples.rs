//! Lines of multisampled views: the sample of a pixel that they read.

use bevy_comics_testkit::reference::resolve::STANDARD_4;

use crate::{
    line_scenes::viewport,
    outlines::{ink, put, removed},
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
    walls::towards_the_sky_again,
};

const SIZE: u32 = 120;

/// An orthographic view with one unit per pixel of a white rectangle with silhouettes.
struct Strip {
    small: Small,
    rectangle: Entity,
}

impl Strip {
    fn new() -> Self {
        let mut small = Small::new(UVec2::splat(SIZE), Msaa::Sample4);
        towards_the_sky_again(&mut small, Msaa::Sample4);
        let square = Rectangle::new(1.0, 1.0);
        let rectangle = put(&mut small, square, Color::WHITE, Transform::IDENTITY);
        ink(&mut small, Outlines::SILHOUETTES);
        Self { small, rectangle }
    }

    /// The ink of the rectangle below the line of this angle through a point in pixels from the
    /// middle, y up.
    fn ink(&mut self, angle: f32, through: Vec2, [length, width]: [f32; 2]) -> Vec<f32> {
        let turn = Quat::from_rotation_z(angle);
        let middle = through.extend(-10.0) + turn * Vec3::new(0.0, -0.5 * width, 0.0);
        let at = Transform::from_translation(middle).with_rotation(turn);
        let at = at.with_scale(Vec3::new(length, width, 1.0));
        self.small.on(self.rectangle).insert(at);
        self.small.headless.step(1);
        removed(&self.small)
    }
}

/// A wire of 0.4 pixels has a line without gaps at every angle. The widest strip between
/// samples is 1 / sqrt(8) = 0.354 pixels, at 45 degrees: thinner wires can be missed. At a
/// fixed sample, a wire of 0.4 pixels is cut into five dashes on average.
#[test]
fn a_line_along_a_wire_is_whole() {
    assert_lines_of_wires_are_whole(&[(0.4, DEGREES), (0.6, &[33]), (0.9, &[33])]);
}

#[test]
#[ignore = "long: every width at every angle"]
fn a_line_along_a_wire_of_any_width_is_whole() {
    assert_lines_of_wires_are_whole(&[0.4, 0.6, 0.9].map(|width| (width, DEGREES)));
}

const DEGREES: &[u8] = &[0, 3, 10, 20, 33, 45, 60, 80, 100, 135, 177];

/// `wires`: widths and degrees.
fn assert_lines_of_wires_are_whole(wires: &[(f32, &[u8])]) {
    let mut strip = Strip::new();
    for &(width, angles) in wires {
        for &degrees in angles {
            for shift in [0.05, 0.55] {
                let angle = f32::from(degrees).to_radians();
                let along = Vec2::from_angle(angle);
                let through = along.perp() * shift;
                let all = strip.ink(angle, through, [100.0, width]);
                // Ink within one pixel of the wire, at every pixel along it.
                let is_bare = |t: &i32| {
                    let at = through + along * *t as f32;
                    let [x, y] = [60.0 + at.x, 60.0 - at.y].map(|v| v.floor() as usize);
                    let near = |x: usize, y: usize| all[y * SIZE as usize + x] > 0.5;
                    !(y - 1..=y + 1).any(|y| (x - 1..=x + 1).any(|x| near(x, y)))
                };
                let gaps: Vec<i32> = (-48..=48).filter(is_bare).collect();
                let what = format!("{width} px, {degrees} degrees, {shift}");
                assert!(gaps.is_empty(), "{what}: {gaps:?}");
            }
        }
    }
}

/// A silhouette is drawn as far outwards in every direction as the outermost sample: 0.35
/// to 0.4 pixels. At a fixed sample, it would be moved by that much to one side: inwards
/// at one end of an object, outwards at the other.
#[test]
fn a_silhouette_moves_outwards_alike_in_every_direction() {
    assert_silhouettes_move_outwards([0, 45, 180, 225]);
}

#[test]
#[ignore = "long: eight directions"]
fn a_silhouette_moves_outwards_alike_in_eight_directions() {
    assert_silhouettes_move_outwards((0..360).step_by(45));
}

fn assert_silhouettes_move_outwards(directions: impl IntoIterator<Item = u16>) {
    const STEPS: u16 = 8;
    let mut strip = Strip::new();
    for degrees in directions {
        let angle = f32::from(degrees).to_radians();
        let normal = Vec2::from_angle(angle).perp();
        // Distance between two rows of pixels across the edge: its place in between does
        // not count.
        let is_diagonal = degrees % 90 != 0;
        let rows = if is_diagonal { 0.5f32.sqrt() } else { 1.0 };
        let (mut sum, mut weight) = (0.0f64, 0.0f64);
        for step in 0..STEPS {
            let through = normal * rows * (f32::from(step) + 0.5) / f32::from(STEPS);
            let all = strip.ink(angle, through, [800.0, 400.0]);
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
        // The mean over eighths of a row is off by half an eighth at most.
        let apart = (sum / weight - f64::from(outermost)).abs();
        assert!(apart <= 0.5 / f64::from(STEPS), "{degrees}: {apart}");
    }
}

/// A plate in front of a wall, by a step that is only a faint silhouette: as two objects or as one
/// mesh, it has one line all around it. With the object of the first sample, object edges and borders
/// of sections ran a pixel beside the silhouette here and there.
#[test]
fn a_low_step_has_one_line() {
    let mut small = Small::new(UVec2::splat(SIZE), Msaa::Sample4);
    // 1.2 % of the distance from which a view of 45 degrees is as high as this one.
    let step = 0.012 * 0.5 * SIZE as f32 / 22.5f32.to_radians().tan();
    // Silhouettes that are object edges too; creases.
    for (is_one_mesh, kinds) in [(false, 5), (true, 2)] {
        for degrees in [6.0f32, 33.0, 66.0] {
            towards_the_sky_again(&mut small, Msaa::Sample4);
            let turn = Quat::from_rotation_z(degrees.to_radians());
            let at = Transform::from_xyz(1.3, 0.6, -100.0).with_rotation(turn);
            let mut wall = Mesh::from(Cuboid::new(200.0, 200.0, 5.0));
            let plate = Mesh::from(Cuboid::new(60.0, 40.0, 5.0)).translated_by(step * Vec3::Z);
            if is_one_mesh {
                wall.merge(&plate).expect("the same attributes");
            } else {
                put(&mut small, plate, Color::WHITE, at);
            }
            put(&mut small, wall, Color::WHITE, at);
            ink(&mut small, Outlines::default());

            let words = small.cracks().expect("lines").words;
            let what = format!("{degrees} degrees, one mesh: {is_one_mesh}");
            let found: BTreeSet<u32> = words.as_flattened().iter().map(|word| word & 7).collect();
            assert_eq!(found, BTreeSet::from([0, kinds]), "{what}");
            let is_line = |side: usize, x: u32, y: u32| words[(y * SIZE + x) as usize][side] != 0;
            for (x, y) in (1..SIZE).flat_map(|y| (1..SIZE).map(move |x| (x, y))) {
                // At the corner between four pixels.
                let east = [y - 1, y].map(|y| is_line(0, x - 1, y));
                let south = [x - 1, x].map(|x| is_line(1, x, y - 1));
                let meeting = [east, south]
                    .as_flattened()
                    .iter()
                    .filter(|is| **is)
                    .count();
                assert!(matches!(meeting, 0 | 2), "{what}: {meeting} at {x}, {y}");
            }
        }
    }
}

/// In a viewport of a larger target, in both forms.
#[test]
fn a_multisampled_viewport_matches_the_reference() {
    let mut small = Small::new(UVec2::new(90, 60), Msaa::Sample4);
    small.insert(viewport(UVec2::new(13, 7), UVec2::new(51, 41)));
    let faithful = Silhouettes {
        equations: Equations::Faithful,
        threshold: 0.0008,
        ..default()
    };
    for silhouettes in [Silhouettes::default(), faithful] {
        let style = outlined(Outlines {
            silhouettes: Some(silhouettes),
            ..default()
        });
        let viewport = Some([13, 7, 51, 41]);
        assert_pass_matches_the_reference(&mut small, &style, viewport, "viewport");
    }
}

/// Samples are picked only where there are several, and for lines alone.
#[test]
fn samples_are_picked_only_for_lines_of_multisampled_views() {
    let outcome = |small: &mut Small, style: &ComicStyle| {
        small.style(style);
        small.settle().outcome(ComicsStage::ResolveSamples)
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
}
