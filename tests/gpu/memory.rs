//! What lines remember under temporal anti-aliasing: they stand still, and leave no ghosts.

use crate::{
    outlines::{put, removed},
    prelude::*,
};

/// Width and height of the picture in pixels; a unit of the scene is a pixel.
pub const SIZE: usize = 120;

/// A white wall in front of a white background: only lines change the picture.
pub fn scene() -> (Small, Entity) {
    let mut small = Small::new(UVec2::splat(SIZE as u32), Msaa::Off);
    small.clear();
    let half = 0.5 * SIZE as f32;
    small.insert((
        Transform::IDENTITY,
        Projection::Perspective(PerspectiveProjection {
            fov: std::f32::consts::FRAC_PI_2,
            ..default()
        }),
        TemporalAntiAliasing::default(),
    ));
    let camera = small.camera;
    let mut camera = small.world().get_mut::<Camera>(camera).expect("a camera");
    camera.clear_color = Color::WHITE.into();
    let wall = put(
        &mut small,
        Rectangle::new(61.3, 47.7),
        Color::WHITE,
        Transform::from_xyz(-3.0, 2.0, -half).with_rotation(Quat::from_rotation_z(0.2)),
    );
    (small, wall)
}

/// Draws until all has settled.
pub fn outline(small: &mut Small, history_weight: f32) {
    outline_for(small, history_weight, 40);
}

fn outline_for(small: &mut Small, history_weight: f32, frames: usize) {
    let outlines = Outlines {
        history_weight,
        ..Outlines::SILHOUETTES
    };
    small.style(&ComicStyle::default().with(outlines));
    small.headless.step(frames);
}

/// The fraction of pixels that change by more than two codes from frame to frame, in two rounds of the
/// engine's offsets.
fn changes(small: &mut Small) -> f64 {
    const FRAMES: usize = 16;
    let mut before = small.picture();
    let mut count = 0;
    for _ in 0..FRAMES {
        small.headless.step(1);
        let now = small.picture();
        let differ = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
            a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2)
        };
        count += before.pixels().zip(now.pixels()).filter(differ).count();
        before = now;
    }
    count as f64 / (FRAMES * SIZE * SIZE) as f64
}

/// The distance of the wall's rim from a place, in pixels; positive inside.
fn inside(x: f64, y: f64) -> f64 {
    let half = 0.5 * SIZE as f64;
    let [x, y] = [x - half + 3.0, half - y - 2.0];
    let (sin, cos) = 0.2f32.sin_cos();
    let (sin, cos) = (f64::from(sin), f64::from(cos));
    let [u, v] = [x * cos + y * sin, -x * sin + y * cos];
    (30.65 - u.abs()).min(23.85 - v.abs())
}

/// Along the middle of each side: how far the middle of the line is from the rim, as a root
/// mean square in pixels.
fn error(small: &Small) -> f64 {
    let ink = removed(small);
    let mut sum = 0.0;
    let mut count = 0.0;
    for column in 40..75 {
        for rows in [15..60, 60..110] {
            let ink = |y: usize| f64::from(ink[y * SIZE + column]);
            let all: f64 = rows.clone().map(ink).sum();
            let moment: f64 = rows.map(|y| (y as f64 + 0.5) * ink(y)).sum();
            let away = inside(column as f64 + 0.5, moment / all);
            sum += away * away;
            count += 1.0;
        }
    }
    (sum / count).sqrt()
}

#[test]
fn lines_of_a_still_view_stand_still() {
    let (mut small, _) = scene();
    let mut found = Vec::new();
    for (history_weight, frames) in [(0.0, 16), (0.875, 40)] {
        outline_for(&mut small, history_weight, frames);
        let away = error(&small);
        let changed = changes(&mut small);
        println!(
            "history weight {history_weight}: {away:.3} px away, {:.4} % change",
            100.0 * changed
        );
        found.push((away, changed));
    }
    let [(trembling, many), (still, few)] = found[..] else {
        unreachable!()
    };
    assert!(many > 0.001, "{many}: nothing trembles without history");
    assert!(few < 1e-4, "{few}");
    assert!(
        still < 0.1 && still < 0.8 * trembling,
        "{still}, {trembling}"
    );
    assert_eq!(small.errors(), 0);
}

