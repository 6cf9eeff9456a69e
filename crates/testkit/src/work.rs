//! Counts the work of a style, which is the same on every machine: passes, bindings, and
//! the texels that the fused pass and the passes of the lines fetch, counted in the shaders.

use std::borrow::Cow;

use bevy::{
    camera::Hdr,
    prelude::*,
    render::{
        RenderApp,
        render_resource::{PipelineCache, PipelineDescriptor},
        sync_world::RenderEntity,
    },
    shader::Source,
};
use bevy_comics::{
    Colorization, ComicStyle, ComicsDiagnostics, ComicsPlugin, Contours, DepthMap, DepthMapping,
    Desaturation, IsoLines, Outlines, Sketch, ToneBands,
    depth::RangeSmoothing,
    diagnostics::ComicsStage,
    lines::{LineResponse, LineWeight},
};

use super::{
    before::BeforeStylize,
    headless::HeadlessOptions,
    line_work::{self, LineWork, PassCounters},
    read_back,
    scenes::BuiltIn,
    studio::{Studio, with_map},
};

/// The work of a style for one camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    pub name: &'static str,
    /// The engine's prepasses and this crate's passes that ran.
    pub ran: Vec<Cow<'static, str>>,
    /// The passes that were left out.
    pub left_out: usize,
    /// Bindings of the fused pass.
    pub bindings: usize,
    /// Texels that the fused pass fetches per pixel: mean and maximum.
    pub fetches: [f64; 2],
    /// Bytes that it fetches per pixel on an 8-bit target, mean.
    pub bytes: f64,
    /// The work of the passes that find and draw lines.
    pub lines: LineWork,
}

/// The stages that are separate passes.
const PASSES: [ComicsStage; 9] = [
    ComicsStage::DepthPrepass,
    ComicsStage::NormalPrepass,
    ComicsStage::ObjectIds,
    ComicsStage::DepthRange,
    ComicsStage::RangeSmoothing,
    ComicsStage::SearchTiles,
    ComicsStage::FindLines,
    ComicsStage::DrawLines,
    ComicsStage::Stylize,
];

/// Desaturation, colorization and contours: the style that the report's targets are set
/// for.
pub fn default_comic() -> ComicStyle {
    ComicStyle::new()
        .with(Desaturation::default())
        .with(Colorization::default())
        .with(Contours::default())
}

/// The default outlines with a change.
fn outlines(change: impl FnOnce(&mut Outlines)) -> Outlines {
    let mut outlines = Outlines::default();
    change(&mut outlines);
    outlines
}

/// Outlines that are neither linked to lines nor smooth, and have no budget.
pub fn along_cracks() -> Outlines {
    Outlines {
        hysteresis: 0.0,
        min_length: 1,
        response: LineResponse::Ink,
        smooth: false,
        ink_budget: 1.0,
        ..default()
    }
}

