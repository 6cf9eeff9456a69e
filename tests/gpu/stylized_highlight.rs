//! Stylized highlights and rims: their place, size and edges on a ball.

use std::f32::consts::FRAC_PI_2;

use bevy_comics_testkit::reference::stylized_highlight::{
    distance, frame_along, stylized_highlight_radius,
};
use image::RgbaImage;

use crate::{
    prelude::*,
    ramp::{bright, drawn, put, room, set_light, sun},
};

/// A picture of the whole ball.
const SIZE: u32 = 256;
/// Pictures of the same scale, in which shapes have room, and plain highlights of every roughness.
const SHAPE: u32 = 160;
const PLAIN: u32 = 192;
/// Of the ball, in units; a camera of the whole ball shows 2.
const BALL: f64 = 0.95;
const ROUGHNESS: f32 = 0.3;
/// Makes the plain highlight 20 pixels wide.
const EDGE: f32 = 0.05;
/// The pixels of the ball's radius.
const RADIUS: f64 = 0.5 * BALL * SIZE as f64;
/// The brightness of a highlight in the picture.
const PEAK: f64 = 0.8;

fn shaped(highlight: StylizedHighlight) -> ToonLight {
    let polish = 1.0 - 1.4 * ROUGHNESS;
    ToonLight {
        stylized_highlight: Some(highlight),
        highlight: PEAK as f32 / (polish * polish),
        highlight_edge: EDGE,
        ..default()
    }
}

/// A view without objects, in the scale of [`RADIUS`].
fn view(size: UVec2) -> Small {
    let mut small = room(size, 0.0);
    let scaling_mode = ScalingMode::FixedVertical {
        viewport_height: 2.0 * size.y as f32 / SIZE as f32,
    };
    small.insert(Projection::Orthographic(OrthographicProjection {
        scaling_mode,
        ..OrthographicProjection::default_3d()
    }));
    small
}

/// The middle of a black ball with smooth normals, under a light from the eye.
fn ball(light: &ToonLight, size: u32) -> Small {
    let mut small = view(UVec2::splat(size));
    small.camera_settings().clear_color = Color::BLACK.into();
    // With more triangles, most of them would be smaller than a pixel.
    let mesh = Sphere::new(BALL as f32).mesh().uv(128, 64);
    put(&mut small, mesh, light, Transform::IDENTITY);
    polish(&mut small);
    sun(&mut small, Vec3::Z, bright(1.0));
    small
}

/// Makes all materials black and shiny.
fn polish(small: &mut Small) {
    polish_to(small, ROUGHNESS);
}

fn polish_to(small: &mut Small, roughness: f32) {
    let world = small.world();
    let mut materials = world.resource_mut::<Assets<ToonMaterial>>();
    for (_, material) in materials.iter_mut() {
        material.base.base_color = Color::BLACK;
        material.base.perceptual_roughness = roughness;
    }
}

/// The only entity with a component.
fn only<C: Component>(small: &mut Small) -> Entity {
    let world = small.world();
    let mut all = world.query_filtered::<Entity, With<C>>();
    all.single(world).expect("one")
}

/// How much of every pixel is covered, row by row.
fn covers(picture: &RgbaImage) -> Vec<f64> {
    let pixels = picture.enumerate_pixels();
    pixels
        .map(|(x, y, _)| linear(picture, x, y)[0] / PEAK)
        .collect()
}

/// Covered pixels, and the middle of what is covered, from the middle of the picture; up is
/// positive.
fn summed(covers: &[f64]) -> (f64, DVec2) {
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    let size = covers.len().isqrt() as u32;
    for (i, cover) in covers.iter().enumerate() {
        area += cover;
        moment += cover * place([i as u32 % size, i as u32 / size], size);
    }
    (area, moment / area.max(1e-9))
}

