#define_import_path bevy_comics::depth::borders

// Divides the visible depths into near, middle and far, so that the three differ as much as
// possible: the two borders explain most of the variance of the logarithm of distance (Otsu
// 1979). One workgroup per view and frame; its state stays on the GPU.

#import bevy_comics::depth::histogram::{BINS, FIRST_OCTAVE_BIN, Histogram, depth_window, window_edge}
#import bevy_comics::depth::level::{HOLD, ORTHOGRAPHIC, RESET, SNAP, Smoothing, bits_of, level_of}

// Borders that explain this many times the variance take the place of those that are there.
const GAIN: f32 = 1.05;

// A border this close to its goal, in octaves of distance or as a fraction of the visible
// range, is set to the goal.
const SETTLED: f32 = 0.00025;

// x: border between near and middle; y: between middle and far.
struct BorderState {
    // Bits of the raw depths that the borders approach; 0 before any were found.
    goals: vec2<u32>,
    // What the drawn levels are beyond those of the goals.
    rests: vec2<f32>,
}

@group(0) @binding(0) var<uniform> smoothing: Smoothing;
@group(0) @binding(1) var<storage, read> histogram: Histogram;
@group(0) @binding(2) var<storage, read_write> state: BorderState;
// xy: keys of the visible range; zw: bits of the raw depths of the borders.
@group(0) @binding(3) var<storage, read_write> drawn: vec4<u32>;

// Places of the middles of the bins, and sums over all bins before each: the count, and the
// places from their mean.
var<workgroup> places: array<f32, 256>;
var<workgroup> counts: array<u32, 257>;
var<workgroup> moments: array<f32, 257>;
// The most that borders explain of which this is the farther, and the nearer one.
var<workgroup> best: array<vec2<f32>, 256>;

fn is_orthographic() -> bool {
    return (smoothing.flags & ORTHOGRAPHIC) != 0u;
}

// Where depths are compared, from far to near: at the logarithm of their reciprocal distance, or
// in an orthographic view as fractions of the window.
fn place_of(bits: u32) -> f32 {
    if is_orthographic() {
        let w = depth_window(vec2(histogram.window_near, histogram.window_far));
        return 0.5 * (bitcast<f32>(bits) - w.far) * w.factor;
    }
    return level_of(smoothing, bits);
}

// The bits of the depth at a place.
fn bits_at(place: f32) -> u32 {
    if is_orthographic() {
        let w = depth_window(vec2(histogram.window_near, histogram.window_far));
        return bits_of(smoothing, w.far + place * (w.near - w.far));
    }
    return bits_of(smoothing, place);
}

// The place of the edge between bin - 1 and bin, for bins 0 to 256.
fn edge_place(bin: u32) -> f32 {
    if is_orthographic() {
        let w = depth_window(vec2(histogram.window_near, histogram.window_far));
        return place_of(bitcast<u32>(window_edge(w, bin)));
    }
    return place_of((bin + FIRST_OCTAVE_BIN) << 20u);
}

// Sums over all bins before this one, and in the last invocation over all.
fn sum_up(bin: u32) {
    var total = 0.0;
    var mean = 0.0;
    for (var k = 0u; k < BINS; k++) {
        total += f32(histogram.bins[k]);
        mean += f32(histogram.bins[k]) * places[k];
    }
    mean /= max(total, 1.0);
    var count = 0u;
    var moment = 0.0;
    for (var k = 0u; k < bin; k++) {
        count += histogram.bins[k];
        moment += f32(histogram.bins[k]) * (places[k] - mean);
    }
    counts[bin] = count;
    moments[bin] = moment;
    if bin == BINS - 1u {
        counts[BINS] = count + histogram.bins[bin];
        moments[BINS] = moment + f32(histogram.bins[bin]) * (places[bin] - mean);
    }
}

// What a class of the bins from `first` to before `end` adds to the variance between classes,
// times the count of all depths.
fn explained(first: u32, end: u32) -> f32 {
    let count = counts[end] - counts[first];
    let moment = moments[end] - moments[first];
    return select(moment * moment / f32(max(count, 1u)), 0.0, count == 0u);
}

