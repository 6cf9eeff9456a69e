//! Signs of light and rims of a surface.

use bevy_comics_testkit::{
    device::gpu,
    reference::{
        stylized_highlight::stylized_highlight_radius,
        toon::{
            rim_light,
            specular::{self, Lit},
            stylized_highlight_light,
            surface::{Arriving, Surface, cosine_over_pixel, half_way},
        },
    },
};

use super::{
    super::stylized_highlight::SHAPES, Numbers, READ, Row, assert_color, lamps, light, rows,
    surface, vector,
};
use crate::prelude::*;

const FRAMES: [(HighlightFrame, &[(&str, Option<u32>)]); 4] = [
    (HighlightFrame::View, &[]),
    (HighlightFrame::Light, &[("STYLIZED_HIGHLIGHT_LIGHT", None)]),
    (
        HighlightFrame::Tangent,
        &[("STYLIZED_HIGHLIGHT_TANGENT", None)],
    ),
    (HighlightFrame::World, &[("STYLIZED_HIGHLIGHT_WORLD", None)]),
];

const CAMERA: [DVec3; 2] = [DVec3::new(0.8, 0.0, 0.6), DVec3::new(0.36, 0.8, -0.48)];

/// The sign of a row: of its numbers for stops, which nothing here reads.
const SIGN: &str = "fn read_sign() {
        view.world_from_view[0] = vec4(0.8, 0.0, 0.6, 0.0);
        view.world_from_view[1] = vec4(0.36, 0.8, -0.48, 0.0);
        toon.stylized_highlight.offset = vec2(i(108u), i(109u)) - 0.5;
        toon.stylized_highlight.scale = 0.6 + vec2(i(110u), i(111u));
        toon.stylized_highlight.split = vec2(0.0, select(0.0, 0.5, i(139u) < 6.0));
        toon.stylized_highlight.turn = vec2(cos(6.0 * i(112u)), sin(6.0 * i(112u)));
        toon.stylized_highlight.size = 0.6 + i(113u);
        toon.stylized_highlight.square = i(114u);
        toon.stylized_highlight.bar = 0.1 + 0.3 * i(115u);
        toon.stylized_highlight.softness = 0.5 + i(116u);
        toon.stylized_highlight.points = 5.0;
        toon.stylized_highlight.sharpness = 3.0;
        toon.stylized_highlight.shape = u(138u);
    }";

fn sign(row: &Row, frame: HighlightFrame) -> StylizedHighlight {
    let at = |k: usize| row[super::STOPS + k];
    let shape = SHAPES[row[super::COUNT] as usize];
    let split = if row[super::POWER] < 6.0 { 0.5 } else { 0.0 };
    StylizedHighlight {
        shape,
        frame,
        offset: Vec2::new(at(0), at(1)) - 0.5,
        scale: Vec2::new(at(2), at(3)) + 0.6,
        split: Vec2::new(0.0, split),
        rotation: (6.0 * at(4)).to_degrees(),
        size: 0.6 + at(5),
        square: at(6),
        bar: 0.1 + 0.3 * at(7),
        softness: 0.5 + at(8),
        points: 5,
        sharpness: 3,
    }
}

/// Rows with a shape in place of the number of lights, whose first light is reflected nearly to the
/// eye.
fn sign_rows(count: usize, seed: u64) -> Vec<Row> {
    let mut numbers = Numbers::new(seed);
    let mut rows = rows(count, seed);
    for row in &mut rows {
        for k in 0..9 {
            row[super::STOPS + k] = numbers.part();
        }
        row[super::COUNT] = (numbers.part() * 6.99).floor();
        let half = half_way(vector(row, 9), surface(row).to_eye);
        let lean = DVec3::from_array(numbers.unit().map(f64::from));
        let normal = (half + f64::from(numbers.part()) * 0.5 * lean).normalize();
        row[super::SURFACE..super::SURFACE + 3].copy_from_slice(&normal.as_vec3().to_array());
        row[super::SETTINGS + 3] = 1.0;
    }
    rows
}

