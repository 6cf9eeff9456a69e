//! Surfaces of a character: clay, whose parts flow into each other; strips of hair and cloth; and
//! what is painted onto a surface.

use std::f32::consts::TAU;

use bevy::prelude::*;

use crate::scenes::shape::Shape;

/// Colors are left to the materials.
const PLAIN: [f32; 4] = [1.0; 4];

/// Distance to an ellipsoid; exact on its surface only.
pub fn ellipsoid(p: Vec3, center: Vec3, radii: Vec3) -> f32 {
    let q = p - center;
    let outward = (q / (radii * radii)).length();
    if outward < 1e-6 {
        return -radii.min_element();
    }
    let scaled = (q / radii).length();
    scaled * (scaled - 1.0) / outward
}

/// Distance to a round bone between two points; `radii` at both.
pub fn bone(p: Vec3, ends: (Vec3, Vec3), radii: (f32, f32)) -> f32 {
    let along = ends.1 - ends.0;
    let t = ((p - ends.0).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (p - ends.0 - along * t).length() - (radii.0 + (radii.1 - radii.0) * t)
}

/// The union of two distances. Within `blend` of each other they flow together.
pub fn join(a: f32, b: f32, blend: f32) -> f32 {
    let near = (blend - (a - b).abs()).max(0.0) / blend;
    a.min(b) - near * near * blend / 4.0
}

/// Direction in which a distance grows.
pub fn outward(distance: &impl Fn(Vec3) -> f32, p: Vec3) -> Vec3 {
    const STEP: f32 = 2e-3;
    let change = |axis: Vec3| distance(p + axis * STEP) - distance(p - axis * STEP);
    Vec3::new(change(Vec3::X), change(Vec3::Y), change(Vec3::Z)).normalize_or(Vec3::Y)
}

/// The nodes of a grid of cubes, and the distance at each.
struct Grid<'a, D> {
    low: Vec3,
    cell: f32,
    /// Nodes along each axis.
    nodes: UVec3,
    values: Vec<f32>,
    distance: &'a D,
}

impl<'a, D: Fn(Vec3) -> f32> Grid<'a, D> {
    fn new(low: Vec3, high: Vec3, cell: f32, distance: &'a D) -> Self {
        let nodes = ((high - low) / cell).ceil().as_uvec3() + 2;
        let mut grid = Self {
            low,
            cell,
            nodes,
            values: Vec::with_capacity(nodes.element_product() as usize),
            distance,
        };
        for z in 0..nodes.z {
            for y in 0..nodes.y {
                for x in 0..nodes.x {
                    let at = grid.place(UVec3::new(x, y, z));
                    grid.values.push(distance(at));
                }
            }
        }
        grid
    }

    fn place(&self, node: UVec3) -> Vec3 {
        self.low + node.as_vec3() * self.cell
    }

    fn index(&self, node: UVec3) -> usize {
        ((node.z * self.nodes.y + node.y) * self.nodes.x + node.x) as usize
    }

    fn inside(&self, node: UVec3) -> bool {
        self.values[self.index(node)] < 0.0
    }

    /// The point of the surface in a cube, if it has one.
    fn point(&self, cube: UVec3) -> Option<Vec3> {
        let corner = |k: u32| cube + UVec3::new(k & 1, (k >> 1) & 1, k >> 2);
        let (mut sum, mut count) = (Vec3::ZERO, 0.0);
        for k in 0..8u32 {
            for axis in 0..3 {
                let other = k | (1 << axis);
                if other == k || self.inside(corner(k)) == self.inside(corner(other)) {
                    continue;
                }
                let [a, b] = [k, other].map(|k| self.values[self.index(corner(k))]);
                let [from, to] = [k, other].map(|k| self.place(corner(k)));
                sum += from.lerp(to, a / (a - b));
                count += 1.0;
            }
        }
        (count > 0.0).then(|| {
            let mut point = sum / count;
            for _ in 0..3 {
                let off = (self.distance)(point).clamp(-self.cell, self.cell);
                point -= outward(self.distance, point) * off;
            }
            point
        })
    }
}

