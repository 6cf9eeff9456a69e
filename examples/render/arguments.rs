//! The command line: everything is checked before anything is rendered.

use std::{path::PathBuf, str::FromStr};

use bevy::math::{UVec2, Vec3};
use bevy_comics::{ComicStyle, presets};

use bevy_comics_testkit::{
    headless::Adapter,
    scenes::{BuiltIn, Vantage},
};

const USAGE: &str = "\
usage: render [SCENE] [options]
  SCENE                    mountains (default), teapot, theatre, village, or a .glb/.gltf file
  --style NAME|FILE        a preset, a .comic.ron file, or none (default: the scene's own)
  --material standard|cartoon  how the scene is lit (default: cartoon for theatre)
  --size WxH               pixels (default 960x540)
  --camera EX,EY,EZ,TX,TY,TZ   eye and target, world units
  --near N  --far F        clipping planes, world units
  --ortho HEIGHT           orthographic view of this height, world units
  --msaa 1|2|4|8           samples a pixel (default 4)
  --hdr                    HDR camera
  --frames N               frames to render before the picture (default 8)
  --out FILE.png           the picture (default target/render.png)
  --dump DIR               also write the pass's input, output, depth, normals,
                           object ids and frame.json";

pub enum SceneChoice {
    BuiltIn(BuiltIn),
    Model(PathBuf),
}

pub struct Arguments {
    pub scene: SceneChoice,
    /// `None`: the original picture.
    pub style: Option<ComicStyle>,
    /// Whether the scene is drawn with the cartoon material.
    pub cartoon: bool,
    pub size: UVec2,
    pub camera: Option<(Vec3, Vec3)>,
    pub near: Option<f32>,
    pub far: Option<f32>,
    pub ortho: Option<f32>,
    pub msaa: u32,
    pub hdr: bool,
    pub frames: u32,
    pub out: PathBuf,
    pub dump: Option<PathBuf>,
}

impl Arguments {
    /// `None` when only help was asked for.
    pub fn parse() -> Result<Option<Self>, String> {
        use lexopt::prelude::*;
        let mut arguments = Self {
            scene: SceneChoice::BuiltIn(BuiltIn::Mountains),
            style: None,
            cartoon: false,
            size: UVec2::new(960, 540),
            camera: None,
            near: None,
            far: None,
            ortho: None,
            msaa: 4,
            hdr: false,
            frames: 8,
            out: PathBuf::from("target/render.png"),
            dump: None,
        };
        let (mut style, mut material) = (None, None);
        let mut scenes = 0;
        let mut parser = lexopt::Parser::from_env();
        let wrong = |error: lexopt::Error| format!("{error}; --help lists the options");
        while let Some(argument) = parser.next().map_err(wrong)? {
            let text = |parser: &mut lexopt::Parser| -> Result<String, String> {
                parser.value().and_then(|v| v.string()).map_err(wrong)
            };
            match argument {
                Short('h') | Long("help") => {
                    println!("{USAGE}");
                    return Ok(None);
                }
                Value(value) if scenes == 0 => {
                    scenes += 1;
                    arguments.scene = scene(&value.to_string_lossy())?;
                }
                Long("style") => style = Some(text(&mut parser)?),
                Long("material") => {
                    let value = text(&mut parser)?;
                    material = Some(match value.as_str() {
                        "standard" => false,
                        "cartoon" => true,
                        _ => {
                            return Err(format!(
                                "--material {value}: possible are standard, cartoon"
                            ));
                        }
                    });
                }
                Long("size") => arguments.size = size(&text(&mut parser)?)?,
                Long("camera") => arguments.camera = Some(camera(&text(&mut parser)?)?),
                Long("near") => arguments.near = Some(positive("--near", &text(&mut parser)?)?),
                Long("far") => arguments.far = Some(positive("--far", &text(&mut parser)?)?),
                Long("ortho") => arguments.ortho = Some(positive("--ortho", &text(&mut parser)?)?),
                Long("msaa") => {
                    let value = text(&mut parser)?;
                    arguments.msaa = number("--msaa", &value)?;
                    if ![1, 2, 4, 8].contains(&arguments.msaa) {
                        return Err(format!("--msaa {value}: possible are 1, 2, 4, 8"));
                    }
                }
                Long("hdr") => arguments.hdr = true,
                Long("frames") => {
                    let value = text(&mut parser)?;
                    arguments.frames = number("--frames", &value)?;
                    if !(1..=100_000).contains(&arguments.frames) {
                        return Err(format!("--frames {value}: possible are 1 to 100000"));
                    }
                }
                Long("out") => arguments.out = png(&text(&mut parser)?)?,
                Long("dump") => arguments.dump = Some(PathBuf::from(text(&mut parser)?)),
                other => return Err(wrong(other.unexpected())),
            }
        }
        if let (Some(near), Some(far)) = (arguments.near, arguments.far)
            && near >= far
        {
            return Err(format!(
                "--near {near} --far {far}: near must be smaller than far"
            ));
        }
        let flat = matches!(arguments.scene, SceneChoice::BuiltIn(BuiltIn::Theatre));
        arguments.cartoon = material.unwrap_or(flat);
        arguments.style = match style.as_deref() {
            Some("none") => None,
            Some(name) => Some(read_style(name)?),
            None => Some(read_style(own_style(&arguments.scene))?),
        };
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
    pub fn adjust(&self, vantage: &mut Vantage) {
        if self.ortho.is_some() {
            *vantage = vantage.orthographic_vantage();
        }
        if let Some((eye, target)) = self.camera {
            vantage.eye = eye;
            vantage.target = target;
        }
        vantage.near = self.near.unwrap_or(vantage.near);
        vantage.far = self.far.unwrap_or(vantage.far).max(vantage.near * 1.001);
    }
}

/// The preset that suits a scene.
fn own_style(scene: &SceneChoice) -> &'static str {
    match scene {
        SceneChoice::BuiltIn(BuiltIn::Mountains) => "crimson-dusk",
        SceneChoice::BuiltIn(BuiltIn::Teapot) => "museum-print",
        SceneChoice::BuiltIn(BuiltIn::Theatre) => "saturday-morning",
        _ => "ligne-claire",
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
    if let Some(preset) = presets::find(name) {
        return Ok(preset.style());
    }
    let names: Vec<&str> = presets::ALL.iter().map(|preset| preset.name()).collect();
    Err(format!(
        "no style {name:?}; possible are none, {}, or a .comic.ron file",
        names.join(", ")
    ))
}

fn number<T: FromStr>(option: &str, text: &str) -> Result<T, String> {
    text.parse()
        .map_err(|_| format!("{option} {text}: not a number that this option takes"))
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
