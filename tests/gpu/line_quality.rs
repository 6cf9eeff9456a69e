//! How well outlines follow the edges of models that resemble real assets. The report measures the
//! same with more frames.

use std::f32::consts::TAU;

use bevy_comics_testkit::{
    reference::color::srgb_encode,
    truth::{Truth, fragments, ids_alone, line_ends, mask},
};

use crate::{
    outlines::{look, put, removed},
    prelude::*,
};

const SIZE: UVec2 = UVec2::new(120, 68);

pub fn show(small: &mut Small, specimen: Specimen) {
    small.clear();
    for (mesh, _) in specimen.parts() {
        put(small, mesh, Color::WHITE, Transform::IDENTITY);
    }
}

/// The camera of the report: turned around the model by an angle, at a distance in radii of
/// the model.
pub fn turn(small: &mut Small, distance: f32, angle: f32) {
    let eye = Quat::from_rotation_y(angle) * Vec3::new(0.0, 0.34, 0.94) * distance;
    look(small, eye, Vec3::ZERO, 0.1);
}

/// The true lines in a picture of `size`, if the last picture is `fine` times as large and
/// shows depth, normals and ids.
pub fn truth(small: &mut Small, size: UVec2, fine: u32) -> Truth {
    let camera = small.camera;
    let view = small.world().get::<RenderEntity>(camera).expect("drawn");
    let view = view.id();
    Truth::read(small.render_world(), view, size, fine)
}

/// Outlines of which the report's tables were made. Without a budget: where lines crowd, the
/// budget would make some too thin for a mask, and more so in smaller pictures.
pub fn scored(width: f32) -> Outlines {
    Outlines {
        width,
        ink_budget: 1.0,
        ..default()
    }
}

/// The pixels that lines have changed in the last picture, as the report counts them.
pub fn inked(small: &Small) -> Vec<bool> {
    let codes = |picture: &FloatImage| {
        let code = |light: f64| (255.0 * light).round() as u8;
        image::RgbaImage::from_fn(picture.width, picture.height, |x, y| {
            let [r, g, b, _] = picture.pixels[(y * picture.width + x) as usize].map(f64::from);
            let [r, g, b] = srgb_encode([r, g, b]).map(code);
            image::Rgba([r, g, b, 255])
        })
    };
    let (plain, lined) = small.pass();
    mask(&codes(&plain), &codes(&lined))
}

/// What lines score, in one picture or in several.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scores {
    /// The true pixels, and those that have a line at most one pixel away.
    pub wanted: usize,
    found: usize,
    /// The drawn pixels, and those that have a true one at most two pixels away.
    drawn: usize,
    right: usize,
    /// Pixels of thin lines in a finer picture, and their parts of at most six pixels.
    thin: usize,
    parts: usize,
}

impl Scores {
    pub fn add(&mut self, truth: &Truth, lines: &[bool]) {
        self.add_beside(truth, &truth.any(&[0, 1, 2]), lines);
    }

    /// `allowed`: the pixels beside which lines are right.
    fn add_beside(&mut self, truth: &Truth, allowed: &[bool], lines: &[bool]) {
        let (found, all) = truth.recall(&truth.any(&[0, 1, 2]), lines);
        let (right, drawn) = truth.precision(allowed, lines);
        self.found += found;
        self.wanted += all;
        self.right += right;
        self.drawn += drawn;
    }

    /// `width`: of the finer picture, in pixels.
    pub fn add_thin(&mut self, lines: &[bool], width: u32) {
        self.thin += lines.iter().filter(|ink| **ink).count();
        self.parts += fragments(lines, width as usize, 6);
    }

    /// The true pixels without a line, as a fraction.
    pub fn missed(&self) -> f64 {
        1.0 - self.found as f64 / self.wanted as f64
    }

    /// The drawn pixels away from true ones, as a fraction.
    pub fn wrong(&self) -> f64 {
        1.0 - self.right as f64 / self.drawn as f64
    }

    /// Small parts for each 100 pixels of thin lines.
    pub fn fragments(&self) -> f64 {
        100.0 * self.parts as f64 / self.thin as f64
    }
}

/// The pictures of a model that turns: a large one for the truth, of thin lines or of none, and one
/// of the size that is measured.
struct Pictures {
    fine: Small,
    lined: Small,
    size: UVec2,
}

impl Pictures {
    /// Depth, normals and ids are drawn in the large one.
    fn new(size: UVec2, fine_lines: Outlines) -> Self {
        let mut fine = Small::new(size * FINE, Msaa::Off);
        let mut lined = Small::new(size, Msaa::Off);
        fine.insert((DepthPrepass, NormalPrepass));
        for (small, lines) in [(&mut fine, fine_lines), (&mut lined, scored(2.0))] {
            small.style(&ComicStyle::new().with(lines)).settle();
        }
        Self { fine, lined, size }
    }

