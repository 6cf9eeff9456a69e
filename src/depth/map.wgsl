#define_import_path bevy_comics::depth::map

// The depth map: from raw reversed depth d (1 at the near plane, 0 for the sky) to
// D in [0, 1], 0 at the near end of a range and 1 at its far end. Pure functions.

const ORTHOGRAPHIC: u32 = 1u;
const LOGARITHMIC: u32 = 2u;
const EMPTY: u32 = 4u;

struct DepthFrame {
    // Raw depth of the near and the far end of the range.
    near: f32,
    far: f32,
    // a = clip_from_view[2][2]: d + a is proportional to 1/z in perspective. 0 otherwise.
    offset: f32,
    // Smallest range that fills [0, 1]: as a fraction of near + a in perspective, in
    // raw depth under an orthographic projection.
    floor: f32,
    // Orthographic projections only: view depth in world units is plane_far - d * extent.
    plane_far: f32,
    extent: f32,
    // Contours see the sky at D = 1 + sky_gap.
    sky_gap: f32,
    // Any of ORTHOGRAPHIC, LOGARITHMIC, EMPTY (no geometry is visible).
    flags: u32,
}

// True for the sky (0) and for values that are no depth: subnormal (arithmetic may
// flush it to 0), above 1, negative, NaN.
fn is_background(d: f32) -> bool {
    let bits = bitcast<u32>(d);
    return bits < 0x00800000u || bits > 0x3f800000u;
}

// Whether a flag is set. The fused pass compiles the flags in as MAP_FLAGS, except
// EMPTY, because CPU adapters execute both sides of a branch on a runtime value.
fn has(f: DepthFrame, flag: u32) -> bool {
#ifdef MAP_FLAGS
    let compiled = #{MAP_FLAGS}u;
    return ((compiled | (f.flags & EMPTY)) & flag) != 0u;
#else
    return (f.flags & flag) != 0u;
#endif
}

// ln(large / small) with full relative precision where the ratio is near 1, given
// the exact difference large - small. Up to a ratio of 2 it is 2 atanh(s), s <= 1/3,
// as a series of eight terms: the ninth is below half an ulp.
fn log_ratio(large: f32, small: f32, difference: f32) -> f32 {
    let s = difference / (large + small);
    if abs(s) > 0.3333 {
        return log(large / small);
    }
    let q = s * s;
    var sum = 1.0 / 15.0;
    sum = sum * q + 1.0 / 13.0;
    sum = sum * q + 1.0 / 11.0;
    sum = sum * q + 1.0 / 9.0;
    sum = sum * q + 1.0 / 7.0;
    sum = sum * q + 1.0 / 5.0;
    sum = sum * q + 1.0 / 3.0;
    sum = sum * q + 1.0;
    return 2.0 * s * sum;
}

// ln(z(q) / z(p)), with z the view depth, for raw depths p (nearer) and q (farther).
fn log_distance(f: DepthFrame, p: f32, q: f32) -> f32 {
    if has(f, ORTHOGRAPHIC) {
        // An orthographic near plane can be at or behind the camera: distances below
        // 1e-4 of the extent count as that distance.
        let least = 1e-4 * f.extent;
        let zp = max(f.plane_far - p * f.extent, least);
        let zq = max(f.plane_far - q * f.extent, least);
        return log_ratio(zq, zp, select((p - q) * f.extent, zq - zp, min(zp, zq) == least));
    }
    return log_ratio(p + f.offset, q + f.offset, p - q);
}

// The smallest range that fills the map, in raw depth.
fn spread_floor(f: DepthFrame) -> f32 {
    if has(f, ORTHOGRAPHIC) {
        return f.floor;
    }
    return f.floor * (f.near + f.offset);
}

// The divisor for differences of raw depth: the range, or its floor if that is
// larger. Not 0 even if all geometry is at one depth and the floor is 0.
fn spread_divisor(f: DepthFrame) -> f32 {
    let divisor = max(f.near - f.far, spread_floor(f));
    return select(divisor, 1e-30, divisor == 0.0);
}

// (D, L): the depth map and its complement 1 - D. Both are computed separately: the
// square root that [CS] Eq. 7 takes of L would amplify the cancellation of 1 - D.
fn depth_map(f: DepthFrame, d: f32) -> vec2<f32> {
    if has(f, EMPTY) || is_background(d) {
        return vec2(1.0, 0.0);
    }
    let floored = !(f.near - f.far > spread_floor(f));
    var map: vec2<f32>;
    if has(f, LOGARITHMIC) && !floored {
        let whole = log_distance(f, f.near, f.far);
        if !(whole > 0.0) {
            // An orthographic range at or behind the camera.
            return vec2(0.0, 1.0);
        }
        map = vec2(log_distance(f, f.near, d), log_distance(f, d, f.far)) / whole;
    } else {
        let divisor = spread_divisor(f);
        map = vec2((f.near - d) / divisor, (d - f.far) / divisor);
        if !has(f, ORTHOGRAPHIC) {
            map *= vec2(f.far + f.offset, f.near + f.offset) / (d + f.offset);
        }
    }
    if floored {
        map.y = 1.0 - clamp(map.x, 0.0, 1.0);
    }
    return clamp(map, vec2(0.0), vec2(1.0));
}

// D(d) - D(p), computed from d - p: exactly 0 for equal depths, without cancellation
// for close ones. Both depths are first clamped to the range.
fn depth_step(f: DepthFrame, d_raw: f32, p_raw: f32) -> f32 {
    let d = clamp(d_raw, f.far, f.near);
    let p = clamp(p_raw, f.far, f.near);
    if has(f, LOGARITHMIC) && f.near - f.far > spread_floor(f) {
        let whole = log_distance(f, f.near, f.far);
        return select(0.0, log_distance(f, p, d) / whole, whole > 0.0);
    }
    var step = (p - d) / spread_divisor(f);
    if !has(f, ORTHOGRAPHIC) {
        step *= (f.near + f.offset) / (d + f.offset);
        step *= (f.far + f.offset) / (p + f.offset);
    }
    return step;
}

// Fraction of the far end in the sum of both ends by the square roots of [CS] Eq. 7 and 11,
// from D and its complement.
fn root_fraction(d: f32, l: f32) -> f32 {
    let far = sqrt(max(d, 0.0));
    return far / (far + sqrt(max(l, 0.0)));
}

// What is `near` at D = 0 and `far` at D = 1; between them by a power of D.
fn graded(near: f32, far: f32, exponent: f32, d: f32) -> f32 {
    let t = clamp(d, 0.0, 1.0);
    return mix(near, far, select(0.0, pow(max(t, 1e-30), exponent), t > 0.0));
}

// Fraction of what lies behind a border, 0 to 1.
fn behind(border: f32, softness: f32, d: f32) -> f32 {
    let t = clamp((d - border) / max(softness, 1e-6) + 0.5, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Fractions of near, middle and far at a depth of the map. Their sum is 1.
fn layer_weights(borders: vec2<f32>, softness: f32, d: f32) -> vec3<f32> {
    let far = behind(borders.y, softness, d);
    let not_near = max(behind(borders.x, softness, d), far);
    return vec3(1.0 - not_near, not_near - far, far);
}
