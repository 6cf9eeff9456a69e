//! Stiff and extreme cases: the condition of the problem, and the errors of the textbook's
//! form and of this crate's.

use bevy::{camera::Hdr, prelude::*, render::RenderApp};
use bevy_comics::{ComicStyle, Outlines, Sketch, ToneBands, presets};

use bevy_comics_testkit::{
    device::gpu,
    read_back,
    reference::map::{Frame, Projection as MapProjection},
    work::default_comic,
};

use crate::{
    Run,
    rig::{Drawn, Rig, unlit},
    table::Table,
};

/// A range of distances under a projection.
struct Case {
    name: &'static str,
    near: f64,
    far: f64,
    projection: Kind,
}

enum Kind {
    /// A perspective projection with this near plane and no far plane.
    Infinite(f64),
    /// A perspective projection with a near and a far plane.
    Finite(f64, f64),
    /// An orthographic projection from 0 to this far plane.
    Orthographic(f64),
    /// No projection: consecutive raw depths, as the bits of the first one and the number of
    /// steps of one ulp.
    Bits(u32, u32),
}

fn cases() -> Vec<Case> {
    let c = |name, near, far, projection| Case {
        name,
        near,
        far,
        projection,
    };
    use Kind::{Bits, Finite, Infinite, Orthographic};
    vec![
        c("z 1 to 1000", 1.0, 1e3, Infinite(0.1)),
        c("z 0.1 to 1e6 (ratio 1e7)", 0.1, 1e6, Infinite(0.1)),
        c("z 1e3 to 1e38", 1e3, 1e38, Infinite(1e3)),
        c("z 1e5 to 1e7", 1e5, 1e7, Infinite(0.1)),
        c("z 10 to 10.01", 10.0, 10.01, Infinite(0.1)),
        c("z 100 to 100.001", 100.0, 100.001, Infinite(0.1)),
        c(
            "z 1 to 1000 in planes 0.1 and 1000",
            1.0,
            1e3,
            Finite(0.1, 1e3),
        ),
        c(
            "z 999 to 1000 in planes 0.1 and 1000",
            999.0,
            1e3,
            Finite(0.1, 1e3),
        ),
        c(
            "orthographic z 1 to 100 of 1000",
            1.0,
            100.0,
            Orthographic(1e3),
        ),
        c(
            "orthographic z 500 to 500.1 of 1000",
            500.0,
            500.1,
            Orthographic(1e3),
        ),
        c(
            "range of 4096 ulp at 0.5",
            0.0,
            0.0,
            Bits(0x3f00_0000, 4096),
        ),
        c("range of 16 ulp at 0.5", 0.0, 0.0, Bits(0x3f00_0000, 16)),
        c("range of one ulp at 0.5", 0.0, 0.0, Bits(0x3f00_0000, 1)),
        c("one depth (ratio 1)", 0.0, 0.0, Bits(0x3f00_0000, 0)),
        c(
            "depths at the smallest normal number",
            0.0,
            0.0,
            Bits(0x0080_0000, 4096),
        ),
        c("denormal depths", 0.0, 0.0, Bits(0x0000_1000, 4096)),
    ]
}

/// Error in units in the last place of the expected value as `f32`.
fn ulps(got: f32, want: f64) -> f64 {
    let unit = f64::from((want as f32).abs().max(f32::MIN_POSITIVE));
    let ulp = 2f64.powi(unit.log2().floor() as i32 - 23);
    (f64::from(got) - want).abs() / ulp
}

