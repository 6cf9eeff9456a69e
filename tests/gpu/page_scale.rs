//! Effects of the page in a screenshot with eight times the scale factor: reduced to the size of
//! the screen, it looks like the screen.
//!
//! The scenes have edges only between pixels of the screen, so that without effects both pictures
//! are one. An effect decides in the middle of a pixel what the screenshot decides for 64 parts of
//! it: edges of dots, of lines and of patches are up to half a pixel elsewhere. So the pictures may
//! differ by as much as the screenshot does from itself, half a pixel of the screen further across
//! and down. A screenshot without the scale factor, whose dots are an eighth as large, is farther
//! from the screen, by more than the rounding of the display.

use bevy::image::ImageSampler;
use bevy_comics_testkit::{
    reference::{color, noise},
    screens::ideal,
};

use crate::{prelude::*, walls::towards_the_sky};

const SCREEN: UVec2 = UVec2::new(48, 32);
/// A screen for lines across all of it.
const WIDE: UVec2 = UVec2::new(96, 64);
const TIMES: u32 = 8;
/// Half a code of the display is at most this much linear light.
pub const ROUNDING: f64 = 0.0045;

/// Linear light of the pixels of a screen, without the last column and row.
pub type Light = Vec<[f64; 3]>;

/// The light of a screenshot, reduced to the size of the screen. `from`: the pixel of the
/// screenshot where the screen's first one begins, in both axes.
pub fn reduced(picture: &image::RgbaImage, times: u32, from: u32) -> Light {
    let (width, height) = (picture.width() / times, picture.height() / times);
    let light: Vec<f64> = (0..=255u8)
        .map(|code| color::srgb_decode([f64::from(code) / 255.0; 3])[0])
        .collect();
    let area = f64::from(times * times);
    let pixels = (0..height - 1).flat_map(|y| (0..width - 1).map(move |x| (x, y)));
    let mean = |(x, y): (u32, u32)| {
        let mut sum = [0.0; 3];
        for (i, j) in (0..times).flat_map(|j| (0..times).map(move |i| (i, j))) {
            let pixel = picture.get_pixel(times * x + from + i, times * y + from + j);
            for (sum, code) in sum.iter_mut().zip(pixel.0) {
                *sum += light[usize::from(code)] / area;
            }
        }
        sum
    };
    pixels.map(mean).collect()
}

/// The mean of the differences of all pixels.
pub fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let all = a.iter().flatten().zip(b.iter().flatten());
    let sum: f64 = all.map(|(a, b)| (a - b).abs()).sum();
    sum / (3 * a.len()) as f64
}

fn mean(light: &[[f64; 3]]) -> f64 {
    light.iter().flatten().sum::<f64>() / (3 * light.len()) as f64
}

pub fn shot(small: &mut Small, style: &ComicStyle, size: UVec2, scale: f32) -> image::RgbaImage {
    small.headless.resize(size, scale);
    let target = small.headless.render_target();
    small.insert(target);
    small.style(style);
    // The second frame has the new size, and what the style needs.
    small.headless.step(2);
    small.picture()
}

/// What a style has on the screen, and reduced in a screenshot with the scale factor and in one
/// without.
struct Looks {
    screen: Light,
    screenshot: Light,
    /// As the screenshot, half a pixel of the screen further across and down.
    moved: Light,
    unscaled: Light,
}

impl Looks {
    fn new(small: &mut Small, style: &ComicStyle) -> Self {
        Self::on(SCREEN, small, style)
    }

    fn on(size: UVec2, small: &mut Small, style: &ComicStyle) -> Self {
        let screen = shot(small, style, size, 1.0);
        let scaled = shot(small, style, TIMES * size, TIMES as f32);
        let unscaled = shot(small, style, TIMES * size, 1.0);
        Self {
            screen: reduced(&screen, 1, 0),
            screenshot: reduced(&scaled, TIMES, 0),
            moved: reduced(&scaled, TIMES, TIMES / 2),
            unscaled: reduced(&unscaled, TIMES, 0),
        }
    }

