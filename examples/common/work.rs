//! Counts what a style does, whatever the machine: passes, bindings, and the
//! texels that the fused pass fetches, counted by the shader itself.

use bevy::{
    camera::Hdr,
    prelude::*,
    render::{
        RenderApp,
        render_resource::{PipelineCache, PipelineDescriptor},
        sync_world::RenderEntity,
        view::Msaa,
    },
    shader::Source,
};
use bevy_comics::{
    Colorization, ComicStyle, ComicsDiagnostics, ComicsStage, Contours, DepthMap, DepthMapping,
    Desaturation, Outlines, RangeSmoothing, Sketch, ToneBands,
};

use super::{read_back, scenes::BuiltIn, studio::Studio};

/// What a style does for one camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    pub name: &'static str,
    /// The engine's prepasses and this crate's passes that ran.
    pub ran: Vec<&'static str>,
    /// The passes that were left out.
    pub left_out: usize,
    /// Bindings of the fused pass.
    pub bindings: usize,
    /// Texels that the fused pass fetches for a pixel, mean and most.
    pub fetches: [f64; 2],
    /// Bytes that it fetches for a pixel, in the mean, on an 8-bit target.
    pub bytes: f64,
}

/// The stages that are passes of their own.
const PASSES: [ComicsStage; 8] = [
    ComicsStage::DepthPrepass,
    ComicsStage::NormalPrepass,
    ComicsStage::ObjectIds,
    ComicsStage::DepthRange,
    ComicsStage::RangeSmoothing,
    ComicsStage::OutlineEdges,
    ComicsStage::LineFlood,
    ComicsStage::Stylize,
];

/// Desaturation, colorization and contours: what the targets speak of.
pub fn default_comic() -> ComicStyle {
    ComicStyle {
        desaturation: Some(Desaturation::default()),
        colorization: Some(Colorization::default()),
        contours: Some(Contours::default()),
        ..default()
    }
}

/// From nothing to everything.
pub fn ladder() -> Vec<(&'static str, ComicStyle)> {
    let none = ComicStyle::default();
    let saturation = Some(Desaturation::default());
    let comic = default_comic();
    let outlined = |outlines| ComicStyle {
        outlines: Some(outlines),
        ..ComicStyle::default()
    };
    vec![
        ("no style", none.clone()),
        (
            "one tint (sepia)",
            ComicStyle {
                colorization: Some(Colorization::SEPIA),
                ..none.clone()
            },
        ),
        (
            "tone bands",
            ComicStyle {
                tone_bands: Some(ToneBands::default()),
                ..none.clone()
            },
        ),
        (
            "desaturation by a fixed range",
            ComicStyle {
                depth_map: Some(DepthMap {
                    mapping: DepthMapping::Fixed {
                        near: 1.0,
                        far: 20.0,
                    },
                    ..default()
                }),
                desaturation: saturation,
                ..none.clone()
            },
        ),
        (
            "desaturation",
            ComicStyle {
                desaturation: saturation,
                ..none.clone()
            },
        ),
        (
            "contours",
            ComicStyle {
                contours: Some(Contours::default()),
                ..none.clone()
            },
        ),
        ("default comic", comic.clone()),
        (
            "default comic, range of every frame",
            ComicStyle {
                depth_map: Some(DepthMap {
                    smoothing: None,
                    ..default()
                }),
                ..comic.clone()
            },
        ),
        (
            "default comic, percentiles",
            ComicStyle {
                depth_map: Some(DepthMap {
                    smoothing: Some(RangeSmoothing {
                        outliers: 0.005,
                        ..default()
                    }),
                    ..default()
                }),
                ..comic.clone()
            },
        ),
        ("silhouettes", outlined(Outlines::SILHOUETTES)),
        ("outlines", outlined(Outlines::default())),
        (
            "outlines, 8 pixels wide",
            outlined(Outlines {
                width: 8.0,
                ..default()
            }),
        ),
        (
            "sketch",
            ComicStyle {
                sketch: Some(Sketch::default()),
                ..none
            },
        ),
        (
            "everything",
            ComicStyle {
                tone_bands: Some(ToneBands::default()),
                outlines: Some(Outlines::default()),
                ..comic
            },
        ),
    ]
}

/// Bytes of a texel, by the name of its binding.
fn texel_size(line: &str) -> Option<u32> {
    let name = line.split("textureLoad(").nth(1)?.split(',').next()?;
    Some(match name {
        "edge_texture" | "flood_texture" => 8,
        _ => 4,
    })
}

