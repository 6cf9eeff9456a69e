//! The error of the depth map when depth is stored in fewer bits.

use bevy::math::UVec2;

use bevy_comics_testkit::{device::gpu, drawing::draw};

use crate::{
    Run,
    bare::{self, Blit, fullscreen, group, texture, time, upload, view},
    capture,
    table::Table,
};

struct Encoding {
    name: &'static str,
    format: wgpu::TextureFormat,
    /// Whether the map is stored, and not the raw depth.
    keeps_map: bool,
    /// WGSL from `value` (raw depth or map) to `stored`.
    encode: &'static str,
    /// WGSL from `texel` back to `value`.
    decode: &'static str,
}

const PACK: &str = "let parts = fract(value * vec4(1.0, 255.0, 65025.0, 16581375.0));
    let stored = parts - parts.yzww * vec4(vec3(1.0 / 255.0), 0.0);";
const UNPACK: &str =
    "let value = dot(texel, vec4(1.0, 1.0 / 255.0, 1.0 / 65025.0, 1.0 / 16581375.0));";
const PLAIN: &str = "let stored = vec4(value);";
const READ: &str = "let value = texel.r;";
const SIXTEEN: &str = "let stored = vec4(u32(round(value * 65535.0)));";
const FROM_SIXTEEN: &str = "let value = f32(texel.r) / 65535.0;";

const ENCODINGS: [Encoding; 8] = {
    use wgpu::TextureFormat as F;
    const fn e(
        name: &'static str,
        format: wgpu::TextureFormat,
        keeps_map: bool,
        encode: &'static str,
        decode: &'static str,
    ) -> Encoding {
        Encoding {
            name,
            format,
            keeps_map,
            encode,
            decode,
        }
    }
    [
        e("f32 depth", F::R32Float, false, PLAIN, READ),
        e(
            "RGBA8-packed depth (paper)",
            F::Rgba8Unorm,
            false,
            PACK,
            UNPACK,
        ),
        e("f16 depth", F::R16Float, false, PLAIN, READ),
        e("unorm16 depth", F::R16Uint, false, SIXTEEN, FROM_SIXTEEN),
        e("unorm8 depth", F::R8Unorm, false, PLAIN, READ),
        e("f16 map", F::R16Float, true, PLAIN, READ),
        e("unorm16 map", F::R16Uint, true, SIXTEEN, FROM_SIXTEEN),
        e("unorm8 map", F::R8Unorm, true, PLAIN, READ),
    ]
};

/// Two passes: one stores the depth, the other reads it and computes the map.
struct Passes {
    target: wgpu::TextureView,
    encode: (wgpu::RenderPipeline, wgpu::BindGroup),
    result: wgpu::Texture,
    result_view: wgpu::TextureView,
    decode: (wgpu::RenderPipeline, wgpu::BindGroup),
}

const FRAME: &str = "#import bevy_comics::depth::map::{DepthFrame, depth_map}
    @group(0) @binding(0) var source: texture_2d<KIND>;
    @group(0) @binding(1) var<uniform> frame: DepthFrame;";

impl Passes {
    fn new(encoding: &Encoding, source: &wgpu::Texture, frame: &wgpu::Buffer) -> Self {
        let size = [source.width(), source.height()];
        let integer = encoding.format == wgpu::TextureFormat::R16Uint;
        let (kind, stored) = if integer {
            ("u32", "u32")
        } else {
            ("f32", "f32")
        };
        let value = if encoding.keeps_map {
            "depth_map(frame, d).x"
        } else {
            "d + 0.0 * frame.near"
        };
        let encode = fullscreen(
            &format!(
                "{}
                @fragment fn draw(@builtin(position) p: vec4<f32>) -> @location(0) vec4<{stored}> {{
                    let d = textureLoad(source, vec2<i32>(p.xy), 0).r;
                    let value = {value};
                    {}
                    return stored;
                }}",
                FRAME.replace("KIND", "f32"),
                encoding.encode
            ),
            encoding.format,
        );
        let read = if encoding.keeps_map {
            "value + 0.0 * frame.near"
        } else {
            "depth_map(frame, value).x"
        };
        let decode = fullscreen(
            &format!(
                "{}
                @fragment fn draw(@builtin(position) p: vec4<f32>) -> @location(0) vec4<f32> {{
                    let texel = textureLoad(source, vec2<i32>(p.xy), 0);
                    {}
                    return vec4({read});
                }}",
                FRAME.replace("KIND", kind),
                encoding.decode
            ),
            wgpu::TextureFormat::R32Float,
        );
        let usage = wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::COPY_SRC;
        let kept = texture(size, encoding.format, usage);
        let result = texture(size, wgpu::TextureFormat::R32Float, usage);
        let bind = |pipeline: &wgpu::RenderPipeline, texture: &wgpu::Texture| {
            group(
                &pipeline.get_bind_group_layout(0),
                &[
                    wgpu::BindingResource::TextureView(&view(texture)),
                    frame.as_entire_binding(),
                ],
            )
        };
        Self {
            target: view(&kept),
            encode: (encode.clone(), bind(&encode, source)),
            result_view: view(&result),
            result,
            decode: (decode.clone(), bind(&decode, &kept)),
        }
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        draw(encoder, &self.encode.0, &self.encode.1, &self.target);
        draw(encoder, &self.decode.0, &self.decode.1, &self.result_view);
    }
}