// The same for far bins, before `middle`, those in the middle, and near ones, from `near` on.
fn all_explained(middle: u32, near: u32) -> f32 {
    return explained(0u, middle) + explained(middle, near) + explained(near, BINS);
}

// The most that is explained if the middle begins at this bin, and where near begins then.
fn best_from(middle: u32) -> vec2<f32> {
    var found = vec2(0.0);
    if middle == 0u {
        return found;
    }
    let far = explained(0u, middle);
    for (var near = middle + 1u; near < BINS; near++) {
        let whole = far + explained(middle, near) + explained(near, BINS);
        if whole > found.x {
            found = vec2(whole, f32(near));
        }
    }
    return found;
}

// Bits of the depth in the middle of the empty bins around the lower edge of a bin: between the
// farthest depth of one class and the nearest of the next.
fn gap_bits(bin: u32) -> u32 {
    var first = bin;
    while first > 0u && counts[first] == counts[first - 1u] {
        first -= 1u;
    }
    var last = bin;
    while last < BINS && counts[last + 1u] == counts[last] {
        last += 1u;
    }
    return bits_at(0.5 * (edge_place(first) + edge_place(last)));
}

// Number of bins whose middle is farther than a depth.
fn bins_before(bits: u32) -> u32 {
    let place = place_of(bits);
    var count = 0u;
    while count < BINS && places[count] < place {
        count += 1u;
    }
    return count;
}

// Makes other borders the goals, if they explain clearly more. Returns whether there are goals.
fn aim() -> bool {
    if (smoothing.flags & RESET) != 0u || (smoothing.flags & (SNAP | HOLD)) == SNAP {
        state.goals = vec2(0u);
    }
    let known = state.goals.x != 0u;
    if known && (smoothing.flags & HOLD) != 0u {
        return true;
    }
    var chosen = vec3(0.0);
    for (var middle = 1u; middle < BINS; middle++) {
        if best[middle].x > chosen.x {
            chosen = vec3(best[middle], f32(middle));
        }
    }
    if chosen.x == 0.0 {
        // All depths are in one bin, or there are none.
        return known;
    }
    if !known {
        state.rests = vec2(0.0);
    } else if chosen.x <= GAIN * all_explained(bins_before(state.goals.y), bins_before(state.goals.x)) {
        return true;
    }
    let goals = vec2(gap_bits(u32(chosen.y)), gap_bits(u32(chosen.z)));
    if known {
        state.rests.x += level_of(smoothing, state.goals.x) - level_of(smoothing, goals.x);
        state.rests.y += level_of(smoothing, state.goals.y) - level_of(smoothing, goals.y);
    }
    state.goals = goals;
    return true;
}

// Bits of the depth at which a border is drawn.
fn drawn_bits(goal: u32, rest: f32) -> u32 {
    if rest == 0.0 {
        return goal;
    }
    return bits_of(smoothing, level_of(smoothing, goal) + rest);
}

// Advances the state by a frame.
fn settle() {
    if !aim() {
        return;
    }
    var settled = SETTLED;
    if is_orthographic() {
        settled *= bitcast<f32>(histogram.window_near) - bitcast<f32>(histogram.window_far);
    }
    var rests = (1.0 - smoothing.shrink) * state.rests;
    rests = select(rests, vec2(0.0), abs(rests) <= vec2(settled));
    state.rests = rests;
    drawn.z = drawn_bits(state.goals.x, rests.x);
    drawn.w = drawn_bits(state.goals.y, rests.y);
}

@compute @workgroup_size(256)
fn divide(@builtin(local_invocation_index) bin: u32) {
    places[bin] = 0.5 * (edge_place(bin) + edge_place(bin + 1u));
    workgroupBarrier();
    sum_up(bin);
    workgroupBarrier();
    best[bin] = best_from(bin);
    workgroupBarrier();
    if bin == 0u {
        settle();
    }
}