/// The center of a pixel, from the middle of the picture; up is positive.
fn place([x, y]: [u32; 2], size: u32) -> DVec2 {
    let middle = 0.5 * f64::from(size);
    DVec2::new(f64::from(x) + 0.5 - middle, middle - f64::from(y) - 0.5)
}

fn covered(picture: &RgbaImage) -> (f64, DVec2) {
    summed(&covers(picture))
}

/// How much of every pixel of a picture of this size the shape covers by the ball's geometry at four
/// times the size. `half` is the half vector.
fn true_covers(highlight: &StylizedHighlight, half: DVec3, size: u32) -> Vec<f64> {
    let radius = stylized_highlight_radius(EDGE.into(), ROUGHNESS.into());
    let is_covered = |at: DVec2| {
        let at = at / RADIUS;
        let rest = 1.0 - at.length_squared();
        // What faces away from the light shows nothing.
        if rest < 1e-4 {
            return false;
        }
        let normal = at.extend(rest.sqrt());
        let frame = frame_along(normal, DVec3::X);
        distance(highlight, frame, radius, normal, half) < 0.0
    };
    let places = (0..size).flat_map(|y| (0..size).map(move |x| place([x, y], size)));
    let cover = |middle: DVec2| {
        let parts = (0..16).map(|k| (DVec2::new((k % 4).into(), (k / 4).into()) - 1.5) / 4.0);
        parts.filter(|part| is_covered(middle + *part)).count() as f64 / 16.0
    };
    places.map(cover).collect()
}

fn highlight_of(shape: HighlightShape, change: fn(&mut StylizedHighlight)) -> StylizedHighlight {
    let mut highlight = StylizedHighlight {
        shape,
        ..StylizedHighlight::default()
    };
    change(&mut highlight);
    highlight
}

/// Checks that shapes are where the geometry of the ball says.
fn check_cover(highlights: &[StylizedHighlight]) {
    let mut small = ball(&shaped(StylizedHighlight::default()), SHAPE);
    for &highlight in highlights {
        set_light(&mut small, &shaped(highlight));
        let found = covers(&drawn(&mut small));
        let wanted = true_covers(&highlight, DVec3::Z, SHAPE);
        let ((area, middle), (true_area, center)) = (summed(&found), summed(&wanted));
        assert!(true_area > 300.0, "{highlight:?}: {true_area} pixels");
        assert!(
            (area / true_area - 1.0).abs() < 0.01,
            "{highlight:?}: {area} pixels, not {true_area}"
        );
        let away = middle.distance(center);
        assert!(away < 0.5, "{highlight:?}: {middle}, not {center}");
        // The 16 parts of a pixel tell its cover to an eighth, and a slanted edge is off by 0.05.
        // Only where edges meet in a pixel is it off by more.
        let pairs = found.iter().zip(&wanted);
        let off = pairs
            .filter(|(found, wanted)| (*found - *wanted).abs() > 0.4)
            .count();
        println!("{:?}: {off} of {true_area} pixels", highlight.shape);
        assert!(
            off as f64 <= 0.02 * true_area,
            "{highlight:?}: {off} of {true_area}"
        );
    }
}

/// Signs are where the geometry of the ball says: what moves, turns and bends them.
#[test]
fn shapes_cover_what_they_should() {
    check_cover(&[
        highlight_of(HighlightShape::Disc, |s| {
            (s.scale, s.offset) = (Vec2::new(2.0, 0.8), Vec2::new(1.5, 0.7));
        }),
        highlight_of(HighlightShape::Star, |s| {
            (s.size, s.points, s.bar) = (2.0, 5, 0.5);
        }),
        highlight_of(HighlightShape::Faithful, |s| {
            (s.square, s.rotation) = (1.0, 30.0);
        }),
    ]);
}

