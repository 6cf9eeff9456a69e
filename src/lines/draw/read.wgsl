#define_import_path bevy_comics::lines::read

// Reads the lines that the service has drawn: the only module that declares binding 4.
// An entry point calls set_lines() first, with the settings of its own uniform.

#import bevy_comics::depth::view::{inside_viewport, view}
#import bevy_comics::lines::edge::{Lines, decode_ink, largest_opacity}
#ifdef OBJECT_STYLES
#import bevy_comics::objects::style_of
#endif
#ifdef SURFACE_LINES
#import bevy_comics::lines::surface::surface_ink
#endif
#ifdef EDGE_STYLES
#import bevy_comics::lines::edge::{CONVEX, EDGE_INK, EDGE_SURFACE}
#import bevy_comics::lines::surface::lightened
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

fn owner_texel(pixel: vec2<i32>) -> vec4<i32> {
    return textureLoad(owner_texture, inside_viewport(pixel) - view.viewport.xy, 0);
}

// The pixel that owns the line at a pixel of the target.
fn line_owner(pixel: vec2<i32>) -> vec2<i32> {
    return inside_viewport(pixel + owner_texel(pixel).xy);
}
#endif

#ifdef SURFACE_LINES
var<private> line_surface: vec3<f32>;

// Sets the color of the surface that the line at the pixel belongs to.
fn set_line_surface(color: vec3<f32>) {
    line_surface = color;
}
#endif

#ifdef LAYER_INK
var<private> line_ink: vec4<f32>;

// Sets the color that takes the place of part of that of the line at the pixel: multiplied by
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
    // EDGE_STYLES: the sign of the crease, see edge.wgsl.
    sign: i32,
}

// Ink and slot / 255 at a pixel of the target.
fn line_texel(pixel: vec2<i32>) -> vec4<f32> {
    let texel = textureLoad(line_texture, inside_viewport(pixel) - view.viewport.xy, 0);
    return vec4(decode_ink(texel.xyz), texel.w);
}

#ifdef EDGE_STYLES
// The sign of the creases at a pixel. Under temporal anti-aliasing, creases of earlier frames have ink
// where there is no line in this one: then it is that of a pixel beside it.
fn sign_at(pixel: vec2<i32>, creases: f32) -> i32 {
    var sign = owner_texel(pixel).z;
    if sign == 0 && creases > 0.0 {
        for (var i = 0; i < 9; i++) {
            sign = max(sign, owner_texel(pixel + vec2(i % 3 - 1, i / 3 - 1)).z);
        }
    }
    return sign;
}
#endif

// The lines at a position in physical pixels from the target's top left corner.
// WITHOUT_LINES: there are none nearby, see Effect::line_reach.
fn lines_at(at: vec2<f32>) -> Found {
#ifdef WITHOUT_LINES
    return Found(vec3(0.0), 0u, 0);
#else
    let own = line_texel(vec2<i32>(floor(at)));
    var found = Found(own.xyz, u32(own.w * 255.0 + 0.5), 0);
#ifdef EDGE_STYLES
    found.sign = sign_at(vec2<i32>(floor(at)), found.ink.y);
#endif
#ifdef LINES_ANYWHERE
    // Between the centers of pixels: bilinear.
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

// The color of lines of a kind that has `ink`, without those of their object and plane.
fn kind_color(ink: vec3<f32>) -> vec3<f32> {
#ifdef SURFACE_LINES
    if lines_drawn.surface_darken >= 0.0 {
        return surface_ink(line_surface, lines_drawn.surface_darken, lines_drawn.surface_saturate);
    }
#endif
    return ink;
}

// The color of creases of a sign.
fn crease_color(sign: i32) -> vec3<f32> {
    let otherwise = kind_color(lines_drawn.crease_color);
#ifdef EDGE_STYLES
    if sign == 0 {
        return otherwise;
    }
    var edge = lines_drawn.concave;
    if sign == CONVEX {
        edge = lines_drawn.convex;
    }
#ifdef SURFACE_LINES
    if edge.source == EDGE_SURFACE {
        return lightened(line_surface, edge.lighten, edge.saturate);
    }
#endif
    return select(otherwise, edge.color, edge.source == EDGE_INK);
#else
    return otherwise;
#endif
}

// The color of a line: that of the OutlineStyle in `slot`, if it has one, else that of its kind, mixed
// with that of its plane.
fn own_color(slot: u32, of_kind: vec3<f32>) -> vec3<f32> {
    var color = of_kind;
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
// color in linear light that is multiplied by its opacity, and the opacity. If opacities
// differ by at most 0.01, a silhouette goes before an object edge, and an object edge
// before a crease.
fn draw_lines(picture: vec4<f32>, lines: Found) -> vec4<f32> {
    let s = lines_drawn;
    let alpha = lines.ink * vec3(s.silhouette_opacity, s.crease_opacity, s.object_opacity);
    var color = kind_color(s.silhouette_color);
    var strongest = alpha.x;
    if alpha.z > strongest + 0.01 {
        color = kind_color(s.object_color);
        strongest = alpha.z;
    }
    if alpha.y > strongest + 0.01 {
        color = crease_color(lines.sign);
        strongest = alpha.y;
    }
    return mix(picture, vec4(own_color(lines.slot, color), 1.0), strongest);
}

// Ink of all kinds together, 0 to 1: the maximum ([CL] Eq. 5).
fn total_ink(lines: Found) -> f32 {
    return largest_opacity(lines_drawn, lines.ink);
}
#endif
