//! The opacity of the picture, over a background that shows through.

use crate::{
    pictures::{check_presets, outlined},
    prelude::*,
};

/// Half a code of the target for what it stores, and half for what it read.
const CODE: f32 = 1.0 / 255.0;

/// The small scene, without a background.
fn small() -> Small {
    small_of(size())
}

fn small_of(size: UVec2) -> Small {
    let mut small = Small::new(size, Msaa::Off);
    again(&mut small, Msaa::Off);
    small
}

/// The same, drawn by a new camera.
fn again(small: &mut Small, msaa: Msaa) {
    small.restart(msaa);
    small.camera_settings().clear_color = ClearColorConfig::Custom(Color::NONE);
}

/// What the pass read and wrote, pixel by pixel.
fn pass(small: &mut Small, style: &ComicStyle) -> Vec<([f32; 4], [f32; 4])> {
    small.style(style).settle();
    let (read, wrote) = small.pass();
    read.pixels.into_iter().zip(wrote.pixels).collect()
}

/// Ink is opaque: of a line over the empty background the color is the ink's, times its
/// coverage, and the opacity is the coverage.
#[test]
fn ink_over_an_empty_background_is_as_opaque_as_its_coverage() {
    let color = Color::linear_rgb(0.9, 0.3, 0.0);
    let lines = Silhouettes { color, ..default() };
    let outlines = Outlines {
        silhouettes: Some(lines),
        width: 4.0,
        ..Outlines::SILHOUETTES
    };
    let contours = Contours {
        color,
        width: 4.0,
        ..default()
    };
    let mut small = small();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        again(&mut small, msaa);
        for style in [outlined(outlines), outlined(contours)] {
            let (mut whole, mut empty) = (0, 0);
            for (read, wrote) in pass(&mut small, &style) {
                if read != [0.0; 4] {
                    assert!(wrote[3] >= read[3] - CODE, "{read:?} {wrote:?}");
                    continue;
                }
                for (ink, got) in [0.9, 0.3, 0.0].into_iter().zip(wrote) {
                    // A code of the target near 0.9 in linear light is 2.3 / 255.
                    let apart = (got - ink * wrote[3]).abs();
                    assert!(apart <= 2.3 * CODE, "{msaa:?}: {wrote:?}");
                }
                whole += usize::from(wrote[3] == 1.0);
                empty += usize::from(wrote == [0.0; 4]);
            }
            assert!(whole > 50, "{msaa:?}: {whole} pixels of whole ink");
            assert!(empty > 500, "{msaa:?}: {empty} pixels of background");
        }
    }
}

/// Paper is opaque, and blank where there is no picture, at every `wash`.
#[test]
fn paper_is_opaque_and_blank_where_nothing_is() {
    let paper = Color::linear_rgb(0.8, 0.7, 0.5);
    let mut small = small();
    again(&mut small, Msaa::Sample4);
    for wash in [0.0, 0.6] {
        let sketch = Sketch {
            paper,
            wash,
            ..default()
        };
        let mut blank = 0;
        for (read, wrote) in pass(&mut small, &ComicStyle::default().with(sketch)) {
            assert_eq!(wrote[3], 1.0, "{read:?}");
            let want = [0.8, 0.7, 0.5];
            let same = (0..3).all(|i| (wrote[i] - want[i]).abs() <= 2.3 * CODE);
            blank += usize::from(read == [0.0; 4] && same);
        }
        assert!(blank > 500, "{blank} pixels of blank paper");
    }
}

/// Effects that add color add none where nothing is.
#[test]
fn an_empty_background_stays_empty() {
    let color = Color::linear_rgb(0.2, 0.1, 0.6);
    let style = ComicStyle::default()
        .with(ToneBands::default())
        .with(Colorization::default())
        .with(Desaturation::default())
        .with(BlackFlats {
            color,
            value: Some(0.4),
            ..default()
        })
        .with(Vignette { color, ..default() });
    let light = TwoTone {
        threshold: 0.0,
        ..default()
    };
    let mut small = small();
    for (msaa, style) in [
        (Msaa::Off, &style),
        (Msaa::Sample4, &style),
        (Msaa::Off, &ComicStyle::new().with(light)),
    ] {
        again(&mut small, msaa);
        let (mut empty, mut changed) = (0, 0);
        for (read, wrote) in pass(&mut small, style) {
            assert_eq!(read[3], wrote[3]);
            if read == [0.0; 4] {
                assert_eq!(wrote, [0.0; 4]);
                empty += 1;
            }
            changed += usize::from(read != wrote);
        }
        assert!(empty > 500 && changed > 500, "{empty}, {changed}");
    }
}

/// The opacity takes part in the mix with the original, and in the split.
#[test]
fn weight_and_split_mix_the_opacity_too() {
    let mut small = small();
    let style = ComicStyle::default().with(Sketch::default());
    small.insert(StyleWeight(0.5));
    let half = pass(&mut small, &style);
    assert!(half.iter().any(|(read, _)| read[3] == 0.0));
    for (read, wrote) in half {
        assert!(
            (wrote[3] - 0.5 * (read[3] + 1.0)).abs() <= CODE,
            "{read:?} {wrote:?}"
        );
    }
    small.insert((StyleWeight(1.0), SplitView { at: 0.5 }));
    for (i, (read, wrote)) in pass(&mut small, &style).into_iter().enumerate() {
        let original = i as u32 % size().x < size().x / 2;
        assert_eq!(wrote[3], if original { read[3] } else { 1.0 }, "pixel {i}");
    }
}

/// Presets that print, and that draw on paper.
#[test]
fn presets_match_the_reference_without_a_background() {
    let mut small = small_of(UVec2::new(64, 44));
    check_presets(&mut small, &[presets::POP_POSTER, presets::PENCIL_SKETCH]);
}

#[test]
#[ignore = "long: every preset"]
fn every_preset_matches_the_reference_without_a_background() {
    let mut small = small();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        again(&mut small, msaa);
        check_presets(&mut small, presets::ALL);
    }
}
