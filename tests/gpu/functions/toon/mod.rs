//! What a surface of the toon material reflects of lights, against references: the shipped functions,
//! with their uniforms, the view and the lights as variables.

mod around;
mod lamp_shadow;
mod lights;
mod modes;
mod reflect;
mod signs;
mod strokes;

use bevy_comics_testkit::reference::toon::{
    surface::{Arriving, Footprint, Surface},
    two_shades::Evenly,
};

use crate::prelude::*;

/// Numbers that look random.
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// From 0 to 1, both included.
    pub fn part(&mut self) -> f32 {
        // SplitMix64 (Steele, Lea and Flood 2014).
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / ((1 << 24) - 1) as f32
    }

    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.part()
    }

    /// Whether something happens that happens once in `n` times.
    pub fn once_in(&mut self, n: u32) -> bool {
        self.part() * (n as f32) < 1.0
    }

    pub fn unit(&mut self) -> [f32; 3] {
        loop {
            let v = [0; 3].map(|_| f64::from(self.within(-1.0, 1.0)));
            let long = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (0.1..=1.0).contains(&long) {
                return v.map(|x| (x / long) as f32);
            }
        }
    }
}

pub const LAMPS: usize = 4;
const LAMP: usize = 16;
/// Of a lamp, what arrives.
const LIT: usize = 13;
const SURFACE: usize = LAMPS * LAMP;
const SETTINGS: usize = SURFACE + 28;
const EVENLY: usize = SETTINGS + 7;
const STOPS: usize = EVENLY + 9;
const STOP: usize = 10;
/// Of the ramps, as many as of its second ramp.
const STOP_COUNT: usize = 3;
const COUNT: usize = STOPS + STOP_COUNT * STOP;
const POWER: usize = COUNT + 1;
const BIAS_STEPS: usize = POWER + 1;
/// Lights, a surface, settings, light from all around, stops, the number of lights, the exponent of the
/// detail by highlights, and the change of the surface's bias.
pub const ROW: usize = BIAS_STEPS + 2;

pub type Row = [f32; ROW];

/// Reads a row. Every name is that of the shipped WGSL.
pub const READ: &str = "#import bevy_comics::toon::bindings::toon
    #import bevy_comics::toon::ramp::Stop
    #import bevy_comics::toon::surface::{Arriving, Surface}
    #import bevy_comics::effect::color::linear_to_oklab
    #import bevy_pbr::mesh_view_bindings::view
    fn v(n: u32) -> vec3<f32> { return vec3(i(n), i(n + 1u), i(n + 2u)); }
    fn lamp(k: u32) -> Arriving {
        let n = 16u * k;
        var l: Arriving;
        l.color = v(n);
        l.smooth_color = v(n + 3u);
        l.to_light = v(n + 6u);
        l.to_highlight = v(n + 9u);
        l.per_distance = i(n + 12u);
        l.lit = i(n + 13u);
        l.diffuse = i(n + 14u);
        l.shine = i(n + 15u);
        return l;
    }
    fn surface() -> Surface {
        var s: Surface;
        s.normal = v(64u);
        s.to_eye = v(67u);
        s.foot.normal_x = v(70u);
        s.foot.normal_y = v(73u);
        s.foot.bias = vec2(i(140u), i(141u));
        s.bias = i(76u);
        s.detail = i(77u);
        s.roughness = i(78u);
        s.position = v(79u);
        s.foot.position_x = v(82u);
        s.foot.position_y = v(85u);
        s.per_eye_distance = i(88u);
        s.tangent = v(89u);
        s.receives = true;
        return s;
    }
    fn stop(n: u32) -> Stop {
        var s: Stop;
        s.color = v(n);
        s.at = i(n + 3u);
        s.softness = i(n + 4u);
        s.plain_color = v(n + 5u);
        s.plain_at = i(n + 8u);
        s.plain_softness = i(n + 9u);
#ifdef RAMP_DETAIL
        s.color = linear_to_oklab(s.color);
        s.plain_color = linear_to_oklab(s.plain_color);
#endif
        return s;
    }
    fn read_settings() {
        toon.light.terminator = i(92u);
        toon.light.backface = i(93u);
        toon.light.projected = i(94u);
        toon.light.highlight = i(95u);
        toon.light.highlight_edge = i(96u);
        view.exposure = i(97u);
        toon.ramp.keep_intensity = i(98u);
        toon.detail.number = i(139u);
        for (var k = 0u; k < 3u; k++) {
            toon.ramp.stops[k] = stop(108u + 10u * k);
        }
    }
