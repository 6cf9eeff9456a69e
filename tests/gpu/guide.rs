//! The README and the pages of `docs/` lead somewhere, and are right about style files.

use std::fs;

use bevy_comics::style::ComicStyleError;

use crate::prelude::*;

/// A page of `docs/`.
pub fn page(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("docs")
        .join(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The code blocks of a language, in order.
pub fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    page.split("```")
        .skip(1)
        .step_by(2)
        .filter_map(|block| block.strip_prefix(language)?.strip_prefix('\n'))
        .collect()
}

/// The README and every page, with their paths.
fn pages() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = fs::read_dir(root.join("docs")).expect("the pages");
    let mut paths: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    paths.push(root.join("README.md"));
    paths
        .into_iter()
        .map(|path| (path.clone(), fs::read_to_string(path).expect("a page")))
        .collect()
}

/// The targets of a page's links and pictures.
fn links(page: &str) -> impl Iterator<Item = &str> {
    page.split("](")
        .skip(1)
        .filter_map(|rest| rest.split([')', '#', ' ']).next())
        .filter(|link| !link.is_empty() && !link.contains("://"))
}

#[test]
fn links_and_commands_of_the_pages_lead_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut linked, mut commands) = (0, 0);
    for (path, page) in pages() {
        let folder = path.parent().expect("a folder");
        for link in links(&page) {
            assert!(folder.join(link).exists(), "{}: {link}", path.display());
            linked += 1;
        }
        for command in page.split("--example ").skip(1) {
            let name = command.split([' ', '`', '\n', ':']).next().expect("a name");
            let exists = ["examples", "tools"].iter().any(|folder| {
                let source = root.join(folder).join(name);
                source.with_extension("rs").exists() || source.join("main.rs").exists()
            });
            assert!(exists, "{}: there is no example {name}", path.display());
            commands += 1;
        }
    }
    assert!(
        linked > 50 && commands > 15,
        "{linked} links, {commands} commands"
    );
}

/// Every step of the page is a style, and draws another picture than the last.
#[test]
fn the_steps_of_the_ten_minutes_can_be_followed() {
    let page = page("your-own-style.md");
    let steps = blocks(&page, "ron");
    assert!(steps.len() >= 5, "{} steps", steps.len());
    let mut small = Small::new(size(), Msaa::Off);
    let mut last = small.settle().picture();
    for (i, step) in steps.iter().enumerate() {
        let style =
            ComicStyle::from_ron(step).unwrap_or_else(|error| panic!("step {}: {error}", i + 1));
        assert_eq!(style, style.sanitized(), "step {} is in its ranges", i + 1);
        let picture = small.shot(&style);
        assert_ne!(picture, last, "step {} changes nothing", i + 1);
        last = picture;
    }
    // The error that the page quotes is the one that is reported.
    let broken = blocks(&page, "text")
        .first()
        .expect("the broken file's message")
        .trim();
    let error = ComicStyle::from_ron("(\n    version: 3,\n    outlines: (widht: 3.0),\n)")
        .expect_err("broken");
    assert_eq!(error.to_string(), broken);
}

#[test]
fn an_unknown_version_and_an_unknown_field_are_said() {
    let error = ComicStyle::from_ron("(version: 4)").expect_err("a later version");
    assert!(
        matches!(error, ComicStyleError::Version { found: 4, .. }),
        "{error}"
    );
    for text in [
        "(version: 3, glitter: ())",
        "(version: 3, sketch: (glitter: 1))",
        "(version: 3, depth_map: (smoothing: (glitter: 1)))",
    ] {
        let error = ComicStyle::from_ron(text).expect_err(text).to_string();
        assert!(
            error.contains("glitter") && error.contains("line 1, column"),
            "{error}"
        );
    }
    let error = ComicStyle::from_ron("(name: \"no version\")")
        .expect_err("no version")
        .to_string();
    assert!(error.contains("version"), "{error}");
}

/// The reference of the format is generated from the types.
#[test]
fn the_reference_of_the_format_is_that_of_the_types() {
    let made = reference::page();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/style-format.md");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(&path, &made).expect("written");
    }
    assert_eq!(
        page("style-format.md"),
        made,
        "UPDATE_DOCS=1 cargo test --test gpu -- the_reference_of_the_format"
    );
}

