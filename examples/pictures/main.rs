//! Renders the pictures of the documents and of the tests, without a window.
//!
//! ```text
//! cargo run --example pictures -- contact-sheet [--size WxH] [--zoom N] [--out FILE.png]
//! cargo run --example pictures -- banner [--out FILE.png]
//! cargo run --example pictures -- looks [--out FILE.png]
//! cargo run --example pictures -- presets [--out FILE.png]
//! cargo run --example pictures -- gallery [--only NAME,NAME] [--out DIR]
//! cargo run --example pictures -- loops [--out DIR]
//! cargo run --example pictures -- ramps [--out FILE.png]
//! cargo run --example pictures -- toon [--out DIR]
//! cargo run --example pictures -- pages [--out DIR]
//! cargo run --example pictures -- motion [--out DIR]
//! cargo run --example pictures -- print [--out DIR]
//! cargo run --example pictures -- strips [NAME...] [--out DIR]
//! cargo run --example pictures -- figures [--out DIR]
//! cargo run --example pictures -- golden [--only NAME,NAME] [--out DIR]
//! ```

mod figures;
mod gallery;
mod loops;
mod motion;
mod pages;
mod painted;
mod palette;
mod print;
mod ramps;
mod sheet;
mod smoothed;
mod strips;
mod strokes;
mod toon;

use std::{path::PathBuf, process::ExitCode};

use bevy::math::UVec2;

const USAGE: &str = "\
usage: pictures contact-sheet [--size WxH] [--zoom N] [--out FILE.png]
                                                              every scene in every preset; or the
                                                              middle of each, enlarged 2 to 8 times
       pictures banner [--out FILE.png]                       the README's first picture
       pictures looks [--out FILE.png]                        a row of looks, for the page of examples
       pictures presets [--out FILE.png]                      the page of the presets
       pictures gallery [--only NAME,NAME] [--out DIR]        docs/looks: every look, and how they differ;
                                                              or only the numbers of these looks
       pictures loops [--out DIR]                             docs/looks: strokes and lines in motion
       pictures ramps [--out FILE.png]                        the ramps of the cartoon material
       pictures toon [--out DIR]                              signs, rims and X-Toon of the cartoon material
       pictures pages [--out DIR]                             the pages about single tasks
       pictures motion [--out DIR]                            the pages about speed lines and paper
       pictures print [--out DIR]                             the pages about print, paint and focus
       pictures strips [NAME...] [--out DIR]                  lines in motion, all or some
       pictures figures [--out DIR]                           the figures of the first paper
       pictures golden [--only NAME,NAME] [--out DIR]         the tests' reference pictures: all, or
                                                              those of these styles";

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("pictures: {message}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), String> {
    use lexopt::prelude::*;
    let mut parser = lexopt::Parser::from_env();
    let wrong = |error: lexopt::Error| format!("{error}\n{USAGE}");
    let (mut what, mut size, mut out) = (None, UVec2::new(480, 270), None);
    let mut names = Vec::new();
    let (mut only, mut zoom) = (String::new(), 1);
    while let Some(argument) = parser.next().map_err(wrong)? {
        match argument {
            Value(value) if what.is_none() => what = Some(value.to_string_lossy().into_owned()),
            Value(value) if what.as_deref() == Some("strips") => {
                names.push(value.to_string_lossy().into_owned());
            }
            Long("size") => {
                let text = parser.value().and_then(|v| v.string()).map_err(wrong)?;
                size = text
                    .split_once('x')
                    .and_then(|(w, h)| Some(UVec2::new(w.parse().ok()?, h.parse().ok()?)))
                    .filter(|size| size.min_element() >= 16 && size.max_element() <= 4096)
                    .ok_or_else(|| format!("--size {text}: possible are 16x16 to 4096x4096"))?;
            }
            Long("zoom") => {
                let text = parser.value().and_then(|v| v.string()).map_err(wrong)?;
                let number = text.parse().ok().filter(|zoom| (1..=8).contains(zoom));
                zoom = number.ok_or_else(|| format!("--zoom {text}: possible are 1 to 8"))?;
            }
            Long("only") => only = parser.value().and_then(|v| v.string()).map_err(wrong)?,
            Long("out") => out = Some(PathBuf::from(parser.value().map_err(wrong)?)),
            Short('h') | Long("help") => {
                println!("{USAGE}");
                return Ok(());
            }
            other => return Err(wrong(other.unexpected())),
        }
    }
    bevy_comics_testkit::headless::adapter()?;
    let or = |path: &str| out.clone().unwrap_or_else(|| PathBuf::from(path));
    match what.as_deref() {
        Some("contact-sheet") => sheet::contact_sheet(size, zoom, &or("target/contact-sheet.png")),
        Some("banner") => sheet::banner(&or("target/banner.png")),
        Some("looks") => sheet::looks(&or("target/looks.png")),
        Some("presets") => sheet::presets(&or("target/presets.png")),
        Some("gallery") => gallery::write(&or("docs/looks"), &only),
        Some("loops") => loops::write(&or("docs/looks")),
        Some("ramps") => save(&ramps::picture(), &or("target/ramps.png")),
        Some("toon") => toon::write(&or("target/toon")),
        Some("pages") => pages::write(&or("target/pages")),
        Some("motion") => motion::write(&or("target/motion")),
        Some("print") => print::write(&or("target/print")),
        Some("strips") => strips::write(&or("target/strips"), &names),
        Some("figures") => figures::write(&or("target/figures")),
        Some("golden") => sheet::golden(&or("tests/golden"), &only),
        Some(other) => Err(format!("no pictures called {other:?}\n{USAGE}")),
        None => Err(USAGE.into()),
    }
}

fn save(picture: &image::RgbaImage, path: &std::path::Path) -> Result<(), String> {
    if let Some(folder) = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
    {
        std::fs::create_dir_all(folder)
            .map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
    }
    // Pictures that may be committed: no alpha, compressed as far as it goes.
    let rgb = image::DynamicImage::ImageRgba8(picture.clone()).into_rgb8();
    let file = std::fs::File::create(path)
        .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    let encoder = image::codecs::png::PngEncoder::new_with_quality(
        std::io::BufWriter::new(file),
        image::codecs::png::CompressionType::Best,
        image::codecs::png::FilterType::Adaptive,
    );
    rgb.write_with_encoder(encoder)
        .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    println!("wrote {}", path.display());
    Ok(())
}
