//! Counts the texels, and the words of buffers, that the passes of the lines fetch: see
//! [`work`].
//!
//! In the pass that searches blocks, every invocation fetches the same number: it is
//! counted in the composed shader. The other passes are counted while they run. A pass
//! returns its count instead of its result, and the passes after it hand the count on to
//! the picture. Lists of tiles, the choice of samples, the faithful equations and the passes that
//! complete cracks are not counted, nor are writes.

use bevy::{
    prelude::*,
    render::{
        RenderApp,
        render_resource::{PipelineCache, PipelineDescriptor},
        sync_world::RenderEntity,
    },
    shader::ShaderDefVal,
};
use bevy_comics::{ComicStyle, Outlines};
use wgpu::naga::{Block, Expression, Function, Module, Statement};

use crate::{
    ROOT, read_back,
    studio::Studio,
    wgsl,
    work::{self, FUSED, RESULT, counting, edit_shaders, teapot},
};

/// Texels and words that the passes of the lines fetch per pixel of the picture, mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineWork {
    /// By the search for blocks with cracks.
    pub walk: f64,
    pub find: f64,
    pub columns: f64,
    pub draw: f64,
    /// Bytes that they fetch together.
    pub bytes: f64,
}

const CELLS: &str = "bevy_comics/lines/find/cells.wgsl";
const COLUMNS: &str = "bevy_comics/lines/draw/columns.wgsl";
const DRAW: &str = "bevy_comics/lines/draw/draw.wgsl";
const READ: &str = "bevy_comics/lines/draw/read.wgsl";
const SETTLE: &str = "bevy_comics/lines/link/settle.wgsl";
/// The files of the counted passes, and of the functions that they read textures with.
const FILES: [&str; 11] = [
    "bevy_comics/depth/normal.wgsl",
    "bevy_comics/depth/view.wgsl",
    FUSED,
    "bevy_comics/lines/cracks/read_planes.wgsl",
    "bevy_comics/lines/cracks/stored.wgsl",
    COLUMNS,
    DRAW,
    READ,
    CELLS,
    SETTLE,
    "bevy_comics/objects/objects.wgsl",
];

/// The end of each pass: how its result is returned, how a count is returned instead,
/// and how the count of an earlier pass is handed on.
struct End {
    file: &'static str,
    result: &'static str,
    counted: &'static str,
    handed: &'static str,
}

/// The end of the pass that finds cracks in cells.
const CELLS_END: &str = "        east_before = east.packed;
    }
";

/// The end of the pass that searches columns.
const COLUMNS_END: &str = "return vec4(
        best.packed.x, pack_middle(best.first, best.owners.xz, best.south.x),
        best.packed.y, pack_middle(best.second, best.owners.yw, best.south.y),
    );";

const ENDS: [End; 4] = [
    End {
        file: CELLS,
        result: CELLS_END,
        counted: "        east_before = east.packed;
    }
    crack_words[cell.y * line_pass.grid.rect.z + cell.x] = vec2(packed_count(), 0u);
",
        handed: "",
    },
    End {
        file: COLUMNS,
        result: COLUMNS_END,
        counted: "return vec4(packed_count(), vec3(0u));",
        handed: "return vec4(load_cracks(line_pass.grid, p).x, vec3(0u));",
    },
    End {
        file: DRAW,
        result: "return drawn;",
        counted: "drawn.ink = unpack4x8unorm(packed_count());\n    return drawn;",
        handed: "
#ifdef COLUMNS
    drawn.ink = unpack4x8unorm(textureLoad(column_texture, center, 0).x);
#else
    drawn.ink = unpack4x8unorm(load_cracks(line_pass.grid, center).x);
#endif
    return drawn;
",
    },
    End {
        file: FUSED,
        result: RESULT,
        counted: "",
        handed: "
#ifdef LINES
    return line_count(pixel);
#else
    return vec4(0.0);
#endif
",
    },
];

