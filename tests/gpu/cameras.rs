//! Cameras that draw over the picture of others, and mirrors.

use bevy::{
    camera::{
        Camera3dDepthLoadOp, CameraProjection, ClearColorConfig, Exposure, Projection,
        visibility::RenderLayers,
    },
    math::Vec4,
    post_process::effect_stack::LensDistortion,
    render::{render_resource::AsBindGroup, view::ColorGrading},
};
use bevy_comics::cameras::{BeyondPrepass, ComicOverlay, RangeOf, StyleMask, overlay_camera};

use crate::{prelude::*, small::Reshaped};

/// Effects of every stage that change every pixel, and lines.
fn comic() -> ComicStyle {
    ComicStyle::new()
        .with(ToneBands {
            levels: 3,
            ..default()
        })
        .with(Colorization {
            amount: 1.0,
            ..Colorization::SEPIA
        })
        .with(Halftone::default())
        .with(Outlines::default())
        .with(Vignette::default())
}

/// The layer of the second camera.
fn own_layer() -> RenderLayers {
    RenderLayers::layer(1)
}

/// A green cube that only the second camera sees, before the others.
fn cube(small: &mut Small, color: Color) -> Entity {
    let at = Transform::from_xyz(0.6, 1.1, 3.0).with_rotation(Quat::from_rotation_y(0.6));
    let cube = small.put(Cuboid::default(), unlit(color), at);
    small.world().entity_mut(cube).insert(own_layer());
    cube
}

/// A second camera at the place of the first one.
fn second(small: &mut Small, settings: impl Bundle, style: &ComicStyle) -> Entity {
    let first = small.camera;
    let world = small.world();
    let camera = world.entity(first);
    let copied = (
        *camera.get::<Transform>().expect("a place"),
        camera.get::<RenderTarget>().expect("a target").clone(),
        *camera.get::<Msaa>().expect("samples"),
    );
    let is_hdr = camera.contains::<Hdr>();
    let plain = (Tonemapping::None, DebandDither::Disabled, own_layer());
    let second = (Camera3d::default(), settings, copied, plain);
    let second = world.spawn(second).id();
    if is_hdr {
        world.entity_mut(second).insert(Hdr);
    }
    style.apply(&mut world.commands().entity(second));
    world.flush();
    second
}

/// The pixels of `a` that differ from `b`.
fn different(a: &image::RgbaImage, b: &image::RgbaImage) -> HashSet<(u32, u32)> {
    let pixels = a.enumerate_pixels().zip(b.pixels());
    pixels
        .filter(|((.., a), b)| a != b)
        .map(|((x, y, _), _)| (x, y))
        .collect()
}

/// Whether a pixel is at most this far from one of these, along both axes.
fn is_near(pixels: &HashSet<(u32, u32)>, (x, y): (u32, u32), reach: u32) -> bool {
    let near = |at: u32| at.saturating_sub(reach)..=at + reach;
    near(x).any(|x| near(y).any(|y| pixels.contains(&(x, y))))
}

/// A camera without a background of its own, over the picture of the first one.
fn over_the_first() -> Camera {
    Camera {
        order: 1,
        clear_color: ClearColorConfig::None,
        ..default()
    }
}

/// A styled view model changes only its own pixels and those of its lines: with a camera that clears to
/// transparent, and with one that shares the picture and has a mask.
#[test]
fn a_second_camera_changes_only_what_it_draws() {
    let gun = ComicStyle::new()
        .with(Desaturation {
            amount: 1.0,
            ..default()
        })
        .with(ToneBands::default())
        .with(Outlines::default());
    for (msaa, hdr) in [
        (Msaa::Off, false),
        (Msaa::Sample4, false),
        (Msaa::Off, true),
    ] {
        let mut small = Small::new(size(), msaa);
        if hdr {
            small.insert(Hdr);
        }
        let alone = small.shot(&comic());
        cube(&mut small, Color::srgb(0.2, 0.7, 0.3));
        let cases = [
            (overlay_camera(1), true),
            (over_the_first(), true),
            (over_the_first(), false),
        ];
        // One control without a mask is enough.
        let is_plain = msaa == Msaa::Off && !hdr;
        for (settings, masks) in cases.into_iter().take(if is_plain { 3 } else { 2 }) {
            let mut drawn = |style: &ComicStyle, mask: StyleMask| {
                let camera = second(&mut small, (settings.clone(), mask), style);
                let picture = small.settle().picture();
                small.world().despawn(camera);
                picture
            };
            let shape = different(&drawn(&ComicStyle::new(), StyleMask::Auto), &alone);
            assert!((250..1500).contains(&shape.len()), "{}", shape.len());
            let mask = if masks {
                StyleMask::Auto
            } else {
                StyleMask::Picture
            };
            let changed = different(&drawn(&gun, mask), &alone);
            assert!(changed.len() > shape.len());
            // A line of 2 px lies on the border, and its smoothed rim reaches a pixel farther.
            let strayed = changed
                .iter()
                .filter(|at| !is_near(&shape, **at, 3))
                .count();
            assert_eq!(
                strayed == 0,
                masks,
                "{msaa:?}, {hdr}, {settings:?}: {strayed}"
            );
            if !masks {
                // Without a mask, nearly all is changed once more.
                assert!(strayed > 2500, "{strayed}");
            }
        }
    }
}

