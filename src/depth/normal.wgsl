#define_import_path bevy_comics::depth::normal

// The normal prepass: the only module that declares binding 7.

#import bevy_comics::depth::view::depth_pixel

// (unit normal, 1) of a texel; w is 0 where there is no normal. Stored normals are
// interpolated between vertices, so they are shorter than 1: the squared length is 0.5
// halfway between two vertices at 90 degrees. Below 0.05, ten bits per component say
// little about the direction. The squared length of a cleared texel (the sky) is 3.
fn decode_normal(texel: vec3<f32>) -> vec4<f32> {
    let n = texel * 2.0 - 1.0;
    let squared = dot(n, n);
    let found = squared >= 0.05 && squared <= 1.5;
    return vec4(n * inverseSqrt(max(squared, 0.05)), select(0.0, 1.0, found));
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