/// The same of every shape and what changes it.
#[test]
#[ignore = "long: every shape"]
fn every_shape_covers_what_it_should() {
    let of = highlight_of;
    check_cover(&[
        StylizedHighlight::default(),
        of(HighlightShape::Disc, |s| s.scale = Vec2::new(2.0, 0.8)),
        of(HighlightShape::Disc, |s| s.split = Vec2::new(1.6, 0.0)),
        of(HighlightShape::Disc, |s| s.offset = Vec2::new(1.5, 0.7)),
        of(HighlightShape::Disc, |s| s.square = 1.0),
        of(HighlightShape::Square, |s| s.square = 1.0),
        of(HighlightShape::Window, |s| s.rotation = 20.0),
        of(HighlightShape::Crescent, |s| s.size = 1.6),
        of(HighlightShape::Star, |s| s.size = 2.0),
        of(HighlightShape::Star, |s| {
            (s.size, s.points, s.bar) = (2.0, 5, 0.5);
        }),
        of(HighlightShape::Streak, |s| {
            (s.size, s.rotation) = (2.0, 45.0);
        }),
        of(HighlightShape::Faithful, |s| s.scale = Vec2::new(1.8, 1.0)),
        of(HighlightShape::Faithful, |s| {
            (s.square, s.rotation) = (1.0, 30.0);
        }),
        of(HighlightShape::Faithful, |s| s.split = Vec2::splat(0.6)),
        of(HighlightShape::Faithful, |s| {
            s.offset = Vec2::new(-1.2, 1.0);
        }),
    ]);
}

/// Polished, between, and matt.
#[test]
fn discs_are_the_plain_highlight_of_some_roughness() {
    check_roughness(&[0.0, 0.2, 0.6]);
}

#[test]
#[ignore = "long: six roughnesses"]
fn discs_are_the_plain_highlight_at_every_roughness() {
    check_roughness(&[0.0, 0.1, 0.2, 0.35, 0.5, 0.6]);
}

/// Checks that the disc of the shape is the plain highlight. From a roughness of 0.65 on, its peak
/// is below a few codes and cannot be measured.
fn check_roughness(all: &[f32]) {
    let mut small = ball(&shaped(StylizedHighlight::default()), PLAIN);
    for roughness in all.iter().copied() {
        let polish = (1.0 - 1.4 * roughness).max(0.01);
        let light = ToonLight {
            // As bright as the strength allows.
            highlight: (PEAK as f32 / (polish * polish)).min(4.0),
            ..shaped(StylizedHighlight::default())
        };
        polish_to(&mut small, roughness);
        let peak = f64::from(light.highlight * polish * polish);
        let pictures = [light.stylized_highlight, None].map(|stylized_highlight| {
            let light = ToonLight {
                stylized_highlight,
                ..light.clone()
            };
            set_light(&mut small, &light);
            drawn(&mut small)
        });
        let tangent = stylized_highlight_radius(EDGE.into(), roughness.into());
        let sine2 = tangent * tangent / (1.0 + tangent * tangent);
        let wanted = std::f64::consts::PI * RADIUS * RADIUS * sine2;
        let border = 2.0 * std::f64::consts::PI * RADIUS * sine2.sqrt();
        for picture in &pictures {
            let area = covered(picture).0 * PEAK / peak;
            // Smaller than the footprint of its edge: a dot.
            if wanted < 30.0 {
                assert!(area < 30.0, "{roughness}: {area}");
                continue;
            }
            // A hundredth of the area, and of the edge, which is one pixel wide.
            let slack = 0.01 * wanted + 0.01 * border;
            assert!(
                (area - wanted).abs() < slack,
                "{roughness}: {area}, not {wanted}"
            );
        }
        // Edges of the two are one pixel wide, one linear and one smooth.
        let differ = differ(&pictures[0], &pictures[1], 24);
        let is_dot = wanted < 30.0;
        assert!(
            is_dot || (differ as f64) < 0.5 * border,
            "{roughness}: {differ} pixels"
        );
    }
}