/// The geometry of the first camera hides that of the second; its lines are not drawn again.
#[test]
fn ids_tell_what_a_camera_that_loads_depth_has_drawn() {
    let mut small = Small::new(UVec2::new(192, 128), Msaa::Off);
    let alone = small.shot(&comic());
    // Half behind the red cube.
    let marker = small.put(
        Cuboid::default(),
        unlit(Color::srgb(0.2, 0.7, 0.3)),
        Transform::from_xyz(-0.9, 0.9, 0.0),
    );
    small.world().entity_mut(marker).insert(own_layer());
    let load = Camera3d {
        depth_load_op: Camera3dDepthLoadOp::Load,
        ..default()
    };
    let mut drawn = |style: &ComicStyle| {
        let camera = second(&mut small, over_the_first(), style);
        small.world().entity_mut(camera).insert(load.clone());
        let picture = small.settle().picture();
        small.world().despawn(camera);
        picture
    };
    let shape = different(&drawn(&ComicStyle::new()), &alone);
    assert!((300..3000).contains(&shape.len()), "{}", shape.len());
    let style = ComicStyle::new()
        .with(Desaturation::default())
        .with(Outlines::default());
    let changed = different(&drawn(&style), &alone);
    let strayed = changed
        .iter()
        .filter(|at| !is_near(&shape, **at, 4))
        .count();
    assert_eq!(strayed, 0);
    assert!(changed.len() > shape.len());
}

/// A picture of half the opacity is half of the opaque one after every color effect, whose arithmetic is
/// not linear.
#[test]
fn color_effects_change_what_is_seen_of_a_surface() {
    let mut small = Small::new(size(), Msaa::Off);
    small.clear();
    small.insert(overlay_camera(0));
    let faithful = Desaturation {
        equations: Equations::Faithful,
        amount: 1.0,
        ..default()
    };
    let sepia = Colorization {
        amount: 1.0,
        ..Colorization::SEPIA
    };
    for style in [
        ComicStyle::new().with(sepia),
        ComicStyle::new().with(ToneBands::default()),
        ComicStyle::new().with(ToneRamp::default()),
        ComicStyle::new().with(faithful),
        ComicStyle::new().with(TwoTone::default()),
    ] {
        // An unlit sheet over nothing.
        let mut color = |alpha: f32| {
            let color = LinearRgba::new(0.3, 0.2, 0.05, alpha);
            let material = StandardMaterial {
                alpha_mode: AlphaMode::Blend,
                ..unlit(color.into())
            };
            let sheet = Plane3d::default().mesh().size(40.0, 40.0);
            let sheet = small.put(sheet, material, Transform::IDENTITY);
            small.style(&style).settle();
            let (before, after) = small.pass();
            small.world().despawn(sheet);
            let middle = before.pixels.len() / 2 + 48;
            let rgb = |picture: &FloatImage| Vec3::from_slice(&picture.pixels[middle][..3]);
            let (before, after) = (rgb(&before), rgb(&after));
            let expected = color.to_vec3() * alpha;
            assert!(before.distance(expected) < 0.01, "{before}, {expected}");
            after
        };
        let (opaque, half) = (color(1.0), color(0.5));
        // The target has eight bits, in sRGB: a code is up to 0.9 % of linear light.
        let name = &style;
        assert!(
            (0.5 * opaque).distance(half) < 0.01,
            "{name:?}: {opaque}, {half}"
        );
    }
}

