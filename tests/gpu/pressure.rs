//! The widths of lines that come from objects: pressure, and the widths of vertices.

use bevy::mesh::PrimitiveTopology;
use bevy_comics::objects::LineWidths;

use crate::{
    ids::{cube, material, skinned_and_morphed},
    line_scenes::{deviation, mean, silhouettes, turned},
    prelude::*,
    sections::{none_has_sections, wait},
    walls::{towards_the_sky, wall},
};

/// Silhouettes of 4 pixels.
fn lines(weight: LineWeight) -> Outlines {
    Outlines {
        weight,
        ..silhouettes(4.0)
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
    small.camera_settings().clear_color = Color::WHITE.into();
    small
}

/// Ink of every column between two rows.
fn ink(picture: &image::RgbaImage, columns: Range<u32>, rows: Range<u32>) -> Vec<f64> {
    let column = |x: u32| black_ink(picture, rows.clone().map(|y| (x, y)));
    columns.map(column).collect()
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
    for pressure in [0.0, 0.25, 0.5, 1.0] {
        let picture = small.outlined(lines(pressed(pressure, 20.0)));
        let rows = rims.iter().map(|y| (100.0 - y) as u32);
        let widths = rows.flat_map(|row| ink(&picture, 10..990, row - 9..row + 9));
        let widths: Vec<f64> = widths.collect();
        let middle = mean(&widths);
        // About 400 independent widths of relative deviation 0.37: 2 % of the pressure.
        let bound = 0.02 + 0.06 * f64::from(pressure);
        assert!((middle / 4.0 - 1.0).abs() < bound, "{pressure}: {middle}");
        // That of the noise is 0.37; a line cannot follow all of it.
        let spread = deviation(&widths);
        let relative = spread / (4.0 * f64::from(pressure).max(1e-6));
        let is_spread = if pressure > 0.0 {
            (0.25..0.42).contains(&relative)
        } else {
            spread < 0.01
        };
        assert!(is_spread, "{pressure}: {spread}, {relative}");
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
/// object has moved and turned. Other objects have other patterns.
#[test]
fn the_pattern_goes_with_its_object() {
    let size = UVec2::new(480, 360);
    let mut small = before_white(size);
    let height = 60.0;
    let first = wall(&mut small, [-200.0, -30.0], [200.0, 30.0], 300.0);
    let outlines = lines(pressed(0.8, 24.0));
    let start = Transform::from_xyz(0.0, 0.0, -300.0);
    let at_start = profile(&small.outlined(outlines), &start, height);
    assert!(deviation(&at_start) > 0.5, "{at_start:.2?}");
    for turn in [
        Transform::from_xyz(23.4, -57.3, -300.0),
        turned(-8.0, 12.0, -200.0, 0.4),
        // About its edge, and away from the camera: the edge is seen shortened.
        start.with_rotation(Quat::from_rotation_x(0.7)),
        start.with_rotation(Quat::from_rotation_y(0.6)),
        Transform::from_xyz(5.5, 3.0, -300.0).with_rotation(Quat::from_euler(
            EulerRot::ZYX,
            -0.3,
            0.4,
            0.5,
        )),
    ] {
        small.on(first).insert(turn);
        let found = profile(&small.outlined(outlines), &turn, height);
        let same = correlation(&at_start, &found);
        assert!(same > 0.9, "{turn:?}: {same}\n{at_start:.2?}\n{found:.2?}");
    }
    small.world().despawn(first);
    let others = 4;
    let sum: f64 = (0..others)
        .map(|_| {
            // No entity is used again.
            small.world().spawn_empty();
            let other = wall(&mut small, [-200.0, -30.0], [200.0, 30.0], 300.0);
            let found = profile(&small.outlined(outlines), &start, height);
            small.world().despawn(other);
            correlation(&at_start, &found)
        })
        .sum();
    // About 16 independent widths: chance correlates two objects by 0.25, and this mean by 0.125.
    let same = sum / f64::from(others);
    assert!(same.abs() < 0.6, "{same}");
}

/// How often widths go from a third of a pixel below their mean to as much above it, or back.
fn waves(widths: &[f64]) -> usize {
    let middle = mean(widths);
    let far = widths.iter().filter(|width| (*width - middle).abs() > 0.33);
    let sides: Vec<bool> = far.map(|width| *width > middle).collect();
    sides.windows(2).filter(|two| two[0] != two[1]).count()
}

/// Truth: waves are as long on the screen at every distance and at every size of the object, in
/// perspective too. In 980 pixels, with a random number about every 20, widths cross their mean
/// some 20 to 40 times.
#[test]
fn waves_are_as_long_at_every_distance() {
    let mut small = before_white(UVec2::new(1000, 80));
    small.insert(Projection::default());
    for (distance, scale) in [(30.0, 1.0), (200.0, 1.0), (200.0, 0.01)] {
        small.clear();
        // Units in which a pixel is one.
        let pixel = 2.0 * distance * (std::f32::consts::PI / 8.0).tan() / 80.0;
        let size = Vec2::new(1040.0, 60.0) * pixel / scale;
        let at = Transform::from_xyz(0.0, -30.0 * pixel, -distance);
        let at = at.with_scale(Vec3::splat(scale));
        small.put(Rectangle::new(size.x, size.y), unlit(Color::WHITE), at);
        let picture = small.outlined(lines(pressed(0.8, 20.0)));
        let count = waves(&ink(&picture, 10..990, 25..55));
        assert!((12..60).contains(&count), "{distance}, {scale}: {count}");
    }
}

/// The left end and the right end of a piece of a plate, and the alpha of its vertices there.
struct Piece {
    ends: [f32; 2],
    alphas: [f32; 2],
}

/// A plate of several pieces side by side, 60 units high.
fn put_plate(small: &mut Small, pieces: &[Piece]) -> Entity {
    let triangles = PrimitiveTopology::TriangleList;
    let mut mesh = Mesh::new(triangles, RenderAssetUsages::default());
    let corners = |values: [f32; 2]| [values[0], values[1], values[1], values[0]];
    let rows = [-30.0, -30.0, 30.0, 30.0];
    let positions = pieces.iter().flat_map(|piece| {
        let places = corners(piece.ends).into_iter().zip(rows);
        places.map(|(x, y)| [x, y, 0.0])
    });
    let positions: Vec<[f32; 3]> = positions.collect();
    let alphas = pieces.iter().flat_map(|piece| corners(piece.alphas));
    let colors: Vec<[f32; 4]> = alphas.map(|alpha| [1.0, 1.0, 1.0, alpha]).collect();
    let indices = (0..pieces.len() as u32).flat_map(|i| [0, 1, 2, 0, 2, 3].map(|k| 4 * i + k));
    let normals = vec![[0.0, 0.0, 1.0]; positions.len()];
    mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, normals);
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    mesh.insert_indices(Indices::U32(indices.collect()));
    let at = Transform::from_xyz(0.0, -30.0, -100.0);
    small.put(mesh, unlit(Color::WHITE), at)
}

/// The widths of even lines are these, in columns of one picture.
fn assert_even(small: &mut Small, parts: &[(Range<u32>, f64)]) {
    let picture = small.outlined(lines(LineWeight::EVEN));
    for (columns, want) in parts {
        for found in ink(&picture, columns.clone(), 25..55) {
            assert!((found - want).abs() < NEAR, "{found}, {want}");
        }
    }
}

/// The alpha of vertices is the width of lines: 0.5 is the width that lines have otherwise, 0
/// is no line. Without the component, nothing is drawn for it.
#[test]
fn vertices_say_how_wide_lines_are() {
    let mut small = before_white(UVec2::new(400, 80));
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.insert(msaa);
        small.clear();
        let alphas = [0.25, 0.5, 1.0, 0.0];
        let piece = |i: usize| Piece {
            ends: [100.0 * i as f32 - 200.0, 100.0 * i as f32 - 100.0],
            alphas: [alphas[i]; 2],
        };
        let plate = put_plate(&mut small, &[0, 1, 2, 3].map(piece));
        for with in [false, true, false] {
            if with {
                small.on(plate).insert(LineWidths::default());
            } else {
                small.on(plate).remove::<LineWidths>();
            }
            let parts = (0..).zip(alphas).map(|(i, alpha)| {
                let want = if with { 8.0 * alpha } else { 4.0 };
                (100 * i + 20..100 * i + 80, f64::from(want))
            });
            assert_even(&mut small, &parts.collect::<Vec<_>>());
            assert_eq!(small.line_widths().is_some(), with, "{msaa:?}");
        }
    }
}

/// The plate in one piece.
fn put_ramp(small: &mut Small, alphas: [f32; 2]) -> Entity {
    let ends = [-200.0, 200.0];
    put_plate(small, &[Piece { ends, alphas }])
}

/// Between vertices, the width changes in proportion. An object without vertex colors keeps its
/// width. The component of a parent applies to its children, if it says so.
#[test]
fn widths_of_vertices_run_into_each_other_and_are_inherited() {
    let mut small = before_white(UVec2::new(400, 80));
    let ramp = put_ramp(&mut small, [0.0, 1.0]);
    small.on(ramp).insert(LineWidths::default());
    let even = small.outlined(lines(LineWeight::EVEN));
    for (i, found) in ink(&even, 20..380, 20..60).into_iter().enumerate() {
        let want = 8.0 * (i as f64 + 20.5) / 400.0;
        assert!((found - want).abs() < NEAR, "{i}: {found}, {want}");
    }
    small.clear();
    let plain = wall(&mut small, [-200.0, -60.0], [200.0, 0.0], 100.0);
    small.on(plain).insert(LineWidths::default());
    assert_even(&mut small, &[(20..380, 4.0)]);
    small.clear();
    let plate = put_ramp(&mut small, [1.0; 2]);
    let parts = (Transform::default(), Visibility::default());
    let root = small.world().spawn(parts).add_child(plate).id();
    small.on(root).insert(LineWidths { inherit: false });
    assert_even(&mut small, &[(20..380, 4.0)]);
    small.on(root).insert(LineWidths::default());
    assert_even(&mut small, &[(20..380, 8.0)]);
    // Pressure multiplies them.
    small.clear();
    let thin = put_ramp(&mut small, [0.25; 2]);
    small.on(thin).insert(LineWidths::default());
    let pressed = small.outlined(lines(pressed(0.5, 20.0)));
    let widths = ink(&pressed, 20..380, 20..60);
    let (middle, spread) = (mean(&widths), deviation(&widths));
    assert!((middle / 2.0 - 1.0).abs() < 0.2, "{middle}");
    assert!((0.15..0.5).contains(&spread), "{spread}");
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
    let parts = (MeshSections::default(), LineWidths::default());
    small.on(divided).insert(parts);
    let outlines = |pressure| Outlines {
        weight: pressed(pressure, 12.0),
        ..default()
    };
    small.insert(msaa);
    small.outlined(outlines(1.0));
    wait(&mut small, |ids| !none_has_sections(ids));
    let widths = small.line_widths().expect("drawn");
    let mut by_id = HashMap::<u32, Vec<f64>>::new();
    for (id, factor) in small.ids().into_iter().zip(widths.factors) {
        by_id.entry(id).or_default().push(factor);
    }
    for (id, own) in by_id.into_iter().filter(|(id, _)| *id != 0) {
        assert!(deviation(&own) > 0.1, "{msaa:?}, {id}: even");
    }
    small.on(divided).remove::<LineWidths>();
    small.outlined(outlines(0.0));
    assert!(small.object_ids().is_some() && small.line_widths().is_none());
}
