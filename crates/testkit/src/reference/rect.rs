//! Reference of `toon/rect.wgsl`.

type Vec3 = [f64; 3];

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Light of a rectangle of luminance 1 / pi at a place, as a vector: the sum over `cells`
/// times `cells` pieces of it. `half_right` and `half_up` lead from its center to two sides;
/// `at` is the place, relative to the center.
pub fn rect_light(half_right: Vec3, half_up: Vec3, at: Vec3, cells: usize) -> Vec3 {
    let normal = [
        half_right[1] * half_up[2] - half_right[2] * half_up[1],
        half_right[2] * half_up[0] - half_right[0] * half_up[2],
        half_right[0] * half_up[1] - half_right[1] * half_up[0],
    ];
    // The length of the normal is a quarter of the area.
    let area = 4.0 * dot(normal, normal).sqrt();
    let piece = area / (cells * cells) as f64;
    let mut sum = [0.0; 3];
    for i in 0..cells * cells {
        let along = |n: usize| 2.0 * (n as f64 + 0.5) / cells as f64 - 1.0;
        let (x, y) = (along(i % cells), along(i / cells));
        let to: Vec3 = std::array::from_fn(|k| x * half_right[k] + y * half_up[k] - at[k]);
        let squared = dot(to, to);
        let distance = squared.sqrt();
        let cosine = 4.0 * dot(normal, to).abs() / (area * distance);
        let part = piece * cosine / (distance * squared * std::f64::consts::PI);
        sum = std::array::from_fn(|k| sum[k] + part * to[k]);
    }
    sum
}
