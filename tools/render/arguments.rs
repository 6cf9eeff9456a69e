//! The command line: everything is checked before anything is rendered.

use std::{collections::HashMap, path::PathBuf, str::FromStr};

use bevy::math::{UVec2, Vec3};
use bevy_comics::{ComicStyle, presets, style::Preset};

use bevy_comics_testkit::{
    headless::Adapter,
    scenes::{BuiltIn, Vantage},
};

use crate::{model::Model, output::Frames};

const USAGE: &str = "\
usage: render [SCENE] [options]
  SCENE                    mountains (default), teapot, theatre, village, figure, or a .glb/.gltf file
Look
  --style NAME|FILE        a preset, a .comic.ron file, or none (default: the scene's own)
  --material standard|toon  how the scene is shaded (default: toon for theatre and figure)
  --sections ANGLE         creases where meshes bend by this angle, 10 to 120 degrees
View (default: a model fills 85 % of the frame)
  --size WxH               pixels (default 960x540; with --presets 480x270 a picture)
  --camera EX,EY,EZ,TX,TY,TZ   eye and target, world units
  --near N  --far F        clipping planes, world units
  --ortho HEIGHT|fit       orthographic view of this height in world units, or that fits
Quality
  --msaa 1|2|4|8           samples a pixel (default 4)
  --hdr                    HDR camera
  --frames N               frames to render before the first picture (default 8)
Output
  --out FILE.png           the picture (default target/render.png)
  --turntable N            N pictures (2 to 720) around the scene: FILE.png is an animated PNG,
                           NAME%03d.png are numbered files, DIR is a folder of numbered files
  --presets[=NAME,NAME]    one sheet with the scene in every preset, or in these
  --dump DIR               also write the pass's input, output, depth, normals,
                           object ids and frame.json";

/// Options that take a value.
const VALUED: [&str; 13] = [
    "style",
    "material",
    "sections",
    "size",
    "camera",
    "near",
    "far",
    "ortho",
    "msaa",
    "frames",
    "out",
    "turntable",
    "dump",
];

pub enum SceneChoice {
    BuiltIn(BuiltIn),
    Model(PathBuf),
}

/// Height of an orthographic view.
#[derive(Clone, Copy)]
pub enum Ortho {
    /// World units.
    Height(f32),
    /// As suits the scene.
    Fit,
}

pub enum Output {
    Picture(PathBuf),
    /// Presets on one sheet.
    Sheet(PathBuf, Vec<Preset>),
    /// Pictures around the scene.
    Turntable(u32, Frames),
}

pub struct Arguments {
    pub scene: SceneChoice,
    /// `None`: the original picture.
    pub style: Option<ComicStyle>,
    /// Whether the scene is drawn with the toon material.
    pub toon: bool,
    /// The angle of `MeshSections`.
    pub sections: Option<f32>,
    pub size: UVec2,
    pub camera: Option<(Vec3, Vec3)>,
    pub near: Option<f32>,
    pub far: Option<f32>,
    pub ortho: Option<Ortho>,
    pub msaa: u32,
    pub hdr: bool,
    pub frames: u32,
    pub output: Output,
    pub dump: Option<PathBuf>,
}

/// The command line as text.
#[derive(Default)]
struct Given {
    scene: Option<String>,
    values: HashMap<&'static str, String>,
    hdr: bool,
    presets: Option<Vec<Preset>>,
}

impl Given {
    /// `None` when help was asked for.
    fn read(mut parser: lexopt::Parser) -> Result<Option<Self>, String> {
        use lexopt::prelude::*;
        let wrong = |error: lexopt::Error| format!("{error}; --help lists the options");
        let mut given = Self::default();
        while let Some(argument) = parser.next().map_err(wrong)? {
            match argument {
                Short('h') | Long("help") => return Ok(None),
                Long("hdr") => given.hdr = true,
                Long("presets") => {
                    let names = parser.optional_value().map(|names| names.string());
                    given.presets = Some(match names.transpose().map_err(wrong)? {
                        Some(names) => names.split(',').map(preset).collect::<Result<_, _>>()?,
                        None => presets::ALL.to_vec(),
                    });
                }
                Long(name) => {
                    let Some(name) = VALUED.iter().find(|known| **known == name) else {
                        return Err(wrong(argument.unexpected()));
                    };
                    let value = parser.value().and_then(|v| v.string()).map_err(wrong)?;
                    given.values.insert(name, value);
                }
                Value(value) if given.scene.is_none() => {
                    given.scene = Some(value.to_string_lossy().into_owned());
                }
                other => return Err(wrong(other.unexpected())),
            }
        }
        Ok(Some(given))
    }

    /// The value of an option, read by `parse`.
    fn get<T>(
        &self,
        name: &str,
        parse: impl Fn(&str) -> Result<T, String>,
    ) -> Result<Option<T>, String> {
        let value = self.values.get(name);
        value.map(|text| parse(text)).transpose()
    }
}

impl Arguments {
    /// `None` when only help was asked for.
    pub fn parse() -> Result<Option<Self>, String> {
        let read = Self::read(lexopt::Parser::from_env())?;
        if read.is_none() {
            println!("{USAGE}");
        }
        Ok(read)
    }

    /// `None` when help was asked for.
    fn read(parser: lexopt::Parser) -> Result<Option<Self>, String> {
        let Some(given) = Given::read(parser)? else {
            return Ok(None);
        };
        let scene = match &given.scene {
            Some(text) => scene(text)?,
            None => SceneChoice::BuiltIn(BuiltIn::Mountains),
        };
        let is_toon = matches!(scene, SceneChoice::BuiltIn(scene) if scene.is_toon());
        let style = match given.values.get("style").map(String::as_str) {
            Some("none") => None,
            Some(name) => Some(read_style(name)?),
            None => Some(read_style(own_style(&scene))?),
        };
        let usual_size = if given.presets.is_some() {
            UVec2::new(480, 270)
        } else {
            UVec2::new(960, 540)
        };
        let arguments = Self {
            style,
            toon: given.get("material", material)?.unwrap_or(is_toon),
            sections: given.get("sections", |text| positive("--sections", text))?,
            size: given.get("size", size)?.unwrap_or(usual_size),
            camera: given.get("camera", camera)?,
            near: given.get("near", |text| positive("--near", text))?,
            far: given.get("far", |text| positive("--far", text))?,
            ortho: given.get("ortho", ortho)?,
            msaa: given.get("msaa", msaa)?.unwrap_or(4),
            hdr: given.hdr,
            frames: given
                .get("frames", |text| count("--frames", text, 1, 100_000))?
                .unwrap_or(8),
            output: output(&given)?,
            dump: given.get("dump", |text| Ok(PathBuf::from(text)))?,
            scene,
        };
        if let (Some(near), Some(far)) = (arguments.near, arguments.far)
            && near >= far
        {
            return Err(format!(
                "--near {near} --far {far}: near must be smaller than far"
            ));
        }
        Ok(Some(arguments))
    }

    /// What the adapter cannot do is said before the engine starts.
    pub fn check_against(&self, adapter: &Adapter) -> Result<(), String> {
        let most = adapter.max_size;
        if self.size.max_element() > most {
            return Err(format!(
                "--size {}x{}: this adapter draws 1x1 to {most}x{most}",
                self.size.x, self.size.y
            ));
        }
        if !adapter.samples.contains(&self.msaa) {
            return Err(format!(
                "--msaa {}: this adapter offers {:?}",
                self.msaa, adapter.samples
            ));
        }
        Ok(())
    }

    /// The scene's view, with what the command line changes.
    pub fn adjust(&self, vantage: &mut Vantage, model: Option<&Model>) {
        if self.ortho.is_some() {
            *vantage = vantage.orthographic_vantage();
        }
        if let Some((eye, target)) = self.camera {
            vantage.eye = eye;
            vantage.target = target;
        }
        if let Some(model) = model {
            model.set_planes(vantage);
        }
        vantage.near = self.near.unwrap_or(vantage.near);
        vantage.far = self.far.unwrap_or(vantage.far).max(vantage.near * 1.001);
    }
}

/// The preset that suits a scene.
fn own_style(scene: &SceneChoice) -> &'static str {
    match scene {
        SceneChoice::BuiltIn(BuiltIn::Mountains) => "twilight-toon",
        SceneChoice::BuiltIn(BuiltIn::Teapot | BuiltIn::Theatre | BuiltIn::Figure) => {
            "saturday-morning"
        }
        SceneChoice::BuiltIn(BuiltIn::Village | BuiltIn::Street) => "graphic-novel",
        SceneChoice::BuiltIn(BuiltIn::Hall) => "storybook",
        SceneChoice::Model(_) => "saturday-morning",
    }
}

