//! Complementary colors and two hues.

use bevy_comics::effects::HarmonyCurve;
use bevy_comics_testkit::reference::color_harmony;

use super::*;
use crate::prelude::*;

const HARMONY: &str = "#import bevy_comics::effects::color_harmony::{ColorHarmony, harmonize}";

/// Evaluates rows of settings, a color and depth.
const BODY: &str = "let s = ColorHarmony(
        vec2(i(0u), i(1u)), i(2u), i(3u), i(4u), i(5u), i(6u), u(7u), u(8u),
    );
    return vec4(harmonize(s, vec3(i(9u), i(10u), i(11u)), i(12u), i(13u)), 0.0);";

const MODES: [HarmonyMode; 4] = [
    HarmonyMode::TwoHues,
    HarmonyMode::Distance,
    HarmonyMode::Rotation,
    HarmonyMode::Shade,
];

/// The most that a conversion to `OKLab` and back changes a component, as a fraction of the largest
/// one. In units of 2^-24: the cube roots have errors of up to 5 of them (2 units in the last
/// place, and a third of the rounding of the sum below), their sums a and b with factors of 4.9 and
/// 1.6 in all 8 times that, L 8. The sums of these with the largest factors have 31, their cubes
/// 95, and the sums of these with factors of 7.6 in all 98 times 7.6.
const CONVERSION_ERROR: f64 = 745.0 / (1 << 24) as f64;

/// What the shader takes.
fn packed(s: &ColorHarmony, [r, g, b]: [f32; 3], (d, l): (f32, f32)) -> [f32; 14] {
    let [x, y] = color_harmony::hue(s.color);
    let mode = MODES.iter().position(|mode| *mode == s.mode);
    [
        x as f32,
        y as f32,
        s.complement,
        s.shade,
        s.pull,
        s.offset,
        s.amount,
        mode.expect("listed") as f32,
        f32::from(u8::from(s.curve == HarmonyCurve::SquareRoot)),
        r,
        g,
        b,
        d,
        l,
    ]
}

fn settings() -> impl Strategy<Value = ColorHarmony> {
    let kinds = (select(MODES.to_vec()), any::<bool>(), any::<bool>());
    let sizes = (0.0f32..=1.5, 0.0f32..=1.0, 0.0f32..=1.0, -0.1f32..=0.1);
    let chroma = prop_oneof![4 => Just(0.15f32), 1 => Just(0.0)];
    let color = (chroma, 0.0f32..360.0).prop_map(|(chroma, hue)| Color::oklch(0.7, chroma, hue));
    let amount = prop_oneof![Just(1.0f32), 0.0f32..=1.0];
    (kinds, sizes, color, amount).prop_map(|(kinds, sizes, color, amount)| {
        let (mode, square_root, faithful) = kinds;
        let (complement, shade, pull, offset) = sizes;
        ColorHarmony {
            mode,
            curve: [HarmonyCurve::Linear, HarmonyCurve::SquareRoot][usize::from(square_root)],
            equations: [Equations::Corrected, Equations::Faithful][usize::from(faithful)],
            complement,
            shade,
            pull,
            offset,
            color,
            amount,
        }
    })
}

type Case = (ColorHarmony, [f32; 3], (f32, f32));

fn for_cases(cases: impl Strategy<Value = Case>, check: impl Fn(&Case, [f32; 4])) {
    for_batches(cases, |cases| {
        let rows: Vec<[f32; 14]> = cases.iter().map(|(s, c, d)| packed(s, *c, *d)).collect();
        let corrected = gpu().evaluate(HARMONY, BODY, &rows);
        let faithful = &[("EFFECT_COLOR_HARMONY_FAITHFUL", None)];
        let faithful = gpu().evaluate_alone(faithful, HARMONY, BODY, &rows);
        for (k, case) in cases.iter().enumerate() {
            let results = match case.0.equations {
                Equations::Faithful => &faithful,
                _ => &corrected,
            };
            check(case, results[k]);
        }
    });
}

