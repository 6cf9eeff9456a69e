//! Pictures of the toon material: stylized highlights, rims, and tones that change with depth.

use std::path::Path;

use bevy::{core_pipeline::tonemapping::Tonemapping, prelude::*};
use bevy_comics::{
    ComicStyle, ComicsPlugin, Outlines, ToneRamp, ToonLight, ToonMaterial, ToonScene, presets,
    toon::{
        DetailAxis, HighlightShape, ProxyShape, Ramp, RampDetail, RampMode, RampStop, Rim,
        RimWidth, ShadingProxy, StylizedHighlight,
    },
};
use bevy_comics_testkit::{
    headless::{Headless, HeadlessOptions},
    scenes::{
        BuiltIn, ScenePart,
        lights::{Lighting, relight},
    },
    studio::Studio,
};
use image::RgbaImage;

use crate::{painted, save, sheet::in_rows, smoothed, strokes};

/// Frames until shaders are compiled and the picture stands still.
const SETTLE: usize = 12;

pub fn write(folder: &Path) -> Result<(), String> {
    save(&highlights(), &folder.join("highlights.png"))?;
    save(&details(), &folder.join("details.png"))?;
    save(&painted::picture(), &folder.join("painted-ramps.png"))?;
    save(&rims(), &folder.join("rims.png"))?;
    save(&forms(), &folder.join("proxies.png"))?;
    save(&smoothed::picture(), &folder.join("smoothed.png"))?;
    save(&strokes::picture(), &folder.join("hatched-material.png"))?;
    save(&tone_ramp(), &folder.join("tone-ramp.png"))?;
    save(&figure(), &folder.join("figure.png"))?;
    save(&lights(), &folder.join("lights.png"))
}

/// A stage with a ground, under a sun from the left.
pub struct Room {
    pub headless: Headless,
}

impl Room {
    pub fn new(size: UVec2, eye: Transform, fov: f32) -> Self {
        let mut headless = Headless::new(HeadlessOptions { size, ..default() }, ComicsPlugin);
        let target = headless.render_target();
        let world = headless.app.world_mut();
        world.insert_resource(ClearColor(Color::srgb(0.96, 0.9, 0.78)));
        world.insert_resource(GlobalAmbientLight {
            brightness: 220.0,
            ..default()
        });
        let outlines = Outlines {
            width: 2.5,
            ..default()
        };
        let lens = Projection::Perspective(PerspectiveProjection { fov, ..default() });
        world.spawn((
            Camera3d::default(),
            Tonemapping::None,
            lens,
            eye,
            target,
            outlines,
        ));
        let sun = DirectionalLight {
            illuminance: 2500.0,
            shadow_maps_enabled: true,
            ..default()
        };
        let from = Transform::from_xyz(-3.4, 4.4, 4.2).looking_at(Vec3::ZERO, Vec3::Y);
        world.spawn((sun, from));
        Self { headless }
    }

    pub fn put(
        &mut self,
        mesh: impl Into<Mesh>,
        base: StandardMaterial,
        light: &ToonLight,
        at: Transform,
    ) -> Entity {
        let world = self.headless.app.world_mut();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        let material = ToonMaterial {
            base,
            extension: light.clone(),
        };
        let material = world.resource_mut::<Assets<ToonMaterial>>().add(material);
        let parts = (Mesh3d(mesh), MeshMaterial3d(material), at);
        world.spawn(parts).id()
    }

    pub fn ground(&mut self) {
        self.ground_with(&ToonLight {
            ramp: Some(per_light(Ramp::default().stops)),
            ..default()
        });
    }

    pub fn ground_with(&mut self, light: &ToonLight) {
        let ground = Plane3d::default().mesh().size(80.0, 80.0);
        let at = Transform::IDENTITY;
        self.put(ground, matt(Color::srgb(0.93, 0.84, 0.66)), light, at);
    }

    pub fn image(&mut self, image: Image) -> Handle<Image> {
        let world = self.headless.app.world_mut();
        world.resource_mut::<Assets<Image>>().add(image)
    }

    pub fn picture(mut self) -> RgbaImage {
        self.headless.step(SETTLE);
        self.headless.picture()
    }
}

pub fn matt(color: Color) -> StandardMaterial {
    StandardMaterial {
        perceptual_roughness: 0.9,
        ..color.into()
    }
}

fn shiny(color: Color) -> StandardMaterial {
    StandardMaterial {
        perceptual_roughness: 0.35,
        ..color.into()
    }
}

pub fn per_light(stops: Vec<RampStop>) -> Ramp {
    Ramp {
        mode: RampMode::PerLight,
        ..Ramp::new(stops)
    }
}

fn ball() -> Mesh {
    Sphere::new(0.5).mesh().uv(96, 48)
}

