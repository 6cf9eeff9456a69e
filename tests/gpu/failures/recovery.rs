//! The engine asks for a new device after an error of the renderer: all that is on the GPU is made
//! again.
//!
//! A device that is lost ends the app, since the engine's clusters of lights panic (Bevy 0.19.1).

use std::time::Instant;

use bevy::render::{
    RenderStartup,
    error_handler::{ErrorType, RenderErrorPolicy},
    settings::WgpuSettings,
};
use bevy_comics::{SelectionOutline, XRayOutline, objects::LineWidths};
use bevy_comics_testkit::validation;
use image::RgbaImage;

use super::*;
use crate::{
    pairwise::effects::{GROUPS, Group},
    prelude::*,
    small::{RenderErrors, spawn_objects},
};

/// How often the renderer was started in an app whose handler may ask for a new device. Devices of
/// two instances of wgpu can be equal.
#[derive(Resource, Default)]
struct Starts(usize);

/// The small scene, which has no light: the engine does not draw the same light after it has
/// recovered. Its app asks for a new device after an error. Also gives the objects that [`highlight`]
/// highlights.
fn scene(size: UVec2, msaa: Msaa) -> (Small, [Entity; 2]) {
    let mut headless = Headless::new(options(size), ComicsPlugin);
    headless
        .app
        .init_resource::<RenderErrors>()
        .insert_resource(RenderErrorHandler(|error, main, _| {
            println!("{}", error.description);
            main.resource_mut::<RenderErrors>().count += 1;
            assert!(matches!(error.ty, ErrorType::Validation), "{error:?}");
            let settings = WgpuSettings {
                backends: Some(HeadlessOptions::default().backends),
                instance_flags: validation::instance_flags(),
                ..default()
            };
            RenderErrorPolicy::Recover(settings.into())
        }));
    headless
        .app
        .sub_app_mut(RenderApp)
        .init_resource::<Starts>()
        .add_systems(RenderStartup, |mut starts: ResMut<Starts>| starts.0 += 1);
    let target = headless.render_target();
    let world = headless.app.world_mut();
    spawn_objects(world);
    let camera = world.spawn(camera(target, msaa)).id();
    let mut small = Small { headless, camera };
    let highlighted = put_objects(&mut small);
    (small, highlighted)
}

/// Objects of the kinds that this crate draws once more. Gives one in front, and one that is partly
/// hidden.
fn put_objects(small: &mut Small) -> [Entity; 2] {
    let glass = StandardMaterial {
        alpha_mode: AlphaMode::Blend,
        ..unlit(Color::srgba(0.3, 0.8, 0.9, 0.6))
    };
    let pane = small.put(
        Rectangle::new(1.0, 0.8),
        glass,
        Transform::from_xyz(0.4, 0.7, 1.6),
    );
    small.world().entity_mut(pane).insert(DepthWrite::default());
    let mut cube = |x: f32, z: f32| {
        let at = Transform::from_xyz(x, 0.4, z).with_rotation(Quat::from_rotation_y(0.7));
        let blue = unlit(Color::srgb(0.3, 0.4, 0.8));
        small.put(Cuboid::from_length(0.6), blue, at)
    };
    let [divided, front, behind, wide] =
        [(-1.7, 1.8), (-0.2, 2.2), (1.2, -2.2), (1.7, 1.4)].map(|(x, z)| cube(x, z));
    let world = small.world();
    world.entity_mut(divided).insert(MeshSections::default());
    world.entity_mut(wide).insert(LineWidths::default());
    world.entity_mut(wide).insert(OutlineStyle {
        width: Some(4.0),
        ..default()
    });
    [front, behind]
}

/// Gives objects outlines that need no style, or takes them away.
fn highlight(small: &mut Small, [front, behind]: [Entity; 2], on: bool) {
    let world = small.world();
    if on {
        world.entity_mut(front).insert(SelectionOutline::default());
        world.entity_mut(behind).insert(XRayOutline::default());
    } else {
        world.entity_mut(front).remove::<SelectionOutline>();
        world.entity_mut(behind).remove::<XRayOutline>();
    }
}

