#define_import_path bevy_comics::lines::crack

// Decides which cracks have a line: those where a surface ends, bends or meets another
// object.

#import bevy_comics::depth::map::depth_map
#import bevy_comics::depth::view::depth_frame
#ifdef SIMPLIFIED_LINES
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::simplification::response_factor
#endif
#import bevy_comics::lines::edge::{
    CREASE, Lines, OBJECT, SILHOUETTE, THINNEST, byte, ends_at_sky, fold_response, least_crease_bend, pack_ink,
    step_response,
}
#ifdef LEDGES
#import bevy_comics::lines::ledge::may_be_ledge
#endif
#import bevy_comics::lines::rows::Borders
#import bevy_comics::objects::kinds_of
#ifdef OBJECT_STYLES
#import bevy_comics::objects::style_of
#endif
#ifdef HIGHLIGHTS
#import bevy_comics::lines::hidden::HIDDEN
#endif

// The bits of `slot_section` that are the slot of an object's style; above them is its section.
const SLOT: u32 = 255u;
const ABOVE_SLOT: u32 = 8u;

#ifdef HIGHLIGHTS
// Bits of ObjectStyle::kinds of objects of which only hidden parts have lines, or only visible ones.
const HIDDEN_ONLY: u32 = 16u;
const VISIBLE_ONLY: u32 = 32u;
#endif

// The kinds of line that four objects draw, by their slots.
fn kinds_of_four(slot_section: vec4<u32>) -> vec4<u32> {
#ifdef OBJECT_STYLES
    let slots = slot_section & vec4(SLOT);
    let kinds = vec4(kinds_of(slots.x), kinds_of(slots.y), kinds_of(slots.z), kinds_of(slots.w));
#ifdef HIGHLIGHTS
    let hidden = has(slot_section, HIDDEN);
    return select(kinds, vec4(0u), (has(kinds, HIDDEN_ONLY) & !hidden) | (has(kinds, VISIBLE_ONLY) & hidden));
#else
    return kinds;
#endif
#else
    return vec4(7u);
#endif
}

fn has(kinds: vec4<u32>, kind: u32) -> vec4<bool> {
    return (kinds & vec4(kind)) != vec4(0u);
}

// Whether the line belongs to `here`: to the object that draws this kind of line if the
// other does not, otherwise to the one that is preferred.
fn owned(here_preferred: vec4<bool>, has_here: vec4<bool>, has_there: vec4<bool>) -> vec4<bool> {
    return select(here_preferred, has_here, has_here != has_there);
}

// A step, as a fraction of what a jump is one of.
const STEP: f32 = 2e-5;
// The fold of 3 degrees.
const PARALLEL: f32 = 0.0027;

