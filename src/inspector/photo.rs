//! Pictures of the window's 3D cameras, as large as wanted.

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

/// A camera as it was before it was turned to the picture.
struct Turned {
    camera: Entity,
    target: RenderTarget,
    viewport: Option<Viewport>,
}

/// A picture in the making.
struct Shot {
    image: Handle<Image>,
    /// With its scale factor: the engine tells targets apart by it.
    target: ImageRenderTarget,
    cameras: Vec<Turned>,
    frames: u32,
    /// Frames since the last pipeline was compiled.
    idle: u32,
    asked: bool,
    answer: Arc<Mutex<Option<Result<PathBuf, String>>>>,
}

pub struct Photo {
    folder: PathBuf,
    shot: Option<Shot>,
    last: Option<Result<PathBuf, String>>,
    /// A picture that was asked for, so many times the window.
    wanted: Option<u32>,
}

/// So many frames are waited for.
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

    /// Whether the panel stands back for a picture.
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
            ui.label("There is no window to take a picture of.");
            return;
        };
        let largest = largest(world, window);
        *multiple = (*multiple).clamp(1, largest);
        let slider = ui.add(Slider::new(multiple, 1..=largest).text("times the window"));
        note(widgets, "photo.multiple", &slider);
        let size = window * *multiple;
        ui.label(format!("{} x {} pixels", size.x, size.y));
        if button(ui, widgets, "photo.take", "Take a picture", true) {
            self.last = None;
            self.wanted = Some(*multiple);
        }
        ui.weak("Every 3D camera of the window, without its user interface; lines keep their share of the picture.");
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

    /// One step a frame: wait for pipelines, ask, wait for the answer, put
    /// everything back.
    pub fn step(&mut self, world: &mut World) {
        if let Some(multiple) = self.wanted.take()
            && let Some((window, _)) = window_size(world)
        {
            self.shot = begin(world, window, multiple);
            if self.shot.is_none() {
                self.last = Some(Err("No 3D camera draws to the window.".into()));
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
            self.last = Some(answer.unwrap_or_else(|| Err("the picture did not arrive".into())));
            if let Some(shot) = self.shot.take() {
                end(world, shot);
            }
            return;
        }
        let diagnostics = world.resource::<ComicsDiagnostics>();
        let compiling = shot
            .cameras
            .iter()
            .any(|turned| diagnostics.is_compiling(turned.camera));
        // The two worlds are a frame or two apart.
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

/// The largest multiple that the adapter can draw.
fn largest(world: &World, window: UVec2) -> u32 {
    let side = world
        .get_resource::<RenderDevice>()
        .map_or(8192, |device| device.limits().max_texture_dimension_2d);
    (side / window.max_element().max(1)).clamp(1, 8)
}

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
        cameras.push(Turned {
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

fn end(world: &mut World, shot: Shot) {
    for turned in shot.cameras {
        let Ok(mut entity) = world.get_entity_mut(turned.camera) else {
            continue;
        };
        entity.insert(turned.target);
        if let Some(mut camera) = entity.get_mut::<Camera>() {
            camera.viewport = turned.viewport;
        }
        // The engine looks at the size of a target anew when the projection
        // changes, and not when the target does.
        if let Some(mut projection) = entity.get_mut::<Projection>() {
            projection.set_changed();
        }
    }
    world.resource_mut::<Assets<Image>>().remove(&shot.image);
}

fn save(image: &Image, folder: &Path) -> Result<PathBuf, String> {
    let size = image.size();
    let bytes = image.data.as_ref().ok_or("the picture is empty")?;
    let opaque: Vec<u8> = bytes
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect();
    let picture = image::RgbImage::from_raw(size.x, size.y, opaque)
        .ok_or("the picture has not the size that it should have")?;
    let say = |error: &dyn std::fmt::Display| format!("{}: {error}", folder.display());
    fs::create_dir_all(folder).map_err(|error| say(&error))?;
    let now = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_millis());
    let path = folder.join(format!("comic-{now}.png"));
    picture.save(&path).map_err(|error| say(&error))?;
    Ok(path)
}
