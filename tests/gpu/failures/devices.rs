//! Devices that are lost, lack something, or allow little.

use bevy::render::{
    error_handler::{ErrorType, RenderErrorHandler, RenderErrorPolicy},
    occlusion_culling::OcclusionCulling,
    renderer::RenderDevice,
    settings::WgpuSettings,
};
use bevy::{light::cluster::GlobalClusterSettings, pbr::Lightmap};
use bevy_comics::{DepthWrite, Halftone, Hatching, Outlines, Paint, Paper};
use bevy_comics_testkit::{device::gpu, scenes::BuiltIn, studio::Studio};

use super::*;

/// A style that has passes of every kind: range, lines, screens, boxes, textures.
fn many_passes() -> ComicStyle {
    full_style()
        .with(Outlines::default())
        .with(Hatching::default())
        .with(Halftone::default())
        .with(Paint::default())
        .with(Paper::default())
}

/// How often an error was reported.
#[derive(Resource, Default)]
struct Reported(usize);

/// After an error for which the app asks for a new device, styles are drawn again and no error follows.
/// What the engine draws after it is not what it drew before, with or without a style; a device that is
/// lost ends the app, since the engine's clusters of lights panic (Bevy 0.19.1).
#[test]
fn styles_come_back_on_a_new_device() {
    let recovered = |msaa: Msaa, style: Option<&ComicStyle>| {
        let mut studio = Studio::new(BuiltIn::Teapot, size(), msaa);
        studio.shoot(style);
        let app = &mut studio.headless.app;
        app.init_resource::<Reported>();
        app.insert_resource(RenderErrorHandler(|error, main, _| {
            assert!(matches!(error.ty, ErrorType::Validation), "{error:?}");
            main.resource_mut::<Reported>().0 += 1;
            RenderErrorPolicy::Recover(WgpuSettings::default().into())
        }));
        let world = app.sub_app(RenderApp).world();
        // A buffer must have a use.
        let _ = world
            .resource::<RenderDevice>()
            .create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: 16,
                usage: wgpu::BufferUsages::empty(),
                mapped_at_creation: false,
            });
        studio.headless.step(12);
        assert_eq!(studio.headless.app.world().resource::<Reported>().0, 1);
        studio.headless.picture()
    };
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let plain = recovered(msaa, None);
        let styled = recovered(msaa, Some(&many_passes()));
        let off = changed(&plain, &styled);
        assert!(off > 0.1, "{msaa:?}: {off} of the picture is styled");
    }
}

/// The engine cannot give cameras of one target prepasses with different samples: the first camera has
/// them, and the other one is drawn without.
#[test]
fn cameras_with_different_samples_share_a_target() {
    let mut small = Small::new(size(), Msaa::Off);
    let target = small.headless.render_target();
    let second = small.world().spawn(camera(target, Msaa::Sample4)).id();
    let mut own = small.world().get_mut::<Camera>(second).expect("a camera");
    own.order = 1;
    own.clear_color = ClearColorConfig::None;
    let style = many_passes();
    small.style(&style);
    let world = small.world();
    style.apply(&mut world.commands().entity(second));
    world.flush();
    small.headless.step(8);
    assert_eq!(small.errors(), 0);
    let has = |small: &Small, camera| {
        let world = small.headless.app.world();
        world.get::<DepthPrepass>(camera).is_some()
    };
    let first = small.camera;
    assert!(has(&small, first) && !has(&small, second));
    assert_eq!(
        outcome(&small, second, ComicsStage::Stylize),
        Some(StageOutcome::Ran)
    );
    // With the same samples, both have one; and again not.
    small.insert(Msaa::Sample4);
    small.headless.step(8);
    assert!(has(&small, first) && has(&small, second));
    small.insert(Msaa::Off);
    small.headless.step(8);
    assert!(has(&small, first) && !has(&small, second));
    // The prepass of a game stays, and the other camera goes without.
    small.world().entity_mut(second).insert(DepthPrepass);
    small.headless.step(8);
    assert!(!has(&small, first) && has(&small, second));
}

