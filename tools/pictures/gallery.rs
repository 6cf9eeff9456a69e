//! The gallery of styles: a picture and a page, with how far styles are from each other.

use std::{fmt::Write, fs, path::Path};

use bevy::{math::UVec2, render::view::Msaa};
use bevy_comics::{ComicStyle, presets, style::Preset};
use bevy_comics_testkit::{
    ROOT,
    scenes::BuiltIn,
    studio::Studio,
    style_work::{
        LEAST_APART, LEAST_CONTRAST, MOST_CLIPPED, MOST_FLICKER, MOST_FRAGMENTS, Measures,
        StyleBench,
    },
};
use image::RgbaImage;

use crate::{loops, save};

/// Scenes that looks are compared on.
const COMPARED: [BuiltIn; 3] = [BuiltIn::Village, BuiltIn::Figure, BuiltIn::Street];

/// Frames of the turntable.
const FRAMES: usize = 6;

/// The scene that shows a style best; else the village.
const SHOWN: [(Preset, BuiltIn); 24] = [
    (presets::SATURDAY_MORNING, BuiltIn::Figure),
    (presets::LIGNE_CLAIRE, BuiltIn::Figure),
    (presets::CLEAR_BANDS, BuiltIn::Figure),
    (presets::PIXEL, BuiltIn::Figure),
    (presets::FIELD_GUIDE, BuiltIn::Figure),
    (presets::STAINED_GLASS, BuiltIn::Figure),
    (presets::UKIYO_E, BuiltIn::Mountains),
    (presets::MANGA_PAGE, BuiltIn::Theatre),
    (presets::SILVER_AGE, BuiltIn::Theatre),
    (presets::POP_POSTER, BuiltIn::Theatre),
    (presets::RED_POSTER, BuiltIn::Figure),
    (presets::ENGRAVING, BuiltIn::Theatre),
    (presets::HARD_BOILED, BuiltIn::Street),
    (presets::PENCIL_SKETCH, BuiltIn::Theatre),
    (presets::PENCIL_STUDY, BuiltIn::Figure),
    (presets::BALLPOINT, BuiltIn::Figure),
    (presets::RED_CHALK, BuiltIn::Figure),
    (presets::SUMI_E, BuiltIn::Figure),
    (presets::WATERCOLOR, BuiltIn::Mountains),
    (presets::OIL_SKETCH, BuiltIn::Mountains),
    (presets::TWILIGHT_TOON, BuiltIn::Mountains),
    (presets::NEON_NIGHT, BuiltIn::Street),
    (presets::NOIR, BuiltIn::Street),
    (presets::SILENT_FILM, BuiltIn::Theatre),
];

/// The scene in which the gallery shows a style.
pub fn scene_of(look: Preset) -> BuiltIn {
    let own = SHOWN.into_iter().find(|(preset, _)| *preset == look);
    own.map_or(BuiltIn::Village, |(_, scene)| scene)
}

