//! Lines towards a point and alongside each other.

use std::f64::consts::TAU;

use bevy::math::UVec4;
use bevy_comics_testkit::reference::speed_lines::Drawing;

use super::*;
use crate::prelude::*;

const IMPORTS: &str = "#import bevy_comics::effects::speed_lines::{SpeedLines, atan_of_fraction, speed_line_coverage}";

/// The fields of the uniform.
const FIELDS: [&str; 13] = [
    "vec3<f32>",
    "f32",
    "vec2<f32>",
    "vec2<f32>",
    "vec2<f32>",
    "f32",
    "f32",
    "i32",
    "u32",
    "f32",
    "u32",
    "f32",
    "f32",
];

/// The settings as a WGSL expression, from the bytes of the uniform.
fn settings(lines: &SpeedLines, view: &EffectContext) -> String {
    let bytes = lines.uniform_bytes(view);
    let mut at = 0usize;
    let values = FIELDS.map(|field| {
        let (align, count) = match field {
            "vec3<f32>" => (16, 3),
            "vec2<f32>" => (8, 2),
            _ => (4, 1),
        };
        at = at.next_multiple_of(align);
        let words = bytes[at..at + 4 * count].chunks_exact(4).map(|word| {
            let word = word.try_into().expect("four bytes");
            match field {
                "i32" => i32::from_le_bytes(word).to_string(),
                "u32" => format!("{}u", u32::from_le_bytes(word)),
                _ => format!("{:?}", f32::from_le_bytes(word)),
            }
        });
        at += 4 * count;
        format!("{field}({})", words.collect::<Vec<_>>().join(", "))
    });
    assert!(bytes.len() < at + 16, "the uniform has more fields");
    format!("SpeedLines({})", values.join(", "))
}

/// A view of this size in physical pixels, at a scale factor, `seconds` after the start.
fn view([width, height]: [u32; 2], scale_factor: f32, seconds: f64) -> EffectContext {
    let mut context = EffectContext::default();
    context.viewport = UVec4::new(0, 0, width, height);
    context.scale_factor = scale_factor;
    context.seconds = seconds;
    context
}

fn coverage(lines: &SpeedLines, context: &EffectContext, places: &[[f32; 2]]) -> Vec<f64> {
    let s = settings(lines, context);
    let body = format!(
        "let s = {s};
         return vec4(speed_line_coverage(s, vec2(i(0u), i(1u))), 0.0, 0.0, 0.0);"
    );
    let found = gpu().evaluate(IMPORTS, &body, places);
    found.iter().map(|v| f64::from(v[0])).collect()
}

fn reference(lines: &SpeedLines, context: &EffectContext) -> Drawing {
    let size = [context.viewport.z, context.viewport.w].map(f64::from);
    let center = lines.center.to_array().map(f64::from);
    Drawing {
        settings: *lines,
        size,
        scale: f64::from(context.scale_factor),
        center: [center[0] * size[0], center[1] * size[1]],
        number: context.animation_seed(lines.rate),
    }
}

#[test]
fn the_arc_tangent_is_exact() {
    let rows: Vec<[f32; 1]> = (0..=1000u16).map(|n| [f32::from(n) / 1000.0]).collect();
    let results = gpu().evaluate(
        IMPORTS,
        "return vec4(atan_of_fraction(i(0u)), 0.0, 0.0, 0.0);",
        &rows,
    );
    for (row, found) in rows.iter().zip(results) {
        let apart = f64::from(found[0]) - f64::from(row[0]).atan();
        assert!(apart.abs() < 2e-7, "{row:?}: {apart}");
    }
}

/// Truth: around a circle, the lines cover the sum of their widths, and each is there once,
/// at every scale factor. The widths are what the settings say, in the mean.
#[test]
fn lines_cover_their_widths_around_a_circle() {
    const POINTS: u32 = 120_000;
    for scale in [1.0f32, 1.25, 3.0] {
        let size = [1000, 600].map(|v| (f64::from(v) * f64::from(scale)) as u32);
        let context = view(size, scale, 0.0);
        let lines = SpeedLines {
            inner: 0.3,
            width: 6.0,
            ..SpeedLines::default()
        };
        let drawing = reference(&lines, &context);
        // Beyond the last inner end (0.3 * 500 * 1.8 = 270) and as far as the corners.
        for rho in [300.0, 450.0, 583.0] {
            let rho = rho * f64::from(scale);
            let place = |n: u32| {
                let (sin, cos) = (f64::from(n) / f64::from(POINTS) * TAU).sin_cos();
                [rho * cos, rho * sin]
            };
            let places: Vec<[f32; 2]> = (0..POINTS)
                .map(|n| {
                    let at = place(n);
                    [0, 1].map(|i| (drawing.center[i] + at[i]) as f32)
                })
                .collect();
            let found = coverage(&lines, &context, &places);
            let covered: f64 = found.iter().sum::<f64>() * TAU * rho / f64::from(POINTS);
            // Radii of the ellipse differ along the circle: that of each line's direction.
            let widths: f64 = (0..lines.count)
                .map(|line| {
                    let [turn, _] = drawing.radial(line, rho, 1.0);
                    let (sin, cos) = ((turn - 0.5) * TAU).sin_cos();
                    2.0 * drawing.radial(line, rho, drawing.border([cos, sin]))[1]
                })
                .sum();
            // Lines that overlap cover less than their sum: neighbors of this width rarely
            // do so.
            let apart = covered / widths - 1.0;
            assert!((-0.02..0.005).contains(&apart), "{scale}, {rho}: {apart}");
            let begins = (0..POINTS as usize)
                .filter(|n| {
                    found[*n] > 0.0 && found[(n + POINTS as usize - 1) % POINTS as usize] == 0.0
                })
                .count();
            assert!(
                (100..=120).contains(&begins),
                "{scale}, {rho}: {begins} lines"
            );
            if rho >= 583.0 * f64::from(scale) {
                // At the corners: the mean of 0.2 + 0.8 u^2 is 0.467.
                let mean = covered / f64::from(lines.count) / f64::from(scale) / 6.0;
                assert!((mean - 0.467).abs() < 0.06, "{scale}: {mean}");
            }
        }
    }
}

/// Truth: nothing is drawn in the ellipse that stays clear, of either kind.
#[test]
fn the_middle_stays_clear() {
    let context = view([1000, 600], 1.0, 3.0);
    for kind in [SpeedLineKind::Radial, SpeedLineKind::Parallel] {
        let lines = SpeedLines {
            kind,
            inner: 0.6,
            count: 400,
            width: 40.0,
            ..SpeedLines::default()
        };
        let places: Vec<[f32; 2]> = (0..20_000u16)
            .map(|n| {
                let (turn, part) = (f32::from(n) * 0.618, f32::from(n) / 20_000.0);
                let (sin, cos) = (turn * TAU as f32).sin_cos();
                // A parallel line is as wide as it is: its middle is outside.
                let by = 0.5 * part.sqrt() * 0.97;
                [500.0 + 600.0 * by * cos, 300.0 + 360.0 * by * sin]
            })
            .collect();
        let found = coverage(&lines, &context, &places);
        let ink = found.iter().filter(|c| **c > 0.0).count();
        assert_eq!(ink, 0, "{kind:?}");
    }
}
