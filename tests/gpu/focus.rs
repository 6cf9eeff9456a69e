//! Focus in the picture of a camera.

use bevy_comics::effect::EffectTarget;
use bevy_comics_testkit::reference::{
    Rgba,
    box_statistics::Sheet,
    color,
    focus::{SKY, Scene},
    fused::{Input, stylize},
};
use half::f16;

use crate::{
    halftone::covered,
    pictures::view_of,
    prelude::*,
    walls::{towards_the_sky, unit_per_pixel},
};

const STYLES: [FocusStyle; 4] = [
    FocusStyle::Blur,
    FocusStyle::Offset,
    FocusStyle::Paint,
    FocusStyle::Dots,
];
const CODE: f64 = 1.0 / 255.0;

pub fn at(distance: f32, style: FocusStyle) -> Focus {
    Focus {
        at: FocusAt::Distance,
        style,
        distance,
        ..default()
    }
}

/// Compares every pixel with the reference, which starts from what the pass read. Counts pixels for
/// which rounding decides what is read; at most 1 in 200 may be. Perspective views.
fn assert_matches_the_reference(
    small: &mut Small,
    s: Focus,
    focus_at: f64,
    viewport: Option<[u32; 4]>,
) {
    let before = ComicStyle::new().with(Desaturation::default());
    small.insert(VisibleDepthRange::default());
    small.style(&before.clone().with(s));
    small.settle();
    assert!(small.ran(ComicsStage::of::<Focus>()), "{s:?}");
    let (read, wrote) = small.pass();
    let loaded = small.loaded();
    let prepass = small.prepass().expect("depth");
    let viewport = viewport.unwrap_or([0, 0, read.width, read.height]);
    let view = view_of(small, &prepass, &default(), viewport);
    let light = |x: u32, y: u32| loaded.pixels[(y * read.width + x) as usize];
    let input = Input {
        picture: &light,
        size: [read.width, read.height],
        lines: None,
        drawing: 0,
        quads: [viewport[0], viewport[1]],
    };
    let [left, top, width, height] = viewport;
    let at = |[x, y]: [usize; 2]| [left + x as u32, top + y as u32];
    let sheet = Sheet::new([width, height].map(|v| v as usize), |p| {
        let pixel: Rgba = stylize(&before, &view, &input, at(p)[0], at(p)[1], 0.0);
        pixel.map(|v| f64::from(f16::from_f64(v).to_f32()))
    });
    let distance = |p: [usize; 2]| {
        let of = |sample| match view.depth(at(p)[0], at(p)[1], sample) {
            0.0 => SKY,
            raw => 0.1 / raw,
        };
        (0..view.samples).map(of).fold(SKY, f64::min)
    };
    let focused = |nudge| {
        let scene = Scene {
            sheet: &sheet,
            distance: &distance,
            focus_at,
            reference: None,
            scale: 1.0,
            nudge,
        };
        scene.focused(&s)
    };
    let [want, more, less] = [1.0, 1.0 + 1e-4, 1.0 - 1e-4].map(focused);
    let encode = |[r, g, b, alpha]: Rgba| {
        let [r, g, b] = color::srgb_encode([r, g, b]);
        [r, g, b, alpha]
    };
    let (mut changed, mut undecided) = (0, 0);
    for (i, want) in want.pixels.iter().enumerate() {
        let p = [i % sheet.size[0], i / sheet.size[0]];
        let [column, row] = at(p);
        let got = wrote.pixels[(row * read.width + column) as usize].map(f64::from);
        let apart = |a: Rgba, b: Rgba| {
            let (a, b) = (encode(a), encode(b));
            (0..4).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
        };
        changed += usize::from(*want != sheet.at(p));
        // Half a code of rounding in the target on top of the one allowed.
        if apart(got, *want) <= 1.5 * CODE {
            continue;
        }
        let decides = apart(more.at(p), less.at(p)) > CODE;
        assert!(decides, "{s:?}: {p:?}: {got:?}, {want:?}");
        undecided += 1;
    }
    assert!(changed > 100, "{changed} pixels are out of focus");
    assert!(undecided * 200 <= want.pixels.len(), "{undecided} pixels");
}

