//! The widths of lines that come from objects: pressure, and the widths of vertices.

use bevy::mesh::PrimitiveTopology;
use bevy_comics::objects::LineWidths;
use bevy_comics_testkit::reference::pressure::{
    Frame as ObjectFrame, pressure_factor, stored_factor,
};

use crate::{
    ids::{cube, material, skinned_and_morphed},
    prelude::*,
    sections::{none_has_sections, wait},
    walls::{towards_the_sky, unit_per_pixel, wall},
};

fn silhouettes(width: f32, weight: LineWeight) -> Outlines {
    Outlines {
        width,
        weight,
        ..Outlines::SILHOUETTES
    }
}

fn pressed(pressure: f32, pressure_length: f32) -> LineWeight {
    LineWeight {
        pressure,
        pressure_length,
        ..LineWeight::EVEN
    }
}

/// How near widths of 4 to 8 pixels are: factors are stored in 127ths, which rounds by 4 / 254
/// pixels, and the ink at both borders of the line rounds by less than 0.01 each.
const NEAR: f64 = 4.0 / 254.0 + 0.02;

/// An orthographic view, one unit per pixel, before a white sky.
fn before_white(size: UVec2) -> Small {
    let mut small = towards_the_sky(size);
    small.insert(Camera {
        clear_color: Color::WHITE.into(),
        ..default()
    });
    small
}

fn drawn(small: &mut Small, outlines: Outlines) -> image::RgbaImage {
    small.style(&ComicStyle::new().with(outlines));
    small.settle();
    small.picture()
}