/// Light that no display shows included; displayable colors stay displayable, and grays stay as
/// they are, to the bit.
#[test]
fn harmony_matches_the_reference_stays_in_gamut_and_keeps_grays() {
    let wide = (wide_component(), wide_component(), wide_component());
    let shown = (component(), component(), component());
    let color = prop_oneof![
        2 => wide.prop_map(|(r, g, b)| [r, g, b]),
        1 => shown.prop_map(|(r, g, b)| [r, g, b]),
        1 => component().prop_map(|gray| [gray; 3]),
    ];
    for_cases(
        (settings(), color, depth_pair()),
        |(s, c, (d, l)), result| {
            let reference = color_harmony::harmonize(s, rgb(c), f64::from(*d), f64::from(*l));
            // Colors far beyond white round in all components by a fraction of the largest.
            let largest = color::largest(rgb(c).map(f64::abs)).max(1.0);
            let rounding = (0..3).map(|i| (f64::from(result[i]) - reference[i]).abs());
            let is_rounding = rounding.fold(0.0, f64::max) <= CONVERSION_ERROR * largest;
            assert!(
                codes_apart(result, reference) <= 1.0 || is_rounding,
                "{s:?}, {c:?} at {d}: {result:?} on the GPU, {reference:?} in the reference"
            );
            if !c.iter().all(|x| (0.0..=1.0).contains(x)) {
                return;
            }
            // The faithful equations return through a power, whose error is 2e-5.
            let over = match s.equations {
                Equations::Faithful => 2e-5,
                _ => 0.0,
            };
            let is_shown = result[..3].iter().all(|x| (-over..=1.0 + over).contains(x));
            assert!(is_shown, "{s:?}, {c:?} at {d}: {result:?}");
            let is_gray = c[0] == c[1] && c[1] == c[2];
            if is_gray && (s.mode != HarmonyMode::TwoHues || s.offset == 0.0) {
                let kept = match s.equations {
                    Equations::Faithful => result[0],
                    _ => c[0],
                };
                assert_eq!(result[..3], [kept; 3], "{s:?}: gray {c:?}");
            }
        },
    );
}

/// The complement of the complement at full distance is the color, where the display can show
/// the complement.
#[test]
fn the_complement_of_the_complement_is_the_color() {
    let s = ColorHarmony {
        mode: HarmonyMode::Distance,
        complement: 1.0,
        ..ColorHarmony::default()
    };
    let colors: Vec<[f32; 3]> = (0..32 * 32 * 32u32)
        .map(|k| [k % 32, k / 32 % 32, k / 1024].map(|x| x as f32 / 31.0))
        .filter(|c| {
            let [l, a, b] = color::linear_to_oklab(rgb(c));
            let opposite = color::oklab_to_linear([l, -a, -b]);
            opposite.iter().all(|x| (0.0..=1.0).contains(x))
        })
        .collect();
    assert!(colors.len() > 5000, "{} have a complement", colors.len());
    let rows: Vec<_> = colors.iter().map(|c| packed(&s, *c, (1.0, 0.0))).collect();
    let once = BODY.replace("return vec4(", "let once = ");
    let body = once.replace(", 0.0);", ";") + "return vec4(harmonize(s, once, 1.0, 0.0), 0.0);";
    for (c, result) in colors.iter().zip(gpu().evaluate(HARMONY, &body, &rows)) {
        let apart = (0..3).map(|i| f64::from(result[i] - c[i]).abs());
        let apart = apart.fold(0.0, f64::max);
        assert!(apart < 2.0 * CONVERSION_ERROR, "{c:?} became {result:?}");
    }
}

