//! Pipelines that are not ready, styles and cameras that come and go.

use super::{
    prepasses::{allocated, in_background, is_compiling, step, still},
    *,
};

/// While a pipeline compiles, or has failed to, the original picture is shown.
#[test]
fn a_picture_is_never_lost_while_a_pipeline_is_missing() {
    let mut small = in_background();
    let original = still(&mut small);
    small.style(&full_style());
    let mut was_missing = false;
    for _ in 0..12 {
        step(&mut small);
        was_missing |= is_compiling(&small);
        let background = small.picture().get_pixel(1, 1).0;
        assert_ne!(background, [0, 0, 0, 0], "the picture was lost");
    }
    assert!(was_missing, "every pipeline was there at once");
    let styled = still(&mut small);
    assert_ne!(styled, original);

    // A broken shader shows the original picture; a repaired one, the style.
    let (id, source) = shader(&mut small, "fused/fused.wgsl");
    replace(
        &mut small,
        id,
        "@fragment fn stylize() -> nonsense {".into(),
    );
    small.settle();
    assert_eq!(
        small.picture(),
        original,
        "a broken shader must leave the picture as it is"
    );
    let camera = small.camera;
    assert_eq!(
        outcome(&small, camera, ComicsStage::Stylize),
        Some(StageOutcome::Skipped(SkipReason::PipelineNotReady))
    );
    replace(&mut small, id, source);
    assert_eq!(still(&mut small), styled);
}

fn shader(small: &mut Small, name: &str) -> (AssetId<Shader>, String) {
    let shaders = small.world().resource::<Assets<Shader>>();
    let (id, shader) = shaders
        .iter()
        .find(|(_, shader)| shader.path.ends_with(name) && shader.path.contains("bevy_comics"))
        .expect("the shader is an asset");
    let bevy::shader::Source::Wgsl(text) = &shader.source else {
        panic!("not WGSL")
    };
    (id, text.to_string())
}

fn replace(small: &mut Small, id: AssetId<Shader>, text: String) {
    let mut shaders = small.world().resource_mut::<Assets<Shader>>();
    let path = shaders.get(id).expect("there").path.clone();
    shaders
        .insert(id, Shader::from_wgsl(text, path))
        .expect("replaced");
}

#[test]
fn without_a_renderer_the_plugin_does_nothing() {
    let mut with_assets = App::new();
    with_assets.add_plugins((MinimalPlugins, AssetPlugin::default(), ComicsPlugin));
    with_assets.update();
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, ComicsPlugin));
    let style = (Contours::default(), Desaturation::default());
    let camera = app.world_mut().spawn(style).id();
    for _ in 0..3 {
        app.update();
    }
    assert!(app.world().get::<Contours>(camera).is_some());
    let diagnostics = app.world().resource::<ComicsDiagnostics>();
    assert!(diagnostics.cameras.is_empty());
}

/// Whether the diagnostics list the camera.
fn is_listed(small: &Small) -> bool {
    let diagnostics = small.headless.app.world().resource::<ComicsDiagnostics>();
    diagnostics.cameras.contains_key(&small.camera)
}

#[test]
fn a_removed_style_and_an_inactive_camera_run_nothing() {
    let mut small = Small::new(size(), Msaa::Off);
    let original = small.settle().picture();
    assert_ne!(small.shot(&full_style()), original);
    let removed = small.shot(&ComicStyle::default());
    assert_eq!(removed, original, "a removed style leaves no trace");
    assert!(!small.camera_mut().contains::<DepthPrepass>());
    assert!(!is_listed(&small));

    small.style(&full_style()).settle();
    // Edits the component. In Bevy 0.19.1 a `Camera` that is replaced has no
    // target until its projection changes, with or without a style.
    for is_active in [false, true] {
        let mut camera = small.camera_mut();
        camera.get_mut::<Camera>().expect("a camera").is_active = is_active;
        small.settle();
        assert_eq!(is_listed(&small), is_active);
    }
    assert!(small.ran(ComicsStage::Stylize));
    small.camera_mut().despawn();
    small.headless.step(3);
    let diagnostics = small.headless.app.world().resource::<ComicsDiagnostics>();
    assert!(diagnostics.cameras.is_empty());
}

#[test]
fn views_that_come_and_go_leave_no_buffers() {
    // No buffers of other tests end beside those of this one.
    let mut small = Small::alone(options(size()), Msaa::Off);
    small.style(&full_style()).settle();
    let buffers = |small: &Small| allocated(small)[0];
    small.headless.step(6);
    let before = buffers(&small);
    assert!(before > 0, "the report counts nothing");
    for _ in 0..6 {
        let target: RenderTarget = small.headless.render_target();
        let order = Camera {
            order: 1,
            ..default()
        };
        let style = (Contours::default(), VisibleDepthRange::default());
        let extra = (camera(target, Msaa::Off), style);
        let extra = small.world().spawn(extra).insert(order).id();
        small.headless.step(3);
        small.world().despawn(extra);
        small.headless.step(3);
    }
    small.headless.step(6);
    let after = buffers(&small);
    assert!(after <= before + 8, "{before} buffers grew to {after}");
}
