//! Strokes that lie on things.

use bevy::camera::CameraProjection;
use bevy_comics_testkit::reference::{
    color,
    hatching::{Hatch, Surface},
};

use crate::{line_scenes::mean, prelude::*};

pub const SIZE: UVec2 = UVec2::new(160, 120);
/// Walls that are turned by up to 60 degrees fill the view.
const FOV: f32 = 0.7;

/// Black marks on white paper, without what is random.
pub fn plain(kind: HatchingKind) -> Hatching {
    Hatching {
        breaks: 0.0,
        wobble: 0.0,
        pressure: 0.0,
        bare_above: 1.0,
        solid_below: 0.0,
        ..inked(kind)
    }
}

fn inked(kind: HatchingKind) -> Hatching {
    Hatching {
        kind,
        ground: HatchingGround::Paper,
        ..default()
    }
}

fn strokes() -> Hatching {
    plain(HatchingKind::Strokes)
}

/// The darkness at a light.
pub fn tone(s: &Hatching, light: f32) -> f64 {
    Hatch::new(s).tone(color::lightness([f64::from(light); 3]))
}

fn perspective(fov: f32) -> Projection {
    Projection::Perspective(PerspectiveProjection { fov, ..default() })
}

/// A camera at the origin that looks at nothing.
pub fn empty() -> Small {
    let mut small = Small::with(options(SIZE), Msaa::Off);
    small.clear();
    small.insert((Transform::IDENTITY, perspective(FOV), Tonemapping::None));
    small
}

/// A wall of a light that fills the view.
pub fn flat(small: &mut Small, light: f32, at: Transform) -> Entity {
    let material = StandardMaterial {
        double_sided: true,
        cull_mode: None,
        ..unlit(Color::linear_rgb(light, light, light))
    };
    small.put(Rectangle::new(4000.0, 4000.0), material, at)
}

/// Darkness of every pixel of the last frame: 0 paper, 1 ink.
fn darkness(small: &Small) -> Vec<f64> {
    let (_, after) = small.pass();
    after.pixels.iter().map(|p| 1.0 - f64::from(p[0])).collect()
}

/// Darkness of every pixel in a style.
pub fn covers(small: &mut Small, s: Hatching) -> Vec<f64> {
    small.style(&ComicStyle::new().with(s));
    darkness(small.settle())
}

pub fn least_and_most(values: &[f64]) -> [f64; 2] {
    [f64::min, f64::max].map(|of| values.iter().copied().reduce(of).expect("some"))
}

/// How many pixels differ by more than a limit.
pub fn differ(a: &[f64], b: &[f64], limit: f64) -> usize {
    let pairs = a.iter().zip(b);
    pairs.filter(|(a, b)| (*a - *b).abs() > limit).count()
}

/// A wall at an angle about a slanted axis, through a point before the camera.
pub fn tilted(degrees: f32, distance: f32) -> Transform {
    let axis = Vec3::new(0.6, 0.8, 0.0);
    Transform::from_xyz(0.0, 0.0, -distance)
        .with_rotation(Quat::from_axis_angle(axis, degrees.to_radians()))
}

/// Walls that fill the view: degrees, and distances.
pub const WALLS: [(f32, f32); 4] = [(0.0, 7.0), (0.0, 9.3), (35.0, 20.0), (60.0, 31.0)];
/// Their light.
pub const LIGHTS: [f32; 5] = [0.003, 0.03, 0.15, 0.4, 0.75];

/// The light of a wall, and the wall.
pub type Field = (f32, (f32, f32));

pub const THREE_FIELDS: [Field; 3] = [
    (LIGHTS[0], WALLS[1]),
    (LIGHTS[2], WALLS[3]),
    (LIGHTS[4], WALLS[1]),
];

pub fn every_field() -> Vec<Field> {
    let of = |light| WALLS.map(|wall| (light, wall));
    LIGHTS.into_iter().flat_map(of).collect()
}

/// Truth: the mean of a flat field has the darkness that its lightness asks for, at every tone,
/// angle and distance, with one layer and with three.
#[test]
fn flat_fields_keep_their_mean_tone() {
    fields_keep_their_mean_tone(&THREE_FIELDS, &layered());
}

#[test]
#[ignore = "long: five tones of four walls"]
fn flat_fields_keep_their_mean_tone_on_every_wall() {
    fields_keep_their_mean_tone(&every_field(), &layered());
}

