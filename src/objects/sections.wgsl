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

// How many sections a mesh can have that were found in all meshes, and that were asked for.
const FOUND: u32 = 63u;
const ASKED: u32 = 64u;

struct Drawn {
    @location(0) object: vec2<u32>,
#ifdef LINE_WIDTHS
    @location(1) width: f32,
#endif
}

// The section of a triangle. `start`: the first word of the mesh's sections, and from bit 24 on, for
// meshes that share their id, 1 more than a number by which theirs are shifted, in ranges of their
// own: numbers up to FOUND from 128 on, the others from 191 on. 255 is no section.
fn section(start: u32, triangle: u32) -> u32 {
    let at = (start & 0xffffffu) + triangle / 4u;
    let word = sections[min(at, arrayLength(&sections) - 1u)];
    let number = (word >> (8u * (triangle % 4u))) & 255u;
    let shift = (start >> 24u) & 127u;
    if shift == 0u || number == 0u || number == 255u {
        return number;
    }
    if number <= FOUND {
        return 128u + (number + shift - 2u) % FOUND;
    }
    return 191u + (number + shift - FOUND - 2u) % ASKED;
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
    drawn.object = vec2(object.x, object.y | (section(object.z, triangle) << 8u));
#ifdef LINE_WIDTHS
    var vertex_factor = 1.0;
#ifdef VERTEX_WIDTHS
    vertex_factor = 2.0 * color.a;
#endif
    drawn.width = line_width(world_position, instance, object.x, vertex_factor);
#endif
    return drawn;
}
