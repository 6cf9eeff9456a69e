//! Times the passes of each crate, in one app and one run, in turn.

use bevy::{
    asset::RenderAssetUsages,
    anti_alias::{contrast_adaptive_sharpening::ContrastAdaptiveSharpening, fxaa::Fxaa},
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    ecs::system::RunSystemOnce,
    post_process::effect_stack::Vignette,
    prelude::*,
    render::view::Msaa,
};
use bevy_comics::{ToonLight, ToonScene, ComicStyle, ComicsPlugin, Contours, Outlines, effects::Equations, toon::Ramp, lines::Silhouettes};
use bevy_edge_detection_outline::{EdgeDetection, EdgeDetectionPlugin, EdgeOperator};
use bevy_mod_outline::{OutlineMode, OutlinePlugin, OutlineVolume};
use bevy_shader_mtoon::{MtoonMaterial, MtoonPlugin, MtoonSun, VrmOutlineMode};
use cloudiful_bevy_outline::{GpmoOutlinePlugin, OutlineAssets, spawn_default_outline_mesh};

use bevy_comics_testkit::{
    bench::{self, BenchPlugin, Blit, Laps},
    headless::Headless,
    scenes::{BuiltIn, ScenePart, Stage},
    work::{along_cracks, default_comic},
};

const SIZE: UVec2 = UVec2::new(960, 540);

/// Marks the meshes that a variant adds.
#[derive(Component)]
struct Shell;

struct Bench {
    headless: Headless,
    camera: Entity,
    /// The parts of the scene with their meshes and original materials.
    plain: Vec<(Entity, Handle<Mesh>, Handle<StandardMaterial>)>,
    toon: Handle<MtoonMaterial>,
}

type Put = fn(&mut Bench);

impl Bench {
    fn new() -> Self {
        let mut headless = Headless::new(
            bench::options(SIZE),
            (
                ComicsPlugin,
                EdgeDetectionPlugin,
                OutlinePlugin::EXTRUDE_VERTEX,
                MtoonPlugin,
                GpmoOutlinePlugin::default(),
                BenchPlugin,
            ),
        );
        let target = headless.render_target();
        let world = headless.app.world_mut();
        let vantage = world
            .run_system_once(|mut stage: Stage| stage.spawn(BuiltIn::Teapot))
            .expect("the stage is there");
        crate::give_uvs(world);
        // Crates that draw shells read the meshes in the main world.
        for (_, mesh) in world.resource_mut::<Assets<Mesh>>().iter_mut() {
            mesh.asset_usage = RenderAssetUsages::default();
        }
        let camera = world.spawn(vantage.camera()).id();
        world.entity_mut(camera).insert((
            target,
            Msaa::Off,
            Tonemapping::None,
            DebandDither::Disabled,
            // All variants have them, so that their time is in no difference.
            DepthPrepass,
            NormalPrepass,
        ));
        let mut parts =
            world.query_filtered::<(Entity, &Mesh3d, &MeshMaterial3d<StandardMaterial>), With<ScenePart>>();
        let plain: Vec<_> = parts
            .iter(world)
            .map(|(entity, mesh, material)| (entity, mesh.0.clone(), material.0.clone()))
            .collect();
        let mut suns = world.query_filtered::<Entity, With<DirectionalLight>>();
        let sun = suns.iter(world).next();
        if let Some(sun) = sun {
            world.entity_mut(sun).insert(MtoonSun);
        }
        let toon = world.resource_mut::<Assets<MtoonMaterial>>().add(MtoonMaterial {
            outline_mode: VrmOutlineMode::default(),
            ..default()
        });
        headless.step(3);
        Self {
            headless,
            camera,
            plain,
            toon,
        }
    }

    fn camera(&mut self) -> EntityWorldMut<'_> {
        self.headless.app.world_mut().entity_mut(self.camera)
    }

    /// Removes what a variant has added.
    fn clear(&mut self) {
        let world = self.headless.app.world_mut();
        ComicStyle::default().apply(&mut world.commands().entity(self.camera));
        world.flush();
        world
            .entity_mut(self.camera)
            .remove::<(Blit, EdgeDetection, Fxaa, ContrastAdaptiveSharpening, Vignette)>();
        for (part, _, material) in &self.plain {
            world
                .entity_mut(*part)
                .remove::<(OutlineVolume, OutlineMode, MeshMaterial3d<MtoonMaterial>, ToonScene)>()
                .insert(MeshMaterial3d(material.clone()));
        }
        let mut shells = world.query_filtered::<Entity, With<Shell>>();
        for shell in shells.iter(world).collect::<Vec<_>>() {
            world.despawn(shell);
        }
    }

    fn style(&mut self, style: &ComicStyle) {
        let world = self.headless.app.world_mut();
        style.apply(&mut world.commands().entity(self.camera));
        world.flush();
    }

    fn edges(&mut self, operator: EdgeOperator) {
        self.camera().insert(EdgeDetection { operator, ..default() });
    }

    fn light(&mut self, light: &ToonLight) {
        let world = self.headless.app.world_mut();
        for (part, _, _) in &self.plain {
            world.entity_mut(*part).insert(ToonScene::new(light.clone()));
        }
    }

    fn volumes(&mut self, mode: &OutlineMode) {
        let world = self.headless.app.world_mut();
        for (part, _, _) in &self.plain {
            world.entity_mut(*part).insert((
                OutlineVolume {
                    visible: true,
                    colour: Color::BLACK,
                    width: 2.0,
                },
                mode.clone(),
            ));
        }
    }
}

