// Copies every sample of the normal prepass, which the engine's texture does not allow the
// encoder to copy.

#ifdef MULTISAMPLED
@group(0) @binding(0) var normals: texture_multisampled_2d<f32>;

@fragment
fn copy_normal(
    @builtin(position) at: vec4<f32>,
    @builtin(sample_index) sample: u32,
) -> @location(0) vec4<f32> {
    return textureLoad(normals, vec2<i32>(at.xy), i32(sample));
}
#else
@group(0) @binding(0) var normals: texture_2d<f32>;

@fragment
fn copy_normal(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(normals, vec2<i32>(at.xy), 0);
}
#endif
