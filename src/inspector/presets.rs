//! The looks there are, as pictures of the current scene.

use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
};

use bevy::{
    asset::{Assets, Handle},
    camera::{Camera, RenderTarget},
    ecs::{entity::Entity, entity::EntityCloner, world::World},
    image::Image,
    platform::collections::HashMap,
    render::render_resource::TextureFormat,
    transform::components::GlobalTransform,
};
use bevy_egui::{
    EguiTextureHandle, EguiUserTextures,
    egui::{self, Button, Slider, TextureId, Ui, Vec2, vec2},
};

use super::{
    Helper, PipelinesBusy, Widgets,
    fields::{self, button},
    files::style_files,
    note,
};
use crate::{ComicStyle, ComicsDiagnostics, ComicsStage, EffectRegistry, presets};

const WIDTH: u32 = 240;
const HEIGHT: u32 = 135;
/// A look whose pipelines take longer has no picture.
const PATIENCE: u32 = 1200;

/// A look in the browser.
struct Entry {
    name: String,
    title: String,
    style: Result<ComicStyle, String>,
}

struct Thumbnail {
    image: Handle<Image>,
    texture: TextureId,
}

/// A picture in the making: its camera stands where the game's does.
struct Sitting {
    name: String,
    camera: Entity,
    thumbnail: Thumbnail,
    frames: u32,
    /// Frames since the look was complete.
    complete: u32,
}

pub struct Presets {
    registry: EffectRegistry,
    entries: Option<Vec<Entry>>,
    thumbnails: HashMap<String, Thumbnail>,
    queue: VecDeque<String>,
    sitting: Option<Sitting>,
    source: Option<Entity>,
    /// The look that was clicked.
    pub chosen: Option<ComicStyle>,
}

fn entries(folder: &Path, registry: &EffectRegistry) -> Vec<Entry> {
    let own = presets::ALL
        .iter()
        .map(|preset| Entry::new(preset.name().to_owned(), Ok(preset.style())));
    let files = style_files(folder).into_iter().filter_map(|path: PathBuf| {
        let file = path.file_name()?.to_string_lossy().into_owned();
        let name = file.strip_suffix(".comic.ron")?.to_owned();
        if presets::find(&name).is_some() {
            return None;
        }
        let style = std::fs::read_to_string(&path)
            .map_err(|error| error.to_string())
            .and_then(|text| {
                registry
                    .style_from_ron(&text)
                    .map_err(|error| error.to_string())
            });
        Some(Entry::new(name, style))
    });
    own.chain(files).collect()
}

impl Entry {
    fn new(name: String, style: Result<ComicStyle, String>) -> Self {
        let title = match &style {
            Ok(style) if !style.name.is_empty() => style.name.clone(),
            _ => name.clone(),
        };
        Self { name, title, style }
    }

    /// Draws the picture with its title; gives the style if it was clicked.
    fn show(
        &self,
        ui: &mut Ui,
        thumbnail: Option<&Thumbnail>,
        size: Vec2,
        widgets: &mut Widgets,
    ) -> Option<ComicStyle> {
        let picture = match thumbnail {
            Some(thumbnail) => {
                let image = egui::Image::new((thumbnail.texture, size));
                ui.add(Button::image(image).min_size(size).frame(false))
            }
            None => ui.add_sized(size, Button::new("…")),
        };
        note(widgets, format!("presets.{}", self.name), &picture);
        match &self.style {
            Ok(style) => {
                ui.label(&self.title);
                picture.clicked().then(|| style.clone())
            }
            Err(error) => {
                fields::error(ui, &self.title).on_hover_text(error);
                None
            }
        }
    }
}

impl Presets {
    pub fn new(registry: EffectRegistry) -> Self {
        Self {
            registry,
            entries: None,
            thumbnails: HashMap::default(),
            queue: VecDeque::new(),
            sitting: None,
            source: None,
            chosen: None,
        }
    }

    pub fn show(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        camera: Entity,
        folder: &Path,
        fade: &mut f32,
        widgets: &mut Widgets,
    ) {
        if self.source != Some(camera) {
            self.source = Some(camera);
            self.refresh(world, folder);
        }
        ui.horizontal_wrapped(|ui| {
            if button(
                ui,
                widgets,
                "presets.refresh",
                "Take the pictures anew",
                true,
            ) {
                self.refresh(world, folder);
            }
            let fade = ui.add(Slider::new(fade, 0.0..=3.0).suffix(" s").text("Fade"));
            note(widgets, "presets.fade", &fade);
        });
        let waiting = self.queue.len() + usize::from(self.sitting.is_some());
        if waiting > 0 {
            ui.label(format!("{waiting} pictures to take"));
        }
        self.pictures(ui, widgets);
    }