/// Measured in `OKLab`, by the engine's conversion.
#[test]
fn complements_lie_opposite_and_two_hues_are_two() {
    use bevy::color::{LinearRgba, Oklaba};
    let lab = |c: [f32; 4]| Oklaba::from(LinearRgba::rgb(c[0], c[1], c[2]));
    let color = (0.05f32..=0.95, 0.05f32..=0.95, 0.05f32..=0.95);
    let full = select(vec![
        HarmonyMode::Distance,
        HarmonyMode::Rotation,
        HarmonyMode::TwoHues,
    ])
    .prop_map(|mode| ColorHarmony {
        mode,
        pull: 1.0,
        offset: 0.0,
        ..ColorHarmony::default()
    });
    let cases = (full, color).prop_map(|(s, (r, g, b))| (s, [r, g, b], (1.0, 0.0)));
    for_cases(cases, |(s, [r, g, b], _), result| {
        let (before, after) = (lab([*r, *g, *b, 1.0]), lab(result));
        // In linear light, mixing with gray changes the lightness a little; the brute force
        // over the cube of colors finds at most 0.0022.
        assert!(
            (before.lightness - after.lightness).abs() < 0.01,
            "{s:?}: {before:?} became {after:?}"
        );
        let [x, y] = match s.mode {
            HarmonyMode::TwoHues => color_harmony::hue(s.color).map(|v| v as f32),
            _ => [before.a, before.b],
        };
        // Mixing with gray also bends the hue of what was out of gamut.
        let reference = color_harmony::harmonize(s, rgb(&[*r, *g, *b]), 1.0, 0.0);
        if reference.iter().any(|v| !(1e-4..=1.0 - 1e-4).contains(v)) {
            return;
        }
        let across = (x * after.b - y * after.a).abs() / x.hypot(y).max(1e-3);
        assert!(across < 1e-3, "{s:?}: {before:?} became {after:?}");
        if s.mode != HarmonyMode::TwoHues {
            assert!(
                x * after.a + y * after.b <= 1e-6,
                "{s:?}: {before:?}, {after:?}"
            );
        }
    });
}

/// What is near becomes warmer, what is far colder, and what is in the middle neither.
#[test]
fn the_offset_puts_the_hue_in_front() {
    let s = ColorHarmony::default();
    let gray = [0.3f32; 3];
    let rows: Vec<_> = [0.0f32, 0.5, 1.0]
        .map(|d| packed(&s, gray, (d, 1.0 - d)))
        .into();
    let warmth: Vec<f32> = gpu()
        .evaluate(HARMONY, BODY, &rows)
        .iter()
        .map(|c| c[0] - c[2])
        .collect();
    assert!(
        warmth[0] > 0.02 && warmth[1].abs() < 1e-6 && warmth[2] < -0.02,
        "red minus blue at the near end, in the middle, at the far end: {warmth:?}"
    );
}

/// Colors in the shade are paler, those in the light stay.
#[test]
fn shade_takes_the_complement() {
    let s = ColorHarmony {
        mode: HarmonyMode::Shade,
        shade: 1.0,
        complement: 1.0,
        ..ColorHarmony::default()
    };
    let [dark, light] = [[0.02f32, 0.005, 0.005], [1.0, 0.9, 0.9]];
    let rows = vec![packed(&s, dark, (1.0, 0.0)), packed(&s, light, (1.0, 0.0))];
    let results = gpu().evaluate(HARMONY, BODY, &rows);
    let chroma = |c: &[f32]| {
        let [_, a, b] = color::linear_to_oklab(rgb(c));
        a.hypot(b)
    };
    // w = (1 - L)^2, and w (1 + k) of the chroma is lost.
    for (c, result) in [dark, light].iter().zip(&results) {
        let [l, ..] = color::linear_to_oklab(rgb(c));
        let left = (1.0 - 2.0 * (1.0 - l).powi(2)).abs();
        let found = chroma(result) / chroma(c);
        assert!((found - left).abs() < 0.01, "{c:?}: {found} for {left}");
    }
}
