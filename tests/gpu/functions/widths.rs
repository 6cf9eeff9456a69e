//! The width of the lines of objects, at pixels of the pass that draws ids.

use bevy::math::{EulerRot, Quat};
use bevy_comics_testkit::reference::{pressure::Frame as ObjectFrame, widths::line_width};

use super::{toon::Numbers, *};
use crate::prelude::*;

const WIDTHS: &str = "#import bevy_comics::objects::widths::{line_width, pressure}
    #import bevy_pbr::mesh_bindings::mesh
    #import bevy_pbr::mesh_view_bindings::view
    fn column(n: u32) -> vec4<f32> { return vec4(i(n), i(n + 1u), i(n + 2u), i(n + 3u)); }";

/// Place, mesh, id, factor of the vertices; amount and wavelength; origin and axes of the object;
/// the matrix of the view; height of the viewport; pixels per unit and distance of the projection.
const BODY: &str = "pressure.amount = i(6u);
    pressure.wavelength = i(7u);
    view.clip_from_world = mat4x4<f32>(column(20u), column(24u), column(28u), column(32u));
    view.clip_from_view[0] = vec4(0.3, 0.0, 0.0, 0.0);
    view.clip_from_view[1] = vec4(0.0, i(37u), 0.0, 0.0);
    view.viewport = vec4(11.0, 13.0, 5000.0, i(36u));
    mesh[u(3u)].world_from_local = mat3x4<f32>(
        vec4(i(11u), i(14u), i(17u), i(8u)),
        vec4(i(12u), i(15u), i(18u), i(9u)),
        vec4(i(13u), i(16u), i(19u), i(10u)),
    );
    let place = vec4(i(0u), i(1u), i(2u), 1.0);
    return vec4(line_width(place, u(3u), u(4u), i(5u)));";

type Row = [f32; 38];

fn found(rows: &[Row]) -> Vec<f64> {
    let results = gpu().evaluate_alone(&[], WIDTHS, BODY, rows);
    results.iter().map(|found| f64::from(found[0])).collect()
}

/// A camera, and the height of its viewport in pixels.
struct Eye {
    clip_from_view: DMat4,
    view_from_world: DMat4,
    up: DVec3,
    height: f64,
}

impl Eye {
    /// At 6 to 40 units from the origin, in perspective or orthographic, and at times upside down,
    /// as mirrors have it.
    fn new(n: &mut Numbers) -> Self {
        let eye = f64::from(n.within(6.0, 40.0)) * DVec3::from_array(n.unit().map(f64::from));
        let above = DVec3::new(0.1, 1.0, 0.2).normalize();
        let view_from_world = DMat4::look_at_rh(eye, DVec3::ZERO, above);
        let projection = if n.once_in(3) {
            let half = f64::from(n.within(1.0, 20.0));
            DMat4::orthographic_rh(-half, half, -half, half, 0.1, 100.0)
        } else {
            DMat4::perspective_infinite_reverse_rh(f64::from(n.within(0.3, 1.9)), 1.5, 0.1)
        };
        let side = if n.once_in(4) { -1.0 } else { 1.0 };
        Self {
            clip_from_view: DMat4::from_scale(DVec3::new(1.0, side, 1.0)) * projection,
            view_from_world,
            up: view_from_world.inverse().transform_vector3(DVec3::Y),
            height: f64::from(n.within(100.0, 2000.0)),
        }
    }

    fn clip_from_world(&self) -> DMat4 {
        self.clip_from_view * self.view_from_world
    }

    /// Pixels between two places that are a unit apart, one above the other on the screen.
    fn pixels(&self, at: DVec3) -> f64 {
        let [low, high] = [-0.5, 0.5].map(|part| {
            let ndc = self.clip_from_world().project_point3(at + part * self.up);
            0.5 * self.height * ndc.y
        });
        (high - low).abs()
    }
}

/// Three axes with the lengths of `scale`, turned; all 0 for an object that is nowhere.
fn axes(n: &mut Numbers, scale: [f32; 3]) -> [[f32; 3]; 3] {
    let [x, y, z] = [3.0, 1.5, 3.0].map(|most| n.within(-most, most));
    let turn = Quat::from_euler(EulerRot::XYZ, x, y, z);
    let unit = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| turn * axis);
    std::array::from_fn(|k| (scale[k] * unit[k]).to_array())
}

