#define_import_path bevy_comics::effect::picture

// The picture after all effects before this one, at any place: for effects that need
// `Needs::PICTURE`. The only module that declares bindings 9 and 10.

#import bevy_comics::depth::view::view

#ifdef CONTINUED
// The viewport after the passes before this one: linear light, multiplied by the opacity. All of it
// is finite.
@group(0) @binding(9) var picture_texture: texture_2d<f32>;
@group(0) @binding(10) var picture_sampler: sampler;
#endif

// The color at a pixel of the render target, in linear light and multiplied by its
// opacity, and the opacity. Outside of the viewport: that of its nearest pixel.
fn load_picture(pixel: vec2<i32>) -> vec4<f32> {
#ifdef CONTINUED
    let last = vec2<i32>(textureDimensions(picture_texture)) - 1;
    return textureLoad(picture_texture, clamp(pixel - view.viewport.xy, vec2(0), last), 0);
#else
    return vec4(0.0);
#endif
}

// The same at a pixel that must be inside the viewport.
fn load_inside(pixel: vec2<i32>) -> vec4<f32> {
#ifdef CONTINUED
    return textureLoad(picture_texture, pixel - view.viewport.xy, 0);
#else
    return vec4(0.0);
#endif
}

// As load_picture() at a position in physical pixels from the render target's top left corner:
// bilinear between the centers of pixels.
fn picture_at(position: vec2<f32>) -> vec4<f32> {
#ifdef CONTINUED
    let inside = position - vec2<f32>(view.viewport.xy);
    let size = vec2<f32>(textureDimensions(picture_texture));
    return textureSampleLevel(picture_texture, picture_sampler, inside / size, 0.0);
#else
    return vec4(0.0);
#endif
}
