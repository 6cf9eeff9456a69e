//! The page of presets and style files, as thumbnails of the current scene.

use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
};

use bevy::{
    camera::RenderTarget, ecs::entity::EntityCloner, platform::collections::HashMap, prelude::*,
    render::render_resource::TextureFormat,
};
use bevy_egui::{
    EguiTextureHandle, EguiUserTextures,
    egui::{self, Button, Label, Slider, TextureId, Ui, Vec2, vec2},
};

use super::{
    Helper, PipelinesBusy, Widgets,
    fields::{self, button},
    files::style_files,
    note,
};
use bevy_comics::{
    ComicStyle, ComicsDiagnostics, diagnostics::ComicsStage, effect::EffectRegistry, presets,
};

/// Size of a thumbnail in pixels.
const WIDTH: u32 = 240;
const HEIGHT: u32 = 135;
/// Frames after which a thumbnail is given up.
const PATIENCE: u32 = 1200;

/// A preset or a style file.
struct Entry {
    name: String,
    title: String,
    style: Result<ComicStyle, String>,
}

/// The picture of a style.
struct Thumbnail {
    image: Handle<Image>,
    texture: TextureId,
}

/// A thumbnail that is being drawn, by a copy of the game's camera.
struct Session {
    name: String,
    camera: Entity,
    thumbnail: Thumbnail,
    frames: u32,
    /// Frames since all pipelines were ready.
    complete: u32,
}

/// The page of presets.
pub struct Presets {
    registry: EffectRegistry,
    entries: Option<Vec<Entry>>,
    thumbnails: HashMap<String, Thumbnail>,
    queue: VecDeque<String>,
    session: Option<Session>,
    source: Option<Entity>,
    /// The style that was clicked.
    pub chosen: Option<ComicStyle>,
}

/// The presets, and the style files of a folder.
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
                // Without a warning for an older version: the list is read often.
                registry
                    .read_style(&text)
                    .map(|read| read.style)
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

    /// Draws the thumbnail with its title; the style if it was clicked.
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
                ui.add(Label::new(&self.title).truncate());
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
            session: None,
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
        ui.vertical(|ui| {
            if button(
                ui,
                widgets,
                "presets.refresh",
                "Redraw the thumbnails",
                true,
            ) {
                self.refresh(world, folder);
            }
            let fade = ui.add(Slider::new(fade, 0.0..=3.0).suffix(" s").text("Transition"));
            note(widgets, "presets.fade", &fade);
        });
        let waiting = self.queue.len() + usize::from(self.session.is_some());
        if waiting > 0 {
            ui.label(format!("{waiting} thumbnails left to draw"));
        }
        self.pictures(ui, widgets);
    }

    /// The thumbnails, in as many columns as fit.
    fn pictures(&mut self, ui: &mut Ui, widgets: &mut Widgets) {
        let wide = ui.available_width();
        let gap = ui.spacing().item_spacing.x;
        let columns = ((wide + gap) / 170.0).floor().max(1.0);
        let width = ((wide + gap) / columns - gap).floor().max(80.0);
        let size = vec2(width, width * HEIGHT as f32 / WIDTH as f32);
        ui.horizontal_wrapped(|ui| {
            for entry in self.entries.iter().flatten() {
                ui.allocate_ui(vec2(width, size.y + 24.0), |ui| {
                    ui.vertical(|ui| {
                        ui.set_max_width(width);
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

    /// One step of a thumbnail per frame, one thumbnail at a time.
    pub fn step(&mut self, world: &mut World) {
        if let Some(session) = &mut self.session {
            session.frames += 1;
            let diagnostics = world.resource::<ComicsDiagnostics>();
            let camera = session.camera;
            let ready = diagnostics.ran(camera, ComicsStage::Stylize)
                && !diagnostics.is_compiling(camera)
                && !world.resource::<PipelinesBusy>().get();
            session.complete = if ready { session.complete + 1 } else { 0 };
            if session.complete > 2 || session.frames > PATIENCE {
                let complete = session.complete > 2;
                world.despawn(camera);
                if let Some(session) = self.session.take() {
                    if complete {
                        self.keep(world, session.name, session.thumbnail);
                    } else {
                        forget(world, &session.thumbnail);
                    }
                }
            }
        }
        if self.session.is_none()
            && let Some(name) = self.queue.pop_front()
        {
            self.session = self.start(world, name);
        }
    }

    fn keep(&mut self, world: &mut World, name: String, thumbnail: Thumbnail) {
        if let Some(old) = self.thumbnails.insert(name, thumbnail) {
            forget(world, &old);
        }
    }

    fn start(&mut self, world: &mut World, name: String) -> Option<Session> {
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
        let camera = copy_of(world, source)?;
        let mut entity = world.entity_mut(camera);
        entity.insert((Helper, place, RenderTarget::Image(image.clone().into())));
        if let Some(mut camera) = entity.get_mut::<Camera>() {
            // Before the cameras that draw to windows.
            camera.order = isize::MIN / 2;
            camera.viewport = None;
            camera.is_active = true;
        }
        let mut commands = world.commands();
        style.apply(&mut commands.entity(camera));
        world.flush();
        Some(Session {
            name,
            camera,
            thumbnail: Thumbnail { image, texture },
            frames: 0,
            complete: 0,
        })
    }

    fn stop(&mut self, world: &mut World) {
        self.queue.clear();
        if let Some(session) = self.session.take() {
            world.despawn(session.camera);
            forget(world, &session.thumbnail);
        }
    }

    /// Stops; the remaining thumbnails are drawn when the panel is open again.
    pub fn close(&mut self, world: &mut World) {
        if let Some(session) = &self.session {
            self.queue.push_front(session.name.clone());
        }
        let queue = std::mem::take(&mut self.queue);
        self.stop(world);
        self.queue = queue;
    }
}

/// Frees a thumbnail.
fn forget(world: &mut World, thumbnail: &Thumbnail) {
    world
        .resource_mut::<EguiUserTextures>()
        .remove_image(&thumbnail.image);
    world
        .resource_mut::<Assets<Image>>()
        .remove(&thumbnail.image);
}

/// A copy of a camera with the engine's components only: a game may expect that
/// only one camera has its own.
fn copy_of(world: &mut World, source: Entity) -> Option<Entity> {
    let source_entity = world.get_entity(source).ok()?;
    let modules = [
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
                modules.iter().any(|start| name.starts_with(start))
            })
        })
        .collect();
    let copy = world.spawn_empty().id();
    let mut cloner = EntityCloner::build_opt_in(world);
    cloner.without_required_components(|cloner| {
        cloner.allow_by_ids(ids);
    });
    cloner.clone_entity(source, copy);
    Some(copy)
}
