//! How straight lines are: where they are drawn along edges of 64 slopes at 16 offsets, and how
//! wide.

use bevy::{
    asset::RenderAssetUsages,
    camera::ScalingMode,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use bevy_comics::{ComicStyle, Outlines};
use bevy_comics_testkit::{
    reference::color::srgb_decode,
    straight_edges::{distance, offsets, slopes},
};

use crate::{
    Run,
    models::Studio,
    rig::{Drawn, Rig},
    table::Table,
};

/// Columns that are measured, and those beside them: more than the 64 cracks of the longest run.
const COLUMNS: usize = 200;
const MARGIN: usize = 80;
/// Rows from edge to edge.
const APART: f64 = 26.0;

/// What is measured of the line along an edge.
#[derive(Default)]
struct Line {
    /// Across the line, in every column.
    widths: Vec<f64>,
    /// The sum of the squares of the distances of the ink's middle from the edge.
    squares: f64,
}

/// Eight walls between 16 edges of a slope, one unit per pixel, and where these cross the left
/// border.
fn walls(slope: f64, size: UVec2) -> (Mesh, [f64; 16]) {
    let fractions = offsets();
    let starts = std::array::from_fn(|n| 20.0 + n as f64 * APART + fractions[n]);
    let [half_width, half_height] = [size.x, size.y].map(|n| 0.5 * f64::from(n));
    let ends = [-half_width - 40.0, half_width + 40.0];
    let mut positions: Vec<[f32; 3]> = vec![];
    for pair in starts.chunks(2) {
        for (x, start) in [
            (ends[0], pair[0]),
            (ends[1], pair[0]),
            (ends[1], pair[1]),
            (ends[0], pair[1]),
        ] {
            let y = half_height - start - slope * (x + half_width);
            positions.push([x as f32, y as f32, -10.0]);
        }
    }
    let indices = (0..8).flat_map(|wall| [0, 1, 2, 0, 2, 3].map(|corner| 4 * wall + corner));
    let mut mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    );
    mesh.insert_indices(Indices::U32(indices.collect()));
    mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 32]);
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    (mesh, starts)
}

/// Measures the line along an edge, column by column.
fn line(picture: &image::RgbaImage, slope: f64, start: f64) -> Line {
    let cosine = 1.0 / slope.hypot(1.0);
    let mut found = Line::default();
    for x in MARGIN..MARGIN + COLUMNS {
        let across = x as f64 + 0.5;
        let middle = start + slope * across;
        let rows = (middle - 0.5 * APART).ceil() as u32..(middle + 0.5 * APART).floor() as u32;
        let (mut sum, mut moment) = (0.0, 0.0);
        for y in rows {
            let code = picture.get_pixel(x as u32, y).0[1];
            let ink = 1.0 - srgb_decode([f64::from(code) / 255.0; 3])[1];
            sum += ink;
            moment += ink * (f64::from(y) + 0.5);
        }
        found.widths.push(sum * cosine);
        found.squares += distance(slope, start, [across, moment / sum]).powi(2);
    }
    found
}

fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().sum::<f64>() / values.count() as f64
}

pub fn measure(run: &Run) -> Result<(), String> {
    let size = UVec2::new((COLUMNS + 2 * MARGIN) as u32, 800);
    let outlines = |width| Outlines {
        width,
        ink_budget: 1.0,
        ..Outlines::SILHOUETTES
    };
    let mut studio = Studio::new(size, outlines(2.0));
    let Rig {
        headless, camera, ..
    } = &mut studio.rig;
    headless.app.world_mut().entity_mut(*camera).insert((
        Transform::IDENTITY,
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::Fixed {
                width: size.x as f32,
                height: size.y as f32,
            },
            ..OrthographicProjection::default_3d()
        }),
    ));
    let mut table = Table::new("width,slope,mean,most,uneven,away");
    let stride = if run.quick { 16 } else { 1 };
    for slope in slopes().step_by(stride) {
        let (mesh, starts) = walls(slope, size);
        studio.show_meshes(vec![mesh]);
        for width in [1.0, 2.0, 3.0, 5.0, 8.0f32] {
            let style = ComicStyle::new().with(outlines(width));
            studio.rig.set_drawn(&Drawn::style(style));
            studio.rig.headless.step(4);
            let picture = studio.rig.headless.picture();
            let lines = starts.map(|start| line(&picture, slope, start));
            let off = |line: &Line| mean(line.widths.iter().copied()) - f64::from(width);
            let uneven = |line: &Line| {
                let middle = mean(line.widths.iter().copied());
                mean(line.widths.iter().map(|w| (w - middle).powi(2))).sqrt()
            };
            let largest = |values: [f64; 16]| {
                let by_size = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
                values.into_iter().fold(0.0, by_size)
            };
            let squares = mean(lines.iter().map(|line| line.squares / COLUMNS as f64));
            table.push(&[
                &width,
                &slope,
                &format!("{:.5}", mean(lines.iter().map(off))),
                &format!("{:.5}", largest(lines.each_ref().map(off))),
                &format!("{:.5}", largest(lines.each_ref().map(uneven))),
                &format!("{:.5}", squares.sqrt()),
            ]);
        }
    }
    run.say("straight lines measured");
    run.save("ink_straight", &table)
}
