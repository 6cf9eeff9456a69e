//! Times variants of one scene and camera in turn: A B C A B C.

use bevy::{
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    ecs::system::RunSystemOnce,
    prelude::*,
    render::{RenderApp, sync_world::RenderEntity},
};
use bevy_comics::{ComicStyle, ComicsPlugin};

use bevy_comics_testkit::{
    bench::{self, BenchPlugin, Blit, Lap, Laps},
    headless::Headless,
    scenes::{BuiltIn, Stage, Vantage},
    truth::Truth,
};

use crate::{Run, parts::set_marks, table::Table};

pub struct Rig {
    pub headless: Headless,
    pub camera: Entity,
    /// Further cameras with the same style.
    pub others: Vec<Entity>,
    pub vantage: Option<Vantage>,
    pub size: UVec2,
}

/// What a camera draws while it is timed.
#[derive(Clone, Debug)]
pub enum Drawn {
    Nothing,
    Blit,
    Style(Box<ComicStyle>),
    /// No style; all meshes are selected.
    Selected,
    /// No style; all meshes are seen through walls.
    SeenThrough,
}

impl Drawn {
    pub fn style(style: ComicStyle) -> Self {
        Self::Style(Box::new(style))
    }
}

/// A material that shows its color alone.
pub fn unlit(color: impl Into<Color>) -> StandardMaterial {
    StandardMaterial {
        base_color: color.into(),
        unlit: true,
        ..default()
    }
}

/// Styles with names, as [`record`] takes them.
pub fn styles<N: Into<String>>(
    named: impl IntoIterator<Item = (N, ComicStyle)>,
) -> Vec<(String, Drawn)> {
    let named = named.into_iter();
    named
        .map(|(name, style)| (name.into(), Drawn::style(style)))
        .collect()
}

impl Rig {
    /// A built-in scene, or an empty world.
    pub fn new(scene: Option<BuiltIn>, size: UVec2) -> Self {
        let mut headless = Headless::new(bench::options(size), (ComicsPlugin, BenchPlugin));
        let target = headless.render_target();
        let world = headless.app.world_mut();
        let vantage = scene.map(|scene| {
            world
                .run_system_once(move |mut stage: Stage| stage.spawn(scene))
                .expect("the stage is there")
        });
        let camera = match &vantage {
            Some(vantage) => world.spawn(vantage.camera()).id(),
            None => world.spawn(Camera3d::default()).id(),
        };
        // Between the main pass and the end of the frame, only the timed passes run.
        world.entity_mut(camera).insert((
            target,
            Msaa::Off,
            Tonemapping::None,
            DebandDither::Disabled,
        ));
        headless.step(3);
        Self {
            headless,
            camera,
            others: Vec::new(),
            vantage,
            size,
        }
    }

    /// The camera in the render world.
    pub fn view(&self) -> Entity {
        let world = self.headless.app.world();
        world
            .get::<RenderEntity>(self.camera)
            .expect("extracted")
            .id()
    }

    /// The lines of a picture of `size`, if this camera is `fine` times as large and draws
    /// [`ids_alone`](bevy_comics_testkit::truth::ids_alone).
    pub fn truth(&self, size: UVec2, fine: u32) -> Truth {
        let world = self.headless.app.sub_app(RenderApp).world();
        Truth::read(world, self.view(), size, fine)
    }

    /// Spawns a mesh of one material.
    pub fn put(
        &mut self,
        mesh: impl Into<Mesh>,
        material: StandardMaterial,
        at: Transform,
    ) -> Entity {
        let world = self.headless.app.world_mut();
        let mesh = Mesh3d(world.add_asset(mesh));
        let material = MeshMaterial3d(world.add_asset::<StandardMaterial>(material));
        world.spawn((mesh, material, at)).id()
    }

    /// All meshes of the scene.
    pub fn meshes(&mut self) -> Vec<Entity> {
        let world = self.headless.app.world_mut();
        let mut meshes = world.query_filtered::<Entity, With<Mesh3d>>();
        meshes.iter(world).collect()
    }

    /// Makes every material unlit: only lines change the picture, and the main pass takes
    /// little time.
    pub fn unlight(&mut self) {
        let world = self.headless.app.world_mut();
        let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
        for (_, material) in materials.iter_mut() {
            material.unlit = true;
        }
    }

    pub fn set_drawn(&mut self, drawn: &Drawn) {
        set_marks(self, drawn);
        let world = self.headless.app.world_mut();
        let none = ComicStyle::default();
        let style = match drawn {
            Drawn::Style(style) => style,
            _ => &none,
        };
        for camera in std::iter::once(&self.camera).chain(&self.others) {
            style.apply(&mut world.commands().entity(*camera));
            world.flush();
            match drawn {
                Drawn::Blit => world.entity_mut(*camera).insert(Blit),
                _ => world.entity_mut(*camera).remove::<Blit>(),
            };
        }
    }

    /// The laps of every variant, round by round. The laps of a round are the medians of its
    /// frames.
    pub fn compare(&mut self, run: &Run, variants: &[(String, Drawn)]) -> Vec<Vec<Laps>> {
        let mut all = vec![Vec::new(); variants.len()];
        // Round 0 creates pipelines and textures, and is not counted.
        for round in 0..=run.rounds {
            for (i, (_, drawn)) in variants.iter().enumerate() {
                self.set_drawn(drawn);
                // A new prepass takes one frame, new pipelines and textures another.
                self.headless.step(2);
                let frames = bench::laps(&mut self.headless, run.frames);
                let mut middle = [0.0; bench::LAPS];
                for (lap, value) in middle.iter_mut().enumerate() {
                    *value = middle_of(frames.iter().map(|frame| frame[lap]));
                }
                if round > 0 {
                    all[i].push(middle);
                }
            }
        }
        all
    }
}

/// The upper median.
pub fn middle_of(times: impl Iterator<Item = f64>) -> f64 {
    let mut times: Vec<f64> = times.collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Header of every table of times.
pub fn times() -> Table {
    Table::new("section,scene,variant,width,height,round,prepass,range,lines,main,post")
}

/// Times the variants together with nothing, a blit, and a second blit that shows the
/// noise, and adds the rows to the table.
pub fn record(
    run: &Run,
    table: &mut Table,
    section: &str,
    scene: &str,
    rig: &mut Rig,
    variants: &[(String, Drawn)],
) {
    let mut all = vec![
        ("nothing".to_owned(), Drawn::Nothing),
        ("blit".to_owned(), Drawn::Blit),
    ];
    all.extend(variants.iter().cloned());
    all.push(("blit again".to_owned(), Drawn::Blit));
    let laps = rig.compare(run, &all);
    for ((name, _), rounds) in all.iter().zip(&laps) {
        for (round, laps) in rounds.iter().enumerate() {
            let ms: Vec<String> = laps.iter().map(|ms| format!("{ms:.4}")).collect();
            table.push(&[
                &section,
                &scene,
                name,
                &rig.size.x,
                &rig.size.y,
                &round,
                &ms[0],
                &ms[1],
                &ms[2],
                &ms[3],
                &ms[4],
            ]);
        }
    }
    let [nothing, blit] =
        [0, 1].map(|i| middle_of(laps[i].iter().map(|laps| laps[Lap::Post as usize])));
    let blit = blit - nothing;
    run.say(&format!(
        "{section}, {scene}: blit {blit:.2} ms over nothing"
    ));
}
