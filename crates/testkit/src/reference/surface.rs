//! Reference of `lines/draw/surface.wgsl`: lines in the color of surfaces.

/// The ink on a surface with a color in linear light.
pub fn surface_ink(color: [f64; 3], darken: f64, saturate: f64) -> [f64; 3] {
    let [r, g, b] = color;
    let gray = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    color.map(|c| darken * (gray * (1.0 - saturate) + c * saturate).max(0.0))
}
