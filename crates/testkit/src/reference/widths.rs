//! Reference of `objects/widths.wgsl`: the factor of the width of an object's lines.

use super::pressure::{Frame, pressure_factor, stored_factor};

/// The factor at a place of the world, in codes of 8 bits: that of the mesh's vertices, limited to
/// 0 to 2, times that of the pen. `pen`: the amount of pressure, and its wavelength in pixels of
/// the viewport. `pixels`: those of the viewport per world unit at that place.
pub fn line_width(
    frame: &Frame,
    world: [f64; 3],
    pixels: f64,
    pen: [f64; 2],
    id: u32,
    vertex_factor: f64,
) -> f64 {
    let own = vertex_factor.clamp(0.0, 2.0);
    if pen[0] == 0.0 {
        return stored_factor(own);
    }
    let per_unit_of_object = pixels * frame.scale();
    stored_factor(own * pressure_factor(pen, frame.place(world), per_unit_of_object, id))
}
