//! Screenshots of the window's 3D cameras, several times as large as the window.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
    time::{SystemTime, UNIX_EPOCH},
};

use bevy::{
    asset::{Assets, Handle},
    camera::{Camera, Camera3d, ImageRenderTarget, Projection, RenderTarget, Viewport},
    ecs::{
        change_detection::DetectChangesMut,
        entity::Entity,
        observer::On,
        query::{With, Without},
        world::World,
    },
    image::Image,
    math::UVec2,
    render::{
        render_resource::TextureFormat,
        renderer::RenderDevice,
        view::window::screenshot::{Screenshot, ScreenshotCaptured},
    },
    window::WindowRef,
};
use bevy_egui::egui::{Slider, Ui};

use super::{
    Helper, PipelinesBusy, Widgets,
    fields::{self, button},
    note, window_size,
};
use crate::ComicsDiagnostics;

/// A camera whose target is the screenshot, and its own target and viewport.
struct Redirected {
    camera: Entity,
    target: RenderTarget,
    viewport: Option<Viewport>,
}

/// A screenshot that is being taken.
struct Shot {
    image: Handle<Image>,
    /// The image with a scale factor, by which the engine tells targets apart.
    target: ImageRenderTarget,
    cameras: Vec<Redirected>,
    frames: u32,
    /// Frames since the last pipeline was compiled.
    idle: u32,
    /// Whether the engine was asked for the image's pixels.
    asked: bool,
    /// The saved file or an error, from the engine's observer.
    answer: Arc<Mutex<Option<Result<PathBuf, String>>>>,
}

/// The page of screenshots.
pub struct Photo {
    folder: PathBuf,
    shot: Option<Shot>,
    /// The result of the last screenshot.
    last: Option<Result<PathBuf, String>>,
    /// The size of a requested screenshot relative to the window.
    wanted: Option<u32>,
}

/// Frames after which a screenshot is given up.
const PATIENCE: u32 = 1200;

impl Photo {
    pub fn new(folder: PathBuf) -> Self {
        Self {
            folder,
            shot: None,
            last: None,
            wanted: None,
        }
    }

    /// Whether a screenshot is being taken. The panel is hidden then.
    pub fn is_under_way(&self) -> bool {
        self.shot.is_some()
    }

    pub fn show(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        multiple: &mut u32,
        widgets: &mut Widgets,
    ) {
        let Some((window, _)) = window_size(world) else {
            ui.label("There is no window.");
            return;
        };
        let largest = largest(world, window);
        *multiple = (*multiple).clamp(1, largest);
        let slider = ui.add(Slider::new(multiple, 1..=largest).text("× window size"));
        note(widgets, "photo.multiple", &slider);
        let size = window * *multiple;
        ui.label(format!("{} x {} pixels", size.x, size.y));
        if button(ui, widgets, "photo.take", "Take a screenshot", true) {
            self.last = None;
            self.wanted = Some(*multiple);
        }
        ui.weak("Shows all 3D cameras of the window, without any user interface. Line widths grow with the picture.");
        match &self.last {
            Some(Ok(path)) => {
                let label = ui.label(format!("Saved {}", path.display()));
                note(widgets, "photo.saved", &label);
            }
            Some(Err(error)) => {
                fields::error(ui, error);
            }
            None => {}
        }
    }

    /// One step of a screenshot per frame: wait for pipelines, request the pixels,
    /// wait for them, give the cameras their targets back.
    pub fn step(&mut self, world: &mut World) {
        if let Some(multiple) = self.wanted.take()
            && let Some((window, _)) = window_size(world)
        {
            self.shot = begin(world, window, multiple);
            if self.shot.is_none() {
                self.last = Some(Err("No active 3D camera draws to the window.".into()));
            }
        }
        let Some(shot) = &mut self.shot else {
            return;
        };
        shot.frames += 1;
        let answer = shot
            .answer
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .take();
        if answer.is_some() || shot.frames > PATIENCE {
            self.last = Some(
                answer
                    .unwrap_or_else(|| Err("The renderer did not deliver the screenshot.".into())),
            );
            if let Some(shot) = self.shot.take() {
                end(world, shot);
            }
            return;
        }
        let diagnostics = world.resource::<ComicsDiagnostics>();
        let compiling = shot
            .cameras
            .iter()
            .any(|redirected| diagnostics.is_compiling(redirected.camera));
        // The render world is up to two frames behind.
        shot.idle = if compiling || world.resource::<PipelinesBusy>().get() {
            0
        } else {
            shot.idle + 1
        };
        if !shot.asked && shot.frames > 4 && shot.idle > 3 {
            shot.asked = true;
            let folder = self.folder.clone();
            let answer = shot.answer.clone();
            world
                .spawn(Screenshot(RenderTarget::Image(shot.target.clone())))
                .observe(move |captured: On<ScreenshotCaptured>| {
                    let saved = save(&captured.image, &folder);
                    *answer.lock().unwrap_or_else(PoisonError::into_inner) = Some(saved);
                });
        }
    }
}