fn map_cases(table: &mut Table, run: &Run) {
    // (D of this crate, D of the textbook). The textbook's form computes distances first.
    let body = "
        var f: DepthFrame;
        f.near = i(1u); f.far = i(2u); f.offset = i(3u); f.floor = i(4u);
        f.plane_far = i(5u); f.extent = i(6u); f.flags = u(7u);
        let ours = depth_map(f, i(0u)).x;
        let z = vec3(i(0u), i(1u), i(2u));
        var distance = i(8u) / (z + i(3u));
        if f.flags == 1u { distance = f.plane_far - z * f.extent; }
        let textbook = (distance.x - distance.y) / (distance.z - distance.y);
        return vec4(ours, textbook, 0.0, 0.0);";
    for case in cases() {
        let count = if run.quick { 512 } else { 8192u32 };
        let (offset, scale, plane_far, extent) = match case.projection {
            Kind::Infinite(near) => (0.0, near, 0.0, 0.0),
            // d = near (far - z) / ((far - near) z).
            Kind::Finite(near, far) => (near / (far - near), near * far / (far - near), 0.0, 0.0),
            Kind::Orthographic(far) => (0.0, 0.0, far, far),
            Kind::Bits(..) => (0.0, 0.1, 0.0, 0.0),
        };
        let (offset, plane_far, extent) = (offset as f32, plane_far as f32, extent as f32);
        let raw = |z: f64| match case.projection {
            Kind::Orthographic(far) => ((far - z) / far) as f32,
            _ => (scale / z - f64::from(offset)) as f32,
        };
        let depths: Vec<f32> = match case.projection {
            Kind::Bits(base, span) => (0..=span.min(count))
                .map(|i| f32::from_bits(base + i))
                .collect(),
            _ => (0..=count)
                .map(|i| {
                    let part = f64::from(i) / f64::from(count);
                    raw(case.near * (case.far / case.near).powf(part))
                })
                .collect(),
        };
        let near = depths.iter().copied().fold(0.0, f32::max);
        let far = depths.iter().copied().fold(1.0, f32::min);
        let orthographic = matches!(case.projection, Kind::Orthographic(_));
        // The floor is 0: it would hide the errors that are measured here.
        let rows: Vec<[f32; 9]> = depths
            .iter()
            .map(|d| {
                let flags = f32::from(u8::from(orthographic));
                [
                    *d,
                    near,
                    far,
                    offset,
                    0.0,
                    plane_far,
                    extent,
                    flags,
                    scale as f32,
                ]
            })
            .collect();
        let got = gpu().evaluate(
            "#import bevy_comics::depth::map::{DepthFrame, depth_map}",
            body,
            &rows,
        );
        let exact = Frame {
            projection: if orthographic {
                MapProjection::Orthographic {
                    plane_far: f64::from(plane_far),
                    extent: f64::from(extent),
                }
            } else {
                MapProjection::Perspective {
                    offset: f64::from(offset),
                }
            },
            ends: Some([f64::from(near), f64::from(far)]),
            logarithmic: false,
            floor: 0.0,
            sky_gap: 0.05,
        };
        let mut worst = [[0.0f64; 2]; 2];
        let mut wild = [0usize; 2];
        for (d, got) in depths.iter().zip(&got) {
            // Depths that count as sky are sky for the reference too.
            let want = exact.depth_map(f64::from(*d))[0];
            for form in 0..2 {
                if got[form].is_finite() {
                    worst[form][0] = worst[form][0].max(ulps(got[form], want));
                    let codes = (f64::from(got[form].clamp(0.0, 1.0)) - want).abs() * 255.0;
                    worst[form][1] = worst[form][1].max(codes);
                } else {
                    wild[form] += 1;
                }
            }
        }
        let condition = (f64::from(near) + f64::from(offset)) / (f64::from(near) - f64::from(far));
        let number = |x: f64| format!("{x:.3e}");
        table.push(&[
            &"depth map",
            &case.name,
            &number(condition),
            &number(worst[1][0]),
            &number(worst[1][1]),
            &wild[1],
            &number(worst[0][0]),
            &number(worst[0][1]),
            &wild[0],
        ]);
    }
}

/// The preset `graphic-novel` with the default comic, outlines and tone bands.
fn everything() -> ComicStyle {
    let mut style = presets::GRAPHIC_NOVEL.style();
    for effect in default_comic().effects() {
        style.insert_any(effect.boxed());
    }
    style.with(Outlines::default()).with(ToneBands::default())
}

type Scene = fn(&mut Rig);

fn cubes(rig: &mut Rig, color: LinearRgba, scale: f32, origin: Vec3) {
    for (x, z) in [(-1.2, -4.0), (0.8, -6.0), (0.2, -20.0)] {
        let at = Transform::from_translation(origin + scale * Vec3::new(x, 0.1, z));
        let at = at.with_rotation(Quat::from_rotation_y(0.6));
        rig.put(Cuboid::from_length(scale), unlit(color), at);
    }
    let world = rig.headless.app.world_mut();
    world
        .entity_mut(rig.camera)
        .insert(Transform::from_translation(origin));
}

