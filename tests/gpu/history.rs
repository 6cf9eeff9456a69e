//! The history of lines under temporal anti-aliasing: they stand still, and leave no ghosts.

use crate::{
    line_scenes::{mean, turned},
    outlines::{put, removed},
    prelude::*,
};

/// Width and height of the picture in pixels; a unit of the scene is a pixel.
const SIZE: usize = 120;
const HALF: f32 = 0.5 * SIZE as f32;

/// A white background, so that only lines change the picture.
fn empty() -> Small {
    let mut small = Small::new(UVec2::splat(SIZE as u32), Msaa::Off);
    small.empty_view(Msaa::Off, Color::WHITE);
    small.insert(TemporalAntiAliasing::default());
    small
}

/// A white wall in front of the background.
fn scene() -> (Small, Entity) {
    let mut small = empty();
    let at = turned(-3.0, 2.0, -HALF, 0.2);
    let wall = put(&mut small, Rectangle::new(61.3, 47.7), Color::WHITE, at);
    (small, wall)
}

/// Draws until all has settled.
fn outline(small: &mut Small, history_weight: f32, frames: usize) {
    outline_as(small, Outlines::SILHOUETTES, history_weight, frames);
}

fn outline_as(small: &mut Small, outlines: Outlines, history_weight: f32, frames: usize) {
    let outlines = Outlines {
        history_weight,
        ..outlines
    };
    small.style(&ComicStyle::default().with(outlines));
    small.headless.step(frames);
}

/// The number of tiles with ink in the left half, if drawing inks every pixel of a tile.
fn tiles(small: &mut Small) -> f64 {
    const TILE: f64 = 16.0 * 16.0;
    let left = (0..SIZE as u32).flat_map(|y| (0..64).map(move |x| (x, y)));
    black_ink(&small.picture(), left) / TILE
}

/// In an empty view no tile is drawn, from the first frame on; and none after the size of the
/// viewport has changed, when tiles are other parts of it.
#[test]
fn only_tiles_that_had_lines_are_drawn() {
    let mut small = Small::alone(options(UVec2::splat(SIZE as u32)), Msaa::Off);
    small.empty_view(Msaa::Off, Color::WHITE);
    small.insert(TemporalAntiAliasing::default());
    small.headless.step(2);
    let mut shaders = small.world().resource_mut::<Assets<Shader>>();
    let is_draw = |shader: &Shader| shader.path.ends_with("lines/draw/draw.wgsl");
    let draw = shaders.iter().find(|(_, shader)| is_draw(shader));
    let (id, text) = draw.map(|(id, s)| (id, s.source.as_str())).expect("it");
    let inked = text.replace("return drawn;", "drawn.ink = vec4(1.0);\n    return drawn;");
    let inked = Shader::from_wgsl(inked, "embedded://bevy_comics/lines/draw/draw.wgsl");
    let _ = shaders.insert(id, inked);
    outline(&mut small, 0.875, 1);
    for frame in 1..6 {
        assert_eq!(tiles(&mut small), 0.0, "frame {frame}");
        small.headless.step(1);
    }
    let at = turned(-3.0, 2.0, -HALF, 0.2);
    let wall = put(&mut small, Rectangle::new(61.3, 47.7), Color::WHITE, at);
    small.headless.step(4);
    assert!(tiles(&mut small) > 4.0);
    small.world().despawn(wall);
    small.headless.step(1);
    assert!(tiles(&mut small) > 4.0, "lines are in the history");
    small.camera_settings().viewport = Some(Viewport {
        physical_size: UVec2::new(64, SIZE as u32),
        ..default()
    });
    small.headless.step(1);
    assert_eq!(tiles(&mut small), 0.0, "another size");
}

/// The sum of ink in the picture.
fn total(small: &Small) -> f32 {
    removed(small).iter().sum()
}

/// The fraction of pixels that change by more than two codes from frame to frame, in two rounds of
/// the engine's offsets.
fn changes(small: &mut Small) -> f64 {
    const FRAMES: usize = 16;
    let mut before = small.picture();
    let mut count = 0;
    for _ in 0..FRAMES {
        small.headless.step(1);
        let now = small.picture();
        count += differ(&before, &now, 2);
        before = now;
    }
    count as f64 / (FRAMES * SIZE * SIZE) as f64
}