    /// `sampling`: how much more the mean of a few places may differ from the mean of the area.
    fn assert_within(&self, what: &str, sampling: f64) {
        let found = apart(&self.screen, &self.screenshot);
        let most = apart(&self.screenshot, &self.moved) + ROUNDING + sampling;
        let unscaled = apart(&self.screen, &self.unscaled);
        let lighter = mean(&self.screenshot) - mean(&self.screen);
        assert!(found <= most, "{what}: {found}, at most {most}");
        assert!(lighter.abs() <= 0.01, "{what}: lighter by {lighter}");
        let least = found + ROUNDING;
        assert!(
            unscaled > least,
            "{what}: unscaled {unscaled}, above {least}"
        );
    }
}

/// A wall of one color.
fn flat(screen: UVec2) -> Small {
    let mut small = towards_the_sky(screen);
    let color = Color::linear_rgb(0.55, 0.4, 0.25);
    let at = Transform::from_xyz(0.0, 0.0, -80.0);
    small.put(Rectangle::new(200.0, 200.0), unlit(color), at);
    small
}

/// Areas of three colors, with a noise of pixels of the screen.
fn photograph() -> Image {
    let pixel = |i: u32| {
        let [x, y] = [i % SCREEN.x, i / SCREEN.x];
        let middle = IVec2::new(x as i32 - 30, y as i32 - 18);
        let area = match (x < 17, middle.length_squared() < 100) {
            (true, _) => [0.55, 0.35, 0.2],
            (_, true) => [0.2, 0.4, 0.6],
            _ => [0.4, 0.6, 0.3],
        };
        let noise = f64::from(noise::hash(i) >> 8) / f64::from(1 << 24);
        let light = area.map(|c: f64| c * (0.7 + 0.6 * noise));
        let [r, g, b] = color::srgb_encode(light).map(|c| (255.0 * c).round() as u8);
        [r, g, b, 255]
    };
    let size = Extent3d {
        width: SCREEN.x,
        height: SCREEN.y,
        depth_or_array_layers: 1,
    };
    let mut image = Image::new(
        size,
        TextureDimension::D2,
        (0..SCREEN.x * SCREEN.y).flat_map(pixel).collect(),
        TextureFormat::Rgba8UnormSrgb,
        RenderAssetUsages::default(),
    );
    image.sampler = ImageSampler::nearest();
    image
}

/// A photograph that fills the view, and before it a red square.
fn layers() -> Small {
    let mut small = towards_the_sky(SCREEN);
    let mut images = small.world().resource_mut::<Assets<Image>>();
    let image = images.add(photograph());
    let photograph = StandardMaterial {
        base_color_texture: Some(image),
        ..unlit(Color::WHITE)
    };
    let (width, height) = (SCREEN.x as f32, SCREEN.y as f32);
    let far = Transform::from_xyz(0.0, 0.0, -40.0);
    small.put(Rectangle::new(width, height), photograph, far);
    let near = Transform::from_xyz(-6.0, -2.5, -10.0);
    let red = unlit(Color::linear_rgb(0.7, 0.2, 0.15));
    small.put(Rectangle::new(14.0, 11.0), red, near);
    small
}

#[test]
fn without_effects_a_screenshot_is_the_screen() {
    for mut small in [flat(SCREEN), layers()] {
        let none = ComicStyle::new();
        let looks = Looks::new(&mut small, &none);
        assert!(apart(&looks.screen, &looks.screenshot) < 1e-9);
    }
}

/// Fails unless every style looks alike.
fn assert_alike<N: std::fmt::Debug>(
    mut small: Small,
    styles: impl IntoIterator<Item = (N, ComicStyle)>,
) {
    let screen = small.headless.options.size;
    for (what, style) in styles {
        Looks::on(screen, &mut small, &style).assert_within(&format!("{what:?}"), 0.0);
    }
}

fn of<E: Effect>(effect: E) -> ComicStyle {
    ComicStyle::new().with(effect)
}

#[test]
fn dots_are_as_large() {
    let spot = |shape| Halftone {
        mode: HalftoneMode::Spot,
        shape,
        ..ideal()
    };
    assert_alike(flat(SCREEN), SHAPES.map(|shape| (shape, of(spot(shape)))));
}

#[test]
fn dots_of_inks_and_grain_are_as_large() {
    let cells = Halftone {
        shape: ScreenShape::Round,
        sampling: ScreenSampling::Cell,
        ..default()
    };
    let coarse = Paper {
        grain: 1.0,
        size: 3.0,
        ..default()
    };
    let styles = [
        ("four inks", of(Halftone::default())),
        ("whole dots", of(cells)),
        ("rough dots", of(Halftone::default()).with(ink(1.0, 0.0))),
        ("paper", of(Paper::default())),
        ("coarse paper", of(coarse)),
    ];
    assert_alike(flat(SCREEN), styles);
}