    /// The pictures, in as many columns as there is room for.
    fn pictures(&mut self, ui: &mut Ui, widgets: &mut Widgets) {
        let wide = ui.available_width();
        let columns = (wide / 170.0).floor().max(1.0);
        let width = (wide / columns - 10.0).max(80.0);
        let size = vec2(width, width * HEIGHT as f32 / WIDTH as f32);
        ui.horizontal_wrapped(|ui| {
            for entry in self.entries.iter().flatten() {
                ui.allocate_ui(vec2(width, size.y + 24.0), |ui| {
                    ui.vertical(|ui| {
                        let thumbnail = self.thumbnails.get(&entry.name);
                        if let Some(style) = entry.show(ui, thumbnail, size, widgets) {
                            self.chosen = Some(style);
                        }
                    });
                });
            }
        });
    }

    fn refresh(&mut self, world: &mut World, folder: &Path) {
        self.stop(world);
        let entries = entries(folder, &self.registry);
        self.queue = entries
            .iter()
            .filter(|entry| entry.style.is_ok())
            .map(|entry| entry.name.clone())
            .collect();
        self.entries = Some(entries);
    }

    /// One picture at a time, one step a frame.
    pub fn step(&mut self, world: &mut World) {
        if let Some(sitting) = &mut self.sitting {
            sitting.frames += 1;
            let diagnostics = world.resource::<ComicsDiagnostics>();
            let camera = sitting.camera;
            let ready = diagnostics.ran(camera, ComicsStage::Stylize)
                && !diagnostics.is_compiling(camera)
                && !world.resource::<PipelinesBusy>().get();
            sitting.complete = if ready { sitting.complete + 1 } else { 0 };
            if sitting.complete > 2 || sitting.frames > PATIENCE {
                let complete = sitting.complete > 2;
                world.despawn(camera);
                if let Some(sitting) = self.sitting.take() {
                    if complete {
                        self.keep(world, sitting.name, sitting.thumbnail);
                    } else {
                        forget(world, &sitting.thumbnail);
                    }
                }
            }
        }
        if self.sitting.is_none()
            && let Some(name) = self.queue.pop_front()
        {
            self.sitting = self.sit(world, name);
        }
    }

    fn keep(&mut self, world: &mut World, name: String, thumbnail: Thumbnail) {
        if let Some(old) = self.thumbnails.insert(name, thumbnail) {
            forget(world, &old);
        }
    }

    fn sit(&mut self, world: &mut World, name: String) -> Option<Sitting> {
        let source = self.source?;
        let entry = self
            .entries
            .iter()
            .flatten()
            .find(|entry| entry.name == name)?;
        let style = entry.style.as_ref().ok()?.clone();
        let place = world.get::<GlobalTransform>(source)?.compute_transform();
        let image = Image::new_target_texture(WIDTH, HEIGHT, TextureFormat::Rgba8UnormSrgb, None);
        let image = world.resource_mut::<Assets<Image>>().add(image);
        let texture = world
            .resource_mut::<EguiUserTextures>()
            .add_image(EguiTextureHandle::Strong(image.clone()));
        let camera = double(world, source)?;
        let mut entity = world.entity_mut(camera);
        entity.insert((Helper, place, RenderTarget::Image(image.clone().into())));
        if let Some(mut camera) = entity.get_mut::<Camera>() {
            // Before everything that is shown.
            camera.order = isize::MIN / 2;
            camera.viewport = None;
            camera.is_active = true;
        }
        let mut commands = world.commands();
        style.apply(&mut commands.entity(camera));
        world.flush();
        Some(Sitting {
            name,
            camera,
            thumbnail: Thumbnail { image, texture },
            frames: 0,
            complete: 0,
        })
    }

    fn stop(&mut self, world: &mut World) {
        self.queue.clear();
        if let Some(sitting) = self.sitting.take() {
            world.despawn(sitting.camera);
            forget(world, &sitting.thumbnail);
        }
    }

    /// What was not finished is taken up again at the next opening.
    pub fn close(&mut self, world: &mut World) {
        if let Some(sitting) = &self.sitting {
            self.queue.push_front(sitting.name.clone());
        }
        let queue = std::mem::take(&mut self.queue);
        self.stop(world);
        self.queue = queue;
    }
}

fn forget(world: &mut World, thumbnail: &Thumbnail) {
    world
        .resource_mut::<EguiUserTextures>()
        .remove_image(&thumbnail.image);
    world
        .resource_mut::<Assets<Image>>()
        .remove(&thumbnail.image);
}

/// A camera that sees as another one does: with the engine's own components,
/// and none of the game's, which would find two where there was one.
fn double(world: &mut World, source: Entity) -> Option<Entity> {
    let source_entity = world.get_entity(source).ok()?;
    let seen = [
        "bevy_camera::",
        "bevy_core_pipeline::",
        "bevy_light::",
        "bevy_pbr::",
        "bevy_post_process::",
        "bevy_render::view::",
    ];
    let ids: Vec<_> = source_entity
        .archetype()
        .components()
        .iter()
        .copied()
        .filter(|id| {
            world.components().get_info(*id).is_some_and(|info| {
                let name = info.name().to_string();
                seen.iter().any(|start| name.starts_with(start))
            })
        })
        .collect();
    let double = world.spawn_empty().id();
    let mut cloner = EntityCloner::build_opt_in(world);
    cloner.without_required_components(|cloner| {
        cloner.allow_by_ids(ids);
    });
    cloner.clone_entity(source, double);
    Some(double)
}