/// The distance of the wall's rim from a place, in pixels; positive inside.
fn inside(x: f64, y: f64) -> f64 {
    let half = f64::from(HALF);
    let [x, y] = [x - half + 3.0, half - y - 2.0];
    let (sin, cos) = f64::from(0.2f32).sin_cos();
    let [u, v] = [x * cos + y * sin, -x * sin + y * cos];
    (30.65 - u.abs()).min(23.85 - v.abs())
}

/// The width of a line in a column, and the row of its middle.
fn across(ink: &[f32], column: usize, rows: Range<usize>) -> [f64; 2] {
    let ink = |y: usize| f64::from(ink[y * SIZE + column]);
    let all: f64 = rows.clone().map(ink).sum();
    let moment: f64 = rows.map(|y| (y as f64 + 0.5) * ink(y)).sum();
    [all, moment / all]
}

/// Along the middle of each side: how far the middle of the line is from the rim, as a root
/// mean square in pixels.
fn error(small: &Small) -> f64 {
    let ink = removed(small);
    let squares = (40..75).flat_map(|column| {
        [15..60, 60..110].map(|rows| {
            let [_, middle] = across(&ink, column, rows);
            inside(column as f64 + 0.5, middle).powi(2)
        })
    });
    mean(&squares.collect::<Vec<f64>>()).sqrt()
}

#[test]
fn lines_of_a_still_view_stand_still() {
    let (mut small, _) = scene();
    let [(trembling, many), (still, few)] = [(0.0, 8), (0.875, 40)].map(|(weight, frames)| {
        outline(&mut small, weight, frames);
        (error(&small), changes(&mut small))
    });
    assert!(many > 0.001, "{many}: nothing trembles without history");
    assert!(few < 1e-4, "{few}");
    let is_still = still < 0.1 && still < 0.8 * trembling;
    assert!(is_still, "{still}, {trembling}");
}

/// Without a history, pixels change; with one, none does.
fn assert_stands_still(small: &mut Small, outlines: Outlines, least: f64) {
    let found = [(0.0, 16), (0.875, 150)].map(|(weight, frames)| {
        outline_as(small, outlines, weight, frames);
        assert!(total(small) > 50.0, "{}", total(small));
        changes(small)
    });
    assert!(found[0] > least && found[1] < 1e-4, "{found:?}");
}

/// A ledge of 0.4 pixels, whose creases are found at some of the engine's offsets only: its line
/// stands still too.
#[test]
#[ignore = "long: many frames until it stands still"]
fn lines_that_are_found_now_and_then_stand_still() {
    let mut small = empty();
    // Below the eye: a slab of the wall, whose top is seen.
    for (height, depth, at) in [
        (200.0, 1.0, turned(0.0, 0.0, -HALF - 1.5, 0.1)),
        (100.0, 1.4, turned(0.0, -67.0, -HALF - 0.3, 0.1)),
    ] {
        let slab = Cuboid::new(200.0, height, depth);
        put(&mut small, slab, Color::WHITE, at);
    }
    let outlines = Outlines {
        objects: None,
        ..default()
    };
    assert_stands_still(&mut small, outlines, 0.001);
}

/// Posts of 0.3 to 0.6 pixels, before the sky and before a wall, which are seen at some of the
/// engine's offsets only: their lines stand still too, and leave no ghosts for longer than two
/// rounds of offsets when they have gone.
#[test]
#[ignore = "long: many frames until it stands still"]
fn lines_of_surfaces_narrower_than_a_pixel_stand_still() {
    let mut small = empty();
    let at = Transform::from_xyz(0.0, -120.0, -2.0 * HALF);
    put(&mut small, Rectangle::new(300.0, 120.0), Color::WHITE, at);
    let posts = [(-31.2, 0.3), (-9.7, 0.4), (8.1, 0.5), (30.4, 0.6)].map(|(x, width)| {
        let at = turned(x, 0.0, -HALF, 0.03);
        put(&mut small, Rectangle::new(width, 80.0), Color::WHITE, at)
    });
    assert_stands_still(&mut small, Outlines::SILHOUETTES, 0.01);
    let before = removed(&small);
    for post in posts {
        small.world().despawn(post);
    }
    small.headless.step(20);
    let after = removed(&small);
    small.headless.step(60);
    // Away from the line of the wall.
    let alone = removed(&small);
    assert_no_ghost(&before, &after, 100.0, |i| alone[i] == 0.0);
}

