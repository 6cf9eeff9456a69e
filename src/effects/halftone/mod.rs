//! Prints the picture with screens of dots or lines.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    settings::{BlendField, FieldRange, color_serde, linear_rgb},
};

/// Prints the colors of the picture with screens of dots or lines: four-color print,
/// screentone, Ben-Day dots.
///
/// The picture is separated into plates, in linear light; each prints its tone as dots
/// that cover that fraction of the area. With ideal inks on white paper, the mean of a
/// flat area is its color. Screens stand still on the page. Lines and areas of ink are
/// drawn over the print, and stay sharp. What is brighter than white is printed as white.
///
/// Screens of less than 2.5 physical pixels fade into plain tones; on a page
/// ([`PageHeight`](crate::style::PageHeight)), cells are at least that large. The views of cameras
/// with this effect are styled after FXAA and SMAA, which would smear the dots.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Halftone {
    /// Which plates there are. Default: [`HalftoneMode::Cmyk`].
    pub mode: HalftoneMode,
    /// What a screen consists of. Default: [`ScreenShape::Euclidean`].
    pub shape: ScreenShape,
    /// Size of a cell of the screens in logical pixels. The grains of
    /// [`ScreenShape::Stochastic`] have a third of it, at least a physical pixel. Range 2.5
    /// to 40, default 6.
    #[reflect(@FieldRange::logarithmic(2.5, 40.0).unit("px"))]
    pub cell_size: f32,
    /// Fraction of the darkness that cyan, magenta and yellow share which is printed in
    /// black instead, in [`HalftoneMode::Cmyk`]. Range 0 to 1, default 0.7.
    #[reflect(@FieldRange::FRACTION)]
    pub black_generation: f32,
    /// Dot gain: how much darker the middle tones are printed, as ink spreads. 0.2 adds a
    /// fifth of the area to a tone of a half. Range 0 to 0.3, default 0.
    #[reflect(@FieldRange::linear(0.0, 0.3))]
    pub gain: f32,
    /// Number of tones of each plate besides bare paper, in equal steps: the few tints of
    /// Ben-Day dots. Range 0 (all tones) to 12, default 0.
    #[reflect(@FieldRange::linear(0.0, 12.0), @BlendField::Switch)]
    pub tints: u32,
    /// Lightness (0 black, 1 white) up to which ink is solid. Range 0 to 0.9, default 0.
    #[reflect(@FieldRange::linear(0.0, 0.9))]
    pub solid_below: f32,
    /// Lightness from which the paper stays bare, at least 0.05 more than `solid_below`.
    /// Range 0.1 to 1, default 1.
    #[reflect(@FieldRange::linear(0.1, 1.0))]
    pub bare_above: f32,
    /// Where the tone of a dot is read. Default: [`ScreenSampling::Pixel`].
    pub sampling: ScreenSampling,
    /// How much of the screens is seen at the near end of the depth map; the rest is
    /// printed as plain tones. Range 0 to 1, default 1. The depth map is read if `at_near` and
    /// `at_far` differ.
    #[reflect(@FieldRange::FRACTION)]
    pub at_near: f32,
    /// The same at the far end. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub at_far: f32,
    /// Lightness up to which screens are seen; within 0.1 above it they become plain
    /// tones. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub shadows_only_below: f32,
    /// Where the screens are fixed. Default: [`ScreenAnchor::View`].
    pub anchor: ScreenAnchor,
    /// The cyan ink, and the first ink of [`HalftoneMode::Duotone`]. Default: a process
    /// cyan. Components of inks are clamped to what a display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub cyan: Color,
    /// The magenta ink. Default: a process magenta.
    #[serde(with = "color_serde")]
    pub magenta: Color,
    /// The yellow ink. Default: a process yellow.
    #[serde(with = "color_serde")]
    pub yellow: Color,
    /// The black ink, the ink of [`HalftoneMode::Spot`], and the second ink of
    /// [`HalftoneMode::Duotone`]. Default: a warm black.
    #[serde(with = "color_serde")]
    pub black: Color,
    /// The paper. Default: a warm white. [`HalftoneMode::Rgb`] has black ground instead.
    #[serde(with = "color_serde")]
    pub paper: Color,
    /// Angle of the cyan screen in degrees, clockwise; of the red one in
    /// [`HalftoneMode::Rgb`]. Range -180 to 180, default 15.
    #[reflect(@FieldRange::linear(-180.0, 180.0).unit("°"))]
    pub cyan_angle: f32,
    /// Angle of the magenta screen, or of the green one. Range -180 to 180, default 75.
    #[reflect(@FieldRange::linear(-180.0, 180.0).unit("°"))]
    pub magenta_angle: f32,
    /// Angle of the yellow screen, or of the blue one. Range -180 to 180, default 0.
    #[reflect(@FieldRange::linear(-180.0, 180.0).unit("°"))]
    pub yellow_angle: f32,
    /// Angle of the black screen. Range -180 to 180, default 45.
    #[reflect(@FieldRange::linear(-180.0, 180.0).unit("°"))]
    pub black_angle: f32,
    /// How much of the print is seen over the picture. Range 0 (the effect is left out) to
    /// 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

