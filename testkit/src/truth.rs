//! Which pixels should have a line, from the same scene at a higher resolution.
//!
//! A pixel has a silhouette where the depth of two finer neighbours differs by
//! more than 2 % beyond the slopes on both sides, a crease where their normals
//! differ by more than 30 degrees on one surface, an object edge where their ids
//! differ.

/// Pixels of the finer picture along an edge of a pixel.
pub const FINE: u32 = 4;

/// The three kinds, one mask each: silhouettes, creases, object edges.
pub struct Truth {
    pub width: usize,
    pub height: usize,
    pub kinds: [Vec<bool>; 3],
}

impl Truth {
    /// From raw depth, normals and object ids of a picture [`FINE`] times as fine.
    pub fn new(
        width: usize,
        height: usize,
        depth: &[f32],
        normals: &[[f32; 4]],
        ids: &[u32],
    ) -> Self {
        let fine = FINE as usize;
        let (w, h) = (width * fine, height * fine);
        let mut kinds = [0; 3].map(|_| vec![false; width * height]);
        for y in 1..h - 2 {
            for x in 1..w - 2 {
                let i = y * w + x;
                for step in [1, w] {
                    let j = i + step;
                    let (a, b) = (depth[i], depth[j]);
                    let (before, beyond) = (depth[i - step], depth[j + step]);
                    let near = a.max(b);
                    if near <= 0.0 {
                        continue;
                    }
                    let (here, there, back, ahead) = if a >= b {
                        (a, b, before, beyond)
                    } else {
                        (b, a, beyond, before)
                    };
                    let excess = (here - there) - (back - here).max(there - ahead).max(0.0);
                    let at = (y / fine) * width + x / fine;
                    let silhouette = excess > 0.02 * near;
                    kinds[0][at] |= silhouette;
                    let (m, n) = (normals[i], normals[j]);
                    let dot = m[0] * n[0] + m[1] * n[1] + m[2] * n[2];
                    let both = a > 0.0 && b > 0.0;
                    kinds[1][at] |= both && !silhouette && dot < 30f32.to_radians().cos();
                    kinds[2][at] |= ids[i] != ids[j];
                }
            }
        }
        Self {
            width,
            height,
            kinds,
        }
    }

    /// Where any of some kinds is.
    pub fn any(&self, kinds: &[usize]) -> Vec<bool> {
        (0..self.width * self.height)
            .map(|i| kinds.iter().any(|kind| self.kinds[*kind][i]))
            .collect()
    }

    /// The pixels that count: the rim reads beyond the picture.
    pub fn inside(&self) -> impl Iterator<Item = usize> {
        let (w, h) = (self.width, self.height);
        (0..w * h).filter(move |i| (3..w - 3).contains(&(i % w)) && (3..h - 3).contains(&(i / w)))
    }

    /// (found, all) of the true pixels: one counts as found where a line lies
    /// within a pixel.
    pub fn recall(&self, truth: &[bool], lines: &[bool]) -> (usize, usize) {
        count(
            self.inside()
                .filter(|i| truth[*i])
                .map(|i| near(lines, self.width, self.height, i, 1)),
        )
    }

    /// (right, all) of the drawn pixels: one is right within two pixels of the
    /// truth.
    pub fn precision(&self, truth: &[bool], lines: &[bool]) -> (usize, usize) {
        count(
            self.inside()
                .filter(|i| lines[*i])
                .map(|i| near(truth, self.width, self.height, i, 2)),
        )
    }
}

fn count(all: impl Iterator<Item = bool>) -> (usize, usize) {
    all.fold((0, 0), |(yes, total), hit| {
        (yes + usize::from(hit), total + 1)
    })
}

/// Which pixels a line has changed by more than a quarter.
pub fn mask(plain: &image::RgbaImage, lined: &image::RgbaImage) -> Vec<bool> {
    plain
        .pixels()
        .zip(lined.pixels())
        .map(|(a, b)| {
            let largest = (0..3).map(|i| a.0[i].abs_diff(b.0[i])).max().unwrap_or(0);
            let light = a.0[..3].iter().copied().max().unwrap_or(0);
            f32::from(largest) > 0.25 * f32::from(light.max(24))
        })
        .collect()
}

fn near(mask: &[bool], width: usize, height: usize, at: usize, reach: i64) -> bool {
    let (x, y) = ((at % width) as i64, (at / width) as i64);
    (-reach..=reach).any(|j| {
        (-reach..=reach).any(|i| {
            let (u, v) = (x + i, y + j);
            (0..width as i64).contains(&u)
                && (0..height as i64).contains(&v)
                && mask[v as usize * width + u as usize]
        })
    })
}
