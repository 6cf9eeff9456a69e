enable primitive_index;

// As ids.wgsl, for meshes that are divided into sections: bits 8 to 15 of the second number
// are the section of the triangle.

#ifdef LINE_WIDTHS
#import bevy_comics::objects::widths::line_width
#endif
#ifdef TOLERANT
#import bevy_comics::objects::tolerance::{Fragment, shows}
#endif

@group(1) @binding(0) var<storage, read> objects: array<vec4<u32>>;
// Four triangles to a word.
@group(1) @binding(1) var<storage, read> sections: array<u32>;

struct Drawn {
    @location(0) object: vec2<u32>,
#ifdef LINE_WIDTHS
    @location(1) width: f32,
#endif
}

@fragment
fn object_id(
#ifdef LINE_WIDTHS
    @location(4) world_position: vec4<f32>,
#endif
#ifdef VERTEX_WIDTHS
    @location(8) color: vec4<f32>,
#endif
    @location(7) @interpolate(flat) instance: u32,
    @builtin(primitive_index) triangle: u32,
#ifdef TOLERANT
    fragment: Fragment,
#endif
) -> Drawn {
    var drawn: Drawn;
#ifdef TOLERANT
    if !shows(fragment) {
        discard;
    }
#endif
    let object = objects[min(instance, arrayLength(&objects) - 1u)];
    let word = sections[min(object.z + triangle / 4u, arrayLength(&sections) - 1u)];
    drawn.object = vec2(object.x, object.y | (((word >> (8u * (triangle % 4u))) & 255u) << 8u));
#ifdef LINE_WIDTHS
    var vertex_factor = 1.0;
#ifdef VERTEX_WIDTHS
    vertex_factor = 2.0 * color.a;
#endif
    drawn.width = line_width(world_position, instance, object.x, vertex_factor);
#endif
    return drawn;
}