/// Balls with one stylized highlight each.
fn highlights() -> RgbaImage {
    let eye = Transform::from_xyz(0.0, 1.7, 8.4).looking_at(Vec3::new(0.0, 0.55, 0.0), Vec3::Y);
    let mut room = Room::new(UVec2::new(800, 200), eye, 0.235);
    room.ground();
    let highlight = |shape, size, change: fn(&mut StylizedHighlight)| {
        let mut highlight = StylizedHighlight {
            shape,
            size,
            ..default()
        };
        change(&mut highlight);
        highlight
    };
    let highlights = [
        highlight(HighlightShape::Disc, 1.6, |_| ()),
        highlight(HighlightShape::Disc, 1.3, |s| s.split.x = 1.5),
        highlight(HighlightShape::Window, 2.4, |s| {
            (s.square, s.rotation) = (0.7, -8.0);
        }),
        highlight(HighlightShape::Crescent, 2.8, |s| {
            (s.bar, s.rotation) = (0.3, -35.0);
        }),
        highlight(HighlightShape::Star, 4.0, |_| ()),
        highlight(HighlightShape::Streak, 3.6, |s| {
            (s.bar, s.rotation) = (0.2, 40.0);
        }),
        highlight(HighlightShape::Faithful, 1.8, |s| {
            (s.square, s.sharpness, s.scale.x) = (0.4, 1, 1.5);
        }),
    ];
    let colors = [
        Color::srgb(0.82, 0.25, 0.22),
        Color::srgb(0.2, 0.42, 0.72),
        Color::srgb(0.2, 0.55, 0.42),
        Color::srgb(0.86, 0.55, 0.18),
        Color::srgb(0.46, 0.28, 0.6),
        Color::srgb(0.24, 0.26, 0.34),
        Color::srgb(0.72, 0.3, 0.45),
    ];
    for (k, (stylized_highlight, color)) in highlights.into_iter().zip(colors).enumerate() {
        let light = ToonLight {
            ramp: Some(per_light(Ramp::default().stops)),
            stylized_highlight: Some(stylized_highlight),
            highlight: 4.0,
            ..default()
        };
        let at = Transform::from_xyz(-3.3 + 1.1 * k as f32, 0.5, 0.0);
        room.put(ball(), shiny(color), &light, at);
    }
    room.picture()
}

/// Rows of balls: far away, the ramp has fewer tones; rims and highlights have another ramp.
fn details() -> RgbaImage {
    let size = UVec2::new(264, 264);
    let near = || {
        vec![
            RampStop::new(0.0, Color::srgb(0.36, 0.25, 0.52)),
            RampStop::new(0.1, Color::srgb(0.72, 0.42, 0.52)),
            RampStop::new(0.4, Color::srgb(0.93, 0.76, 0.7)),
            RampStop::new(0.78, Color::WHITE),
        ]
    };
    let same = |color, count: usize| {
        (0..count)
            .map(|k| RampStop::new(0.02 * k as f32, color))
            .collect()
    };
    let pale = Color::srgb(0.82, 0.88, 0.98);
    // The same edges, but all light.
    let warm = near().into_iter().map(|stop| RampStop {
        color: Color::srgb(1.0, 0.93, 0.6),
        ..stop
    });
    let warm = warm.collect();
    let cases: [(Vec<RampStop>, Vec<RampStop>, DetailAxis); 3] = [
        (
            near(),
            same(pale, 4),
            DetailAxis::Depth {
                from: 4.5,
                ratio: 3.2,
            },
        ),
        (near(), warm, DetailAxis::Rim { power: 0.5 }),
        (
            same(Color::WHITE, 2),
            vec![
                RampStop::new(0.0, Color::srgb(0.2, 0.16, 0.3)),
                RampStop::new(0.5, Color::srgb(0.42, 0.36, 0.5)),
            ],
            DetailAxis::Highlight { power: 6.0 },
        ),
    ];
    let pictures = cases.map(|(stops, plain, axis)| {
        let eye = Transform::from_xyz(0.2, 2.1, 4.6).looking_at(Vec3::new(0.1, 0.3, -0.6), Vec3::Y);
        let mut room = Room::new(size, eye, 0.62);
        room.ground();
        let light = ToonLight {
            ramp: Some(Ramp {
                detail: Some(RampDetail { plain, axis }),
                ..per_light(stops)
            }),
            highlight: 0.0,
            ..default()
        };
        for k in 0..5u8 {
            let k = f32::from(k);
            let at = Transform::from_xyz(-0.6 + 0.56 * k, 0.5, 0.5 - 2.1 * k);
            let color = Color::srgb(0.95, 0.62, 0.42);
            room.put(ball(), matt(color), &light, at);
        }
        room.picture()
    });
    in_rows(&pictures, 3, size, 4)
}

