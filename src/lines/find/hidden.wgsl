#define_import_path bevy_comics::lines::hidden

// Which pixels of highlighted objects are hidden in the picture: the only module that declares
// binding 27.

#import bevy_comics::depth::raw::raw_depth
#import bevy_comics::depth::view::view
#import bevy_comics::lines::edge::is_in_front
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::objects::texel_object

// Depth of the picture; that of the view is that of the highlighted objects.
#ifdef MULTISAMPLED_PICTURE
@group(0) @binding(27) var picture_depth: texture_multisampled_2d<f32>;
#else
@group(0) @binding(27) var picture_depth: texture_2d<f32>;
#endif

// The bit above an object's slot and section where it is hidden.
const HIDDEN: u32 = 0x10000u;

// What hides an object is in front of it by this part of a jump at least.
const LEAST: f32 = 0.1;

// The object at a pixel of the depth texture, see texel_object, with its bit. `own`: its raw
// depth.
fn highlighted_object(at: vec2<i32>, own: f32) -> vec2<u32> {
    let s = line_pass.settings;
    let jump = LEAST * s.jump * (s.reference_factor * own + s.reference_constant);
    let d = raw_depth(view.raw, vec2<u32>(at), textureLoad(picture_depth, at, 0).r);
    return texel_object(at, 0) | vec2(0u, select(0u, HIDDEN, is_in_front(d, own, jump)));
}
