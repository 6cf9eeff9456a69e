//! The command line.

use std::path::PathBuf;

use bevy::math::UVec2;

const USAGE: &str = "\
usage: pictures styles [--size WxH] [--out FILE.png]         each style of the gallery in its own scene
       pictures contact-sheet [--size WxH] [--zoom N] [--out FILE.png]
                                                              every scene in every preset; or the
                                                              middle of each, enlarged 2 to 8 times
       pictures banner [--out FILE.png]                       the README's first picture
       pictures style-row [--out FILE.png]                    a row of styles, for the page of examples
       pictures presets [--out FILE.png]                      the page of the presets
       pictures gallery [--only NAME,NAME] [--out DIR]        docs/gallery: every style, and how they differ;
                                                              or only the numbers of these styles
       pictures loops [--out DIR]                             docs/gallery: strokes and lines in motion
       pictures ramps [--out FILE.png]                        the ramps of the toon material
       pictures toon [--out DIR]                              signs, rims and X-Toon of the toon material
       pictures pages [--out DIR]                             the pages about single tasks
       pictures motion [--out DIR]                            the pages about speed lines and paper
       pictures print [--out DIR]                             the pages about print, paint and focus
       pictures strips [NAME...] [--out DIR]                  lines in motion, all or some
       pictures figures [--out DIR]                           the figures of the first paper
       pictures golden [--only NAME,NAME] [--out DIR]         the tests' reference pictures: all, or
                                                              those of these styles";

/// What can be drawn.
const PICTURES: [&str; 15] = [
    "styles",
    "contact-sheet",
    "banner",
    "style-row",
    "presets",
    "gallery",
    "loops",
    "ramps",
    "toon",
    "pages",
    "motion",
    "print",
    "strips",
    "figures",
    "golden",
];

/// What the command line asks for.
pub struct Arguments {
    /// One of the pictures.
    pub what: String,
    pub size: UVec2,
    pub zoom: u32,
    /// Names behind that of the pictures.
    pub names: Vec<String>,
    pub only: String,
    pub out: Option<PathBuf>,
}

impl Arguments {
    /// `None` when only help was asked for.
    pub fn parse() -> Result<Option<Self>, String> {
        let read = Self::read(lexopt::Parser::from_env())
            .map_err(|message| format!("{message}\n{USAGE}"))?;
        if read.is_none() {
            println!("{USAGE}");
        }
        Ok(read)
    }

    /// `None` when help was asked for.
    fn read(mut parser: lexopt::Parser) -> Result<Option<Self>, String> {
        use lexopt::prelude::*;
        let wrong = |error: lexopt::Error| error.to_string();
        let mut what = None;
        let mut read = Self {
            what: String::new(),
            size: UVec2::new(480, 270),
            zoom: 1,
            names: Vec::new(),
            only: String::new(),
            out: None,
        };
        while let Some(argument) = parser.next().map_err(wrong)? {
            match argument {
                Value(value) if what.is_none() => what = Some(value.to_string_lossy().into_owned()),
                Value(value) if what.as_deref() == Some("strips") => {
                    read.names.push(value.to_string_lossy().into_owned());
                }
                Long("size") => {
                    let text = parser.value().and_then(|v| v.string()).map_err(wrong)?;
                    read.size = size(&text)?;
                }
                Long("zoom") => {
                    let text = parser.value().and_then(|v| v.string()).map_err(wrong)?;
                    let number = text.parse().ok().filter(|zoom| (1..=8).contains(zoom));
                    read.zoom =
                        number.ok_or_else(|| format!("--zoom {text}: possible are 1 to 8"))?;
                }
                Long("only") => {
                    read.only = parser.value().and_then(|v| v.string()).map_err(wrong)?;
                }
                Long("out") => read.out = Some(parser.value().map_err(wrong)?.into()),
                Short('h') | Long("help") => return Ok(None),
                other => return Err(wrong(other.unexpected())),
            }
        }
        read.what = what.ok_or("no pictures are named")?;
        if PICTURES.contains(&read.what.as_str()) {
            Ok(Some(read))
        } else {
            Err(format!("no pictures called {:?}", read.what))
        }
    }
}

fn size(text: &str) -> Result<UVec2, String> {
    text.split_once('x')
        .and_then(|(w, h)| Some(UVec2::new(w.parse().ok()?, h.parse().ok()?)))
        .filter(|size| size.min_element() >= 16 && size.max_element() <= 4096)
        .ok_or_else(|| format!("--size {text}: possible are 16x16 to 4096x4096"))
}

#[cfg(test)]
mod tests {
    use bevy_comics_testkit::fuzz::{Counting, check_command_lines};

    use super::*;

    #[global_allocator]
    static ALLOCATOR: Counting = Counting;

    /// Command lines with an argument on each line.
    const RIGHT: [&str; 5] = [
        "contact-sheet\n--size\n320x180\n--zoom\n4\n--out\na.png",
        "gallery\n--only\nnoir,sepia\n--out=folder",
        "strips\nboil\nwalk",
        "golden\n--only=noir",
        "--help",
    ];

    /// Every command line is read, or refused with a message.
    #[test]
    fn parsing_a_command_line_never_panics() {
        check_command_lines(
            6,
            &RIGHT,
            |given| Arguments::read(lexopt::Parser::from_args(given)),
            |arguments| assert!(arguments.size.min_element() >= 16 && arguments.zoom <= 8),
        );
    }
}
