// The first half of the search for lines wider than the neighboring pixels: for every
// pixel, the crack in its column whose line covers it most, and of the others the one
// whose line reaches farthest over it. The second half, in draw.wgsl, compares the results
// of the columns nearby. Together they load 2 r pixels around a pixel instead of r^2.
//
// x, y: the packed crack, and the middle of its line, see pack_middle; z, w: those of the
// other. 0 stands for none.

#import bevy_comics::lines::edge::{
    crack_opacity, is_apart, line_coverage, owner_step, pack_middle, unpack_width,
}
#import bevy_comics::lines::pass::line_pass
#ifdef BLOCKS
#import bevy_comics::lines::read_planes::inked_rows
#endif
#import bevy_comics::lines::stored::{load_bends, load_cracks, stored_middle}

// The best crack in the column so far, and the one whose line reaches farthest among those
// with another middle.
struct Best {
    packed: vec2<u32>,
    // Middles of the lines, in pixels from the center of the pixel.
    first: vec2<f32>,
    second: vec2<f32>,
    // From the pixel to those that own them: across x and y, down z and w; and whether they are
    // to the south of their pixels.
    owners: vec4<i32>,
    south: vec2<bool>,
    // The score of the first, and how far its line and that of the second reach over the
    // pixel's row, squared.
    score: f32,
    reach: vec2<f32>,
}

// Compares a crack with the best two.
fn compare(best: ptr<function, Best>, packed: u32, middle: vec2<f32>, row: i32, south: bool) {
    let half_width = unpack_width(packed >> 20u);
    // In pixels of the viewport, as widths are.
    let away = abs(middle.y) / line_pass.grid.from_viewport.y;
    let value = line_coverage(away, half_width) * crack_opacity(line_pass.settings, packed);
    // Of equal ink, the line is taken whose border is farther out.
    let exists = (packed & 7u) != 0u;
    let score = select(-1e6, value + 1e-4 * (half_width - away), exists);
    // Squared: how far the line reaches over the pixel's row.
    let reach = select(-1e6, (half_width + 0.5) * (half_width + 0.5) - away * away, exists);
    // Of equal cracks the first is taken: differences by rounding do not count.
    let better = score > (*best).score + 1e-6;
    // Both cracks at a corner of a line of odd width have their middle in one pixel.
    let other = is_apart(middle, (*best).first);
    let pushed = better && other && (*best).reach.x > (*best).reach.y + 1e-3;
    let next = !better && other && reach > (*best).reach.y + 1e-3;
    (*best).packed.y = select(select((*best).packed.y, packed, next), (*best).packed.x, pushed);
    (*best).second = select(select((*best).second, middle, next), (*best).first, pushed);
    (*best).reach.y = select(select((*best).reach.y, reach, next), (*best).reach.x, pushed);
    let owner = vec2(0, row) + owner_step(packed, south);
    let first = (*best).owners.xz;
    let second = select(select((*best).owners.yw, owner, next), first, pushed);
    let kept = select(first, owner, better);
    (*best).owners = vec4(kept.x, second.x, kept.y, second.y);
    (*best).south.y = select(select((*best).south.y, south, next), (*best).south.x, pushed);
    (*best).south.x = select((*best).south.x, south, better);
    (*best).packed.x = select((*best).packed.x, packed, better);
    (*best).first = select((*best).first, middle, better);
    (*best).reach.x = select((*best).reach.x, reach, better);
    (*best).score = select((*best).score, score, better);
}

// Compares both cracks of the pixel in row `y` of the column of `p`.
fn compare_row(best: ptr<function, Best>, p: vec2<i32>, y: i32) {
    let packed = load_cracks(line_pass.grid, vec2(p.x, y));
    let bends = load_bends(line_pass.grid, vec2(p.x, y));
    let row = y - p.y;
    let down = vec2(0.0, f32(row));
    compare(best, packed.x, down + stored_middle(packed.x, vec2(1.0, 0.0), bends), row, false);
    compare(best, packed.y, down + stored_middle(packed.y, vec2(0.0, 1.0), bends >> 16u), row, true);
}

@fragment
fn columns(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let g = line_pass.grid;
    let p = vec2<i32>(position.xy);
    var best = Best(vec2(0u), vec2(1e6), vec2(1e6), vec4(0), vec2(false), -1e6, vec2(-1e6));
    let first = max(p.y - g.reach - 1, 0);
    let last = min(p.y + g.reach, g.rect.w - 1);
#ifdef BLOCKS
    for (var top = first; top <= last; top += 32) {
        let inked = inked_rows(g, p.x, top, min(top + 31, last));
        var rows = inked.x | inked.y;
        while rows != 0u {
            compare_row(&best, p, top + i32(firstTrailingBit(rows)));
            rows &= rows - 1u;
        }
    }
#else
    for (var y = first; y <= last; y++) {
        compare_row(&best, p, y);
    }
#endif
    return vec4(
        best.packed.x, pack_middle(best.first, best.owners.xz, best.south.x),
        best.packed.y, pack_middle(best.second, best.owners.yw, best.south.y),
    );
}
