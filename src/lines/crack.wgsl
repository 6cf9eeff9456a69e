#define_import_path bevy_comics::lines::crack

// Decides which cracks have a line: those where a surface ends, bends or meets another
// object.

#import bevy_comics::depth::map::depth_map
#import bevy_comics::depth::view::depth_frame
#import bevy_comics::lines::edge::{
    CREASE, Lines, OBJECT, SILHOUETTE, THINNEST, byte, fold_response, pack_ink, step_response,
}
#import bevy_comics::lines::rows::Borders
#import bevy_comics::objects::kinds_of
#ifdef OBJECT_STYLES
#import bevy_comics::objects::style_of
#endif

// The kinds of line that four objects draw.
fn kinds_of_four(slots: vec4<u32>) -> vec4<u32> {
#ifdef OBJECT_STYLES
    return vec4(kinds_of(slots.x), kinds_of(slots.y), kinds_of(slots.z), kinds_of(slots.w));
#else
    return vec4(7u);
#endif
}

fn has(kinds: vec4<u32>, kind: u32) -> vec4<bool> {
    return (kinds & vec4(kind)) != vec4(0u);
}

// Whether the line belongs to `here`: to the object that draws this kind of line if the
// other does not, otherwise to the nearer one, otherwise to `here`.
fn owned(here_nearer: vec4<bool>, has_here: vec4<bool>, has_there: vec4<bool>) -> vec4<bool> {
    return select(here_nearer, has_here, has_here != has_there);
}

fn half_width_of(slots: vec4<u32>, s: Lines) -> vec4<f32> {
    var width = vec4(s.half_width);
#ifdef OBJECT_STYLES
    let own = vec4(
        style_of(slots.x).half_width, style_of(slots.y).half_width,
        style_of(slots.z).half_width, style_of(slots.w).half_width,
    );
    width = select(width, own * s.scale, (slots != vec4(0u)) & (own >= vec4(0.0)));
#endif
    return width;
}

// The factor of the opacity of lines that belong to these objects.
fn opacity_of(slots: vec4<u32>) -> vec4<f32> {
#ifdef OBJECT_STYLES
    return vec4(
        style_of(slots.x).opacity, style_of(slots.y).opacity,
        style_of(slots.z).opacity, style_of(slots.w).opacity,
    );
#else
    return vec4(1.0);
#endif
}

// Four cracks.
struct Cracks {
    // Packed, see Crack in edge.wgsl; 0 where there is none.
    packed: vec4<u32>,
    // Whether they are lines by themselves. The others only continue lines.
    certain: vec4<bool>,
}

// Packs ink and half width as they respond to the `amount` of the full response, 0 to 1.
// Along object edges, which have no response, lines have their full width.
fn pack_response(s: Lines, amount: vec4<f32>, object: vec4<bool>, opacity: vec4<f32>, half_width: vec4<f32>) -> vec4<u32> {
    let thinnest = min(half_width, vec4(THINNEST));
    let thinner = half_width * select(mix(vec4(1.0), amount, s.width_part), vec4(1.0), object);
    let fainter = min(thinner / max(thinnest, vec4(1e-3)), vec4(1.0));
    let ink = mix(fainter, amount * fainter, max(vec4(s.ink_part), vec4<f32>(object)));
    return pack_ink(ink, opacity, max(thinner, thinnest));
}

fn cracks(s: Lines, at: Borders) -> Cracks {
    let near = max(at.here, at.there);
    let reference = s.reference_factor * near + s.reference_constant;
    let here_nearer = at.here >= at.there;
    let kinds_here = kinds_of_four(at.slot_here);
    let kinds_there = kinds_of_four(at.slot_there);
    var found = vec4(0u);
    var ink = vec4(0.0);
    var mine = here_nearer;
    var certain = vec4(false);
#ifdef SILHOUETTES
    let depth_response = step_response(at.excess, s.silhouette_k * reference);
    let depth_ink = smoothstep(vec4(s.silhouette_low), vec4(s.silhouette_high), depth_response);
    let draws = has(select(kinds_there, kinds_here, here_nearer), SILHOUETTE);
    let silhouette = draws & (near > vec4(0.0)) & (byte(depth_ink) > vec4(0u));
    found |= select(vec4(0u), vec4(SILHOUETTE), silhouette);
    ink = select(ink, depth_ink, silhouette);
    certain = silhouette & (depth_response >= vec4(s.silhouette_limit));
#endif
#ifdef CREASES
    let bend_response = fold_response(at.folds, s.crease_k);
    let bend_ink = smoothstep(vec4(s.crease_low), vec4(s.crease_high), bend_response);
    let creased_here = has(kinds_here, CREASE);
    let creased_there = has(kinds_there, CREASE);
    // Both sides of a crease meet: there is no jump in depth between them.
    let joined = at.excess < s.jump * reference;
    let crease = at.ridge & joined & (creased_here | creased_there) & (byte(bend_ink) > vec4(0u)) & (found == vec4(0u));
    found |= select(vec4(0u), vec4(CREASE), crease);
    ink = select(ink, bend_ink, crease);
    certain |= crease & (bend_response >= vec4(s.crease_limit));
    mine = select(mine, owned(here_nearer, creased_here, creased_there), crease);
#endif
#ifdef OBJECT_EDGES
    let edged_here = has(kinds_here, OBJECT);
    let edged_there = has(kinds_there, OBJECT);
    // If one object hides the other, the line belongs to the nearer one, even if that
    // has no object edges: then there is none.
    let hides = abs(at.here - at.there) > s.jump * reference;
    let object_mine = select(owned(here_nearer, edged_here, edged_there), here_nearer, hides);
    let drawn = select(edged_there, edged_here, object_mine);
    let object = (at.object_here != at.object_there) & drawn;
    found |= select(vec4(0u), vec4(OBJECT), object);
    mine = select(mine, object_mine, object);
    certain |= object;
#endif
    let owner_slot = select(at.slot_there, at.slot_here, mine);
    var opacity = vec4(1.0);
    var half_width = half_width_of(owner_slot, s);
#ifdef FADING
    let frame = depth_frame();
    let owner = select(at.there, at.here, mine);
    let map = vec4(
        depth_map(frame, owner.x).x, depth_map(frame, owner.y).x,
        depth_map(frame, owner.z).x, depth_map(frame, owner.w).x,
    );
    opacity -= s.opacity_fade * map;
    half_width *= 1.0 - s.width_fade * map;
#endif
    opacity *= opacity_of(owner_slot);
    let packed = found | select(vec4(0u), vec4(8u), mine) | pack_response(s, ink, has(found, OBJECT), opacity, half_width);
    return Cracks(select(vec4(0u), packed, found != vec4(0u)), certain);
}