/// Moved by parts of a pixel, a shape covers the same.
#[test]
fn shapes_are_anti_aliased() {
    const SHIFTS: u32 = 16;
    let highlight = StylizedHighlight {
        shape: HighlightShape::Window,
        rotation: 15.0,
        ..StylizedHighlight::default()
    };
    let mut small = ball(&shaped(highlight), SHAPE);
    small.headless.step(3);
    let ball = only::<Mesh3d>(&mut small);
    let areas: Vec<f64> = (0..SHIFTS)
        .map(|shift| {
            let moved = shift as f32 / SHIFTS as f32 * 2.0 / SIZE as f32;
            let at = Transform::from_xyz(moved, 0.37 * moved, 0.0);
            small.world().entity_mut(ball).insert(at);
            small.headless.step(1);
            covered(&small.picture()).0
        })
        .collect();
    let mean = areas.iter().sum::<f64>() / f64::from(SHIFTS);
    let variance = areas.iter().map(|a| (a - mean).powi(2)).sum::<f64>() / f64::from(SHIFTS);
    assert!(
        variance.sqrt() < 0.01 * mean,
        "{} of {mean}",
        variance.sqrt()
    );
}

/// A light turns by 80 degrees in 360 frames. The shape moves smoothly, and is where the geometry
/// says at every 90th. A shape that stood still for a frame would bend its way by 0.2 pixels.
#[test]
#[ignore = "long: 361 frames of a moving light"]
fn shapes_move_smoothly_with_the_light() {
    let highlight = StylizedHighlight {
        shape: HighlightShape::Star,
        size: 2.0,
        ..StylizedHighlight::default()
    };
    let mut small = ball(&shaped(highlight), SIZE);
    let sun = only::<DirectionalLight>(&mut small);
    let mut middles = vec![];
    for frame in 0..=360 {
        let degrees = frame as f32 / 4.5 - 40.0;
        let angle = degrees.to_radians();
        let to = Vec3::new(angle.sin(), 0.0, angle.cos());
        let at = Transform::from_translation(to).looking_at(Vec3::ZERO, Vec3::Y);
        small.world().entity_mut(sun).insert(at);
        small.headless.step(if middles.is_empty() { 3 } else { 1 });
        let picture = small.picture();
        let middle = covered(&picture).1;
        if frame % 90 == 0 {
            small.headless.step(2);
            assert!(small.picture() == picture, "{degrees}: the shape lags");
            let half = (to + Vec3::Z).normalize().as_dvec3();
            let wanted = summed(&true_covers(&highlight, half, SIZE)).1;
            assert!(
                middle.distance(wanted) < 0.5,
                "{degrees}: {middle}, not {wanted}"
            );
        }
        middles.push(middle);
    }
    let bends = middles
        .windows(3)
        .map(|at| (at[0] - 2.0 * at[1] + at[2]).length());
    let most = bends.fold(0.0, f64::max);
    assert!(most < 0.05, "{most}");
    assert!(middles[0].distance(middles[360]) > 60.0);
}

/// Only the brightest light draws a shape; of two that are equal, none does, and between, a part of
/// it.
#[test]
fn the_brightest_light_draws_the_sign() {
    // A ring around the plain highlight.
    let highlight = StylizedHighlight {
        offset: Vec2::new(2.5, 0.0),
        ..StylizedHighlight::default()
    };
    let mut small = ball(&shaped(highlight), SHAPE);
    let one = covered(&drawn(&mut small));
    assert!(one.1.x > 40.0, "{one:?}");
    let to = Vec3::new(-1.0, 0.0, 1.0);
    let weak = sun(&mut small, to, bright(0.5));
    let two = covered(&drawn(&mut small));
    // The weaker one's highlight has half its light, and is where it is without a shape.
    assert!(two.0 > 1.3 * one.0 && two.1.x < one.1.x, "{one:?}, {two:?}");
    small.world().entity_mut(weak).insert(bright(0.95));
    let nearly = covered(&drawn(&mut small));
    small.world().entity_mut(weak).insert(bright(1.0));
    let equal = covered(&drawn(&mut small));
    let plain = ToonLight {
        stylized_highlight: None,
        ..shaped(highlight)
    };
    set_light(&mut small, &plain);
    let plain = covered(&drawn(&mut small));
    assert!(equal.1.distance(plain.1) < 0.5, "{equal:?}, {plain:?}");
    // A light that is 5 % brighter draws half of the shape, and half of the plain highlight.
    let moment = |(area, middle): (f64, DVec2)| area * middle.extend(1.0);
    let [one, two, nearly, equal] = [one, two, nearly, equal].map(moment);
    let weak = 2.0 * (two - one);
    let strong = equal - weak;
    let wanted = 0.5 * (one + strong) + 0.95 * weak;
    let off = (nearly - wanted).length();
    assert!(off < 0.01 * wanted.length(), "{nearly}, not {wanted}");
}