    fn show(&mut self, specimen: Specimen) {
        show(&mut self.fine, specimen);
        show(&mut self.lined, specimen);
    }

    /// Draws both. Returns the true lines.
    fn turn(&mut self, distance: f32, angle: f32) -> Truth {
        for small in [&mut self.fine, &mut self.lined] {
            turn(small, distance, angle);
            small.headless.step(3);
        }
        truth(&mut self.fine, self.size, FINE)
    }

    fn fine_width(&self) -> u32 {
        self.size.x * FINE
    }
}

/// For each specimen: the least recall, the most false pixels as a fraction of the picture,
/// and the most fragments for each 100 pixels of line. Measured on llvmpipe: recall 0.994,
/// 0.966, 1.000, 1.000, 0.985, 0.986; wrong pixels 0.0036 of the organic model; fragments
/// 0.37, 0.00, 0.00, 0.06, 0.00, 0.00.
const LIMITS: [(Specimen, [f64; 3]); 6] = [
    (Specimen::Organic, [0.99, 0.004, 0.5]),
    (Specimen::HardSurface, [0.96, 0.0005, 0.05]),
    (Specimen::Foliage, [0.99, 0.0005, 0.05]),
    (Specimen::Figure, [0.99, 0.0005, 0.15]),
    (Specimen::Stairs, [0.98, 0.0005, 0.05]),
    (Specimen::Wires, [0.98, 0.0005, 0.05]),
];

/// A model of bevels, of which the most lines are missed.
#[test]
fn lines_of_models_follow_their_edges() {
    assert_follow_edges(&LIMITS[1..2]);
}

#[test]
#[ignore = "long: every model in a large picture"]
fn lines_of_every_model_follow_their_edges() {
    assert_follow_edges(&LIMITS);
}

fn assert_follow_edges(limits: &[(Specimen, [f64; 3])]) {
    let mut pictures = Pictures::new(SIZE, scored(1.0));
    let width = pictures.fine_width();
    let lines = |small: &Small| -> Vec<bool> {
        let ink = removed(small);
        ink.into_iter().map(|ink| ink > 0.25).collect()
    };
    for &(specimen, [least_recall, most_wrong, most_fragments]) in limits {
        let mut scores = Scores::default();
        let mut pixels = 0;
        pictures.show(specimen);
        for angle in [0.0, 1.3, 2.9] {
            let truth = pictures.turn(2.6, angle);
            scores.add_beside(&truth, &truth.faint, &lines(&pictures.lined));
            scores.add_thin(&lines(&pictures.fine), width);
            pixels += truth.inside().count();
        }
        let what = format!("{}: {scores:?} of {pixels} pixels", specimen.name());
        let wrong = (scores.drawn - scores.right) as f64 / pixels as f64;
        assert!(scores.wanted > 500, "{what}");
        assert!(1.0 - scores.missed() >= least_recall, "{what}");
        assert!(wrong <= most_wrong, "{what}");
        assert!(scores.fragments() <= most_fragments, "{what}");
    }
}

/// Models seen from afar in the report's frames 15 and 60: the fractions of the true pixels that
/// are missed and of the drawn ones that are wrong, and fragments of thin lines for each 100
/// pixels. Measured on llvmpipe.
const DISTANT: [(Specimen, [f64; 3]); 6] = [
    (Specimen::Organic, [7.0 / 164.0, 0.0, 1.11]),
    (Specimen::HardSurface, [0.0, 0.0, 0.81]),
    (Specimen::Foliage, [3.0 / 407.0, 0.0, 0.18]),
    (Specimen::Figure, [0.0, 0.0, 0.28]),
    (Specimen::Stairs, [0.0, 0.0, 0.0]),
    (Specimen::Wires, [0.0453, 0.0, 5.41]),
];

/// The most fragments for each 100 pixels of thin lines in scenes: the target of the report.
pub const MOST_FRAGMENTS: f64 = 0.3;

/// Lines may move by a pixel between adapters: 2 % more pixels, as in the report's counts of
/// work, and a tenth more fragments, at least 0.05.
const ADAPTER: f64 = 0.02;
const ADAPTER_FRAGMENTS: [f64; 2] = [0.1, 0.05];

/// The size of the report's pictures, of which its scores hold as they are.
const REPORTED: UVec2 = UVec2::new(240, 136);
const DISTANT_ANGLES: [f32; 2] = [15.0 / 90.0 * TAU, 60.0 / 90.0 * TAU];

