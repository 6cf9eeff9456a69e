//! A ball under several lights, in every mode of a ramp, against the reference of every pixel.

use bevy_comics_testkit::reference::{
    color::srgb_encode,
    detail,
    toon::{
        brightest, light_fraction, per_light, reflect,
        surface::{Arriving, Footprint, Surface},
        two_shades::{self, Evenly},
    },
};

use crate::{
    prelude::*,
    ramp::{bright, drawn, full, put, room, set_light, sun},
};

const SIZE: u32 = 100;
const BALL: f64 = 0.95;
/// Units of a pixel.
const PIXEL: f64 = 2.0 / SIZE as f64;
const AMBIENT: f32 = 0.15;
/// Directions and parts of full light.
const SUNS: [(Vec3, f32); 3] = [
    (Vec3::new(-1.0, 0.8, 0.7), 0.5),
    (Vec3::new(0.9, 0.2, 0.6), 0.3),
    (Vec3::new(0.1, -1.0, 0.3), 0.2),
];

/// The surface of the ball at a pixel, without its borders.
fn surface(x: u32, y: u32) -> Option<Surface> {
    let normal = |x: f64, y: f64| {
        let at = DVec3::new(x - 0.5 * f64::from(SIZE), 0.5 * f64::from(SIZE) - y, 0.0);
        let at = at * PIXEL / BALL;
        let rest = 1.0 - at.length_squared();
        (rest > 0.15).then(|| DVec3::new(at.x, at.y, rest.sqrt()))
    };
    let [x, y] = [x, y].map(|v| f64::from(v) + 0.5);
    let here = normal(x, y)?;
    let steps = [normal(x + 1.0, y)? - here, normal(x, y + 1.0)? - here];
    Some(Surface {
        normal: here,
        to_eye: DVec3::Z,
        foot: Footprint {
            normal: steps,
            position: steps.map(|step| BALL * step),
            bias: [0.0; 2],
        },
        detail: 1.0,
        roughness: 1.0,
        ..Surface::default()
    })
}

/// A directional light without shadows; `part` of what makes white of white.
pub fn arriving((to, part): (Vec3, f32)) -> Arriving {
    let color = DVec3::splat(f64::from(part * full()));
    let to = to.normalize().as_dvec3();
    Arriving {
        color,
        smooth_color: color,
        to_light: to,
        to_highlight: to,
        lit: 1.0,
        diffuse: 1.0,
        shine: 1.0,
        ..Arriving::default()
    }
}

fn suns() -> Vec<Arriving> {
    SUNS.map(arriving).to_vec()
}

/// Soft tones, so that interpolated normals of the mesh do not decide; the last edge is as sharp as
/// pixels.
fn stops(last: f32) -> [RampStop; 3] {
    [
        RampStop::new(0.0, Color::linear_rgb(0.1, 0.05, 0.3)),
        RampStop::new(0.3, Color::linear_rgb(0.5, 0.4, 0.6)).soft(0.3),
        RampStop::new(last, Color::linear_rgb(1.0, 0.9, 0.8)).soft(0.1),
    ]
}

fn cases() -> Vec<Option<Ramp>> {
    let mut all = vec![None];
    for mode in [
        RampMode::LightFraction,
        RampMode::PerLight,
        RampMode::Brightest,
    ] {
        for blend in [RampBlend::Multiply, RampBlend::Absolute] {
            for axis in [None, Some(DetailAxis::Rim { power: 1.5 })] {
                let plain = stops(0.5).map(|stop| RampStop {
                    at: 0.8 * stop.at,
                    ..stop
                });
                all.push(Some(Ramp {
                    mode,
                    blend,
                    keep_intensity: 0.5,
                    detail: axis.map(|axis| RampDetail {
                        axis,
                        plain: plain.to_vec(),
                    }),
                    ..Ramp::new(stops(0.7))
                }));
            }
        }
    }
    all
}

fn reference(light: &ToonLight, s: &Surface, e: &Evenly) -> DVec3 {
    let suns = suns();
    let Some(ramp) = &light.ramp else {
        let left = |sun: &Arriving| (*sun, reflect::unshadowed(light, s, sun));
        let lit: Vec<_> = suns.iter().map(left).collect();
        return two_shades::reflected(&lit, e);
    };
    match ramp.mode {
        RampMode::PerLight => per_light::reflected(light, s, &suns, e),
        RampMode::Brightest => brightest::reflected(light, s, &suns, e),
        _ => light_fraction::reflected(light, s, &suns, e),
    }
}

/// Pixel by pixel, the picture is the reference of the whole light, in every mode.
#[test]
fn a_ball_under_three_suns_matches_the_reference() {
    let cases = cases();
    // No ramp, a share on two axes, each light alone, the brightest one on two axes.
    check([0, 2, 7, 12].map(|k| cases[k].clone()));
}

#[test]
#[ignore = "long: every mode with every blend and axis"]
fn a_ball_under_three_suns_matches_the_reference_in_every_case() {
    check(cases());
}

fn check(cases: impl IntoIterator<Item = Option<Ramp>>) {
    let mut small = room(UVec2::splat(SIZE), AMBIENT);
    let ball = Sphere::new(BALL as f32).mesh().uv(256, 128);
    put(&mut small, ball, &ToonLight::default(), Transform::IDENTITY);
    for (to, part) in SUNS {
        sun(&mut small, to, bright(part));
    }
    let exposure = f64::from(Exposure::default().exposure());
    for ramp in cases {
        let light = ToonLight {
            ramp,
            falloff: 0.0,
            ..ToonLight::default()
        };
        set_light(&mut small, &light);
        let picture = drawn(&mut small);
        let (mut looked, mut off) = (0u32, 0u32);
        for (x, y) in (0..SIZE).flat_map(|x| (0..SIZE).map(move |y| (x, y))) {
            let Some(mut s) = surface(x, y) else {
                continue;
            };
            let axis = (light.ramp.as_ref())
                .and_then(|ramp| ramp.detail.as_ref())
                .map(|detail| detail.axis);
            if let Some(axis) = axis {
                s.detail = detail::detail(axis, s.normal.dot(s.to_eye));
            }
            let e = Evenly {
                base: DVec3::ONE,
                around: DVec3::splat(f64::from(AMBIENT) / exposure),
                shine: DVec3::ZERO,
                exposure,
            };
            let [wanted, found] = [reference(&light, &s, &e).to_array(), linear(&picture, x, y)]
                .map(|color| srgb_encode(color.map(|c| c.clamp(0.0, 1.0))));
            let codes = (0..3)
                .map(|c| 255.0 * (wanted[c] - found[c]).abs())
                .fold(0.0, f64::max);
            looked += 1;
            // The normals of the mesh are off by at most (pi / 128)^2 / 8 = 8e-5. A tone rises by 15
            // per unit, and dark tones by 12 codes per hundredth: 1.5 codes, and half of one in the
            // picture. Without a ramp, an edge is one pixel wide.
            let most = if light.ramp.is_some() { 2.0 } else { 6.0 };
            off += u32::from(codes > most);
            assert!(
                codes < 12.0,
                "({x}, {y}): {found:?}, not {wanted:?}, {light:?}"
            );
        }
        assert!(looked > SIZE * SIZE / 2, "{looked}");
        assert!(off * 500 < looked, "{off} of {looked}, {light:?}");
    }
}
