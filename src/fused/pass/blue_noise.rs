//! A tile of blue noise: the order in which grains are printed as a tone grows.

use bevy::{
    ecs::resource::Resource,
    math::UVec2,
    render::{
        render_resource::{
            TextureDataOrder, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor,
        },
        renderer::{RenderDevice, RenderQueue},
    },
};

use crate::gpu::texture;

/// Grains across and down the tile.
const SIDE: usize = 64;
/// The rank of every grain in 256 classes, row by row, by void and cluster (Ulichney 1993).
const CLASSES: &[u8; SIDE * SIDE] = include_bytes!("blue_noise.bin");

/// The tile as a texture, once an effect has needed it.
#[derive(Resource, Default)]
pub(crate) struct BlueNoise(Option<TextureView>);

impl BlueNoise {
    /// Makes the texture if there is none yet.
    pub fn prepare(&mut self, device: &RenderDevice, queue: &RenderQueue) {
        self.0.get_or_insert_with(|| {
            let described = texture(
                "comics_blue_noise",
                (UVec2::splat(SIDE as u32), 1),
                TextureFormat::Rgba32Uint,
                TextureUsages::TEXTURE_BINDING,
            );
            device
                .create_texture_with_data(
                    queue,
                    &described,
                    TextureDataOrder::default(),
                    &around(CLASSES),
                )
                .create_view(&TextureViewDescriptor::default())
        });
    }

    pub fn view(&self) -> Option<&TextureView> {
        self.0.as_ref()
    }
}

/// Where the part of the tile of each plate begins, in plates.
const PLATE: [usize; 2] = [19, 37];

/// All that a pixel shows of four plates, for every place: of each plate the classes of the grain
/// at the place, and of those to its right, below it, and to the right below it.
fn around(classes: &[u8]) -> Vec<u8> {
    let of = |x: usize, y: usize| classes[y % SIDE * SIDE + x % SIDE];
    let texel = |i: usize| {
        (0..4).flat_map(move |plate| {
            let x = i % SIDE + plate * PLATE[0];
            let y = i / SIDE + plate * PLATE[1];
            [of(x, y), of(x + 1, y), of(x, y + 1), of(x + 1, y + 1)]
        })
    };
    (0..SIDE * SIDE).flat_map(texel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texel_has_what_a_pixel_shows_of_each_plate() {
        let texels = around(CLASSES);
        for (x, y) in [(0, 0), (5, 9), (63, 20), (17, 63), (63, 63)] {
            let texel = &texels[16 * (y * SIDE + x)..][..16];
            for (plate, found) in texel.chunks(4).enumerate() {
                let of = |right: usize, down: usize| {
                    let column = (x + 19 * plate + right) % SIDE;
                    let row = (y + 37 * plate + down) % SIDE;
                    CLASSES[row * SIDE + column]
                };
                assert_eq!(found, [of(0, 0), of(1, 0), of(0, 1), of(1, 1)], "{x}, {y}");
            }
        }
    }
}
