//! Reference of `objects/depth_test/count.wgsl`.

/// Pixels that the depth prepass covers, and those of them without an object id, among every fourth
/// pixel of every fourth row of a viewport (origin and size). What lies beyond the picture is as at
/// its border.
pub fn counts(
    size: [u32; 2],
    viewport: [u32; 4],
    depth: impl Fn(u32, u32) -> f64,
    id: impl Fn(u32, u32) -> u32,
) -> [u32; 2] {
    let [left, top, width, height] = viewport;
    let mut found = [0, 0];
    for y in (0..height).step_by(4) {
        for x in (0..width).step_by(4) {
            let [x, y] = [(left + x).min(size[0] - 1), (top + y).min(size[1] - 1)];
            if depth(x, y) > 0.0 {
                found[0] += 1;
                found[1] += u32::from(id(x, y) == 0);
            }
        }
    }
    found
}
