// Writes the object at each pixel: its id and the slot of its outline style. The vertex
// shader is that of the depth prepass.

// Id, slot, and the first word of the sections.
@group(1) @binding(0) var<storage, read> objects: array<vec4<u32>>;

@fragment
fn object_id(@location(7) @interpolate(flat) instance: u32) -> @location(0) vec2<u32> {
    return objects[min(instance, arrayLength(&objects) - 1u)].xy;
}
