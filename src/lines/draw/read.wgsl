#define_import_path bevy_comics::lines::read

// Reads the lines that the service has drawn: the only module that declares binding 4.
// An entry point calls set_lines() first, with the settings of its own uniform.

#import bevy_comics::depth::view::{inside_viewport, view}
#import bevy_comics::lines::edge::{Lines, decode_ink}
#ifdef OBJECT_STYLES
#import bevy_comics::objects::style_of
#endif
#ifdef SURFACE_LINES
#import bevy_comics::lines::surface::surface_ink
#endif

var<private> lines_drawn: Lines;

fn set_lines(lines: Lines) {
    lines_drawn = lines;
}

#ifdef LINES
// The ink of the viewport, see draw.wgsl.
@group(0) @binding(4) var line_texture: texture_2d<f32>;

#ifdef LINE_OWNERS
// From each pixel of the viewport to the one that owns its line, see draw.wgsl.
@group(0) @binding(5) var owner_texture: texture_2d<i32>;

// The pixel that owns the line at a pixel of the target.
fn line_owner(pixel: vec2<i32>) -> vec2<i32> {
    let offset = textureLoad(owner_texture, inside_viewport(pixel) - view.viewport.xy, 0).xy;
    return inside_viewport(pixel + offset);
}
#endif

#ifdef SURFACE_LINES
var<private> line_surface: vec3<f32>;

// Sets the colour of the surface that the line at the pixel belongs to.
fn set_line_surface(color: vec3<f32>) {
    line_surface = color;
}
#endif

#ifdef LAYER_INK
var<private> line_ink: vec4<f32>;

// Sets the colour that takes the place of part of that of the line at the pixel: multiplied by
// that part, and the part.
fn set_line_ink(ink: vec4<f32>) {
    line_ink = ink;
}
#endif

// Ink at a position, 0 to 1: x silhouettes, y creases, z object edges. `slot` is that of
// the OutlineStyle of the object that the strongest line belongs to; 0: it has none.
struct Found {
    ink: vec3<f32>,
    slot: u32,
}

// Ink and slot / 255 at a pixel of the target.
fn line_texel(pixel: vec2<i32>) -> vec4<f32> {
    let texel = textureLoad(line_texture, inside_viewport(pixel) - view.viewport.xy, 0);
    return vec4(decode_ink(texel.xyz), texel.w);
}

// The lines at a position in physical pixels from the target's top left corner.
// WITHOUT_LINES: there are none nearby, see Effect::line_reach.
fn lines_at(at: vec2<f32>) -> Found {
#ifdef WITHOUT_LINES
    return Found(vec3(0.0), 0u);
#else
    let own = line_texel(vec2<i32>(floor(at)));
    var found = Found(own.xyz, u32(own.w * 255.0 + 0.5));
#ifdef LINES_ANYWHERE
    // Between the centres of pixels: bilinear.
    let corner = floor(at - 0.5);
    let f = at - 0.5 - corner;
    let p = vec2<i32>(corner);
    let above = mix(line_texel(p).xyz, line_texel(p + vec2(1, 0)).xyz, f.x);
    let below = mix(line_texel(p + vec2(0, 1)).xyz, line_texel(p + vec2(1, 1)).xyz, f.x);
    found.ink = mix(above, below, f.y);
#endif
    return found;
#endif
}

// The colour of a line: that of the OutlineStyle in `slot`, if it has one, else that of the
// surface, or `kind_color`, mixed with that of its plane.
fn own_color(slot: u32, kind_color: vec3<f32>) -> vec3<f32> {
    var color = kind_color;
#ifdef SURFACE_LINES
    color = surface_ink(line_surface, lines_drawn.surface_darken, lines_drawn.surface_saturate);
#endif
#ifdef LAYER_INK
    color = (1.0 - line_ink.a) * color + line_ink.rgb;
#endif
#ifdef OBJECT_STYLES
    if slot != 0u {
        let own = style_of(slot);
        return select(color, own.color, own.has_color > 0.0);
    }
#endif
    return color;
}

// Draws the line of largest opacity over the picture ([CL] Eq. 5 takes the maximum): a
// colour in linear light that is multiplied by its opacity, and the opacity. If opacities
// differ by at most 0.01, a silhouette goes before an object edge, and an object edge
// before a crease.
fn draw_lines(picture: vec4<f32>, lines: Found) -> vec4<f32> {
    let s = lines_drawn;
    let alpha = lines.ink * vec3(s.silhouette_opacity, s.crease_opacity, s.object_opacity);
    var color = s.silhouette_color;
    var strongest = alpha.x;
    if alpha.z > strongest + 0.01 {
        color = s.object_color;
        strongest = alpha.z;
    }
    if alpha.y > strongest + 0.01 {
        color = s.crease_color;
        strongest = alpha.y;
    }
    return mix(picture, vec4(own_color(lines.slot, color), 1.0), strongest);
}

// Ink of all kinds together, 0 to 1: the maximum ([CL] Eq. 5).
fn total_ink(lines: Found) -> f32 {
    let s = lines_drawn;
    return max(lines.ink.x * s.silhouette_opacity, max(lines.ink.y * s.crease_opacity, lines.ink.z * s.object_opacity));
}
#endif
