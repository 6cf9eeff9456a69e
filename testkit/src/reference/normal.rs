//! Twin of `depth/normal.wgsl`: what a texel of the normal prepass says.

/// The normal of a decoded texel (-1 to 1); `None` unless it is of unit length
/// within the precision of ten bits.
pub fn there(n: [f64; 3]) -> Option<[f64; 3]> {
    let squared = n.iter().map(|c| c * c).sum::<f64>();
    (0.5..=1.5).contains(&squared).then_some(n)
}

/// The normal of a texel (0 to 1).
pub fn decode(texel: [f64; 3]) -> Option<[f64; 3]> {
    there(texel.map(|c| 2.0 * c - 1.0))
}
