//! Examples on the command line: their output files and their errors.

use std::{
    env,
    ffi::OsStr,
    fs,
    process::Output,
    sync::{Arc, PoisonError},
};

use bevy_comics_testkit::reference::range;
use serde_json::Value;

use crate::prelude::*;

/// Builds an example with the profile of this test, in its target folder; nothing is compiled there if
/// it was built with the tests. Returns what cargo says about the example and all that is linked into it.
pub fn build(example: &'static str) -> Arc<[Value]> {
    static BUILT: Mutex<BTreeMap<&str, Arc<[Value]>>> = Mutex::new(BTreeMap::new());
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    built
        .entry(example)
        .or_insert_with(|| ask_cargo(example))
        .clone()
}

fn ask_cargo(example: &str) -> Arc<[Value]> {
    let program = env::current_exe().expect("this test");
    // The program lies in TARGET/PROFILE/deps.
    let mut folders = program.ancestors().skip(2);
    let [Some(profile), Some(target)] = [folders.next(), folders.next()] else {
        panic!("{} is not in a target folder", program.display());
    };
    let profile = match profile.file_name().and_then(OsStr::to_str) {
        Some("debug") => "dev",
        Some(name) => name,
        None => panic!("{} is not the folder of a profile", profile.display()),
    };
    let output = Command::new(env::var("CARGO").unwrap_or_else(|_| "cargo".into()))
        .args(["build", "--quiet", "--locked", "--offline"])
        .args(["--profile", profile, "--example", example])
        .arg("--message-format=json-render-diagnostics")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("CARGO_TARGET_DIR", target)
        // `scripts/test` sets it for the test binary; build scripts would see it and run again.
        .env_remove("RUSTC_BOOTSTRAP")
        .output()
        .expect("cargo runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success(),
        "{example} does not build: {errors}"
    );
    let messages = String::from_utf8(output.stdout).expect("UTF-8");
    messages
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect()
}

/// Builds an example and returns its path.
pub fn example(name: &'static str) -> PathBuf {
    let messages = build(name);
    let mut programs = messages.iter().filter_map(|m| m["executable"].as_str());
    programs.next_back().expect("the example").into()
}

/// The output of `render`, started in a folder.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(example("render"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("it starts")
}

