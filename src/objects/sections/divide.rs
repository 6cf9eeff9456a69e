//! Divides a mesh into sections: parts that bend nowhere as sharply as a given angle.

use bevy::{
    mesh::{MeshAccessError, PrimitiveTopology, VertexAttributeValues},
    platform::collections::{HashMap, HashSet},
    prelude::*,
};

use super::{ATTRIBUTE_MESH_SECTION, Origin};

/// A section whose borders and bends have no creases.
pub(super) const SILENT: u8 = 255;
/// Numbers of sections, from 1 on. Neighbors have different numbers.
pub(super) const NUMBERS: u8 = 127;
/// Numbers of sections that were [found](Origin::Found), from 1 on: pixels must confirm their
/// borders. Those that were asked for have the others.
const FOUND: u8 = 63;
/// Normals at an edge that differ by less are smooth, in degrees.
const SMOOTH: f32 = 15.0;
/// Most triangles of a mesh in which sections are found.
const MOST_TRIANGLES: usize = 1_000_000;
/// Most sections that cover half of a mesh's area. More are grass, leaves, or rubble.
const MOST: usize = 1000;
/// Most sections whose boxes are compared, and most pairs of them that touch.
const MOST_BOXES: usize = 4000;
const MOST_PAIRS: usize = 200_000;
/// Vertices that are nearer to each other than this fraction of the mesh's diagonal are one.
const WELD: f32 = 1e-5;

/// What dividing reads of a mesh.
pub(super) struct Surface {
    positions: Vec<Vec3>,
    normals: Option<Vec<Vec3>>,
    triangles: Vec<[u32; 3]>,
    /// The author's sections, by vertex.
    own: Option<Vec<u32>>,
}

/// How many indices a mesh has, or vertices without indices; 0 if they cannot be read.
pub(super) fn indices_of(mesh: &Mesh) -> usize {
    match mesh.try_indices_option() {
        Ok(Some(indices)) => indices.len(),
        Ok(None) => mesh.count_vertices(),
        Err(_) => 0,
    }
}

impl Surface {
    /// `None` for a mesh without triangles, and for one that has too many of them to be divided
    /// unless it was asked for.
    pub fn new(mesh: &Mesh, origin: Origin) -> Result<Option<Self>, MeshAccessError> {
        if origin == Origin::Found && indices_of(mesh) > 3 * MOST_TRIANGLES {
            return Ok(None);
        }
        let Some(VertexAttributeValues::Float32x3(positions)) =
            mesh.try_attribute_option(Mesh::ATTRIBUTE_POSITION)?
        else {
            return Ok(None);
        };
        // Only the edges that were found depend on normals.
        let normals = match mesh.try_attribute_option(Mesh::ATTRIBUTE_NORMAL)? {
            Some(VertexAttributeValues::Float32x3(n))
                if origin == Origin::Found && n.len() == positions.len() =>
            {
                Some(n.iter().copied().map(Vec3::from).collect())
            }
            _ => None,
        };
        let own = match mesh.try_attribute_option(ATTRIBUTE_MESH_SECTION)? {
            Some(VertexAttributeValues::Uint32(own)) => Some(own.clone()),
            _ => None,
        };
        let indices: Vec<u32> = match mesh.try_indices_option()? {
            Some(indices) => indices.iter().map(|i| i as u32).collect(),
            None => (0..positions.len() as u32).collect(),
        };
        let triangles = match mesh.primitive_topology() {
            PrimitiveTopology::TriangleList => indices.as_chunks::<3>().0.to_vec(),
            // Every second triangle of a strip has the other winding.
            PrimitiveTopology::TriangleStrip => indices
                .array_windows()
                .enumerate()
                .map(|(i, &[a, b, c])| if i % 2 == 0 { [a, b, c] } else { [a, c, b] })
                .collect(),
            _ => return Ok(None),
        };
        // A strip that starts anew somewhere: which triangle is which, is not known.
        let restarts = indices.iter().any(|i| matches!(i, 0xffff | 0xffff_ffff));
        if mesh.primitive_topology() == PrimitiveTopology::TriangleStrip && restarts {
            return Ok(None);
        }
        let count = positions.len() as u32;
        let is_whole = |t: &[u32; 3]| t.iter().all(|i| *i < count);
        // A triangle with an index that does not exist is not drawn, but counts.
        let triangles = triangles
            .into_iter()
            .map(|t| if is_whole(&t) { t } else { [0; 3] })
            .collect();
        Ok(Some(Self {
            positions: positions.iter().copied().map(Vec3::from).collect(),
            normals,
            triangles,
            own,
        }))
    }