/// Behind the camera, a board keeps the light away: shapes and plain highlights vanish, unless the
/// material has no cast shadows.
#[test]
fn cast_shadows_hide_signs() {
    let mut small = ball(&shaped(StylizedHighlight::default()), SIZE);
    let shadows = DirectionalLight {
        shadow_maps_enabled: true,
        ..bright(1.0)
    };
    let sun = only::<DirectionalLight>(&mut small);
    small.world().entity_mut(sun).insert(shadows);
    let board = Transform::from_xyz(0.0, 0.0, 7.0);
    put(
        &mut small,
        Cuboid::new(4.0, 4.0, 0.2),
        &ToonLight::default(),
        board,
    );
    for stylized_highlight in [None, Some(StylizedHighlight::default())] {
        let [shaded, lit] = [true, false].map(|cast_shadows| {
            let light = ToonLight {
                stylized_highlight,
                cast_shadows,
                ..shaped(StylizedHighlight::default())
            };
            set_light(&mut small, &light);
            covered(&drawn(&mut small)).0
        });
        assert!(
            shaded == 0.0 && lit > 300.0,
            "{shaded}, {lit}: {stylized_highlight:?}"
        );
    }
}

/// How much wider than high a shape is, as the logarithm of the ratio of the squares.
fn wider_than_high(picture: &RgbaImage) -> f64 {
    let (area, middle) = covered(picture);
    let mut spread = DVec2::ZERO;
    for (x, y, _) in picture.enumerate_pixels() {
        let at = place([x, y], picture.width()) - middle;
        spread += linear(picture, x, y)[0] / PEAK * at * at;
    }
    assert!(area > 500.0);
    (spread.x / spread.y).ln()
}

/// Signs turn with the picture, the world or the light.
#[test]
fn frames_turn_signs() {
    let highlight = |frame| StylizedHighlight {
        shape: HighlightShape::Streak,
        size: 2.0,
        frame,
        ..StylizedHighlight::default()
    };
    let mut small = ball(&shaped(highlight(HighlightFrame::View)), SHAPE);
    let wide = |small: &mut Small| wider_than_high(&drawn(small));
    assert!(wide(&mut small) > 1.0);
    // The camera lies on its side: the shape of the world stays, that of the picture turns.
    let turned = Transform::from_xyz(0.0, 0.0, 5.0).looking_at(Vec3::ZERO, Vec3::X);
    small.insert(turned);
    assert!(wide(&mut small) > 1.0);
    set_light(&mut small, &shaped(highlight(HighlightFrame::World)));
    assert!(wide(&mut small) < -1.0);
    // A light from above: along it is upwards in the upright picture.
    small.insert(Transform::from_xyz(0.0, 0.0, 5.0));
    let old = only::<DirectionalLight>(&mut small);
    small.world().despawn(old);
    sun(&mut small, Vec3::new(0.0, 1.0, 1.0), bright(1.0));
    set_light(&mut small, &shaped(highlight(HighlightFrame::Light)));
    assert!(wide(&mut small) < -0.5);
}