/// Strokes of one layer and three, without what is random and with it, and the limits of their
/// means.
fn layered() -> Vec<(Hatching, f64)> {
    let of = |layers| {
        let even = Hatching {
            layers,
            ..strokes()
        };
        let random = Hatching {
            breaks: 1.0,
            wobble: 1.0,
            pressure: 0.5,
            ..even
        };
        [(even, 0.02), (random, 0.04)]
    };
    let tinted = Hatching {
        tones: 3,
        gamma: 1.5,
        ..strokes()
    };
    [of(1), of(3)]
        .concat()
        .into_iter()
        .chain([(tinted, 0.02)])
        .collect()
}

/// `styles`: with the limits of their means.
pub fn fields_keep_their_mean_tone(fields: &[Field], styles: &[(Hatching, f64)]) {
    let mut small = empty();
    for &(light, (degrees, distance)) in fields {
        small.clear();
        flat(&mut small, light, tilted(degrees, distance));
        for (s, limit) in styles {
            let (got, want) = (mean(&covers(&mut small, *s)), tone(s, light));
            let off = (got - want).abs();
            println!("light {light}, {degrees} degrees: {got:.3}, {want:.3}");
            assert!(
                off < *limit,
                "{light}, {degrees} degrees, {s:?}: {got}, {want}"
            );
        }
    }
}

/// How many pixels are not those of the geometry of a wall of light 0.2. `plane`: a place of it from the
/// eye on, and its normal; `eye`: where strokes are fixed to.
pub fn misplaced(found: &[f64], s: &Hatching, plane: [Vec3; 2], eye: DVec3) -> usize {
    let projection = PerspectiveProjection {
        fov: FOV,
        aspect_ratio: SIZE.x as f32 / SIZE.y as f32,
        ..default()
    };
    let view = projection.get_clip_from_view().as_dmat4().inverse();
    let [place, normal] = plane.map(|v| v.as_dvec3());
    let (hatch, tone) = (Hatch::new(s), tone(s, 0.2));
    let is_apart = |(i, got): (usize, &f64)| {
        let [x, y] = [i as u32 % SIZE.x, i as u32 / SIZE.x].map(|v| f64::from(v) + 0.5);
        let part = DVec2::new(x, y) / SIZE.as_dvec2();
        let ndc = part * DVec2::new(2.0, -2.0) + DVec2::new(-1.0, 1.0);
        let on = Surface::of_plane(view, ndc, SIZE.as_dvec2(), (place, normal));
        let beside = [DVec3::ZERO, on.across, on.down, -on.across, -on.down];
        let near = beside.map(|by| {
            let place = on.place + eye + 0.1 * by;
            hatch.cover(&Surface { place, ..on }, tone)
        });
        let [low, high] = least_and_most(&near);
        !(low - 0.03..=high + 0.03).contains(got)
    };
    found.iter().enumerate().filter(|at| is_apart(*at)).count()
}

/// Every pixel of a slanted wall is that of its geometry: the plane, not its depth and normals.
#[test]
fn strokes_are_where_the_plane_is() {
    let mut small = empty();
    for (degrees, distance) in [(20.0, 9.0), (55.0, 30.0)] {
        let at = tilted(degrees, distance);
        let plane = [at.translation, at.rotation * Vec3::Z];
        small.clear();
        flat(&mut small, 0.2, at);
        for s in [strokes(), inked(HatchingKind::Strokes)] {
            let found = covers(&mut small, s);
            let apart = misplaced(&found, &s, plane, DVec3::ZERO);
            println!("{degrees} degrees: {apart} pixels differ");
            assert!(
                apart < found.len() / 100,
                "{degrees} degrees, {s:?}: {apart}"
            );
        }
    }
}

/// Half of the view in both directions, which is seen while the camera comes nearer.
const MIDDLE: UVec2 = UVec2::new(80, 60);

/// The first and the last frame on the way to a wall, through more than an octave.
pub const WHOLE_WAY: &[[i32; 2]] = &[[1, 144]];
/// An octave is 138 frames, in which new marks begin to grow three times; on a slanted wall each
/// takes some twenty frames. These see one of the three at least.
pub const PARTS_OF_THE_WAY: &[[i32; 2]] = &[[1, 17], [64, 80], [128, 144]];