// Whether a line along which no surface hides the other belongs to `here`, if both draw it.
fn preferred(at: Borders, reference: vec4<f32>) -> vec4<bool> {
#ifdef HARD
    // One side all along: the object of the larger id; or the surface that faces a direction more; of
    // parallel ones that behind, so that a small feature in front keeps its pixels; and in one plane the
    // larger section.
    let object = at.object_here > at.object_there;
    let has_step = abs(at.in_front) > STEP * reference;
    let parallel = select(at.slot_section_here > at.slot_section_there, at.in_front < vec4(0.0), has_step);
    let surface = select(at.faces_more > vec4(0.0), parallel, at.folds < vec4(PARALLEL));
    return select(surface, object, at.object_here != at.object_there);
#else
    return at.here >= at.there;
#endif
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
    // LEDGES: whether they only join lines.
    ledge: vec4<bool>,
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

// What four cracks are, as far as it is known.
struct Found {
    // Bits of the kinds of line.
    kinds: vec4<u32>,
    // Ink of the silhouette or crease.
    ink: vec4<f32>,
    // Whether the line belongs to `here`.
    mine: vec4<bool>,
    certain: vec4<bool>,
}

#ifdef SILHOUETTES
fn add_silhouettes(before: Found, s: Lines, at: Borders, reference: vec4<f32>, kinds: vec4<u32>) -> Found {
    var found = before;
    let step = step_response(at.excess * sqrt(response_factors(at)), s.silhouette_k * reference);
    let response = select(step, vec4(1.0), ends_at_sky(at.here, at.there));
    let ink = smoothstep(vec4(s.silhouette_low), vec4(s.silhouette_high), response);
    let exists = max(at.here, at.there) > vec4(0.0);
    let silhouette = has(kinds, SILHOUETTE) & exists & (byte(ink) > vec4(0u)) & !at.outdone;
    found.kinds |= select(vec4(0u), vec4(SILHOUETTE), silhouette);
    found.ink = select(found.ink, ink, silhouette);
    found.certain |= silhouette & (response >= vec4(s.silhouette_limit));
    return found;
}
#endif

#ifdef SECTIONS
// Sections up to the first one were found, those up to the second one were asked for; above them,
// also those of meshes in groups, see sections.wgsl. The last one has no creases. Pixels must confirm
// the borders of all but those that were asked for outside of groups.
const LAST_FOUND: u32 = 63u;
const LAST_ALONE: u32 = 127u;
const LAST_FOUND_IN_GROUP: u32 = 190u;
const SILENT: u32 = 255u;
// The fold of 10 degrees, and the tangent of half of it.
const BENT: f32 = 0.0304;
const BENT_TANGENT: f32 = 0.0875;
// A change of the slope per pixel, as a fraction of what a jump is one of.
const TURN: f32 = 5e-5;

// 0 where there is no section.
fn sections_of(s: Lines, slot_section: vec4<u32>) -> vec4<u32> {
    let sections = slot_section >> vec4(ABOVE_SLOT);
    let in_group = (sections > vec4(LAST_ALONE)) & (sections <= vec4(LAST_FOUND_IN_GROUP));
    let found = (sections <= vec4(LAST_FOUND)) | in_group;
    return select(sections, vec4(0u), found & vec4(s.found_sections == 0u));
}

// Whether the surface has a step at the next crack, or over two pixels. In a multisampled view, the
// depth of a pixel may be that of another sample than its section, see resolve.wgsl. A step that
// separates two surfaces, or has a silhouette that is certain, has its line.
fn has_step_beside(s: Lines, at: Borders, reference: vec4<f32>) -> vec4<bool> {
    let beside = at.departs.beside;
    let has_step = (beside > STEP * reference) & (beside < s.jump * reference);
#ifdef SILHOUETTES
    let response = step_response(beside, s.silhouette_k * reference);
    let ink = smoothstep(vec4(s.silhouette_low), vec4(s.silhouette_high), response);
    return has_step & ((byte(ink) == vec4(0u)) | (response < vec4(s.silhouette_limit)));
#else
    return has_step;
#endif
}

// Whether two sections of an object meet. Unless one of them was asked for, the surface must also
// bend there, or have a step.
fn section_borders(s: Lines, at: Borders, reference: vec4<f32>) -> vec4<bool> {
    let here = sections_of(s, at.slot_section_here);
    let there = sections_of(s, at.slot_section_there);
    let differ = (here != there) & (here != vec4(0u)) & (there != vec4(0u));
    let asked_here = (here > vec4(LAST_FOUND)) & (here <= vec4(LAST_ALONE));
    let asked_there = (there > vec4(LAST_FOUND)) & (there <= vec4(LAST_ALONE));
#ifdef NORMALS
#ifdef BENDS
    let bends = (at.folds > vec4(BENT)) & (at.bend > vec4(BENT_TANGENT * s.bend));
#else
    let bends = at.folds > vec4(BENT);
#endif
#else
    let bends = at.departs.turn > TURN * reference;
#endif
    let steps = (at.departs.step > STEP * reference) | has_step_beside(s, at, reference);
    let ends = asked_here | asked_there | bends | steps;
    return differ & ends & (at.object_here == at.object_there);
}

fn are_silent(at: Borders) -> vec4<bool> {
    return max(at.slot_section_here, at.slot_section_there) >> vec4(ABOVE_SLOT) == vec4(SILENT);
}
#endif

#ifdef CREASES
// A crease is no silhouette, and both sides meet there: no jump in depth separates them.
fn add_creases(before: Found, s: Lines, at: Borders, reference: vec4<f32>, here: vec4<u32>, there: vec4<u32>) -> Found {
    var found = before;
    var by_normals = vec4(s.normal_creases != 0u);
#ifdef BENDS
    by_normals &= at.bend > vec4(least_crease_bend(s));
#endif
    var response = fold_response(at.folds * response_factors(at), s.crease_k);
    var ridge = at.ridge & by_normals;
    var rim = at.rim & by_normals;
    var free = found.kinds == vec4(0u);
#ifdef SECTIONS
    let border = section_borders(s, at, reference);
    response = select(response, vec4(1.0), border);
    ridge = (ridge | border) & !are_silent(at);
    rim &= !are_silent(at);
    // A border is a line where the step is too low for one.
    free |= border & !found.certain;
#endif
    let ink = smoothstep(vec4(s.crease_low), vec4(s.crease_high), response);
    let drawn_here = has(here, CREASE);
    let drawn_there = has(there, CREASE);
    let joined = at.excess < s.jump * reference;
    let drawn = (drawn_here | drawn_there) & (byte(ink) > vec4(0u)) & free;
#ifdef SECTIONS
    // A weak silhouette there is as strong as the crease that follows where the step is lower still.
    let strong = border & (found.kinds != vec4(0u)) & (drawn_here | drawn_there) & !are_silent(at);
    found.ink = select(found.ink, max(found.ink, ink), strong);
#endif
    let crease = (ridge | rim) & joined & drawn;
    found.kinds = select(found.kinds, vec4(CREASE), crease);
    found.ink = select(found.ink, ink, crease);
    // At a rim a crease only continues another.
    found.certain |= crease & ridge & (response >= vec4(s.crease_limit));
    found.mine = select(found.mine, owned(preferred(at, reference), drawn_here, drawn_there), crease);
    return found;
}
#endif

#ifdef OBJECT_EDGES
// If one object hides the other, the line belongs to the nearer one, even if that has no
// object edges: then there is none.
fn add_object_edges(before: Found, s: Lines, at: Borders, reference: vec4<f32>, here: vec4<u32>, there: vec4<u32>) -> Found {
    var found = before;
    let drawn_here = has(here, OBJECT);
    let drawn_there = has(there, OBJECT);
    let here_nearer = at.here >= at.there;
    let hides = abs(at.here - at.there) > s.jump * reference;
    let mine = select(owned(preferred(at, reference), drawn_here, drawn_there), here_nearer, hides);
    let drawn = select(drawn_there, drawn_here, mine);
    let object = (at.object_here != at.object_there) & drawn;
    found.kinds |= select(vec4(0u), vec4(OBJECT), object);
    found.mine = select(found.mine, mine, object);
    found.certain |= object;
    return found;
}
#endif

#ifdef LEDGES
// A face between two creases may be so thin that it is only seen in some of the pixels along it:
// at the others, the surfaces on its two sides border on each other with a step. Such a step is
// too low for a silhouette, and has no fold. It is a crease where it joins lines, see join.wgsl.
fn are_ledges(found: Found, s: Lines, at: Borders, here: vec4<u32>, there: vec4<u32>) -> vec4<bool> {
    let near = max(at.here, at.there);
    let joined = at.excess < s.jump * (s.reference_factor * near + s.reference_constant);
    let exists = min(at.here, at.there) > vec4(0.0);
    let drawn = (has(here, CREASE) | has(there, CREASE)) & (found.kinds == vec4(0u));
    return may_be_ledge(s, at.excess, near) & joined & exists & drawn & !at.outdone;
}
#endif

// The packed cracks, with the width and opacity of the lines of their owners.
fn packed_of(found: Found, s: Lines, at: Borders) -> vec4<u32> {
    let owner_slot = select(at.slot_section_there, at.slot_section_here, found.mine) & vec4(SLOT);
    var opacity = vec4(1.0);
    var half_width = half_width_of(owner_slot, s);
#ifdef FADING
    let frame = depth_frame();
    let owner = select(at.there, at.here, found.mine);
    let map = vec4(
        depth_map(frame, owner.x).x, depth_map(frame, owner.y).x,
        depth_map(frame, owner.z).x, depth_map(frame, owner.w).x,
    );
    opacity -= s.opacity_fade * map;
    half_width *= 1.0 - s.width_fade * map;
#endif
    opacity *= opacity_of(owner_slot);
    let owner_bit = select(vec4(0u), vec4(8u), found.mine);
    let object = has(found.kinds, OBJECT);
    let packed = found.kinds | owner_bit | pack_response(s, found.ink, object, opacity, half_width);
    return select(vec4(0u), packed, found.kinds != vec4(0u));
}

// Factors of the responses of edges before these are limited to 1, by the nearer side.
fn response_factors(at: Borders) -> vec4<f32> {
#ifdef SIMPLIFIED_LINES
    let s = line_pass.simplification;
    let near = max(at.here, at.there);
    let object = select(at.object_there, at.object_here, at.here >= at.there);
    return vec4(
        response_factor(s, near.x, object.x), response_factor(s, near.y, object.y),
        response_factor(s, near.z, object.z), response_factor(s, near.w, object.w),
    );
#else
    return vec4(1.0);
#endif
}

fn cracks(s: Lines, at: Borders) -> Cracks {
    let reference = s.reference_factor * max(at.here, at.there) + s.reference_constant;
    let here_nearer = at.here >= at.there;
    let here = kinds_of_four(at.slot_section_here);
    let there = kinds_of_four(at.slot_section_there);
    var found = Found(vec4(0u), vec4(0.0), here_nearer, vec4(false));
#ifdef SILHOUETTES
    found = add_silhouettes(found, s, at, reference, select(there, here, here_nearer));
#endif
#ifdef CREASES
    found = add_creases(found, s, at, reference, here, there);
#endif
#ifdef OBJECT_EDGES
    found = add_object_edges(found, s, at, reference, here, there);
#endif
    var ledge = vec4(false);
#ifdef LEDGES
    ledge = are_ledges(found, s, at, here, there);
    found.kinds |= select(vec4(0u), vec4(CREASE), ledge);
    found.ink = select(found.ink, vec4(1.0), ledge);
    let mine = owned(preferred(at, reference), has(here, CREASE), has(there, CREASE));
    found.mine = select(found.mine, mine, ledge);
#endif
    return Cracks(packed_of(found, s, at), found.certain, ledge);
}