/// The picture of a new camera, without history, in a style.
fn shoot(small: &mut Small, msaa: Msaa, style: Option<&ComicStyle>) -> RgbaImage {
    let target = small.headless.render_target();
    small.camera_mut().despawn();
    small.camera = small.world().spawn(camera(target, msaa)).id();
    if let Some(style) = style {
        small.style(style);
    }
    small.headless.step(8);
    small.picture()
}

/// Draws until the sections of a mesh, which a task computes, are in the ids of objects.
fn wait_for_sections(small: &mut Small, when: &str) {
    for _ in 0..200 {
        small.headless.step(2);
        let ids = small.object_ids();
        if ids.is_some_and(|ids| {
            ids.pixels
                .iter()
                .any(|[_, slot_section]| slot_section >> 8 != 0)
        }) {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("there are no sections {when}");
}

/// Causes an error, and draws until there is another device.
fn recover(small: &mut Small) {
    let starts = |small: &Small| small.render_world().resource::<Starts>().0;
    let before = starts(small);
    let device = small.render_world().resource::<RenderDevice>();
    // A buffer must have a use.
    let _ = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 16,
        usage: wgpu::BufferUsages::empty(),
        mapped_at_creation: false,
    });
    // A task asks for the device.
    let until = Instant::now() + Duration::from_secs(30);
    while starts(small) == before && Instant::now() < until {
        small.headless.step(1);
        std::thread::sleep(Duration::from_millis(5));
    }
    small.headless.step(12);
    assert_eq!(small.errors(), 1, "errors, of which one was wanted");
    assert_eq!(starts(small), before + 1, "starts of the renderer");
}

/// Styles with their names; the first one is none.
type Styles = [(&'static str, Option<ComicStyle>)];

/// The picture of the engine alone, and those of the styles, with highlighted objects.
fn shoot_all(
    (small, highlighted): (&mut Small, [Entity; 2]),
    msaa: Msaa,
    styles: &Styles,
) -> (RgbaImage, Vec<RgbaImage>) {
    highlight(small, highlighted, false);
    let plain = shoot(small, msaa, None);
    highlight(small, highlighted, true);
    let styles = styles.iter();
    let styled = styles.map(|(_, style)| shoot(small, msaa, style.as_ref()));
    (plain, styled.collect())
}

/// The camera has the last group while the device is replaced.
fn check(size: UVec2, msaa: Msaa, groups: &[Group]) {
    let (mut small, highlighted) = scene(size, msaa);
    let mut styles = vec![("highlighted objects", None)];
    styles.extend(groups.iter().map(|(name, style)| (*name, Some(style()))));
    let (last, all) = styles.last().cloned().expect("there is a first one");
    shoot(&mut small, msaa, all.as_ref());
    wait_for_sections(&mut small, "before");
    let (plain, before) = shoot_all((&mut small, highlighted), msaa, &styles);
    for (picture, (name, _)) in before.iter().zip(&styles) {
        let off = changed(&plain, picture, 1);
        assert!(off > 0.005, "{msaa:?}, {name}: {off} is changed");
    }
    recover(&mut small);
    wait_for_sections(&mut small, "on the new device");
    // The visible range, which is smoothed, settles.
    small.headless.step(120);
    let kept = small.picture();
    let (plain_again, after) = shoot_all((&mut small, highlighted), msaa, &styles);
    let off = changed(&plain, &plain_again, 1);
    assert_eq!(
        off, 0.0,
        "{msaa:?}: nothing is tested, since the ENGINE draws another picture on the new device"
    );
    for ((before, after), (name, _)) in before.iter().zip(&after).zip(&styles) {
        let off = changed(before, after, 1);
        assert_eq!(off, 0.0, "{msaa:?}, {name}, new camera: {off} differs");
    }
    let off = changed(before.last().expect("pictures"), &kept, 1);
    assert_eq!(off, 0.0, "{msaa:?}, {last}, same camera: {off} differs");
    assert_eq!(small.errors(), 1, "{msaa:?}: errors on the new device");
}

#[test]
#[ignore = "long: every effect on two devices"]
fn styles_are_the_same_on_a_new_device() {
    check(size(), Msaa::Off, &GROUPS);
}

#[test]
#[ignore = "long: all effects on two devices"]
fn multisampled_styles_are_the_same_on_a_new_device() {
    // The one with all effects.
    check(size(), Msaa::Sample4, &GROUPS[GROUPS.len() - 1..]);
}