#[test]
fn every_pixel_matches_the_reference() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        for style in STYLES {
            let s = Focus {
                clear: 0.1,
                ramp: 0.6,
                radius: 7.5,
                ..at(5.0, style)
            };
            assert_matches_the_reference(&mut small, s, 5.0, None);
        }
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn a_viewport_is_a_picture_of_its_own() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    let viewport = [11, 5, 43, 30];
    let entity = small.camera;
    let mut camera = small.world().get_mut::<Camera>(entity).expect("a camera");
    camera.viewport = Some(Viewport {
        physical_position: UVec2::new(viewport[0], viewport[1]),
        physical_size: UVec2::new(viewport[2], viewport[3]),
        ..default()
    });
    for style in STYLES {
        assert_matches_the_reference(&mut small, at(5.0, style), 5.0, Some(viewport));
    }
    assert_eq!(small.errors(), 0);
}

/// A background that shows through keeps nothing of the picture.
#[test]
fn a_transparent_background_stays() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    small.insert(Camera {
        clear_color: Color::NONE.into(),
        ..default()
    });
    for style in STYLES {
        assert_matches_the_reference(&mut small, at(4.0, style), 4.0, None);
        let (read, wrote) = small.pass();
        for (read, wrote) in read.pixels.iter().zip(&wrote.pixels) {
            assert_eq!(read[3], wrote[3]);
            assert!(read[3] > 0.0 || *wrote == [0.0; 4], "{style:?}: {wrote:?}");
        }
    }
}

pub fn shot(small: &mut Small, style: &ComicStyle) -> image::RgbaImage {
    small.style(style);
    small.settle();
    small.picture()
}

/// A red figure before stripes of blue and green.
pub fn figure(small: &mut Small, near: f32, far: f32) {
    small.clear();
    small.insert((Transform::IDENTITY, Projection::default()));
    let scale = |distance: f32| distance * (std::f32::consts::PI / 8.0).tan();
    let red = Transform::from_xyz(0.0, 0.0, -near);
    let size = 0.8 * scale(near);
    small.put(
        Rectangle::new(size, size),
        unlit(Color::linear_rgb(1.0, 0.0, 0.0)),
        red,
    );
    for i in -20..20 {
        let color = if i % 2 == 0 {
            Color::linear_rgb(0.0, 1.0, 0.0)
        } else {
            Color::linear_rgb(0.0, 0.0, 1.0)
        };
        let width = 0.2 * scale(far);
        let stripe = Transform::from_xyz(width * i as f32, 0.0, -far);
        small.put(
            Rectangle::new(width, 4.0 * scale(far)),
            unlit(color),
            stripe,
        );
    }
}

/// Truth: not a trace of a sharp figure is beside it, and it is unchanged; what is behind it is
/// out of focus. Under MSAA its border, which is part figure, stays as it is too.
#[test]
fn a_sharp_figure_does_not_bleed() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        figure(&mut small, 5.0, 60.0);
        let plain = shot(&mut small, &ComicStyle::new());
        for style in [FocusStyle::Blur, FocusStyle::Offset] {
            let s = Focus {
                radius: 8.0,
                ..at(5.0, style)
            };
            let picture = shot(&mut small, &ComicStyle::new().with(s));
            let (mut inside, mut changed) = (0, 0);
            for (a, b) in plain.pixels().zip(picture.pixels()) {
                if a.0[0] > 0 {
                    assert_eq!(a, b, "{style:?}, {msaa:?}: the figure");
                    inside += 1;
                } else {
                    assert_eq!(b.0[0], 0, "{style:?}, {msaa:?}: red beside the figure");
                    changed += usize::from(a != b);
                }
            }
            assert!(
                inside > 200 && changed > 1000,
                "{style:?}, {msaa:?}: {inside}, {changed}"
            );
        }
    }
}

