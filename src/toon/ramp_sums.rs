//! Sums of the tones that are painted in images.

use bevy::{
    asset::{LoadState, RenderAssetUsages},
    ecs::system::SystemParam,
    image::TextureFormatPixelInfo,
    platform::collections::HashMap,
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};

use super::{RampMap, ToonMaterial, ramp_map::Sums};
use crate::settings::clamp_or_default;

/// The sums of an image: texel `k` of a row is the sum of the first `k` texels of that row, in
/// linear light.
///
/// Texels are rounded so that every sum is exact: a flat part of a row has one color, wherever it
/// begins. With 1024 texels, they are multiples of 2^-14.
fn sums_of(image: &Image) -> Result<Image, String> {
    let [width, height] = size_of(image)?;
    let exact = 2f64.powi(24) / f64::from(width.next_power_of_two());
    let mut bytes = Vec::with_capacity(16 * (width as usize + 1) * height as usize);
    for y in 0..height {
        let mut sum = [0.0; 3];
        for x in 0..=width {
            let texel = [sum[0], sum[1], sum[2], 1.0].map(|c: f64| c as f32);
            bytes.extend(texel.into_iter().flat_map(f32::to_le_bytes));
            if x < width {
                let color = image
                    .get_color_at(x, y)
                    .map_err(|error| error.to_string())?;
                for (sum, c) in sum.iter_mut().zip(color.to_linear().to_f32_array()) {
                    let c = f64::from(clamp_or_default(c, 0.0, 0.0, 1.0));
                    *sum += (c * exact).round() / exact;
                }
            }
        }
    }
    let size = Extent3d {
        width: width + 1,
        height,
        depth_or_array_layers: 1,
    };
    Ok(Image::new(
        size,
        TextureDimension::D2,
        bytes,
        TextureFormat::Rgba32Float,
        RenderAssetUsages::RENDER_WORLD,
    ))
}

/// The size of an image of tones, in texels.
fn size_of(image: &Image) -> Result<[u32; 2], String> {
    let texture = &image.texture_descriptor;
    let size = texture.size;
    let most = RampMap::LARGEST;
    if texture.dimension != TextureDimension::D2 || size.depth_or_array_layers != 1 {
        return Err("it is not an image of two dimensions".into());
    }
    if !(2..=most).contains(&size.width) || !(1..=most).contains(&size.height) {
        let [width, height] = [size.width, size.height];
        return Err(format!(
            "it has {width}x{height} texels; a ramp has 2 to {most} columns and 1 to {most} rows"
        ));
    }
    let format = texture.format;
    if format.is_depth_stencil_format() || format.is_multi_planar_format() {
        return Err(format!("its format has no colors: {format:?}"));
    }
    let Ok(texel) = format.pixel_size() else {
        return Err(format!("its format is compressed: {format:?}"));
    };
    let Some(data) = &image.data else {
        return Err("its data is not kept in the main world (see `RenderAssetUsages`)".into());
    };
    if data.len() < texel * size.width as usize * size.height as usize {
        return Err("it has less data than texels".into());
    }
    Ok([size.width, size.height])
}

enum Found {
    Sums(Handle<Image>),
    Unusable,
    /// Its file could not be loaded.
    Missing,
}

/// The sums of all images of tones that materials have had.
#[derive(Resource, Default)]
pub(super) struct RampSums(HashMap<AssetId<Image>, Found>);

/// What images are read from, and their sums are added to.
#[derive(SystemParam)]
pub(super) struct RampImages<'w> {
    images: ResMut<'w, Assets<Image>>,
    server: Res<'w, AssetServer>,
    known: ResMut<'w, RampSums>,
}

impl RampImages<'_> {
    /// Forgets the sums of an image that is gone or has changed.
    fn follow(&mut self, event: &AssetEvent<Image>) {
        let known = &mut self.known.0;
        match event {
            AssetEvent::Removed { id } | AssetEvent::Unused { id } => {
                known.remove(id);
            }
            // The sums of what only the render world has stay.
            AssetEvent::Modified { id }
                if self.images.get(*id).is_some_and(|i| i.data.is_some()) =>
            {
                known.remove(id);
            }
            // A missing file that is there now.
            AssetEvent::Added { id } if matches!(known.get(id), Some(Found::Missing)) => {
                known.remove(id);
            }
            _ => {}
        }
    }

    /// Finds the sums of an image. `None`: it is still loading.
    fn find(&self, id: AssetId<Image>) -> Option<Result<Image, String>> {
        match self.images.get(id) {
            Some(image) => Some(sums_of(image)),
            None => match self.server.load_state(id) {
                LoadState::Failed(error) => Some(Err(error.to_string())),
                _ => None,
            },
        }
    }

    /// A map with what is known of it.
    fn with_sums(&mut self, map: &RampMap) -> RampMap {
        let mut map = map.clone().loaded(|path| self.server.load(path));
        let Some(image) = &map.image else {
            return map;
        };
        let id = image.id();
        if !self.known.0.contains_key(&id)
            && let Some(sums) = self.find(id)
        {
            let is_there = self.images.contains(id);
            let found = match sums {
                Ok(sums) => Found::Sums(self.images.add(sums)),
                Err(why) => {
                    warn!("ramp map {image:?}: {why}. The stops of the ramp are drawn instead");
                    if is_there {
                        Found::Unusable
                    } else {
                        Found::Missing
                    }
                }
            };
            self.known.0.insert(id, found);
        }
        map.sums = match self.known.0.get(&id) {
            Some(Found::Sums(sums)) => Sums::Ready(sums.clone()),
            Some(_) => Sums::None,
            None => Sums::Unknown,
        };
        map
    }
}

