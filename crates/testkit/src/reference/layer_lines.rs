//! Reference of `lines/modifiers/layer_lines.wgsl`: lines of near, middle and far.

use bevy_comics::lines::LineLayers;

/// Factors of the width and of the opacity. `weights`: fractions of near, middle and far.
pub fn factors(s: &LineLayers, weights: [f64; 3]) -> [f64; 2] {
    [s.widths, s.opacities].map(|factors| sum(factors.map(f64::from), weights))
}

/// Red, green and blue times the amount of the colour, and the amount.
pub fn ink(s: &LineLayers, weights: [f64; 3]) -> [f64; 4] {
    let amounts = s.color_amounts.map(f64::from);
    let part = |channel: usize| {
        let colors = s.colors.map(|c| [c.red, c.green, c.blue][channel]);
        std::array::from_fn(|plane| f64::from(colors[plane]) * amounts[plane])
    };
    let [red, green, blue] = [0, 1, 2].map(|channel| sum(part(channel), weights));
    [red, green, blue, sum(amounts, weights)]
}

fn sum(values: [f64; 3], weights: [f64; 3]) -> f64 {
    (0..3).map(|plane| values[plane] * weights[plane]).sum()
}