/// Truth: painted, a sharp figure is unchanged, and over an even background there is no trace of
/// it. Areas that reach over its outline vary, so they do not count; over stripes, where all areas
/// vary, some do.
#[test]
fn a_sharp_figure_before_paint_does_not_bleed_where_it_is_even() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        for even in [true, false] {
            figure(&mut small, 5.0, 60.0);
            if even {
                let blue = unlit(Color::linear_rgb(0.0, 0.0, 1.0));
                let before_the_stripes = Transform::from_xyz(0.0, 0.0, -50.0);
                small.put(Rectangle::new(200.0, 200.0), blue, before_the_stripes);
            }
            let plain = shot(&mut small, &ComicStyle::new());
            let s = Focus {
                radius: 8.0,
                ..at(5.0, FocusStyle::Paint)
            };
            let picture = shot(&mut small, &ComicStyle::new().with(s));
            assert!(small.ran(ComicsStage::of::<Focus>()));
            let mut most = 0;
            for (a, b) in plain.pixels().zip(picture.pixels()) {
                if a.0[0] > 0 {
                    assert_eq!(a, b, "{msaa:?}: the figure");
                } else {
                    most = most.max(b.0[0]);
                }
            }
            println!("{msaa:?}, even {even}: {most} codes of red");
            assert!(!even || most == 0, "{msaa:?}: {most} codes of red");
        }
    }
}

/// Truth: what is out of focus in front stays inside its outline, over a sharp background.
#[test]
fn an_unsharp_figure_keeps_its_outline() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    figure(&mut small, 5.0, 60.0);
    let plain = shot(&mut small, &ComicStyle::new());
    let blurred = shot(
        &mut small,
        &ComicStyle::new().with(at(60.0, FocusStyle::Blur)),
    );
    for (a, b) in plain.pixels().zip(blurred.pixels()) {
        assert!(a.0[0] == 255 || a == b, "the background");
    }
}

/// Blurred stripes are even, and more so the farther they are from the focus.
#[test]
fn blur_grows_with_the_distance_from_the_focus() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    figure(&mut small, 5.0, 60.0);
    let mut contrast = |focus_at: f32| {
        let s = at(focus_at, FocusStyle::Blur);
        let picture = shot(&mut small, &ComicStyle::new().with(s));
        let greens: Vec<f64> = (6..66).map(|x| linear(&picture, x, 4)[1]).collect();
        let mean = greens.iter().sum::<f64>() / greens.len() as f64;
        greens.iter().map(|g| (g - mean).powi(2)).sum::<f64>()
    };
    let found = [60.0, 35.0, 28.0, 10.0].map(&mut contrast);
    assert!(found.is_sorted_by(|a, b| a > b), "{found:?}");
    assert!(found[3] < 0.1 * found[0], "{found:?}");
}

/// The focus follows an object, wherever it moves, and stays at its own distance while there
/// is none.
#[test]
fn the_focus_follows_an_object() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    let hero = small.world().spawn(Transform::default()).id();
    let own = Focus {
        distance: 3.0,
        ..default()
    };
    let with_target = |small: &mut Small, distance: f32| {
        let camera = small.camera;
        let eye = *small.world().get::<Transform>(camera).expect("placed");
        let place = eye.transform_point(Vec3::new(0.4, 0.2, -distance));
        let moved = Transform::from_translation(place);
        small.world().entity_mut(hero).insert(moved);
        shot(small, &ComicStyle::new().with(own))
    };
    small.insert(EffectTarget::new(hero));
    let mut seen = Vec::new();
    for distance in [2.0, 5.0, 40.0] {
        let followed = with_target(&mut small, distance);
        let fixed = ComicStyle::new().with(at(distance, FocusStyle::Blur));
        let fixed = shot(&mut small, &fixed);
        let pairs = followed.as_raw().iter().zip(fixed.as_raw());
        let apart = pairs.map(|(a, b)| a.abs_diff(*b)).max();
        // The distance is rounded on its way through the world.
        assert!(apart <= Some(1), "{distance}: {apart:?}");
        seen.push(followed);
    }
    assert!(seen[0] != seen[1] && seen[1] != seen[2]);
    let behind = with_target(&mut small, -5.0);
    let fixed = shot(
        &mut small,
        &ComicStyle::new().with(at(3.0, FocusStyle::Blur)),
    );
    assert_eq!(behind, fixed);
}

