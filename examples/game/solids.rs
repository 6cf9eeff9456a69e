//! What the plane cannot fly through: the triangles of houses and trees, in a grid of cells.

use std::{collections::HashMap, fmt, sync::Arc};

use bevy::{
    math::{IVec3, Vec3},
    mesh::{Mesh, VertexAttributeValues},
    transform::components::Transform,
};

type Triangle = [Vec3; 3];

/// Meshes that are larger than this, in world units, are ground: its height is known to the course.
const LARGEST: f32 = 250.0;

/// The solid surfaces of a level. Copies share their triangles.
#[derive(Clone, Default)]
pub struct Solids(Arc<Grid>);

#[derive(Default)]
struct Grid {
    /// Width of a cell, world units.
    cell: f32,
    triangles: Vec<Triangle>,
    /// Indices of the triangles whose bounding boxes touch a cell.
    cells: HashMap<IVec3, Vec<u32>>,
}

impl fmt::Debug for Solids {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} triangles", self.0.triangles.len())
    }
}

impl Solids {
    /// Sorts triangles into cells of this width.
    pub fn new(triangles: Vec<Triangle>, cell: f32) -> Self {
        let mut cells = HashMap::<IVec3, Vec<u32>>::new();
        for (index, [a, b, c]) in (0..).zip(&triangles) {
            let (low, high) = (a.min(*b).min(*c), a.max(*b).max(*c));
            for at in cells_between(low, high, cell) {
                cells.entry(at).or_default().push(index);
            }
        }
        Self(Arc::new(Grid {
            cell,
            triangles,
            cells,
        }))
    }

    /// The shortest way out of the nearest surface for a ball that touches it.
    pub fn way_out(&self, center: Vec3, radius: f32) -> Option<Vec3> {
        let grid = &*self.0;
        if grid.triangles.is_empty() {
            return None;
        }
        let reach = Vec3::splat(radius);
        let nearest = cells_between(center - reach, center + reach, grid.cell)
            .filter_map(|at| grid.cells.get(&at))
            .flatten()
            .map(|index| {
                let triangle = &grid.triangles[*index as usize];
                (closest_point(center, triangle), triangle)
            })
            .min_by(|(a, _), (b, _)| {
                let distance = |p: &Vec3| p.distance_squared(center);
                distance(a).total_cmp(&distance(b))
            });
        let (point, [a, b, c]) = nearest?;
        let away = center - point;
        let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
        (away.length() < radius)
            .then(|| away.normalize_or(normal) * (radius - away.length()).max(1e-4))
    }
}

/// The cells that a box touches.
fn cells_between(low: Vec3, high: Vec3, cell: f32) -> impl Iterator<Item = IVec3> {
    let (low, high) = ((low / cell).floor(), (high / cell).floor());
    let (low, high) = (low.as_ivec3(), high.as_ivec3());
    let square = move |x| (low.y..=high.y).map(move |y| (x, y));
    let column = move |(x, y)| (low.z..=high.z).map(move |z| IVec3::new(x, y, z));
    (low.x..=high.x).flat_map(square).flat_map(column)
}

/// The point of a triangle that is nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
fn closest_point(p: Vec3, [a, b, c]: &Triangle) -> Vec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3).max(1e-12));
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6).max(1e-12));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)).max(1e-12));
    }
    let total = (va + vb + vc).max(1e-12);
    a + ab * (vb / total) + ac * (vc / total)
}

/// Whether a mesh is so large that it is ground.
pub fn is_ground(mesh: &Mesh) -> bool {
    let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
    let Some(VertexAttributeValues::Float32x3(positions)) = positions else {
        return false;
    };
    let points = || positions.iter().map(|p| Vec3::from(*p));
    let low = points().fold(Vec3::INFINITY, Vec3::min);
    let high = points().fold(Vec3::NEG_INFINITY, Vec3::max);
    (high - low).max_element() > LARGEST
}

/// The triangles of a mesh where it stands; none for the ground.
pub fn triangles(mesh: &Mesh, at: &Transform) -> Vec<Triangle> {
    if is_ground(mesh) {
        return Vec::new();
    }
    let matrix = at.to_matrix();
    let place = |corner: Vec3| matrix.transform_point3(corner);
    let triangles = mesh.triangles().into_iter().flatten();
    triangles
        .map(|triangle| triangle.vertices.map(place))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall at z = 0, 8 wide and 6 high.
    fn wall() -> Vec<Triangle> {
        let [a, b, c, d] =
            [(-4.0, 0.0), (4.0, 0.0), (4.0, 6.0), (-4.0, 6.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
        vec![[a, b, c], [a, c, d]]
    }

    #[test]
    fn a_ball_leaves_a_wall_on_its_own_side() {
        let solids = Solids::new(wall(), 1.5);
        for side in [-1.0, 1.0] {
            let center = Vec3::new(1.0, 2.0, 0.3 * side);
            let way = solids.way_out(center, 0.5).expect("it touches the wall");
            assert!((way - Vec3::Z * 0.2 * side).length() < 1e-4, "{way}");
            assert!(solids.way_out(center + way * 1.01, 0.5).is_none());
        }
    }

    #[test]
    fn beside_and_above_the_wall_is_nothing() {
        let solids = Solids::new(wall(), 1.5);
        for free in [
            Vec3::new(0.0, 6.6, 0.0),
            Vec3::new(4.6, 3.0, 0.0),
            Vec3::new(0.0, 3.0, 0.6),
        ] {
            assert!(solids.way_out(free, 0.5).is_none(), "{free}");
        }
        assert!(Solids::default().way_out(Vec3::ZERO, 1.0).is_none());
    }

    #[test]
    fn the_closest_point_is_the_closest_of_many() {
        let triangle = [
            Vec3::ZERO,
            Vec3::new(3.0, 0.5, 0.0),
            Vec3::new(1.0, 2.0, 1.0),
        ];
        let [a, b, c] = triangle;
        for i in 0..200 {
            let angle = |k: f32| (i as f32 * k).sin() * 3.0;
            let p = Vec3::new(angle(0.7), angle(1.3), angle(2.1));
            let found = closest_point(p, &triangle).distance(p);
            let sampled = (0..=60)
                .flat_map(|u| (0..=60 - u).map(move |v| (u as f32 / 60.0, v as f32 / 60.0)))
                .map(|(u, v)| (a + (b - a) * u + (c - a) * v).distance(p))
                .fold(f32::INFINITY, f32::min);
            assert!(found <= sampled + 1e-4 && sampled < found + 0.06, "{p}");
        }
    }
}