/// The text of a file while the pass in `counted` is counted.
fn edited(counted: &str, path: &str, text: &str) -> String {
    if path == READ {
        return text.replace(
            "// Ink at a position",
            "fn line_count(pixel: vec2<i32>) -> vec4<f32> {
                return textureLoad(line_texture, inside_viewport(pixel) - view.viewport.xy, 0);
            }\n\n// Ink at a position",
        );
    }
    if path == SETTLE {
        // It would take the counts of cells for cracks.
        let cell = "    let linked_east = cell_bits(";
        assert!(text.contains(cell), "a function of {path} has moved");
        return if counted == CELLS {
            text.replace(cell, &format!("    if true {{ return; }}\n{cell}"))
        } else {
            text.to_owned()
        };
    }
    let Some(end) = ENDS.iter().find(|end| end.file == path) else {
        return counting(path, text);
    };
    assert!(text.contains(end.result), "the end of {path} has moved");
    if path == FUSED {
        let import = "#ifdef LINES\n#import bevy_comics::lines::read::line_count\n#endif\n";
        return import.to_owned() + &text.replace(end.result, end.handed);
    }
    let place = |file: &str| ENDS.iter().position(|end| end.file == file);
    if path == CELLS && path == counted {
        // The cell's first texel gets the count of all its pixels, the others none.
        let none = text.replace("] = vec2(east.", "] = 0u * vec2(east.");
        counting(path, &none).replace(end.result, end.counted)
    } else if path == counted {
        counting(path, text).replace(end.result, end.counted)
    } else if place(path) > place(counted) {
        text.replace(end.result, end.handed)
    } else {
        // An earlier pass: its result is needed.
        text.to_owned()
    }
}

/// The teapot, while the pass of a file is counted.
fn counting_teapot(counted: &str) -> Studio {
    let mut studio = teapot();
    let edit = |path: &str, text: &str| edited(counted, path, text);
    let files = edit_shaders(studio.headless.app.world_mut(), &FILES, edit);
    assert_eq!(files, FILES, "the files of the passes");
    studio
}

/// Draws a style for as many frames as it needs to settle.
pub(crate) fn draw(studio: &mut Studio, style: &ComicStyle) {
    studio.shoot(Some(style));
    studio.headless.step(4);
}

/// The number that the passes have handed on for every pixel.
fn numbers(studio: &Studio) -> Vec<u32> {
    let world = studio.headless.app.world();
    let view = world.get::<RenderEntity>(studio.camera);
    let view = view.expect("extracted").id();
    let render_world = studio.headless.app.sub_app(RenderApp).world();
    let (_, counted) = read_back::pictures(render_world, view).expect("a picture");
    let bytes = |p: &[f32; 4]| p.map(|c| (c * 255.0).round() as u8);
    let pixels = counted.pixels.iter();
    pixels.map(|p| u32::from_le_bytes(bytes(p))).collect()
}

/// The passes that are counted while they run: their files, and the labels of their pipelines.
const COUNTED: [(&str, &str); 3] = [
    (CELLS, "comics_find_in_cells"),
    (COLUMNS, "comics_line_columns"),
    (DRAW, "comics_draw_lines"),
];

/// Apps that each count one pass, made when it is first needed.
#[derive(Default)]
pub(crate) struct PassCounters([Option<Studio>; COUNTED.len()]);

/// The label of a pipeline.
pub fn label(descriptor: &PipelineDescriptor) -> &str {
    let label = match descriptor {
        PipelineDescriptor::RenderPipelineDescriptor(d) => &d.label,
        PipelineDescriptor::ComputePipelineDescriptor(d) => &d.label,
    };
    label.as_deref().unwrap_or_default()
}

/// (texels, bytes) per pixel that the pass of a file fetches.
fn count_pass(studio: &mut Option<Studio>, style: &ComicStyle, file: &str) -> [f64; 2] {
    let boils = |outlines: &Outlines| outlines.boil.amplitude > 0.0;
    if style.get::<Outlines>().is_some_and(boils) {
        // Where boiling lines are depends on the time since the start of the app.
        *studio = None;
    }
    let studio = match studio {
        Some(studio) => {
            // Where a pass does not run, the counts of the style before would be left.
            work::renew_camera(studio);
            studio
        }
        None => studio.insert(counting_teapot(file)),
    };
    draw(studio, style);
    let counted = numbers(studio);
    let mean = |part: fn(u32) -> u32| {
        let sum: f64 = counted.iter().map(|number| f64::from(part(*number))).sum();
        sum / counted.len() as f64
    };
    [mean(|number| number & 0xffff), mean(|number| number >> 16)]
}