/// The middle of the view is as sharp as without the effect, be it a thing or the sky.
#[test]
fn the_middle_of_the_view_is_in_focus() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let style = ComicStyle::new().with(Focus {
        at: FocusAt::Center,
        ..default()
    });
    for distance in [5.0, 50.0] {
        figure(&mut small, distance, 600.0);
        let plain = shot(&mut small, &ComicStyle::new());
        let picture = shot(&mut small, &style);
        let middle = plain
            .pixels()
            .zip(picture.pixels())
            .filter(|(a, _)| a.0[0] == 255);
        assert!(middle.into_iter().all(|(a, b)| a == b), "{distance}");
        assert_ne!(plain, picture);
    }
}

/// Orthographic views: the reference is 1.2 times the height, here 48 pixels of one unit.
#[test]
fn an_orthographic_view_has_a_focus() {
    let mut small = towards_the_sky(UVec2::new(72, 48));
    small.insert(Projection::Orthographic(OrthographicProjection {
        far: 500.0,
        ..unit_per_pixel(UVec2::new(72, 48))
    }));
    let stripes = |small: &mut Small, distance: f32| {
        small.clear();
        for i in 0..9 {
            let color = Color::linear_rgb(0.0, 1.0, 0.0);
            let stripe = Transform::from_xyz(8.0 * i as f32 - 32.0, 0.0, -distance);
            small.put(Rectangle::new(4.0, 100.0), unlit(color), stripe);
        }
        let back = Transform::from_xyz(0.0, 0.0, -distance - 0.01);
        small.put(Rectangle::new(100.0, 100.0), unlit(Color::BLACK), back);
        let plain = shot(small, &ComicStyle::new());
        let s = ComicStyle::new().with(at(100.0, FocusStyle::Blur));
        (plain, shot(small, &s))
    };
    let reference = 0.5 * 48.0 / 22.5f32.to_radians().tan();
    for sharp in [100.0, 100.0 - 0.14 * reference, 100.0 + 0.14 * reference] {
        let (plain, picture) = stripes(&mut small, sharp);
        assert_eq!(plain, picture, "{sharp}");
    }
    for far in [100.0 - 0.9 * reference, 100.0 + 1.2 * reference] {
        let (plain, picture) = stripes(&mut small, far);
        let green = |p: &image::RgbaImage| linear(p, 36, 24)[1];
        assert_eq!(green(&plain), 1.0);
        assert!(green(&picture) < 0.7, "{far}: {}", green(&picture));
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn lines_stay_sharp() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    let bare = covered(&mut small, &ComicStyle::new());
    let s = ComicStyle::new().with(at(3.0, FocusStyle::Blur));
    assert_eq!(bare, covered(&mut small, &s));
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
    for style in STYLES {
        for x in [f32::NAN, 1e30] {
            let s = Focus {
                at: FocusAt::Center,
                style,
                distance: x,
                clear: if x.is_nan() { x } else { 0.0 },
                ramp: x,
                radius: x,
                cell_size: x,
            };
            for at in [FocusAt::Center, FocusAt::Distance] {
                small
                    .insert((Focus { at, ..s }, Outlines::default()))
                    .settle();
                let (_, after) = small.pass();
                let finite = after.pixels.iter().flatten().all(|v| v.is_finite());
                assert!(finite, "{style:?}, {x}");
            }
        }
    }
    assert_eq!(small.errors(), 0);
}