/// The largest change of a pixel near the middle of the picture from one of these frames to the
/// next, while the camera comes nearer to the middle of a wall 20 units away by 0.5 % in each frame.
/// Near the middle, things move by less than 0.1 pixels a frame. The camera sees the middle of the
/// view. The mean tone stays.
pub fn largest_change(light: f32, degrees: f32, s: Hatching, way: &[[i32; 2]]) -> f64 {
    let mut small = empty();
    flat(&mut small, light, tilted(degrees, 20.0));
    small.headless.resize(MIDDLE, 1.0);
    let target = small.headless.render_target();
    let half = perspective(2.0 * (0.5 * (0.5 * FOV).tan()).atan());
    small.insert((target, half));
    let near: Vec<usize> = (0..(MIDDLE.x * MIDDLE.y) as usize)
        .filter(|i| {
            let [x, y] = [i % MIDDLE.x as usize, i / MIDDLE.x as usize].map(|v| v as f64);
            (x - 40.0).hypot(y - 30.0) < 20.0
        })
        .collect();
    let place = |frame: i32| {
        let distance = 20.0 * (1.0 - 0.995f32.powi(frame));
        Transform::from_xyz(0.0, 0.0, -distance)
    };
    let (mut largest, mut means) = (0.0f64, Vec::new());
    for &[first, last] in way {
        small.insert(place(first - 1));
        let mut before = covers(&mut small, s);
        means.push(mean(&before));
        for frame in first..=last {
            small.insert(place(frame));
            small.headless.step(1);
            let now = darkness(&small);
            let moved = near.iter().map(|i| (now[*i] - before[*i]).abs());
            largest = moved.fold(largest, f64::max);
            means.push(mean(&now));
            before = now;
        }
    }
    let [low, high] = least_and_most(&means);
    println!("{light}, {degrees}: largest change {largest:.3}, mean tone {low:.3} to {high:.3}");
    assert!(high - low < 0.03, "{light}, {degrees}: {low} to {high}");
    largest
}

/// Truth: strokes do not pop. While the camera comes nearer by 0.5 % in each frame, no pixel
/// changes by more than motion and growth explain: two edges that move by 0.1 pixels, and half of a
/// tenth.
#[test]
#[ignore = "long: an octave before three walls"]
fn strokes_of_every_tone_grow_while_the_camera_comes_nearer() {
    for (light, degrees) in [(0.2, 25.0), (0.05, 0.0), (0.4, 50.0)] {
        let s = inked(HatchingKind::Strokes);
        let largest = largest_change(light, degrees, s, WHOLE_WAY);
        assert!(largest < 0.25, "{light}, {degrees}: {largest}");
    }
}

/// The amounts of ink between white pixels in the middle row of the picture, but for those at its
/// ends.
fn strokes_of_a_row(covers: &[f64]) -> Vec<f64> {
    let row = &covers[60 * SIZE.x as usize..61 * SIZE.x as usize];
    let strokes = row.chunk_by(|a, b| !(*a > 0.0 && *b == 0.0));
    let mut found: Vec<f64> = strokes.map(|stroke| stroke.iter().sum()).collect();
    found.remove(0);
    found.pop();
    found
}

/// Truth: through an octave of distance, the strokes that are there keep their width within 0.1
/// pixels, and those that grow between them are never wider. On a wall that faces the eye, strokes
/// of one layer are a grating.
#[test]
fn strokes_keep_their_width_through_an_octave() {
    let mut small = empty();
    let wall = flat(&mut small, 0.35, Transform::IDENTITY);
    let s = Hatching {
        layers: 1,
        spacing: 6.0,
        ..strokes()
    };
    // Strokes are slanted on the wall: a row cuts them at that slant.
    let across = s.axes()[0].truncate().as_dvec2().normalize().x.abs();
    let want = 2.0 * f64::from(s.spacing) * tone(&s, 0.35) / across;
    let mut grown = BTreeSet::new();
    covers(&mut small, s);
    for zoom in 0..32u8 {
        let distance = 10.0 * (f32::from(zoom) / 32.0).exp2();
        let at = Transform::from_xyz(0.0, 0.0, -distance);
        small.world().entity_mut(wall).insert(at);
        small.headless.step(1);
        let widths = strokes_of_a_row(&darkness(&small));
        assert!(widths.len() > 4, "{widths:?}");
        let [least, widest] = least_and_most(&widths);
        assert!((widest - want).abs() < 0.1, "{widest:.3}, not {want:.3}");
        // Every second one is of the level: it has the whole width.
        let is_new = |w: &f64| (w - want).abs() >= 0.1;
        let two_new = widths.windows(2).any(|pair| pair.iter().all(is_new));
        assert!(!two_new, "{widths:.3?}");
        grown.insert((4.0 * least / want) as u32);
    }
    assert!(grown.len() > 2, "new strokes grow: {grown:?}");
}