/// Texels per pixel that the pass that finds cracks in cells fetches in a style, in an app of its
/// own.
pub fn count_find(style: &ComicStyle) -> f64 {
    count_pass(&mut None, style, CELLS)[0]
}

/// Texels that an execution of these statements loads. Loops run `rounds` times.
fn loads(module: &Module, function: &Function, block: &Block, rounds: usize) -> usize {
    let within = |block: &Block| loads(module, function, block, rounds);
    block
        .iter()
        .map(|statement| match statement {
            Statement::Emit(range) => range
                .clone()
                .filter(|e| matches!(function.expressions[*e], Expression::ImageLoad { .. }))
                .count(),
            Statement::Call { function, .. } => {
                let called = &module.functions[*function];
                loads(module, called, &called.body, rounds)
            }
            Statement::Block(block) => within(block),
            Statement::If { accept, reject, .. } => within(accept).max(within(reject)),
            Statement::Loop {
                body, continuing, ..
            } => rounds * (within(body) + within(continuing)),
            _ => 0,
        })
        .sum()
}

/// Texels per pixel that the search for blocks fetches, with these definitions.
fn count_walk(definitions: &[ShaderDefVal], size: UVec2) -> f64 {
    let definitions: Vec<wgsl::Definition> = (definitions.iter())
        .filter_map(|definition| match definition {
            ShaderDefVal::Bool(name, on) => on.then_some((name.as_str(), None)),
            ShaderDefVal::UInt(name, value) => Some((name.as_str(), Some(*value))),
            ShaderDefVal::Int(..) => None,
        })
        .collect();
    let text = std::fs::read_to_string(format!("{ROOT}/src/lines/find/walk.wgsl"));
    let module = wgsl::module_with(&text.expect("the shader"), &definitions).expect("it compiles");
    let cracks = definitions.iter().any(|(name, _)| *name == "CRACKS");
    // Rows of a block, and those above and below that are read.
    let rows = if cracks { 32 + 5 } else { 32 + 2 };
    let walk = &module.entry_points[0].function;
    // Of two blocks each.
    let invocations = size.x.div_ceil(8) * size.y.div_ceil(32);
    let texels = loads(&module, walk, &walk.body, rows) * invocations as usize;
    texels as f64 / f64::from(size.x * size.y)
}

/// Counts the work of the lines of a style. `cache`: the pipelines of an app that draws
/// it in a picture of `size`.
pub(crate) fn count(
    counters: &mut PassCounters,
    style: &ComicStyle,
    cache: &PipelineCache,
    size: UVec2,
) -> LineWork {
    let mut walk = 0.0;
    let mut ran = [false; COUNTED.len()];
    for pipeline in cache.pipelines() {
        let name = label(&pipeline.descriptor);
        if let PipelineDescriptor::ComputePipelineDescriptor(d) = &pipeline.descriptor
            && name == "comics_walk"
        {
            walk = count_walk(&d.shader_defs, size);
        }
        for (ran, (_, label)) in ran.iter_mut().zip(COUNTED) {
            *ran |= name == label;
        }
    }
    let mut fetched = [[0.0; 2]; COUNTED.len()];
    for (i, (file, _)) in COUNTED.into_iter().enumerate() {
        if ran[i] {
            fetched[i] = count_pass(&mut counters.0[i], style, file);
        }
    }
    LineWork {
        walk,
        find: fetched[0][0],
        columns: fetched[1][0],
        draw: fetched[2][0],
        bytes: 4.0 * walk + fetched.iter().map(|f| f[1]).sum::<f64>(),
    }
}
