//! Reference of `depth/ping_pong.wgsl`, with the index arithmetic of \[CS\] 3.1.

use super::raw;

/// Reduces a buffer of `width` x `height` raw depths: (number of passes, bits of the
/// nearest and the farthest depth if there is geometry).
pub fn reduce(depths: &[f32], width: usize, height: usize) -> (usize, Option<[u32; 2]>) {
    let key = |x: usize, y: usize, far: bool| {
        let key = raw::key(depths[y.min(height - 1) * width + x.min(width - 1)]);
        if far && key != 0 {
            key.wrapping_neg()
        } else {
            key
        }
    };
    let (mut w, mut h) = (2 * width.div_ceil(2), height.div_ceil(2));
    let mut table: Vec<u32> = (0..h)
        .flat_map(|y| (0..w).map(move |x| (x, y)))
        .map(|(x, y)| {
            // t(x + i, 2y + j) in even columns, t(x - i, 2y + j) in odd ones.
            let start = x & !1;
            (0..4)
                .map(|i| key(start + (i & 1), 2 * y + (i >> 1), x & 1 == 1))
                .fold(0, u32::max)
        })
        .collect();
    let mut passes = 1;
    while (w, h) != (2, 1) {
        let (nw, nh) = (2 * w.div_ceil(4), h.div_ceil(2));
        let next = (0..nh)
            .flat_map(|y| (0..nw).map(move |x| (x, y)))
            .map(|(x, y)| {
                // t'(2(x + i), 2y + j) in even columns, t'(2(x + i) - 1, 2y + j)
                // in odd ones. Beyond the border, the last column pair and the
                // last row are read again.
                let base = if x & 1 == 0 { 2 * x } else { 2 * x - 1 };
                (0..4)
                    .map(|i| {
                        let column = (base + 2 * (i & 1)).min(w - 2 + (x & 1));
                        let row = (2 * y + (i >> 1)).min(h - 1);
                        table[row * w + column]
                    })
                    .fold(0, u32::max)
            })
            .collect();
        table = next;
        (w, h) = (nw, nh);
        passes += 1;
    }
    (
        passes,
        (table[0] != 0).then(|| [table[0], table[1].wrapping_neg()]),
    )
}