/// How far rounding moves the coverage of a sign: the distance from its border, in units of its radius,
/// over what it changes by in a pixel; four times, for both distances of a quotient. `None` where it is
/// not decided: near opposite directions, poles of frames, middles of split signs, or where the
/// highlight has no border.
fn doubt(light: &ToonLight, s: &Surface, lamp: &Arriving) -> Option<f64> {
    let sign = light.stylized_highlight.as_ref()?;
    let edge = f64::from(light.highlight_edge).sqrt();
    let a2 = s.roughness.powi(4);
    let radius = stylized_highlight_radius(edge * edge, s.roughness);
    let along = match sign.frame {
        HighlightFrame::Light => lamp.to_light,
        HighlightFrame::Tangent => s.tangent,
        HighlightFrame::World => DVec3::Y,
        _ => CAMERA[0],
    };
    let half = half_way(lamp.to_highlight, s.to_eye);
    let is_decided = (1.0 - a2 / edge).abs() > 0.1
        && (lamp.to_highlight + s.to_eye).length() > 0.2
        && s.normal.cross(along).length() > 0.1
        && s.normal.dot(half) > 0.2
        && s.normal.dot(lamp.to_highlight).abs() > 1e-4
        && (sign.shape != HighlightShape::Faithful || sign.split == Vec2::ZERO);
    let distances = stylized_highlight_light::distances(light, CAMERA, s, lamp);
    let [here, beside, below] = distances;
    let pixel = (beside - here).hypot(below - here);
    let smallest = f64::from(sign.size * sign.scale.min_element()) * radius;
    let rounding = 3e-6 / smallest + 1e-5 * here.abs();
    let doubt = 4.0 * rounding / (pixel * f64::from(sign.softness).min(1.0));
    (is_decided && pixel > 1e-3 && radius > 0.0).then_some(doubt + 1e-4)
}

/// The sign of one light, in every frame; and with a second light, which hides a part of it.
#[test]
fn signs_of_surfaces_match_the_reference() {
    let import = format!(
        "#import bevy_comics::toon::stylized_highlight_light::sign_of
         #import bevy_comics::toon::surface::Source\n{READ}{SIGN}"
    );
    let body = "read_settings();
         read_sign();
         let l = lamp(0u);
         return vec4(sign_of(surface(), Source(l.to_light, l.to_highlight, l.per_distance)));";
    for (k, (frame, definitions)) in FRAMES.into_iter().enumerate() {
        let rows = sign_rows(4096, 20 + k as u64);
        let (mut undecided, mut telling) = (0, 0);
        let results = gpu().evaluate_alone(definitions, &import, body, &rows);
        for (row, found) in rows.iter().zip(results) {
            assert!(found[0].is_finite(), "{row:?}: {found:?}");
            let light = ToonLight {
                stylized_highlight: Some(sign(row, frame)),
                ..light(row, RampBlend::Multiply, None)
            };
            let mut one = *row;
            one[super::COUNT] = 1.0;
            let (s, lamp) = (surface(row), lamps(&one)[0]);
            let Some(doubt) = doubt(&light, &s, &lamp) else {
                undecided += 1;
                continue;
            };
            let reference = stylized_highlight_light::sign_of(&light, CAMERA, &s, &lamp);
            let off = (f64::from(found[0]) - reference).abs();
            assert!(
                off <= doubt,
                "{frame:?}, {row:?}: {}, not {reference} +- {doubt}",
                found[0]
            );
            telling += usize::from(reference > 0.05 && doubt < 0.02);
        }
        assert!(undecided < 1600 && telling > 400, "{undecided}, {telling}");
    }
}

