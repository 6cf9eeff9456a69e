enable primitive_index;

// As ids.wgsl, for meshes that are divided into sections: bits 8 to 15 of the second number
// are the section of the triangle.

@group(1) @binding(0) var<storage, read> objects: array<vec4<u32>>;
// Four triangles to a word.
@group(1) @binding(1) var<storage, read> sections: array<u32>;

@fragment
fn object_id(
    @location(7) @interpolate(flat) instance: u32,
    @builtin(primitive_index) triangle: u32,
) -> @location(0) vec2<u32> {
    let object = objects[min(instance, arrayLength(&objects) - 1u)];
    let word = sections[min(object.z + triangle / 4u, arrayLength(&sections) - 1u)];
    return vec2(object.x, object.y | (((word >> (8u * (triangle % 4u))) & 255u) << 8u));
}