mod reference {
    use std::fmt::Write;

    use bevy::reflect::{NamedField, TypeInfo, Typed, enums::VariantInfo};
    use bevy_comics::{
        ComicStyle, DepthMap,
        effect::{EffectRegistry, EffectType, FieldRange},
        style::StyleCamera,
        toon::StyleScene,
    };

    const HEAD: &str = "\
# The format of style files

A style file is [RON](https://docs.rs/ron) with implicit `Some`, ends in `.comic.ron`, and holds one
`ComicStyle`. `version` is the version of the format and must be there. This page is about version 3; a file of
version 2 is read with a warning that says what to change. An unknown version, an unknown field or a wrong type
is an error that names line and column. Every other entry is optional: an effect that is left out is off (in a
partial style: as the camera has it), a field that is left out has its default. Colors are `\"#rrggbb\"`,
`\"#rrggbbaa\"` or four sRGB components. Numbers outside their range count as its nearest end. Lengths in logical
pixels are in page pixels where there is a `page`.

Files may be untrusted. Reading a text, using its settings and writing it again allocates at most 1 MiB and 256
bytes for each byte of the text, and takes less than a second; a test holds texts that are wrong somewhere to both. No
entry names another file.

This page is made from the types by a test, which fails where the two differ.
";

    /// Documentation as Markdown, without examples in Rust, and with names in place of
    /// links to items.
    fn prose(docs: Option<&str>) -> String {
        let mut text = String::new();
        for (index, part) in docs.unwrap_or_default().split("```").enumerate() {
            if index % 2 == 0 {
                text += &prose_between_examples(part);
            } else if part.starts_with("ron") {
                let _ = writeln!(text, "```{}```", part.replace("\n ", "\n"));
            }
        }
        while text.contains("\n\n\n") {
            text = text.replace("\n\n\n", "\n\n");
        }
        text.trim().to_owned()
    }

    fn prose_between_examples(part: &str) -> String {
        let mut text = String::new();
        for line in part.lines().map(str::trim) {
            if line.starts_with('[') && line.contains("]: ") {
                continue;
            }
            let line = line
                .strip_prefix("# ")
                .map_or(line.to_owned(), |title| format!("### {title}"));
            text += &without_links(&line);
            text.push('\n');
        }
        text
    }

    fn without_links(line: &str) -> String {
        let mut text = String::new();
        let mut rest = line;
        while let Some((before, link)) = rest.split_once("[`")
            && let Some((name, after)) = link.split_once("`]")
        {
            text += &format!("{before}`{name}`");
            rest = match after
                .strip_prefix('(')
                .and_then(|path| path.split_once(')'))
            {
                Some((_, after)) => after,
                None => after,
            };
        }
        text + rest
    }

    /// The same in one line, for a table.
    fn plain(docs: Option<&str>) -> String {
        prose(docs).replace('\n', " ").replace('|', "\\|")
    }

    /// Short for very small and very large numbers too.
    fn number(value: f64) -> String {
        if value != 0.0 && !(1e-4..1e6).contains(&value.abs()) {
            format!("{value:e}")
        } else {
            value.to_string()
        }
    }

    fn kind(field: &NamedField) -> String {
        let name = field.type_path_table().short_path().to_owned();
        match FieldRange::of(field) {
            Some(range) => {
                let unit = match range.unit {
                    "" => String::new(),
                    unit => format!(" {unit}"),
                };
                let [min, max] = [range.min, range.max].map(number);
                format!("{name}, {min} to {max}{unit}")
            }
            None => name,
        }
    }

    fn fields<'a>(page: &mut String, fields: impl Iterator<Item = &'a NamedField>) {
        page.push_str("\n| field | type, range | meaning |\n|---|---|---|\n");
        for field in fields {
            let _ = writeln!(
                page,
                "| `{}` | {} | {} |",
                field.name(),
                kind(field),
                plain(field.docs())
            );
        }
    }