/// Objects that the engine leaves out because others hide them are not missed, from the first frame on and
/// where it begins later.
#[test]
fn occlusion_culling_changes_nothing() {
    let shoot = |small: &mut Small| {
        let ids = small.object_ids().expect("ids are drawn");
        (small.picture(), ids.pixels)
    };
    let mut apps = [false, true].map(|culls| {
        let mut small = Small::new(size(), Msaa::Off);
        small.style(&many_passes());
        // A wall before half of the scene.
        small.put(
            Cuboid::new(1.2, 3.0, 0.2),
            StandardMaterial::default(),
            Transform::from_xyz(0.6, 0.5, 2.0),
        );
        if culls {
            small.insert(OcclusionCulling);
        }
        small.settle();
        small
    });
    let (before, ids) = shoot(&mut apps[0]);
    assert!(ids.iter().any(|id| id[0] != 0), "no ids");
    apps[0].insert(OcclusionCulling);
    apps[0].headless.step(8);
    for small in &mut apps {
        let (picture, found) = shoot(small);
        assert!(found == ids, "other ids");
        let off = changed(&before, &picture);
        assert!(off == 0.0, "{off} differs");
        assert_eq!(small.errors(), 0);
    }
}

/// The picture of the first frame after a wall is gone, and that of a later one.
fn behind_a_wall(style: Option<&ComicStyle>) -> [image::RgbaImage; 2] {
    let mut small = Small::new(size(), Msaa::Off);
    // The culling reads the prepass of the frame before.
    small.insert((DepthPrepass, OcclusionCulling));
    if let Some(style) = style {
        small.style(style);
    }
    let wall = small.put(
        Cuboid::new(1.2, 3.0, 0.2),
        StandardMaterial::default(),
        Transform::from_xyz(0.6, 0.5, 2.0),
    );
    small.headless.step(8);
    small.world().despawn(wall);
    small.headless.step(1);
    let first = small.picture();
    small.headless.step(8);
    assert_eq!(small.errors(), 0);
    [first, small.picture()]
}

/// What was hidden and is not any more is drawn by the late prepass of the engine: effects that read
/// depth, normals or ids before it would miss it for a frame.
#[test]
fn what_is_no_longer_hidden_is_styled_at_once() {
    let [first, later] = behind_a_wall(None);
    assert_eq!(
        changed(&first, &later),
        0.0,
        "the engine draws it later: nothing is tested"
    );
    // Without smoothing, the range is that of its own frame.
    let style = many_passes().with_depth_map(DepthMap {
        smoothing: None,
        ..default()
    });
    let [first, later] = behind_a_wall(Some(&style));
    let off = changed(&first, &later);
    assert_eq!(off, 0.0, "{off} of the picture is styled later");
}

/// Nothing that is allocated is larger than the target, which may be as large as the device allows.
#[test]
fn the_largest_target_is_styled() {
    let most = 1024;
    for size in [UVec2::new(most, 16), UVec2::new(16, most)] {
        let limits = wgpu::Limits {
            max_texture_dimension_2d: most,
            ..gpu().device.limits()
        };
        let options = HeadlessOptions {
            limits: Some(limits),
            ..options(size)
        };
        let mut small = Small::with(options, Msaa::Off);
        let plain = small.settle().picture();
        small.style(&many_passes());
        small.settle();
        assert_eq!(small.errors(), 0, "{size}");
        assert!(
            changed(&plain, &small.picture()) > 0.1,
            "{size} is not styled"
        );
    }
}

/// An opaque and a transparent cube with lightmaps.
fn put_lightmapped(small: &mut Small) {
    let mut mesh = Mesh::from(Cuboid::from_length(0.8));
    let places = mesh
        .attribute(Mesh::ATTRIBUTE_UV_0)
        .expect("a cube has some");
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_1, places.clone());
    let white = small
        .world()
        .resource_mut::<Assets<Image>>()
        .add(Image::default());
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
    small.style(&many_passes());
    small.settle();
    assert_eq!(small.errors(), 0);
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
    put_lightmapped(&mut small);
    // The engine decides by the adapter, not by its limits, whether it has compute shaders, and fails.
    let mut clusters = small.world().resource_mut::<GlobalClusterSettings>();
    clusters.gpu_clustering = None;
    let plain = small.settle().picture();
    let of_engine = small.errors();
    small.settle();
    let each = small.errors() - of_engine;
    small.style(&many_passes());
    small.settle();
    assert_eq!(
        small.errors(),
        of_engine + 2 * each,
        "{each} are the engine's"
    );
    assert!(changed(&plain, &small.picture()) > 0.1, "it is not styled");
}