/// Of the ink in pixels where no line is left there was `least`, and is less than a hundredth.
fn assert_no_ghost(before: &[f32], after: &[f32], least: f32, is_free: impl Fn(usize) -> bool) {
    let of = |ink: &[f32]| -> f32 {
        let free = (0..ink.len()).filter(|i| is_free(*i));
        free.map(|i| ink[i]).sum()
    };
    let [there, ghost] = [of(before), of(after)];
    assert!(there > least, "{there}");
    assert!(ghost < 0.01 * there, "{ghost} of {there}");
}

/// A wall that comes before another hides its lines at once.
#[test]
fn lines_that_are_covered_leave_no_ghosts() {
    let (mut small, _) = scene();
    outline(&mut small, 0.875, 40);
    assert!(total(&small) > 100.0);
    let at = Transform::from_xyz(0.0, 0.0, -0.5 * HALF);
    put(&mut small, Rectangle::new(500.0, 500.0), Color::WHITE, at);
    small.headless.step(4);
    let ghost = total(&small);
    assert!(ghost < 1.0, "{ghost}");
}

/// A wall that is gone has no lines in the next frame, also where another line is drawn: on
/// a wall behind it.
#[test]
fn lines_of_objects_that_vanish_leave_no_ghosts() {
    let (mut small, wall) = scene();
    for depth in [1.2, 1.5] {
        let behind = Rectangle::new(55.0 * depth, 50.0 * depth);
        let at = Transform::from_xyz(0.0, 0.0, -HALF * depth);
        put(&mut small, behind, Color::WHITE, at);
    }
    outline(&mut small, 0.125, 24);
    let before = removed(&small);
    small.world().despawn(wall);
    // The second frame is the first that is drawn without it.
    small.headless.step(2);
    let after = removed(&small);
    small.headless.step(12);
    let alone = removed(&small);
    // Away from the lines that are left.
    assert_no_ghost(&before, &after, 20.0, |i| {
        let is_near = |x: i64, y: i64| {
            let ink = alone.get((i as i64 + y * SIZE as i64 + x) as usize);
            ink.is_none_or(|ink| *ink > 0.0)
        };
        !(-2..=2).any(|y| (-2..=2).any(|x| is_near(x, y)))
    });
}

/// After a camera cut, nothing of the frame before is left.
#[test]
fn a_cut_forgets_lines() {
    let (mut small, _) = scene();
    outline(&mut small, 0.03125, 24);
    small.cut();
    small.insert(Transform::from_xyz(3.0, 1.0, 0.0));
    small.headless.step(1);
    let once = removed(&small);
    small.headless.step(40);
    let later = removed(&small);
    // A frame without history: each line may be half a pixel away.
    let apart = once.iter().zip(&later).map(|(a, b)| (a - b).abs());
    let found = apart.sum::<f32>();
    assert!(found < 0.5 * total(&small), "{found}");
}

/// Lines of an object that moves are where it is.
#[test]
fn lines_follow_what_moves() {
    let (mut small, wall) = scene();
    outline(&mut small, 0.875, 40);
    let middle = |small: &Small| {
        let ink = removed(small);
        let left = (0..60).map(|x| (ink[58 * SIZE + x], x as f32 + 0.5));
        let sum: f32 = left.clone().map(|(ink, _)| ink).sum();
        (left.map(|(ink, x)| ink * x).sum::<f32>() / sum, sum)
    };
    let (start, _) = middle(&small);
    for speed in [0.3f32, 1.7] {
        for step in 1..=10 {
            let mut at = small.world().get_mut::<Transform>(wall).expect("a wall");
            at.translation.x += if step <= 5 { speed } else { -speed };
            small.headless.step(1);
            let at = small.world().get::<GlobalTransform>(wall).expect("drawn");
            let want = start + at.translation().x + 3.0;
            let (found, ink) = middle(&small);
            let what = format!("{speed}, {step}: {found}, {want}, ink {ink}");
            assert!((found - want).abs() < 0.2, "{what}");
            assert!((1.8..2.2).contains(&ink), "{what}");
        }
    }
}

