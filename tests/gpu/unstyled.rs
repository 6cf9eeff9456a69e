//! Objects that the color effects leave alone.

use crate::{
    ids::{cube, material},
    prelude::*,
};

/// Color effects that change every color of the small scene.
fn colors() -> ComicStyle {
    ComicStyle::new()
        .with(ToneBands {
            levels: 3,
            ..default()
        })
        .with(Desaturation {
            amount: 1.0,
            ..default()
        })
        .with(Colorization {
            amount: 1.0,
            ..Colorization::SEPIA
        })
}

/// An orange cube before the scene.
fn orange_cube(small: &mut Small) -> Entity {
    let orange = material(small, |m| m.base_color = Color::srgb(0.9, 0.4, 0.1));
    cube(small, orange, Transform::from_xyz(0.3, 0.6, 2.5))
}

/// For each pixel: the largest change of a component, and the samples, of all, that show
/// an object with the slot of a style.
fn changes(small: &mut Small, style: &ComicStyle) -> Vec<(f32, usize, usize)> {
    small.style(style).settle();
    let (input, output) = small.pass();
    let ids = small.prepass().expect("a prepass").ids;
    let pixel = |i: usize| {
        let [a, b] = [input.pixels[i], output.pixels[i]];
        let change = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f32::max);
        let own = ids.iter().filter(|ids| ids.pixels[i][1] != 0).count();
        (change, own, ids.len())
    };
    (0..input.pixels.len()).map(pixel).collect()
}

/// The pixels of the object are those of the unstyled picture, bit for bit; those of others
/// are not; multisampled pixels of its rim are in between.
#[test]
fn an_object_keeps_its_colors() {
    let mut small = Small::new(size(), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        let cube = orange_cube(&mut small);
        small.world().entity_mut(cube).insert(NoStyle::default());
        let pixels = changes(&mut small, &colors());
        let whole = pixels.iter().filter(|(_, own, all)| own == all);
        assert!(whole.clone().count() > 200);
        for (change, ..) in whole {
            assert_eq!(*change, 0.0, "{msaa:?}");
        }
        let others = pixels.iter().filter(|(_, own, _)| *own == 0);
        let changed = others.clone().filter(|(change, ..)| *change > 0.02);
        assert!(changed.count() > others.count() / 2, "{msaa:?}");
        let rim = pixels.iter().filter(|(_, own, all)| own != all && *own > 0);
        assert_eq!(rim.count() > 20, msaa == Msaa::Sample4);
    }
}

/// A rim pixel of which k of n samples show the object has k/n of its own color.
#[test]
fn the_rim_mixes_by_samples() {
    let mut small = Small::new(size(), Msaa::Sample4);
    let cube = orange_cube(&mut small);
    small.style(&colors()).settle();
    let (input, styled) = small.pass();
    small.world().entity_mut(cube).insert(NoStyle::default());
    let pixels = changes(&mut small, &colors());
    let (_, kept) = small.pass();
    let mut seen = [0; 5];
    for (i, (_, own, all)) in pixels.iter().enumerate() {
        seen[*own] += 1;
        let part = *own as f32 / *all as f32;
        for k in 0..3 {
            let mixed = styled.pixels[i][k] * (1.0 - part) + input.pixels[i][k] * part;
            let found = kept.pixels[i][k];
            // The target has eight bits, in sRGB: a code is up to 0.9 % of linear light.
            assert!((found - mixed).abs() < 0.01, "{i}: {found}, {mixed}");
        }
    }
    assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
}

/// Ink is drawn over it, lines are still its style's, and a sketch draws it too.
#[test]
fn ink_is_drawn_over_it() {
    let mut small = Small::new(size(), Msaa::Off);
    let cube = orange_cube(&mut small);
    let own = (NoStyle::default(), OutlineStyle::default());
    small.world().entity_mut(cube).insert(own);
    for style in [
        colors().with(Outlines::default()),
        colors().with(Contours::default()),
        colors().with(Sketch::default()),
    ] {
        let pixels = changes(&mut small, &style);
        let is_dark = |(change, own, _): &&(f32, usize, usize)| *own > 0 && *change > 0.2;
        assert!(pixels.iter().filter(is_dark).count() > 20, "{style:?}");
    }
}

/// Descendants inherit it where asked, except for those with their own; taken off, all is
/// styled again.
#[test]
fn descendants_inherit_it_where_asked() {
    let mut small = Small::new(size(), Msaa::Off);
    let child = orange_cube(&mut small);
    let root = (Transform::default(), Visibility::default());
    let root = small.world().spawn(root).add_child(child).id();
    let mut kept_with = |root_style: Option<NoStyle>| {
        let mut root = small.world().entity_mut(root);
        match root_style {
            Some(style) => root.insert(style),
            None => root.remove::<NoStyle>(),
        };
        let pixels = changes(&mut small, &colors());
        pixels.iter().filter(|(change, ..)| *change == 0.0).count()
    };
    let none = kept_with(None);
    let own = NoStyle { inherit: false };
    assert_eq!(kept_with(Some(own)), none, "not inherited");
    let inherited = kept_with(Some(NoStyle::default()));
    assert!(inherited > none + 200, "inherited");
    assert_eq!(kept_with(None), none, "taken off");
}

/// Without such objects, and without color effects, no ids are drawn for it.
#[test]
fn it_costs_nothing_where_it_does_nothing() {
    let mut small = Small::new(size(), Msaa::Off);
    let cube = orange_cube(&mut small);
    small.style(&colors()).settle();
    assert!(!small.ran(ComicsStage::ObjectIds));
    small.world().entity_mut(cube).insert(NoStyle::default());
    small.settle();
    assert!(small.ran(ComicsStage::ObjectIds));
    small.style(&ComicStyle::new().with(Contours::default()));
    small.settle();
    assert!(!small.ran(ComicsStage::ObjectIds));
}
