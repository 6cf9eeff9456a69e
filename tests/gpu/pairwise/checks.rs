//! What holds in every row. A comment says what a check sees.

use image::RgbaImage;

use super::{
    compare::{Mask, changed, crop, fraction, inked_rim, is_at_edge, is_explained, mean, size},
    covering::{AntiAliasing, Area, Row},
    effects::{GROUPS, LINES},
    stage::OUTSIDE,
};
use crate::prelude::*;

/// The fraction of pixels in flat parts of the picture that may have another tone: pixels at which
/// a threshold of dots, strokes or bands lies within one code. 2 % is the line between two bands of
/// tone over the sphere and the box. A pattern that is moved, scaled or missing changes a tenth at
/// least.
const UNDECIDED: f64 = 0.02;

/// What a row is compared with: the same view and effects on the plainest camera.
pub struct Base {
    pub plain: RgbaImage,
    pub styled: RgbaImage,
}

/// What a row shows inside its viewport.
pub struct Shown {
    pub what: String,
    pub rect: URect,
    pub plain: RgbaImage,
    pub styled: RgbaImage,
}

/// Sees effects that are left out silently in a configuration.
pub fn assert_drawn(small: &Small, style: &ComicStyle, what: &str) {
    assert_drawn_by(small, small.camera, style, what);
}

/// The same of any camera.
pub fn assert_drawn_by(small: &Small, camera: Entity, style: &ComicStyle, what: &str) {
    let world = small.headless.app.world();
    let diagnostics = world.resource::<ComicsDiagnostics>();
    let stages = diagnostics.cameras.get(&camera);
    let stages = stages.unwrap_or_else(|| panic!("{what}: nothing is reported"));
    let sketched = style.get::<Sketch>().is_some();
    for effect in style.effects() {
        let name = effect.effect_type().name;
        let outcome = stages.outcome(ComicsStage::Effect(name));
        let replaced = sketched && outcome == Some(StageOutcome::Skipped(SkipReason::Replaced));
        let ran = stages.ran(ComicsStage::Effect(name));
        // It has no fallback.
        let counts = name == "tone_range";
        let without = StageOutcome::Skipped(SkipReason::NoComputeShaders);
        let replaced = replaced || (counts && outcome == Some(without));
        assert!(ran || replaced, "{what}: {name}: {outcome:?}");
    }
    assert!(stages.ran(ComicsStage::Stylize), "{what}: {stages:?}");
}

/// Sees NaN and infinity, which only HDR pictures can hold.
pub fn assert_finite(small: &Small, shown: &Shown) {
    let (_, output) = small.pass();
    let rect = shown.rect;
    let numbers = fraction(rect.size(), |x, y| {
        let at = (rect.min.y + y) * output.width + rect.min.x + x;
        output.pixels[at as usize].iter().all(|c| c.is_finite())
    });
    assert_eq!(numbers, 1.0, "{}: not finite", shown.what);
}

/// Sees a pass that writes beside its viewport, or clears the whole target.
pub fn assert_outside(picture: &RgbaImage, rect: URect, what: &str) {
    for (x, y, pixel) in picture.enumerate_pixels() {
        let is_inside =
            UVec2::new(x, y).cmpge(rect.min).all() && UVec2::new(x, y).cmplt(rect.max).all();
        assert!(
            is_inside || pixel.0[..3] == OUTSIDE,
            "{what}: {pixel:?} at {x}, {y}, outside the viewport"
        );
    }
}

/// Sees a picture that is lost, and effects that draw nothing. The least that a group draws is
/// lines: 2 pixels wide, along more than the height of the picture.
pub fn assert_styled(shown: &Shown) {
    let what = &shown.what;
    let bright = mean(&shown.styled);
    assert!(
        bright.iter().any(|c| *c > 20.0),
        "{what}: black, {bright:?}"
    );
    let off = changed(&shown.plain, &shown.styled);
    assert!(off > 0.02, "{what}: {off} of the picture is styled");
    let pink = fraction(size(&shown.styled), |x, y| {
        shown.styled.get_pixel(x, y).0[..3] == OUTSIDE
    });
    assert_eq!(pink, 0.0, "{what}: not drawn");
}

/// Sees prepasses of this crate that draw something else, or elsewhere, than those of the engine.
/// The jitter of TAA differs by up to 0.75 pixels of the main pass between two frames.
pub fn assert_silhouettes(row: &Row, plain: &Mask, styled: Option<&Mask>, shown: &Shown) {
    let what = &shown.what;
    if let Some(styled) = styled {
        let reach = match (row.is_temporal(), row.area) {
            (false, _) => 0,
            (true, Area::SmallMainPass) => 2,
            (true, _) => 1,
        };
        // Slivers that are thinner than the jitter.
        let most = if row.is_temporal() { 0.001 } else { 0.0 };
        let apart = if reach == 0 {
            fraction(plain.size, |x, y| plain.at(x, y) != styled.at(x, y))
        } else {
            plain.apart(styled, reach)
        };
        assert!(apart <= most, "{what}: the geometry differs: {apart}");
    }
    // Sees lines that are missing, or are not at the rims of things: those of another viewport,
    // resolution or projection are several pixels off. A card may be a speck where the view is
    // small.
    if GROUPS[row.effects].0 == LINES {
        let inked = inked_rim(&shown.styled, plain);
        println!("{what}: {inked:.3} of the rims are inked");
        assert!(inked >= 0.9, "{what}: {inked} of the rims are inked");
    }
}