/// Perceptual difference of two pictures (FLIP: Andersson et al. 2020), 0 to 1.
fn flip(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let rgb = |picture: &RgbaImage| {
        let bytes: Vec<u8> = picture.pixels().flat_map(|p| [p[0], p[1], p[2]]).collect();
        nv_flip::FlipImageRgb8::with_data(picture.width(), picture.height(), &bytes)
    };
    let map = nv_flip::flip(rgb(a), rgb(b), nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    f64::from(nv_flip::FlipPool::from_image(&map).mean())
}

/// What is measured of a look, over the compared scenes.
struct Measured {
    /// The look that is nearest, and the mean FLIP between them.
    nearest: (Preset, f64),
    own: Measures,
}

/// The style of a look as its file is now, not as it was compiled in.
fn style(look: Preset) -> Result<ComicStyle, String> {
    let path = Path::new(ROOT).join(format!("assets/styles/{look}.comic.ron"));
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    ComicStyle::from_ron(&text).map_err(|error| format!("{}: {error}", path.display()))
}

/// The scene without a style, and its picture in every style.
fn measure_in(
    scene: BuiltIn,
    looks: &[Preset],
    styles: &[ComicStyle],
) -> (Measures, Vec<(RgbaImage, Measures)>) {
    let mut bench = StyleBench::new(scene, UVec2::new(240, 135), FRAMES);
    let unstyled = bench.measure(None).1;
    let of = |(look, style): (&Preset, &ComicStyle)| {
        let (shot, measures) = bench.measure(Some(style));
        println!("{}: {look}: {measures:.3?}", scene.name());
        (shot, measures)
    };
    (unstyled, looks.iter().zip(styles).map(of).collect())
}

/// Looks, and the scenes without a style.
fn measure(looks: &[Preset]) -> Result<(Vec<Measured>, Measures), String> {
    let styles: Vec<ComicStyle> = looks
        .iter()
        .map(|look| style(*look))
        .collect::<Result<_, _>>()?;
    let scenes = std::thread::scope(|scope| {
        let styles = &styles;
        let start = |scene| scope.spawn(move || measure_in(scene, looks, styles));
        let running = COMPARED.map(start);
        running.map(|scene| scene.join().expect("no panic"))
    });
    let of_look = |k: usize| scenes.iter().map(move |(_, of)| &of[k]);
    let all = 0..looks.len();
    let shots: Vec<Vec<&RgbaImage>> = (all.clone())
        .map(|k| of_look(k).map(|(shot, _)| shot).collect())
        .collect();
    let own: Vec<Vec<Measures>> = all
        .map(|k| of_look(k).map(|(_, measures)| *measures).collect())
        .collect();
    let unstyled: Vec<Measures> = scenes.iter().map(|(unstyled, _)| *unstyled).collect();
    let apart = distances(&shots);
    let of = |(k, own): (usize, &Vec<Measures>)| {
        let distances = apart[k].iter().copied().enumerate();
        let (other, distance) = distances
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .expect("a style");
        Measured {
            nearest: (looks[other], distance),
            own: Measures::mean(own),
        }
    };
    let measured = own.iter().enumerate().map(of).collect();
    let unstyled = Measures::mean(&unstyled);
    println!("unstyled: {unstyled:.3?}");
    Ok((measured, unstyled))
}

/// The mean FLIP of each two looks over the scenes.
fn distances(shots: &[Vec<&RgbaImage>]) -> Vec<Vec<f64>> {
    let mut apart = vec![vec![f64::INFINITY; shots.len()]; shots.len()];
    for a in 0..shots.len() {
        for b in 0..a {
            let pairs = shots[a].iter().zip(&shots[b]);
            let sum: f64 = pairs.map(|(a, b)| flip(a, b)).sum();
            apart[a][b] = sum / COMPARED.len() as f64;
            apart[b][a] = apart[a][b];
        }
    }
    apart
}

/// The limits that looks do not keep.
fn failures(looks: &[Preset], measured: &[Measured], unstyled: &Measures) -> Vec<String> {
    let mut failed = Vec::new();
    for (look, m) in looks.iter().zip(measured) {
        let mut found = m.own.failures(*look, unstyled);
        if m.nearest.1 < LEAST_APART {
            found.push(format!("{:.3} from {}", m.nearest.1, m.nearest.0));
        }
        failed.extend(found.into_iter().map(|text| format!("{look}: {text}")));
    }
    failed
}

/// The first line of a style file: what the look is, and what it was made for.
fn intent(look: Preset) -> &'static str {
    let first = look.source().lines().next().unwrap_or_default();
    first.trim_start_matches("// ")
}

