//! Paint in the picture of a camera.

use bevy_comics_testkit::reference::{paint::Scene, view::pixel_depth};

use crate::{
    halftone::covered,
    pictures::assert_later_pass_matches_the_reference,
    prelude::*,
    walls::{towards_the_sky, wall},
};

const FORMS: [PaintKernel; 2] = [PaintKernel::Box, PaintKernel::Anisotropic];

fn paint(form: PaintKernel) -> Paint {
    Paint {
        kernel: form,
        ..default()
    }
}

/// Compares every pixel with the reference. `before`: the other effects of the camera.
fn assert_matches_the_reference(
    small: &mut Small,
    before: &ComicStyle,
    s: Paint,
    viewport: Option<[u32; 4]>,
) {
    assert_later_pass_matches_the_reference(small, before, s, viewport, |view, sheet, _| {
        let [left, top, ..] = view.viewport;
        let at = |[x, y]: [usize; 2]| [left + x as u32, top + y as u32];
        let id = |p: [usize; 2]| {
            let [x, y] = at(p);
            let index = (y * view.width + x) as usize;
            view.ids.map_or(0, |ids| ids.pixels[index][0])
        };
        let scene = Scene {
            sheet,
            depth: &|p| pixel_depth(view, at(p)[0], at(p)[1])[0],
            id: &id,
            scale: 1.0,
        };
        scene.painted(&s)
    });
}

#[test]
fn every_pixel_matches_the_reference() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    let colors = ComicStyle::new().with(Desaturation::default());
    for form in FORMS {
        let s = paint(form);
        assert_matches_the_reference(&mut small, &colors, s, None);
        // Radii of no whole number, by depth, part of the paint, figures.
        let mixed = Paint {
            at_near: 1.3,
            at_far: 7.9,
            sharpness: 4.5,
            figures: true,
            amount: 0.8,
            ..s
        };
        assert_matches_the_reference(&mut small, &colors, mixed, None);
    }
}

#[test]
fn a_viewport_is_a_picture_of_its_own() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    let viewport = [11, 5, 43, 30];
    small.see_in(viewport);
    let colors = ComicStyle::new().with(Desaturation::default());
    for form in FORMS {
        assert_matches_the_reference(&mut small, &colors, paint(form), Some(viewport));
    }
}

/// Over a background that shows through, too. Where nothing is, nothing is painted; and paint
/// is as opaque as the picture.
#[test]
fn a_transparent_background_stays() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Sample4);
    small.camera_settings().clear_color = Color::NONE.into();
    let colors = ComicStyle::new().with(Desaturation::default());
    for form in FORMS {
        let s = Paint {
            figures: true,
            ..paint(form)
        };
        assert_matches_the_reference(&mut small, &colors, s, None);
        let (read, wrote) = small.pass();
        let mut empty = 0;
        for (read, wrote) in read.pixels.iter().zip(&wrote.pixels) {
            assert_eq!(read[3], wrote[3]);
            empty += usize::from(*wrote == [0.0; 4]);
        }
        assert!(empty > 300, "{empty} pixels show the background");
    }
}

/// A code of rounding: the picture between the passes has 11 bits.
#[test]
fn one_color_stays() {
    let mut small = towards_the_sky(UVec2::new(40, 30));
    for color in [
        Color::WHITE,
        Color::BLACK,
        Color::srgb(0.9, 0.1, 0.4),
        Color::srgb(0.02, 0.5, 0.03),
    ] {
        small.clear();
        let at = Transform::from_xyz(0.0, 0.0, -10.0);
        small.put(Rectangle::new(90.0, 90.0), unlit(color), at);
        let plain = small.shot(&ComicStyle::new());
        for form in FORMS {
            let painted = small.shot(&ComicStyle::new().with(paint(form)));
            assert!(small.ran(ComicsStage::of::<Paint>()));
            assert!(apart(&plain, &painted) <= 1, "{form:?}");
        }
    }
}

