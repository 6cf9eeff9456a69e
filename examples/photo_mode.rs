//! Photo mode: pause the game, fly around, choose a look, and save a picture that is twice as
//! large as the window.

use std::process::ExitCode;

use bevy::{
    camera::{ImageRenderTarget, RenderTarget},
    input::{common_conditions::input_just_pressed, mouse::AccumulatedMouseMotion},
    prelude::*,
    render::{
        render_resource::TextureFormat,
        renderer::RenderDevice,
        view::{
            Msaa,
            screenshot::{Screenshot, ScreenshotCaptured, save_to_disk},
        },
    },
};
use bevy_comics::{ComicsDiagnostics, presets, style::Preset};
use bevy_comics_testkit::{
    demo::{Demo, Screen},
    headless::{Headless, new_target},
    scenes::{BuiltIn, Stage, figure::motion::MotionPlugin},
    studio::{set_style, set_toon},
};

/// How much larger a photo is than the window.
const SCALE: u32 = 2;

const STYLES: [Preset; 6] = [
    presets::SATURDAY_MORNING,
    presets::SILVER_AGE,
    presets::MANGA_PAGE,
    presets::WATERCOLOR,
    presets::ENGRAVING,
    presets::NOIR,
];

const KEYS: &str = "\
P            photo mode: pause and go on
W A S D Q E  fly, with the mouse button held: look around
Left Right   look
Enter        save a photo in the working folder";

/// The camera of the game, and its look as an index of [`STYLES`].
#[derive(Component)]
struct Photographer {
    look: usize,
}

/// The photo that is being taken.
#[derive(Resource)]
struct Photo {
    image: ImageRenderTarget,
    /// What the camera draws to otherwise.
    before: RenderTarget,
    frames: u32,
}

fn spawn(mut stage: Stage, screen: Res<Screen>) {
    let vantage = stage.spawn(BuiltIn::Figure);
    let mut camera = stage.commands.spawn(vantage.camera());
    camera.insert((
        screen.target.clone(),
        Msaa::Sample4,
        Photographer { look: 0 },
    ));
    set_style(&mut camera, &STYLES[0].style());
    stage
        .commands
        .queue(|world: &mut World| set_toon(world, true));
    stage.commands.spawn((
        Text::new(KEYS),
        TextFont {
            font_size: FontSize::Px(15.0),
            ..default()
        },
        Node {
            margin: UiRect::all(px(10)),
            padding: UiRect::all(px(10)),
            ..default()
        },
        BackgroundColor(Color::srgba(0.05, 0.05, 0.08, 0.72)),
    ));
}

/// The game's clock stands still in the photo mode. Strokes and everything that is drawn anew stand
/// still with it.
fn pause(mut time: ResMut<Time<Virtual>>) {
    if time.is_paused() {
        time.unpause();
    } else {
        time.pause();
    }
}

fn choose_look(
    keys: Res<ButtonInput<KeyCode>>,
    mut commands: Commands,
    mut camera: Single<(Entity, &mut Photographer)>,
) {
    let step = if keys.just_pressed(KeyCode::ArrowRight) {
        1
    } else if keys.just_pressed(KeyCode::ArrowLeft) {
        STYLES.len() - 1
    } else {
        return;
    };
    let (entity, photographer) = &mut *camera;
    photographer.look = (photographer.look + step) % STYLES.len();
    let style = STYLES[photographer.look].style();
    set_style(&mut commands.entity(*entity), &style);
}

/// Moves the camera by the clock that does not stand still.
fn fly(
    keys: Res<ButtonInput<KeyCode>>,
    buttons: Res<ButtonInput<MouseButton>>,
    mouse: Res<AccumulatedMouseMotion>,
    time: Res<Time<Real>>,
    mut camera: Single<&mut Transform, With<Photographer>>,
) {
    let axis =
        |plus, minus| f32::from(i8::from(keys.pressed(plus)) - i8::from(keys.pressed(minus)));
    let wish = Vec3::new(
        axis(KeyCode::KeyD, KeyCode::KeyA),
        axis(KeyCode::KeyE, KeyCode::KeyQ),
        axis(KeyCode::KeyS, KeyCode::KeyW),
    );
    let step = camera.rotation * wish * 2.0 * time.delta_secs();
    camera.translation += step;
    if buttons.pressed(MouseButton::Left) {
        let turn = mouse.delta * -0.003;
        camera.rotate_y(turn.x);
        camera.rotate_local_x(turn.y);
    }
}

