// Copies every sample of the normal prepass, which the engine's texture does not allow the
// encoder to copy.

#ifdef MULTISAMPLED
@group(0) @binding(0) var normals: texture_multisampled_2d<f32>;
#else
@group(0) @binding(0) var normals: texture_2d<f32>;
#endif

@fragment
fn copy_normal(
    @builtin(position) at: vec4<f32>,
#ifdef SAMPLE_SHADING
    @builtin(sample_index) sample: u32,
#endif
) -> @location(0) vec4<f32> {
#ifdef SAMPLE_SHADING
    return textureLoad(normals, vec2<i32>(at.xy), i32(sample));
#else
    return textureLoad(normals, vec2<i32>(at.xy), 0);
#endif
}