fn frame_buffer(ends: [f32; 2]) -> wgpu::Buffer {
    // DepthFrame: near, far, offset, floor, plane_far, extent, sky_gap, flags.
    let floats = [ends[0], ends[1], 0.0, 1.0 / 16384.0, 0.0, 0.0, 0.05];
    let mut words: Vec<u32> = floats.iter().map(|f| f.to_bits()).collect();
    words.push(0);
    gpu().buffer(&bare::words(&words), wgpu::BufferUsages::UNIFORM)
}

pub fn measure(run: &Run) -> Result<(), String> {
    let mut table = Table::new(&["scene", "encoding", "map", "band", "flip"]);
    let style = capture::look();
    for capture in capture::captures(run, 1) {
        let shot = &capture.shots[0];
        let Some(ends) = shot.ends() else { continue };
        let source = upload(capture.size.to_array(), &shot.depth);
        let frame = frame_buffer(ends);
        let exact = capture::frame(ends.map(f64::from));
        let truth: Vec<f64> = shot
            .depth
            .iter()
            .map(|d| exact.depth_map(f64::from(*d))[0])
            .collect();
        for encoding in &ENCODINGS {
            let passes = Passes::new(encoding, &source, &frame);
            let mut encoder = gpu().device.create_command_encoder(&Default::default());
            passes.record(&mut encoder);
            gpu().queue.submit([encoder.finish()]);
            let got: Vec<f64> = bare::read(&passes.result)
                .into_iter()
                .map(|bits| f64::from(f32::from_bits(bits)))
                .collect();
            let (mut map, mut band, mut count) = (0.0f64, 0usize, 0usize);
            let (mut a, mut b) = (Vec::new(), Vec::new());
            for ((d, light), (want, got)) in shot
                .depth
                .iter()
                .zip(&shot.picture)
                .zip(truth.iter().zip(&got))
            {
                if *d > 0.0 {
                    map = map.max((want - got).abs());
                    let of = |d: f64| (d * 8.0).floor().min(7.0);
                    band += usize::from(of(*want) != of(*got));
                    count += 1;
                }
                a.push(capture::styled(&style, *light, [*want, 1.0 - want]));
                b.push(capture::styled(&style, *light, [*got, 1.0 - got]));
            }
            table.push(&[
                &capture.name,
                &encoding.name,
                &format!("{map:.3e}"),
                &format!("{:.5}", band as f64 / count.max(1) as f64),
                &format!("{:.5}", capture::flip(capture.size, &a, &b)),
            ]);
        }
        run.say(&format!("{}: errors of the encodings", capture.name));
    }
    run.save("encoding_errors", &table)?;

    let size = if run.quick {
        UVec2::new(320, 180)
    } else {
        UVec2::new(1280, 720)
    };
    let depth: Vec<f32> = (0..size.x * size.y)
        .map(|i| 0.001 + 0.9 * (i % 977) as f32 / 977.0)
        .collect();
    let source = upload(size.to_array(), &depth);
    let frame = frame_buffer([0.901, 0.001]);
    let all: Vec<_> = ENCODINGS
        .iter()
        .map(|encoding| (encoding.name, Passes::new(encoding, &source, &frame)))
        .collect();
    let direct = Passes::new(&ENCODINGS[0], &source, &frame);
    let direct_group = group(
        &direct.decode.0.get_bind_group_layout(0),
        &[
            wgpu::BindingResource::TextureView(&view(&source)),
            frame.as_entire_binding(),
        ],
    );
    let blit = Blit::new(size.to_array());
    let mut times = Table::new(&["encoding", "width", "height", "round", "milliseconds"]);
    let repeat = if run.quick { 1 } else { 4 };
    for round in 0..=run.rounds {
        let mut row = |name: &str, ms: f64| {
            if round > 0 {
                times.push(&[&name, &size.x, &size.y, &round, &format!("{ms:.5}")]);
            }
        };
        row("blit", time(repeat, |e| blit.record(e)));
        row(
            "none: the depth texture itself",
            time(repeat, |e| {
                draw(e, &direct.decode.0, &direct_group, &direct.result_view);
            }),
        );
        for (name, passes) in &all {
            row(name, time(repeat, |e| passes.record(e)));
        }
        row("blit again", time(repeat, |e| blit.record(e)));
    }
    run.save("encoding_times", &times)
}