/// What the numbers are, and their limits.
fn method(least: f64, unstyled: &Measures) -> String {
    let percent = |part: f64| 100.0 * part;
    format!(
        "## Numbers\n\n\
         Styles are measured on the village, the figure and the street, at 240x135 pixels. The page is not\n\
         written if a style does not keep a limit. To judge by eye, `cargo run --example pictures -- contact-sheet\n\
         --size 960x540` draws every scene in every style, and with `--zoom 4` the middle of each at four times the size.\n\n\
         | number | is | limit |\n\
         |---|---|---|\n\
         | nearest style | the mean of FLIP to the style that differs least (0: the same picture, 1: black and white) | at least {LEAST_APART}; the least is {least:.3} |\n\
         | ink | the part of the picture that is darker than a quarter of the display's range | |\n\
         | clipped | the part that is black, and the part that is white | {:.0} % together, but for white on the white paper of `manga-page` and `hard-boiled` |\n\
         | contrast | pixels of geometry are divided by distance into three planes of the same size; the mean difference of the mean colors of near and middle, and of middle and far, in CIELAB | at least {LEAST_CONTRAST}, which is just noticeable; unstyled {:.1} |\n\
         | flicker | while the camera goes around the scene by a quarter of a pixel a frame for {FRAMES} frames: by how many codes of 255 a pixel jumps and jumps back in the next frame, on average. Time stands still: lines that are drawn anew by the clock do not count | {MOST_FLICKER} code more than unstyled, {:.2} |\n\
         | fragments | the part of the pixels of outlines that are in pieces of fewer than eight pixels | {:.0} % |\n",
        percent(MOST_CLIPPED),
        unstyled.contrast,
        unstyled.flicker,
        percent(MOST_FRAGMENTS),
    )
}

fn page(measured: &[Measured], unstyled: &Measures) -> String {
    let least = measured.iter().map(|m| m.nearest.1).fold(1.0, f64::min);
    let mut text = format!(
        "# Gallery\n\n\
         {} presets, one picture each. Made by `cargo run --example pictures -- gallery`, which writes this\n\
         page, too. How to use one: [styles and presets](../styles-and-presets.md). How styles are\n\
         measured: [numbers](#numbers).\n{}",
        measured.len(),
        loops::SECTION,
    );
    for (look, m) in presets::STYLES.iter().zip(measured) {
        let title = look.style().name;
        let own = &m.own;
        write!(
            text,
            "\n## {title}\n\n![{title}]({look}.png)\n\n\
             `{look}` ([file](../../assets/styles/{look}.comic.ron)): {}\n\n\
             *The {}. Nearest style: `{}`, {:.3}. Ink {:.0} %, clipped {:.1} % black and {:.1} % white.\n\
             Contrast {:.1}, flicker {:.2}, fragments {:.1} %.*\n",
            intent(*look),
            scene_of(*look).name(),
            m.nearest.0,
            m.nearest.1,
            100.0 * own.ink,
            100.0 * own.black,
            100.0 * own.white,
            own.contrast,
            own.flicker,
            100.0 * own.fragments,
        )
        .expect("memory");
    }
    text + "\n" + &method(least, unstyled)
}

/// `only`: names of looks with commas between them, which are measured and not written; empty: all.
pub fn write(folder: &Path, only: &str) -> Result<(), String> {
    let wanted = |look: &Preset| only.is_empty() || only.split(',').any(|one| one == look.name());
    let looks: Vec<Preset> = presets::STYLES.iter().copied().filter(wanted).collect();
    let (measured, unstyled) = measure(&looks)?;
    for (look, m) in looks.iter().zip(&measured) {
        println!(
            "{look}: {:.3} from {}, {:.3?}",
            m.nearest.1, m.nearest.0, m.own
        );
    }
    let failed = failures(&looks, &measured, &unstyled);
    if !failed.is_empty() {
        return Err(format!("styles beyond the limits:\n{}", failed.join("\n")));
    }
    if !only.is_empty() {
        return Ok(());
    }
    for scene in BuiltIn::ALL {
        let looks: Vec<Preset> = (presets::STYLES.iter().copied())
            .filter(|look| scene_of(*look) == scene)
            .collect();
        if looks.is_empty() {
            continue;
        }
        let mut studio = Studio::new(scene, UVec2::new(560, 315), Msaa::Sample4);
        for look in looks {
            let picture = studio.shoot(Some(&style(look)?));
            save(&picture, &folder.join(format!("{look}.png")))?;
        }
    }
    fs::write(folder.join("README.md"), page(&measured, &unstyled))
        .map_err(|error| format!("cannot write the page: {error}"))
}
