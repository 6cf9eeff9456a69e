//! Names and files of styles.

use super::*;
use crate::fuzz::{Numbers, cases, in_time};
use bevy_comics::{Contours, ToneBands};

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("comics-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn inked(width: f32) -> ComicStyle {
    ComicStyle::new().with(Contours {
        width,
        ..Contours::default()
    })
}

fn wait(files: &mut Files, camera: Entity, style: &ComicStyle) -> Option<ComicStyle> {
    std::thread::sleep(WATCH + Duration::from_millis(20));
    files.watch(camera, style)
}

#[test]
fn a_name_alone_is_a_file_of_the_folder() {
    let of = |name| path_of(name, ".toon.ron", Path::new("shading"));
    assert_eq!(of("  "), None);
    assert_eq!(of(" skin"), Some("shading/skin.toon.ron".into()));
    assert_eq!(of("skin.toon.ron"), Some("shading/skin.toon.ron".into()));
    assert_eq!(of("other/skin"), Some("other/skin.toon.ron".into()));
    assert_eq!(of("/tmp/skin"), Some("/tmp/skin.toon.ron".into()));
}

/// A name without separators is a file in the folder, whatever it is; what is typed as a path is
/// that path.
#[test]
fn a_file_of_any_name_is_handled() {
    const PARTS: [&str; 14] = [
        "skin",
        ".",
        "..",
        "/",
        "\\",
        ":",
        "C:",
        "~",
        " ",
        "\0",
        "\u{1f600}",
        SUFFIX,
        ".ron",
        "\n",
    ];
    let (folder, mut numbers) = (Path::new("shading"), Numbers::new(7));
    for _ in 0..cases() {
        let parts = (0..numbers.below(8)).map(|_| PARTS[numbers.below(PARTS.len())]);
        let name: String = parts.collect();
        let Some(path) = in_time(&name, || path_of(&name, SUFFIX, folder)) else {
            assert!(name.trim().is_empty(), "{name:?}");
            continue;
        };
        assert!(path.to_string_lossy().ends_with(SUFFIX), "{name:?}");
        if !name.contains(['/', '\\', ':']) {
            assert_eq!(path.parent(), Some(folder), "{name:?}");
        }
    }
}

#[test]
fn a_partial_file_keeps_what_it_does_not_mention() {
    let folder = folder("partial");
    let path = folder.join("ink.comic.ron");
    fs::write(&path, "(version: 3, partial: true, contours: (width: 7.0))").expect("written");
    let mut files = Files::new(folder.clone(), EffectRegistry::built_in());
    let loaded = files.load(Entity::PLACEHOLDER, &path).expect("loaded");
    let toned = ComicStyle::new().with(ToneBands::default());
    let style = on_camera(&loaded, &toned);
    assert_eq!(style.get::<Contours>().map(|c| c.width), Some(7.0));
    assert!(style.get::<ToneBands>().is_some() && !style.partial);
    let open = &files.open[&Entity::PLACEHOLDER];
    assert!(open.is_saved(&style) && !open.is_saved(&inked(3.0)));
    fs::remove_dir_all(&folder).expect("removed");
}

/// The panel edits effects alone, also on a camera that does not have the rest of the file.
#[test]
fn a_file_keeps_what_the_panel_does_not_edit() {
    let folder = folder("scene");
    let path = folder.join("ink.comic.ron");
    let text = "(version: 3, camera: (dither: Off), contours: (width: 7.0))";
    fs::write(&path, text).expect("written");
    let mut files = Files::new(folder.clone(), EffectRegistry::built_in());
    let camera = Entity::PLACEHOLDER;
    let file = files.load(camera, &path).expect("loaded");
    assert!(files.open[&camera].is_saved(&inked(7.0)));
    files.save(camera, &inked(8.0));
    let saved = style_of(&path, &text_of(&path).expect("text"), &files.registry);
    let saved = saved.expect("a style");
    assert_eq!(saved.camera, file.camera);
    let contours = saved.get::<Contours>().expect("contours");
    assert_eq!(contours.width, 8.0);
    fs::remove_dir_all(&folder).expect("removed");
}

#[test]
fn a_file_goes_there_and_back() {
    let folder = folder("files");
    let mut files = Files::new(folder.clone(), EffectRegistry::built_in());
    let camera = Entity::PLACEHOLDER;
    files.save(camera, &inked(3.0));
    assert!(files.message.is_some(), "no name, no file");
    files.name = "mine".into();
    files.save(camera, &inked(3.0));
    assert_eq!(files.message, None);
    let path = folder.join("mine.comic.ron");
    assert_eq!(style_files(&folder), std::slice::from_ref(&path));
    assert!(files.open[&camera].is_saved(&inked(3.0)));
    assert!(
        !files.open[&camera].is_saved(&inked(4.0)),
        "a change is marked"
    );

    // What the panel itself has written is not a change.
    assert_eq!(wait(&mut files, camera, &inked(4.0)), None);

    // Another program edits it, breaks it, repairs it, deletes it.
    fs::write(&path, "(version: 3, contours: (width: 7.0))").expect("written");
    let read = wait(&mut files, camera, &inked(4.0)).expect("the new style");
    assert_eq!(read.get::<Contours>().map(|c| c.width), Some(7.0));
    fs::write(&path, "(version: 3,\n contours: (widht: 7.0))").expect("written");
    assert_eq!(
        wait(&mut files, camera, &inked(7.0)),
        None,
        "the last valid style stays"
    );
    let error = files.open[&camera].error.clone().expect("an error");
    assert!(
        error.contains("line 2") && error.contains("column"),
        "{error}"
    );
    fs::write(&path, "(version: 3, contours: (width: 8.0))").expect("written");
    assert!(wait(&mut files, camera, &inked(7.0)).is_some());
    assert_eq!(files.open[&camera].error, None);
    fs::remove_file(&path).expect("removed");
    assert_eq!(wait(&mut files, camera, &inked(8.0)), None);
    assert!(
        files.open[&camera].error.is_some(),
        "a missing file is an error"
    );
    fs::remove_dir_all(&folder).expect("removed");
}
