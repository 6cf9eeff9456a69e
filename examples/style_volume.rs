//! Style by volume: a camera walks down the village street into a box where the style is another
//! one, and out again. How much of the style is seen depends only on where the camera is, so it is
//! the same at every frame rate and in both directions.

use std::process::ExitCode;

use bevy::{prelude::*, render::view::Msaa};
use bevy_comics::{BlackFlats, ComicStyle, Outlines, ToonScene, Vignette, presets};
use bevy_comics_testkit::{
    demo::{Demo, Screen},
    headless::Headless,
    scenes::{BuiltIn, ScenePart, Stage},
    studio::set_style,
};
use image::RgbaImage;

/// A box with a style of its own, for cameras with a [`StyleOutside`].
#[derive(Component)]
struct StyleVolume {
    /// Half of the width, height and depth, in the frame of reference of the entity.
    half_size: Vec3,
    /// Width of the border around the box in which styles blend, world units.
    border: f32,
    style: ComicStyle,
}

/// On a camera: the style outside of all volumes, and how much of that of a volume is seen.
#[derive(Component)]
struct StyleOutside {
    style: ComicStyle,
    /// The volume that counts, and how much of it; `None` before the first frame.
    within: Option<Option<(f32, Entity)>>,
}

/// 1 inside the box, 0 from `border` outside of it on, and smooth between. `at` is in the frame of
/// reference of the box.
fn weight(at: Vec3, half_size: Vec3, border: f32) -> f32 {
    let outside = (at.abs() - half_size).max(Vec3::ZERO).length();
    let near = (1.0 - outside / border.max(1e-6)).clamp(0.0, 1.0);
    near * near * (3.0 - 2.0 * near)
}

/// Gives every camera the style of where it is.
fn dress(
    mut commands: Commands,
    volumes: Query<(Entity, &GlobalTransform, &StyleVolume)>,
    mut cameras: Query<(Entity, &Transform, &mut StyleOutside)>,
) {
    for (camera, eye, mut outside) in &mut cameras {
        let weighed = volumes.iter().map(|(entity, place, volume)| {
            let at = place.affine().inverse().transform_point3(eye.translation);
            (weight(at, volume.half_size, volume.border), entity, volume)
        });
        let strongest = weighed.max_by(|a, b| a.0.total_cmp(&b.0));
        let now = strongest.map(|(weight, entity, _)| (weight, entity));
        if outside.within == Some(now) {
            continue;
        }
        outside.within = Some(now);
        let style = match strongest {
            Some((weight, _, volume)) => outside.style.blend(&volume.style, weight),
            None => outside.style.clone(),
        };
        set_style(&mut commands.entity(camera), &style);
    }
}

/// Where the walk is, 0 to 1.
#[derive(Resource, Default)]
struct Walk(f32);

/// Seconds from one end to the other.
const WALK: f32 = 12.0;

fn walk(
    time: Res<Time>,
    screen: Res<Screen>,
    mut walk: ResMut<Walk>,
    mut camera: Single<&mut Transform, With<StyleOutside>>,
) {
    if screen.out.is_none() {
        let turn = (time.elapsed_secs() / WALK) % 2.0;
        walk.0 = 1.0 - (turn - 1.0).abs();
    }
    let z = 30.0 - 44.0 * walk.0;
    let eye = Vec3::new(0.6, 2.4, z);
    **camera =
        Transform::from_translation(eye).looking_at(eye + Vec3::new(-0.25, 0.25, -8.0), Vec3::Y);
}

/// Noir for a place in the sun: more ink than the preset has.
fn night(lines: Outlines) -> ComicStyle {
    let flats = BlackFlats {
        value: Some(0.78),
        softness: 0.05,
        ..default()
    };
    let corners = Vignette {
        amount: 0.9,
        ..default()
    };
    let noir = presets::NOIR.style().with(lines);
    noir.with(flats).with(corners)
}

fn spawn(mut stage: Stage, screen: Res<Screen>) {
    let vantage = stage.spawn(BuiltIn::Village);
    let day = presets::SATURDAY_MORNING.style();
    let lines = day.get::<Outlines>().copied().unwrap_or_default();
    stage.commands.spawn((
        vantage.camera(),
        screen.target.clone(),
        Msaa::Sample4,
        StyleOutside {
            style: day,
            within: None,
        },
    ));
    stage.commands.spawn((
        Transform::from_xyz(0.0, 3.0, -14.0),
        StyleVolume {
            half_size: Vec3::new(12.0, 6.0, 12.0),
            border: 22.0,
            style: night(lines),
        },
    ));
}

fn flatten(mut commands: Commands, parts: Query<Entity, (With<ScenePart>, Without<ChildOf>)>) {
    for part in &parts {
        commands.entity(part).insert(ToonScene::default());
    }
}

/// Four steps of the walk, from left to right.
fn steps(headless: &mut Headless) -> RgbaImage {
    let size = headless.options.size;
    let gap = 6;
    let mut strip = RgbaImage::from_pixel(
        4 * size.x + 3 * gap,
        size.y,
        image::Rgba([255, 255, 255, 255]),
    );
    for (column, at) in [0.0, 0.32, 0.52, 0.8].into_iter().enumerate() {
        headless.app.insert_resource(Walk(at));
        headless.step(4);
        let x = column as i64 * i64::from(size.x + gap);
        image::imageops::replace(&mut strip, &headless.picture(), x, 0);
    }
    strip
}

fn main() -> ExitCode {
    let demo = Demo {
        title: "Style by volume",
        keys: "The camera walks by itself. The picture shows four steps.",
        size: UVec2::new(320, 360),
        frames: 2,
    };
    let add = |app: &mut App| {
        app.init_resource::<Walk>()
            .add_systems(Startup, (spawn, flatten).chain())
            .add_systems(Update, (walk, dress).chain());
    };
    demo.run_with(add, steps)
}

#[cfg(test)]
mod tests {
    use super::weight;
    use bevy::math::Vec3;

    #[test]
    fn the_weight_is_one_inside_none_far_away_and_falls_evenly_between() {
        let half = Vec3::new(2.0, 3.0, 4.0);
        assert_eq!(weight(Vec3::new(1.9, -2.9, 3.9), half, 5.0), 1.0);
        assert_eq!(weight(Vec3::new(0.0, 0.0, 9.0), half, 5.0), 0.0);
        assert!((weight(Vec3::new(0.0, 0.0, -6.5), half, 5.0) - 0.5).abs() < 1e-6);
        let mut last = 1.0;
        for step in 0..200 {
            let now = weight(Vec3::X * (2.0 + step as f32 * 0.03), half, 5.0);
            assert!(now <= last && last - now < 0.01, "no jump at step {step}");
            last = now;
        }
    }

    #[test]
    fn a_border_of_no_width_is_a_switch() {
        assert_eq!(weight(Vec3::X * 1.001, Vec3::ONE, 0.0), 0.0);
        assert_eq!(weight(Vec3::X * 0.999, Vec3::ONE, 0.0), 1.0);
    }
}
