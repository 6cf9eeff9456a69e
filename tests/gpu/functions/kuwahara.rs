//! Paint against Kuwahara's filter, written out.

use bevy_comics_testkit::reference::{
    box_statistics::{Sheet, means, root, square},
    color, noise,
    paint::{box_areas, chosen},
};

/// Kuwahara (1976), written out: of the four squares of side `radius + 1` with a corner in the
/// pixel, the mean of that whose lightness varies least.
fn classic(sheet: &Sheet, at: [i64; 2], radius: i64) -> [f64; 3] {
    let quadrants = [[-1, -1], [1, -1], [-1, 1], [1, 1]].map(|side: [i64; 2]| {
        let (mut sum, mut light, mut squares) = ([0.0; 3], 0.0, 0.0);
        for (i, j) in (0..=radius).flat_map(|j| (0..=radius).map(move |i| (i, j))) {
            let [r, g, b, _] = sheet.nearest([at[0] + side[0] * i, at[1] + side[1] * j]);
            let color = [r, g, b].map(root);
            let lightness = color::luminance(color);
            sum = std::array::from_fn(|c| sum[c] + color[c]);
            light += lightness;
            squares += lightness * lightness;
        }
        let count = ((radius + 1) * (radius + 1)) as f64;
        let mean = light / count;
        (squares / count - mean * mean, sum.map(|c| c / count))
    });
    let best = quadrants
        .into_iter()
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .expect("four");
    best.1.map(square)
}

/// Number `i` of a sequence without order, 0 to 1.
fn random(i: usize) -> f64 {
    f64::from(noise::hash(i as u32) >> 8) / f64::from(1 << 24)
}

/// A sheet of random colours.
fn noisy(size: [usize; 2]) -> Sheet {
    Sheet::new(size, |[x, y]| {
        let of = |c: usize| random(3 * (y * size[0] + x) + c);
        [of(0), of(1), of(2), 1.0]
    })
}

/// A scene of a disc, a slope of light and stripes, with a noise: no two squares vary alike.
fn drawing(size: [usize; 2]) -> Sheet {
    Sheet::new(size, |[x, y]| {
        let (u, v) = (x as f64 - 18.0, y as f64 - 14.0);
        let area = if u * u + v * v < 81.0 {
            [0.7, 0.2, 0.1]
        } else if x > 32 && x % 6 < 3 {
            [0.1, 0.1, 0.3]
        } else {
            [0.3, 0.5, 0.2].map(|c: f64| c + 0.01 * y as f64)
        };
        let noise = 0.06 * random(y * size[0] + x);
        let [r, g, b] = area.map(|c| c + noise);
        [r, g, b, 1.0]
    })
}

/// Truth: the whole painted picture is that of Kuwahara's filter where only the four boxes at the
/// corners count, and the least variance decides.
#[test]
fn four_sharp_boxes_are_kuwaharas_filter() {
    // Corners of `box_areas`: 0, 2, 6 and 8 of 3 x 3 without the middle.
    const CORNERS: [usize; 4] = [0, 2, 5, 7];
    let size = [48, 30];
    for sheet in [drawing(size), noisy(size)] {
        for radius in [2i64, 4, 6] {
            let half = (radius / 2) as f64;
            let boxes = means(&sheet, &|_| half);
            let mut painted = 0;
            let rows = radius..30 - radius;
            for (x, y) in rows.flat_map(|y| (radius..48 - radius).map(move |x| (x, y))) {
                let at = [x as usize, y as usize];
                let areas = box_areas(&sheet, &boxes, at, half, &|_| 1.0);
                let corners = CORNERS.map(|k| areas[k]);
                // Twice the least variance counts 2^-5e8.
                let found = chosen(&corners, 1e9).expect("four areas");
                let want = classic(&sheet, [x, y], radius);
                for c in 0..3 {
                    let apart = (found[c] - want[c]).abs();
                    assert!(apart < 1e-3, "{radius}, {at:?}: {found:?}, {want:?}");
                    painted += usize::from((want[c] - sheet.at(at)[c]).abs() > 0.01);
                }
            }
            assert!(painted > 500, "{painted} colours are painted over");
        }
    }
}
