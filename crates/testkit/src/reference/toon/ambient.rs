//! Reference of `toon/ambient.wgsl`.

use super::super::Rgb;

pub fn brightness(light: Rgb) -> f64 {
    0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2]
}

/// The two tones of light from all around, of the brightest side and of the opposite one.
/// `sides`: light at surfaces that face along +X, -X, +Y, -Y, +Z and -Z.
pub fn two_tones(sides: [Rgb; 6]) -> (Rgb, Rgb) {
    let difference = |axis: usize| -> Rgb {
        std::array::from_fn(|k| sides[2 * axis][k] - sides[2 * axis + 1][k])
    };
    let towards = [0, 1, 2].map(|axis| brightness(difference(axis)));
    let squared: f64 = towards.iter().map(|x| x * x).sum();
    let direction = match squared > 0.0 {
        true => towards.map(|x| x / squared.sqrt()),
        false => [0.0, 1.0, 0.0],
    };
    let mean: Rgb = std::array::from_fn(|k| sides.iter().map(|side| side[k]).sum::<f64>() / 6.0);
    let half: Rgb = std::array::from_fn(|k| {
        let sum: f64 = (0..3)
            .map(|axis| difference(axis)[k] * direction[axis] * direction[axis].abs())
            .sum();
        (0.5 * sum).clamp(-mean[k], mean[k])
    });
    (
        std::array::from_fn(|k| mean[k] + half[k]),
        std::array::from_fn(|k| mean[k] - half[k]),
    )
}