/// A folder for one test.
pub fn folder(name: &str) -> PathBuf {
    let folder = env::temp_dir().join(format!("bevy-comics-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

#[test]
fn what_cannot_be_done_is_one_line_that_says_what_can() {
    let folder = folder("errors");
    fs::write(
        folder.join("broken.comic.ron"),
        "(version: 3, contours: (thresh: 1))",
    )
    .expect("written");
    fs::write(folder.join("broken.gltf"), "{ not json").expect("written");
    for (arguments, says) in [
        (
            &["moonscape"][..],
            "mountains, teapot, theatre, village, figure, street, hall",
        ),
        (&["--style", "nope"], "saturday-morning, graphic-novel"),
        (&["--material", "wood"], "possible are standard, toon"),
        (
            &["--style", "missing.comic.ron"],
            "cannot read missing.comic.ron",
        ),
        (&["--style", "broken.comic.ron"], "line 1"),
        (&["--size", "0x10"], "WxH"),
        (&["--size", "999999x10"], "this adapter draws"),
        (&["--msaa", "3"], "1, 2, 4, 8"),
        (&["--camera", "1,2,3"], "EX,EY,EZ,TX,TY,TZ"),
        (&["--camera", "1,2,3,nan,0,0"], "finite"),
        (&["--near", "-1"], "positive"),
        (&["--near", "5", "--far", "2"], "near must be smaller"),
        (&["--ortho", "inf"], "finite"),
        (&["--frames", "0"], "1 to 100000"),
        (&["--out", "picture.bmp"], ".png"),
        (&["--turntable", "1"], "2 to 720"),
        (&["--presets", "--out", "sheet"], ".png"),
        (&["--presets", "--style", "noir"], "exclude each other"),
        (&["--polish"], "--help"),
        (&["missing.glb"], "cannot read missing.glb"),
        (&["broken.gltf"], "is no glTF model"),
    ] {
        let output = run(&folder, arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
        // The driver and the engine may print warnings.
        let ours: Vec<_> = errors
            .lines()
            .filter(|line| line.starts_with("render: "))
            .collect();
        assert!(
            ours.len() == 1 && ours[0].contains(says),
            "{arguments:?}: {errors}"
        );
        assert!(!errors.contains("panicked"), "{arguments:?}: {errors}");
    }
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn a_dump_holds_the_depth_without_loss_and_says_what_was_decided() {
    let folder = folder("dump");
    let arguments = [
        "teapot",
        "--style",
        "crimson-dusk",
        "--size",
        "64x48",
        "--msaa",
        "1",
        "--frames",
        "4",
        "--hdr",
        "--out",
        "p.png",
        "--dump",
        "d",
    ];
    let output = run(&folder, &arguments);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(
        image::image_dimensions(folder.join("p.png")).expect("a PNG"),
        (64, 48)
    );

    let frame: Value =
        serde_json::from_slice(&fs::read(folder.join("d/frame.json")).expect("frame.json"))
            .expect("JSON");
    assert_eq!(frame["projection"], "perspective");
    assert_eq!(frame["style"]["name"], "Crimson dusk");
    let ran: Vec<_> = frame["passes_run"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(Value::as_str)
        .collect();
    assert!(
        ran.contains(&"stylize") && ran.contains(&"contours"),
        "{ran:?}"
    );
    assert_eq!(frame["passes_left_out"]["desaturation"], "not requested");
    for key in ["near", "far", "adapter", "clip_from_view"] {
        assert!(!frame[key].is_null(), "{key} is missing");
    }

    // The range is the scan of the depth that was written.
    let depth = exr::prelude::read_first_flat_layer_from_file(folder.join("d/depth.exr"))
        .expect("depth.exr");
    let channel = &depth.layer_data.channel_data.list[0];
    assert_eq!(channel.name.to_string(), "Z");
    let exr::prelude::FlatSamples::F32(values) = &channel.sample_data else {
        panic!("depth is not f32")
    };
    assert_eq!(values.len(), 64 * 48);
    let scan = range::scan(values.iter().copied()).expect("geometry");
    let bits: Vec<_> = frame["range"]["raw_bits"]
        .as_array()
        .expect("bits")
        .iter()
        .filter_map(Value::as_u64)
        .collect();
    assert_eq!(bits, scan.map(u64::from));

    // The pass changed the picture.
    let rgba = |name: &str| {
        let image =
            exr::prelude::read_first_flat_layer_from_file(folder.join("d").join(name)).expect(name);
        let channels = &image.layer_data.channel_data.list;
        channels
            .iter()
            .flat_map(|c| c.sample_data.values_as_f32())
            .collect::<Vec<f32>>()
    };
    assert_ne!(rgba("input.exr"), rgba("output.exr"));
    assert!(!folder.join("d/ids.exr").exists(), "no line wants ids");
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn a_dump_of_outlines_holds_ids_and_counts_the_lights() {
    let folder = folder("dump-ids");
    let arguments = [
        "theatre", "--size", "64x48", "--msaa", "1", "--frames", "1", "--out", "p.png", "--dump",
        "d",
    ];
    let output = run(&folder, &arguments);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let frame: Value =
        serde_json::from_slice(&fs::read(folder.join("d/frame.json")).expect("frame.json"))
            .expect("JSON");
    assert_eq!(frame["material"], "toon");
    for kind in ["directional", "point", "spot"] {
        assert_eq!(frame["lights"][kind], 1, "{kind}");
    }
    let ids =
        exr::prelude::read_first_flat_layer_from_file(folder.join("d/ids.exr")).expect("ids.exr");
    let channel = &ids.layer_data.channel_data.list[0];
    assert_eq!(channel.name.to_string(), "id");
    let exr::prelude::FlatSamples::U32(values) = &channel.sample_data else {
        panic!("ids are not whole numbers")
    };
    let different: BTreeSet<u32> = values.iter().copied().collect();
    assert!(different.len() > 10, "{} objects", different.len());
    assert!(folder.join("d/normal.exr").exists());
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// A triangle 0.01 units across, with no light and no camera.
const TRIANGLE: &str = r#"{
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "buffers": [{"uri": "triangle.bin", "byteLength": 36}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
    "min": [0, 0, 0], "max": [0.01, 0.01, 0]}]
}"#;

#[test]
fn a_gltf_file_is_framed_and_lit() {
    let folder = folder("model");
    fs::write(folder.join("triangle.gltf"), TRIANGLE).expect("written");
    let corners = [[0.0f32, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0]];
    let bytes: Vec<u8> = corners
        .iter()
        .flatten()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    fs::write(folder.join("triangle.bin"), bytes).expect("written");
    let output = run(
        &folder,
        &[
            "triangle.gltf",
            "--size",
            "64x64",
            "--out",
            "p.png",
            "--style",
            "none",
            "--dump",
            "d",
        ],
    );
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let frame: Value =
        serde_json::from_slice(&fs::read(folder.join("d/frame.json")).expect("frame.json"))
            .expect("JSON");
    // Framed: its distance is about its width. Lit: it is not black.
    let near = frame["range"]["distance"][0]
        .as_f64()
        .expect("it is in view");
    assert!(near > 0.005 && near < 0.1, "{near}");
    let picture = image::open(folder.join("p.png"))
        .expect("a picture")
        .to_rgb8();
    let middle = picture.get_pixel(28, 34).0;
    assert!(middle.iter().any(|c| *c > 40), "{middle:?}");
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// The game plays a level by itself and prints the result. That each level can be won is tested by the
/// game itself, without drawing it.
#[test]
#[ignore = "long: draws a village for many frames"]
fn the_game_finishes_a_level() {
    let output = Command::new(example("game"))
        .args(["--play", "--level", "1", "--lanterns", "47"])
        .output()
        .expect("it starts");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("The Village: won in "), "{said}");
    assert!(said.contains(" 48 of 48 lanterns"), "{said}");
}
