#define_import_path bevy_comics::effect::pixel

// The state of a pixel that each effect receives and returns.

struct Pixel {
    // The picture after the effects so far, and the unstyled picture: linear light,
    // multiplied by the opacity.
    color: vec3<f32>,
    original: vec3<f32>,
    // The unstyled picture in the camera's `ToneRange`; without one the same as `original`.
    toned: vec3<f32>,
    // The picture after the effects that change colors, before ink; like `color`. Set
    // from the stage Ink on.
    colored: vec3<f32>,
    // Opacity of the picture after the effects so far, 0 to 1: below 1 where the
    // background shows through. Opaque ink of coverage a makes it a + (1 - a) * alpha.
    alpha: f32,
    // Center of the pixel in the render target: physical pixels from its top left
    // corner.
    position: vec2<f32>,
    // Column and row of the pixel in the viewport, whole numbers from 0.
    inside: vec2<f32>,
    // The depth map D (0 near, 1 far) and its complement 1 - D, exchanged if
    // `DepthMap::flip` is set; (1, 0) unless an effect of the camera needs the map.
    depth: vec2<f32>,
    // Fraction of the saturation that remains after Desaturation, 0 to 1.
    saturation: f32,
    // Factors that DepthLayers has set, 0 to 1: of the darkness of hatching, and of the fraction of
    // screens that is seen as dots. 1 again in a later pass, see Needs::PICTURE.
    print_factors: vec2<f32>,
    // How often the bands of tones split, and the factor of the distance of strokes: 0 and 1
    // unless an effect sets them, and again in a later pass.
    splits: f32,
    spacing: f32,
    // Change of the lightness of `toned` over this pixel (fwidth); 0 unless an effect of
    // the camera needs it.
    change: f32,
}
