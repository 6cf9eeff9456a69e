//! Vulkan's validation layer. `scripts/validate` runs all tests under it: every app checks after
//! each frame and at its end that it has said nothing, the bare device whenever something is read.

use std::panic::catch_unwind;

use bevy_comics_testkit::{device::gpu, validation, wgsl};

use crate::prelude::*;

/// The only test of this file, by its whole name.
const TEST: &str = "validation::the_layer_is_active_where_it_is_wanted";
/// Set in the process in which the layer is made to speak: here, a test beside would find the
/// message.
const SPEAKS: &str = "VALIDATION_SPEAKS";
/// Precedes the text of the failed check.
const ARRIVED: &str = "the check failed with";

/// Writes a sample mask: naga 29 translates it to SPIR-V that is not valid (wgpu 7311). Where that
/// is mended, this needs another fault that wgpu does not see.
const SAMPLE_MASK: &str = "
    @vertex fn vertex() -> @builtin(position) vec4<f32> { return vec4(0.0); }
    @fragment fn fragment() -> @builtin(sample_mask) u32 { return 1u; }
";

/// Makes a pipeline that is wrong.
fn write_a_sample_mask() {
    let gpu = gpu();
    let module = wgsl::module(SAMPLE_MASK, &[]).unwrap_or_else(|error| panic!("{error}"));
    let module = gpu.shader(module);
    let _ = gpu
        .device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: Default::default(),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        });
}

/// Prints the text with which a check fails after the layer has warned.
fn speak() {
    gpu();
    validation::check();
    write_a_sample_mask();
    let panic = catch_unwind(validation::check).expect_err("no message of the layer arrives");
    let text = panic.downcast::<String>().expect("a text");
    assert!(text.contains(TEST), "the thread is missing: {text}");
    println!("{ARRIVED} {text}");
}

/// A layer that is missing is silent, too, and so is one whose messages do not arrive.
#[ignore = "only scripts/validate installs the layer"]
#[test]
fn the_layer_is_active_where_it_is_wanted() {
    assert!(validation::is_wanted(), "scripts/validate runs this test");
    if std::env::var_os(SPEAKS).is_some() {
        speak();
        return;
    }
    gpu();
    assert_eq!(
        validation::is_loaded(),
        Some(true),
        "the layer is not loaded, or the system does not say"
    );
    let output = Command::new(std::env::current_exe().expect("the path of the tests"))
        .args(["--exact", TEST, "--include-ignored"])
        .args(["--nocapture", "--test-threads=2"])
        .env(SPEAKS, "1")
        .output()
        .expect("the tests start");
    let [said, errors] = [&output.stdout, &output.stderr].map(|out| String::from_utf8_lossy(out));
    assert!(
        output.status.success() && said.contains(ARRIVED),
        "{said}\n{errors}"
    );
}