/// A shape in the frame of the tangents turns with its ball; without tangents it stays.
#[test]
fn tangents_turn_signs() {
    let highlight = StylizedHighlight {
        shape: HighlightShape::Streak,
        size: 2.0,
        frame: HighlightFrame::Tangent,
        ..StylizedHighlight::default()
    };
    let mut small = ball(&shaped(highlight), SHAPE);
    // The seam of the texture is behind, and no pole of it in front.
    let stands = Quat::from_rotation_x(FRAC_PI_2) * Quat::from_rotation_z(FRAC_PI_2);
    for has_tangents in [false, true] {
        if has_tangents {
            let world = small.world();
            let mut meshes = world.resource_mut::<Assets<Mesh>>();
            for (_, mesh) in meshes.iter_mut() {
                mesh.generate_tangents().expect("UVs");
            }
        }
        let mut spread = [0.0, FRAC_PI_2].map(|turn| {
            let at = Transform::from_rotation(Quat::from_rotation_z(turn) * stands);
            let ball = only::<Mesh3d>(&mut small);
            small.world().entity_mut(ball).insert(at);
            wider_than_high(&drawn(&mut small))
        });
        // The direction of the tangents depends on the mesh; that they turn does not.
        if spread[0] < 0.0 {
            spread = spread.map(|log| -log);
        }
        let [before, after] = spread;
        assert!(before > 0.5, "{spread:?}");
        assert!((after < -0.5) == has_tangents, "{spread:?}");
        assert!(has_tangents || (after - before).abs() < 0.05, "{spread:?}");
    }
}

fn rimmed(width: RimWidth, lit_side: f32) -> ToonLight {
    ToonLight {
        highlight: 0.0,
        rim: Some(Rim {
            width,
            color: Color::linear_rgb(PEAK as f32, PEAK as f32, PEAK as f32),
            lit_side,
            ..default()
        }),
        ..default()
    }
}

/// Rims of a ball are rings of a known area.
#[test]
fn rims_are_as_wide_as_they_say() {
    let fraction = 0.4;
    let facing = RimWidth::Facing {
        fraction,
        softness: 0.0,
    };
    let mut small = ball(&rimmed(facing, 0.0), SIZE);
    small.insert(DepthPrepass);
    let all = std::f64::consts::PI * RADIUS * RADIUS;
    let (area, middle) = covered(&drawn(&mut small));
    let wanted = all * f64::from(fraction * fraction);
    assert!((area / wanted - 1.0).abs() < 0.02, "{area}, not {wanted}");
    assert!(middle.length() < 0.3);
    // Half of the strength is half of the light.
    let mut weak = rimmed(facing, 0.0);
    weak.rim.as_mut().expect("a rim").strength = 0.5;
    set_light(&mut small, &weak);
    let half = covered(&drawn(&mut small)).0;
    assert!((half / area - 0.5).abs() < 0.01, "{half} of {area}");
    // A tenth of the step of `smoothstep` is at 0.196 of its width. The part of the ball between
    // two cosines is the difference of their squares.
    let softness = 0.4;
    set_light(
        &mut small,
        &rimmed(RimWidth::Facing { fraction, softness }, 0.0),
    );
    let soft = covers(&drawn(&mut small));
    let between = soft
        .iter()
        .filter(|cover| (0.1..0.9).contains(*cover))
        .count() as f64;
    let wanted = all * f64::from(2.0 * fraction * softness) * (1.0 - 2.0 * 0.196);
    assert!(
        (between / wanted - 1.0).abs() < 0.02,
        "{between}, not {wanted}"
    );
    let mut around = 0.0;
    for pixels in [2.0f32, 9.0, 5.0] {
        set_light(&mut small, &rimmed(RimWidth::Pixels(pixels), 0.0));
        let (area, middle) = covered(&drawn(&mut small));
        let wanted = all * (1.0 - (1.0 - f64::from(pixels) / RADIUS).powi(2));
        // The border of the depth is that of whole pixels.
        assert!(
            (area / wanted - 1.0).abs() < 0.05,
            "{pixels}: {area}, not {wanted}"
        );
        assert!(middle.length() < 1.0);
        around = area;
    }
    // On the side of a light from the right, and without the prepass as `Facing`.
    let old = only::<DirectionalLight>(&mut small);
    small.world().despawn(old);
    sun(&mut small, Vec3::X, bright(1.0));
    let mut covered_by = |lit_side| {
        set_light(&mut small, &rimmed(RimWidth::Pixels(5.0), lit_side));
        covered(&drawn(&mut small))
    };
    let [(half, _), (lit, middle)] = [0.5, 1.0].map(&mut covered_by);
    assert!(middle.x > 0.4 * RADIUS, "{middle}");
    // Half on that side is the mean of all and none.
    let mean = 0.5 * (around + lit);
    assert!(
        lit < 0.8 * around && (half / mean - 1.0).abs() < 0.01,
        "{half}, not {mean}"
    );
}

