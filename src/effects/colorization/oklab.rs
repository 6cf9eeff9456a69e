//! The largest chroma that the sRGB gamut has at an `OKLab` hue and lightness: the
//! limit for the chroma of an atmosphere (`OKLab`: Ottosson 2020).

/// Linear sRGB of an `OKLab` color.
fn linear_from_oklab(l: f64, a: f64, b: f64) -> [f64; 3] {
    let cube = |x: f64| x * x * x;
    let (p, q, r) = (
        cube(l + 0.3963377774 * a + 0.2158037573 * b),
        cube(l - 0.1055613458 * a - 0.0638541728 * b),
        cube(l - 0.0894841775 * a - 1.2914855480 * b),
    );
    [
        4.0767416621 * p - 3.3077115913 * q + 0.2309699292 * r,
        -1.2684380046 * p + 2.6097574011 * q - 0.3413193965 * r,
        -0.0041960863 * p - 0.7034186147 * q + 1.7076147010 * r,
    ]
}

/// Lightness and chroma of the most saturated displayable color of a hue: the cusp
/// of the sRGB gamut. The hue is a unit vector (a, b).
pub(super) fn cusp(direction: [f64; 2]) -> (f64, f64) {
    let [a, b] = direction;
    // Chroma / lightness is constant along a ray from black. Bisects for the largest
    // ratio at which no component is negative.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        let inside = linear_from_oklab(1.0, middle * a, middle * b)
            .iter()
            .all(|c| *c >= 0.0);
        if inside {
            low = middle;
        } else {
            high = middle;
        }
    }
    let brightest = linear_from_oklab(1.0, low * a, low * b)
        .into_iter()
        .fold(f64::MIN, f64::max);
    let lightness = (1.0 / brightest).cbrt();
    (lightness, lightness * low)
}

/// The largest chroma of a hue at a lightness, approximated by a triangle: it rises
/// from 0 at black to the cusp and falls to 0 at white.
pub(super) fn room(lightness: f64, cusp: (f64, f64)) -> f64 {
    cusp.1
        * (lightness / cusp.0)
            .min((1.0 - lightness) / (1.0 - cusp.0))
            .clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cusp_of_every_hue_lies_on_the_gamut_boundary() {
        for degree in 0..360 {
            let (b, a) = f64::from(degree).to_radians().sin_cos();
            let (lightness, chroma) = cusp([a, b]);
            let rgb = linear_from_oklab(lightness, chroma * a, chroma * b);
            let low = rgb.into_iter().fold(f64::MAX, f64::min);
            let high = rgb.into_iter().fold(f64::MIN, f64::max);
            assert!(low.abs() < 1e-6, "hue {degree}: smallest component {low}");
            assert!(
                (high - 1.0).abs() < 1e-6,
                "hue {degree}: largest component {high}"
            );
        }
    }
}
