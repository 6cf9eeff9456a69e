#define_import_path bevy_comics::effect::aux_scalar

// The picture before an effect with a number of the effect's own at each pixel, for effects that
// need `Needs::AUX_SCALAR`, by one load. The only module that declares binding 13.

#import bevy_comics::depth::view::view

#ifdef AUX_SCALAR
@group(0) @binding(13) var aux_scalar_texture: texture_2d<u32>;
#endif

struct WithScalar {
    // Linear light, multiplied by the opacity, and the opacity.
    color: vec4<f32>,
    number: f32,
}

fn packed_number(color: vec4<f32>, number: f32) -> vec4<u32> {
    return vec4(pack2x16float(color.rg), pack2x16float(color.ba), bitcast<u32>(number), 0u);
}

// A pixel of the render target, which must be inside the viewport.
fn load_aux_scalar(pixel: vec2<i32>) -> WithScalar {
#ifdef AUX_SCALAR
    let words = textureLoad(aux_scalar_texture, pixel - view.viewport.xy, 0);
    return WithScalar(vec4(unpack2x16float(words.x), unpack2x16float(words.y)), bitcast<f32>(words.z));
#else
    return WithScalar(vec4(0.0), 0.0);
#endif
}
