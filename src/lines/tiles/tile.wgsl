// Draws the tiles that tiles.wgsl has listed: instances of a strip of two triangles.

@vertex
fn tile(@location(0) rectangle: vec4<f32>, @builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    let x = select(rectangle.x, rectangle.z, (vertex & 1u) != 0u);
    let y = select(rectangle.y, rectangle.w, (vertex & 2u) != 0u);
    return vec4(x, y, 0.0, 1.0);
}