/// Sends the camera's picture to a larger image. Lines grow with the scale factor, so that the
/// photo looks as the window does.
fn begin(world: &mut World) {
    if world.contains_resource::<Photo>() {
        return;
    }
    let mut cameras = world.query_filtered::<(Entity, &Camera), With<Photographer>>();
    let Ok((entity, camera)) = cameras.single(world) else {
        return;
    };
    let (Some(size), Some(scale)) = (
        camera.physical_target_size(),
        camera.target_scaling_factor(),
    ) else {
        return;
    };
    // No larger than the adapter's textures.
    let most = world
        .get_resource::<RenderDevice>()
        .map_or(8192, |device| device.limits().max_texture_dimension_2d);
    let larger = (most / size.max_element().max(1)).clamp(1, SCALE);
    let image = ImageRenderTarget {
        handle: new_target(world, size * larger, TextureFormat::Rgba8UnormSrgb),
        scale_factor: scale * larger as f32,
    };
    let before = redirect(world, entity, RenderTarget::Image(image.clone()));
    world.insert_resource(Photo {
        image,
        before,
        frames: 0,
    });
}

/// Gives a camera another target, and returns the one that it had.
fn redirect(world: &mut World, camera: Entity, target: RenderTarget) -> RenderTarget {
    let mut camera = world.entity_mut(camera);
    let before = camera.take::<RenderTarget>().unwrap_or_default();
    camera.insert(target);
    // The engine looks at the size of a target again when the projection changes.
    if let Some(mut projection) = camera.get_mut::<Projection>() {
        projection.set_changed();
    }
    before
}

/// Saves the photo when all pipelines are compiled and a few frames are drawn.
fn develop(
    mut commands: Commands,
    mut photo: ResMut<Photo>,
    screen: Res<Screen>,
    diagnostics: Res<ComicsDiagnostics>,
    camera: Single<Entity, With<Photographer>>,
) {
    photo.frames += u32::from(!diagnostics.is_compiling(*camera));
    if photo.frames == 6 && screen.out.is_none() {
        let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
        let name = format!("photo-{}.png", now.map_or(0, |since| since.as_millis()));
        info!("{name}");
        commands
            .spawn(Screenshot(RenderTarget::Image(photo.image.clone())))
            .observe(save_to_disk(name))
            .observe(|_: On<ScreenshotCaptured>, mut commands: Commands| {
                commands.queue(end);
            });
    }
}

/// Gives the camera its window back.
fn end(world: &mut World) {
    let mut cameras = world.query_filtered::<Entity, With<Photographer>>();
    if let Ok(camera) = cameras.single(world)
        && let Some(photo) = world.remove_resource::<Photo>()
    {
        redirect(world, camera, photo.before);
    }
}

/// A photo from closer by, as a player would take it.
fn photograph(headless: &mut Headless) -> image::RgbaImage {
    let world = headless.app.world_mut();
    world.resource_mut::<Time<Virtual>>().pause();
    let mut cameras = world.query_filtered::<&mut Transform, With<Photographer>>();
    for mut camera in cameras.iter_mut(world) {
        let eye = Vec3::new(-1.5, -0.5, 6.6);
        *camera = Transform::from_translation(eye).looking_at(Vec3::new(0.25, -0.2, 0.0), Vec3::Y);
        camera.rotate_local_z(0.12);
    }
    begin(world);
    headless.step(7);
    let image = headless
        .app
        .world()
        .resource::<Photo>()
        .image
        .handle
        .clone();
    headless.picture_of(&image)
}

fn main() -> ExitCode {
    let demo = Demo {
        title: "Photo mode",
        keys: KEYS,
        size: UVec2::new(480, 360),
        frames: 4,
    };
    let add = |app: &mut App| {
        app.add_plugins(MotionPlugin)
            .add_systems(Startup, spawn)
            .add_systems(
                Update,
                (
                    pause.run_if(input_just_pressed(KeyCode::KeyP)),
                    begin.run_if(input_just_pressed(KeyCode::Enter)),
                    choose_look,
                    fly,
                    develop.run_if(resource_exists::<Photo>),
                ),
            );
    };
    demo.run_with(add, photograph)
}
