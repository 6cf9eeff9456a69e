// Draws the lines of highlighted objects over the picture.

#import bevy_comics::effect::color::to_stored
#import bevy_comics::lines::edge::decode_ink
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::objects::style_of

// Ink of the layer, see draw.wgsl.
@group(0) @binding(4) var ink_texture: texture_2d<f32>;

@fragment
fn draw_highlights(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let viewport = line_pass.seen.viewport;
    let pixel = clamp(vec2<i32>(position.xy) - viewport.xy, vec2(0), viewport.zw - 1);
    let texel = textureLoad(ink_texture, pixel, 0);
    let kinds = decode_ink(texel.xyz);
    let ink = max(kinds.x, max(kinds.y, kinds.z));
    let color = style_of(u32(texel.w * 255.0 + 0.5)).color;
    return vec4(to_stored(color) * ink, ink);
}
