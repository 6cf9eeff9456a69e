//! Style files: read, written, loaded, changed on disk, broken, removed.

use std::fs;

use bevy::reflect::{
    PartialReflect, ReflectMut,
    enums::{DynamicEnum, DynamicVariant, VariantInfo},
    structs::DynamicStruct,
};
use bevy_comics::style::ComicStyleError;
use proptest::{
    prelude::{ProptestConfig, Strategy, any},
    test_runner::TestRunner,
};

use crate::prelude::*;

/// A number of any size and sign.
fn number(random: &mut Random) -> f32 {
    let mut half = || (random.unit() * 65536.0) as u32;
    let x = f32::from_bits((half() << 16) | half());
    if x.is_finite() { x } else { -0.0 }
}

fn color(random: &mut Random) -> Color {
    if random.unit() < 0.5 {
        return Color::srgba(random.unit(), 0.123_456_7, 0.9, 1.0);
    }
    let [r, g, b, a] = [0; 4].map(|_| (256.0 * random.unit()) as u8);
    Color::srgba_u8(r, g, b, a)
}

/// Sets a value at random: of a struct, half of the fields.
fn set_at_random(value: &mut dyn PartialReflect, random: &mut Random) {
    if let Some(x) = value.try_downcast_mut::<f32>() {
        *x = number(random);
    } else if let Some(x) = value.try_downcast_mut::<Option<f32>>() {
        *x = (random.unit() < 0.5).then(|| number(random));
    } else if let Some(x) = value.try_downcast_mut::<u32>() {
        *x = random.pick(&[0, 1, 7, 98, u32::MAX]);
    } else if let Some(x) = value.try_downcast_mut::<bool>() {
        *x = random.unit() < 0.5;
    } else if let Some(x) = value.try_downcast_mut::<Color>() {
        *x = color(random);
    } else {
        set_inside_at_random(value, random);
    }
}

/// Files have colors in sRGB, and some defaults are not.
fn into_srgb(value: &mut dyn PartialReflect) {
    if let Some(color) = value.try_downcast_mut::<Color>() {
        *color = Color::Srgba(color.to_srgba());
        return;
    }
    match value.reflect_mut() {
        ReflectMut::Struct(all) => {
            (0..all.field_len()).for_each(|i| into_srgb(all.field_at_mut(i).expect("a field")));
        }
        ReflectMut::Enum(kind) => {
            (0..kind.field_len()).for_each(|i| into_srgb(kind.field_at_mut(i).expect("a field")));
        }
        _ => {}
    }
}

fn set_inside_at_random(value: &mut dyn PartialReflect, random: &mut Random) {
    let info = value.get_represented_type_info();
    match value.reflect_mut() {
        ReflectMut::Struct(all) => {
            for i in 0..all.field_len() {
                let field = all.field_at_mut(i).expect("a field");
                if random.unit() < 0.5 {
                    set_at_random(field, random);
                } else {
                    into_srgb(field);
                }
            }
        }
        ReflectMut::Enum(kind) => {
            let info = info.expect("a type").as_enum().expect("kinds");
            let variant = match random.pick(&info.iter().collect::<Vec<_>>()) {
                VariantInfo::Unit(unit) => DynamicEnum::new(unit.name(), DynamicVariant::Unit),
                VariantInfo::Struct(of) => {
                    let mut fields = DynamicStruct::default();
                    for field in of.iter() {
                        fields.insert(field.name(), number(random));
                    }
                    DynamicEnum::new(of.name(), fields)
                }
                VariantInfo::Tuple(_) => {
                    for i in 0..kind.field_len() {
                        set_at_random(kind.field_at_mut(i).expect("a field"), random);
                    }
                    return;
                }
            };
            kind.apply(&variant);
        }
        _ => panic!("{info:?} has no random values"),
    }
}

/// Styles with any of the effects, whose settings are far out of their ranges.
pub fn styles() -> impl Strategy<Value = ComicStyle> {
    (".{0,12}", any::<u64>()).prop_map(|(name, seed)| {
        let mut random = Random::new(seed);
        let mut style = ComicStyle::new();
        style.name = name;
        if random.unit() < 0.5 {
            let mut map = DepthMap::default();
            set_at_random(&mut map, &mut random);
            style.depth_map = Some(map);
        }
        for kind in EffectRegistry::built_in().types() {
            if random.unit() < 0.4 {
                let mut effect = (kind.default)();
                set_at_random(effect.as_struct_mut(), &mut random);
                style.insert_any(effect);
            }
        }
        style
    })
}

