//! Files for pictures: one PNG, an animated PNG, or numbered frames.

use std::{
    fs::File,
    io::BufWriter,
    path::{Path, PathBuf},
};

use image::{DynamicImage, RgbImage, RgbaImage};

/// Where a turntable goes.
pub enum Frames {
    /// An animated PNG.
    Animation(PathBuf),
    /// One PNG a frame; the number goes between the two parts.
    WithScalar {
        before: String,
        digits: usize,
        after: String,
    },
}

impl Frames {
    /// `FILE.png` is an animation, `NAME%03d.png` are numbered files, anything
    /// else is a folder for `frame-000.png` and so on.
    pub fn parse(out: &str) -> Self {
        if let Some(numbered) = pattern(out) {
            return numbered;
        }
        if out.to_lowercase().ends_with(".png") {
            return Self::Animation(out.into());
        }
        Self::WithScalar {
            before: format!("{}/frame-", out.trim_end_matches(['/', '\\'])),
            digits: 3,
            after: ".png".into(),
        }
    }
}

/// A name with `%d` or `%0Nd` that ends in `.png`.
fn pattern(out: &str) -> Option<Frames> {
    let (before, rest) = out.split_once('%')?;
    let (digits, after) = rest.split_once('d')?;
    let digits: usize = match digits {
        "" => 1,
        _ => digits.strip_prefix('0')?.parse().ok()?,
    };
    let valid = digits <= 9 && after.to_lowercase().ends_with(".png");
    valid.then(|| Frames::WithScalar {
        before: before.into(),
        digits,
        after: after.into(),
    })
}

/// Writes frames as they come.
pub enum FrameWriter {
    Animation(PathBuf, Box<png::Writer<BufWriter<File>>>),
    WithScalar {
        before: String,
        digits: usize,
        after: String,
        next: usize,
    },
}

impl FrameWriter {
    /// `seconds` is the time of one turn of `count` frames.
    pub fn new(
        frames: &Frames,
        size: (u32, u32),
        count: u32,
        seconds: f32,
    ) -> Result<Self, String> {
        match frames {
            Frames::Animation(path) => {
                let file = create(path)?;
                let writer = animation(file, size, count, seconds);
                let writer = writer.map_err(|error| cannot_write(path, &error))?;
                Ok(Self::Animation(path.clone(), Box::new(writer)))
            }
            Frames::WithScalar {
                before,
                digits,
                after,
            } => Ok(Self::WithScalar {
                before: before.clone(),
                digits: *digits,
                after: after.clone(),
                next: 0,
            }),
        }
    }

    pub fn add(&mut self, picture: RgbaImage) -> Result<(), String> {
        match self {
            Self::Animation(path, writer) => writer
                .write_image_data(&opaque(picture))
                .map_err(|error| cannot_write(path, &error)),
            Self::WithScalar {
                before,
                digits,
                after,
                next,
            } => {
                let path = format!("{before}{next:0digits$}{after}", digits = *digits);
                *next += 1;
                save(picture, Path::new(&path))
            }
        }
    }

    /// Ends the file, and says what was written.
    pub fn finish(self) -> Result<String, String> {
        match self {
            Self::Animation(path, writer) => {
                let ended = writer.finish();
                ended.map_err(|error| cannot_write(&path, &error))?;
                Ok(path.display().to_string())
            }
            Self::WithScalar {
                before,
                digits,
                after,
                next,
            } => {
                let last = next.saturating_sub(1);
                Ok(format!(
                    "{before}{:0digits$}{after} to {before}{last:0digits$}{after}",
                    0
                ))
            }
        }
    }
}

fn animation(
    file: File,
    (width, height): (u32, u32),
    count: u32,
    seconds: f32,
) -> Result<png::Writer<BufWriter<File>>, png::EncodingError> {
    let mut encoder = png::Encoder::new(BufWriter::new(file), width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_animated(count, 0)?;
    let milliseconds = (1000.0 * seconds / count as f32)
        .round()
        .clamp(10.0, 65535.0);
    encoder.set_frame_delay(milliseconds as u16, 1000)?;
    encoder.write_header()
}

/// Saves a picture without alpha, and makes its folder.
pub fn save(picture: RgbaImage, path: &Path) -> Result<(), String> {
    drop(create(path)?);
    opaque(picture)
        .save(path)
        .map_err(|error| cannot_write(path, &error))
}

fn opaque(picture: RgbaImage) -> RgbImage {
    DynamicImage::ImageRgba8(picture).into_rgb8()
}

fn create(path: &Path) -> Result<File, String> {
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)
            .map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
    }
    File::create(path).map_err(|error| cannot_write(path, &error))
}

fn cannot_write(path: &Path, error: &dyn std::fmt::Display) -> String {
    format!("cannot write {}: {error}", path.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_numbered_as_the_name_says() {
        let folder = format!("bevy-comics-numbered-{}", std::process::id());
        let folder = std::env::temp_dir().join(folder);
        let out = folder.join("new").join("a%02d.png");
        let frames = Frames::parse(out.to_str().expect("a name"));
        let mut writer = FrameWriter::new(&frames, (4, 3), 3, 1.0).expect("a writer");
        for _ in 0..3 {
            writer.add(RgbaImage::new(4, 3)).expect("written");
        }
        let said = writer.finish().expect("written");
        let names = ["a00.png", "a01.png", "a02.png"];
        assert!(said.ends_with(names[2]), "{said}");
        let entries = std::fs::read_dir(folder.join("new")).expect("the folder");
        let mut paths: Vec<_> = entries.map(|entry| entry.expect("entry").path()).collect();
        paths.sort();
        assert_eq!(paths, names.map(|name| folder.join("new").join(name)));
        let size = image::image_dimensions(&paths[0]).expect("a picture");
        assert_eq!(size, (4, 3));
        std::fs::remove_dir_all(folder).expect("the folder goes");
    }
}