/// Lines are as dark while the camera moves: the history reads the last frame between its pixels,
/// and must not spread lines. As a mean of pictures without history, so that where lines lie
/// between pixels does not count.
#[test]
fn lines_are_as_dark_while_the_camera_moves() {
    assert_dark_while_moving(&[Vec3::new(0.37, 0.21, 0.0)]);
}

#[test]
#[ignore = "long: more ways to move"]
fn lines_are_as_dark_while_the_camera_moves_slowly_fast_or_forward() {
    assert_dark_while_moving(&[
        Vec3::new(0.13, 0.0, 0.0),
        Vec3::new(1.45, 0.0, 0.0),
        Vec3::new(0.05, 0.02, -0.4),
    ]);
}

/// How dark lines are: the mean ink of inked pixels, weighted by ink.
fn darkness(small: &Small) -> f32 {
    let ink = removed(small);
    let squares: f32 = ink.iter().map(|ink| ink * ink).sum();
    squares / ink.iter().sum::<f32>()
}

fn assert_dark_while_moving(steps: &[Vec3]) {
    let (mut small, _) = scene();
    for &step in steps {
        let [without, with] = [(0.0, 8), (0.875, 24)].map(|(history_weight, frames)| {
            small.insert(Transform::IDENTITY);
            outline(&mut small, history_weight, frames);
            let dark = (1..=24).map(|frame| {
                small.insert(Transform::from_translation(step * frame as f32));
                small.headless.step(1);
                darkness(&small)
            });
            dark.skip(8).sum::<f32>() / 16.0
        });
        assert!(with > 0.85 * without, "{step}: {with}, {without}");
    }
}

/// The standard deviation of values from the straight line of least squares through them.
fn deviation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = mean(values);
    let (mut cross, mut square) = (0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        cross += (i as f64 - middle) * (value - mean);
        square += (i as f64 - middle).powi(2);
    }
    let off = |(i, value): (usize, &f64)| value - mean - (i as f64 - middle) * cross / square;
    let squares: f64 = values.iter().enumerate().map(|v| off(v).powi(2)).sum();
    (squares / count).sqrt()
}

/// While the camera moves by a tenth of a pixel a frame, the width and the place of a line vary no
/// more along it with a history than without one: the history reads the last frame between its
/// pixels.
#[test]
fn a_slow_pan_keeps_lines_even() {
    let (mut small, _) = scene();
    // Only the history needs time, before the pan and at its start.
    let [without, with] = [(0.0, 8, 17), (0.875, 24, 1)].map(|(history_weight, frames, first)| {
        small.insert(Transform::IDENTITY);
        outline(&mut small, history_weight, frames);
        let mut sums = [0.0; 2];
        for frame in first..=48 {
            small.insert(Transform::from_xyz(0.1 * frame as f32, 0.0, 0.0));
            small.headless.step(1);
            // Four rounds of the engine's offsets.
            if frame > 16 {
                let ink = removed(&small);
                for (i, sum) in sums.iter_mut().enumerate() {
                    let column = |x| across(&ink, x, 15..60)[i];
                    *sum += deviation(&(40..70).map(column).collect::<Vec<f64>>()) / 32.0;
                }
            }
        }
        sums
    });
    for (without, with) in without.iter().zip(with) {
        assert!(with <= *without, "{with}, {without}");
    }
}

/// All kinds of lines under the engine's anti-aliasing: the pass of object ids binds what the
/// prepass with motion vectors binds.
#[test]
fn object_edges_are_drawn_under_temporal_anti_aliasing() {
    let (mut small, _) = scene();
    let at = Transform::from_xyz(0.0, 0.0, 0.01 - HALF);
    put(&mut small, Rectangle::new(20.0, 20.0), Color::WHITE, at);
    small.style(&ComicStyle::default().with(Outlines::default()));
    small.headless.step(30);
    assert!(total(&small) > 400.0, "{}", total(&small));
    assert!(small.ran(ComicsStage::ObjectIds));
}