#[test]
fn speed_lines_are_as_large() {
    let radial = SpeedLines {
        rate: 0.0,
        count: 40,
        width: 6.0,
        ..default()
    };
    let [mut parallel, mut dry] = [radial; 2];
    parallel.kind = SpeedLineKind::Parallel;
    dry.dry_brush = 0.6;
    let styles = [("dry focus lines", of(dry)), ("speed lines", of(parallel))];
    assert_alike(flat(WIDE), styles);
}

/// Paper without grain, on which ink bleeds and a brush runs dry.
fn ink(ink_bleed: f32, dry_brush: f32) -> Paper {
    Paper {
        grain: 0.0,
        shading: 0.0,
        ink_bleed,
        dry_brush,
        ..default()
    }
}

/// The mean distance of a blur on the screen from its area's mean. It takes 12 places and one more
/// for each pixel of its radius, and those of the photograph have an independent noise: uniform
/// in 0.6 of a light of at most 0.6. The sum of so many is normal.
fn sampling(radius: f32) -> f64 {
    let noise = 0.6 * 0.6 / 12f64.sqrt();
    let places = 12.0 + f64::from(radius);
    noise / places.sqrt() * (2.0 / std::f64::consts::PI).sqrt()
}

fn focus(style: FocusStyle) -> Focus {
    Focus {
        at: FocusAt::Distance,
        style,
        distance: 10.0,
        ramp: 0.3,
        ..default()
    }
}

#[test]
fn patches_are_as_large() {
    let paint = |kernel| Paint {
        kernel,
        ..default()
    };
    let kernels = [PaintKernel::Box, PaintKernel::Anisotropic];
    assert_alike(layers(), kernels.map(|kernel| (kernel, of(paint(kernel)))));
}

#[test]
fn focus_is_as_large() {
    let styles = [FocusStyle::Offset, FocusStyle::Paint, FocusStyle::Dots];
    assert_alike(layers(), styles.map(|style| (style, of(focus(style)))));
    let blur = focus(FocusStyle::Blur);
    Looks::new(&mut layers(), &of(blur)).assert_within("blur", sampling(blur.radius));
}

/// Ink on paper: rough edges, dry brushes, and lines that fade out of focus.
#[test]
fn ink_is_as_rough() {
    let lines = of(Outlines {
        width: 6.0,
        ..Outlines::SILHOUETTES
    });
    let beyond = Focus {
        distance: 13.0,
        clear: 0.0,
        ramp: 0.2,
        ..focus(FocusStyle::Lines)
    };
    let styles = [
        ("rough lines", lines.clone().with(ink(2.0, 0.0))),
        ("dry lines", lines.clone().with(ink(0.0, 0.5))),
        ("faded lines", lines.with(beyond)),
    ];
    assert_alike(layers(), styles);
}

/// Without black, a moved plate is a moved channel. The bilinear mean of two pixels of the screen
/// is the mean of their parts in the screenshot: alike but for the rounding of the display.
#[test]
fn plates_out_of_register_are_as_far_apart() {
    let mut small = layers();
    let three = Misregistration {
        black_generation: 0.0,
        drift: 1.5,
        ..default()
    };
    let looks = Looks::new(&mut small, &of(three));
    let found = apart(&looks.screen, &looks.screenshot);
    assert!(found < ROUNDING, "{found}");
    assert!(apart(&looks.screen, &looks.unscaled) > 4.0 * ROUNDING);
    let four = of(Misregistration::default());
    Looks::new(&mut small, &four).assert_within("four plates", 0.0);
}

/// The largest radius of the settings still grows at this scale factor: 192 physical pixels.
#[test]
fn the_largest_blur_is_as_large() {
    let mut small = layers();
    let blurred = |radius: f32| {
        let blur = focus(FocusStyle::Blur);
        of(Focus { radius, ..blur })
    };
    let largest = Looks::new(&mut small, &blurred(24.0));
    largest.assert_within("largest blur", sampling(24.0));
    let other = shot(&mut small, &blurred(16.0), TIMES * SCREEN, TIMES as f32);
    let other = reduced(&other, TIMES, 0);
    assert!(apart(&largest.screenshot, &other) > ROUNDING);
}