#[test]
#[ignore = "long: large pictures; quick test line_quality::lines_of_models_follow_their_edges"]
fn lines_of_distant_models_follow_their_edges() {
    let mut pictures = Pictures::new(REPORTED, scored(1.0));
    let width = pictures.fine_width();
    for (specimen, measured) in DISTANT {
        let mut scores = Scores::default();
        pictures.show(specimen);
        for angle in DISTANT_ANGLES {
            let truth = pictures.turn(16.0, angle);
            scores.add(&truth, &inked(&pictures.lined));
            scores.add_thin(&inked(&pictures.fine), width);
        }
        let what = format!("{}: {scores:?}", specimen.name());
        // The smooth model and the figure have the fewest edges: 164 and 163 pixels.
        let least = match specimen {
            Specimen::Organic | Specimen::Figure => 160,
            _ => 200,
        };
        assert!(scores.wanted > least, "{what}");
        let [ratio, least] = ADAPTER_FRAGMENTS;
        let more = (ratio * measured[2]).max(least);
        assert!(scores.missed() <= measured[0] + ADAPTER, "{what}");
        assert!(scores.wrong() <= measured[1] + ADAPTER, "{what}");
        assert!(scores.fragments() <= measured[2] + more, "{what}");
    }
}

/// A cylinder and a solid of flat faces that turn: every tenth of the report's 90 frames. There are
/// fewer than 0.5 dashes, of two ends each, in 100 pixels of true line, and not more than without
/// continuing along weak edges. One end more is allowed: that of a line that continues along an
/// edge that ends inside a surface.
#[test]
#[ignore = "long: large pictures; `a_curved_rim_has_one_line` turns a cylinder"]
fn turning_shapes_have_few_dashes() {
    let mut pictures = Pictures::new(REPORTED, ids_alone());
    let cut = Outlines {
        hysteresis: 0.0,
        min_length: 1,
        ..scored(2.0)
    };
    // Its faces bend by 42 degrees, where creases begin at 40.
    let mut solid = Sphere::new(1.0).mesh().ico(0).expect("few triangles");
    solid.duplicate_vertices();
    solid.compute_flat_normals();
    for (name, mesh) in [
        ("cylinder", Cylinder::new(0.6, 1.2).into()),
        ("solid", solid),
    ] {
        for small in [&mut pictures.fine, &mut pictures.lined] {
            small.clear();
            put(small, mesh.clone(), Color::WHITE, Transform::IDENTITY);
        }
        let angles = (0..9u8).map(|frame| f32::from(frame) / 9.0 * TAU);
        let mut length = 0;
        for angle in angles.clone() {
            let lines = pictures.turn(2.6, angle).any(&[0, 1, 2]);
            length += lines.iter().filter(|line| **line).count();
        }
        let lined = &mut pictures.lined;
        let ends = [cut, scored(2.0)].map(|outlines| {
            lined.outlined(outlines);
            let ends = angles.clone().map(|angle| {
                turn(lined, 2.6, angle);
                lined.headless.step(1);
                line_ends(&lined.cracks().expect("lines"))
            });
            ends.sum::<usize>()
        });
        assert!(length > 2000, "{name}: {length}");
        assert!(ends[1] <= ends[0] + 1, "{name}: {ends:?}");
        let dashes = 50.0 * ends[1] as f64 / length as f64;
        assert!(dashes < 0.5, "{name}: {dashes}");
    }
}

/// Distant wires, most of them thinner than a pixel, seen in pictures of the report's size: with
/// their gaps closed, more of them have lines, these are in fewer pieces, and hardly more lines are
/// wrong.
#[test]
#[ignore = "long: large pictures; quick test gap_closing::thin_wires_at_small_angles_are_whole"]
fn closed_gaps_make_distant_wires_whole() {
    let mut pictures = Pictures::new(REPORTED, ids_alone());
    pictures.show(Specimen::Wires);
    let mut scores = [Scores::default(); 2];
    for angle in DISTANT_ANGLES {
        let truth = pictures.turn(16.0, angle);
        let lined = &mut pictures.lined;
        for (scores, gap_closing) in scores.iter_mut().zip([0, 3]) {
            let mut drawn = |width| {
                lined.outlined(Outlines {
                    gap_closing,
                    ..scored(width)
                });
                inked(lined)
            };
            scores.add(&truth, &drawn(2.0));
            scores.add_thin(&drawn(1.0), REPORTED.x);
        }
    }
    let [open, closed] = scores;
    assert!(open.wanted > 200, "{scores:?}");
    assert!(closed.missed() <= open.missed(), "{scores:?}");
    assert!(closed.wrong() <= open.wrong() + ADAPTER, "{scores:?}");
    assert!(closed.fragments() <= open.fragments(), "{scores:?}");
}