/// Gives materials the sums of their images, also when these change.
pub(super) fn sum_ramp_maps(
    mut events: MessageReader<AssetEvent<Image>>,
    mut images: RampImages,
    mut materials: ResMut<Assets<ToonMaterial>>,
) {
    for event in events.read() {
        images.follow(event);
    }
    let changed: Vec<_> = materials
        .iter()
        .filter_map(|(id, material)| {
            let map = &material.extension.ramp_map;
            if map.is_none() {
                return None;
            }
            let known = images.with_sums(map);
            (known.sums != map.sums || known.image != map.image).then_some((id, known))
        })
        .collect();
    for (id, map) in changed {
        if let Some(mut material) = materials.get_mut(id) {
            material.extension.ramp_map = map;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(size: [u32; 2], format: TextureFormat, data: Vec<u8>) -> Image {
        Image::new(
            Extent3d {
                width: size[0],
                height: size[1],
                depth_or_array_layers: 1,
            },
            TextureDimension::D2,
            data,
            format,
            RenderAssetUsages::default(),
        )
    }

    fn numbers(image: &Image) -> Vec<[f32; 4]> {
        let bytes = image.data.as_deref().expect("data");
        let number = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        let texel = |b: &[u8]| [0, 4, 8, 12].map(|k| number(&b[k..]));
        bytes.chunks_exact(16).map(texel).collect()
    }

    /// Codes that shading random, for a row of the largest width.
    fn codes() -> Vec<u8> {
        let texel = |k: u32| {
            let hash = k.wrapping_mul(2_654_435_761);
            [
                (hash >> 8) as u8,
                (hash >> 16) as u8,
                (hash >> 24) as u8,
                255,
            ]
        };
        (0..RampMap::LARGEST).flat_map(texel).collect()
    }

    /// Differences of sums are the texels, wherever they lie in a row.
    #[test]
    fn differences_of_sums_are_the_texels() {
        let codes = codes();
        let row = image(
            [RampMap::LARGEST, 1],
            TextureFormat::Rgba8UnormSrgb,
            codes.clone(),
        );
        let sums = numbers(&sums_of(&row).expect("sums"));
        assert_eq!(sums.len(), RampMap::LARGEST as usize + 1);
        let mut by_code = HashMap::<u8, f32>::default();
        for (k, pair) in sums.windows(2).enumerate() {
            for c in 0..3 {
                let code = codes[4 * k + c];
                let part = f64::from(code) / 255.0;
                // IEC 61966-2-1.
                let wanted = match part <= 0.040_45 {
                    true => part / 12.92,
                    false => ((part + 0.055) / 1.055).powf(2.4),
                };
                let found = pair[1][c] - pair[0][c];
                assert!((f64::from(found) - wanted).abs() < 0.5 / 16384.0 + 1e-6);
                assert_eq!(*by_code.entry(code).or_insert(found), found, "exact");
            }
        }
    }

    #[test]
    fn rows_and_formats_are_told_apart() {
        let linear = image(
            [2, 2],
            TextureFormat::Rgba8Unorm,
            vec![
                0, 51, 255, 0, 255, 102, 0, 0, //
                51, 0, 0, 255, 0, 0, 0, 255,
            ],
        );
        let sums = numbers(&sums_of(&linear).expect("sums"));
        let close =
            |found: [f32; 4], wanted: [f32; 3]| (0..3).all(|c| (found[c] - wanted[c]).abs() < 1e-6);
        assert!(close(sums[0], [0.0; 3]) && close(sums[3], [0.0; 3]));
        assert!(close(sums[1], [0.0, 0.2, 1.0]) && close(sums[2], [1.0, 0.6, 1.0]));
        assert!(close(sums[4], [0.2, 0.0, 0.0]) && close(sums[5], [0.2, 0.0, 0.0]));
        let bright: Vec<u8> = [9.0f32, -1.0, f32::NAN, 1.0, 0.25, f32::INFINITY, 0.5, 0.0]
            .into_iter()
            .flat_map(f32::to_le_bytes)
            .collect();
        let wide = image([2, 1], TextureFormat::Rgba32Float, bright);
        let sums = numbers(&sums_of(&wide).expect("sums"));
        assert!(close(sums[1], [1.0, 0.0, 0.0]) && close(sums[2], [1.25, 0.0, 0.5]));
    }

    #[test]
    fn bad_images_are_named() {
        let why = |image: &Image| sums_of(image).expect_err("it is bad");
        let rgba = TextureFormat::Rgba8Unorm;
        let wide = image([1025, 1], rgba, vec![0; 4 * 1025]);
        assert!(why(&wide).contains("1025x1"));
        let narrow = image([1, 4], rgba, vec![0; 16]);
        assert!(why(&narrow).contains("1x4"));
        let mut empty = image([2, 1], rgba, vec![0; 8]);
        empty.texture_descriptor.size.height = 0;
        assert!(why(&empty).contains("2x0"));
        let mut gone = image([2, 1], rgba, vec![0; 8]);
        gone.data = None;
        assert!(why(&gone).contains("main world"));
        let mut short = image([2, 1], rgba, vec![0; 8]);
        short.texture_descriptor.size.width = 8;
        assert!(why(&short).contains("less data"));
        let mut packed = image([4, 4], rgba, vec![0; 64]);
        packed.texture_descriptor.format = TextureFormat::Bc1RgbaUnorm;
        assert!(why(&packed).contains("compressed"));
        let mut solid = image([2, 2], rgba, vec![0; 16]);
        solid.texture_descriptor.dimension = TextureDimension::D3;
        assert!(why(&solid).contains("two dimensions"));
        let odd = image([2, 1], TextureFormat::Rgba8Snorm, vec![0; 8]);
        assert!(why(&odd).contains("Rgba8Snorm"));
    }
}
