//! How whole and how steady lines are: dashes on models that turn, and pixels that change in
//! a still view under temporal anti-aliasing.

use std::time::Instant;

use bevy::{
    anti_alias::taa::TemporalAntiAliasing,
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    light::Skybox,
    prelude::*,
    render::RenderApp,
};
use bevy_comics::{ComicStyle, Outlines};
use bevy_comics_testkit::{
    read_back,
    scenes::BuiltIn,
    specimens::Specimen,
    truth::{FINE, Truth, at_places, ends_of_lines, ids_alone},
};

use crate::{
    Run,
    models::Studio,
    rig::{Drawn, Rig, middle_of},
    table::Table,
};

/// How far an end of a line may be from that of a true line, in pixels of the finer picture: two of
/// the picture.
const NEAR_END: i64 = 2 * FINE as i64;
/// By how much true ends are moved to see how many ends are near one by chance, in pixels of the
/// finer picture.
const ELSEWHERE: [i64; 2] = [44, -36];

/// Ends of lines on models that turn, with and without continuing along weak edges; and how many
/// of them are where true lines end.
pub fn dashes(run: &Run) -> Result<(), String> {
    let (frames, size) = (run.pick(2, 90), run.size([120, 68], [240, 136]));
    let mut table = Table::new("model,method,ends,true,true_ends,by_chance");
    let mut fine = Studio::new(size * FINE, ids_alone());
    let whole = Outlines {
        ink_budget: 1.0,
        ..default()
    };
    let cut = Outlines {
        hysteresis: 0.0,
        min_length: 1,
        ..whole
    };
    let methods = [("cut", cut), ("continued", whole)];
    let mut lined = methods.map(|(_, outlines)| Studio::new(size, outlines));
    for (model, parts) in &run.some(1, turning()) {
        for studio in lined.iter_mut().chain([&mut fine]) {
            studio.show_meshes(parts.clone());
            studio.rig.headless.step(4);
        }
        let mut counts = [Ends::default(); 2];
        let mut length = 0;
        for frame in 0..frames {
            let turned = frame as f32 / frames as f32;
            fine.turn(2.6, turned);
            let truth = fine.rig.truth(size, FINE);
            length += truth.any(&[0, 1, 2]).iter().filter(|line| **line).count();
            let true_ends = fine_ends(&fine.rig);
            for (studio, counts) in lined.iter_mut().zip(&mut counts) {
                studio.turn(2.6, turned);
                let world = studio.rig.headless.app.sub_app(RenderApp).world();
                let cracks = read_back::cracks(world, studio.rig.view());
                let ends = cracks.as_ref().map(ends_of_lines).unwrap_or_default();
                counts.add(&ends, &true_ends);
            }
        }
        for ((method, _), counts) in methods.iter().zip(counts) {
            let Ends {
                all,
                true_ends,
                by_chance,
            } = counts;
            table.push(&[model, method, &all, &length, &true_ends, &by_chance]);
        }
        run.say(&format!("{model}: ends counted"));
    }
    run.save("ink_dashes", &table)
}

/// Where the lines of the truth end, in pixels of the finer picture.
fn fine_ends(rig: &Rig) -> Vec<[i64; 2]> {
    let world = rig.headless.app.sub_app(RenderApp).world();
    ends_of_lines(&Truth::fine_cracks(world, rig.view(), rig.size))
}

/// Numbers of ends of lines.
#[derive(Clone, Copy, Default)]
struct Ends {
    all: usize,
    /// Near the end of a true line, and near one that was moved elsewhere.
    true_ends: usize,
    by_chance: usize,
}

impl Ends {
    fn add(&mut self, ends: &[[i64; 2]], true_ends: &[[i64; 2]]) {
        let [x, y] = ELSEWHERE;
        let moved: Vec<_> = true_ends.iter().map(|[u, v]| [u + x, v + y]).collect();
        let near = |others: &[[i64; 2]]| at_places(ends, i64::from(FINE), others, NEAR_END);
        self.all += ends.len();
        self.true_ends += near(true_ends);
        self.by_chance += near(&moved);
    }
}

/// What turns: two shapes, and the models.
fn turning() -> Vec<(&'static str, Vec<Mesh>)> {
    let models = Specimen::ALL.map(|model| {
        let parts: Vec<Mesh> = model.parts().into_iter().map(|(mesh, _)| mesh).collect();
        (model.name(), parts)
    });
    let shapes: [(&str, Mesh); 2] = [
        ("cylinder", Cylinder::new(0.6, 1.2).into()),
        // Its faces bend by 42 degrees, where creases begin at 40.
        (
            "icosahedron",
            flat(Sphere::new(1.0).mesh().ico(0).expect("few triangles")),
        ),
    ];
    let shapes = shapes.map(|(name, mesh)| (name, vec![mesh]));
    shapes.into_iter().chain(models).collect()
}

/// A mesh without shared vertices, and so with flat faces.
fn flat(mesh: Mesh) -> Mesh {
    let mut mesh = mesh;
    mesh.duplicate_vertices();
    mesh.compute_flat_normals();
    mesh
}

/// Makes everything white but the lines: what anti-aliasing does to the picture does not count.
fn whiten(rig: &mut Rig) {
    let camera = rig.camera;
    let world = rig.headless.app.world_mut();
    world.insert_resource(ClearColor(Color::WHITE));
    world.entity_mut(camera).remove::<Skybox>();
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    for (_, mesh) in meshes.iter_mut() {
        mesh.remove_attribute(Mesh::ATTRIBUTE_COLOR);
    }
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    for (_, material) in materials.iter_mut() {
        *material = StandardMaterial {
            unlit: true,
            cull_mode: material.cull_mode,
            double_sided: material.double_sided,
            ..Color::WHITE.into()
        };
    }
}

/// Pixels that change by more than two codes from frame to frame, and the time of a frame.
pub fn history(run: &Run) -> Result<(), String> {
    let (settled, frames, timed) = run.pick((4, 2, 1), (150, 64, 21));
    let size = run.size([160, 90], [640, 360]);
    let mut table = Table::new("scene,method,changed,pixels,ms");
    let lines = |history_weight: f32| {
        Drawn::style(ComicStyle::new().with(Outlines {
            history_weight,
            ..default()
        }))
    };
    let methods = [
        ("no lines", Drawn::Nothing),
        ("no history", lines(0.0)),
        ("history", lines(0.875)),
    ];
    for scene in run.some(1, [BuiltIn::Teapot, BuiltIn::Village]) {
        let mut rig = Rig::new(Some(scene), size);
        whiten(&mut rig);
        let world = rig.headless.app.world_mut();
        world.entity_mut(rig.camera).insert((
            TemporalAntiAliasing::default(),
            DepthPrepass,
            NormalPrepass,
        ));
        for (method, drawn) in &methods {
            rig.set_drawn(drawn);
            rig.headless.step(settled);
            let mut before = rig.headless.picture();
            let mut changed = 0;
            for _ in 0..frames {
                rig.headless.step(1);
                let now = rig.headless.picture();
                let differ = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
                    a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2)
                };
                changed += before.pixels().zip(now.pixels()).filter(differ).count();
                before = now;
            }
            let times = (0..timed).map(|_| {
                let start = Instant::now();
                rig.headless.step(1);
                1e3 * start.elapsed().as_secs_f64()
            });
            let ms = format!("{:.4}", middle_of(times));
            let pixels = frames * (size.x * size.y) as usize;
            table.push(&[&scene.name(), method, &changed, &pixels, &ms]);
        }
        run.say(&format!("{}: changes counted", scene.name()));
    }
    run.save("ink_history", &table)
}
