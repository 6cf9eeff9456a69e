#define_import_path bevy_comics::lines::fold

// Where the two sides of a crease meet. Pure functions.
//
// Raw depth is affine over a plane on the screen. So two depths on each side of a crease are
// two straight lines, and the crease is where these meet, between pixels.

// Raw depths around a crack: of the four pixels in a row across it, the two in the middle
// beside it; and of the pixels before and after the outer two, along the crack.
struct Fold {
    across: vec4<f32>,
    first_before: f32,
    first_after: f32,
    last_before: f32,
    last_after: f32,
}

// Differences of slopes below this fraction of the depth are rounding: 32 ulps.
const LEAST_FOLD: f32 = 3.8e-6;
// How far from the crack the planes may meet, in pixels.
const FARTHEST_FOLD: f32 = 0.6;
// How much offset and slope may differ from those of the run of cracks. On curved surfaces,
// the depths of few pixels may say anything.
const UNLIKE: f32 = 0.35;

// How the line along a crease leaves its crack: x offset, y slope, see line_bend in
// bend.wgsl. `otherwise` where the two sides do not say. `jump`: the difference of depths
// that separates two surfaces.
fn fold_bend(f: Fold, jump: f32, otherwise: vec2<f32>) -> vec2<f32> {
    let d = f.across;
    let across = max(abs(d.y - d.x), abs(d.w - d.z));
    let along = max(abs(f.first_after - f.first_before), abs(f.last_after - f.last_before));
    let whole = max(across, 0.5 * along) < jump;
    let slope_here = d.y - d.x;
    let slope_there = d.w - d.z;
    let bend = slope_here - slope_there;
    let along_here = 0.5 * (f.first_after - f.first_before);
    let along_there = 0.5 * (f.last_after - f.last_before);
    let offset = (d.z - d.y - slope_there) / bend - 0.5;
    let slope = (along_there - along_here) / bend;
    let bends = abs(bend) > LEAST_FOLD * max(d.y, d.z);
    let near = abs(offset) <= FARTHEST_FOLD && distance(vec2(offset, slope), otherwise) <= UNLIKE;
    return select(otherwise, clamp(vec2(offset, slope), vec2(-0.49, -1.0), vec2(0.49, 1.0)), bends && near && whole);
}
