// Counts pixels that the depth prepass covers, and those of them without an object id. Looks at
// the first sample of every fourth pixel of every fourth row: what a device loses are triangles,
// not single pixels.

#ifdef MULTISAMPLED
@group(0) @binding(0) var depth_texture: texture_multisampled_2d<f32>;
@group(0) @binding(1) var object_texture: texture_multisampled_2d<u32>;
#else
@group(0) @binding(0) var depth_texture: texture_2d<f32>;
@group(0) @binding(1) var object_texture: texture_2d<u32>;
#endif
// Origin and size of the viewport in pixels of the depth texture.
@group(0) @binding(2) var<uniform> viewport: vec4<u32>;

struct Counts {
    covered: atomic<u32>,
    missing: atomic<u32>,
}
@group(0) @binding(3) var<storage, read_write> counts: Counts;

// STEP and STRIP of count.rs: pixels from one that is counted to the next; pixels that an
// invocation counts, in a row.
const STEP: u32 = 4u;
const STRIP: u32 = 16u;

@compute @workgroup_size(8, 8)
fn count(@builtin(global_invocation_id) id: vec3<u32>) {
    let last = textureDimensions(depth_texture) - 1u;
    var covered = 0u;
    var missing = 0u;
    for (var i = 0u; i < STRIP; i++) {
        let inside = STEP * vec2(STRIP * id.x + i, id.y);
        let at = min(viewport.xy + inside, last);
        let is_covered = all(inside < viewport.zw) && textureLoad(depth_texture, at, 0).x > 0.0;
        covered += u32(is_covered);
        missing += u32(is_covered && textureLoad(object_texture, at, 0).x == 0u);
    }
    if covered > 0u {
        atomicAdd(&counts.covered, covered);
    }
    if missing > 0u {
        atomicAdd(&counts.missing, missing);
    }
}