    /// The section of each triangle: 1 to [`NUMBERS`], or [`SILENT`]; empty if there are too many.
    /// `angle`: from which two triangles that share an edge are two sections, in degrees.
    pub fn divide(&self, angle: f32, origin: Origin) -> Vec<u8> {
        if let Some(own) = &self.own {
            let of = |t: &[u32; 3]| own.get(t[0] as usize).copied().unwrap_or(0);
            return self.triangles.iter().map(|t| own_number(of(t))).collect();
        }
        let corners = self.welded();
        let normals: Vec<Vec3> = self.triangles.iter().map(|t| self.normal(t)).collect();
        let least = angle.to_radians().cos();
        let mut parts = Parts::new(self.triangles.len());
        let mut apart = Vec::new();
        for [a, b] in edges(&corners) {
            let turned = a.forwards == b.forwards;
            let [n, m] = [normals[a.triangle], normals[b.triangle]];
            // A triangle without an area has no normal; it separates nothing.
            let flat = n == Vec3::ZERO || m == Vec3::ZERO;
            let cosine = if turned { -n.dot(m) } else { n.dot(m) };
            if flat
                || cosine > least
                || (origin == Origin::Found && self.is_smooth(&corners, [a, b]))
            {
                parts.join(a.triangle, b.triangle);
            } else {
                apart.push([a.triangle, b.triangle]);
            }
        }
        let roots: Vec<usize> = (0..self.triangles.len()).map(|i| parts.root(i)).collect();
        match origin {
            Origin::Asked => number(&roots, &apart, &[], FOUND..NUMBERS),
            Origin::Found if self.is_crowd(&roots) => Vec::new(),
            Origin::Found => number(&roots, &apart, &self.touching(&roots), 0..FOUND),
        }
    }

    /// Whether the normals of two triangles agree at both ends of their common edge.
    fn is_smooth(&self, corners: &[[u32; 3]], [a, b]: [Side; 2]) -> bool {
        let Some(normals) = &self.normals else {
            return false;
        };
        let least = SMOOTH.to_radians().cos();
        let [at, bt] = [a, b].map(|side| (&corners[side.triangle], &self.triangles[side.triangle]));
        let normal = |corner: u32, (welded, own): (&[u32; 3], &[u32; 3])| {
            let i = welded.iter().position(|other| *other == corner)?;
            Some(normals[own[i] as usize].normalize_or_zero())
        };
        at.0.iter()
            .filter(|corner| bt.0.contains(corner))
            .all(|corner| {
                let found = normal(*corner, at).zip(normal(*corner, bt));
                found.is_some_and(|(n, m)| n.dot(m) > least)
            })
    }

    /// Whether half of the area is divided into more than [`MOST`] sections.
    fn is_crowd(&self, roots: &[usize]) -> bool {
        let mut areas: HashMap<usize, f64> = HashMap::default();
        for (t, root) in self.triangles.iter().zip(roots) {
            let [a, b, c] = t.map(|i| self.positions[i as usize].as_dvec3());
            let area = (b - a).cross(c - a).length();
            if area.is_finite() {
                *areas.entry(*root).or_default() += area;
            }
        }
        let mut areas: Vec<f64> = areas.into_values().collect();
        areas.sort_by(|a, b| b.total_cmp(a));
        let half = 0.5 * areas.iter().sum::<f64>();
        areas.iter().take(MOST).sum::<f64>() < half
    }