/// Which plates a [`Halftone`] prints.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
#[repr(u32)]
pub enum HalftoneMode {
    /// Cyan, magenta, yellow and black.
    #[default]
    Cmyk = 0,
    /// One plate, in the black ink, by the darkness of the picture.
    Spot = 1,
    /// Two plates by the darkness of the picture: the cyan ink, which is solid where the
    /// picture is as dark as that ink, and from there on the black ink.
    Duotone = 2,
    /// Lights of red, green and blue on a black ground: a screen, not a print.
    Rgb = 3,
}

/// What a screen of a [`Halftone`] consists of.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
#[repr(u32)]
pub enum ScreenShape {
    /// Discs that grow until they overlap: Ben-Day dots.
    Round = 0,
    /// Discs in the lights, a checkerboard in the middle tones, holes in the shadows.
    #[default]
    Euclidean = 1,
    /// Lines that grow wider.
    Line = 2,
    /// Diamonds that touch at half the tone.
    Diamond = 3,
    /// Lines in two directions.
    Cross = 4,
    /// Square grains in an even, irregular distribution (blue noise; void and cluster,
    /// Ulichney 1993). Angles do not matter.
    Stochastic = 5,
}

/// Where a [`Halftone`] reads the tone of a dot.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ScreenSampling {
    /// At every pixel: dots are cut off at the edges of things, so details stay sharp.
    #[default]
    Pixel,
    /// At four places of the cell: dots are whole. Reads the picture four times for each
    /// plate, and draws it in two passes. [`ScreenShape::Stochastic`] reads pixels.
    Cell,
}

/// Where the screens of a [`Halftone`] are fixed.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ScreenAnchor {
    /// At the middle of the viewport: each view is a page.
    #[default]
    View,
    /// At the middle of the render target: in a split screen, the screens of all views are
    /// one.
    Window,
    /// At the objects with a [`PatternAnchor`](crate::objects::PatternAnchor): dots move, turn and
    /// grow with each of them. Elsewhere as [`ScreenAnchor::View`]. While there are such objects,
    /// object ids are drawn, which needs the crate's feature `objects`. Grains of
    /// [`ScreenShape::Stochastic`] move, but neither turn nor grow.
    Object,
}

impl Default for Halftone {
    fn default() -> Self {
        Self {
            mode: HalftoneMode::Cmyk,
            shape: ScreenShape::Euclidean,
            cell_size: 6.0,
            black_generation: 0.7,
            gain: 0.0,
            tints: 0,
            solid_below: 0.0,
            bare_above: 1.0,
            sampling: ScreenSampling::Pixel,
            at_near: 1.0,
            at_far: 1.0,
            shadows_only_below: 1.0,
            anchor: ScreenAnchor::View,
            cyan: Color::srgb_u8(0x00, 0xad, 0xef),
            magenta: Color::srgb_u8(0xed, 0x00, 0x8c),
            yellow: Color::srgb_u8(0xff, 0xf2, 0x00),
            black: Color::srgb_u8(0x21, 0x1f, 0x1e),
            paper: Color::srgb_u8(0xfd, 0xf9, 0xf0),
            cyan_angle: 15.0,
            magenta_angle: 75.0,
            yellow_angle: 0.0,
            black_angle: 45.0,
            opacity: 1.0,
        }
    }
}

impl Effect for Halftone {
    const NAME: &'static str = "halftone";
    const STAGE: EffectStage = EffectStage::Print;
    const SHADER: EffectShader = shader!("halftone", "Halftone");
    type Uniform = HalftoneUniform;

    fades_by!(opacity);

    fn needs(&self) -> Needs {
        let mut needs = Needs::TONES;
        needs.set(Needs::MAP, self.at_near != self.at_far);
        needs.set(Needs::PICTURE, self.reads_cells());
        needs.set(Needs::BLUE_NOISE, self.shape == ScreenShape::Stochastic);
        needs.set(Needs::OBJECT_ANCHORS, self.anchor == ScreenAnchor::Object);
        needs
    }

    fn without(self, missing: Needs) -> Option<Self> {
        // Without the map, screens are as at its far end, as for the sky.
        let at_near = if missing.contains(Needs::MAP) {
            self.at_far
        } else {
            self.at_near
        };
        let anchor = match self.anchor {
            ScreenAnchor::Object if missing.contains(Needs::OBJECT_ANCHORS) => ScreenAnchor::View,
            anchor => anchor,
        };
        Some(Self {
            at_near,
            anchor,
            ..self
        })
    }