/// Sees flicker: the scene, the camera and the drawings stand still.
pub fn assert_still(small: &mut Small, row: &Row, shown: &Shown) {
    let what = &shown.what;
    if !row.is_temporal() {
        for _ in 0..2 {
            small.headless.step(1);
            let now = crop(&small.picture(), shown.rect);
            assert!(now == shown.styled, "{what}: it flickers");
        }
        return;
    }
    // Eight frames later the jitter is the same, and the history has taken up 12 % of them: at
    // edges, their contrast changes by as much and lines follow. Elsewhere nothing changes. A
    // pattern that does not follow the jitter, or a range that never settles, changes flat parts
    // too.
    small.headless.step(8);
    let now = crop(&small.picture(), shown.rect);
    let is_flat = |x, y| !is_at_edge(&shown.plain, x, y, 4);
    let flicker = fraction(size(&now), |x, y| {
        is_flat(x, y) && !is_explained(&now, &shown.styled, (x, y), 0)
    });
    println!("{what}: {flicker:.4} flickers");
    assert!(
        flicker <= 0.005,
        "{what}: {flicker} of the picture flickers"
    );
}

/// How far edges and lines may be from those of the plainest camera, in pixels.
fn reach(row: &Row) -> u32 {
    let small = row.area == Area::SmallMainPass;
    // Other samples, and filters of anti-aliasing, move an edge into a neighbor.
    let one = 1;
    // A texel of two pixels moves an edge by one more, and the jitter is in texels.
    let texel = u32::from(small) + u32::from(small && row.is_temporal());
    // The engine's SMAA takes the size of a pixel from the viewport, not from the target.
    let smaa = row.area == Area::Part && row.anti_aliasing == AntiAliasing::Smaa;
    one + texel + u32::from(smaa)
}

/// The fraction of the flat parts of `base` where a picture has a color that `other` has not,
/// within the row's reach.
fn unexplained(row: &Row, picture: &RgbaImage, other: &RgbaImage, base: &RgbaImage) -> f64 {
    let reach = reach(row);
    // The engine's FXAA mixes the outermost pixels of a viewport with what is beside it.
    let framed = row.area == Area::Part && row.anti_aliasing == AntiAliasing::Fxaa;
    let frame = u32::from(framed);
    let inside = |x, y| {
        let last = size(base) - 1;
        x >= frame && y >= frame && x + frame <= last.x && y + frame <= last.y
    };
    // A line of 2 pixels along a moved edge.
    let is_flat = |x, y| inside(x, y) && !is_at_edge(base, x, y, reach + 2);
    let flat = fraction(size(base), is_flat);
    assert!(flat > 0.15, "{row:?}: only {flat} of the picture is flat");
    let strange = fraction(size(base), |x, y| {
        is_flat(x, y) && !is_explained(picture, other, (x, y), reach)
    });
    strange / flat
}

/// The row against its base. Anti-aliasing, samples and resolution only mix or move colors at
/// edges; HDR and the deferred renderer change numbers by a code.
pub fn assert_near(row: &Row, shown: &Shown, base: &Base) {
    let what = &shown.what;
    // Sees a row that the engine draws otherwise, so that the rest would compare nothing.
    let engine = unexplained(row, &shown.plain, &base.plain, &base.plain);
    // Sees effects in other places, sizes or tones than on the plainest camera.
    let ours = unexplained(row, &shown.styled, &base.styled, &base.plain);
    println!("{what}: unexplained {engine:.4} of the engine, {ours:.4} of the style");
    assert!(engine <= UNDECIDED, "{what}: {engine} without a style");
    assert!(ours <= UNDECIDED, "{what}: {ours} with its style");
    // Sees lines that are lost or wider, tones that are encoded twice, and effects that are weaker:
    // mixing keeps the mean. A quarter of the effect is what the rims of wide strokes vary by;
    // three codes are one for each of: rounding of both pictures, of the deferred colors, of HDR.
    let effect = |styled, plain| {
        let (styled, plain) = (mean(styled), mean(plain));
        [0, 1, 2].map(|i| styled[i] - plain[i])
    };
    let (own, wanted) = (
        effect(&shown.styled, &shown.plain),
        effect(&base.styled, &base.plain),
    );
    let largest = wanted.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let apart = (own.iter().zip(wanted)).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    println!("{what}: the effect is {apart:.2} of {largest:.2} codes off");
    assert!(
        apart <= 0.25 * largest + 3.0,
        "{what}: the mean changes by {own:?}, not {wanted:?}"
    );
}