/// A figure of round and square parts: without a rim, with one that faces away from the eye, and
/// with one of constant width.
fn rims() -> RgbaImage {
    let eye = Transform::from_xyz(0.0, 1.5, 7.0).looking_at(Vec3::new(0.0, 0.85, 0.0), Vec3::Y);
    let mut room = Room::new(UVec2::new(800, 300), eye, 0.33);
    room.ground();
    let rim = |width| {
        Some(Rim {
            width,
            color: Color::srgb(1.0, 0.97, 0.86),
            ..default()
        })
    };
    let facing = RimWidth::Facing {
        fraction: 0.4,
        softness: 0.0,
    };
    let cases = [None, rim(facing), rim(RimWidth::Pixels(5.0))];
    for (k, rim) in cases.into_iter().enumerate() {
        let light = ToonLight {
            ramp: Some(per_light(Ramp::default().stops)),
            rim,
            ..default()
        };
        let x = -2.45 + 1.95 * k as f32;
        let mut put = |mesh: Mesh, color, x2: f32, y: f32, turn: f32| {
            let at = Transform::from_xyz(x + x2, y, 0.0).with_rotation(Quat::from_rotation_y(turn));
            room.put(mesh, matt(color), &light, at);
        };
        let blue = Color::srgb(0.28, 0.38, 0.6);
        put(
            Capsule3d::new(0.36, 0.5).mesh().longitudes(48).build(),
            blue,
            0.0,
            0.61,
            0.0,
        );
        put(
            Sphere::new(0.4).mesh().uv(64, 32),
            Color::srgb(0.86, 0.56, 0.42),
            0.0,
            1.5,
            0.0,
        );
        put(
            Cuboid::new(0.5, 0.5, 0.5).into(),
            Color::srgb(0.62, 0.26, 0.24),
            0.95,
            0.25,
            0.5,
        );
    }
    room.picture()
}

/// A ball with dents, as heads and bushes have them.
pub fn bumpy(dents: f32) -> Mesh {
    let mut mesh: Mesh = Sphere::new(0.6).mesh().ico(12).expect("few vertices");
    let Some(bevy::mesh::VertexAttributeValues::Float32x3(places)) =
        mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION)
    else {
        return mesh;
    };
    for place in places {
        let at = Vec3::from_array(*place);
        let wave = (9.0 * at.x).sin() * (11.0 * at.y + 1.0).sin() * (10.0 * at.z + 2.0).sin();
        *place = (at * (1.0 + dents * wave)).to_array();
    }
    mesh.compute_smooth_normals();
    mesh
}

/// A bush and a tall stone, as they are, and shaded as an ellipsoid.
fn forms() -> RgbaImage {
    let eye = Transform::from_xyz(0.0, 1.6, 7.6).looking_at(Vec3::new(0.0, 0.62, 0.0), Vec3::Y);
    let mut room = Room::new(UVec2::new(800, 260), eye, 0.27);
    room.ground();
    let cases = [
        (0.35, Color::srgb(0.36, 0.6, 0.3), Vec3::ONE),
        (
            0.18,
            Color::srgb(0.86, 0.62, 0.5),
            Vec3::new(0.8, 1.1, 0.85),
        ),
    ];
    for (k, (dents, color, scale)) in cases.into_iter().enumerate() {
        let mesh = bumpy(dents);
        let shape = ProxyShape::ellipsoid_of(&mesh).expect("it has vertices");
        for (n, amount) in [0.0, 0.85].into_iter().enumerate() {
            let form = ShadingProxy {
                shape,
                amount,
                amount_at_far: amount,
                ..default()
            };
            let light = ToonLight {
                ramp: Some(per_light(Ramp::default().stops)),
                highlight: 0.0,
                proxy: Some(form),
                ..default()
            };
            let x = -2.2 + 3.0 * k as f32 + 1.5 * n as f32;
            let at = Transform::from_xyz(x, 0.62, 0.0).with_scale(scale);
            room.put(mesh.clone(), matt(color), &light, at);
        }
    }
    room.picture()
}

/// A landscape as it is, and in tones that fade with distance.
fn tone_ramp() -> RgbaImage {
    let size = UVec2::new(480, 270);
    let mut studio = Studio::new(BuiltIn::Village, size, Msaa::Sample4);
    let outlines = ComicStyle::new().with(Outlines::default());
    let before = studio.shoot(Some(&outlines));
    let after = studio.shoot(Some(&outlines.with(ToneRamp::default())));
    in_rows(&[before, after], 2, size, 6)
}

/// A character whose materials have looks of their own, from files.
fn figure() -> RgbaImage {
    let mut studio = Studio::new(BuiltIn::Figure, UVec2::new(800, 450), Msaa::Sample4);
    studio.shoot(Some(&presets::SATURDAY_MORNING.style()))
}

/// The theatre with the default ramp, under one kind of light after the other.
fn lights() -> RgbaImage {
    let size = UVec2::new(400, 225);
    let mut studio = Studio::new(BuiltIn::Theatre, size, Msaa::Sample4);
    let scene = ToonScene::new(ToonLight {
        ramp: Some(Ramp::default()),
        ..default()
    });
    let camera = studio.camera;
    let world = studio.headless.app.world_mut();
    let mut parts = world.query_filtered::<Entity, (With<ScenePart>, With<Mesh3d>)>();
    let parts: Vec<Entity> = parts.iter(world).collect();
    for part in parts {
        world.entity_mut(part).insert(scene.clone());
    }
    let style = presets::SATURDAY_MORNING.style();
    let pictures = Lighting::ALL.map(|lighting| {
        relight(studio.headless.app.world_mut(), camera, lighting);
        studio.shoot(Some(&style));
        studio.headless.step(SETTLE);
        studio.headless.picture()
    });
    in_rows(&pictures, 2, size, 4)
}