fn scene(text: &str) -> Result<SceneChoice, String> {
    if let Some(scene) = BuiltIn::from_name(text) {
        return Ok(SceneChoice::BuiltIn(scene));
    }
    let path = PathBuf::from(text);
    let is_model = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("glb") || e.eq_ignore_ascii_case("gltf"));
    if !is_model {
        let names = BuiltIn::ALL.map(BuiltIn::name).join(", ");
        return Err(format!(
            "no scene {text:?}; possible are {names}, or a .glb or .gltf file"
        ));
    }
    std::fs::File::open(&path).map_err(|error| format!("cannot read {text}: {error}"))?;
    Ok(SceneChoice::Model(path))
}

fn read_style(name: &str) -> Result<ComicStyle, String> {
    if name.ends_with(".comic.ron") {
        let text = std::fs::read_to_string(name)
            .map_err(|error| format!("cannot read {name}: {error}"))?;
        return ComicStyle::from_ron(&text).map_err(|error| format!("{name}: {error}"));
    }
    let preset = preset(name).map_err(|error| error + ", none, or a .comic.ron file")?;
    Ok(preset.style())
}

fn preset(name: &str) -> Result<Preset, String> {
    presets::find(name).ok_or_else(|| {
        let names: Vec<&str> = presets::ALL.iter().map(|preset| preset.name()).collect();
        format!("no style {name:?}; possible are {}", names.join(", "))
    })
}

