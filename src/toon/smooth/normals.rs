//! Normals of a mesh without its details.

use bevy::{
    asset::RenderAssetUsages,
    math::{DVec3, Vec3},
    mesh::{Mesh, MeshAccessError, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues},
    platform::collections::HashMap,
    render::render_resource::VertexFormat,
};
use thiserror::Error;

/// The smoothed normal of a vertex, octahedral: see `octahedral.wgsl`.
pub(crate) const SMOOTHED_NORMAL: MeshVertexAttribute = MeshVertexAttribute::new(
    "ComicsSmoothedNormal",
    0x6f1d_93c2_54ab_e801,
    VertexFormat::Snorm16x2,
);

/// Vertices that are closer than this fraction of the diagonal of a mesh are one.
const WELD: f64 = 1e-5;

/// Why a mesh keeps its own normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub(crate) enum Unsmoothed {
    #[error("its data is only on the GPU: it needs `RenderAssetUsages::MAIN_WORLD`")]
    OnGpu,
    #[error("it has no positions or no normals of three 32-bit numbers")]
    NoNormals,
    #[error("it is not made of triangles")]
    NoTriangles,
}

impl From<MeshAccessError> for Unsmoothed {
    fn from(error: MeshAccessError) -> Self {
        match error {
            MeshAccessError::ExtractedToRenderWorld => Self::OnGpu,
            MeshAccessError::NotFound => Self::NoNormals,
        }
    }
}

/// The part of a mesh that its smoothed normals depend on.
#[derive(Clone, Debug)]
pub(crate) struct Faces {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Faces {
    pub fn of(mesh: &Mesh) -> Result<Self, Unsmoothed> {
        // It may still have its data in its first frame.
        if !mesh.asset_usage.contains(RenderAssetUsages::MAIN_WORLD) {
            return Err(Unsmoothed::OnGpu);
        }
        let three = |attribute: MeshVertexAttribute| match mesh.try_attribute(attribute)? {
            VertexAttributeValues::Float32x3(values) => Ok(values.clone()),
            _ => Err(Unsmoothed::NoNormals),
        };
        let positions = three(Mesh::ATTRIBUTE_POSITION)?;
        let normals = three(Mesh::ATTRIBUTE_NORMAL)?;
        if positions.len() != normals.len() {
            return Err(Unsmoothed::NoNormals);
        }
        let corners: Vec<u32> = match mesh.try_indices_option()? {
            Some(corners) => corners.iter().map(|i| i as u32).collect(),
            None => (0..positions.len() as u32).collect(),
        };
        let triangles: Vec<[u32; 3]> = match mesh.primitive_topology() {
            PrimitiveTopology::TriangleList => corners.as_chunks::<3>().0.to_vec(),
            PrimitiveTopology::TriangleStrip => corners.array_windows().copied().collect(),
            _ => return Err(Unsmoothed::NoTriangles),
        };
        Ok(Self {
            positions,
            normals,
            triangles,
        })
    }

    /// Normals of unit length, one for each vertex. Vertices at one place are one vertex. It starts
    /// with the mean of the normals of the triangles around it, weighted by their angles there. In
    /// each round the normals of its neighbors are added to it, with weights whose mean is 1: they
    /// are mean value coordinates (Floater 2003), so that the middle of the neighbors is where the
    /// vertex is, however an area is divided into triangles. A ball keeps its normals.
    ///
    /// Where the mean is undecided, as where two sides of a leaf meet, and where a vertex has no
    /// triangle, the vertex keeps its own normal.
    pub fn smoothed(&self, rounds: u32) -> Vec<Vec3> {
        let places = self.welded();
        let fan = Fan::new(self, &places);
        let normals = fan.smoothed(rounds);
        let own = |vertex: usize| Vec3::from_array(self.normals[vertex]).normalize_or(Vec3::Y);
        let of = |(vertex, place): (usize, &u32)| {
            let normal = normals[*place as usize];
            if normal == DVec3::ZERO {
                own(vertex)
            } else {
                normal.as_vec3()
            }
        };
        places.iter().enumerate().map(of).collect()
    }

    fn position(&self, vertex: usize) -> DVec3 {
        Vec3::from_array(self.positions[vertex]).as_dvec3()
    }

