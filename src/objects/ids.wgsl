// Writes the object at each pixel: its id and the slot of its outline style. The vertex
// shader is that of the depth prepass.

#ifdef LINE_WIDTHS
#import bevy_comics::objects::widths::line_width
#endif
#ifdef TOLERANT
#import bevy_comics::objects::tolerance::{Fragment, shows}
#endif

// Id, slot, and the first word of the sections.
@group(1) @binding(0) var<storage, read> objects: array<vec4<u32>>;

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
    drawn.object = objects[min(instance, arrayLength(&objects) - 1u)].xy;
#ifdef LINE_WIDTHS
    var vertex_factor = 1.0;
#ifdef VERTEX_WIDTHS
    vertex_factor = 2.0 * color.a;
#endif
    drawn.width = line_width(world_position, instance, drawn.object.x, vertex_factor);
#endif
    return drawn;
}
