//! Divides a mesh into sections: parts that bend nowhere as sharply as a given angle.

use bevy::{
    math::{IVec3, Vec3},
    mesh::{Indices, Mesh, MeshAccessError, PrimitiveTopology, VertexAttributeValues},
    platform::collections::{HashMap, HashSet},
};

use super::ATTRIBUTE_MESH_SECTION;

/// A section whose borders and bends have no creases.
pub(super) const SILENT: u8 = 255;
/// Numbers of sections, from 1 on. Neighbours have different numbers.
pub(super) const NUMBERS: u8 = 127;
/// Vertices that are nearer to each other than this fraction of the mesh's diagonal are one.
const WELD: f32 = 1e-5;

/// What dividing reads of a mesh.
pub(super) struct Surface {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// The author's sections, by vertex.
    own: Option<Vec<u32>>,
}

impl Surface {
    /// `None` for a mesh without triangles.
    pub fn new(mesh: &Mesh) -> Result<Option<Self>, MeshAccessError> {
        let Some(VertexAttributeValues::Float32x3(positions)) =
            mesh.try_attribute_option(Mesh::ATTRIBUTE_POSITION)?
        else {
            return Ok(None);
        };
        let own = match mesh.try_attribute_option(ATTRIBUTE_MESH_SECTION)? {
            Some(VertexAttributeValues::Uint32(own)) => Some(own.clone()),
            _ => None,
        };
        let indices: Vec<u32> = match mesh.try_indices_option()? {
            Some(Indices::U16(indices)) => indices.iter().map(|i| u32::from(*i)).collect(),
            Some(Indices::U32(indices)) => indices.clone(),
            None => (0..positions.len() as u32).collect(),
        };
        let triangles = match mesh.primitive_topology() {
            PrimitiveTopology::TriangleList => indices.as_chunks::<3>().0.to_vec(),
            // Every second triangle of a strip has the other winding.
            PrimitiveTopology::TriangleStrip => indices
                .windows(3)
                .enumerate()
                .map(|(i, t)| {
                    if i % 2 == 0 {
                        [t[0], t[1], t[2]]
                    } else {
                        [t[0], t[2], t[1]]
                    }
                })
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
            triangles,
            own,
        }))
    }

    /// The section of each triangle: 1 to [`NUMBERS`], or [`SILENT`]. `angle`: from which
    /// two triangles that share an edge are two sections, in degrees.
    pub fn divide(&self, angle: f32) -> Vec<u8> {
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
            if flat || cosine > least {
                parts.join(a.triangle, b.triangle);
            } else {
                apart.push([a.triangle, b.triangle]);
            }
        }
        number(&mut parts, &apart)
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
        own => ((own - 1) % u32::from(NUMBERS)) as u8 + 1,
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

/// Gives each part a number that its neighbours do not have, if there is one.
fn number(parts: &mut Parts, apart: &[[usize; 2]]) -> Vec<u8> {
    let roots: Vec<usize> = (0..parts.0.len()).map(|i| parts.root(i)).collect();
    let mut beside: HashMap<usize, HashSet<usize>> = HashMap::default();
    for [a, b] in apart {
        let [a, b] = [roots[*a], roots[*b]];
        if a != b {
            beside.entry(a).or_default().insert(b);
            beside.entry(b).or_default().insert(a);
        }
    }
    let mut numbers = vec![0u8; roots.len()];
    let mut next = 0u8;
    for (triangle, root) in roots.iter().enumerate() {
        if triangle == *root {
            let taken: HashSet<u8> = (beside.get(root).into_iter().flatten())
                .map(|other| numbers[*other])
                .collect();
            // Numbers in turn: parts that only touch on the screen rarely have the same.
            let mut candidates = (0..NUMBERS).map(|i| (next + i) % NUMBERS + 1);
            let free = candidates.find(|n| !taken.contains(n)).unwrap_or(1);
            numbers[triangle] = free;
            next = free % NUMBERS;
        }
        // The root of a part is its first triangle.
        numbers[triangle] = numbers[*root];
    }
    numbers
}

#[cfg(test)]
mod tests;