const COUNTER: &str = "
var<private> fetched: vec2<f32>;
fn tally(bytes: f32) { fetched += vec2(1.0, bytes); }
fn fetched_so_far() -> vec2<f32> { return fetched; }
";

/// Puts a counter before every fetch, and gives the count instead of a colour.
fn counting(path: &str, text: &str) -> Option<String> {
    let mut lines: Vec<String> = Vec::new();
    let is = |name: &str| path.ends_with(name);
    if !(is("bindings.wgsl") || is("lines.wgsl") || is("stylize.wgsl")) {
        return None;
    }
    for line in text.lines() {
        if let Some(bytes) = texel_size(line) {
            lines.push(format!("tally({bytes}.0);"));
        }
        lines.push(line.to_owned());
        let first_import =
            line.starts_with("#define_import_path") || line.starts_with("// The fused");
        if first_import && !is("bindings.wgsl") {
            lines
                .push("#import bevy_comics::stylize::bindings::{tally, fetched_so_far}".to_owned());
        }
        if line.starts_with("@group(0) @binding(1)") && is("bindings.wgsl") {
            lines.push(COUNTER.to_owned());
        }
    }
    let text = lines.join("\n");
    let result = "return vec4(to_stored(linear), stored.a);";
    if is("stylize.wgsl") {
        assert!(text.contains(result), "the end of the fused pass has moved");
    }
    Some(text.replace(
        result,
        "return vec4(fetched_so_far(), to_stored(linear).r, 1.0);",
    ))
}

fn instrument(world: &mut World) -> usize {
    let mut shaders = world.resource_mut::<Assets<Shader>>();
    let ids: Vec<_> = shaders.ids().collect();
    let mut changed = 0;
    for id in ids {
        let Some(shader) = shaders.get(id) else {
            continue;
        };
        let Source::Wgsl(text) = &shader.source else {
            continue;
        };
        if !shader.path.contains("bevy_comics/stylize/") {
            continue;
        }
        if let Some(text) = counting(&shader.path, text) {
            let shader = Shader::from_wgsl(text, shader.path.clone());
            let _ = shaders.insert(id, shader);
            changed += 1;
        }
    }
    changed
}

/// Renders the teapot, small, in a style, and counts.
pub fn count(name: &'static str, style: &ComicStyle) -> Work {
    let mut studio = Studio::new(BuiltIn::Teapot, UVec2::new(160, 90), Msaa::Off);
    let camera = studio.camera;
    studio
        .headless
        .app
        .world_mut()
        .entity_mut(camera)
        .insert(Hdr);
    studio.headless.step(2);
    let changed = instrument(studio.headless.app.world_mut());
    assert_eq!(changed, 3, "the fused pass is made of other files");
    studio.shoot(Some(style));
    studio.headless.step(4);

    let world = studio.headless.app.world();
    let stages = world
        .resource::<ComicsDiagnostics>()
        .cameras
        .get(&camera)
        .cloned()
        .unwrap_or_default();
    let (ran, left): (Vec<_>, Vec<_>) = PASSES.into_iter().partition(|s| stages.ran(*s));
    let view = world.get::<RenderEntity>(camera).expect("extracted").id();
    let render_world = studio.headless.app.sub_app(RenderApp).world();
    let bindings = render_world
        .resource::<PipelineCache>()
        .pipelines()
        .filter_map(|pipeline| match &pipeline.descriptor {
            PipelineDescriptor::RenderPipelineDescriptor(d)
                if d.label.as_deref() == Some("comics_stylize") =>
            {
                Some(d.layout[0].entries.len())
            }
            _ => None,
        })
        .last()
        .unwrap_or(0);
    let (mut fetches, mut bytes) = ([0.0f64; 2], 0.0);
    if stages.ran(ComicsStage::Stylize) {
        let (_, counted) = read_back::last_pass(render_world, view, true).expect("a picture");
        let pixels = counted.pixels.len() as f64;
        for p in &counted.pixels {
            fetches[0] += f64::from(p[0]) / pixels;
            fetches[1] = fetches[1].max(f64::from(p[0]));
            bytes += f64::from(p[1]) / pixels;
        }
    }
    Work {
        name,
        ran: ran.into_iter().map(ComicsStage::name).collect(),
        left_out: left.len(),
        bindings,
        fetches,
        bytes,
    }
}