    /// Pairs of triangles of sections whose boxes touch: such sections may meet on the screen
    /// although they have no common edge.
    fn touching(&self, roots: &[usize]) -> Vec<[usize; 2]> {
        let mut boxes: HashMap<usize, [Vec3; 2]> = HashMap::default();
        for (t, root) in self.triangles.iter().zip(roots) {
            let known = boxes
                .entry(*root)
                .or_insert([Vec3::INFINITY, Vec3::NEG_INFINITY]);
            for p in t.map(|i| self.positions[i as usize]) {
                *known = [known[0].min(p), known[1].max(p)];
            }
        }
        if boxes.len() > MOST_BOXES {
            return Vec::new();
        }
        let all = boxes
            .values()
            .fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |all, b| {
                [all[0].min(b[0]), all[1].max(b[1])]
            });
        let near = 1e-3 * (all[1] - all[0]).length();
        let mut boxes: Vec<(usize, [Vec3; 2])> = boxes.into_iter().collect();
        boxes.sort_by(|a, b| a.1[0].x.total_cmp(&b.1[0].x).then(a.0.cmp(&b.0)));
        let mut pairs = Vec::new();
        for (i, (root, [low, high])) in boxes.iter().enumerate() {
            let right = boxes[i + 1..]
                .iter()
                .take_while(|(_, b)| b[0].x <= high.x + near);
            let meets = |b: &[Vec3; 2]| {
                let apart = (b[0] - *high).max(*low - b[1]);
                apart.max_element() <= near
            };
            pairs.extend(
                right
                    .filter(|(_, b)| meets(b))
                    .map(|(other, _)| [*root, *other]),
            );
            if pairs.len() > MOST_PAIRS {
                return Vec::new();
            }
        }
        pairs
    }

    /// The unit normal of a triangle; 0 if it has no area.
    fn normal(&self, t: &[u32; 3]) -> Vec3 {
        let [a, b, c] = t.map(|i| self.positions[i as usize]);
        (b - a)
            .as_dvec3()
            .cross((c - a).as_dvec3())
            .normalize_or_zero()
            .as_vec3()
    }

    /// The triangles, with one index for all vertices at the same place.
    fn welded(&self) -> Vec<[u32; 3]> {
        let finite = self.positions.iter().copied().filter(|p| p.is_finite());
        let low = finite.clone().fold(Vec3::INFINITY, Vec3::min);
        let high = finite.fold(Vec3::NEG_INFINITY, Vec3::max);
        let near = (WELD * (high - low).length()).max(f32::MIN_POSITIVE);
        // Cells of twice the distance: what is near lies in one of at most eight.
        let cell = |p: Vec3| ((p - low) / (2.0 * near)).floor().as_ivec3();
        let mut known: HashMap<IVec3, Vec<u32>> = HashMap::default();
        let mut one_of = Vec::with_capacity(self.positions.len());
        for (i, p) in self.positions.iter().enumerate() {
            if !p.is_finite() {
                one_of.push(i as u32);
                continue;
            }
            let [from, to] = [cell(*p - near), cell(*p + near)];
            let mut found = None;
            for corner in 0..8 {
                let pick = |axis: usize| {
                    if corner >> axis & 1 == 0 {
                        from[axis]
                    } else {
                        to[axis]
                    }
                };
                let at = IVec3::new(pick(0), pick(1), pick(2));
                let same = |j: &&u32| self.positions[**j as usize].distance(*p) <= near;
                found = found.or_else(|| known.get(&at)?.iter().find(same).copied());
            }
            let own = i as u32;
            if found.is_none() {
                known.entry(cell(*p)).or_default().push(own);
            }
            one_of.push(found.unwrap_or(own));
        }
        let weld = |t: &[u32; 3]| t.map(|i| one_of[i as usize]);
        self.triangles.iter().map(weld).collect()
    }
}

