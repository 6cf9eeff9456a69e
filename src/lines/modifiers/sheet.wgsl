#define_import_path bevy_comics::lines::sheet

// Lines on the sheet of the page: rough edges, and the streaks of a dry brush. Pure functions.

#import bevy_comics::effect::noise::wave
#import bevy_comics::effect::screen::{cos_turn, sin_turn}
#import bevy_comics::effect::sheet::{bristles, sheet_height}

struct Sheet {
    // The corner of the viewport, in physical pixels from that of the sheet.
    origin: vec2<f32>,
    // Width of the band in which edges of ink vary, in physical pixels.
    ink_bleed: f32,
    dry_brush: f32,
    // Places on the sheet per physical pixel.
    scale: f32,
    // Physical pixels per logical pixel.
    unit: f32,
    seed: u32,
    unused: u32,
}

// Half of a line that its edges may take from it or add to it.
const MOST_SPREAD: f32 = 0.75;

// Streaks run in this many directions, so that they are fixed to the sheet.
const DIRECTIONS: f32 = 16.0;

// Length and width of a streak in logical pixels.
const STREAK: vec2<f32> = vec2(12.8, 1.6);

// Height of the sheet under a place of the viewport.
fn height_under(s: Sheet, place: vec2<f32>) -> f32 {
    return sheet_height((s.origin + place) * s.scale, s.seed);
}

// Half the width with which a line covers a place where the sheet has a height: ink runs into
// valleys.
fn spread_width(s: Sheet, half_width: f32, height: f32) -> f32 {
    return half_width - min(0.5 * s.ink_bleed, MOST_SPREAD * half_width) * height;
}

// Noise that is stretched along the direction of a number.
fn streak(s: Sheet, place: vec2<f32>, number: f32) -> f32 {
    let turn = 0.5 * number / DIRECTIONS;
    let u = vec2(cos_turn(turn), sin_turn(turn));
    let on_sheet = s.origin + place;
    let d = vec2(dot(on_sheet, u), u.x * on_sheet.y - u.y * on_sheet.x);
    return wave(d / (s.unit * STREAK), 0x64727962u + 16u * s.seed + u32(number));
}

// Fraction of the ink of a line that a dry brush leaves at a place of the viewport. `along`: the
// direction of the line, of any length but 0. Between two directions of streaks, those of both
// are mixed; dividing by the length of the weights keeps their contrast.
fn dry_ink(s: Sheet, place: vec2<f32>, along: vec2<f32>, half_width: f32) -> f32 {
    let wide = smoothstep(3.0, 6.0, 2.0 * half_width / s.unit);
    if wide == 0.0 {
        return 1.0;
    }
    let turn = atan2(along.y, along.x) * (DIRECTIONS / 3.1415927) + DIRECTIONS;
    let part = clamp(2.0 * fract(turn) - 0.5, 0.0, 1.0);
    let first = floor(turn) % DIRECTIONS;
    let second = (first + 1.0) % DIRECTIONS;
    let weights = vec2(1.0 - part, part);
    let noise = dot(weights, vec2(streak(s, place, first), streak(s, place, second)));
    let left = bristles(s.dry_brush, noise * inverseSqrt(dot(weights, weights)));
    // The first streaks appear as the brush becomes dry.
    return mix(1.0, left, wide * min(5.0 * s.dry_brush, 1.0));
}
