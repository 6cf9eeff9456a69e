#define_import_path bevy_comics::depth::normal

// The normal prepass: the only module that declares binding 7.

#import bevy_comics::depth::view::depth_pixel

// (normal, 1) of a texel; w is 0 where there is no normal. The squared length of a
// normal is close to 1 (10 bits per component), that of a cleared texel (the sky) is 3.
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

// (normal, 1) of a pixel's first sample, in world space; w is 0 where there is none.
fn load_normal(pixel: vec2<i32>) -> vec4<f32> {
    return texel_normal(depth_pixel(pixel), 0);
}

// The same at a pixel and sample of the prepass texture.
fn texel_normal(at: vec2<i32>, sample: i32) -> vec4<f32> {
    return decode_normal(normal_texel(at, sample).xyz);
}

// The texel of the prepass texture at a pixel and sample of it.
fn normal_texel(at: vec2<i32>, sample: i32) -> vec4<f32> {
    return textureLoad(normal_texture, at, sample);
}
#endif
