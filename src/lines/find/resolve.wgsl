// Picks one sample of every pixel of a multisampled view for its depth, and one for its
// normal, object and width of lines. The passes that find and draw lines read these.
//
// The depth is that of the nearest one: an object that covers any sample of a pixel has the pixel, so
// wires down to 0.4 pixels (at 4 samples) have lines without gaps. At a fixed sample,
// wires below one pixel have gaps. Over a plane, the nearest sample is the same one in
// every pixel, so depth stays affine there.
//
// In exchange, a silhouette lies further out by the distance to the outermost sample:
// 0.35 to 0.4 pixels at 4 samples, alike in all directions.
//
// Where no jump in depth separates the first sample from the nearest, normal and object are
// those of the first. Along a crease, the nearest sample lies on either side in turn, and
// the crease would be jagged. Between two objects or sections, the step of a faint silhouette is
// enough: the object edge or crease would run a pixel beside that silhouette.

#import bevy_comics::depth::view::{depth_texel, sample_count, set_view, texel_depth}
#import bevy_comics::lines::edge::least_silhouette
#import bevy_comics::lines::pass::line_pass
#ifdef NORMALS
#import bevy_comics::depth::normal::normal_texel
#endif
#ifdef OBJECT_IDS
#import bevy_comics::objects::texel_object
#endif
#ifdef WIDTH_MAP
#import bevy_comics::objects::width_texel
#endif

// Texels as the prepasses store them.
struct Resolved {
    @location(0) depth: f32,
#ifdef NORMALS
    @location(1) normal: vec4<f32>,
#endif
#ifdef OBJECT_IDS
    @location(2) object: vec2<u32>,
#endif
#ifdef WIDTH_MAP
    @location(3) width: f32,
#endif
}

// The sample of largest raw depth at a pixel of the depth texture; of equal ones the
// first.
fn nearest_sample(at: vec2<i32>) -> i32 {
    var nearest = texel_depth(at, 0);
    var chosen = 0;
    for (var sample = 1; sample < sample_count(); sample++) {
        let d = texel_depth(at, sample);
        chosen = select(chosen, sample, d > nearest);
        nearest = max(nearest, d);
    }
    return chosen;
}

// The sample whose normal and object are read, if `nearest` is the nearest one.
fn surface_sample(at: vec2<i32>, nearest: i32) -> i32 {
    let s = line_pass.settings;
    let near = texel_depth(at, nearest);
    var least = s.jump;
#ifdef OBJECT_IDS
#ifdef SILHOUETTES
    let differ = any(texel_object(at, 0) != texel_object(at, nearest));
    least = select(least, least_silhouette(s), differ);
#endif
#endif
    let separated = near - least * (s.reference_factor * near + s.reference_constant);
    return select(nearest, 0, texel_depth(at, 0) >= separated);
}

@fragment
fn resolve(@builtin(position) position: vec4<f32>) -> Resolved {
    set_view(line_pass.seen);
    let at = vec2<i32>(position.xy);
    let chosen = nearest_sample(at);
    let surface = surface_sample(at, chosen);
    var out: Resolved;
    out.depth = depth_texel(at, chosen);
#ifdef NORMALS
    out.normal = normal_texel(at, surface);
#endif
#ifdef OBJECT_IDS
    out.object = texel_object(at, surface);
#endif
#ifdef WIDTH_MAP
    out.width = width_texel(at, surface);
#endif
    return out;
}
