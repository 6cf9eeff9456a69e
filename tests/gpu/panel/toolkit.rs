//! The panel beside a game's own egui windows, and the order of the plugins.

use bevy::{
    camera::ImageRenderTarget,
    window::{PrimaryWindow, WindowResolution},
};
use bevy_comics_inspector::{ComicsInspector, ComicsInspectorPlugin};
use bevy_comics_testkit::headless;
use bevy_egui::{EguiContext, EguiContexts, EguiPlugin, EguiPrimaryContextPass, egui};

use crate::prelude::*;

fn options() -> HeadlessOptions {
    HeadlessOptions {
        size: UVec2::new(160, 120),
        ..default()
    }
}

fn inspector() -> ComicsInspectorPlugin {
    ComicsInspectorPlugin {
        memory: None,
        ..default()
    }
}

/// The game's own window.
fn score(mut contexts: EguiContexts) -> Result {
    egui::Window::new("Score")
        .fixed_pos([20.0, 20.0])
        .show(contexts.ctx_mut()?, |ui| ui.label("1200 points"));
    Ok(())
}

/// Starts an app with a camera that draws nothing but black, and renders some
/// frames.
fn start(app: App) -> Headless {
    start_with(app, ())
}

/// The same with a style on the camera.
fn start_with(app: App, style: impl Bundle) -> Headless {
    let mut app = Headless::of(app, options());
    let target = app.render_target();
    app.app.insert_resource(ClearColor(Color::BLACK));
    app.app
        .world_mut()
        .spawn((Camera3d::default(), style, target));
    app.step(6);
    app
}

/// An app with the engine's plugins.
fn app() -> App {
    headless::adapter().unwrap_or_else(|message| panic!("{message}"));
    let mut app = App::new();
    app.add_plugins(headless::plugins(&options()));
    app
}

fn contexts(app: &mut Headless) -> usize {
    let world = app.app.world_mut();
    world.query::<&EguiContext>().iter(world).count()
}

/// Whether the game's window is in the picture, which is black without it.
fn shows_score(app: &mut Headless) -> bool {
    let drawn = app
        .picture()
        .pixels()
        .filter(|pixel| pixel.0[..3] != [0; 3])
        .count();
    drawn > 1000
}

#[test]
fn a_games_windows_work_where_the_panels_plugin_comes_first() {
    let mut app = app();
    app.add_plugins((ComicsPlugin, inspector(), EguiPlugin::default()));
    assert_windows_work(app);
}

#[test]
fn a_games_windows_work_where_the_toolkits_plugin_comes_first() {
    let mut app = app();
    app.add_plugins((EguiPlugin::default(), inspector(), ComicsPlugin));
    assert_windows_work(app);
}

fn assert_windows_work(mut app: App) {
    app.add_systems(EguiPrimaryContextPass, score);
    let mut app = start_with(app, Contours::default());
    assert!(shows_score(&mut app), "beside the closed panel");
    assert_eq!(contexts(&mut app), 1, "a closed panel has no context");
    open_panel(&mut app);
    assert!(shows_score(&mut app), "beside the open panel");
    assert_eq!(contexts(&mut app), 2);
}

/// A game that only adds systems for its windows gets its context as well.
#[test]
fn a_games_windows_work_with_the_toolkit_that_the_panel_adds() {
    let mut app = app();
    app.add_plugins((ComicsPlugin, inspector()));
    app.add_systems(EguiPrimaryContextPass, score);
    assert!(shows_score(&mut start(app)));
}

/// Opens the panel in a window, which is not shown: the layout needs its size
/// only.
fn open_panel(app: &mut Headless) {
    app.app.world_mut().spawn((
        Window {
            resolution: WindowResolution::new(800, 600),
            ..default()
        },
        PrimaryWindow,
    ));
    app.app.world_mut().resource_mut::<ComicsInspector>().open = true;
    app.step(6);
    let inspector = app.app.world().resource::<ComicsInspector>();
    assert!(
        inspector.widgets.contains_key("contours"),
        "the panel is laid out"
    );
}

#[test]
fn a_closed_panel_alone_has_no_context() {
    let mut app = app();
    app.add_plugins((ComicsPlugin, inspector()));
    let mut app = start(app);
    assert_eq!(contexts(&mut app), 0);
    assert!(!shows_score(&mut app), "the picture is black");
    open_panel(&mut app);
    assert_eq!(contexts(&mut app), 1);
    app.app.world_mut().resource_mut::<ComicsInspector>().open = false;
    app.step(1);
    assert_eq!(contexts(&mut app), 0);
}

#[test]
fn the_panels_plugin_may_come_before_all_others() {
    headless::adapter().unwrap_or_else(|message| panic!("{message}"));
    let mut app = App::new();
    app.add_plugins(inspector())
        .add_plugins(headless::plugins(&options()))
        .add_plugins(ComicsPlugin);
    let mut app = start(app);
    open_panel(&mut app);
}

/// The panel that is opened before the game has a camera leaves the context to
/// the game's first camera.
#[test]
fn an_open_panel_leaves_the_first_camera_its_context() {
    let mut app = app();
    app.add_plugins((ComicsPlugin, inspector(), EguiPlugin::default()))
        .add_systems(EguiPrimaryContextPass, score);
    app.world_mut().spawn((Window::default(), PrimaryWindow));
    app.finish();
    app.cleanup();
    app.world_mut().resource_mut::<ComicsInspector>().open = true;
    for _ in 0..3 {
        app.update();
    }
    let handle: Handle<Image> = {
        let options = options();
        new_target(app.world_mut(), options.size, options.format)
    };
    let target = RenderTarget::Image(ImageRenderTarget::from(handle));
    let camera = app.world_mut().spawn((Camera3d::default(), target)).id();
    for _ in 0..4 {
        app.update();
    }
    assert!(app.world().entity(camera).contains::<EguiContext>());
    let world = app.world_mut();
    assert_eq!(world.query::<&EguiContext>().iter(world).count(), 2);
}

/// Without `ComicsPlugin` the app runs on without a panel; the log says why.
#[test]
fn an_app_without_the_comics_plugin_runs_on() {
    let mut app = app();
    app.add_plugins(inspector());
    let mut app = start(app);
    app.app.world_mut().resource_mut::<ComicsInspector>().open = true;
    app.step(2);
    assert!(!app.app.is_plugin_added::<EguiPlugin>());
}
