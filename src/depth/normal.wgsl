#define_import_path bevy_comics::depth::normal

// The normal prepass: the only owner of binding 7.

#import bevy_comics::depth::view::depth_pixel

// (normal, 1) of a texel; w is 0 where there is none: the sky, and whatever is not
// of unit length within the precision of ten bits.
fn decode_normal(texel: vec3<f32>) -> vec4<f32> {
    let n = texel * 2.0 - 1.0;
    let squared = dot(n, n);
    return vec4(n, select(0.0, 1.0, squared >= 0.5 && squared <= 1.5));
}

#ifdef NORMALS
#ifdef MULTISAMPLED
@group(0) @binding(7) var normal_texture: texture_multisampled_2d<f32>;
#else
@group(0) @binding(7) var normal_texture: texture_2d<f32>;
#endif

// World normal of a pixel's first sample; w is 0 where there is none.
fn load_normal(pixel: vec2<i32>) -> vec4<f32> {
    return decode_normal(textureLoad(normal_texture, depth_pixel(pixel), 0).xyz);
}
#endif