/// Ink of every column between two rows.
fn ink(picture: &image::RgbaImage, columns: Range<u32>, rows: Range<u32>) -> Vec<f64> {
    let column = |x: u32| black_ink(picture, rows.clone().map(|y| (x, y)));
    columns.map(column).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn deviation(values: &[f64]) -> f64 {
    let middle = mean(values);
    let squares: Vec<f64> = values.iter().map(|v| (v - middle).powi(2)).collect();
    mean(&squares).sqrt()
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let (middle_a, middle_b) = (mean(a), mean(b));
    let products: Vec<f64> = (a.iter().zip(b))
        .map(|(a, b)| (a - middle_a) * (b - middle_b))
        .collect();
    mean(&products) / (deviation(a) * deviation(b))
}

/// Long straight rims: the mean width is the nominal one, and its deviation is in proportion
/// to the pressure.
#[test]
fn pressure_keeps_the_mean_and_spreads_the_width() {
    let size = UVec2::new(1000, 200);
    let mut small = before_white(size);
    // Bars of 20 pixels, 50 apart: eight rims.
    let bars = [-75.0f32, -25.0, 25.0, 75.0];
    for y in bars {
        wall(&mut small, [-520.0, y - 10.0], [520.0, y + 10.0], 50.0);
    }
    let rims = bars.map(|y| [y - 10.0, y + 10.0]).concat();
    let mut deviations = Vec::new();
    for pressure in [0.0, 0.25, 0.5, 1.0] {
        let picture = drawn(&mut small, silhouettes(4.0, pressed(pressure, 20.0)));
        let widths: Vec<f64> = (rims.iter())
            .flat_map(|y| {
                let row = (100.0 - y) as u32;
                ink(&picture, 10..990, row - 9..row + 9)
            })
            .collect();
        let middle = mean(&widths);
        println!(
            "pressure {pressure}: mean {middle:.3}, deviation {:.3}",
            deviation(&widths)
        );
        // About 400 independent widths of relative deviation 0.37: 2 % of the pressure.
        let bound = 0.02 + 0.06 * f64::from(pressure);
        assert!((middle / 4.0 - 1.0).abs() < bound, "{pressure}: {middle}");
        deviations.push(deviation(&widths));
    }
    assert!(deviations[0] < 0.01, "{deviations:?}");
    for (i, pressure) in [(1, 0.25), (2, 0.5), (3, 1.0)] {
        // That of the noise is 0.37; a line cannot follow all of it.
        let relative = deviations[i] / (4.0 * pressure);
        assert!((0.25..0.42).contains(&relative), "{pressure}: {relative}");
    }
}

/// The width of the line along the upper edge of a wall that is 400 units long, from its left
/// to its right end: at places of the wall, wherever it is. One unit is a pixel.
fn profile(picture: &image::RgbaImage, at: &Transform, height: f32) -> Vec<f64> {
    let middle = 0.5 * Vec2::new(picture.width() as f32, picture.height() as f32);
    let on_screen = |s: f32| {
        let world = at.transform_point(Vec3::new(s, 0.5 * height, 0.0));
        Vec2::new(middle.x + world.x, middle.y - world.y)
    };
    let along = (on_screen(1.0) - on_screen(0.0)).normalize();
    let width = |p: Vec2| {
        // Columns are half a pixel further right than their numbers.
        let x = p.x - 0.5;
        let column = |x: f32| {
            let y = p.y + (x + 0.5 - p.x) * along.y / along.x;
            let rows = (y - 12.0) as u32..(y + 13.0) as u32;
            black_ink(picture, rows.map(|row| (x as u32, row))) * f64::from(along.x.abs())
        };
        let t = f64::from(x.fract());
        (1.0 - t) * column(x.floor()) + t * column(x.floor() + 1.0)
    };
    (-95..=95)
        .map(|i| width(on_screen(2.0 * i as f32)))
        .collect()
}

/// The pattern goes with its object: along the same edge, the width is the same after the
/// object has moved and turned. Another object has another pattern.
#[test]
fn the_pattern_goes_with_its_object() {
    let size = UVec2::new(480, 360);
    let mut small = before_white(size);
    let height = 60.0;
    let first = wall(&mut small, [-200.0, -30.0], [200.0, 30.0], 300.0);
    let outlines = silhouettes(4.0, pressed(0.8, 24.0));
    let start = Transform::from_xyz(0.0, 0.0, -300.0);
    let at_start = profile(&drawn(&mut small, outlines), &start, height);
    assert!(deviation(&at_start) > 0.5, "{at_start:.2?}");
    let turns = [
        Transform::from_xyz(23.4, -57.3, -300.0),
        Transform::from_xyz(-8.0, 12.0, -200.0).with_rotation(Quat::from_rotation_z(0.4)),
        // About its edge, and away from the camera: the edge is seen shortened.
        start.with_rotation(Quat::from_rotation_x(0.7)),
        start.with_rotation(Quat::from_rotation_y(0.6)),
        Transform::from_xyz(5.5, 3.0, -300.0).with_rotation(Quat::from_euler(
            EulerRot::ZYX,
            -0.3,
            0.4,
            0.5,
        )),
    ];
    for turn in turns {
        small.world().entity_mut(first).insert(turn);
        let found = profile(&drawn(&mut small, outlines), &turn, height);
        let same = correlation(&at_start, &found);
        println!("{turn:?}: {same:.3}");
        assert!(same > 0.9, "{turn:?}: {same}\n{at_start:.2?}\n{found:.2?}");
    }
    small.world().despawn(first);
    // The first one's entity is not used again.
    small.world().spawn_empty();
    wall(&mut small, [-200.0, -30.0], [200.0, 30.0], 300.0);
    let other = profile(&drawn(&mut small, outlines), &start, height);
    let same = correlation(&at_start, &other);
    println!("another object: {same:.3}");
    // About 16 independent widths: chance correlates them by 0.25.
    assert!(same.abs() < 0.6, "{same}");
}

/// Zooming in by an octave in steps of 5 %: at no place of the object does the width change
/// by more than the noise may.
#[test]
fn zooming_changes_widths_gradually() {
    let size = UVec2::new(480, 120);
    let mut small = before_white(size);
    wall(&mut small, [-250.0, -80.0], [250.0, 0.0], 100.0);
    let (width, pressure) = (4.0, 0.9);
    let outlines = silhouettes(width, pressed(pressure, 40.0));
    // Places in the half of the view that remains.
    let places: Vec<f32> = (-13..=13).map(|i| 8.0 * i as f32).collect();
    let mut before: Option<Vec<f64>> = None;
    // The weights of the octaves turn by a quarter of a circle per octave.
    let bound = std::f64::consts::FRAC_PI_2 * 2f64.sqrt() * 1.05f64.log2();
    let bound = f64::from(width * pressure) * bound + 0.15;
    let mut largest: f64 = 0.0;
    for step in 0..=15 {
        let zoom = 1.05f32.powi(step);
        let mut projection = unit_per_pixel(size);
        projection.scale = 1.0 / zoom;
        small.insert(Projection::Orthographic(projection));
        let picture = drawn(&mut small, outlines);
        let columns = ink(&picture, 0..480, 40..80);
        let widths: Vec<f64> = (places.iter())
            .map(|place| {
                let x = f64::from(240.0 + place * zoom - 0.5);
                let (low, t) = (x.floor() as usize, x.fract());
                (1.0 - t) * columns[low] + t * columns[low + 1]
            })
            .collect();
        assert!(deviation(&widths) > 0.4, "{step}: {widths:.2?}");
        for (a, b) in before.iter().flatten().zip(&widths) {
            largest = largest.max((a - b).abs());
        }
        before = Some(widths);
    }
    println!("largest change {largest:.3} px of {bound:.3}");
    assert!(largest < bound, "{largest} px");
    // The octaves do take turns.
    assert!(largest > 0.1, "{largest} px");
}

/// The factors that are drawn are those of the reference, on a surface that is moved, turned and
/// stretched, in perspective.
#[test]
fn drawn_factors_match_the_reference() {
    let size = UVec2::new(96, 64);
    let mut small = Small::new(size, Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        small.clear();
        small.insert(Transform::IDENTITY);
        let turn = Quat::from_euler(EulerRot::XYZ, 0.4, -0.7, 0.2);
        let at = Transform::from_xyz(0.3, -0.2, -7.0)
            .with_rotation(turn)
            .with_scale(Vec3::new(9.0, 4.0, 1.0));
        let board = small.put(Rectangle::new(1.0, 1.0), unlit(Color::WHITE), at);
        let (amount, wavelength) = (0.75, 13.0);
        drawn(&mut small, silhouettes(2.0, pressed(amount, wavelength)));
        let found = small.line_widths().expect("drawn");
        let ids = small.object_ids().expect("drawn");
        let frame = ObjectFrame {
            origin: at.translation.to_array().map(f64::from),
            axes: [Vec3::X, Vec3::Y, Vec3::Z]
                .map(|axis| (turn * (axis * at.scale)).to_array().map(f64::from)),
        };
        let half_height = f64::from(std::f32::consts::FRAC_PI_8).tan();
        let normal = (turn * Vec3::Z).to_array().map(f64::from);
        let seed = u32::from(object_id(board));
        let (mut compared, mut spread) = (0, Vec::new());
        for i in 0..(size.x * size.y) as usize {
            if ids.pixels[i][0] == 0 {
                assert_eq!(found.factors[i], 1.0, "the sky");
                continue;
            }
            let [x, y] = [i as u32 % size.x, i as u32 / size.x].map(|v| f64::from(v) + 0.5);
            let [w, h] = [f64::from(size.x), f64::from(size.y)];
            let ray = [
                (2.0 * x - w) / h * half_height,
                (1.0 - 2.0 * y / h) * half_height,
                -1.0,
            ];
            let dot = |a: [f64; 3], b: [f64; 3]| -> f64 { (0..3).map(|i| a[i] * b[i]).sum() };
            let distance = dot(frame.origin, normal) / dot(ray, normal);
            let world = ray.map(|v| v * distance);
            let pixels = 0.5 * h / half_height / distance * frame.scale();
            let settings = [amount, wavelength].map(f64::from);
            let want = pressure_factor(settings, frame.place(world), pixels, seed);
            let codes = 127.0 * found.factors[i];
            // Half a code of rounding.
            assert!(
                (codes - stored_factor(want)).abs() < 0.55,
                "{msaa:?} ({x}, {y}): {codes}, {want}"
            );
            compared += 1;
            spread.push(want);
        }
        assert!(compared > 1000 && deviation(&spread) > 0.1, "{compared}");
        assert_eq!(small.errors(), 0);
    }
}

/// A plate of several pieces side by side, 60 units high: the left end and the right end of
/// each, and the alpha of its vertices there.
fn plate(pieces: &[([f32; 2], [f32; 2])]) -> Mesh {
    let mut mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    );
    let corners = |values: [f32; 2]| [values[0], values[1], values[1], values[0]];
    let positions: Vec<[f32; 3]> = (pieces.iter())
        .flat_map(|(ends, _)| {
            let rows = [-30.0, -30.0, 30.0, 30.0];
            corners(*ends)
                .into_iter()
                .zip(rows)
                .map(|(x, y)| [x, y, 0.0])
        })
        .collect();
    let colors: Vec<[f32; 4]> = (pieces.iter())
        .flat_map(|(_, alphas)| corners(*alphas).map(|alpha| [1.0, 1.0, 1.0, alpha]))
        .collect();
    let indices = (0..pieces.len() as u32).flat_map(|i| [0, 1, 2, 0, 2, 3].map(|k| 4 * i + k));
    mesh.insert_attribute(
        Mesh::ATTRIBUTE_NORMAL,
        vec![[0.0, 0.0, 1.0]; positions.len()],
    );
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    mesh.insert_indices(Indices::U32(indices.collect()));
    mesh
}

