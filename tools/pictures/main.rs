//! Renders the pictures of the documents and of the tests, without a window.
//!
//! ```text
//! cargo run --example pictures -- styles [--size WxH] [--out FILE.png]
//! cargo run --example pictures -- contact-sheet [--size WxH] [--zoom N] [--out FILE.png]
//! cargo run --example pictures -- banner [--out FILE.png]
//! cargo run --example pictures -- style-row [--out FILE.png]
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

mod arguments;
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

use arguments::Arguments;

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
    let Some(arguments) = Arguments::parse()? else {
        return Ok(());
    };
    let Arguments {
        size,
        zoom,
        only,
        names,
        ..
    } = &arguments;
    bevy_comics_testkit::headless::adapter()?;
    let or = |path: &str| arguments.out.clone().unwrap_or_else(|| PathBuf::from(path));
    match arguments.what.as_str() {
        "styles" => sheet::styles(*size, &or("target/styles.png")),
        "contact-sheet" => sheet::contact_sheet(*size, *zoom, &or("target/contact-sheet.png")),
        "banner" => sheet::banner(&or("target/banner.png")),
        "style-row" => sheet::style_row(&or("target/style-row.png")),
        "presets" => sheet::presets(&or("target/presets.png")),
        "gallery" => gallery::write(&or("docs/gallery"), only),
        "loops" => loops::write(&or("docs/gallery")),
        "ramps" => save(&ramps::picture(), &or("target/ramps.png")),
        "toon" => toon::write(&or("target/toon")),
        "pages" => pages::write(&or("target/pages")),
        "motion" => motion::write(&or("target/motion")),
        "print" => print::write(&or("target/print")),
        "strips" => strips::write(&or("target/strips"), names),
        "figures" => figures::write(&or("target/figures")),
        "golden" => sheet::golden(&or("tests/golden"), only),
        other => Err(format!("no pictures called {other:?}")),
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
