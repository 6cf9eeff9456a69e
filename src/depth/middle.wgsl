#define_import_path bevy_comics::depth::middle

// Finds the depth in the middle of a view: the median of 25 places, smoothed over time. One
// invocation per view and frame; its state stays on the GPU.

#import bevy_comics::depth::level::{BEGIN, RESET, Smoothing, bits_of, level_of}
#import bevy_comics::depth::raw::{RangeView, raw_depth_key}

// Places along a side of the square, and their distance as a fraction of the view's height.
const SIDE: u32 = 5u;
const SPACING: f32 = 0.005;

// Time constant in seconds.
const SECONDS: f32 = 0.15;

// A level this close to its goal is set to it.
const SETTLED: f32 = 0.00025;

struct VisibleRange {
    keys: vec4<u32>,
    // x: bits of the depth; y: 1 after the first frame.
    middle: vec4<u32>,
}

#ifdef MULTISAMPLED
@group(0) @binding(0) var depth_texture: texture_multisampled_2d<f32>;
#else
@group(0) @binding(0) var depth_texture: texture_2d<f32>;
#endif
@group(0) @binding(1) var<uniform> view: RangeView;
@group(0) @binding(2) var<uniform> smoothing: Smoothing;
@group(0) @binding(3) var<storage, read_write> drawn: VisibleRange;

// Bits of the median of the places.
fn median() -> u32 {
    var found: array<u32, 25>;
    let step = max(i32(round(SPACING * f32(view.rect.w))), 1);
    let first = vec2<i32>(view.rect.xy);
    let last = first + vec2<i32>(view.rect.zw) - 1;
    for (var i = 0u; i < SIDE * SIDE; i++) {
        let offset = vec2(i32(i % SIDE), i32(i / SIDE)) - i32(SIDE / 2u);
        let pixel = clamp(first + vec2<i32>(view.rect.zw / 2u) + step * offset, first, last);
        found[i] = raw_depth_key(view.raw, vec2<u32>(pixel), textureLoad(depth_texture, pixel, 0).r);
    }
    for (var i = 0u; i < SIDE * SIDE; i++) {
        var less = 0u;
        var equal = 0u;
        for (var j = 0u; j < SIDE * SIDE; j++) {
            less += u32(found[j] < found[i]);
            equal += u32(found[j] == found[i]);
        }
        if less <= SIDE * SIDE / 2u && less + equal > SIDE * SIDE / 2u {
            return found[i];
        }
    }
    return 0u;
}

@compute @workgroup_size(1)
fn follow() {
    let goal = median();
    let last = drawn.middle.x;
    let starts = (smoothing.flags & (RESET | BEGIN)) != 0u;
    var bits = goal;
    // Between a surface and the sky there is nothing to approach.
    if drawn.middle.y != 0u && !starts && goal != 0u && last != 0u {
        let rest = level_of(smoothing, last) - level_of(smoothing, goal);
        let left = rest * exp(-smoothing.seconds / SECONDS);
        if abs(left) > SETTLED {
            bits = bits_of(smoothing, level_of(smoothing, goal) + left);
        }
    }
    drawn.middle = vec4(bits, 1u, 0u, 0u);
}