fn put_plate(small: &mut Small, pieces: &[([f32; 2], [f32; 2])]) -> Entity {
    let at = Transform::from_xyz(0.0, -30.0, -100.0);
    small.put(plate(pieces), unlit(Color::WHITE), at)
}

/// The alpha of vertices is the width of lines: 0.5 is the width that lines have otherwise, 0
/// is no line. Without the component, nothing is drawn for it.
#[test]
fn vertices_say_how_wide_lines_are() {
    let size = UVec2::new(400, 80);
    let mut small = before_white(size);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.insert(msaa);
        small.clear();
        let pieces = [
            ([-200.0, -100.0], [0.25; 2]),
            ([-100.0, 0.0], [0.5; 2]),
            ([0.0, 100.0], [1.0; 2]),
            ([100.0, 200.0], [0.0; 2]),
        ];
        let plate = put_plate(&mut small, &pieces);
        let width = 4.0;
        let widths = |small: &mut Small| {
            let picture = drawn(small, silhouettes(width, LineWeight::EVEN));
            let piece = |i: u32| ink(&picture, 100 * i + 20..100 * i + 80, 25..55);
            [0, 1, 2, 3].map(piece)
        };
        for found in widths(&mut small).concat() {
            assert!((found - 4.0).abs() < NEAR, "{msaa:?}: {found}");
        }
        assert!(small.line_widths().is_none(), "no mesh asks for it");
        small
            .world()
            .entity_mut(plate)
            .insert(LineWidths::default());
        let found = widths(&mut small);
        for (found, factor) in found.iter().zip([0.5, 1.0, 2.0, 0.0]) {
            println!("{msaa:?}, {factor}: {:.3}", mean(found));
            for found in found {
                let want = factor * f64::from(width);
                assert!((found - want).abs() < NEAR, "{msaa:?}: {found}, {want}");
            }
        }
        small.world().entity_mut(plate).remove::<LineWidths>();
        for found in widths(&mut small).concat() {
            assert!((found - 4.0).abs() < NEAR, "{msaa:?}: {found}");
        }
        assert!(
            small.line_widths().is_none(),
            "no mesh asks for it any more"
        );
        assert_eq!(small.errors(), 0);
    }
}

