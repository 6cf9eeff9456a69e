#define_import_path bevy_comics::effect::pixel

// What the chain of effects passes from one to the next.

struct Pixel {
    // The picture so far and the unstyled picture, linear light.
    color: vec3<f32>,
    original: vec3<f32>,
    // Centre of the pixel, physical pixels from the target's top left corner.
    position: vec2<f32>,
    // Column and row of the pixel in the viewport, whole numbers from 0.
    inside: vec2<f32>,
    // The depth map D (0 near, 1 far) and its complement, exchanged by
    // `DepthMap::flip`; (1, 0) unless an effect of the chain needs the map.
    depth: vec2<f32>,
    // Share of the saturation that desaturation has left.
    saturation: f32,
    // How much the lightness of the unstyled picture changes over this pixel; 0
    // unless an effect of the chain needs it.
    change: f32,
}