/// A ledge of 0.4 pixels, whose creases are found at some of the engine's offsets only: its line
/// stands still too.
#[test]
#[ignore = "long: many frames until it stands still"]
fn lines_that_are_found_now_and_then_stand_still() {
    let (mut small, wall) = scene();
    small.world().despawn(wall);
    let half = 0.5 * SIZE as f32;
    // Below the eye: a slab of the wall, whose top is seen.
    for (size, at) in [
        (
            Vec3::new(200.0, 200.0, 1.0),
            Vec3::new(0.0, 0.0, -half - 1.5),
        ),
        (
            Vec3::new(200.0, 100.0, 1.4),
            Vec3::new(0.0, -67.0, -half - 0.3),
        ),
    ] {
        let lean = Quat::from_rotation_z(0.1);
        let at = Transform::from_translation(at).with_rotation(lean);
        put(&mut small, Cuboid::from_size(size), Color::WHITE, at);
    }
    let mut found = Vec::new();
    for (history_weight, frames) in [(0.0, 16), (0.875, 150)] {
        let outlines = Outlines {
            history_weight,
            objects: None,
            ..default()
        };
        small.style(&ComicStyle::default().with(outlines));
        small.headless.step(frames);
        assert!(total(&small) > 50.0, "{}", total(&small));
        found.push(changes(&mut small));
        println!(
            "history weight {history_weight}: {:.4} % change",
            100.0 * found[found.len() - 1]
        );
    }
    assert!(found[0] > 0.001, "{found:?}");
    assert!(found[1] < 1e-4, "{found:?}");
    assert_eq!(small.errors(), 0);
}

/// Posts of 0.3 to 0.6 pixels, before the sky and before a wall, which are seen at some of the
/// engine's offsets only: their lines stand still too, and leave no ghosts for longer than two
/// rounds of offsets when they have gone.
#[test]
#[ignore = "long: many frames until it stands still"]
fn lines_of_surfaces_narrower_than_a_pixel_stand_still() {
    let (mut small, wall) = scene();
    small.world().despawn(wall);
    let half = 0.5 * SIZE as f32;
    put(
        &mut small,
        Rectangle::new(300.0, 120.0),
        Color::WHITE,
        Transform::from_xyz(0.0, -120.0, -2.0 * half),
    );
    let posts: Vec<Entity> = [(-31.2, 0.3), (-9.7, 0.4), (8.1, 0.5), (30.4, 0.6)]
        .into_iter()
        .map(|(x, width)| {
            let at = Transform::from_xyz(x, 0.0, -half).with_rotation(Quat::from_rotation_z(0.03));
            put(&mut small, Rectangle::new(width, 80.0), Color::WHITE, at)
        })
        .collect();
    let found = [(0.0, 16), (0.875, 150)].map(|(history_weight, frames)| {
        outline_for(&mut small, history_weight, frames);
        let changed = changes(&mut small);
        println!(
            "history weight {history_weight}: {:.4} % change",
            100.0 * changed
        );
        changed
    });
    assert!(found[0] > 0.01, "{found:?}");
    assert!(found[1] < 1e-4, "{found:?}");
    let before = removed(&small);
    for post in posts {
        small.world().despawn(post);
    }
    small.headless.step(20);
    let after = removed(&small);
    small.headless.step(60);
    let alone = removed(&small);
    // Away from the line of the wall.
    let of = |ink: &[f32]| -> f32 {
        let free = (0..ink.len()).filter(|i| alone[*i] == 0.0);
        free.map(|i| ink[i]).sum()
    };
    let [there, ghost] = [of(&before), of(&after)];
    println!("ghost: {ghost} of {there}");
    assert!(there > 100.0 && ghost < 0.01 * there);
    assert_eq!(small.errors(), 0);
}

/// A wall that comes before another hides its lines at once.
#[test]
fn lines_that_are_covered_leave_no_ghosts() {
    let (mut small, _) = scene();
    outline(&mut small, 0.875);
    assert!(total(&small) > 100.0);
    let half = 0.5 * SIZE as f32;
    let cover = Transform::from_xyz(0.0, 0.0, -0.5 * half);
    put(
        &mut small,
        Rectangle::new(500.0, 500.0),
        Color::WHITE,
        cover,
    );
    small.headless.step(4);
    let ghost = total(&small);
    println!("ghost: {ghost}");
    assert!(ghost < 1.0, "{ghost}");
    assert_eq!(small.errors(), 0);
}

/// The sum of ink in the picture.
fn total(small: &Small) -> f32 {
    removed(small).iter().sum()
}

/// A wall that is gone has no lines in the next frame, also where another line is drawn: on
/// a wall behind it.
#[test]
fn lines_of_objects_that_vanish_leave_no_ghosts() {
    let (mut small, wall) = scene();
    let half = 0.5 * SIZE as f32;
    for depth in [1.2, 1.5] {
        put(
            &mut small,
            Rectangle::new(55.0 * depth, 50.0 * depth),
            Color::WHITE,
            Transform::from_xyz(0.0, 0.0, -half * depth),
        );
    }
    outline_for(&mut small, 0.125, 24);
    let before = removed(&small);
    small.world().despawn(wall);
    // The second frame is the first that is drawn without it.
    small.headless.step(2);
    let after = removed(&small);
    small.headless.step(60);
    let alone = removed(&small);
    // Away from the lines that are left.
    let free = |i: usize| {
        let near = |d: i64| {
            alone
                .get((i as i64 + d) as usize)
                .is_none_or(|ink| *ink > 0.0)
        };
        !(-2..=2).any(|y| (-2..=2).any(|x| near(y * SIZE as i64 + x)))
    };
    let of = |ink: &[f32]| -> f32 { (0..ink.len()).filter(|i| free(*i)).map(|i| ink[i]).sum() };
    let [there, ghost] = [of(&before), of(&after)];
    println!("ghost: {ghost} of {there}");
    assert!(there > 20.0, "{there}");
    assert!(ghost < 0.01 * there, "{ghost} of {there}");
    assert_eq!(small.errors(), 0);
}

