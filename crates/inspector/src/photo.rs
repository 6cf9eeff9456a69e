//! Screenshots of the window's 3D cameras, several times as large as the window.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use bevy::{
    camera::{ImageRenderTarget, RenderTarget, Viewport},
    prelude::*,
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
use bevy_comics::ComicsDiagnostics;

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
        let size = picture_size(window, *multiple);
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
    largest_below(side, window)
}

/// The largest multiple of a size of which no side is longer than `side`.
fn largest_below(side: u32, size: UVec2) -> u32 {
    (side / size.max_element().max(1)).clamp(1, 8)
}

/// The size of a screenshot of a window.
fn picture_size(window: UVec2, multiple: u32) -> UVec2 {
    window
        .saturating_mul(UVec2::splat(multiple))
        .max(UVec2::ONE)
}

/// Redirects the window's 3D cameras to an image.
fn begin(world: &mut World, window: UVec2, multiple: u32) -> Option<Shot> {
    // The window may have grown since the page was shown.
    let multiple = multiple.clamp(1, largest(world, window));
    let size = picture_size(window, multiple);
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
            let factor = UVec2::splat(multiple);
            viewport.physical_position = viewport.physical_position.saturating_mul(factor);
            viewport.physical_size = viewport.physical_size.saturating_mul(factor);
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

/// The colors of a screenshot without alpha.
fn colors(image: &Image) -> Result<image::RgbImage, String> {
    let size = image.size();
    let bytes = image.data.as_ref().ok_or("The screenshot is empty.")?;
    let count = u64::from(size.x) * u64::from(size.y);
    if count == 0 || bytes.len() as u64 != 4 * count {
        return Err("The screenshot has the wrong size.".into());
    }
    let opaque: Vec<u8> = bytes
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect();
    image::RgbImage::from_raw(size.x, size.y, opaque)
        .ok_or_else(|| "The screenshot has the wrong size.".into())
}

/// The name of the file of a screenshot, by the time since 1970.
fn file_name(now: Duration) -> String {
    format!("comic-{}.png", now.as_millis())
}

/// Saves the image as a PNG file without alpha.
fn save(image: &Image, folder: &Path) -> Result<PathBuf, String> {
    let picture = colors(image)?;
    let in_folder = |error: &dyn std::fmt::Display| format!("{}: {error}", folder.display());
    fs::create_dir_all(folder).map_err(|error| in_folder(&error))?;
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let path = folder.join(file_name(now.unwrap_or_default()));
    picture.save(&path).map_err(|error| in_folder(&error))?;
    Ok(path)
}

#[cfg(test)]
mod tests {
    use std::path::Component;

    use super::*;
    use crate::fuzz::{Numbers, cases, in_time};

    /// A length: any, one of a window, or one beside a power of two.
    fn length(numbers: &mut Numbers) -> u32 {
        match numbers.below(4) {
            0 => numbers.bits(),
            1 => (1u32 << numbers.below(32)).wrapping_sub(numbers.below(3) as u32),
            _ => numbers.below(16385) as u32,
        }
    }

    /// A screenshot of a window that the adapter can draw is one that it can draw, too; whatever
    /// the numbers are, there is a size.
    #[test]
    fn a_window_of_any_size_is_drawn() {
        let mut numbers = Numbers::new(4);
        for _ in 0..cases() {
            let window = UVec2::new(length(&mut numbers), length(&mut numbers));
            let side = length(&mut numbers);
            let most = largest_below(side, window);
            assert!((1..=8).contains(&most), "{window}, {side}");
            // As stored, or as typed.
            let multiple = length(&mut numbers).clamp(1, most);
            let size = picture_size(window, multiple);
            assert!(size.min_element() > 0, "{window}, {multiple}");
            let fits = |size: UVec2| size.max_element() <= side.max(1);
            assert!(!fits(window) || fits(size), "{window}, {multiple}, {side}");
        }
    }

    /// A picture is read if it has the bytes of its size, and refused otherwise.
    #[test]
    fn any_screenshot_is_read_or_refused() {
        let mut numbers = Numbers::new(5);
        for _ in 0..cases() {
            let mut image = Image::default();
            let size = UVec2::new(numbers.below(12) as u32, numbers.below(12) as u32);
            let is_huge = numbers.below(16) == 0;
            let side = if is_huge { u32::MAX } else { size.x };
            image.texture_descriptor.size.width = side;
            image.texture_descriptor.size.height = size.y;
            let wanted = 4 * (size.x * size.y) as usize;
            let count = (wanted + numbers.below(3)).saturating_sub(numbers.below(2));
            image.data = (numbers.below(16) > 0).then(|| vec![7; count]);
            let is_right = image.data.is_some() && !is_huge && wanted > 0 && count == wanted;
            match in_time(&size, || colors(&image)) {
                Ok(picture) => {
                    assert!(is_right, "{side} x {}, {count} bytes", size.y);
                    assert_eq!(picture.dimensions(), (size.x, size.y));
                }
                Err(message) => assert!(!is_right && !message.is_empty()),
            }
        }
    }

    /// The name is that of a file in the folder.
    #[test]
    fn any_time_makes_a_file_name() {
        let mut numbers = Numbers::new(6);
        for _ in 0..cases() {
            let seconds = u64::from(numbers.bits()) << numbers.below(33);
            let name = file_name(Duration::new(seconds, numbers.bits() % 1_000_000_000));
            let parts: Vec<_> = Path::new(&name).components().collect();
            assert!(matches!(parts[..], [Component::Normal(_)]), "{name}");
            assert!(name.starts_with("comic-") && name.ends_with(".png"));
        }
    }
}
