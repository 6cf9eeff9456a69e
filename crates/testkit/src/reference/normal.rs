//! Reference of `depth/normal.wgsl`: decodes texels of the normal prepass.

/// The unit normal of a decoded texel (components -1 to 1); `None` unless its squared
/// length is 0.05 to 1.5. Interpolated normals are shorter than 1; cleared texels have
/// the squared length 3.
pub fn there(n: [f64; 3]) -> Option<[f64; 3]> {
    let squared = n.iter().map(|c| c * c).sum::<f64>();
    (0.05..=1.5)
        .contains(&squared)
        .then(|| n.map(|c| c / squared.sqrt()))
}

/// The normal of a stored texel (components 0 to 1).
pub fn decode(texel: [f64; 3]) -> Option<[f64; 3]> {
    there(texel.map(|c| 2.0 * c - 1.0))
}