/// Between vertices, the width changes in proportion; it multiplies the pressure, and an
/// object without vertex colours keeps its width.
#[test]
fn widths_of_vertices_run_into_each_other() {
    let size = UVec2::new(400, 80);
    let mut small = before_white(size);
    let ramp = put_plate(&mut small, &[([-200.0, 200.0], [0.0, 1.0])]);
    small.world().entity_mut(ramp).insert(LineWidths::default());
    let even = drawn(&mut small, silhouettes(4.0, LineWeight::EVEN));
    for (i, found) in ink(&even, 20..380, 20..60).into_iter().enumerate() {
        let want = 8.0 * (i as f64 + 20.5) / 400.0;
        assert!((found - want).abs() < NEAR, "{i}: {found}, {want}");
    }
    small.clear();
    let plain = wall(&mut small, [-200.0, -60.0], [200.0, 0.0], 100.0);
    small
        .world()
        .entity_mut(plain)
        .insert(LineWidths::default());
    let without = drawn(&mut small, silhouettes(4.0, LineWeight::EVEN));
    for found in ink(&without, 20..380, 20..60) {
        assert!((found - 4.0).abs() < NEAR, "{found}");
    }
    assert_eq!(small.errors(), 0);
}

/// The component of a parent applies to its children, if it says so.
#[test]
fn widths_of_vertices_are_inherited() {
    let size = UVec2::new(400, 80);
    let mut small = before_white(size);
    let plate = put_plate(&mut small, &[([-200.0, 200.0], [1.0; 2])]);
    let parts = (Transform::default(), Visibility::default());
    let root = small.world().spawn(parts).id();
    small.world().entity_mut(root).add_child(plate);
    for (widths, want) in [
        (LineWidths { inherit: false }, 4.0),
        (LineWidths::default(), 8.0),
    ] {
        small.world().entity_mut(root).insert(widths);
        let picture = drawn(&mut small, silhouettes(4.0, LineWeight::EVEN));
        let found = mean(&ink(&picture, 20..380, 20..60));
        assert!((found - want).abs() < NEAR, "{widths:?}: {found}");
    }
}

