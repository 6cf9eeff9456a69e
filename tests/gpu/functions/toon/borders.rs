//! Borders of the shadows of two lights in one pixel, under a ramp over the fraction of all light.

use bevy_comics_testkit::{device::gpu, reference::color::luminance};

use super::Numbers;
use crate::prelude::*;

const PIECES: usize = 128;

/// For each of two lights: its color, its direction, and the fraction of it that arrives. Then the normal
/// of the surface, and how much of the strength of the light is kept.
type Row = [f32; 18];

const LIT: [usize; 2] = [6, 13];

const READ: &str = "#import bevy_comics::toon::bindings::toon
    #import bevy_comics::toon::light_fraction::{Sum, add, reflected}
    #import bevy_comics::toon::ramp::Stop
    #import bevy_comics::toon::surface::{Arriving, Surface}
    #import bevy_pbr::mesh_view_bindings::view
    fn v(n: u32) -> vec3<f32> { return vec3(i(n), i(n + 1u), i(n + 2u)); }
    fn stop(k: u32, at: f32, color: vec3<f32>) {
        toon.ramp.stops[k].color = color;
        toon.ramp.stops[k].at = at;
        toon.ramp.stops[k].softness = 0.2;
    }
    fn lamp(n: u32) -> Arriving {
        var l: Arriving;
        l.color = v(n);
        l.smooth_color = v(n);
        l.to_light = v(n + 3u);
        l.to_highlight = v(n + 3u);
        l.lit = i(n + 6u);
        l.diffuse = 1.0;
        return l;
    }";

const BODY: &str = "stop(0u, 0.0, vec3(0.1, 0.05, 0.3));
    stop(1u, 0.2, vec3(0.5, 0.4, 0.6));
    stop(2u, 0.5, vec3(1.0, 0.9, 0.8));
    view.exposure = 1.0;
    toon.light.form_shadow = 1.0;
    toon.light.cast_shadow = 1.0;
    toon.ramp.keep_intensity = i(17u);
    var s: Surface;
    s.normal = v(14u);
    var sum: Sum;
    add(&sum, s, lamp(0u), 1.0);
    add(&sum, s, lamp(7u), 1.0);
    return vec4(reflected(sum, vec3(1.0), vec3(0.02), vec3(0.0)), 0.0);";

fn with_lit(row: &Row, lit: [f64; 2]) -> Row {
    let mut row = *row;
    for (slot, lit) in LIT.into_iter().zip(lit) {
        row[slot] = lit as f32;
    }
    row
}

/// The largest channel that a row can have: that of all light, times the strength that the ramp
/// gives it.
fn brightest(row: &Row) -> f64 {
    let color = |c: usize| f64::from(row[c] + row[7 + c]) / std::f64::consts::PI + 0.02;
    let all = [0, 1, 2].map(color);
    let strength = luminance(all).powf(f64::from(row[17]) - 1.0);
    strength * all.into_iter().fold(0.0, f64::max)
}

/// Truth: a pixel in which the borders of two shadows cross at right angles has the mean of 128 x
/// 128 pieces, in each of which either light arrives or does not.
#[test]
fn crossing_borders_of_shadows_are_mixed_by_their_areas() {
    let mut n = Numbers::new(23);
    let (mut pixels, mut states, mut parts) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..64 {
        let color = |n: &mut Numbers| [0; 3].map(|_| n.part());
        let [first, second] = [0; 2].map(|_| [color(&mut n), n.unit()].concat());
        let lamps = [&first[..], &[0.0], &second, &[0.0]].concat();
        let row = [&lamps[..], &n.unit(), &[n.part()]].concat();
        let row = Row::try_from(row).expect("18 numbers");
        // Borders through the pixel: x cos a + y sin a = c, and the other one at a right angle.
        // Every second pair is parallel to the sides of the pixel.
        let angle = f64::from(n.within(0.0, 6.3));
        let (sin, cos) = if k % 2 == 0 {
            (0.0, 1.0)
        } else {
            angle.sin_cos()
        };
        let [c, d] = [0; 2].map(|_| f64::from(n.within(-0.3, 0.3)));
        let mut counts = [0usize; 4];
        for i in 0..PIECES * PIECES {
            let at = |k: usize| (k as f64 + 0.5) / PIECES as f64 - 0.5;
            let (x, y) = (at(i % PIECES), at(i / PIECES));
            let lit = [x * cos + y * sin > c, y * cos - x * sin > d];
            counts[usize::from(lit[0]) + 2 * usize::from(lit[1])] += 1;
        }
        let part = counts.map(|n| n as f64 / (PIECES * PIECES) as f64);
        pixels.push(with_lit(&row, [part[1] + part[3], part[2] + part[3]]));
        states.extend([0, 1, 2, 3].map(|k| with_lit(&row, [k & 1, k >> 1].map(f64::from))));
        parts.push(part);
    }
    let colors = |rows: &[Row]| gpu().evaluate_alone(&[("RAMP_STOPS", Some(3))], READ, BODY, rows);
    let (found, states) = (colors(&pixels), colors(&states));
    let mut mixed = 0;
    for (k, part) in parts.iter().enumerate() {
        // The mixture takes the borders as independent of each other, which they are in a pixel
        // whose sides they are parallel to.
        let together = part[3] - (part[1] + part[3]) * (part[2] + part[3]);
        let most = if k % 2 == 0 { 1e-9 } else { 0.05 };
        assert!(together.abs() < most, "{together}");
        let bound = (2.0 * together.abs() + 1e-3) * brightest(&pixels[k]);
        for c in 0..3 {
            let states: [f64; 4] = std::array::from_fn(|s| states[4 * k + s][c].into());
            let mean: f64 = part
                .iter()
                .zip(states)
                .map(|(part, state)| part * state)
                .sum();
            let off = (f64::from(found[k][c]) - mean).abs();
            assert!(off <= bound, "{:?}: {off}, not {bound}", pixels[k]);
            mixed += usize::from(states[0] < mean - 0.01 && mean < states[3] - 0.01);
        }
    }
    assert!(mixed > 40, "{mixed} mixtures");
}
