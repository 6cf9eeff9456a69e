#define_import_path bevy_comics::toon::stylized_highlight

// Highlights in shapes: pure functions (Anjyo and Hiramitsu 2003). Shapes are drawn in the plane of
// half vectors: a place in it is how far the normal leans from the half vector, which is the tangent
// of the angle between them. The plain highlight is a disc around the origin.

const DISC: u32 = 0u;
const SQUARE: u32 = 1u;
const WINDOW: u32 = 2u;
const CRESCENT: u32 = 3u;
const STAR: u32 = 4u;
const STREAK: u32 = 5u;
const FAITHFUL: u32 = 6u;

struct StylizedHighlight {
    // Multiples of the radius of the plain highlight.
    offset: vec2<f32>,
    scale: vec2<f32>,
    split: vec2<f32>,
    // Cosine and sine of the rotation.
    turn: vec2<f32>,
    size: f32,
    // 0: round corners, 1: square ones.
    square: f32,
    // Width of the bars of a window and of a streak, thickness of a crescent, inner radius of a
    // star.
    bar: f32,
    // Pixels.
    softness: f32,
    points: f32,
    // Exponent of the faithful equations' squaring.
    sharpness: f32,
    shape: u32,
}

// Two unit vectors that span the tangent plane.
struct Frame {
    right: vec3<f32>,
    up: vec3<f32>,
}

fn shape_of(g: StylizedHighlight) -> u32 {
#ifdef STYLIZED_HIGHLIGHT_SHAPE
    return #{STYLIZED_HIGHLIGHT_SHAPE}u;
#else
    return g.shape;
#endif
}

// The frame whose first vector is `right` in the tangent plane, or `other` where that is along
// the normal.
fn frame_along(normal: vec3<f32>, right: vec3<f32>, other: vec3<f32>) -> Frame {
    var along = right - normal * dot(normal, right);
    if dot(along, along) < 1e-4 {
        along = other - normal * dot(normal, other);
    }
    let unit = along * inverseSqrt(max(dot(along, along), 1e-12));
    return Frame(unit, cross(normal, unit));
}

// Radius of the plain highlight in the plane of half vectors: the tangent of the angle at which
// the distribution of Trowbridge and Reitz falls to `edge` of its peak. 0 if it never does.
fn stylized_highlight_radius(edge: f32, perceptual_roughness: f32) -> f32 {
    let roughness = max(perceptual_roughness * perceptual_roughness, 0.002);
    let a2 = roughness * roughness;
    let rise = inverseSqrt(edge);
    let left = 1.0 - a2 * rise;
    return select(0.0, sqrt(a2 * max(rise - 1.0, 0.0) / max(left, 1e-6)), left > 0.0);
}

fn place_of(frame: Frame, normal: vec3<f32>, half_vector: vec3<f32>) -> vec2<f32> {
    let along = max(dot(half_vector, normal), 1e-4);
    return -vec2(dot(half_vector, frame.right), dot(half_vector, frame.up)) / along;
}

// Distance of `y` from a box with half sides of 1, whose corners are `square`.
fn box_distance(square: f32, y: vec2<f32>) -> f32 {
    let corner = 0.5 * (1.0 - square);
    let beyond = abs(y) - vec2(1.0 - corner);
    return length(max(beyond, vec2(0.0))) + min(max(beyond.x, beyond.y), 0.0) - corner;
}

// From a circle to a square: a superellipse.
fn disc_distance(square: f32, y: vec2<f32>) -> f32 {
    if square <= 0.0 {
        return length(y) - 1.0;
    }
    let largest = max(max(abs(y.x), abs(y.y)), 1e-6);
    let part = abs(y) / largest;
    let power = 2.0 + 6.0 * square;
    return largest * pow(pow(part.x, power) + pow(part.y, power), 1.0 / power) - 1.0;
}

// A star with tips at a radius of 1, the first above the middle, and corners at `inner` between
// them.
fn star_distance(points: f32, inner: f32, y: vec2<f32>) -> f32 {
    let sector = 3.14159265 / points;
    let away = length(y);
    // Angle from the nearest tip.
    let angle = atan2(y.x, y.y);
    let turn = abs(angle - 2.0 * sector * round(angle / (2.0 * sector)));
    let folded = away * vec2(cos(turn), sin(turn));
    let corner = inner * vec2(cos(sector), sin(sector));
    let side = normalize(corner - vec2(1.0, 0.0));
    return dot(folded - vec2(1.0, 0.0), vec2(side.y, -side.x));
}

