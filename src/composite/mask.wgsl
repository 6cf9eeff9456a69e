#define_import_path bevy_comics::composite::mask

// Which part of a pixel the effects of a camera change, see StyleMask and BeyondPrepass: the only
// module that declares binding 33.

#ifdef MASK
#import bevy_comics::depth::view::{depth_pixel, inside_viewport}
#endif
#ifdef MASKED_BY_DEPTH
#import bevy_comics::depth::map::is_background
// One import for each item: two are ambiguous.
#import bevy_comics::depth::view::texel_depth
#else ifdef BEYOND_PREPASS
#import bevy_comics::depth::view::texel_depth
#endif
#ifdef MASKED_BY_IDS
#import bevy_comics::objects::texel_object
#endif
#ifdef BEYOND_PREPASS
#import bevy_comics::depth::raw::raw_depth
#import bevy_comics::depth::view::view

// The depth that the main pass has drawn.
#ifdef MULTISAMPLED
@group(0) @binding(33) var drawn_depth: texture_multisampled_2d<f32>;
#else
@group(0) @binding(33) var drawn_depth: texture_2d<f32>;
#endif

// Whether the picture shows something that is not in the prepass, at a pixel and sample of the
// prepass textures.
fn is_beyond_prepass(at: vec2<i32>, sample: i32) -> bool {
#ifdef MULTISAMPLED
    let drawn = textureLoad(drawn_depth, at, sample).r;
#else
    let drawn = textureLoad(drawn_depth, at, 0).r;
#endif
    let raw = raw_depth(view.raw, vec2<u32>(at), drawn);
    let surface = texel_depth(at, sample);
    return raw > view.backdrop && raw > surface + view.nearer.x * surface + view.nearer.y;
}
#endif

#ifdef MASKED_BY_IDS
// Whether the camera has drawn an object where lines at this pixel may come from: half of a line
// lies outside of its object. Elsewhere, lines are those of what another camera has drawn.
fn is_near_own(pixel: vec2<i32>) -> bool {
    let reach = #{MASK_REACH};
    for (var y = -reach; y <= reach; y++) {
        for (var x = -reach; x <= reach; x++) {
            let there = inside_viewport(pixel + vec2(x, y));
            if texel_object(depth_pixel(there), 0).x != 0u {
                return true;
            }
        }
    }
    return false;
}
#endif

#ifdef MASK
// The fraction of a pixel that effects change: x: those that change all pixels, y: lines.
fn changed_fractions(pixel: vec2<i32>) -> vec2<f32> {
    let at = depth_pixel(pixel);
#ifdef MULTISAMPLED
    let samples = #{SAMPLES};
#else
    let samples = 1;
#endif
    var sum = vec2(0.0);
    for (var s = 0; s < samples; s++) {
        var changed = vec2(1.0);
#ifdef MASKED_BY_IDS
        changed.x = select(0.0, 1.0, texel_object(at, s).x != 0u);
#endif
#ifdef MASKED_BY_DEPTH
        changed.x = select(1.0, 0.0, is_background(texel_depth(at, s)));
#endif
#ifdef BEYOND_PREPASS
        if is_beyond_prepass(at, s) {
#ifdef BEYOND_PLAIN
            changed = vec2(0.0);
#else
            changed.y = 0.0;
#endif
        }
#endif
        sum += changed;
    }
    let changed = sum / f32(samples);
#ifdef MASKED_BY_IDS
    if changed.x == 0.0 && !is_near_own(pixel) {
        return vec2(0.0);
    }
    return changed;
#else
    return changed;
#endif
}
#endif
