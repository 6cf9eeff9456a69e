//! What a frame was made of: the pass's input and output, the raw depth, the
//! normals, and what was decided.

use std::path::Path;

use bevy::{
    prelude::*,
    render::{RenderApp, sync_world::RenderEntity},
};
use bevy_comics::{
    ComicStyle, ComicsDiagnostics,
    depth::{ProjectionKind, VisibleDepthRange},
    diagnostics::StageOutcome,
};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, Layer, LayerAttributes,
    SpecificChannels, WritableImage,
};
use serde_json::{Value, json};

use bevy_comics_testkit::{
    headless::{Adapter, Headless},
    read_back::{self, DepthImage, FloatImage, IdImage},
};

use crate::arguments::{Arguments, SceneChoice};

pub fn write(
    headless: &mut Headless,
    camera: Entity,
    arguments: &Arguments,
    adapter: &Adapter,
    folder: &Path,
) -> Result<(), String> {
    std::fs::create_dir_all(folder)
        .map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
    // The ledger and the range of the last frame arrive with the next update.
    let view = headless
        .app
        .world()
        .get::<RenderEntity>(camera)
        .map(|e| e.id());
    let render_world = headless.app.sub_app(RenderApp).world();
    let view = view.ok_or("the camera was not rendered")?;
    let (input, output) =
        read_back::pictures(render_world, view).ok_or("the camera has no picture")?;
    write_rgba(&folder.join("input.exr"), input.as_ref().unwrap_or(&output))?;
    write_rgba(&folder.join("output.exr"), &output)?;
    if let Some(depth) = read_back::depth(render_world, view) {
        write_depth(&folder.join("depth.exr"), &depth)?;
    }
    if let Some(normals) = read_back::normals(render_world, view) {
        write_rgba(&folder.join("normal.exr"), &normals)?;
    }
    if let Some(ids) = read_back::object_ids(render_world, view) {
        write_ids(&folder.join("ids.exr"), &ids)?;
    }
    headless.step(3);
    let frame = describe(headless, camera, arguments, adapter);
    let text = serde_json::to_string_pretty(&frame).map_err(|error| error.to_string())?;
    let path = folder.join("frame.json");
    std::fs::write(&path, text + "\n")
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

fn write_rgba(path: &Path, picture: &FloatImage) -> Result<(), String> {
    let width = picture.width as usize;
    let image = ExrImage::from_channels(
        (width, picture.height as usize),
        SpecificChannels::rgba(|at: exr::math::Vec2<usize>| {
            let [r, g, b, a] = picture.pixels[at.y() * width + at.x()];
            (r, g, b, a)
        }),
    );
    image
        .write()
        .to_file(path)
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// `id` and `style`, as whole numbers.
fn write_ids(path: &Path, ids: &IdImage) -> Result<(), String> {
    let channel = |name: &str, index: usize| {
        let values = ids.pixels.iter().map(|pixel| pixel[index]).collect();
        AnyChannel::new(name, FlatSamples::U32(values))
    };
    let layer = Layer::new(
        (ids.width as usize, ids.height as usize),
        LayerAttributes::named("ids"),
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort(
            [channel("id", 0), channel("style", 1)]
                .into_iter()
                .collect(),
        ),
    );
    ExrImage::from_layer(layer)
        .write()
        .to_file(path)
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// One lossless channel a sample: `Z` for the first, `Z1`, `Z2` ... for the
/// others.
fn write_depth(path: &Path, depth: &DepthImage) -> Result<(), String> {
    let channels = (0..depth.samples)
        .map(|sample| {
            let name = if sample == 0 {
                "Z".to_owned()
            } else {
                format!("Z{sample}")
            };
            let values = depth
                .bits
                .iter()
                .skip(sample as usize)
                .step_by(depth.samples as usize)
                .map(|bits| f32::from_bits(*bits))
                .collect();
            AnyChannel::new(name.as_str(), FlatSamples::F32(values))
        })
        .collect();
    let layer = Layer::new(
        (depth.width as usize, depth.height as usize),
        LayerAttributes::named("depth"),
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort(channels),
    );
    ExrImage::from_layer(layer)
        .write()
        .to_file(path)
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

/// How many lights of each kind the scene has.
fn lights(headless: &Headless) -> Value {
    let world = headless.app.world();
    let count = |kind: Option<bevy::ecs::component::ComponentId>| {
        kind.map_or(0, |kind| {
            world
                .archetypes()
                .iter()
                .filter(|archetype| archetype.contains(kind))
                .map(bevy::ecs::archetype::Archetype::len)
                .sum()
        })
    };
    json!({
        "directional": count(world.component_id::<DirectionalLight>()),
        "point": count(world.component_id::<PointLight>()),
        "spot": count(world.component_id::<SpotLight>()),
    })
}

fn describe(
    headless: &Headless,
    camera: Entity,
    arguments: &Arguments,
    adapter: &Adapter,
) -> Value {
    let world = headless.app.world();
    let range = match world.get::<VisibleDepthRange>(camera) {
        Some(VisibleDepthRange::Visible {
            nearest,
            farthest,
            raw_nearest,
            raw_farthest,
        }) => json!({
            "raw": [raw_nearest, raw_farthest],
            "raw_bits": [raw_nearest.to_bits(), raw_farthest.to_bits()],
            "distance": [nearest, farthest],
        }),
        Some(VisibleDepthRange::Empty) => json!("empty"),
        _ => Value::Null,
    };
    let mut ran = Vec::new();
    let mut left_out = serde_json::Map::new();
    let diagnostics = world.resource::<ComicsDiagnostics>();
    let stages = diagnostics.cameras.get(&camera).map(|drawn| &drawn.stages);
    for (stage, outcome) in stages.into_iter().flatten() {
        match outcome {
            StageOutcome::Ran => ran.push(json!(stage.name())),
            StageOutcome::RanWith(method) => {
                ran.push(json!(format!("{} ({method})", stage.name())));
            }
            StageOutcome::Skipped(reason) => {
                left_out.insert(stage.name().into(), json!(reason.to_string()));
            }
            _ => {}
        }
    }
    let clip = world
        .get::<Camera>(camera)
        .map(Camera::clip_from_view)
        .unwrap_or_default();
    let style = arguments.style.as_ref().map(ComicStyle::sanitized);
    let resolved = style.map(|style| serde_json::to_value(style).unwrap_or_default());
    let plane = |pick: fn(&Projection) -> f32| world.get::<Projection>(camera).map(pick);
    json!({
        "scene": match &arguments.scene {
            SceneChoice::BuiltIn(scene) => scene.name().to_owned(),
            SceneChoice::Model(path) => path.display().to_string(),
        },
        "size": [arguments.size.x, arguments.size.y],
        "samples": arguments.msaa,
        "hdr": arguments.hdr,
        "material": if arguments.toon { "toon" } else { "standard" },
        "lights": lights(headless),
        "range": range,
        "projection": match ProjectionKind::of(&clip) {
            ProjectionKind::Perspective => "perspective",
            ProjectionKind::Orthographic => "orthographic",
            _ => "oblique",
        },
        "near": plane(|p| match p {
            Projection::Perspective(p) => p.near,
            Projection::Orthographic(p) => p.near,
            Projection::Custom(_) => f32::NAN,
        }),
        "far": plane(|p| match p {
            Projection::Perspective(p) => p.far,
            Projection::Orthographic(p) => p.far,
            Projection::Custom(p) => p.far(),
        }),
        "clip_from_view": clip.to_cols_array_2d(),
        "passes_run": ran,
        "passes_left_out": left_out,
        "style": resolved,
        "adapter": adapter.info.name,
        "driver": format!("{} {}", adapter.info.driver, adapter.info.driver_info),
    })
}