/// Truth: at full abstraction strokes are as far apart as it says, and half way by ratio in
/// between.
#[test]
fn abstraction_draws_strokes_farther_apart() {
    let mut small = empty();
    flat(&mut small, 0.3, tilted(20.0, 12.0));
    for (level, factor) in [(0.0, 1.0), (0.5, std::f32::consts::SQRT_2), (1.0, 2.0)] {
        let abstraction = Abstraction {
            at_near: level,
            at_far: level,
            spacing: 2.0,
            saturation: 1.0,
            ..default()
        };
        small.style(&ComicStyle::new().with(strokes()).with(abstraction));
        let found = darkness(small.settle());
        let wanted = Hatching {
            spacing: 4.0 * factor,
            ..strokes()
        };
        let wanted = covers(&mut small, wanted);
        assert_eq!(differ(&found, &wanted, 2.0 / 255.0), 0, "{level}");
    }
}

/// Truth: strokes travel with an object that has a screen, in every direction and turn.
#[test]
fn strokes_travel_with_their_object() {
    let s = inked(HatchingKind::Strokes);
    // Up to 2.3 codes were measured.
    assert_marks_travel(s, Vec3::new(31.7, -8.3, 102.9), 3.0 / 255.0);
    // Up to 4.0: far from the origin, places are known to a thousandth of a unit.
    assert_marks_travel(s, Vec3::new(9000.0, 500.0, -7000.0), 5.0 / 255.0);
}

/// A camera that follows an object sees the same picture, within a limit: normals are known to ten
/// bits.
pub fn assert_marks_travel(s: Hatching, by: Vec3, limit: f64) {
    let mut small = empty();
    let at = tilted(30.0, 12.0);
    let object = flat(&mut small, 0.2, at);
    let anchor = PatternAnchor::default();
    small.world().entity_mut(object).insert(anchor);
    let still = covers(&mut small, s);
    let turn = Quat::from_euler(EulerRot::YXZ, 0.7, -0.3, 1.1);
    let moved = Transform::from_translation(by).with_rotation(turn);
    small.world().entity_mut(object).insert(moved * at);
    small.insert(moved);
    let apart = differ(&still, &covers(&mut small, s), limit);
    println!("moved by {by}: {apart} pixels differ");
    assert!(apart < still.len() / 200, "{by}: {apart}");
    // Fixed to the world, marks swim.
    small.world().entity_mut(object).remove::<PatternAnchor>();
    let apart = differ(&still, &covers(&mut small, s), limit);
    assert!(apart > still.len() / 10, "{by}: {apart}");
}

/// The darkness without and with `simplify_small`.
fn plain_and_simplified(small: &mut Small) -> [Vec<f64>; 2] {
    [0.0, 1.0].map(|simplify_small| {
        let s = Hatching {
            simplify_small,
            ..strokes()
        };
        covers(small, s)
    })
}

/// Truth: simplified strokes are those of others on large surfaces, up to their edges.
#[test]
fn simplification_changes_nothing_on_large_surfaces() {
    let mut small = empty();
    for (degrees, distance) in [(0.0, 7.0), (60.0, 31.0), (75.0, 50.0)] {
        small.clear();
        flat(&mut small, 0.3, tilted(degrees, distance));
        // A box whose sides are some strokes wide, before the wall.
        let turn = Quat::from_euler(EulerRot::YXZ, 0.6, 0.4, 0.2);
        let at = Transform::from_xyz(0.1, 0.0, -4.0).with_rotation(turn);
        let material = unlit(Color::linear_rgb(0.3, 0.3, 0.3));
        small.put(Cuboid::from_length(0.9), material, at);
        let [plain, simplified] = plain_and_simplified(&mut small);
        let apart = differ(&plain, &simplified, 0.02);
        println!(
            "{degrees} degrees: {apart} of {} pixels differ",
            plain.len()
        );
        assert!(apart < plain.len() / 200, "{degrees} degrees: {apart}");
    }
}