/// Light that is added has no opacity; effects leave it as it is where nothing else is.
#[test]
fn added_light_stays() {
    let mut small = Small::new(size(), Msaa::Off);
    small.clear();
    small.insert(overlay_camera(0));
    let light = StandardMaterial {
        alpha_mode: AlphaMode::Add,
        ..unlit(Color::linear_rgb(0.3, 0.2, 0.05))
    };
    let sheet = Plane3d::default().mesh().size(40.0, 40.0);
    small.put(sheet, light, Transform::IDENTITY);
    for style in [
        ComicStyle::new().with(ToneBands::default()),
        ComicStyle::new().with(ToneRamp::default()),
        ComicStyle::new().with(Colorization::SEPIA),
    ] {
        small.style(&style).settle();
        let (before, after) = small.pass();
        let middle = before.pixels.len() / 2 + 48;
        let light = |picture: &FloatImage| picture.pixels[middle][..3].iter().sum::<f32>();
        assert!(light(&before) > 0.4, "{}", light(&before));
        assert!(light(&after) > 0.3, "{style:?}: {}", light(&after));
    }
}

/// A material that is not in the prepass.
#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct Bare {}

impl Material for Bare {
    fn enable_prepass() -> bool {
        false
    }
}

/// The picture of the small scene with a cube that is not in the prepass, before an edge.
fn with_bare_cube(
    small: &mut Small,
    beyond: BeyondPrepass,
    style: &ComicStyle,
) -> image::RgbaImage {
    small.insert(beyond);
    small.shot(style)
}

/// Where the picture shows what is not in the prepass, `NoLines` draws no lines of what is behind it,
/// and `Plain` changes nothing.
#[test]
fn what_is_not_in_the_prepass_keeps_its_colors() {
    let plugin = MaterialPlugin::<Bare>::default();
    let mut small = Small::with_plugins(options(size()), Msaa::Off, plugin);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        let empty = ComicStyle::new();
        let before = with_bare_cube(&mut small, BeyondPrepass::Styled, &empty);
        let material = small.world().resource_mut::<Assets<Bare>>().add(Bare {});
        let at = Transform::from_xyz(0.6, 0.9, 2.4);
        small.put_shared(Cuboid::default(), MeshMaterial3d(material), at);
        let plain = with_bare_cube(&mut small, BeyondPrepass::Styled, &empty);
        let shape = different(&plain, &before);
        assert!((250..1500).contains(&shape.len()), "{}", shape.len());
        // Not the rim, whose pixels show both.
        let is_whole = |(x, y): (u32, u32)| {
            let near = |at: u32| at - 1..=at + 1;
            near(x).all(|x| near(y).all(|y| shape.contains(&(x, y))))
        };
        let whole: Vec<_> = shape.iter().filter(|at| is_whole(**at)).collect();
        let lines = ComicStyle::new().with(Outlines::default());
        let mut changed = |beyond: BeyondPrepass, style: &ComicStyle| {
            let drawn = with_bare_cube(&mut small, beyond, style);
            let changed = different(&drawn, &plain);
            whole.iter().filter(|at| changed.contains(**at)).count()
        };
        assert!(changed(BeyondPrepass::Styled, &lines) > 25, "{msaa:?}");
        assert_eq!(changed(BeyondPrepass::NoLines, &lines), 0, "{msaa:?}");
        assert!(changed(BeyondPrepass::NoLines, &comic()) > whole.len() / 2);
        assert_eq!(changed(BeyondPrepass::Plain, &comic()), 0, "{msaa:?}");
        // Elsewhere there are lines.
        let drawn = with_bare_cube(&mut small, BeyondPrepass::NoLines, &lines);
        assert!(different(&drawn, &plain).len() > 125);
        // Both masks in one shader.
        small.insert(StyleMask::Own).settle();
        assert!(small.ran(ComicsStage::Stylize));
    }
}