/// As many styles as the variable `FUZZ_CASES` says, else 400.
#[test]
fn a_style_saved_and_loaded_is_equal() {
    let given = std::env::var("FUZZ_CASES").ok();
    TestRunner::new(ProptestConfig {
        cases: given.and_then(|text| text.parse().ok()).unwrap_or(400),
        ..default()
    })
    .run(&styles(), |style| {
        let text = style.to_ron().expect("every style has a text");
        let back = ComicStyle::from_ron(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        // Compares bits, so that -0 is kept.
        assert_eq!(format!("{style:?}"), format!("{back:?}"), "{text}");
        Ok(())
    })
    .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn errors_name_the_line_and_what_is_wrong() {
    for (text, named) in [
        (
            "(\n    version: 3,\n    contours: (\n        treshold: 0.1,\n    ),\n)",
            &["line 4", "treshold"][..],
        ),
        ("(version: 3,\n contours: (\n", &["line 2"]),
        ("(version: 3, contours: (color: \"reddish\"))", &["reddish"]),
    ] {
        let error = ComicStyle::from_ron(text).expect_err("must not read");
        let error = error.to_string();
        assert!(named.iter().all(|name| error.contains(name)), "{error}");
    }
    assert!(matches!(
        ComicStyle::from_ron("(version: 7)"),
        Err(ComicStyleError::Version { found: 7, .. })
    ));
}

/// A temporary folder, removed when dropped.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("bevy-comics-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // An error is ignored: the system empties its temporary folder.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Steps until the app satisfies `done`; false after this many frames.
fn wait(small: &mut Small, frames: usize, done: impl Fn(&Small) -> bool) -> bool {
    for _ in 0..frames {
        small.headless.step(1);
        if done(small) {
            return true;
        }
        std::thread::sleep(Duration::from_millis(25));
    }
    false
}

/// The width of the camera's contours.
fn width(small: &Small) -> Option<f32> {
    let contours = small.headless.app.world().get::<Contours>(small.camera);
    contours.map(|contours| contours.width)
}

#[test]
fn a_style_file_is_loaded_reloaded_and_survives_being_broken() {
    let folder = Folder::new("styles");
    let file = folder.0.join("mine.comic.ron");
    let write = |text: &str| fs::write(&file, text).expect("written");
    write("(version: 3, contours: (width: 3.0))");
    let with_watcher = HeadlessOptions {
        assets: folder.0.to_string_lossy().into_owned(),
        watch: true,
        ..options(size())
    };
    let mut small = Small::with(with_watcher, Msaa::Off);
    let server = small.world().resource::<AssetServer>();
    let handle = server.load("mine.comic.ron");
    let id = handle.id();
    small.insert(Comic(handle));
    // Ten seconds.
    let becomes =
        |small: &mut Small, wanted: f32| wait(small, 400, |small| width(small) == Some(wanted));
    assert!(becomes(&mut small, 3.0), "the style did not load");

    write("(version: 3, contours: (width: 5.0), desaturation: ())");
    assert!(becomes(&mut small, 5.0), "the change did not arrive");
    let camera = small.camera;
    assert!(small.world().get::<Desaturation>(camera).is_some());

    write("(version: 3, contours: (width: ");
    let is_read = wait(&mut small, 400, |small| {
        let server = small.headless.app.world().resource::<AssetServer>();
        server.load_state(id).is_failed()
    });
    assert!(is_read, "the broken file was not read");
    let changes = wait(&mut small, 5, |small| width(small) != Some(5.0));
    assert!(!changes, "the last good look is kept");

    write("(version: 3, contours: (width: 7.0))");
    assert!(becomes(&mut small, 7.0), "mended, it is back");
    let lost = small.world().get::<Desaturation>(camera).is_none();
    assert!(lost, "what the style lost, the camera lost");

    small.camera_mut().remove::<Comic>();
    let is_bare = wait(&mut small, 400, |small| width(small).is_none());
    assert!(is_bare, "without the handle there is no look");
}
