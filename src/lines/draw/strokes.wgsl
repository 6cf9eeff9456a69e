// Draws the strokes that extend lines beyond their loose ends, over the ink of draw.wgsl.

#ifdef BOIL
#import bevy_comics::lines::boil::boiled
#endif
#import bevy_comics::lines::coverage::segment_coverage
#import bevy_comics::lines::edge::{CONCAVE, CONVEX, CREASE, OBJECT, encode_ink, ink_of, is_convex, unpack_width}
#import bevy_comics::lines::pass::line_pass
#ifdef TAPER_WEIGHT
#import bevy_comics::lines::overshoot::stroke_width
#endif
#ifdef INK_BLEED
#import bevy_comics::lines::sheet::{height_under, spread_width}
#endif
#ifdef STREAKS
#import bevy_comics::lines::sheet::dry_ink
#endif
#ifdef OBJECT_STYLES
#import bevy_comics::depth::view::set_view
#import bevy_comics::objects::texel_slot
#endif

// An instance: Stroke of ends.wgsl.
struct Corner {
    @builtin(position) position: vec4<f32>,
    // The ends of the stroke in pixels of the viewport.
    @location(0) @interpolate(flat) segment: vec4<f32>,
    @location(1) @interpolate(flat) line: vec4<u32>,
}

struct Drawn {
    @location(0) ink: vec4<f32>,
#ifdef SURFACE
    // See draw.wgsl.
    @location(1) owner: vec4<i32>,
#endif
}

// A place of the viewport from one of the grid.
fn in_viewport(place: vec2<f32>) -> vec2<f32> {
    let g = line_pass.grid;
    return (place - g.from_viewport.zw) / g.from_viewport.xy;
}

fn pixel_of(shorts: u32) -> vec2<i32> {
    return vec2(extractBits(i32(shorts), 0u, 16u), extractBits(i32(shorts), 16u, 16u));
}

// The corners of the rectangle around a stroke.
@vertex
fn corner(
    @builtin(vertex_index) index: u32,
    @location(0) segment: vec4<f32>,
    @location(1) line: vec4<u32>,
) -> Corner {
    let a = in_viewport(segment.xy);
    let b = in_viewport(segment.zw);
    let margin = unpack_width(line.x >> 20u) + 1.0 + line_pass.boil.amplitude
        + 0.5 * line_pass.sheet.ink_bleed;
    let far = vec2<f32>(vec2(index & 1u, index >> 1u));
    let place = mix(min(a, b) - margin, max(a, b) + margin, far);
    let size = vec2<f32>(line_pass.seen.viewport.zw);
    let clip = (place / size * 2.0 - 1.0) * vec2(1.0, -1.0);
    return Corner(vec4(clip, 0.0, 1.0), vec4(a, b), line);
}

@fragment
fn stroke(at: Corner) -> Drawn {
    var place = at.position.xy;
#ifdef BOIL
    place = boiled(line_pass.boil, place);
#endif
    let a = at.segment.xy;
    let b = at.segment.zw;
    var half_width = unpack_width(at.line.x >> 20u);
    var kinds = ink_of(at.line.x);
#ifdef TAPER_WEIGHT
    // In cracks, as tapers are.
    let scale = line_pass.grid.from_viewport.x;
    let length = distance(a, b) * scale;
    let away = clamp(dot(place - a, normalize(b - a)) * scale, 0.0, length);
    let width = stroke_width(line_pass.weight, half_width, length, away);
    half_width = width.x;
    kinds *= width.y;
#endif
#ifdef STREAKS
    kinds *= dry_ink(line_pass.sheet, at.position.xy, b - a, half_width);
#endif
#ifdef INK_BLEED
    half_width = spread_width(line_pass.sheet, half_width, height_under(line_pass.sheet, at.position.xy));
#endif
    kinds *= segment_coverage(place, a, b, half_width);
    if all(kinds <= vec3(0.0)) {
        discard;
    }
    var slot = 0.0;
#ifdef OBJECT_STYLES
    set_view(line_pass.seen);
    let rect = line_pass.grid.rect;
    slot = f32(texel_slot(rect.xy + clamp(pixel_of(at.line.y), vec2(0), rect.zw - 1), 0)) / 255.0;
#endif
    var drawn: Drawn;
    drawn.ink = vec4(encode_ink(kinds), slot);
#ifdef SURFACE
#ifdef INWARD
    let inside = pixel_of(at.line.z);
#else
    let inside = pixel_of(at.line.y);
#endif
    let owner = in_viewport(vec2<f32>(inside) + 0.5);
    let offset = vec2<i32>(floor(owner)) - vec2<i32>(at.position.xy);
    var sign = 0;
#ifdef EDGE_STYLES
    sign = select(select(0, CONCAVE, (at.line.x & (CREASE | OBJECT)) == CREASE), CONVEX, is_convex(at.line.x));
#endif
    drawn.owner = vec4(clamp(offset, vec2(-127), vec2(127)), sign, 0);
#endif
    return drawn;
}
