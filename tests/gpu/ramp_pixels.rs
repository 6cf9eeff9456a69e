//! A ball under several lights, in every mode of a ramp, against the reference of every pixel.

use bevy_comics_testkit::reference::{
    color::srgb_encode,
    detail,
    toon::reflected::{self, Lights, Surface},
};

use crate::{
    prelude::*,
    ramp::{MODES, bright, drawn, full, put, room, set_light, sun},
};

const SIZE: u32 = 100;
const BALL: f64 = 0.95;
/// Units of a pixel.
const PIXEL: f64 = 2.0 / SIZE as f64;
const AMBIENT: f32 = 0.15;
const BASE: [f32; 3] = [0.9, 0.7, 0.5];
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
    Some(Surface {
        base: DVec3::from_array(BASE.map(f64::from)),
        normal: here,
        steps: [normal(x + 1.0, y)? - here, normal(x, y + 1.0)? - here],
        to_eye: DVec3::Z,
        detail: 1.0,
    })
}

/// A directional light; `part` of what makes white of white.
pub fn arriving((to, part): (Vec3, f32)) -> reflected::Sun {
    reflected::Sun {
        color: DVec3::splat(f64::from(part * full())),
        to_light: to.normalize().as_dvec3(),
    }
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

fn light(ramp: Option<Ramp>, shadow_strength: f32) -> ToonLight {
    ToonLight {
        ramp,
        shadow_strength,
        falloff: 0.0,
        ..default()
    }
}

fn ramped(mode: RampMode, blend: RampBlend, axis: Option<DetailAxis>) -> ToonLight {
    let plain = stops(0.5).map(|stop| RampStop {
        at: 0.8 * stop.at,
        ..stop
    });
    let detail = axis.map(|axis| RampDetail {
        axis,
        plain: plain.to_vec(),
    });
    let ramp = Ramp {
        mode,
        blend,
        keep_intensity: 0.5,
        detail,
        ..Ramp::new(stops(0.7))
    };
    light(
        Some(ramp),
        if blend == RampBlend::Multiply {
            1.0
        } else {
            0.6
        },
    )
}

const RIM: DetailAxis = DetailAxis::Rim { power: 1.5 };
const HIGHLIGHT: DetailAxis = DetailAxis::Highlight { power: 2.0 };

/// Pixel by pixel, the picture is the reference of the whole light, in every mode.
#[test]
fn a_ball_under_three_suns_matches_the_reference() {
    check([
        light(None, 0.7),
        ramped(RampMode::LightFraction, RampBlend::Multiply, Some(RIM)),
        ramped(RampMode::PerLight, RampBlend::Absolute, None),
        ramped(RampMode::Brightest, RampBlend::Absolute, Some(HIGHLIGHT)),
    ]);
}

#[test]
#[ignore = "long: every mode with every blend and axis"]
fn a_ball_under_three_suns_matches_the_reference_in_every_case() {
    let mut cases = vec![light(None, 1.0)];
    for mode in MODES {
        for blend in [RampBlend::Multiply, RampBlend::Absolute] {
            cases.extend([None, Some(RIM), Some(HIGHLIGHT)].map(|axis| ramped(mode, blend, axis)));
        }
    }
    check(cases);
}

fn check(cases: impl IntoIterator<Item = ToonLight>) {
    let mut small = room(UVec2::splat(SIZE), AMBIENT);
    let ball = Sphere::new(BALL as f32).mesh().uv(256, 128);
    put(&mut small, ball, &ToonLight::default(), Transform::IDENTITY);
    let [r, g, b] = BASE;
    let mut materials = small.world().resource_mut::<Assets<ToonMaterial>>();
    for (_, material) in materials.iter_mut() {
        material.base.base_color = Color::linear_rgb(r, g, b);
    }
    let suns = SUNS.map(|(to, part)| sun(&mut small, to, bright(part)));
    let exposure = f64::from(Exposure::default().exposure());
    let mut lights = Lights {
        suns: SUNS.map(arriving).to_vec(),
        around: DVec3::splat(f64::from(AMBIENT) / exposure),
        exposure,
    };
    let cases: Vec<ToonLight> = cases.into_iter().collect();
    for light in &cases {
        check_pixels(&mut small, light, &lights);
    }
    // Light from all around alone has the tone of shade.
    for sun in suns {
        small.world().despawn(sun);
    }
    lights.suns.clear();
    let has_axis = |light: &&ToonLight| {
        light
            .ramp
            .as_ref()
            .is_some_and(|ramp| ramp.detail.is_some())
    };
    for light in cases.iter().filter(|light| !has_axis(light)) {
        check_pixels(&mut small, light, &lights);
    }
}

fn check_pixels(small: &mut Small, light: &ToonLight, lights: &Lights) {
    set_light(small, light);
    let picture = drawn(small);
    let axis = (light.ramp.as_ref())
        .and_then(|ramp| ramp.detail.as_ref())
        .map(|detail| detail.axis);
    let (mut looked, mut off) = (0u32, 0u32);
    for (x, y) in (0..SIZE).flat_map(|x| (0..SIZE).map(move |y| (x, y))) {
        let Some(mut s) = surface(x, y) else {
            continue;
        };
        if let Some(axis) = axis {
            s.detail = detail::detail(axis, s.normal.dot(s.to_eye));
        }
        let wanted = reflected::reflected(light, &s, lights).to_array();
        let [wanted, found] = [wanted, linear(&picture, x, y)]
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