/// An overlay draws its layers over the comic without effects, hidden by the geometry of its camera; it
/// follows the camera, and goes with the component.
#[test]
fn an_overlay_is_drawn_over_the_comic() {
    let mut small = Small::new(UVec2::new(192, 128), Msaa::Sample4);
    let alone = small.shot(&comic());
    let green = Color::srgb(0.2, 0.7, 0.3);
    let marker = cube(&mut small, green);
    small.insert(ComicOverlay::default());
    let shown = different(&small.settle().picture(), &alone);
    let [r, g, b, _] = green.to_srgba().to_u8_array();
    let picture = small.picture();
    let is_exact = |(x, y): &&(u32, u32)| {
        let found = picture.get_pixel(*x, *y).0;
        (0..3).all(|c| found[c].abs_diff([r, g, b][c]) <= 1)
    };
    let exact = shown.iter().filter(is_exact).count();
    assert!(exact * 10 > shown.len() * 9, "{exact} of {}", shown.len());
    // Below the ground, it is hidden.
    let below = Transform::from_xyz(0.0, -2.0, 1.0);
    small.world().entity_mut(marker).insert(below);
    assert!(different(&small.settle().picture(), &alone).is_empty());
    // The camera turns, and sees the marker through its overlay.
    small
        .world()
        .entity_mut(marker)
        .insert(Transform::from_xyz(9.0, 1.0, 0.0));
    let ahead = Transform::from_xyz(1.5, 2.4, 6.0).looking_at(Vec3::new(9.0, 1.0, 0.0), Vec3::Y);
    small.insert(ahead);
    let middle = small.settle().picture().get_pixel(96, 64).0;
    assert!((0..3).all(|c| middle[c].abs_diff([r, g, b][c]) <= 1));
    let mut grading = ColorGrading::default();
    grading.global.hue = 0.5;
    small.insert((Exposure { ev100: 3.0 }, grading)).settle();
    let world = small.world();
    let mut light = world.query::<(&Exposure, &ColorGrading)>();
    let copied = |(exposure, grading): (&Exposure, &ColorGrading)| {
        exposure.ev100 == 3.0 && grading.global.hue == 0.5
    };
    assert!(light.iter(world).all(copied));
    small.camera_mut().remove::<ComicOverlay>();
    small.settle();
    let world = small.world();
    assert_eq!(world.query::<&Camera>().iter(world).count(), 1);
}

/// The pixels of a quad may belong to two viewports: what is beside a view that begins at an odd pixel does not
/// change it.
#[test]
fn a_viewport_at_an_odd_pixel_reads_no_pixel_of_its_neighbor() {
    let mut small = Small::new(size(), Msaa::Off);
    // Bands read how lightness changes over a pixel.
    let bands = ToneBands {
        softness: 8.0,
        ..default()
    };
    small.style(&ComicStyle::new().with(bands));
    // Stripes of every tone fill the view.
    small.insert(Transform::from_xyz(0.0, 3.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::X));
    for stripe in 0..64 {
        let tone = stripe as f32 / 63.0;
        let at = Transform::from_xyz(2.4 * (tone - 0.5), 1.2, 0.0);
        let stripe = Cuboid::new(0.04, 0.1, 9.0);
        small.put(stripe, unlit(Color::srgb(tone, tone, tone)), at);
    }
    let (left, top, height) = (41, 11, 41);
    small.see_in([left, top, 51, height]);
    let picture = small.settle().picture();
    let [first, second] = [left, left + 1].map(|x| {
        let column = (top..top + height).map(|y| picture.get_pixel(x, y).0);
        column.collect::<Vec<_>>()
    });
    let tones: HashSet<_> = second.iter().collect();
    assert!(tones.len() > 4, "{tones:?}");
    assert_eq!(first, second);
}

/// Where Bevy's `LensDistortion` with these settings reads the picture for a place; both from 0 to 1.
fn bent(place: Vec2, lens: &LensDistortion) -> Vec2 {
    let away = place - lens.center;
    let k = lens.intensity * (away / away.length().max(1e-6)).abs().dot(lens.multiplier);
    let place = away * (1.0 + k * away.length_squared()) / lens.scale + lens.center;
    place.clamp(Vec2::ZERO, Vec2::ONE)
}

/// An empty second camera with `LensDistortion` bends the finished comic, lines and colors together.
#[test]
fn an_empty_camera_bends_the_finished_comic() {
    let size = UVec2::new(192, 128);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let mut small = Small::new(size, msaa);
        let comic = small.shot(&comic());
        let lens = LensDistortion::default();
        let settings = (over_the_first(), lens.clone());
        second(&mut small, settings, &ComicStyle::new());
        let found = small.settle().picture();
        let (mut moved, mut wrong) = (0, 0);
        for (x, y, color) in found.enumerate_pixels() {
            let place = (Vec2::new(x as f32, y as f32) + 0.5) / size.as_vec2();
            let from = (bent(place, &lens) * size.as_vec2() - 0.5).as_ivec2();
            let near = (-1..=2).flat_map(|v| (-1..=2).map(move |u| from + IVec2::new(u, v)));
            let last = size.as_ivec2() - 1;
            let near: Vec<_> = (near.map(|at| at.clamp(IVec2::ZERO, last).as_uvec2()))
                .map(|at| comic.get_pixel(at.x, at.y).0)
                .collect();
            let fits = |channel: usize| {
                let of = near.iter().map(|color| i32::from(color[channel]));
                let (least, most) = of.fold((255, 0), |(a, b), v| (a.min(v), b.max(v)));
                (least - 2..=most + 2).contains(&i32::from(color.0[channel]))
            };
            wrong += usize::from(!(0..3).all(fits));
            moved += usize::from(comic.get_pixel(x, y) != color);
        }
        assert!(moved > 3000, "{msaa:?}: {moved}");
        assert_eq!(wrong, 0, "{msaa:?}");
    }
}