/// Where the pictures go, and how many there are.
fn output(given: &Given) -> Result<Output, String> {
    let out = given.values.get("out").map(String::as_str);
    let out = out.unwrap_or("target/render.png");
    let turntable = given.get("turntable", |text| count("--turntable", text, 2, 720))?;
    if let Some(presets) = &given.presets {
        for (option, set) in [
            ("--turntable", turntable.is_some()),
            ("--style", given.values.contains_key("style")),
            ("--dump", given.values.contains_key("dump")),
        ] {
            if set {
                return Err(format!("--presets and {option} exclude each other"));
            }
        }
        return Ok(Output::Sheet(png(out)?, presets.clone()));
    }
    Ok(match turntable {
        Some(count) => Output::Turntable(count, Frames::parse(out)),
        None => Output::Picture(png(out)?),
    })
}

fn number<T: FromStr>(option: &str, text: &str) -> Result<T, String> {
    text.parse()
        .map_err(|_| format!("{option} {text}: not a number that this option takes"))
}

fn count(option: &str, text: &str, least: u32, most: u32) -> Result<u32, String> {
    let value = number(option, text)?;
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(format!("{option} {text}: possible are {least} to {most}"))
    }
}

fn positive(option: &str, text: &str) -> Result<f32, String> {
    let value: f32 = number(option, text)?;
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(format!(
            "{option} {text}: must be a positive, finite number"
        ))
    }
}

fn material(text: &str) -> Result<bool, String> {
    match text {
        "standard" => Ok(false),
        "toon" => Ok(true),
        _ => Err(format!("--material {text}: possible are standard, toon")),
    }
}

fn ortho(text: &str) -> Result<Ortho, String> {
    match text {
        "fit" => Ok(Ortho::Fit),
        _ => positive("--ortho", text).map(Ortho::Height),
    }
}

fn msaa(text: &str) -> Result<u32, String> {
    let samples = number("--msaa", text)?;
    if [1, 2, 4, 8].contains(&samples) {
        Ok(samples)
    } else {
        Err(format!("--msaa {text}: possible are 1, 2, 4, 8"))
    }
}

fn size(text: &str) -> Result<UVec2, String> {
    let wrong = || format!("--size {text}: must be WxH with whole numbers from 1, as 960x540");
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let size = UVec2::new(
        width.parse().map_err(|_| wrong())?,
        height.parse().map_err(|_| wrong())?,
    );
    if size.min_element() == 0 {
        Err(wrong())
    } else {
        Ok(size)
    }
}

fn camera(text: &str) -> Result<(Vec3, Vec3), String> {
    let wrong = || {
        format!(
            "--camera {text}: must be six finite numbers EX,EY,EZ,TX,TY,TZ, eye and target apart"
        )
    };
    let parts: Vec<f32> = text
        .split(',')
        .map(|p| p.trim().parse().map_err(|_| wrong()))
        .collect::<Result<_, _>>()?;
    let [ex, ey, ez, tx, ty, tz] = parts[..] else {
        return Err(wrong());
    };
    let (eye, target) = (Vec3::new(ex, ey, ez), Vec3::new(tx, ty, tz));
    if eye.is_finite() && target.is_finite() && eye.distance(target) > 1e-6 {
        Ok((eye, target))
    } else {
        Err(wrong())
    }
}

fn png(text: &str) -> Result<PathBuf, String> {
    if text.to_lowercase().ends_with(".png") {
        Ok(PathBuf::from(text))
    } else {
        Err(format!("--out {text}: must end in .png"))
    }
}

#[cfg(test)]
mod tests {
    use bevy_comics_testkit::fuzz::{Counting, check_command_lines};

    use super::*;

    #[global_allocator]
    static ALLOCATOR: Counting = Counting;

    /// Command lines that can be drawn, with an argument on each line.
    const RIGHT: [&str; 8] = [
        "teapot\n--style\nnoir\n--size\n320x180\n--out\na.png",
        "village\n--camera\n1,2,3,0,0,0\n--near\n0.1\n--far\n100\n--msaa\n4\n--hdr",
        "--ortho\n12.5\n--frames\n3\n--dump\nfolder",
        "figure\n--ortho=fit\n--material=standard\n--sections=30\n--turntable=24\n--out=a%03d.png",
        "--presets\n--size=480x270\n--out=sheet.png",
        "teapot\n--presets=noir,sepia\n--out\nsheet.png",
        "street\n--style=none\n--turntable\n2\n--out\nfolder",
        "theatre\n--style=missing.comic.ron\n--material\ncartoon",
    ];

    /// Every command line is read, or refused with a message.
    #[test]
    fn parsing_a_command_line_never_panics() {
        // The first style that is read makes the tables of effects.
        let _ = presets::NOIR.style();
        check_command_lines(
            3,
            &RIGHT,
            |given| Arguments::read(lexopt::Parser::from_args(given)),
            |arguments| assert!(arguments.size.min_element() > 0 && arguments.frames > 0),
        );
    }
}
