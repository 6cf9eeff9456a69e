#define_import_path bevy_comics::lines::rim

// Where the rim of a surface is a single silhouette.

#import bevy_comics::depth::view::texel_depth
#import bevy_comics::lines::chain::{first_corner, last_corner, next_crack, other_corner}
#import bevy_comics::lines::edge::{CREASE, Grid, SILHOUETTE}
#ifdef CLOSED_GAPS
#import bevy_comics::lines::gaps::source_of
#endif
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{SILHOUETTE_EAST, SILHOUETTE_SOUTH}
#import bevy_comics::lines::read_planes::column_bit

// Cracks within which silhouettes follow on both sides of one at the rim of a surface.
const RIM: i32 = 16;

// Whether a line goes on to a silhouette behind a corner of a crack.
fn leads_to_silhouette(g: Grid, crack: vec3<i32>, corner: vec2<i32>) -> bool {
    var at = corner;
    var next = crack;
    for (var i = 0; i < RIM; i++) {
        next = next_crack(g, next, at);
        if next.z < 0 {
            return false;
        }
        let plane = select(SILHOUETTE_EAST, SILHOUETTE_SOUTH, next.z == 1);
        if column_bit(g, plane, next.x, next.y) != 0u {
            return true;
        }
        at = other_corner(next, at);
    }
    return false;
}

// A packed crack, as a silhouette if it is part of one. Where a surface is seen so obliquely that
// its depth changes by more from pixel to pixel than at its rim, the last step may be the slope's
// or the rim's, depending on where between the pixels the rim is. So the line there would be a
// silhouette, a crease, a silhouette, ... It is one silhouette: where others follow on both sides,
// and the step is as large as that of a silhouette.
fn with_rim(crack: vec3<i32>, packed: u32) -> u32 {
    if packed == 0u || (packed & SILHOUETTE) != 0u {
        return packed;
    }
    let g = line_pass.grid;
    let s = line_pass.settings;
    var source = crack;
#ifdef CLOSED_GAPS
    source = source_of(g, crack);
#endif
    let here = g.rect.xy + source.xy;
    let d_here = texel_depth(here, 0);
    let d_there = texel_depth(here + select(vec2(1, 0), vec2(0, 1), crack.z == 1), 0);
    let reference = s.reference_factor * max(d_here, d_there) + s.reference_constant;
    if abs(d_here - d_there) <= s.jump * reference {
        return packed;
    }
    let back = leads_to_silhouette(g, crack, first_corner(crack));
    let rim = back && leads_to_silhouette(g, crack, last_corner(crack));
    return select(packed, (packed & ~CREASE) | SILHOUETTE, rim);
}
