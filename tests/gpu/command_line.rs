//! Examples on the command line: their output files and their errors.

use std::{
    env,
    ffi::OsStr,
    fs,
    process::Output,
    sync::{Arc, PoisonError},
};

use bevy_comics_testkit::reference::range;
use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
use serde_json::{Value, json};

use crate::prelude::*;

/// Builds an example with the profile of this test, in its target folder; nothing is compiled there
/// if it was built with the tests. Returns what cargo says about the example and all that is linked
/// into it.
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

/// The output of `render`, started in a folder, with these arguments between spaces.
pub fn run(folder: &Path, arguments: &str) -> Output {
    Command::new(example("render"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .output()
        .expect("it starts")
}

/// The same; it must end well. Gives what it wrote to stderr.
pub fn render(folder: &Path, arguments: &str) -> String {
    let output = run(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let is_right = output.status.success() && !errors.contains("panicked");
    assert!(is_right, "{arguments}: {errors}");
    errors
}

/// What a dump in `d` says of its frame.
pub fn frame(folder: &Path) -> Value {
    let text = fs::read(folder.join("d/frame.json")).expect("frame.json");
    serde_json::from_slice(&text).expect("JSON")
}

/// The name and the values of the first channel of a picture of a dump in `d`.
pub fn dumped(folder: &Path, name: &str) -> (String, FlatSamples) {
    let image = read_first_flat_layer_from_file(folder.join("d").join(name)).expect(name);
    let channel = image.layer_data.channel_data.list.into_iter().next();
    let channel = channel.expect("a channel");
    (channel.name.to_string(), channel.sample_data)
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
    let write = |name, text| fs::write(folder.join(name), text).expect("written");
    write("broken.comic.ron", "(version: 3, contours: (thresh: 1))");
    write("broken.gltf", "{ not json");
    for (arguments, says) in [
        (
            "moonscape",
            "mountains, teapot, theatre, village, figure, street, hall",
        ),
        ("--style nope", "saturday-morning, graphic-novel"),
        ("--material wood", "possible are standard, toon"),
        ("--style missing.comic.ron", "cannot read missing.comic.ron"),
        ("--style broken.comic.ron", "line 1"),
        ("--size 0x10", "WxH"),
        ("--size 999999x10", "this adapter draws"),
        ("--msaa 3", "1, 2, 4, 8"),
        ("--camera 1,2,3", "EX,EY,EZ,TX,TY,TZ"),
        ("--camera 1,2,3,nan,0,0", "finite"),
        ("--near -1", "positive"),
        ("--near 5 --far 2", "near must be smaller"),
        ("--ortho inf", "finite"),
        ("--frames 0", "1 to 100000"),
        ("--out picture.bmp", ".png"),
        ("--turntable 1", "2 to 720"),
        ("--presets --out sheet", ".png"),
        ("--presets --style noir", "exclude each other"),
        ("--polish", "--help"),
        ("missing.glb", "cannot read missing.glb"),
        ("broken.gltf", "is no glTF model"),
    ] {
        let output = run(&folder, arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {errors}");
        // The driver and the engine may print warnings.
        let ours = errors.lines().filter(|line| line.starts_with("render: "));
        let is_said = matches!(&ours.collect::<Vec<_>>()[..], [line] if line.contains(says));
        let is_right = is_said && !errors.contains("panicked");
        assert!(is_right, "{arguments}: {errors}");
    }
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// Contours read the depth range, and outlines the ids.
#[test]
fn a_dump_holds_depth_and_ids_without_loss_and_says_what_was_decided() {
    let folder = folder("dump");
    let both = r#"(version: 3, name: "Both lines", contours: (), outlines: ())"#;
    fs::write(folder.join("both.comic.ron"), both).expect("written");
    let style = "theatre --style both.comic.ron --hdr";
    let rest = "--size 64x48 --msaa 1 --frames 4 --out p.png --dump d";
    render(&folder, &format!("{style} {rest}"));
    let size = image::image_dimensions(folder.join("p.png"));
    assert_eq!(size.expect("a PNG"), (64, 48));

    let frame = frame(&folder);
    assert_eq!(frame["projection"], "perspective");
    assert_eq!(frame["style"]["name"], "Both lines");
    assert_eq!(frame["material"], "toon");
    for kind in ["directional", "point", "spot"] {
        assert_eq!(frame["lights"][kind], 1, "{kind}");
    }
    let ran = frame["passes_run"].as_array().expect("a list");
    for pass in ["stylize", "contours", "outlines"] {
        assert!(ran.iter().any(|name| name == pass), "{pass}: {ran:?}");
    }
    assert_eq!(frame["passes_left_out"]["desaturation"], "not requested");
    for key in ["near", "far", "adapter", "clip_from_view"] {
        assert!(!frame[key].is_null(), "{key} is missing");
    }

    // The range is the scan of the depth that was written.
    let (name, FlatSamples::F32(depth)) = dumped(&folder, "depth.exr") else {
        panic!("depth is not f32")
    };
    assert_eq!((name.as_str(), depth.len()), ("Z", 64 * 48));
    let scan = range::scan(depth).expect("geometry");
    assert_eq!(frame["range"]["raw_bits"], json!(scan));

    // The pass changed the picture.
    let [before, after] = ["input.exr", "output.exr"].map(|name| {
        let image = read_first_flat_layer_from_file(folder.join("d").join(name)).expect(name);
        let channels = image.layer_data.channel_data.list.into_iter();
        let values = channels.flat_map(|c| c.sample_data.values_as_f32().collect::<Vec<_>>());
        values.collect::<Vec<f32>>()
    });
    assert_ne!(before, after);

    let (name, FlatSamples::U32(ids)) = dumped(&folder, "ids.exr") else {
        panic!("ids are not whole numbers")
    };
    assert_eq!(name, "id");
    let different: BTreeSet<u32> = ids.into_iter().collect();
    assert!(different.len() > 10, "{} objects", different.len());
    assert!(folder.join("d/normal.exr").exists());
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// The game plays a level by itself and prints the result. That each level can be won is tested by
/// the game itself, without drawing it.
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