/// Truth: the inner border of a rim of constant width is a straight line along a pillar that leans,
/// where it should be. The border of the depth has the steps of pixels, or of their samples: half
/// of a pixel, or of the half pixel that four samples are apart at most.
#[test]
fn rims_of_constant_width_have_straight_borders() {
    check_rims([(Msaa::Off, 0.5, LEANS), (Msaa::Sample4, 0.25, &LEANS[1..2])]);
}

#[test]
#[ignore = "long: more pillars of four samples"]
fn multisampled_rims_of_constant_width_have_straight_borders() {
    check_rims([(Msaa::Sample4, 0.25, LEANS)]);
}

/// Degrees by which pillars lean.
const LEANS: &[f64] = &[3.0, 17.0, 40.0];

/// Samples, how far a border may be off in pixels, and how far pillars lean.
fn check_rims<'a>(all: impl IntoIterator<Item = (Msaa, f64, &'a [f64])>) {
    let pixels = 8.0f64;
    let radius = 0.35;
    let pillar = || Cylinder::new(radius, 6.0).mesh().resolution(256);
    let size = UVec2::new(192, 96);
    let mut small = view(size);
    for (msaa, limit, leans) in all {
        for &degrees in leans {
            small.clear();
            small.insert((msaa, DepthPrepass));
            let lean = degrees.to_radians();
            let at = Transform::from_rotation(Quat::from_rotation_z(-lean as f32));
            let light = rimmed(RimWidth::Pixels(pixels as f32), 0.0);
            put(&mut small, pillar(), &light, at);
            polish(&mut small);
            sun(&mut small, Vec3::Z, bright(1.0));
            let picture = drawn(&mut small);
            let middle = 0.5 * size.as_dvec2();
            let scale = 0.5 * f64::from(SIZE);
            let inner = (f64::from(radius) * scale - pixels) / lean.cos();
            let (mut sum, mut worst) = (0.0, 0.0f64);
            let rows = 10..86;
            for y in rows.clone() {
                // Rows go down, and the pillar leans to the right.
                let axis = middle.x + (middle.y - f64::from(y) - 0.5) * lean.tan();
                // What is not covered between the axis and a place well inside of the rim.
                let first = (axis - inner - 3.0).floor() as u32;
                let last = axis.floor() as u32;
                let bare = (first..last).map(|x| 1.0 - linear(&picture, x, y)[0] / PEAK);
                // Across the border.
                let off = (f64::from(last) - bare.sum::<f64>() - (axis - inner)) * lean.cos();
                sum += off;
                worst = worst.max(off.abs());
            }
            let mean = sum / f64::from(rows.end - rows.start);
            assert!(
                worst < limit && mean.abs() < 0.2,
                "{msaa:?}, {degrees}: {worst}, {mean}"
            );
        }
    }
}
