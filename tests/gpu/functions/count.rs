//! The count of covered pixels without an object id.

use bevy_comics_testkit::wgsl;

use super::{
    bound::{buffer, floats, pairs, texture},
    toon::Numbers,
    *,
};
use crate::prelude::*;

/// Pixels that a workgroup counts: 8 invocations in x and in y, of which each counts a row of 16
/// pixels, and every fourth pixel of every fourth row.
const WORKGROUP: [u32; 2] = [8 * 16 * 4, 8 * 4];

fn pass() -> &'static wgpu::ComputePipeline {
    static PASS: OnceLock<wgpu::ComputePipeline> = OnceLock::new();
    PASS.get_or_init(|| {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/src/objects/depth_test/count.wgsl"
        );
        let source = std::fs::read_to_string(path).expect("the shader");
        let module = wgsl::module(&source, &[]).unwrap_or_else(|error| panic!("{error}"));
        gpu().compute_pipeline(module, "count")
    })
}

/// Depths and ids of a picture, row by row.
struct Picture {
    size: [u32; 2],
    depths: Vec<f32>,
    ids: Vec<[u32; 2]>,
}

impl Picture {
    /// Only depths above 0 are covered, and only the first number is an id.
    fn new(size: [u32; 2], n: &mut Numbers) -> Self {
        let count = (size[0] * size[1]) as usize;
        let depths = [0.0, -0.0, -0.5, 1e-30, 1e-7, 0.25, 1.0];
        let ids = [[0, 0], [0, 7], [1, 0], [u32::MAX, 3]];
        let mut pick = |length: usize| ((n.part() * length as f32) as usize).min(length - 1);
        Self {
            size,
            depths: (0..count).map(|_| depths[pick(depths.len())]).collect(),
            ids: (0..count).map(|_| ids[pick(ids.len())]).collect(),
        }
    }

    /// What the shipped pass counts in a viewport (origin and size).
    fn counted(&self, viewport: [u32; 4]) -> [u32; 2] {
        let gpu = gpu();
        let depths = floats(self.size, &self.depths);
        let ids = pairs(self.size, &self.ids);
        let bytes: Vec<u8> = viewport.iter().flat_map(|n| n.to_le_bytes()).collect();
        let rectangle = gpu.buffer(&bytes, wgpu::BufferUsages::UNIFORM);
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let found = gpu.buffer(&[0; 8], usage);
        let entries = [
            texture(0, &depths),
            texture(1, &ids),
            buffer(2, &rectangle),
            buffer(3, &found),
        ];
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pass().get_bind_group_layout(0),
            entries: &entries,
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut compute = encoder.begin_compute_pass(&Default::default());
            compute.set_pipeline(pass());
            compute.set_bind_group(0, &group, &[]);
            // One workgroup more in each direction counts nothing.
            let [x, y] = [0, 1].map(|k| viewport[2 + k].div_ceil(WORKGROUP[k]) + 1);
            compute.dispatch_workgroups(x, y, 1);
        }
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.read(&found);
        [0, 4].map(|k| u32::from_le_bytes([bytes[k], bytes[k + 1], bytes[k + 2], bytes[k + 3]]))
    }

    /// The same, pixel by pixel: every fourth one of every fourth row. What lies beyond the picture
    /// is as at its border.
    fn scanned(&self, [left, top, width, height]: [u32; 4]) -> [u32; 2] {
        let [columns, rows] = self.size;
        let mut found = [0, 0];
        for y in (0..height).step_by(4) {
            for x in (0..width).step_by(4) {
                let at = (top + y).min(rows - 1) * columns + (left + x).min(columns - 1);
                if self.depths[at as usize] > 0.0 {
                    found[0] += 1;
                    found[1] += u32::from(self.ids[at as usize][0] == 0);
                }
            }
        }
        found
    }
}

/// Whole pictures and parts of them, up to several workgroups in both directions.
#[test]
fn covered_pixels_and_those_without_an_id_are_counted() {
    let mut n = Numbers::new(91);
    let cases = [
        ([1, 1], [0, 0, 1, 1]),
        ([4, 4], [0, 0, 4, 4]),
        ([5, 5], [0, 0, 5, 5]),
        ([5, 5], [4, 4, 1, 1]),
        ([70, 40], [0, 0, 70, 40]),
        // Beside the viewport is depth of other cameras.
        ([70, 40], [3, 5, 61, 30]),
        ([70, 40], [0, 0, 64, 32]),
        ([70, 40], [0, 0, 65, 33]),
        ([70, 40], [0, 0, 0, 0]),
        // Beyond the picture.
        ([70, 40], [50, 30, 90, 70]),
        ([1100, 70], [0, 0, 1100, 70]),
        ([1100, 70], [513, 33, 520, 36]),
    ];
    let mut all = [0, 0];
    for (size, viewport) in cases {
        let picture = Picture::new(size, &mut n);
        let found = picture.counted(viewport);
        assert_eq!(found, picture.scanned(viewport), "{size:?}, {viewport:?}");
        all = [0, 1].map(|k| all[k] + found[k]);
    }
    assert!(all[1] > 1000 && all[0] > all[1] + 1000, "{all:?}");
}
