//! Devices that lack something, or allow little, and what the engine cannot do.

use std::sync::Arc;

use bevy::{pbr::Lightmap, render::occlusion_culling::OcclusionCulling};
use bevy_comics_testkit::device::gpu;

use super::*;
use crate::prelude::*;

/// A style that has passes of every kind: range, lines, screens, boxes, textures.
fn many_passes() -> ComicStyle {
    full_style()
        .with(Outlines::default())
        .with(Hatching::default())
        .with(Halftone::default())
        .with(Paint::default())
        .with(Paper::default())
}

/// A camera without multisampling, and another one that draws over it to the same target.
fn with_second_camera(size: UVec2, msaa: Msaa) -> (Small, Entity) {
    let mut small = Small::new(size, Msaa::Off);
    // Where a later pass of a frame fails, wgpu runs none of its commands but maps the engine's
    // copy of the numbers of clusters, whose memory counts as written and is not: the engine (Bevy
    // 0.19.1) overflows.
    cluster_on_cpu(&mut small);
    let target = small.headless.render_target();
    let second = small.world().spawn(camera(target, msaa)).id();
    let mut own = small.world().get_mut::<Camera>(second).expect("a camera");
    own.order = 1;
    own.clear_color = ClearColorConfig::None;
    (small, second)
}

/// Gives both cameras a style.
fn style_both(small: &mut Small, second: Entity) {
    let style = many_passes();
    small.style(&style);
    let world = small.world();
    style.apply(&mut world.commands().entity(second));
    world.flush();
}

/// The engine cannot give cameras of one target prepasses with different samples: the first camera
/// has them, and the other one is drawn without.
#[test]
#[ignore = "long: many frames of two cameras"]
fn cameras_with_different_samples_share_a_target() {
    let (mut small, second) = with_second_camera(tiny(), Msaa::Sample4);
    style_both(&mut small, second);
    small.headless.step(6);
    let has = |small: &Small, camera| {
        let world = small.headless.app.world();
        world.get::<DepthPrepass>(camera).is_some()
    };
    let first = small.camera;
    assert!(has(&small, first) && !has(&small, second));
    let styled = outcome(&small, second, ComicsStage::Stylize);
    assert_eq!(styled, Some(StageOutcome::Ran));
    // With the same samples, both have one; and again not.
    for (msaa, same) in [(Msaa::Sample4, true), (Msaa::Off, false)] {
        small.insert(msaa);
        small.headless.step(8);
        assert!(has(&small, first) && has(&small, second) == same);
    }
    // The prepass of a game stays, and the other camera goes without.
    small.world().entity_mut(second).insert(DepthPrepass);
    small.headless.step(8);
    assert!(!has(&small, first) && has(&small, second));
}

/// Texts of errors, without numbers.
type Errors = Arc<Mutex<BTreeSet<String>>>;

/// Keeps all errors of the device; the engine keeps the first one of a frame.
fn listen(small: &Small) -> Errors {
    let errors = Errors::default();
    let kept = errors.clone();
    let device = small.render_world().resource::<RenderDevice>();
    device
        .wgpu_device()
        .on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let text = error.to_string().replace(|c: char| c.is_ascii_digit(), "");
            let text = text.replace("true", "?").replace("false", "?");
            kept.lock().expect("no panic").insert(text);
        }));
    errors
}

/// The errors of some frames.
fn errors_of(small: &mut Small, errors: &Errors, frames: usize) -> BTreeSet<String> {
    errors.lock().expect("no panic").clear();
    small.headless.step(frames);
    errors.lock().expect("no panic").clone()
}

