//! glTF models: loaded, framed and lit.

mod document;
pub mod framing;
mod lighting;
mod textures;
mod vertices;

use std::path::Path;

use bevy::{
    asset::{
        AssetPath, LoadState, RecursiveDependencyLoadState, io::embedded::EmbeddedAssetRegistry,
    },
    ecs::system::RunSystemOnce,
    gltf::GltfLoaderSettings,
    prelude::*,
};

use bevy_comics_testkit::{
    headless::Headless,
    scenes::{ScenePart, Vantage, environment},
};
use document::Document;
use framing::{AffectedArea, FOV};
pub use lighting::turn_environment;

/// Updates that a file may take to load. They are short while nothing is drawn.
const MAX_UPDATES: usize = 20_000;

/// A spawned model.
pub struct Model {
    pub extent: AffectedArea,
    /// Whether the file has lights.
    pub has_lights: bool,
}

/// Loads the model, spawns it and sets the level of its own lights. `turned`
/// measures it for a turntable. Textures that cannot be shown are reported on
/// stderr and left out.
pub fn load(headless: &mut Headless, path: &Path, turned: bool) -> Result<Model, String> {
    println!("loading {}", path.display());
    let scene = load_scene(headless, path)?;
    headless
        .app
        .world_mut()
        .spawn((ScenePart, WorldAssetRoot(scene)));
    // Spawning takes an update, transforms another.
    headless.step(4);

    let cannot = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let world = headless.app.world_mut();
    let points = world
        .run_system_once(vertices::collect)
        .map_err(|error| cannot(&error))?;
    let extent = AffectedArea::new(points, turned)
        .ok_or_else(|| cannot(&"nothing to see: no mesh in its scene"))?;
    let (center, radius) = (extent.center, extent.radius);
    let has_lights = world
        .run_system_once(move |mut lights: lighting::OwnLights| {
            lights.level(center, radius);
            !lights.is_empty()
        })
        .map_err(|error| cannot(&error))?;
    Ok(Model { extent, has_lights })
}

impl Model {
    /// The view that shows the model best.
    pub fn vantage(&self, world: &mut World, size: UVec2) -> Vantage {
        let aspect = size.x as f32 / size.y as f32;
        let perspective = self.extent.perspective(aspect);
        let orthographic = self.extent.orthographic(aspect);
        Vantage {
            eye: perspective.eye,
            target: perspective.target,
            fov: FOV,
            near: perspective.near,
            far: perspective.far,
            ortho: (orthographic.eye, orthographic.target),
            ortho_height: orthographic.height,
            sky: world
                .resource_mut::<Assets<Image>>()
                .add(environment::backdrop()),
            sky_brightness: 1000.0,
        }
    }

    /// Sets the clipping planes of a view to the extent of the model.
    pub fn set_planes(&self, vantage: &mut Vantage) {
        let framing = self.extent.with_planes(vantage.eye, vantage.target);
        (vantage.near, vantage.far) = (framing.near, framing.far);
    }

    /// Gives the camera the light for models. `toon`: for the toon material.
    pub fn light(&self, world: &mut World, camera: Entity, vantage: &Vantage, toon: bool) {
        let framing = self.extent.with_planes(vantage.eye, vantage.target);
        lighting::light_camera(world, camera, &framing, (!self.has_lights, toon));
    }
}

fn load_scene(headless: &mut Headless, path: &Path) -> Result<Handle<WorldAsset>, String> {
    let mut document = Document::read(path)?;
    check_extensions(&document)?;
    let full = path
        .canonicalize()
        .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    let missing = textures::unusable(&document, false);
    if missing.is_empty() && !textures::needs_redirection(&document) {
        let scene = document.scene();
        match wait_for(headless, full.into(), scene) {
            Ok(scene) => return Ok(scene),
            Err(error) => {
                // Decoding every texture takes long, so it is done only here.
                let damaged = textures::unusable(&document, true);
                if damaged.is_empty() {
                    return Err(format!("{} is no glTF model: {error}", path.display()));
                }
                return load_without(headless, &mut document, &damaged);
            }
        }
    }
    load_without(headless, &mut document, &missing)
}

fn load_without(
    headless: &mut Headless,
    document: &mut Document,
    unusable: &[textures::Unusable],
) -> Result<Handle<WorldAsset>, String> {
    for unusable in unusable {
        eprintln!(
            "render: warning: texture {} {}; the model is drawn without it",
            unusable.texture, unusable.reason
        );
    }
    let indices: Vec<usize> = unusable.iter().map(|u| u.texture).collect();
    textures::take_out(document, &indices);
    let world = headless.app.world();
    let embedded = document
        .embed(world.resource::<EmbeddedAssetRegistry>())
        .map_err(|error| error.to_string())?;
    let scene = document.scene();
    wait_for(headless, embedded, scene)
        .map_err(|error| format!("{} is no glTF model: {error}", document.path.display()))
}

/// Extensions that change how the file is read, and that the engine cannot read.
fn check_extensions(document: &Document) -> Result<(), String> {
    const COMPRESSIONS: [(&str, &str); 3] = [
        ("KHR_draco_mesh_compression", "Draco mesh compression"),
        ("EXT_meshopt_compression", "meshopt compression"),
        ("KHR_mesh_quantization", "quantized vertices"),
    ];
    let required = document.list("extensionsRequired");
    match COMPRESSIONS
        .iter()
        .find(|(name, _)| required.iter().any(|r| r == name))
    {
        Some((name, meaning)) => Err(format!(
            "{}: Bevy cannot read {name}; export the model without {meaning}",
            document.path.display()
        )),
        None => Ok(()),
    }
}

/// Loads a scene of a file with everything that it refers to.
fn wait_for(
    headless: &mut Headless,
    file: AssetPath<'static>,
    scene: usize,
) -> Result<Handle<WorldAsset>, String> {
    let server = headless.app.world().resource::<AssetServer>().clone();
    let scene: Handle<WorldAsset> = server
        .load_builder()
        .with_settings(|settings: &mut GltfLoaderSettings| settings.load_cameras = false)
        .load(GltfAssetLabel::Scene(scene).from_asset(file));
    for waited in 1..=MAX_UPDATES {
        if server.is_loaded_with_dependencies(&scene) {
            return Ok(scene);
        }
        if let Some(LoadState::Failed(error)) = server.get_load_state(&scene) {
            return Err(first_line(&error));
        }
        if let Some(RecursiveDependencyLoadState::Failed(error)) =
            server.get_recursive_dependency_load_state(&scene)
        {
            return Err(first_line(&error));
        }
        headless.step(1);
        std::thread::sleep(std::time::Duration::from_millis(2));
        if waited % 500 == 0 {
            println!("still loading");
        }
    }
    Err("it did not load in time".into())
}

/// The engine appends a backtrace to its errors where `RUST_BACKTRACE` is set.
fn first_line(error: &dyn std::fmt::Display) -> String {
    let text = error.to_string();
    text.lines().next().unwrap_or_default().to_owned()
}