    /// The number of the place of each vertex. Vertices at one place have the same number.
    fn welded(&self) -> Vec<u32> {
        let all = (0..self.positions.len()).map(|v| self.position(v));
        let finite = all.filter(|p| p.is_finite());
        let (low, high) = finite.fold((DVec3::MAX, DVec3::MIN), |(low, high), p| {
            (low.min(p), high.max(p))
        });
        let reach = WELD * (high - low).length();
        let cell = if reach > 0.0 { reach } else { 1.0 };
        let mut places = Vec::with_capacity(self.positions.len());
        let mut count = 0;
        let mut grid: HashMap<[i32; 3], Vec<(DVec3, u32)>> = HashMap::default();
        for vertex in 0..self.positions.len() {
            let p = self.position(vertex);
            let at = ((p - low) / cell).to_array().map(|x| x as i32);
            let found = (p.is_finite().then(|| near(&grid, at, p, reach))).flatten();
            places.push(found.unwrap_or_else(|| {
                grid.entry(at).or_default().push((p, count));
                count += 1;
                count - 1
            }));
        }
        places
    }
}

/// The place within `reach` of a point, in the cells around its own.
fn near(
    grid: &HashMap<[i32; 3], Vec<(DVec3, u32)>>,
    at: [i32; 3],
    p: DVec3,
    reach: f64,
) -> Option<u32> {
    (0..27).find_map(|k: i32| {
        let cell = [at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1];
        let here = grid.get(&cell)?;
        let close = here.iter().find(|(q, _)| p.distance(*q) <= reach)?;
        Some(close.1)
    })
}

/// Places, and the edges between them.
struct Fan {
    /// Mean normals of the triangles, of unit length, or 0.
    normals: Vec<DVec3>,
    /// Pairs of neighbors, each in both orders, sorted, and the weight of the second one.
    edges: Vec<([u32; 2], f64)>,
}

/// The largest tangent of half an angle: triangles may have no area.
const WIDEST: f64 = 100.0;

impl Fan {
    fn new(faces: &Faces, places: &[u32]) -> Self {
        let count = places.iter().max().map_or(0, |most| *most as usize + 1);
        let mut normals = vec![DVec3::ZERO; count];
        let mut edges = Vec::with_capacity(6 * faces.triangles.len());
        for triangle in &faces.triangles {
            let vertices = triangle.map(|corner| corner as usize);
            if vertices.iter().any(|v| *v >= places.len()) {
                continue;
            }
            let p = vertices.map(|v| faces.position(v));
            let Some(normal) = (p[1] - p[0]).cross(p[2] - p[0]).try_normalize() else {
                continue;
            };
            // On the side of the mesh's normals, however the triangle is wound.
            let own: DVec3 = vertices
                .map(|v| Vec3::from_array(faces.normals[v]).as_dvec3())
                .into_iter()
                .sum();
            let normal = if normal.dot(own) < 0.0 {
                -normal
            } else {
                normal
            };
            let at = vertices.map(|v| places[v]);
            for k in 0..3 {
                let [here, next, last] = [k, (k + 1) % 3, (k + 2) % 3];
                let sides = [next, last].map(|other| p[other] - p[here]);
                let angle = sides[0].angle_between(sides[1]);
                normals[at[here] as usize] += angle * normal;
                for (side, other) in sides.into_iter().zip([next, last]) {
                    if at[here] != at[other] {
                        let weight = (0.5 * angle).tan().clamp(0.0, WIDEST) / side.length();
                        edges.push(([at[here], at[other]], weight));
                    }
                }
            }
        }
        let edges = evened(edges, count);
        for normal in &mut normals {
            *normal = unit(*normal, DVec3::ZERO);
        }
        Self { normals, edges }
    }

    fn smoothed(self, rounds: u32) -> Vec<DVec3> {
        let mut normals = self.normals;
        for _ in 0..rounds {
            let mut sums = normals.clone();
            for ([here, other], weight) in &self.edges {
                sums[*here as usize] += *weight * normals[*other as usize];
            }
            for (sum, normal) in sums.iter_mut().zip(&normals) {
                *sum = unit(*sum, *normal);
            }
            normals = sums;
        }
        normals
    }
}

/// One edge for each pair of neighbors, with weights whose mean is 1 at each of `count` places.
fn evened(mut edges: Vec<([u32; 2], f64)>, count: usize) -> Vec<([u32; 2], f64)> {
    edges.sort_by_key(|(pair, _)| *pair);
    edges.dedup_by(|next, kept| {
        let is_same = next.0 == kept.0;
        kept.1 += if is_same { next.1 } else { 0.0 };
        is_same
    });
    let mut sums = vec![(0.0, 0.0); count];
    for ([here, _], weight) in &edges {
        let (sum, neighbors) = &mut sums[*here as usize];
        *sum += *weight;
        *neighbors += 1.0;
    }
    for ([here, _], weight) in &mut edges {
        let (sum, neighbors) = sums[*here as usize];
        *weight *= neighbors / sum;
    }
    edges
}

/// A sum of unit vectors at unit length, or another one where they cancel.
fn unit(sum: DVec3, otherwise: DVec3) -> DVec3 {
    let length = sum.length();
    if length > 1e-6 && length.is_finite() {
        sum / length
    } else {
        otherwise
    }
}

/// A unit vector on an octahedron that is unfolded to a square.
pub(crate) fn octahedral(normal: Vec3) -> [i16; 2] {
    let n = normal / normal.abs().element_sum().max(f32::MIN_POSITIVE);
    let sign = |x: f32| if x < 0.0 { -1.0 } else { 1.0 };
    let folded = if n.z < 0.0 {
        [(1.0 - n.y.abs()) * sign(n.x), (1.0 - n.x.abs()) * sign(n.y)]
    } else {
        [n.x, n.y]
    };
    folded.map(|x| (x * 32767.0).round() as i16)
}

#[cfg(test)]
mod tests;