/// The number of an author's section.
fn own_number(own: u32) -> u8 {
    match own {
        0 => SILENT,
        own => ((own - 1) % u32::from(NUMBERS - FOUND)) as u8 + FOUND + 1,
    }
}

/// One side of an edge.
#[derive(Clone, Copy)]
struct Side {
    triangle: usize,
    /// Whether the triangle goes from the smaller to the larger index.
    forwards: bool,
}

/// All pairs of triangles that share an edge.
fn edges(corners: &[[u32; 3]]) -> Vec<[Side; 2]> {
    let mut first: HashMap<[u32; 2], Side> = HashMap::default();
    let mut pairs = Vec::with_capacity(corners.len() * 3 / 2);
    for (triangle, t) in corners.iter().enumerate() {
        for i in 0..3 {
            let [a, b] = [t[i], t[(i + 1) % 3]];
            if a == b {
                continue;
            }
            let side = Side {
                triangle,
                forwards: a < b,
            };
            // Where more than two triangles meet, each is compared with the first.
            match first.get(&[a.min(b), a.max(b)]) {
                Some(other) => pairs.push([*other, side]),
                None => {
                    first.insert([a.min(b), a.max(b)], side);
                }
            }
        }
    }
    pairs
}

/// Disjoint sets of triangles.
struct Parts(Vec<u32>);

impl Parts {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn root(&mut self, mut at: usize) -> usize {
        while self.0[at] as usize != at {
            self.0[at] = self.0[self.0[at] as usize];
            at = self.0[at] as usize;
        }
        at
    }

    fn join(&mut self, a: usize, b: usize) {
        let [a, b] = [self.root(a), self.root(b)];
        self.0[a.max(b)] = a.min(b) as u32;
    }
}

/// Gives each part a number of a range, which is 1 less than the number, that its neighbors do not
/// have, if there is one. `roots`: the first triangle of the part of each triangle; `apart`: pairs
/// of neighbors; `near`: pairs that should differ if that is possible too.
fn number(
    roots: &[usize],
    apart: &[[usize; 2]],
    near: &[[usize; 2]],
    range: std::ops::Range<u8>,
) -> Vec<u8> {
    let beside = |pairs: &[[usize; 2]]| {
        let mut beside: HashMap<usize, HashSet<usize>> = HashMap::default();
        for [a, b] in pairs {
            let [a, b] = [roots[*a], roots[*b]];
            if a != b {
                beside.entry(a).or_default().insert(b);
                beside.entry(b).or_default().insert(a);
            }
        }
        beside
    };
    let (apart, near) = (beside(apart), beside(near));
    let count = range.end - range.start;
    let mut numbers = vec![0u8; roots.len()];
    let mut next = 0u8;
    for (triangle, root) in roots.iter().enumerate() {
        if triangle == *root {
            let taken = |beside: &HashMap<usize, HashSet<usize>>| -> HashSet<u8> {
                let others = beside.get(root).into_iter().flatten();
                others.map(|other| numbers[*other]).collect()
            };
            let (apart, near) = (taken(&apart), taken(&near));
            // Numbers in turn: parts that only touch on the screen rarely have the same.
            let candidates = || (0..count).map(|i| range.start + (next + i) % count + 1);
            let free = candidates().find(|n| !apart.contains(n) && !near.contains(n));
            let free = free.or_else(|| candidates().find(|n| !apart.contains(n)));
            let free = free.unwrap_or(range.start + 1);
            numbers[triangle] = free;
            next = (free - range.start) % count;
        }
        // The root of a part is its first triangle.
        numbers[triangle] = numbers[*root];
    }
    numbers
}

#[cfg(test)]
mod tests;
