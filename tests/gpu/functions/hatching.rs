//! Hatching: surfaces, families of planes, layers, tones.

use bevy_comics_testkit::reference::hatching::{Hatch, Surface, strokes_left};

use super::*;
use crate::prelude::*;

const HATCHING: &str = "
    #import bevy_comics::effect::strokes::{Strokes, Surface, darkness, ground_color, hatched, page_at}
    #import bevy_comics::effects::hatching::{continues, strokes_left, surface_at}";

/// A view of 90 degrees, 96 x 64 pixels, from the origin.
pub const VIEW: &str = "const VIEW = mat4x4<f32>(
        vec4(1.5, 0.0, 0.0, 0.0), vec4(0.0, 1.0, 0.0, 0.0),
        vec4(0.0, 0.0, 0.0, 10.0), vec4(0.0, 0.0, -1.0, 0.0),
    );";

pub fn view() -> DMat4 {
    DMat4::from_cols_array(&[
        1.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, -1.0, 0.0,
    ])
}

/// Planes at all angles and distances, to the rim of what is seen.
#[test]
fn surfaces_are_those_that_rays_meet() {
    let row = (
        -1.0f32..=1.0,
        -1.0f32..=1.0,
        -2.0f32..=2.0,
        0.5f32..=100.0,
        -0.9f32..=0.9,
        -0.9f32..=0.9,
    )
        .prop_filter_map("seen from the front", |(yaw, pitch, _, distance, x, y)| {
            let normal = Vec3::new(yaw, pitch, 1.0).normalize();
            let ray = Vec3::new(1.5 * x, y, -1.0).normalize();
            (normal.dot(ray) < -0.05).then_some([normal.x, normal.y, normal.z, distance, x, y])
        });
    for_batches(row, |rows| {
        for part in ["place", "across", "down"] {
            let results = gpu().evaluate(
                &format!("{HATCHING}\n{VIEW}"),
                &format!(
                    "let clip = vec2(i(4u), i(5u));
                     let h = VIEW * vec4(clip, 0.1 / i(3u), 1.0);
                     let n = vec3(i(0u), i(1u), i(2u));
                     let on = surface_at(VIEW, h, vec2(2.0 / 96.0, -2.0 / 64.0), n);
                     return vec4(on.{part}, 0.0);"
                ),
                rows,
            );
            for (row, found) in rows.iter().zip(results) {
                let [x, y, z, distance, cx, cy] = row.map(f64::from);
                let clip = DVec2::new(cx, cy);
                let origin = DVec3::new(1.5 * cx, cy, -1.0) * distance;
                let normal = DVec3::new(x, y, z);
                let plane = (origin, normal);
                let on = Surface::of_plane(view(), clip, DVec2::new(96.0, 64.0), plane);
                let want = match part {
                    "place" => on.place,
                    "across" => on.across,
                    _ => on.down,
                };
                let found = DVec3::new(found[0].into(), found[1].into(), found[2].into());
                assert!(
                    found.distance(want) < 1e-4 * want.length(),
                    "{part} of {row:?}: {found}, {want}"
                );
            }
        }
    });
}

fn settings(row: &[f32; 12]) -> Hatching {
    Hatching {
        spacing: row[4],
        length: row[5],
        breaks: row[6],
        wobble: row[7],
        pressure: row[8],
        layers: row[9] as u32,
        angle: row[10],
        ..Hatching::default()
    }
}

/// Whether a coverage is that of the reference, there or a little beside it: where rounding decides which mark is
/// meant, both are right.
pub fn is_near(hatch: &Hatch, on: &Surface, tone: f64, found: f64) -> bool {
    let near = [-0.02, 0.0, 0.02].map(|by| {
        let moved = Surface {
            place: on.place + by * (on.across + on.down),
            ..*on
        };
        hatch.cover(&moved, tone)
    });
    let low = near.iter().copied().fold(f64::MAX, f64::min) - 0.01;
    let high = near.iter().copied().fold(f64::MIN, f64::max) + 0.01;
    (low..=high).contains(&found)
}