/// Outlines of which one thing differs from the default: what each costs.
fn factors() -> [(&'static str, Outlines); 9] {
    let weighted = |change: fn(&mut LineWeight)| {
        let mut weight = LineWeight::EVEN;
        change(&mut weight);
        outlines(|o| o.weight = weight)
    };
    let unlinked = outlines(|o| (o.hysteresis, o.min_length) = (0.0, 1));
    let by_kind = |w: &mut LineWeight| {
        (w.outer, w.inner, w.crease, w.object) = (1.5, 0.75, 0.6, 0.75);
    };
    let by_light = weighted(|w| (w.shade, w.lit) = (0.6, 0.4));
    let by_distance = weighted(|w| w.perspective = 0.5);
    [
        ("outlines, not linked", unlinked),
        ("outlines, not smooth", outlines(|o| o.smooth = false)),
        (
            "outlines, without a budget",
            outlines(|o| o.ink_budget = 1.0),
        ),
        ("outlines, boiling", outlines(|o| o.boil.amplitude = 1.0)),
        ("outlines, weighted by kind", weighted(by_kind)),
        ("outlines, weighted by light", by_light),
        ("outlines, weighted by distance", by_distance),
        (
            "outlines, drawn with a nib",
            weighted(|w| w.nib_roundness = 0.4),
        ),
        ("outlines, tapered", weighted(|w| w.taper = 12.0)),
    ]
}

/// The styles whose work is counted, from none to everything.
pub fn ladder() -> Vec<(&'static str, ComicStyle)> {
    let style = ComicStyle::new;
    let saturation = || style().with(Desaturation::default());
    let outlined = |outlines: Outlines| style().with(outlines);
    let wide = |width: f32| outlined(outlines(|o| o.width = width));
    let mapped = |style: ComicStyle, change: fn(&mut DepthMap)| {
        let mut map = DepthMap::default();
        change(&mut map);
        with_map(style, map)
    };
    let fixed = mapped(saturation(), |map| {
        map.mapping = DepthMapping::Fixed {
            from: 1.0,
            to: 20.0,
        };
    });
    let of_every_frame = mapped(default_comic(), |map| map.smoothing = None);
    let percentiles = mapped(default_comic(), |map| {
        map.smoothing = Some(RangeSmoothing {
            outliers: 0.005,
            ..default()
        });
    });
    let wide_cracks = outlined(Outlines {
        width: 16.0,
        ..along_cracks()
    });
    let everything = default_comic().with(ToneBands::default());
    let mut rungs = vec![
        ("no style", style()),
        ("one tint (sepia)", style().with(Colorization::SEPIA)),
        ("tone bands", style().with(ToneBands::default())),
        ("desaturation by a fixed range", fixed),
        ("desaturation", saturation()),
        ("contours", style().with(Contours::default())),
        ("iso-lines", style().with(IsoLines::default())),
        ("default comic", default_comic()),
        ("default comic, range of every frame", of_every_frame),
        ("default comic, percentiles", percentiles),
        ("silhouettes", outlined(Outlines::SILHOUETTES)),
        ("outlines", outlined(Outlines::default())),
        ("outlines, along cracks", outlined(along_cracks())),
        ("outlines, along cracks, 16 pixels wide", wide_cracks),
        ("outlines, 16 pixels wide", wide(16.0)),
        ("outlines, 8 pixels wide", wide(8.0)),
        ("sketch", style().with(Sketch::default())),
    ];
    rungs.extend(factors().map(|(name, outlines)| (name, outlined(outlines))));
    rungs.push(("everything", everything.with(Outlines::default())));
    rungs
}

/// The texels or words that a line of WGSL loads, and the bytes of each, by the name of its
/// binding.
fn texels(line: &str) -> Option<[u32; 2]> {
    let sizes = [
        ("column_texture", 16),
        ("means_texture", 16),
        ("aux_scalar_texture", 16),
        ("blue_noise_tile", 16),
        ("crack_texture", 8),
        ("crack_words[", 8),
        ("picture_texture", 8),
    ];
    let size = sizes.iter().find(|(name, _)| line.contains(name));
    let size = size.map_or(4, |(_, size)| *size);
    if line.contains("textureSampleLevel(") {
        return Some([4, size]);
    }
    let loads = [
        "textureLoad(",
        "return crack_words[",
        "return bend_words[",
        "planes[column_word(",
        "planes[row_word(",
        "planes[corner_word(",
    ];
    let is_load = loads.iter().any(|load| line.contains(load));
    is_load.then_some([1, size])
}

/// The file of the fused pass.
pub(crate) const FUSED: &str = "bevy_comics/fused/fused.wgsl";
/// The files whose functions read textures for the fused pass, sorted.
const READERS: [&str; 5] = [
    "bevy_comics/depth/normal.wgsl",
    "bevy_comics/depth/view.wgsl",
    FUSED,
    "bevy_comics/lines/draw/read.wgsl",
    "bevy_comics/objects/objects.wgsl",
];

/// The counter: a module that all readers import.
const COUNTER: &str = "#define_import_path bevy_comics_count::tally

var<private> fetched: vec2<f32>;
fn tally(count: f32, size: f32) { fetched += vec2(count, count * size); }
fn fetched_so_far() -> vec2<f32> { return fetched; }
fn packed_count() -> u32 { return u32(fetched.x) | (u32(fetched.y) << 16u); }
";
const IMPORT: &str = "#import bevy_comics_count::tally::{tally, fetched_so_far, packed_count}";

/// The end of the fused pass.
pub(crate) const RESULT: &str = "return vec4(to_stored(result.rgb), result.a);";

/// Keeps the counter's module loaded.
#[derive(Resource)]
struct Counter {
    _module: Handle<Shader>,
}

/// Adds a call of the counter before every fetch. The fused pass then returns the counts
/// instead of the color.
pub(crate) fn counting(path: &str, text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    if !text.contains("#define_import_path") {
        lines.push(IMPORT.to_owned());
    }
    for line in text.lines() {
        if let Some([count, size]) = texels(line) {
            lines.push(format!("tally({count}.0, {size}.0);"));
        }
        lines.push(line.to_owned());
        if line.starts_with("#define_import_path") {
            lines.push(IMPORT.to_owned());
        }
    }
    let text = lines.join("\n");
    if path != FUSED {
        return text;
    }
    assert!(text.contains(RESULT), "the end of the fused pass has moved");
    text.replace(
        RESULT,
        "return vec4(fetched_so_far(), to_stored(result.rgb).r, 1.0);",
    )
}

/// Replaces the text of these files by `edit(file, text)`, and adds the counter's module.
/// Returns the names of the files that were found, sorted.
pub(crate) fn edit_shaders(
    world: &mut World,
    files: &[&'static str],
    edit: impl Fn(&str, &str) -> String,
) -> Vec<&'static str> {
    let mut shaders = world.resource_mut::<Assets<Shader>>();
    let ids: Vec<_> = shaders.ids().collect();
    let module = shaders.add(Shader::from_wgsl(COUNTER, "bevy_comics_count/tally.wgsl"));
    let mut changed = Vec::new();
    for id in ids {
        let Some(shader) = shaders.get(id) else {
            continue;
        };
        let file = files.iter().find(|file| shader.path.ends_with(**file));
        if let (Source::Wgsl(text), Some(file)) = (&shader.source, file) {
            let shader = Shader::from_wgsl(edit(file, text), shader.path.clone());
            let _ = shaders.insert(id, shader);
            changed.push(*file);
        }
    }
    world.insert_resource(Counter { _module: module });
    changed.sort_unstable();
    changed
}

/// Size of the picture whose work is counted.
const SIZE: UVec2 = UVec2::new(160, 90);

/// The scene whose work is counted, in an HDR view.
pub(crate) fn teapot() -> Studio {
    let options = HeadlessOptions {
        size: SIZE,
        ..default()
    };
    // Where no tile is drawn over the picture, nothing is fetched.
    let plugins = (ComicsPlugin, BeforeStylize::Clear, cameras_are_hdr);
    let mut studio = Studio::with_plugins(BuiltIn::Teapot, options, Msaa::Off, plugins);
    // The counts of boiling lines depend on the time.
    studio.headless.step(2);
    studio
}

/// Else the engine would compile pipelines for the first frames as well.
fn cameras_are_hdr(app: &mut App) {
    app.register_required_components::<Camera3d, Hdr>();
}

/// Replaces the camera by one that has no buffers and textures yet.
pub(crate) fn renew_camera(studio: &mut Studio) {
    let target = studio.headless.render_target();
    studio.headless.app.world_mut().despawn(studio.camera);
    // The engine keeps textures for some frames.
    studio.headless.step(4);
    let camera = (studio.vantage.camera(), target, Msaa::Off);
    studio.camera = studio.headless.app.world_mut().spawn(camera).id();
    studio.headless.step(2);
}

/// Counts the work of styles on the teapot at 160 x 90 pixels. Passes of lines are counted in apps
/// that draw one style after the other.
#[derive(Default)]
pub struct WorkCounter {
    lines: PassCounters,
}

impl WorkCounter {
    pub fn count(&mut self, name: &'static str, style: &ComicStyle) -> Work {
        let (work, studio) = count_fused(name, style);
        let render_world = studio.headless.app.sub_app(RenderApp).world();
        let pipelines = render_world.resource::<PipelineCache>();
        Work {
            lines: line_work::count(&mut self.lines, style, pipelines, SIZE),
            ..work
        }
    }
}

/// What a pass has written in place of the colors of a view: mean and maximum of the texels, and
/// the mean of the bytes.
pub(crate) fn counted(render_world: &World, view: Entity) -> ([f64; 2], f64) {
    let (_, counted) = read_back::pictures(render_world, view).expect("a picture");
    let pixels = counted.pixels.len() as f64;
    let (mut texels, mut bytes) = ([0.0f64; 2], 0.0);
    for p in &counted.pixels {
        texels[0] += f64::from(p[0]) / pixels;
        texels[1] = texels[1].max(f64::from(p[0]));
        bytes += f64::from(p[1]) / pixels;
    }
    (texels, bytes)
}

/// Counts the work of a style but for that of its lines.
pub fn count_without_lines(name: &'static str, style: &ComicStyle) -> Work {
    count_fused(name, style).0
}

/// The same, with the app that has drawn the style.
fn count_fused(name: &'static str, style: &ComicStyle) -> (Work, Studio) {
    let mut studio = teapot();
    let camera = studio.camera;
    let changed = edit_shaders(studio.headless.app.world_mut(), &READERS, counting);
    assert_eq!(changed, READERS, "the files that read textures");
    line_work::draw(&mut studio, style);

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
            PipelineDescriptor::RenderPipelineDescriptor(d) => Some(d),
            _ => None,
        })
        .filter(|d| d.label.as_deref() == Some("comics_stylize"))
        .last()
        .map_or(0, |d| d.layout[0].entries.len());
    let (fetches, bytes) = if stages.ran(ComicsStage::Stylize) {
        counted(render_world, view)
    } else {
        default()
    };
    let work = Work {
        name,
        ran: ran.into_iter().map(ComicsStage::name).collect(),
        left_out: left.len(),
        bindings,
        fetches,
        bytes,
        lines: LineWork::default(),
    };
    (work, studio)
}