/// Meshes with sections, skins and morph targets have pipelines of their own. Without
/// pressure, there is no texture.
#[test]
fn widths_are_drawn_of_every_mesh() {
    assert_widths_of_meshes(Msaa::Off);
}

#[test]
#[ignore = "long: pipelines of four samples"]
fn widths_are_drawn_of_every_mesh_in_multisampled_views() {
    assert_widths_of_meshes(Msaa::Sample4);
}

fn assert_widths_of_meshes(msaa: Msaa) {
    let (mut small, _) = skinned_and_morphed();
    let plain = material(&mut small, |_| {});
    let at = Transform::from_xyz(0.0, 1.0, 0.0).with_rotation(Quat::from_rotation_y(0.6));
    let divided = cube(&mut small, plain, at);
    small
        .world()
        .entity_mut(divided)
        .insert((MeshSections::default(), LineWidths::default()));
    let outlines = |pressure| Outlines {
        silhouettes: Some(Silhouettes::default()),
        weight: pressed(pressure, 12.0),
        ..default()
    };
    small.insert(msaa);
    drawn(&mut small, outlines(1.0));
    wait(&mut small, |ids| !none_has_sections(ids));
    let (ids, widths) = (small.object_ids(), small.line_widths());
    let (ids, widths) = (ids.expect("drawn"), widths.expect("drawn"));
    let mut seen: Vec<u32> = ids.pixels.iter().map(|p| p[0]).collect();
    assert!(ids.pixels.iter().any(|p| p[1] >> 8 != 0), "no sections");
    let all = seen.clone();
    seen.sort_unstable();
    seen.dedup();
    for id in seen.into_iter().filter(|id| *id != 0) {
        let own: Vec<f64> = (all.iter().zip(&widths.factors))
            .filter(|(other, _)| **other == id)
            .map(|(_, factor)| *factor)
            .collect();
        assert!(deviation(&own) > 0.1, "{msaa:?}, {id}: even");
    }
    small.world().entity_mut(divided).remove::<LineWidths>();
    drawn(&mut small, outlines(0.0));
    assert!(small.object_ids().is_some() && small.line_widths().is_none());
    assert_eq!(small.errors(), 0);
}
