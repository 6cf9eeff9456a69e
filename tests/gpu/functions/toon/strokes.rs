//! Strokes and dots of a surface of the toon material.

use bevy_comics::effect::linear_rgb;
use bevy_comics_testkit::{
    device::gpu,
    reference::{
        hatch::hatch_tone,
        hatching::{Hatch, Surface},
    },
};

use super::Numbers;
use crate::prelude::*;

/// A pixel, a share of light, a colour, seconds, drawings per second, the factor of the darkness, the
/// opacity, the ground; a place at rest with its changes over a pixel and its normal.
type Row = [f32; 23];

const READ: &str = "#import bevy_comics::toon::hatch_light::{HatchPlace, hatch, with_hatching}
    #import bevy_comics::effect::strokes::Surface
    #import bevy_pbr::mesh_view_bindings::globals
    fn v(n: u32) -> vec3<f32> { return vec3(i(n), i(n + 1u), i(n + 2u)); }
    fn place() -> HatchPlace {
        globals.time = i(6u);
        hatch.rate = i(7u);
        hatch.factor = i(8u);
        hatch.strokes.opacity = i(9u);
        hatch.strokes.ground = u(10u);
        hatch.strokes.spacing = 5.0;
        hatch.strokes.length = 60.0;
        hatch.strokes.layers = 3u;
        hatch.strokes.layer_darkness = 0.45;
        hatch.strokes.breaks = 0.3;
        hatch.strokes.wobble = 0.4;
        hatch.strokes.pressure = 0.2;
        hatch.strokes.shadows = 0.1;
        hatch.strokes.highlights = 0.8;
        hatch.strokes.gamma = 1.5;
        hatch.strokes.ink = INK;
        hatch.strokes.paper = PAPER;
        hatch.strokes.axes = AXES;
        var at: HatchPlace;
        at.pixel = vec2(i(0u), i(1u));
        at.rest = Surface(v(11u), vec3(0.0), v(14u), v(17u), v(20u));
        return at;
    }";

fn settings(row: &Row, marks: HatchingMarks) -> Hatching {
    Hatching {
        marks,
        spacing: 5.0,
        length: 60.0,
        layers: 3,
        layer_darkness: 0.45,
        breaks: 0.3,
        wobble: 0.4,
        pressure: 0.2,
        shadows: 0.1,
        highlights: 0.8,
        gamma: 1.5,
        at_near: row[8],
        opacity: row[9],
        ground: if row[10] == 1.0 {
            HatchingGround::Paper
        } else {
            HatchingGround::Color
        },
        ..Hatching::default()
    }
}

/// What `READ` takes from settings, as WGSL.
fn constants(marks: HatchingMarks) -> String {
    let s = settings(&[0.0; 23], marks);
    let text = |[x, y, z]: [f32; 3]| format!("vec3<f32>({x:?}, {y:?}, {z:?})");
    let axes = s.axes().map(|axis| text(axis.normalize().to_array()));
    let [ink, paper] = [s.ink, s.paper].map(|color| text(linear_rgb(color).to_array()));
    format!(
        "const INK = {ink}; const PAPER = {paper}; const AXES = mat3x3<f32>({});",
        axes.join(", ")
    )
}

fn rows(count: usize) -> Vec<Row> {
    let mut n = Numbers::new(91);
    let row = |_| {
        let mut row = [0.0; 23];
        let scale = 10f32.powf(n.within(-3.0, 1.0));
        row[..11].copy_from_slice(&[
            n.within(0.0, 900.0),
            n.within(0.0, 900.0),
            n.part(),
            n.part(),
            n.part(),
            n.part(),
            n.within(0.0, 5.0),
            if n.once_in(3) { 0.0 } else { 8.0 },
            n.part(),
            n.part(),
            if n.once_in(2) { 1.0 } else { 0.0 },
        ]);
        let (normal, other) = (n.unit(), n.unit());
        let [normal, other] = [normal, other].map(vector);
        let across = normal
            .cross(other)
            .normalize_or(normal.any_orthonormal_vector());
        let down = normal.cross(across) * f64::from(n.within(0.2, 1.0));
        let place = vector(n.unit()) * f64::from(n.within(0.0, 300.0));
        let parts = [place, across, down].map(|part| part * f64::from(scale));
        for (slot, value) in row[11..]
            .chunks_mut(3)
            .zip([parts[0], parts[1], parts[2], normal])
        {
            slot.copy_from_slice(&value.as_vec3().to_array());
        }
        row
    };
    (0..count).map(row).collect()
}

fn vector(of: [f32; 3]) -> DVec3 {
    DVec3::from_array(of.map(f64::from))
}

/// Strokes and dots, on the page and on surfaces at rest. Where rounding decides which mark is meant, the
/// reference a little beside the pixel is as good.
#[test]
fn surfaces_with_strokes_match_the_reference() {
    let variants: [(HatchingMarks, bool, &[Definition]); 4] = [
        (HatchingMarks::Strokes, false, &[]),
        (HatchingMarks::Strokes, true, &[("HATCH_REST", None)]),
        (HatchingMarks::Dots, false, &[("HATCH_DOTS", None)]),
        (
            HatchingMarks::Dots,
            true,
            &[("HATCH_DOTS", None), ("HATCH_REST", None)],
        ),
    ];
    for (marks, at_rest, definitions) in variants {
        let rows = rows(4096);
        let body = "let at = place(); return vec4(with_hatching(v(3u), i(2u), at), 0.0);";
        let import = format!("{}\n{READ}", constants(marks));
        let results = gpu().evaluate_alone(definitions, &import, body, &rows);
        let (mut apart, mut inked) = (0, 0);
        for (row, found) in rows.iter().zip(results) {
            let s = settings(row, marks);
            let hatch = Hatch {
                settings: &s,
                scale: 1.0,
                drawing: ((f64::from(row[6]) + 1e-6) * f64::from(row[7])) as u32,
            };
            let three = |k: usize| vector([row[k], row[k + 1], row[k + 2]]);
            let on = if at_rest {
                Surface {
                    place: three(11),
                    across: three(14),
                    down: three(17),
                    normal: three(20),
                }
            } else {
                let pixel = [row[0], row[1]].map(f64::from);
                Surface::page(pixel.into(), f64::from(s.spacing))
            };
            let color = three(3).to_array();
            let tone = hatch_tone(&s, row[2].into(), 1.0);
            let colors = [-0.02, 0.0, 0.02].map(|by| {
                let place = on.place + by * (on.across + on.down);
                hatch.hatched(color, tone, hatch.cover(&Surface { place, ..on }, tone))
            });
            let is_near = (0..3).all(|k| {
                let of = colors.map(|color| color[k]);
                let low = of.into_iter().fold(f64::MAX, f64::min) - 0.01;
                let high = of.into_iter().fold(f64::MIN, f64::max) + 0.01;
                (low..=high).contains(&f64::from(found[k]))
            });
            apart += usize::from(!is_near);
            inked += usize::from(DVec3::from_array(colors[1]).distance(three(3)) > 0.1);
        }
        assert!(inked > 1000, "{inked} rows with ink or paper");
        let most = rows.len() / 200;
        assert!(apart <= most, "{definitions:?}: {apart} of {}", rows.len());
    }
}