/// The largest multiple of the window's size that the adapter can draw.
fn largest(world: &World, window: UVec2) -> u32 {
    let side = world
        .get_resource::<RenderDevice>()
        .map_or(8192, |device| device.limits().max_texture_dimension_2d);
    (side / window.max_element().max(1)).clamp(1, 8)
}

/// Redirects the window's 3D cameras to an image.
fn begin(world: &mut World, window: UVec2, multiple: u32) -> Option<Shot> {
    let size = (window * multiple).max(UVec2::ONE);
    let image = Image::new_target_texture(size.x, size.y, TextureFormat::Rgba8UnormSrgb, None);
    let image = world.resource_mut::<Assets<Image>>().add(image);
    let scale = window_size(world)?.1 * multiple as f32;
    let target_image = ImageRenderTarget {
        handle: image.clone(),
        scale_factor: scale,
    };
    let mut cameras = Vec::new();
    let mut query =
        world.query_filtered::<(Entity, &mut Camera, &mut RenderTarget, &mut Projection), (With<Camera3d>, Without<Helper>)>();
    for (entity, mut camera, mut target, mut projection) in query.iter_mut(world) {
        if !camera.is_active || !matches!(*target, RenderTarget::Window(WindowRef::Primary)) {
            continue;
        }
        let into = RenderTarget::Image(target_image.clone());
        cameras.push(Redirected {
            camera: entity,
            target: std::mem::replace(&mut *target, into),
            viewport: camera.viewport.clone(),
        });
        projection.set_changed();
        if let Some(viewport) = &mut camera.viewport {
            viewport.physical_position *= multiple;
            viewport.physical_size *= multiple;
        }
    }
    if cameras.is_empty() {
        world.resource_mut::<Assets<Image>>().remove(&image);
        return None;
    }
    Some(Shot {
        image,
        target: target_image,
        cameras,
        frames: 0,
        idle: 0,
        asked: false,
        answer: Arc::default(),
    })
}

/// Gives the cameras their targets back.
fn end(world: &mut World, shot: Shot) {
    for redirected in shot.cameras {
        let Ok(mut entity) = world.get_entity_mut(redirected.camera) else {
            continue;
        };
        entity.insert(redirected.target);
        if let Some(mut camera) = entity.get_mut::<Camera>() {
            camera.viewport = redirected.viewport;
        }
        // The engine updates a target's size when the projection changes, but not
        // when the target does.
        if let Some(mut projection) = entity.get_mut::<Projection>() {
            projection.set_changed();
        }
    }
    world.resource_mut::<Assets<Image>>().remove(&shot.image);
}

/// Saves the image as a PNG file without alpha.
fn save(image: &Image, folder: &Path) -> Result<PathBuf, String> {
    let size = image.size();
    let bytes = image.data.as_ref().ok_or("The screenshot is empty.")?;
    let opaque: Vec<u8> = bytes
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect();
    let picture = image::RgbImage::from_raw(size.x, size.y, opaque)
        .ok_or("The screenshot has the wrong size.")?;
    let in_folder = |error: &dyn std::fmt::Display| format!("{}: {error}", folder.display());
    fs::create_dir_all(folder).map_err(|error| in_folder(&error))?;
    let now = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_millis());
    let path = folder.join(format!("comic-{now}.png"));
    picture.save(&path).map_err(|error| in_folder(&error))?;
    Ok(path)
}
