//! The teapot's lid has layers that lie close: the sides of its pixels where the geometry ends
//! have a line.

use bevy_comics_testkit::{
    read_back,
    reference::planes::column_word,
    scenes::{Vantage, teapot},
};

use crate::prelude::*;

/// The size of figure 10 of the documents.
const SIZE: UVec2 = UVec2::new(800, 450);
/// Quads along the sides of the teapot's patches.
const STEPS: u32 = 12;
/// Vertices of a patch.
const VERTICES: usize = (STEPS as usize + 1) * (STEPS as usize + 1);
/// The patches of the knob and the lid.
const LID: Range<usize> = 16..24;
/// A jump of this fraction of the distance is a silhouette of full ink, by default.
const JUMP: f64 = 0.02;

/// A triangle on the screen, in pixels, that faces the camera.
struct Triangle {
    corners: [DVec2; 3],
    /// One over the distance of the corners along the view: affine on the screen.
    raw: [f64; 3],
    is_lid: bool,
}

impl Triangle {
    fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        (b - a).perp_dot(c - a)
    }

    /// One over the distance at a place, if the triangle covers it.
    fn raw_at(&self, at: DVec2) -> Option<f64> {
        let [a, b, c] = self.corners;
        let weight = |(p, q): (DVec2, DVec2)| (q - p).perp_dot(at - p) / self.area();
        let weights = [(b, c), (c, a), (a, b)].map(weight);
        let covers = weights.iter().all(|weight| *weight >= 0.0);
        covers.then(|| weights.iter().zip(self.raw).map(|(w, r)| w * r).sum())
    }
}

/// The triangles of the teapot that the scene's camera sees from their front.
fn triangles(vantage: &Vantage) -> Vec<Triangle> {
    let shape = teapot::mesh(STEPS, [1.0; 4]);
    let to_view = vantage.transform().to_matrix().as_dmat4().inverse();
    let size = SIZE.as_dvec2();
    let focal = 0.5 * size.y / (0.5 * f64::from(vantage.fov)).tan();
    let project = |index: u32| {
        let place = Vec3::from(shape.positions[index as usize]) + Vec3::new(0.0, 4.0, 0.0);
        let DVec3 { x, y, z } = to_view.transform_point3(place.as_dvec3());
        (0.5 * size + DVec2::new(x, -y) * (focal / -z), -1.0 / z)
    };
    let triangles = shape.indices.as_chunks::<3>().0.iter().map(|indices| {
        let [a, b, c] = indices.map(project);
        Triangle {
            corners: [a.0, b.0, c.0],
            raw: [a.1, b.1, c.1],
            is_lid: LID.contains(&(indices[0] as usize / VERTICES)),
        }
    });
    // The screen's y axis points down: fronts are clockwise in its coordinates.
    triangles.filter(|triangle| triangle.area() < 0.0).collect()
}

/// The triangles by the pixel columns and rows that they may cover.
struct Seen {
    triangles: Vec<Triangle>,
    by_pixel: Vec<Vec<usize>>,
}

impl Seen {
    fn new(vantage: &Vantage) -> Self {
        let triangles = triangles(vantage);
        let mut by_pixel = vec![Vec::new(); (SIZE.x * SIZE.y) as usize];
        for (i, triangle) in triangles.iter().enumerate() {
            let [a, b, c] = triangle.corners;
            let (low, high) = (a.min(b).min(c).floor(), a.max(b).max(c).floor());
            for y in low.y as usize..=high.y as usize {
                for x in low.x as usize..=high.x as usize {
                    by_pixel[y * SIZE.x as usize + x].push(i);
                }
            }
        }
        Self {
            triangles,
            by_pixel,
        }
    }

    /// One over the distance of the nearest point at a place, and whether it is the lid's; 0 where
    /// the teapot is not.
    fn at(&self, at: DVec2) -> (f64, bool) {
        let [x, y] = at.floor().to_array().map(|v| v as usize);
        let here = self.by_pixel[y * SIZE.x as usize + x].iter();
        here.map(|i| &self.triangles[*i])
            .filter_map(|triangle| Some((triangle.raw_at(at)?, triangle.is_lid)))
            .fold((0.0, false), |a, b| if b.0 > a.0 { b } else { a })
    }

    /// Whether the distance jumps somewhere between two places: all of a continuous change would
    /// not happen within 1/64 of the way.
    fn jumps(&self, from: DVec2, to: DVec2) -> bool {
        const PARTS: usize = 64;
        let at = |i: usize| self.at(from.lerp(to, i as f64 / PARTS as f64)).0;
        (0..PARTS).any(|i| {
            let (a, b) = (at(i), at(i + 1));
            (a - b).abs() > JUMP * a.max(b)
        })
    }
}

/// The sides of pixels at which the lid ends, or something ends before it: pixel, and 0 for its
/// east and 1 for its south.
fn true_sides(seen: &Seen) -> HashSet<([i64; 2], usize)> {
    let center = |[x, y]: [i64; 2]| DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let [width, height] = SIZE.to_array().map(i64::from);
    let mut sides = HashSet::new();
    for pixel in (0..height - 1).flat_map(|y| (0..width - 1).map(move |x| [x, y])) {
        for (side, step) in [[1, 0], [0, 1]].into_iter().enumerate() {
            let [from, to] = [pixel, [pixel[0] + step[0], pixel[1] + step[1]]].map(center);
            let [(a, lid_a), (b, lid_b)] = [from, to].map(|place| seen.at(place));
            let may_jump = (lid_a || lid_b) && (a - b).abs() > JUMP * a.max(b);
            if may_jump && seen.jumps(from, to) {
                sides.insert((pixel, side));
            }
        }
    }
    sides
}

#[test]
#[ignore = "long: a large picture; quick test line_truth::a_strong_edge_nearby_hides_no_edge"]
fn sides_of_the_lid_have_lines() {
    let mut studio = Studio::new(BuiltIn::Teapot, SIZE, Msaa::Off);
    studio.shoot(Some(&ComicStyle::new().with(Outlines::default())));
    let world = studio.headless.app.world();
    let view = world.get::<RenderEntity>(studio.camera);
    let view = view.expect("drawn").id();
    let world = studio.headless.app.sub_app(RenderApp).world();
    let cracks = read_back::cracks(world, view).expect("lines");
    let size = SIZE.to_array().map(i64::from);
    let has_line = |[x, y]: [i64; 2], side: usize| {
        let word = cracks.planes[column_word(size, side as i64, x, y / 32) as usize];
        (word >> (y % 32)) & 1 != 0
    };

    let sides = true_sides(&Seen::new(&studio.vantage));
    let bare: Vec<_> = (sides.iter())
        .filter(|(pixel, side)| !has_line(*pixel, *side))
        .collect();
    assert!(sides.len() > 72, "{}", sides.len());
    // Of a surface that is seen in a single row of pixels, depth alone does not tell whether it is
    // another one or the end of a curve: there, the line of the larger step beside it is drawn.
    for ([x, y], side) in &bare {
        let [i, j] = [[1, 0], [0, 1]][*side];
        let beside = [[x - i, y - j], [x + i, y + j]];
        assert!(beside.into_iter().any(|pixel| has_line(pixel, *side)));
    }
    assert!(20 * bare.len() < sides.len(), "{bare:?}");
}