/// The smooth surface where a distance is 0, between two corners of a box around it, in facets of
/// about the size of a cell (surface nets).
pub fn surface(low: Vec3, high: Vec3, cell: f32, distance: impl Fn(Vec3) -> f32) -> Shape {
    let grid = Grid::new(low, high, cell, &distance);
    let mut shape = Shape::default();
    let mut found = vec![u32::MAX; grid.values.len()];
    for z in 0..grid.nodes.z - 1 {
        for y in 0..grid.nodes.y - 1 {
            for x in 0..grid.nodes.x - 1 {
                let cube = UVec3::new(x, y, z);
                if let Some(point) = grid.point(cube) {
                    let normal = outward(&distance, point);
                    found[grid.index(cube)] = shape.vertex(point, normal, PLAIN);
                }
            }
        }
    }
    // The four cubes around an edge of the grid that crosses the surface.
    for z in 1..grid.nodes.z - 1 {
        for y in 1..grid.nodes.y - 1 {
            for x in 1..grid.nodes.x - 1 {
                let node = UVec3::new(x, y, z);
                for [along, u, v] in [
                    [UVec3::X, UVec3::Y, UVec3::Z],
                    [UVec3::Y, UVec3::Z, UVec3::X],
                    [UVec3::Z, UVec3::X, UVec3::Y],
                ] {
                    let inside = grid.inside(node);
                    if inside == grid.inside(node + along) {
                        continue;
                    }
                    let quad = [node - u - v, node - v, node, node - u];
                    let [a, b, c, d] = quad.map(|cube| found[grid.index(cube)]);
                    if inside {
                        shape.indices.extend([a, b, c, a, c, d]);
                    } else {
                        shape.indices.extend([a, c, b, a, d, c]);
                    }
                }
            }
        }
    }
    shape
}

/// Adds a closed strip: `at` is a point for the place along it (0 to 1) and the angle around it.
pub fn strip(shape: &mut Shape, rows: u32, columns: u32, at: impl Fn(f32, f32) -> Vec3) {
    let mut points = Vec::new();
    for row in 0..=rows {
        for column in 0..columns {
            let angle = TAU * column as f32 / columns as f32;
            points.push(at(row as f32 / rows as f32, angle));
        }
    }
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let node = |down: u32, right: u32| (row + down) * columns + (column + right) % columns;
            let [a, b, c, d] = [node(0, 0), node(0, 1), node(1, 1), node(1, 0)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    shape.smooth(&points, &triangles, PLAIN);
}

/// A strip along a path. Its section is an ellipse; `out` is the short axis, `size` is half of the
/// width and of the thickness for every place along it.
pub fn lock(
    shape: &mut Shape,
    path: impl Fn(f32) -> Vec3,
    out: impl Fn(Vec3) -> Vec3,
    size: impl Fn(f32) -> Vec2,
) {
    strip(shape, 28, 14, |t, angle| {
        let along = (path(t + 0.01) - path(t - 0.01)).normalize_or(Vec3::NEG_Y);
        let center = path(t);
        let out = out(center)
            .reject_from_normalized(along)
            .normalize_or(Vec3::Z);
        let side = out.cross(along);
        let (sin, cos) = angle.sin_cos();
        let size = size(t);
        center + side * (size.x * cos) + out * (size.y * sin)
    });
}

/// A cubic Bézier curve.
pub fn curve(points: [Vec3; 4]) -> impl Fn(f32) -> Vec3 {
    move |t| {
        let [a, b, c, d] = points;
        let s = 1.0 - t;
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    }
}

/// Adds a sheet that lies on a surface, with the normals of the surface. `at`: place and normal for
/// two numbers from 0 to 1.
pub fn sheet(shape: &mut Shape, rows: u32, columns: u32, at: impl Fn(f32, f32) -> (Vec3, Vec3)) {
    let first = shape.positions.len() as u32;
    for row in 0..=rows {
        for column in 0..=columns {
            let (place, normal) = at(row as f32 / rows as f32, column as f32 / columns as f32);
            shape.vertex(place, normal, PLAIN);
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let node =
                |down: u32, right: u32| first + (row + down) * (columns + 1) + column + right;
            let [a, b, c, d] = [node(0, 0), node(0, 1), node(1, 1), node(1, 0)];
            for [a, b, c] in [[a, b, c], [a, c, d]] {
                let [p, q, r] = [a, b, c].map(|k| Vec3::from(shape.positions[k as usize]));
                let normal = Vec3::from(shape.normals[a as usize]);
                if (q - p).cross(r - p).dot(normal) >= 0.0 {
                    shape.indices.extend([a, b, c]);
                } else {
                    shape.indices.extend([a, c, b]);
                }
            }
        }
    }
}