fn rendered_cases() -> Vec<(&'static str, Scene)> {
    const GRAY: LinearRgba = LinearRgba::new(0.5, 0.4, 0.3, 1.0);
    vec![
        ("all sky", |_| {}),
        ("one pixel of geometry", |rig| {
            let at = Transform::from_xyz(0.003, 0.003, -5.0);
            rig.put(Cuboid::from_length(0.02), unlit(GRAY), at);
        }),
        ("thin wires", |rig| {
            for i in 0..40u8 {
                let x = 0.05 * f32::from(i) - 1.0;
                let at = Transform::from_xyz(x, 0.0, -2.0 - 0.2 * f32::from(i));
                rig.put(Cuboid::new(0.001, 2.0, 0.001), unlit(GRAY), at);
            }
        }),
        ("HDR color of 65504", |rig| {
            let bright = LinearRgba::new(65504.0, 60000.0, 2e4, 1.0);
            cubes(rig, bright, 1.0, Vec3::ZERO);
        }),
        ("negative color", |rig| {
            cubes(rig, LinearRgba::new(-4.0, 0.5, -1e-6, 1.0), 1.0, Vec3::ZERO);
        }),
        ("infinite color", |rig| {
            let bright = LinearRgba::new(f32::INFINITY, 1.0, f32::NEG_INFINITY, 1.0);
            cubes(rig, bright, 1.0, Vec3::ZERO);
        }),
        ("color that is not a number", |rig| {
            cubes(
                rig,
                LinearRgba::new(f32::NAN, 1.0, 0.2, 1.0),
                1.0,
                Vec3::ZERO,
            );
        }),
        ("zero normals", |rig| {
            let mut mesh: Mesh = Cuboid::from_length(1.0).into();
            let count = mesh.count_vertices();
            mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0f32; 3]; count]);
            rig.put(mesh, unlit(GRAY), Transform::from_xyz(0.2, 0.1, -4.0));
        }),
        ("a world a millionth the size", |rig| {
            cubes(rig, GRAY, 1e-6, Vec3::ZERO);
            let tiny = PerspectiveProjection {
                near: 1e-7,
                ..default()
            };
            let world = rig.headless.app.world_mut();
            world
                .entity_mut(rig.camera)
                .insert(Projection::Perspective(tiny));
        }),
        ("a world a million times the size", |rig| {
            cubes(rig, GRAY, 1e6, Vec3::ZERO);
        }),
        ("camera at 1e6 from the origin", |rig| {
            cubes(rig, GRAY, 1.0, Vec3::new(1e6, 0.0, -1e6));
        }),
    ]
}

fn rendered(table: &mut Table, run: &Run) {
    let size = run.size([96, 64], [320, 200]);
    let style = everything();
    let sketch = style.clone().with(Sketch::default());
    for (name, scene) in run.some(3, rendered_cases()) {
        let mut rig = Rig::new(None, size);
        scene(&mut rig);
        let world = rig.headless.app.world_mut();
        world.entity_mut(rig.camera).insert(Hdr);
        let (mut wild_in, mut wild_out) = (0, 0);
        let mut wild = |style: &ComicStyle| {
            rig.set_drawn(&Drawn::style(style.clone()));
            rig.headless.step(4);
            let view = rig.view();
            let world = rig.headless.app.sub_app(RenderApp).world();
            let (_, picture) = read_back::pictures(world, view).expect("a picture");
            let bad = |p: &&[f32; 4]| p[..3].iter().any(|c| !c.is_finite());
            picture.pixels.iter().filter(bad).count()
        };
        for style in [&style, &sketch] {
            wild_in += wild(&ComicStyle::new());
            wild_out += wild(style);
        }
        table.push(&[
            &"picture", &name, &"", &"", &"", &wild_in, &"", &"", &wild_out,
        ]);
    }
    run.say("extreme pictures drawn");
}

pub fn measure(run: &Run) -> Result<(), String> {
    let mut table =
        Table::new("kind,case,condition,textbook_ulp,textbook_codes,textbook_wild,ulp,codes,wild");
    map_cases(&mut table, run);
    rendered(&mut table, run);
    run.save("stability", &table)
}