/// Truth: an edge between two colors stays where it is, and as sharp as it is.
#[test]
fn an_edge_stays_sharp() {
    let mut small = towards_the_sky(UVec2::new(48, 40));
    wall(&mut small, [0.0, -40.0], [40.0, 40.0], 20.0);
    let gray = Color::srgb(0.3, 0.3, 0.3);
    let at = Transform::from_xyz(0.0, 0.0, -30.0);
    small.put(Rectangle::new(90.0, 90.0), unlit(gray), at);
    let plain = small.shot(&ComicStyle::new());
    let painted = small.shot(&ComicStyle::new().with(paint(PaintKernel::Box)));
    let most = apart(&plain, &painted);
    assert!(most <= 1, "a vertical edge between two pixels: {most}");
    let style = ComicStyle::new().with(paint(PaintKernel::Anisotropic));
    let painted = small.shot(&style);
    for y in 0..40 {
        let ink = |picture: &image::RgbaImage| -> f64 {
            (12..36).map(|x| linear(picture, x, y)[1]).sum()
        };
        // One pixel of white more is 1 less the gray.
        let contrast = 1.0 - linear(&plain, 2, y)[1];
        let moved = (ink(&painted) - ink(&plain)) / contrast;
        assert!(moved.abs() < 0.1, "row {y}: {moved}");
    }
}

/// Two objects of nearly one color: paint that keeps figures blurs less of their border.
#[test]
fn figures_keep_their_outline() {
    let mut small = towards_the_sky(UVec2::new(40, 30));
    small.insert(Hdr);
    let mut half = |color: f32, x: f32| {
        let at = Transform::from_xyz(x, 0.0, -10.0);
        let color = Color::linear_rgb(color, color, color);
        small.put(Rectangle::new(40.0, 90.0), unlit(color), at);
    };
    half(0.250, -20.0);
    half(0.256, 20.0);
    let mut blur = |figures: bool| {
        let s = Paint {
            figures,
            ..default()
        };
        small.style(&ComicStyle::new().with(s)).settle();
        let (read, wrote) = small.pass();
        let at = |x: usize| {
            let i = 15 * 40 + x;
            f64::from((wrote.pixels[i][1] - read.pixels[i][1]).abs())
        };
        (18..22).map(at).sum::<f64>()
    };
    let (with, without) = (blur(true), blur(false));
    // Three boxes of 5 x 5 pixels lie across the border, two on it, three on this side. Of the
    // contrast, (3 * 4 / 5 + 2 * 2 / 5) / 8 = 0.4 is lost beside the border and 0.275 in the
    // next pixel; with figures, 0.205 and 0.116: less than half.
    // Variances of up to 9e-6 beside the 1e-4 that is not seen take away a tenth.
    assert!(without > 0.006, "{without}");
    assert!(with < 0.55 * without, "{with}, {without}");
}

/// Three passes: painted, then whole dots of the paint; lines are drawn over both, in their
/// places.
#[test]
fn prints_and_lines_come_after_the_paint() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    let bare = covered(&mut small, &ComicStyle::new());
    let style = ComicStyle::new()
        .with(ToneBands::default())
        .with(Paint::default())
        .with(Misregistration::default())
        .with(Halftone {
            sampling: ScreenSampling::Cell,
            ..default()
        });
    assert_eq!(bare, covered(&mut small, &style));
    assert!(small.ran(ComicsStage::of::<Paint>()));
    assert!(small.ran(ComicsStage::of::<Halftone>()));
}

/// Debug views show the same as without paint.
#[test]
fn debug_views_are_those_of_one_pass() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    let alone = ComicStyle::new().with(Desaturation::default());
    let painted = alone.clone().with(Paint::default());
    for view in [DebugView::DepthMap, DebugView::Saturation] {
        small.insert(view);
        let one = small.shot(&alone);
        let two = small.shot(&painted);
        assert_eq!(one, two, "{view:?}");
    }
}

/// Numbers out of range, and light beyond all displays: nothing that is no number.
#[test]
fn extreme_values_are_finite() {
    let mut small = Small::new(UVec2::new(33, 21), Msaa::Off);
    small.insert(Hdr);
    let bright = Color::linear_rgb(60000.0, 1e9, 1e-30);
    small.put(
        Sphere::new(0.6),
        unlit(bright),
        Transform::from_xyz(0.0, 1.0, 2.0),
    );
    for form in FORMS {
        for x in [f32::NAN, 0.0, 1e30] {
            let s = Paint {
                at_near: x,
                sharpness: x,
                figures: true,
                amount: if x == 0.0 { 1.0 } else { x },
                ..paint(form)
            };
            small.insert(s).settle();
            let (_, after) = small.pass();
            let finite = after.pixels.iter().flatten().all(|v| v.is_finite());
            assert!(finite, "{form:?}, {x}");
        }
    }
}
