#define_import_path bevy_comics::depth::range_of

// Converts the visible range of another view to raw depth of this one. One invocation per view.

struct Conversion {
    factor: f32,
    summand: f32,
    pole: f32,
    is_reciprocal: u32,
}

@group(0) @binding(0) var<uniform> conversion: Conversion;
@group(0) @binding(1) var<storage, read> keys: vec4<u32>;
@group(0) @binding(2) var<storage, read_write> drawn: vec4<u32>;

// Bits of this view's raw depth, clamped to what the reduction can find.
fn converted(bits: u32) -> u32 {
    let d = bitcast<f32>(bits);
    // Behind the eye: under an orthographic projection, near planes may be.
    if conversion.pole < 0.0 && d + conversion.pole >= 0.0 {
        return bitcast<u32>(1.0);
    }
    let value = select(d, 1.0 / (d + conversion.pole), conversion.is_reciprocal == 1u);
    return bitcast<u32>(clamp(conversion.factor * value + conversion.summand, 1.1754944e-38, 1.0));
}

@compute @workgroup_size(1)
fn convert() {
    // No geometry.
    if keys.x == 0u {
        drawn = vec4(0u);
        return;
    }
    drawn = vec4(converted(keys.x), 0u - converted(0u - keys.y), 0u, 0u);
}