/// The brightest light draws its sign, others plain highlights.
#[test]
fn signs_among_highlights_match_the_reference() {
    let import = format!(
        "#import bevy_comics::toon::specular::{{Shine, shine_of, with_light}}\n{READ}{SIGN}"
    );
    let body = "read_settings();
         read_sign();
         toon.stylized_highlight.shape = 0u;
         let s = surface();
         var shine: Shine;
         for (var k = 0u; k < 2u; k++) {
             let l = lamp(k);
             shine = with_light(shine, s, l, l.color, l.lit);
         }
         return vec4(shine_of(shine, s), 0.0);";
    let definitions = [
        ("KEY_LIGHT", None),
        ("STYLIZED_HIGHLIGHT", None),
        ("RAMP_STOPS", Some(3)),
    ];
    let mut rows = sign_rows(8192, 40);
    for row in &mut rows {
        // Only the first light has a highlight here; the brightness of the second one counts.
        (row[9 + 16], row[10 + 16], row[11 + 16]) = (-row[64], -row[65], -row[66]);
        row[15] = 1.0;
        row[31] = 1.0;
    }
    let results = gpu().evaluate_alone(&definitions, &import, body, &rows);
    let mut telling = 0;
    for (row, found) in rows.iter().zip(results) {
        assert!(found.iter().all(|x| x.is_finite()), "{row:?}: {found:?}");
        let mut two = *row;
        two[super::COUNT] = 2.0;
        let s = surface(row);
        let disc = StylizedHighlight {
            shape: HighlightShape::Disc,
            ..sign(row, HighlightFrame::View)
        };
        let light = ToonLight {
            stylized_highlight: Some(disc),
            ..light(row, RampBlend::Multiply, None)
        };
        let lit: Vec<Lit> = (lamps(&two).into_iter())
            .map(|lamp| Lit {
                lamp,
                color: lamp.color,
                left: lamp.lit,
            })
            .collect();
        let Some(sign_doubt) = doubt(&light, &s, &lit[0].lamp) else {
            continue;
        };
        let sign = |lamp: &Arriving| stylized_highlight_light::sign_of(&light, CAMERA, &s, lamp);
        let reference = specular::shine(&light, &s, &lit, Some(&sign));
        let plain_doubt = super::reflect::doubt_of_a_highlight(row, &s, &lit[0].lamp);
        let slack = (sign_doubt + plain_doubt) * lit[0].color.max_element()
            + 1e-5 * (lit[0].color + lit[1].color).max_element();
        assert_color(row, found, reference, slack);
        telling += usize::from(reference.max_element() > 0.05 && slack < 0.02);
    }
    assert!(telling > 400, "{telling}");
}

/// Along a small movement, the direction to a place changes as it should: the rest is of the second
/// order.
#[test]
fn directions_swing_with_movements() {
    let mut numbers = Numbers::new(50);
    for _ in 0..1000 {
        let [to, movement] = [0; 2].map(|_| DVec3::from_array(numbers.unit().map(f64::from)));
        let distance = f64::from(numbers.within(0.5, 20.0));
        let movement = 1e-3 * movement;
        let true_change = (distance * to - movement).normalize() - to.normalize();
        let swing = stylized_highlight_light::swing(to.normalize(), movement, distance.recip());
        let second = 2.0 * (movement.length() / distance).powi(2);
        assert!((true_change - swing).length() < second);
    }
}

/// Rims that face away, over colours.
#[test]
fn rims_of_surfaces_match_the_reference() {
    let import = format!(
        "#import bevy_comics::toon::rim_light::with_rim
         #import bevy_comics::toon::specular::Shine\n{READ}"
    );
    let body = "toon.rim.color = v(108u);
         toon.rim.strength = i(111u);
         toon.rim.begin = 1.0 - i(112u);
         toon.rim.softness = 0.2 * i(113u);
         toon.rim.lit_side = i(114u);
         var shine: Shine;
         shine.source.to_light = v(6u) * i(14u);
         return vec4(with_rim(v(99u), surface(), shine), 0.0);";
    let definitions = [("KEY_LIGHT", None), ("RIM", None)];
    let rows = rows(8192, 60);
    let mut telling = 0;
    for (row, found) in rows
        .iter()
        .zip(gpu().evaluate_alone(&definitions, &import, body, &rows))
    {
        let at = |k: usize| row[super::STOPS + k];
        let rim = Rim {
            color: Color::linear_rgb(at(0), at(1), at(2)),
            strength: at(3),
            lit_side: at(6),
            width: RimWidth::Facing {
                share: at(4),
                softness: 0.2 * at(5),
            },
        };
        let s = surface(row);
        let base = vector(row, super::EVENLY);
        let to_light = vector(row, 6) * f64::from(row[14]);
        let reference = rim_light::with_rim(&rim, base, &s, to_light, rim_light::facing(&rim, &s));
        let width = cosine_over_pixel(&s.foot, s.to_eye).max(f64::from(0.2 * at(5)));
        assert_color(row, found, reference, 1.5 * 1e-6 / width.max(2e-5) + 1e-6);
        telling += usize::from((reference - base).length() > 0.1);
    }
    assert!(telling > 500, "{telling}");
}