/// How many pixels of two pictures differ by more than 2 codes, within a rectangle from the left side.
fn apart(a: &image::RgbaImage, b: &image::RgbaImage, width: u32) -> usize {
    let pixels = a.enumerate_pixels().zip(b.pixels());
    let inside = pixels.filter(|((x, ..), _)| *x < width);
    inside
        .filter(|((.., a), b)| a.0[0].abs_diff(b.0[0]) > 2)
        .count()
}

/// A camera that sees something nearer has the depth map of another one, whatever its near plane is.
#[test]
fn a_camera_takes_the_range_of_another_one() {
    let mut small = Small::new(size(), Msaa::Off);
    small.insert(DebugView::DepthMap);
    let first = small.camera;
    let expected = small.settle().picture();
    // At the right side of the picture.
    let at = Transform::from_xyz(1.53, 2.12, 5.11);
    let near = small.put(Cuboid::from_length(0.2), unlit(Color::WHITE), at);
    small.world().entity_mut(near).insert(own_layer());
    let settings = Camera {
        order: 1,
        ..default()
    };
    let camera = second(&mut small, settings, &ComicStyle::new());
    let both = RenderLayers::from_layers(&[0, 1]);
    small
        .world()
        .entity_mut(camera)
        .insert((both, DebugView::DepthMap));
    let third = (Camera3d::default(), DebugView::DepthMap, RangeOf(first));
    let third = small
        .world()
        .spawn((third, RenderTarget::None { size: size() }))
        .id();
    let nowhere = RenderTarget::None { size: size() };
    let unseen = (Camera3d::default(), DebugView::DepthMap, nowhere);
    let unseen = small.world().spawn(unseen).id();
    let measures = |small: &Small| {
        let stages = small.headless.app.world().resource::<ComicsDiagnostics>();
        let outcome = stages.cameras[&camera].outcome(ComicsStage::DepthRange);
        outcome != Some(StageOutcome::Skipped(SkipReason::RangeOf))
    };
    let width = size().x / 2;
    for (leader, near, takes) in [
        (None, 0.1, false),
        (Some(first), 0.1, true),
        (Some(first), 0.02, true),
        (Some(third), 0.1, true),
        (Some(camera), 0.1, false),
        (Some(unseen), 0.1, false),
    ] {
        let projection = Projection::Perspective(PerspectiveProjection { near, ..default() });
        let mut entity = small.world().entity_mut(camera);
        entity.insert(projection);
        match leader {
            Some(leader) => entity.insert(RangeOf(leader)),
            None => entity.remove::<RangeOf>(),
        };
        let found = apart(&small.settle().picture(), &expected, width);
        assert_eq!(measures(&small), !takes, "{leader:?}");
        assert_eq!(found == 0, takes, "{leader:?}, {near}: {found}");
    }
}

/// A mirrored view is the picture of the view that it mirrors.
#[test]
fn a_mirrored_view_is_the_mirrored_picture() {
    let size = UVec2::new(192, 128);
    let mut small = Small::new(size, Msaa::Off);
    // Strokes and screens would begin at another corner.
    let style = ComicStyle::new()
        .with(ToneBands::default())
        .with(Outlines::default());
    let mut expected = small.shot(&style);
    image::imageops::flip_horizontal_in_place(&mut expected);
    let camera = small.camera;
    let projection = small.world().get::<Projection>(camera).cloned();
    let Some(Projection::Perspective(projection)) = projection else {
        panic!("a perspective");
    };
    let mirrored = Reshaped {
        projection,
        plane: Vec4::ZERO,
        matrix: |projection, _| {
            Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)) * projection.get_clip_from_view()
        },
    };
    let settings = Camera {
        invert_culling: true,
        clear_color: Color::srgb(0.3, 0.5, 0.8).into(),
        ..default()
    };
    small.insert((Projection::custom(mirrored), settings));
    small.settle();
    let found = small.settle().picture();
    let others = differ(&found, &expected, 2);
    // Silhouettes cover other pixels where a border passes through the center of one.
    assert!(others < (size.x * size.y / 500) as usize, "{others}");
}