";

pub fn vector(row: &Row, k: usize) -> DVec3 {
    DVec3::new(row[k].into(), row[k + 1].into(), row[k + 2].into())
}

pub fn lamps(row: &Row) -> Vec<Arriving> {
    let lamp = |k: usize| {
        let n = LAMP * k;
        let number = |k: usize| f64::from(row[n + k]);
        Arriving {
            color: vector(row, n),
            smooth_color: vector(row, n + 3),
            to_light: vector(row, n + 6),
            to_highlight: vector(row, n + 9),
            per_distance: number(12),
            lit: number(13),
            diffuse: number(14),
            shine: number(15),
        }
    };
    (0..row[COUNT] as usize).map(lamp).collect()
}

pub fn surface(row: &Row) -> Surface {
    let vector = |k| vector(row, SURFACE + k);
    let number = |k: usize| f64::from(row[SURFACE + k]);
    Surface {
        normal: vector(0),
        to_eye: vector(3),
        foot: Footprint {
            normal: [vector(6), vector(9)],
            position: [vector(18), vector(21)],
            bias: [0, 1].map(|k| row[BIAS_STEPS + k].into()),
        },
        bias: number(12),
        detail: number(13),
        roughness: number(14),
        position: vector(15),
        per_eye_distance: number(24),
        tangent: vector(25),
    }
}

pub fn evenly(row: &Row) -> Evenly {
    Evenly {
        base: vector(row, EVENLY),
        around: vector(row, EVENLY + 3),
        shine: vector(row, EVENLY + 6),
        exposure: row[SETTINGS + 5].into(),
    }
}

/// The settings, with the ramp of a blend. `axis`: a second ramp.
pub fn light(row: &Row, blend: RampBlend, axis: Option<DetailAxis>) -> ToonLight {
    let number = |k: usize| row[SETTINGS + k];
    let stop = |n: usize| {
        let color = Color::linear_rgb(row[n], row[n + 1], row[n + 2]);
        RampStop::new(row[n + 3], color).soft(row[n + 4])
    };
    let stops = |from: usize| (0..STOP_COUNT).map(move |k| stop(STOPS + STOP * k + from));
    ToonLight {
        shadow_threshold: number(0),
        form_shadows: number(1) > 0.0,
        cast_shadows: number(2) > 0.0,
        shadow_strength: number(1).max(number(2)),
        highlight: number(3),
        highlight_edge: number(4),
        ramp: Some(Ramp {
            blend,
            keep_intensity: number(6),
            detail: axis.map(|axis| RampDetail {
                axis,
                plain: stops(5).collect(),
            }),
            ..Ramp::new(stops(0))
        }),
        ..ToonLight::default()
    }
}

/// Rows of up to four lights. One in eight has extreme light; several have lights that are alike, or
/// that do not arrive.
pub fn rows(count: usize, seed: u64) -> Vec<Row> {
    let mut numbers = Numbers::new(seed);
    (0..count).map(|_| random_row(&mut numbers)).collect()
}