/// Where the game itself gives both cameras a prepass, passes of the engine fail. This crate adds
/// no error, and the diagnostics say why one of the cameras has no ids of objects.
#[test]
fn prepasses_of_a_game_with_different_samples_are_reported() {
    let (mut small, second) = with_second_camera(size(), Msaa::Sample4);
    let cameras = [small.camera, second];
    let ids = |small: &Small| cameras.map(|camera| outcome(small, camera, ComicsStage::ObjectIds));
    let errors = listen(&small);
    for camera in cameras {
        small.world().entity_mut(camera).insert(DepthPrepass);
    }
    let of_engine = errors_of(&mut small, &errors, 8);
    assert!(
        !of_engine.is_empty(),
        "the engine can do it: docs/troubleshooting.md is out of date"
    );
    style_both(&mut small, second);
    let all = errors_of(&mut small, &errors, 8);
    let own: Vec<_> = all.difference(&of_engine).collect();
    assert!(own.is_empty(), "{own:#?}, besides {of_engine:#?}");
    let mismatch = Some(StageOutcome::Skipped(SkipReason::SampleCountMismatch));
    let found = ids(&small);
    let count = found.iter().filter(|found| **found == mismatch).count();
    assert_eq!(count, 1, "{found:?}");
    // The game takes one prepass away again.
    small.world().entity_mut(second).remove::<DepthPrepass>();
    small.headless.step(4);
    let left = errors_of(&mut small, &errors, 8);
    assert!(left.is_empty(), "{left:#?}");
    assert!(!ids(&small).contains(&mismatch));
    assert!(small.ran(ComicsStage::ObjectIds) && small.ran(ComicsStage::DrawLines));
}

/// A wall before half of the scene.
fn put_wall(small: &mut Small) -> Entity {
    let at = Transform::from_xyz(0.6, 0.5, 2.0);
    small.put(Cuboid::new(1.2, 3.0, 0.2), StandardMaterial::default(), at)
}

/// Objects that the engine leaves out because others hide them are not missed, from the first frame
/// on and where it begins later.
#[test]
fn occlusion_culling_changes_nothing() {
    let shoot = |small: &mut Small| {
        let ids = small.object_ids().expect("ids are drawn");
        (small.picture(), ids.pixels)
    };
    let mut small = Small::new(size(), Msaa::Off);
    small.style(&many_passes());
    put_wall(&mut small);
    small.settle();
    let (before, ids) = shoot(&mut small);
    assert!(ids.iter().any(|id| id[0] != 0), "no ids");
    let check = |small: &mut Small| {
        let (picture, found) = shoot(small);
        assert!(found == ids, "other ids");
        let off = changed(&before, &picture, 1);
        assert!(off == 0.0, "{off} differs");
    };
    small.insert(OcclusionCulling);
    small.headless.step(6);
    check(&mut small);
    // A camera that has it from its first frame on.
    let target = small.headless.render_target();
    small.camera_mut().despawn();
    let new = (camera(target, Msaa::Off), OcclusionCulling);
    small.camera = small.world().spawn(new).id();
    small.style(&many_passes()).settle();
    check(&mut small);
}

/// The picture of the first frame after a wall is gone, and that of a later one.
fn behind_a_wall(style: Option<&ComicStyle>) -> [image::RgbaImage; 2] {
    let mut small = Small::new(size(), Msaa::Off);
    // The culling reads the prepass of the frame before.
    small.insert((DepthPrepass, OcclusionCulling));
    if let Some(style) = style {
        small.style(style);
    }
    let wall = put_wall(&mut small);
    small.headless.step(8);
    small.world().despawn(wall);
    small.headless.step(1);
    let first = small.picture();
    small.headless.step(8);
    [first, small.picture()]
}

/// What was hidden and is not any more is drawn by the late prepass of the engine: effects that
/// read depth, normals or ids before it would miss it for a frame.
#[test]
fn what_is_no_longer_hidden_is_styled_at_once() {
    let [first, later] = behind_a_wall(None);
    let off = changed(&first, &later, 1);
    assert_eq!(off, 0.0, "the engine draws it later: nothing is tested");
    // Without smoothing, the range is that of its own frame.
    let style = many_passes().with_depth_map(DepthMap {
        smoothing: None,
        ..default()
    });
    let [first, later] = behind_a_wall(Some(&style));
    let off = changed(&first, &later, 1);
    assert_eq!(off, 0.0, "{off} of the picture is styled later");
}