/// A row whose waves are 2^-2 to 2^5 units of the object long, and the pixels per world unit.
fn row(n: &mut Numbers) -> (Row, f64) {
    let scale = if n.once_in(20) {
        [0.0; 3]
    } else {
        [0; 3].map(|_| n.within(0.3, 2.0))
    };
    let axes = axes(n, scale);
    let origin = [0; 3].map(|_| n.within(-1.0, 1.0));
    let local = [0; 3].map(|_| n.within(-0.8, 0.8));
    let world: [f32; 3] = std::array::from_fn(|k| {
        origin[k] + (0..3).map(|axis| local[axis] * axes[axis][k]).sum::<f32>()
    });
    let eye = Eye::new(n);
    let pixels = eye.pixels(DVec3::from_array(world.map(f64::from)));
    let longest = scale.iter().fold(0.5f32, |longest, s| longest.max(*s));
    let wavelength = pixels * f64::from(longest) * f64::from(n.within(-2.0, 5.0)).exp2();
    let factors = [1.0, 0.0, -0.5, 2.0, 3.0, n.within(0.0, 2.2)];
    let factor = factors[((n.part() * 6.0) as usize).min(5)];
    let amount = [0.0, 1.0, n.part()][((n.part() * 3.0) as usize).min(2)];
    let mut row = [0.0; 38];
    row[..3].copy_from_slice(&world);
    row[3] = (n.part() * 3.0).floor();
    row[4] = (n.part() * 65535.0).floor();
    row[5..8].copy_from_slice(&[factor, amount, wavelength as f32]);
    row[8..11].copy_from_slice(&origin);
    row[11..20].copy_from_slice(axes.as_flattened());
    let clip = eye.clip_from_world().as_mat4().to_cols_array();
    row[20..36].copy_from_slice(&clip);
    row[36] = eye.height as f32;
    row[37] = eye.clip_from_view.y_axis.y as f32;
    (row, pixels)
}

fn reference(row: &Row, pixels: f64) -> f64 {
    let three = |at: usize| [row[at], row[at + 1], row[at + 2]].map(f64::from);
    let frame = ObjectFrame {
        origin: three(8),
        axes: [three(11), three(14), three(17)],
    };
    let pen = [row[6], row[7]].map(f64::from);
    let id = row[4] as u32;
    line_width(&frame, three(0), pixels, pen, id, row[5].into()) / 255.0
}

/// In views of all kinds, for objects that are turned, stretched, or shrunk to a point. Pixels per
/// unit are measured on the screen.
#[test]
fn widths_of_lines_match_the_reference() {
    let mut n = Numbers::new(311);
    let rows: Vec<(Row, f64)> = (0..8192).map(|_| row(&mut n)).collect();
    let inputs: Vec<Row> = rows.iter().map(|(row, _)| *row).collect();
    let mut pressed = 0;
    for ((row, pixels), found) in rows.iter().zip(found(&inputs)) {
        let want = reference(row, *pixels);
        // As the noise of `pressure.rs`, of an amount up to 1 and a factor up to 2.
        assert!((found - want).abs() < 4e-4, "{row:?}: {found}, not {want}");
        let own = f64::from(row[5].clamp(0.0, 2.0)) * 127.0 / 255.0;
        if row[6] == 0.0 {
            assert!((found - own).abs() < 1e-6, "{row:?}: {found}, not {own}");
        }
        pressed += u32::from((found - own).abs() > 0.02);
    }
    assert!(pressed > 1000, "{pressed}");
}

/// At the eye and behind it there is no number of pixels per unit: the factor stays within what the
/// amount of pressure allows.
#[test]
fn widths_behind_the_eye_stay_within_bounds() {
    let mut n = Numbers::new(312);
    let rows: Vec<Row> = (0..2048)
        .map(|k| {
            let (mut row, _) = row(&mut n);
            // w of clip space is the same everywhere.
            let w = [0.0, -0.0, -1e-30, 1e-30, -1.0, -1e6][k % 6];
            for column in 0..4 {
                row[23 + 4 * column] = if column == 3 { w } else { 0.0 };
            }
            row[7] = 60.0;
            row
        })
        .collect();
    for (row, found) in rows.iter().zip(found(&rows)) {
        let [own, amount] = [row[5].clamp(0.0, 2.0), row[6]].map(f64::from);
        let [low, high] = [1.0 - amount, 1.0 + amount].map(|part| own * part);
        let found = found * 255.0 / 127.0;
        let within = found >= low - 1e-5 && found <= high.min(2.0) + 1e-5;
        assert!(within, "{row:?}: {found}");
    }
}