    /// The sections of a type of this crate and of those of its fields that have none yet.
    fn sections(info: &'static TypeInfo, page: &mut String) {
        let table = info.type_path_table();
        let is_ours = table.crate_name() == Some("bevy_comics");
        // Styles name no images.
        if page.contains(&format!("\n## {}\n", table.short_path()))
            || table.short_path() == "RampMap"
        {
            return;
        }
        if is_ours {
            section_of(info, page);
        }
        let fields: Vec<Option<&TypeInfo>> = match info {
            TypeInfo::Struct(info) if is_ours => info.iter().map(NamedField::type_info).collect(),
            TypeInfo::Enum(info) => {
                let inner = info.iter().flat_map(|variant| match variant {
                    VariantInfo::Struct(inner) => inner.iter().map(NamedField::type_info).collect(),
                    VariantInfo::Tuple(inner) => inner.iter().map(|f| f.type_info()).collect(),
                    VariantInfo::Unit(_) => Vec::new(),
                });
                inner.collect()
            }
            TypeInfo::List(info) => vec![info.item_info()],
            _ => Vec::new(),
        };
        for field in fields.into_iter().flatten() {
            sections(field, page);
        }
    }

    fn section_of(info: &'static TypeInfo, page: &mut String) {
        let name = info.type_path_table().short_path();
        let _ = write!(page, "\n## {name}\n\n{}\n", prose(info.docs()));
        match info {
            TypeInfo::Struct(info) => fields(page, info.iter()),
            TypeInfo::Enum(info) => {
                page.push_str("\n| variant | meaning |\n|---|---|\n");
                for variant in info.iter() {
                    let shown = match variant.as_struct_variant() {
                        Ok(inner) => {
                            let names: Vec<&str> = inner.iter().map(NamedField::name).collect();
                            format!("{}({})", variant.name(), names.join(", "))
                        }
                        Err(_) => variant.name().to_owned(),
                    };
                    let _ = writeln!(page, "| `{shown}` | {} |", plain(variant.docs()));
                }
                for variant in info.iter() {
                    if let Ok(inner) = variant.as_struct_variant() {
                        let _ = write!(page, "\n`{}`:\n", variant.name());
                        fields(page, inner.iter());
                    }
                }
            }
            _ => panic!("{name} is no type of a style file"),
        }
    }

    /// The style, with an entry for each registered effect.
    fn style(page: &mut String, effects: &[&EffectType]) {
        let docs = prose(ComicStyle::type_info().docs());
        let _ = write!(
            page,
            "\n## ComicStyle\n\n{docs}\n\n| entry | type | meaning |\n|---|---|---|\n\
             | `version` | u32 | Version of the file format: 3. |\n\
             | `name` | String | Title for people. |\n\
             | `partial` | bool | Whether effects that the file does not mention stay as the camera has \
             them. Default: `false`. |\n\
             | `depth_map` | Option<DepthMap> | The depth map; the camera's own where absent. |\n\
             | `page` | Option<f32>, 90 to 4320 | Height of the view in page pixels. Without it, lengths \
             are in logical pixels. |\n\
             | `camera` | StyleCamera | What cameras with a `Comic` have besides effects. |\n\
             | `scene` | Option<StyleScene> | What cameras with a `Comic` do to the meshes that they \
             see; nothing where absent. |\n"
        );
        for effect in effects {
            let info = (effect.type_info)();
            let name = info.type_path_table().short_path();
            // The first paragraph; the rest follows in the section of the type.
            let docs: Vec<&str> = info.docs().unwrap_or_default().lines().collect();
            let about = docs.split(|line| line.trim().is_empty()).next();
            let about = plain(about.map(|lines| lines.join("\n")).as_deref());
            let _ = writeln!(page, "| `{}` | Option<{name}> | {about} |", effect.name);
        }
    }

    pub fn page() -> String {
        let mut page = HEAD.to_owned();
        let effects = EffectRegistry::built_in().types();
        style(&mut page, &effects);
        sections(DepthMap::type_info(), &mut page);
        sections(StyleCamera::type_info(), &mut page);
        for effect in effects {
            sections((effect.type_info)(), &mut page);
        }
        sections(StyleScene::type_info(), &mut page);
        page
    }
}
