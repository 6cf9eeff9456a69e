#define_import_path bevy_comics::toon::visible

// Detail by the distance within the visible range: pure functions.

#import bevy_comics::depth::map::{DepthFrame, EMPTY, depth_map, has}

// A `DepthFrame` in the form that vertices hand on.
struct ViewRange {
    // Its ends, offset and floor.
    ends: vec4<f32>,
    // Its far plane, extent and flags; the distance of depth 1 in an oblique view, else 0.
    scale: vec4<f32>,
}

fn frame_of(range: ViewRange) -> DepthFrame {
    return DepthFrame(
        range.ends.x, range.ends.y, range.ends.z, range.ends.w, range.scale.x, range.scale.y,
        0.0, u32(range.scale.z),
    );
}

// All of it at the near end of the range and without a range, none at the far end; between, it changes
// with the logarithm of the distance. `depth` is that of the pixel, `z` its distance along the view
// axis.
fn detail_in_range(range: ViewRange, depth: f32, z: f32) -> f32 {
    let frame = frame_of(range);
    if has(frame, EMPTY) {
        return 1.0;
    }
    let unit = range.scale.w;
    let raw = select(depth, unit / max(z, unit), unit > 0.0);
    return depth_map(frame, raw).y;
}