fn random_row(n: &mut Numbers) -> Row {
    let mut row = [0.0; ROW];
    let scale = match n.once_in(8) {
        true => 10f32.powf(n.within(-8.0, 8.0)),
        false => 1.0,
    };
    for k in 0..LAMPS {
        let lamp = random_lamp(n, scale);
        row[LAMP * k..LAMP * (k + 1)].copy_from_slice(&lamp);
    }
    if n.once_in(8) {
        // The second light is the first one, but for its shadow.
        row.copy_within(0..13, LAMP);
    }
    let foot = [0; 6].map(|_| n.within(-0.06, 0.06));
    let moves = [0; 6].map(|_| n.within(-0.02, 0.02));
    let bias = match n.once_in(4) {
        true => n.within(-2.0, 2.0),
        false => 0.0,
    };
    let surface = [
        &n.unit()[..],
        &n.unit(),
        &foot,
        &[bias, n.part(), n.within(0.3, 0.65)],
        &[0; 3].map(|_| n.within(-5.0, 5.0)),
        &moves,
        &[n.within(0.02, 1.0)],
        &n.unit(),
    ]
    .concat();
    row[SURFACE..SETTINGS].copy_from_slice(&surface);
    let strength = if n.once_in(3) { n.part() } else { 1.0 };
    let on = |n: &mut Numbers| if n.once_in(5) { 0.0 } else { strength };
    row[SETTINGS..EVENLY].copy_from_slice(&[
        n.within(0.0, 0.9),
        on(n),
        on(n),
        n.within(0.0, 4.0),
        n.within(0.02, 0.6),
        n.within(0.2, 2.0),
        if n.once_in(3) { 0.0 } else { n.part() },
    ]);
    for slot in &mut row[EVENLY..STOPS] {
        *slot = scale * n.part();
    }
    let around = if n.once_in(4) { 0.0 } else { 0.3 };
    for slot in &mut row[EVENLY + 3..EVENLY + 6] {
        *slot *= around;
    }
    for slot in &mut row[EVENLY..EVENLY + 3] {
        *slot /= scale;
    }
    for k in 0..STOP_COUNT {
        let third = k as f32 / 3.0;
        let stop = [(); STOP].map(|()| n.part());
        row[STOPS + STOP * k..][..STOP].copy_from_slice(&stop);
        // Sorted, and soft: hard edges are those of `ramp.rs`.
        for at in [3, 8] {
            row[STOPS + STOP * k + at] = third + stop[at] / 3.0;
            row[STOPS + STOP * k + at + 1] = 0.1 + 0.3 * stop[at + 1];
        }
    }
    row[COUNT] = (n.part() * 4.99).floor();
    row[POWER] = n.within(1.0, 20.0);
    for step in &mut row[BIAS_STEPS..] {
        *step = if n.once_in(2) {
            0.0
        } else {
            n.within(-0.1, 0.1)
        };
    }
    row
}

fn random_lamp(n: &mut Numbers, scale: f32) -> [f32; LAMP] {
    let mut lamp = [0.0; LAMP];
    let bright = if n.once_in(10) { 0.0 } else { scale };
    let ring = n.within(0.3, 1.0);
    for c in 0..3 {
        lamp[3 + c] = bright * n.part();
        lamp[c] = lamp[3 + c] * ring;
    }
    let to = n.unit();
    lamp[6..9].copy_from_slice(&to);
    lamp[9..12].copy_from_slice(&if n.once_in(4) { n.unit() } else { to });
    lamp[12] = if n.once_in(4) { 0.0 } else { n.part() };
    lamp[13] = match (n.part() * 3.0) as u32 {
        0 => 0.0,
        1 => 1.0,
        _ => n.part(),
    };
    lamp[14] = if n.once_in(6) { 0.0 } else { 1.0 };
    lamp[15] = if n.once_in(6) { 0.0 } else { 1.0 };
    lamp
}

/// Fails if a colour is not finite, or not that of the reference.
pub fn assert_color(row: &Row, found: [f32; 4], reference: DVec3, tolerance: f64) {
    for (found, reference) in found.into_iter().zip(reference.to_array()) {
        let off = (f64::from(found) - reference).abs();
        assert!(
            off <= tolerance,
            "{row:?}: {found}, not {reference} within {tolerance}"
        );
    }
}