/// Nothing that is allocated is larger than the target, which may be as large as the device allows.
#[test]
fn the_largest_target_is_styled() {
    let most = 1024;
    let sizes = [UVec2::new(most, 16), UVec2::new(16, most)];
    let limits = wgpu::Limits {
        max_texture_dimension_2d: most,
        ..gpu().device.limits()
    };
    let options = HeadlessOptions {
        limits: Some(limits),
        ..options(sizes[0])
    };
    let mut small = Small::with(options, Msaa::Off);
    for size in sizes {
        small.headless.resize(size, 1.0);
        small.restart(Msaa::Off);
        let plain = small.settle().picture();
        small.style(&many_passes()).settle();
        assert!(
            changed(&plain, &small.picture(), 1) > 0.1,
            "{size} is not styled"
        );
    }
}

/// An opaque and a transparent cube with lightmaps.
fn put_lightmapped(small: &mut Small) {
    let mut mesh = Mesh::from(Cuboid::from_length(0.8));
    let places = mesh.attribute(Mesh::ATTRIBUTE_UV_0).cloned();
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_1, places.expect("a cube has some"));
    let mut images = small.world().resource_mut::<Assets<Image>>();
    let white = images.add(Image::default());
    for (x, alpha_mode) in [(-1.5, AlphaMode::Opaque), (1.5, AlphaMode::Blend)] {
        let material = StandardMaterial {
            alpha_mode,
            base_color: Color::srgba(0.8, 0.5, 0.4, 0.6),
            ..default()
        };
        let cube = small.put(mesh.clone(), material, Transform::from_xyz(x, 1.0, 1.5));
        let image = white.clone();
        let lightmap = Lightmap { image, ..default() };
        let mut cube = small.world().entity_mut(cube);
        cube.insert((lightmap, DepthWrite::default()));
    }
}

/// Lines of objects with lightmaps, which have bindings of other layouts.
#[test]
fn objects_with_lightmaps_have_lines() {
    let mut small = Small::new(size(), Msaa::Off);
    put_lightmapped(&mut small);
    let plain = small.settle().picture();
    let lines = changed(
        &plain,
        &small.shot(&ComicStyle::new().with(Outlines::default())),
        1,
    );
    assert!((0.005..0.2).contains(&lines), "{lines} of the picture");
    small.style(&many_passes()).settle();
}

/// Without compute shaders and storage, as in WebGL 2, a style is drawn without what needs them.
#[test]
fn a_device_without_compute_shaders_draws_a_style() {
    let limits = wgpu::Limits {
        max_compute_workgroup_size_x: 0,
        max_compute_workgroup_size_y: 0,
        max_compute_workgroup_size_z: 0,
        max_compute_invocations_per_workgroup: 0,
        max_compute_workgroups_per_dimension: 0,
        max_compute_workgroup_storage_size: 0,
        max_storage_textures_per_shader_stage: 0,
        ..gpu().device.limits()
    };
    let options = HeadlessOptions {
        limits: Some(limits),
        ..options(size())
    };
    let mut small = Small::with(options, Msaa::Off);
    small.count_errors();
    put_lightmapped(&mut small);
    // The engine decides by the adapter, not by its limits, whether it has compute shaders, and
    // fails.
    cluster_on_cpu(&mut small);
    let plain = small.settle().picture();
    let of_engine = small.errors();
    small.settle();
    let each = small.errors() - of_engine;
    small.style(&many_passes()).settle();
    assert_eq!(
        small.errors(),
        of_engine + 2 * each,
        "{each} are the engine's"
    );
    assert!(
        changed(&plain, &small.picture(), 1) > 0.1,
        "it is not styled"
    );
}