/// Truth: where everything is smaller than the distance of two strokes, the picture is more even,
/// and its mean stays.
#[test]
fn what_is_small_is_more_even() {
    let mut small = empty();
    let wall = flat(&mut small, 0.3, Transform::from_xyz(0.0, 0.0, -14.0));
    let world = small.world();
    let material = world.get::<MeshMaterial3d<StandardMaterial>>(wall);
    let material = material.cloned().expect("a wall");
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    let card = Mesh3d(meshes.add(Rectangle::new(1.0, 1.0)));
    // Cards of about three pixels.
    let pixel = 2.0 * (0.5 * FOV).tan() / SIZE.y as f32;
    for (i, j) in (-28..=28).flat_map(|i| (-20..=20).map(move |j| (i, j))) {
        let random = |k: i32| (f64::from(i * 37 + j * 101 + k * 53) * 0.618_034).fract() as f32;
        let [yaw, pitch] = [1, 2].map(|k| 3.0 * random(k) - 1.5);
        let turn = Quat::from_euler(EulerRot::YXZ, yaw, pitch, 3.0 * random(3));
        let away = 5.0 + 4.0 * random(4);
        let [x, y] = [i, j].map(|at| at as f32 * 2.5 * pixel * away);
        let at = Transform::from_xyz(x, y, -away)
            .with_rotation(turn)
            .with_scale(Vec3::splat(4.0 * pixel * away));
        world.spawn((Object, card.clone(), material.clone(), at));
    }
    let [plain, simplified] = plain_and_simplified(&mut small).map(|covers| {
        let middle = mean(&covers);
        let squares: Vec<f64> = covers.iter().map(|c| (c - middle).powi(2)).collect();
        (middle, mean(&squares).sqrt())
    });
    println!("mean and spread: {plain:.3?}, {simplified:.3?}");
    assert!(
        (plain.0 - simplified.0).abs() < 0.03,
        "{plain:?}, {simplified:?}"
    );
    assert!(simplified.1 < plain.1, "{plain:?}, {simplified:?}");
}

/// Settings that are all one number.
pub fn extreme(kind: HatchingKind, x: f32) -> Hatching {
    Hatching {
        kind,
        solid_below: x,
        bare_above: x,
        gamma: x,
        tones: u32::MAX,
        spacing: x,
        layers: 99,
        layer_darkness: x,
        angle: x,
        length: x,
        breaks: x,
        wobble: x,
        pressure: x,
        rate: x,
        at_near: x,
        simplify_small: x,
        ..default()
    }
}

pub const EXTREMES: [f32; 5] = [f32::NAN, f32::INFINITY, -1e30, 0.0, 1e30];

/// The sky has no marks on things; light walls have none, black ones are solid; values out of range
/// are clamped.
#[test]
fn extreme_hatching_is_finite() {
    assert_extremes_are_finite(&[2.0 * FOV]);
}

#[test]
#[ignore = "long: two views; quick test hatching::extreme_hatching_is_finite"]
fn extreme_hatching_is_finite_in_every_view() {
    assert_extremes_are_finite(&[FOV, 2.0 * FOV]);
}

fn assert_extremes_are_finite(fovs: &[f32]) {
    let mut small = empty();
    for kind in [HatchingKind::Strokes, HatchingKind::Dots] {
        small.clear();
        small.insert(perspective(FOV));
        let sky = covers(&mut small, plain(kind));
        assert!(sky.iter().all(|c| c.abs() < 0.01), "{kind:?}");
        for (light, want) in [(0.0, 1.0), (1.0, 0.0)] {
            small.clear();
            flat(&mut small, light, tilted(40.0, 5.0));
            for anchor in [HatchingAnchor::Object, HatchingAnchor::Page] {
                let s = Hatching {
                    anchor,
                    ..plain(kind)
                };
                let found = covers(&mut small, s);
                let is_wanted = |c: &f64| (c - want).abs() < 0.01;
                assert!(found.iter().all(is_wanted), "{light}, {kind:?}, {anchor:?}");
            }
        }
        small.clear();
        flat(&mut small, 0.2, tilted(89.5, 5.0));
        for &fov in fovs {
            small.insert(perspective(fov));
            for x in EXTREMES {
                let found = covers(&mut small, extreme(kind, x));
                assert!(found.iter().all(|c| c.is_finite()), "{x}, {kind:?}");
            }
        }
    }
}
