//! Few colors for many pictures, by median cut (Heckbert 1982).

use std::collections::HashMap;

use image::RgbaImage;

type Code = [u8; 3];

/// A palette, and the place of each color of the pictures in it.
pub struct Palette {
    pub colors: Vec<Code>,
    places: HashMap<Code, u8>,
}

/// Colors with how many pixels have them.
type Counted = Vec<(Code, usize)>;

/// The channel in which colors differ most, and by how much.
fn widest(colors: &Counted) -> (usize, u8) {
    let extent = |i: usize| {
        let values = || colors.iter().map(|(color, _)| color[i]);
        values().max().unwrap_or(0) - values().min().unwrap_or(0)
    };
    let channels = [0, 1, 2].map(|i| (i, extent(i)));
    let most = channels.into_iter().max_by_key(|(_, extent)| *extent);
    most.unwrap_or((0, 0))
}

/// Divides colors into two groups with as many pixels.
fn divide(mut colors: Counted) -> [Counted; 2] {
    let (channel, _) = widest(&colors);
    colors.sort_unstable_by_key(|(color, _)| (color[channel], *color));
    let half = colors.iter().map(|(_, count)| count).sum::<usize>() / 2;
    let mut sum = 0;
    let middle = colors.iter().position(|(_, count)| {
        sum += count;
        sum > half
    });
    let middle = middle.unwrap_or(0).clamp(1, colors.len() - 1);
    let upper = colors.split_off(middle);
    [colors, upper]
}

fn mean(colors: &Counted) -> Code {
    let all = colors.iter().map(|(_, count)| count).sum::<usize>().max(1);
    [0, 1, 2].map(|i| {
        let sum: usize = colors.iter().map(|(c, n)| usize::from(c[i]) * n).sum();
        ((sum + all / 2) / all) as u8
    })
}

impl Palette {
    pub fn of(pictures: &[RgbaImage], size: usize) -> Self {
        let mut counts: HashMap<Code, usize> = HashMap::new();
        for pixel in pictures.iter().flat_map(RgbaImage::pixels) {
            *counts.entry([pixel[0], pixel[1], pixel[2]]).or_default() += 1;
        }
        let mut all: Counted = counts.into_iter().collect();
        all.sort_unstable();
        let mut groups = vec![all];
        while groups.len() < size {
            // The group with the largest differences of many pixels.
            let weight = |group: &Counted| {
                let pixels: usize = group.iter().map(|(_, count)| count).sum();
                f64::from(widest(group).1) * (pixels as f64).sqrt()
            };
            let places = (0..groups.len()).filter(|k| groups[*k].len() > 1);
            let most = places.max_by(|a, b| weight(&groups[*a]).total_cmp(&weight(&groups[*b])));
            let Some(most) = most else { break };
            let parts = divide(groups.swap_remove(most));
            groups.extend(parts);
        }
        let mut places = HashMap::new();
        for (k, group) in groups.iter().enumerate() {
            places.extend(group.iter().map(|(color, _)| (*color, k as u8)));
        }
        Self {
            colors: groups.iter().map(mean).collect(),
            places,
        }
    }

    /// The place of a color of the pictures.
    pub fn place(&self, pixel: &image::Rgba<u8>) -> u8 {
        let place = self.places.get(&[pixel[0], pixel[1], pixel[2]]);
        place.copied().unwrap_or(0)
    }
}
