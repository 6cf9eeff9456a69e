//! Twin of `depth/normal.wgsl`: decodes texels of the normal prepass.

/// The normal of a decoded texel (components -1 to 1); `None` unless its squared
/// length is 1 within 0.5. Ten bits per component stay well inside; cleared texels,
/// whose squared length is 3, and zero normals do not.
pub fn there(n: [f64; 3]) -> Option<[f64; 3]> {
    let squared = n.iter().map(|c| c * c).sum::<f64>();
    (0.5..=1.5).contains(&squared).then_some(n)
}

/// The normal of a stored texel (components 0 to 1).
pub fn decode(texel: [f64; 3]) -> Option<[f64; 3]> {
    there(texel.map(|c| 2.0 * c - 1.0))
}