// Distance of `y` from the border of the shape, negative inside, in units of its radius.
fn shape_distance(g: StylizedHighlight, y: vec2<f32>) -> f32 {
    let shape = shape_of(g);
    if shape == SQUARE {
        return box_distance(g.square, y);
    }
    if shape == WINDOW {
        return max(box_distance(g.square, y), 0.5 * g.bar - min(abs(y.x), abs(y.y)));
    }
    if shape == CRESCENT {
        return max(length(y) - 1.0, 1.0 - length(y - vec2(2.0 * g.bar, 0.0)));
    }
    if shape == STAR {
        return star_distance(g.points, g.bar, y);
    }
    if shape == STREAK {
        return length(y - vec2(clamp(y.x, g.bar - 1.0, 1.0 - g.bar), 0.0)) - g.bar;
    }
    return disc_distance(g.square, y);
}

fn turned(g: StylizedHighlight, v: vec2<f32>) -> vec2<f32> {
    return vec2(g.turn.x * v.x + g.turn.y * v.y, g.turn.x * v.y - g.turn.y * v.x);
}

// Where the center of the shape is: at most 63 degrees from the plain highlight.
fn center_of(g: StylizedHighlight, radius: f32) -> vec2<f32> {
    let center = g.offset * radius;
    return center * min(1.0, 2.0 / max(length(center), 1e-6));
}

// Distance of a place in the plane of half vectors from the border of the shape, in units of its
// radius. `radius` is that of the plain highlight.
fn planar_distance(g: StylizedHighlight, radius: f32, place: vec2<f32>) -> f32 {
    let y = turned(g, place - center_of(g, radius)) / (g.scale * g.size * radius);
    return shape_distance(g, select(y, abs(y) - g.split, g.split > vec2(0.0)));
}

// The paper's form: the half vector is scaled, turned, moved, split and squared, in this order.
fn moved(g: StylizedHighlight, frame: Frame, radius: f32, half_vector: vec3<f32>) -> vec3<f32> {
    let right = g.turn.x * frame.right + g.turn.y * frame.up;
    let up = g.turn.x * frame.up - g.turn.y * frame.right;
    let shrink = vec2(1.0) - vec2(1.0) / g.scale;
    var h = half_vector;
    h = normalize(h - shrink.x * dot(h, right) * right);
    h = normalize(h - shrink.y * dot(h, up) * up);
    let center = center_of(g, radius);
    h = normalize(h + center.x * frame.right + center.y * frame.up);
    let apart = g.split * radius * sign(vec2(dot(h, right), dot(h, up)));
    h = normalize(h - apart.x * right - apart.y * up);
    let tangential = vec2(dot(h, right), dot(h, up));
    let cosine = max(abs(tangential.x), abs(tangential.y));
    let sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    let corner = pow(max(2.0 * sine * cosine, 1e-6), g.sharpness);
    let pull = g.square * corner;
    return normalize(h - pull * (tangential.x * right + tangential.y * up));
}

fn faithful_distance(g: StylizedHighlight, frame: Frame, radius: f32, normal: vec3<f32>, half_vector: vec3<f32>) -> f32 {
    let h = moved(g, frame, radius, half_vector);
    return length(place_of(frame, normal, h)) / (g.size * radius) - 1.0;
}

// Distance of a surface from the border of the shape.
fn stylized_highlight_distance(g: StylizedHighlight, frame: Frame, radius: f32, normal: vec3<f32>, half_vector: vec3<f32>) -> f32 {
    if shape_of(g) == FAITHFUL {
        return faithful_distance(g, frame, radius, normal, half_vector);
    }
    return planar_distance(g, radius, place_of(frame, normal, half_vector));
}

// How much of a pixel the shape covers, from the distance at the pixel and at two neighbors. A
// shape that is smaller than a pixel fades.
fn stylized_highlight_coverage(g: StylizedHighlight, here: f32, beside: f32, below: f32) -> f32 {
    let pixel = max(length(vec2(beside - here, below - here)), 1e-5);
    let small = min(2.0 / pixel, 1.0);
    return clamp(0.5 - here / (pixel * max(g.softness, 1e-2)), 0.0, 1.0) * small * small;
}