/// After a camera cut, nothing of the frame before is left.
#[test]
fn a_cut_forgets_lines() {
    let (mut small, _) = scene();
    outline_for(&mut small, 0.03125, 24);
    let camera = small.camera;
    small.world().trigger(CameraCut { entity: camera });
    small.insert(Transform::from_xyz(3.0, 1.0, 0.0));
    small.headless.step(1);
    let once = removed(&small);
    small.headless.step(40);
    let later = removed(&small);
    // A frame without history: each line may be half a pixel away.
    let apart = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f32>();
    let found = apart(&once, &later);
    println!("{found} of {}", total(&small));
    assert!(found < 0.5 * total(&small), "{found}");
    assert_eq!(small.errors(), 0);
}

/// Lines of an object that moves are where it is.
#[test]
fn lines_follow_what_moves() {
    let (mut small, wall) = scene();
    outline(&mut small, 0.875);
    let middle = |small: &Small| {
        let ink = removed(small);
        let row = (0..SIZE).map(|x| (x, ink[58 * SIZE + x]));
        let left = row.filter(|(x, _)| *x < 60);
        let (sum, moment) = left.fold((0.0, 0.0), |(sum, moment), (x, ink)| {
            (sum + ink, moment + ink * (x as f32 + 0.5))
        });
        (moment / sum, sum)
    };
    let (start, _) = middle(&small);
    for speed in [0.3f32, 1.7] {
        for step in 1..=10 {
            let mut world = small.world().get_mut::<Transform>(wall).expect("a wall");
            world.translation.x += if step <= 5 { speed } else { -speed };
            small.headless.step(1);
            let mut transforms = small.world().query::<&GlobalTransform>();
            let at = transforms.get(small.world(), wall).expect("drawn");
            let want = start + at.translation().x + 3.0;
            let (found, ink) = middle(&small);
            println!("speed {speed}, step {step}: {found:.2}, {want:.2}, ink {ink:.2}");
            assert!(
                (found - want).abs() < 0.2,
                "{speed}, {step}: {found}, {want}"
            );
            assert!((1.8..2.2).contains(&ink), "{speed}, {step}: {ink}");
        }
    }
    assert_eq!(small.errors(), 0);
}

/// How dark lines are: the mean ink of inked pixels, weighted by ink.
fn darkness(small: &Small) -> f32 {
    let ink = removed(small);
    let squares: f32 = ink.iter().map(|ink| ink * ink).sum();
    squares / ink.iter().sum::<f32>()
}

/// Lines are as dark while the camera moves: the history
/// reads the last frame between its pixels, and must not spread lines. As a mean of pictures
/// without history, so that where lines lie between pixels does not count.
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

fn assert_dark_while_moving(steps: &[Vec3]) {
    let (mut small, _) = scene();
    for &step in steps {
        let [without, with] = [(0.0, 8), (0.875, 40)].map(|(history_weight, frames)| {
            small.insert(Transform::IDENTITY);
            outline_for(&mut small, history_weight, frames);
            let mut sum = 0.0;
            for frame in 1..=24 {
                small.insert(Transform::from_translation(step * frame as f32));
                small.headless.step(1);
                sum += if frame > 8 {
                    darkness(&small) / 16.0
                } else {
                    0.0
                };
            }
            sum
        });
        println!("{step}: {without:.3} without history, {with:.3} with one");
        assert!(with > 0.85 * without, "{step}: {with}, {without}");
    }
    assert_eq!(small.errors(), 0);
}

/// All kinds of lines under the engine's anti-aliasing: the pass of object ids binds what the
/// prepass with motion vectors binds.
#[test]
fn object_edges_are_drawn_under_temporal_anti_aliasing() {
    let (mut small, _) = scene();
    put(
        &mut small,
        Rectangle::new(20.0, 20.0),
        Color::WHITE,
        Transform::from_xyz(0.0, 0.0, -0.5 * SIZE as f32 + 0.01),
    );
    small.style(&ComicStyle::default().with(Outlines::default()));
    small.headless.step(30);
    assert!(total(&small) > 400.0, "{}", total(&small));
    assert!(small.ran(ComicsStage::ObjectIds));
    assert_eq!(small.errors(), 0);
}