/// Every tone, angle and level. Where rounding decides which line or which axis is meant, the
/// reference a little beside it is as good.
#[test]
fn strokes_match_the_reference() {
    let fraction = || 0.0f32..=1.0;
    let row = (
        (-1.0f32..=1.0, -1.0f32..=1.0),
        (0.5f32..=60.0, 0.01f32..=1.0),
        (2.0f32..=24.0, 10.0f32..=400.0),
        (fraction(), fraction(), fraction()),
        (1u32..=3, -90.0f32..=90.0),
        (-0.9f32..=0.9),
    )
        .prop_map(
            |(
                (a, b),
                (distance, tone),
                (spacing, length),
                (breaks, wobble, pressure),
                (layers, angle),
                x,
            )| {
                [
                    a,
                    b,
                    distance,
                    tone,
                    spacing,
                    length,
                    breaks,
                    wobble,
                    pressure,
                    layers as f32,
                    angle,
                    x,
                ]
            },
        );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            &format!("{HATCHING}\n{VIEW}"),
            "var s: Strokes;
             s.spacing = i(4u); s.length = i(5u); s.breaks = i(6u); s.wobble = i(7u);
             s.pressure = i(8u); s.layers = u32(i(9u)); s.layer_darkness = 0.45; s.seed = 7u;
             let angle = radians(i(10u));
             let turn = mat3x3(vec3(cos(angle), 0.0, -sin(angle)), vec3(0.0, 1.0, 0.0),
                 vec3(sin(angle), 0.0, cos(angle)));
             s.axes = turn * mat3x3(vec3(2.0, 2.0, -1.0) / 3.0, vec3(-1.0, 2.0, 2.0) / 3.0,
                 vec3(2.0, -1.0, 2.0) / 3.0);
             let n = normalize(vec3(i(0u), i(1u), 1.5));
             let h = VIEW * vec4(i(11u), 0.3, 0.1 / i(2u), 1.0);
             let on = surface_at(VIEW, h, vec2(2.0 / 96.0, -2.0 / 64.0), n);
             return vec4(hatched(s, on, i(3u)), hatched(s, page_at(on.place.xy * 9.0, s.spacing), i(3u)), 0.0, 0.0);",
            rows,
        );
        let mut apart = 0;
        for (row, found) in rows.iter().zip(results) {
            let s = settings(row);
            let hatch = Hatch {
                settings: &s,
                scale: 1.0,
                drawing: 7,
            };
            let [a, b, distance, tone] = [0, 1, 2, 3].map(|k| f64::from(row[k]));
            let clip = DVec2::new(f64::from(row[11]), f64::from(0.3f32));
            let place = DVec3::new(1.5 * clip.x, clip.y, -1.0) * distance;
            let normal = DVec3::new(a, b, 1.5).normalize();
            let plane = (place, normal);
            let on = Surface::of_plane(view(), clip, DVec2::new(96.0, 64.0), plane);
            let page = Surface::page(DVec2::new(place.x, place.y) * 9.0, f64::from(s.spacing));
            for (on, found) in [on, page].into_iter().zip(found) {
                apart += usize::from(!is_near(&hatch, &on, tone, f64::from(found)));
            }
        }
        assert!(apart <= rows.len() / 200, "{apart} of {}", 2 * rows.len());
    });
}

#[test]
fn tones_and_grounds_match_the_reference() {
    let row = (
        0.0f32..=1.0,
        0.0f32..=0.9,
        0.05f32..=1.0,
        0.25f32..=4.0,
        0u32..=12,
        0.0f32..=1.0,
    )
        .prop_map(|(light, low, high, gamma, tones, color)| {
            [light, low, high.max(low + 0.05), gamma, tones as f32, color]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            HATCHING,
            "var s: Strokes;
             s.shadows = i(1u); s.highlights = i(2u); s.gamma = i(3u); s.levels = i(4u);
             s.ink = vec3(0.1, 0.0, 0.3);
             let ground = ground_color(s, vec3(i(5u), 0.5, 1.5), i(0u));
             return vec4(darkness(s, i(0u)), ground);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let s = Hatching {
                shadows: row[1],
                highlights: row[2],
                gamma: row[3],
                tones: row[4] as u32,
                ink: Color::linear_rgb(0.1, 0.0, 0.3),
                ground: HatchingGround::Color,
                ..Hatching::default()
            };
            let hatch = Hatch {
                settings: &s,
                scale: 1.0,
                drawing: 0,
            };
            let [light, color] = [0, 5].map(|k| f64::from(row[k]));
            let near = [-1e-5, 0.0, 1e-5].map(|by| hatch.tone(light + by));
            let same = |want: f64| (want - f64::from(found[0])).abs() < 2e-3;
            assert!(near.into_iter().any(same), "{row:?}: {found:?}, {near:?}");
            let ground = hatch.hatched([color, 0.5, 1.5], light, 0.0);
            for (found, want) in found[1..].iter().zip(ground) {
                let away = (f64::from(*found) - want).abs();
                assert!(away < 1e-4 * want.max(1.0), "{row:?}: {found}, {want}");
            }
        }
    });
}

#[test]
fn strokes_are_left_as_by_the_reference() {
    let row = (0.0f32..=1.0, vec(0.0f32..=0.7, 4))
        .prop_map(|(calm, gaps)| [calm, gaps[0], gaps[1], gaps[2], gaps[3]]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            HATCHING,
            "let sum = continues(i(1u)) + continues(i(2u)) + continues(i(3u)) + continues(i(4u));
             return vec4(strokes_left(i(0u), sum), 0.0, 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let gaps = [1, 2, 3, 4].map(|k| f64::from(row[k]));
            let want = strokes_left(f64::from(row[0]), gaps);
            assert!(
                (f64::from(found[0]) - want).abs() < 1e-5,
                "{row:?}: {found:?}, {want}"
            );
        }
    });
}