fn outlines(outlines: Outlines) -> ComicStyle {
    ComicStyle::new().with(outlines)
}

const VARIANTS: &[(&str, Put)] = &[
    ("nothing", |_| {}),
    ("blit", |b| {
        b.camera().insert(Blit);
    }),
    ("bevy_comics: default comic", |b| b.style(&default_comic())),
    ("bevy_comics: contours", |b| {
        b.style(&ComicStyle::new().with(Contours::default()));
    }),
    ("bevy_comics: silhouettes", |b| b.style(&outlines(Outlines::SILHOUETTES))),
    ("bevy_comics: silhouettes + creases", |b| {
        b.style(&outlines(Outlines {
            objects: None,
            ..default()
        }));
    }),
    ("bevy_comics: silhouettes + creases; along cracks", |b| {
        b.style(&outlines(Outlines {
            objects: None,
            ..along_cracks()
        }));
    }),
    ("bevy_comics: faithful silhouettes", |b| {
        b.style(&outlines(Outlines {
            silhouettes: Some(Silhouettes {
                equations: Equations::Faithful,
                ..default()
            }),
            ..Outlines::SILHOUETTES
        }));
    }),
    ("bevy_edge_detection_outline 0.4.1: Sobel; depth + normals", |b| {
        b.edges(EdgeOperator::Sobel);
    }),
    ("bevy_edge_detection_outline 0.4.1: Roberts; depth + normals", |b| {
        b.edges(EdgeOperator::RobertsCross);
    }),
    ("bevy_mod_outline 0.13.0: extruded", |b| b.volumes(&OutlineMode::ExtrudeFlat)),
    ("bevy_mod_outline 0.13.0: jump flood", |b| b.volumes(&OutlineMode::FloodFlat)),
    ("bevy_shader_mtoon 0.4.0: material", |b| {
        let toon = b.toon.clone();
        let world = b.headless.app.world_mut();
        for (part, _, _) in &b.plain {
            world
                .entity_mut(*part)
                .remove::<MeshMaterial3d<StandardMaterial>>()
                .insert(MeshMaterial3d(toon.clone()));
        }
    }),
    ("bevy_comics: toon material", |b| b.light(&ToonLight::default())),
    ("bevy_comics: toon material; default ramp", |b| {
        b.light(&ToonLight {
            ramp: Some(Ramp::default()),
            ..default()
        });
    }),
    ("cloudiful-bevy-outline 0.3.0: shells", |b| {
        let plain = b.plain.clone();
        let world = b.headless.app.world_mut();
        world.resource_scope(|world, assets: Mut<OutlineAssets>| {
            for (part, mesh, _) in plain {
                world.commands().entity(part).with_children(|parent| {
                    spawn_default_outline_mesh(parent, &assets, mesh, Visibility::Visible)
                        .insert(Shell);
                });
            }
            world.flush();
        });
    }),
    ("Bevy: FXAA", |b| {
        b.camera().insert(Fxaa::default());
    }),
    ("Bevy: contrast adaptive sharpening", |b| {
        b.camera().insert(ContrastAdaptiveSharpening::default());
    }),
    ("Bevy: vignette", |b| {
        b.camera().insert(Vignette::default());
    }),
    ("blit again", |b| {
        b.camera().insert(Blit);
    }),
];

/// Measures the report's table of times, as CSV. `frames`: timed frames per round.
pub fn measure(rounds: usize, frames: usize) -> String {
    let mut bench = Bench::new();
    let mut rows = vec![
        "section,scene,variant,width,height,round,prepass,range,lines,main,post".to_owned(),
    ];
    // Round 0 creates pipelines and textures, and is not counted.
    for round in 0..=rounds {
        for (name, put) in VARIANTS {
            bench.clear();
            put(&mut bench);
            bench.headless.step(4);
            let laps = bench::laps(&mut bench.headless, frames);
            let mut middle: Laps = [0.0; bench::LAPS];
            for (lap, value) in middle.iter_mut().enumerate() {
                let mut times: Vec<f64> = laps.iter().map(|l| l[lap]).collect();
                times.sort_by(f64::total_cmp);
                *value = times[times.len() / 2];
            }
            if round == 0 {
                let folder = std::path::Path::new("target/peers");
                let _ = std::fs::create_dir_all(folder);
                let file = name.replace([':', ';', ' '], "-");
                let _ = bench.headless.picture().save(folder.join(format!("time-{file}.png")));
                continue;
            }
            let ms: Vec<String> = middle.iter().map(|ms| format!("{ms:.4}")).collect();
            let [w, h] = SIZE.to_array();
            let round = round - 1;
            rows.push(format!("peers,teapot,{name},{w},{h},{round},{}", ms.join(",")));
        }
        println!("round {round} of {rounds}");
    }
    rows.join("\n") + "\n"
}