    fn variants(&self, view: &EffectContext, variants: &mut Variants) {
        variants.number("MODE", self.mode as u32);
        variants.number("SHAPE", self.shape as u32);
        variants.flag("CELLS", self.reads_cells());
        variants.number("ADJUSTED", u32::from(self.adjusts()));
        variants.flag("FOLLOWS", self.anchor == ScreenAnchor::Object);
        let spreads = view.sheet.is_some_and(|sheet| sheet.ink_bleed > 0.0);
        variants.number("SPREADS", u32::from(spreads));
    }

    fn map_faded(self, fraction: f32) -> Self {
        let at_near = self.at_far + (self.at_near - self.at_far) * fraction;
        Self { at_near, ..self }
    }

    fn uniform(&self, view: &EffectContext) -> HalftoneUniform {
        let cell_size = view.cell_size(self.cell_size);
        let turns = self.angles().map(|degrees| degrees.to_radians());
        let inks = [self.cyan, self.magenta, self.yellow, self.black];
        let [cyan, magenta, yellow, black] =
            inks.map(|ink| (Vec3::ONE - linear_rgb(ink)).extend(0.0));
        // Finer screens than the picture can show would be noise.
        let shown = smooth((cell_size - 1.5) / (2.5 - 1.5));
        let stochastic = self.shape == ScreenShape::Stochastic;
        let shown = if stochastic { 1.0 } else { shown };
        let luminance = linear_rgb(self.cyan).dot(Vec3::new(0.2126, 0.7152, 0.0722));
        HalftoneUniform {
            cosines: Vec4::from(turns.map(|angle| angle.cos() / cell_size)),
            sines: Vec4::from(turns.map(|angle| angle.sin() / cell_size)),
            cyan,
            magenta,
            yellow,
            black,
            paper: linear_rgb(self.paper),
            opacity: self.opacity,
            center: self.center(view),
            cell_size,
            grain: (cell_size / 3.0).max(1.0),
            at_near: self.at_near * shown,
            at_far: self.at_far * shown,
            shadows_only_below: self.shadows_only_below,
            black_generation: self.black_generation,
            gain: self.gain,
            tints: self.tints as f32,
            solid_below: self.solid_below,
            contrast: 1.0 / (self.bare_above - self.solid_below).max(0.05),
            pivot: (1.0 - luminance).clamp(0.05, 0.95),
            mode: self.mode as u32,
            shape: self.shape as u32,
            sheet: view.sheet.map_or(0, |sheet| sheet.seed),
            ink_bleed: view.sheet.map_or(0.0, |sheet| 0.5 * sheet.ink_bleed),
            sheet_scale: view.sheet.map_or(0.0, |sheet| sheet.scale),
            sheet_corner: view.sheet.map_or(Vec2::ZERO, |sheet| sheet.corner),
            clip_from_world: view.clip_from_world,
        }
    }
}

impl Halftone {
    /// Whether tones are read in the middle of cells. Grains are too small for that.
    fn reads_cells(&self) -> bool {
        self.sampling == ScreenSampling::Cell && self.shape != ScreenShape::Stochastic
    }

    /// Whether tones, levels or screens depend on more than the color.
    fn adjusts(&self) -> bool {
        let levels = self.solid_below > 0.0 || self.bare_above < 1.0;
        levels || self.tints > 0 || self.gain > 0.0 || self.shadows_only_below < 1.0
    }

    /// Angles of cyan, magenta, yellow and black in degrees.
    fn angles(&self) -> [f32; 4] {
        [
            self.cyan_angle,
            self.magenta_angle,
            self.yellow_angle,
            self.black_angle,
        ]
    }

    /// The place in the render target where the screens begin, in physical pixels: a
    /// quarter of a pixel from the corner of a pixel near the middle. If whole cells are
    /// whole pixels, every dot has the same pixels; there, their errors cancel.
    fn center(&self, view: &EffectContext) -> Vec2 {
        let (first, size) = match self.anchor {
            ScreenAnchor::View | ScreenAnchor::Object => (view.viewport.xy(), view.viewport.zw()),
            ScreenAnchor::Window => (UVec2::ZERO, view.target_size),
        };
        (first + size / 2).as_vec2() + 0.25
    }
}

/// 0 to 1 with a smooth beginning and end.
fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The uniform: `Halftone` in `halftone.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, PartialEq)]
pub struct HalftoneUniform {
    cosines: Vec4,
    sines: Vec4,
    cyan: Vec4,
    magenta: Vec4,
    yellow: Vec4,
    black: Vec4,
    paper: Vec3,
    opacity: f32,
    center: Vec2,
    cell_size: f32,
    grain: f32,
    at_near: f32,
    at_far: f32,
    shadows_only_below: f32,
    black_generation: f32,
    gain: f32,
    tints: f32,
    solid_below: f32,
    contrast: f32,
    pivot: f32,
    mode: u32,
    shape: u32,
    sheet: u32,
    ink_bleed: f32,
    sheet_scale: f32,
    sheet_corner: Vec2,
    clip_from_world: Mat4,
}
