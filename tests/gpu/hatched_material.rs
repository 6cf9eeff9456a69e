//! Strokes on the toon material: `hatch_light.wgsl`, and `vertex.wgsl`, which outputs positions of
//! the mesh at rest.

use bevy::{
    camera::visibility::NoFrustumCulling, light::DirectionalLightShadowMap,
    mesh::morph::MorphAttributes,
};
use bevy_comics_testkit::reference::hatching::Hatch;

use crate::{
    hatching::{EXTREMES, differ, extreme},
    line_scenes::mean,
    prelude::*,
    ramp::{MODES, bright, drawn, full, put, room, set_light, sun},
};

pub const SIZE: UVec2 = UVec2::new(160, 160);

/// Black strokes on white paper.
fn inked() -> Hatching {
    Hatching {
        ground: HatchingGround::Paper,
        ..default()
    }
}

/// The same without what is random, with a tone for every lightness.
pub fn plain() -> Hatching {
    crate::hatching::plain(HatchingKind::Strokes)
}

pub fn with(hatching: Hatching) -> ToonLight {
    ToonLight {
        hatching: Some(hatching),
        ..default()
    }
}

/// Darkness of every pixel: 0 paper, 1 ink.
pub fn covers(small: &mut Small) -> Vec<f64> {
    let picture = drawn(small);
    let places = (0..picture.height()).flat_map(|y| (0..picture.width()).map(move |x| (x, y)));
    places
        .map(|(x, y)| 1.0 - linear(&picture, x, y)[0])
        .collect()
}

/// A wall of 18 units that faces the eye.
pub fn wall() -> Mesh {
    Plane3d::new(Vec3::Z, Vec2::splat(9.0)).mesh().build()
}

/// A turn about a slanted axis.
pub fn turned(degrees: f32) -> Quat {
    Quat::from_axis_angle(Vec3::new(0.6, 0.8, 0.0), degrees.to_radians())
}

/// A sun without shadow maps, whose light comes from a direction.
pub fn light_from(small: &mut Small, to: Vec3, part: f32) -> Entity {
    let at = Transform::IDENTITY.looking_to(-to, Vec3::new(0.1, 0.9, 0.2));
    small.world().spawn((Object, bright(part), at)).id()
}

/// The darkness where a fraction of all light arrives.
pub fn tone(hatching: &Hatching, fraction: f64) -> f64 {
    Hatch::new(hatching).tone(fraction.sqrt()) * f64::from(hatching.at_near)
}

/// Light from the front, from behind, and from all around.
const LIGHT: [[f32; 3]; 3] = [[0.3, 0.9, 0.0], [0.6, 0.4, 0.0], [0.0, 0.6, 0.2]];

/// Truth: a flat wall on which a fraction of all light arrives has the darkness that this fraction
/// asks for, at every angle, with one layer and with three.
#[test]
fn flat_walls_have_the_tone_of_their_light() {
    let [back, front, around] = LIGHT;
    walls_have_the_tone_of_their_light(&[(back, &[0.0]), (front, &[35.0]), (around, &[60.0])]);
}

#[test]
#[ignore = "long: every angle under every light"]
fn flat_walls_have_the_tone_of_every_light() {
    walls_have_the_tone_of_their_light(&LIGHT.map(|light| (light, &[0.0, 35.0, 60.0][..])));
}

/// `walls`: their light, and their angles in degrees.
fn walls_have_the_tone_of_their_light(walls: &[([f32; 3], &[f32])]) {
    let mut small = room(SIZE, 0.0);
    for &([front, behind, around], angles) in walls {
        let fraction = f64::from((front + around) / (front + behind + around));
        small.world().insert_resource(GlobalAmbientLight {
            brightness: around * full() / std::f32::consts::PI,
            ..default()
        });
        for degrees in angles {
            small.clear();
            light_from(&mut small, Vec3::Z, front);
            light_from(&mut small, -Vec3::Z, behind);
            // Lines at 45 degrees would all lie in the same way on pixels.
            let turn = turned(*degrees) * Quat::from_rotation_z(0.2);
            let at = Transform::from_rotation(turn);
            put(&mut small, wall(), &ToonLight::default(), at);
            let styles = [1, 3].map(|layers| [(layers, 0.0), (layers, 1.0)]);
            for (layers, random) in styles.concat() {
                let limit = if random > 0.0 { 0.04 } else { 0.02 };
                let s = Hatching {
                    layers,
                    breaks: random,
                    wobble: random,
                    pressure: 0.5 * random,
                    at_near: 1.0 - 0.2 * random,
                    ..plain()
                };
                set_light(&mut small, &with(s));
                let (got, want) = (mean(&covers(&mut small)), tone(&s, fraction));
                let what = format!("fraction {fraction:.2}, {degrees} degrees, {s:?}");
                assert!((got - want).abs() < limit, "{what}: {got}, {want}");
            }
        }
    }
}

/// Every mode of a ramp gives the fraction of what the same ramp gives where all light arrives.
#[test]
fn strokes_follow_the_tones_of_ramps() {
    let gray = |part| Color::linear_rgb(part, part, part);
    let mut small = room(SIZE, 0.0);
    for mode in MODES {
        small.clear();
        // 60 degrees from the normal.
        light_from(&mut small, Vec3::new(0.0, 0.75f32.sqrt(), 0.5), 0.8);
        let stops = [
            RampStop::new(0.0, Color::BLACK),
            RampStop::new(0.3, gray(0.3)),
            RampStop::new(0.7, gray(0.9)),
        ];
        let light = ToonLight {
            ramp: Some(Ramp {
                mode,
                ..Ramp::new(stops)
            }),
            ..with(plain())
        };
        put(&mut small, wall(), &light, Transform::IDENTITY);
        let (got, want) = (mean(&covers(&mut small)), tone(&plain(), 0.3 / 0.9));
        assert!((got - want).abs() < 0.02, "{mode:?}: {got}, {want}");
    }
}

/// The places that a rigid motion takes things to.
pub fn frames() -> [Transform; 3] {
    let turn = Quat::from_euler(EulerRot::YXZ, 0.7, -0.3, 1.1);
    [
        Transform::from_xyz(0.4, -1.3, 2.9),
        Transform::from_rotation(turn),
        Transform::from_xyz(31.7, -8.3, 102.9).with_rotation(turn),
    ]
}

pub fn ball() -> Mesh {
    Sphere::new(0.8).mesh().uv(64, 32)
}

/// An empty white room with a sun, and a seventh of the light from all around.
pub struct WhiteRoom {
    pub small: Small,
    sun: Entity,
}

impl WhiteRoom {
    pub fn new() -> Self {
        let mut small = room(SIZE, 0.1);
        small.camera_settings().clear_color = Color::WHITE.into();
        let sun = light_from(&mut small, Vec3::Z, 0.6);
        Self { small, sun }
    }

    /// The darkness that the camera sees which moves with a frame, with the sun.
    fn seen_from(&mut self, frame: Transform) -> Vec<f64> {
        let small = &mut self.small;
        small.insert(frame * Transform::from_xyz(0.0, 0.0, 5.0));
        let to = Vec3::new(0.5, 0.6, 0.7);
        let at = frame * Transform::IDENTITY.looking_to(-to, Vec3::Y);
        small.world().entity_mut(self.sun).insert(at);
        covers(small)
    }

    /// Checks that the camera sees the same picture from every frame, after something has moved
    /// with it. Edges of the light and the mesh may round to another pixel.
    pub fn assert_stays(
        &mut self,
        still: &[f64],
        frames: impl IntoIterator<Item = Transform>,
        mut moved: impl FnMut(&mut World, Transform),
    ) {
        assert!(still.iter().any(|c| *c > 0.9), "no ink");
        for frame in frames {
            moved(self.small.world(), frame);
            let apart = differ(still, &self.seen_from(frame), 2.0 / 255.0);
            println!("{frame:?}: {apart} of {} pixels differ", still.len());
            assert!(apart < still.len() / 200, "{frame:?}: {apart}");
        }
    }

    pub fn still(&mut self) -> Vec<f64> {
        self.seen_from(Transform::IDENTITY)
    }
}

/// Checks that strokes or dots stay on a mesh that moves, turns and is stretched.
pub fn assert_marks_stay(s: Hatching) {
    let mut room = WhiteRoom::new();
    room.small.insert((DepthPrepass, NormalPrepass));
    let own =
        Transform::from_rotation(Quat::from_rotation_x(0.4)).with_scale(Vec3::new(1.2, 0.7, 1.0));
    let object = put(&mut room.small, ball(), &with(s), own);
    let still = room.still();
    room.assert_stays(&still, frames(), |world, frame| {
        world.entity_mut(object).insert(frame * own);
    });
    // Marks lie in the mesh: seen from elsewhere, they are elsewhere in the picture.
    room.small.world().entity_mut(object).insert(own);
    let turned = covers(&mut room.small);
    assert!(differ(&still, &turned, 2.0 / 255.0) > still.len() / 20);
}

/// Truth: strokes stay on a mesh that moves: the camera that follows sees the same picture. Strokes
/// of the page do not.
#[test]
fn strokes_stay_on_what_moves() {
    assert_marks_stay(inked());
}

/// The room, in which a mesh takes the place of a ball after its picture was taken.
fn in_place_of_a_ball(mesh: Mesh, mut room: WhiteRoom) -> (WhiteRoom, Entity, Vec<f64>) {
    let small = &mut room.small;
    let plain = put(small, ball(), &with(inked()), Transform::IDENTITY);
    let still = room.still();
    room.small.world().despawn(plain);
    let light = with(inked());
    let object = put(&mut room.small, mesh, &light, Transform::IDENTITY);
    (room, object, still)
}

/// Truth: strokes stay on a skinned mesh, whatever its entity does.
#[test]
fn strokes_stay_on_skinned_meshes() {
    let mut room = WhiteRoom::new();
    // Prepasses have a vertex shader of their own: both must give the same depth.
    room.small.insert((DepthPrepass, NormalPrepass));
    let count = ball().count_vertices();
    let joints = VertexAttributeValues::Uint16x4(vec![[0; 4]; count]);
    let weights = vec![[1.0f32, 0.0, 0.0, 0.0]; count];
    let mesh = ball()
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, joints)
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights);
    let (mut room, object, still) = in_place_of_a_ball(mesh, room);
    let world = room.small.world();
    let mut poses = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
    let inverse_bindposes = poses.add(SkinnedMeshInverseBindposes::from(vec![Mat4::IDENTITY]));
    let joint = world.spawn(Transform::IDENTITY).id();
    let skin = SkinnedMesh {
        inverse_bindposes,
        joints: vec![joint],
    };
    world.entity_mut(object).insert((skin, NoFrustumCulling));
    let mut aside = Transform::IDENTITY;
    room.assert_stays(&still, frames(), |world, frame| {
        world.entity_mut(joint).insert(frame);
        world.entity_mut(object).insert(aside);
        aside.translation.x += 1.0;
    });
}

/// Truth: strokes stay on a morphed mesh.
#[test]
fn strokes_stay_on_morphed_meshes() {
    let by = Vec3::new(0.9, -0.6, 0.4);
    let mut mesh = ball();
    let target = MorphAttributes {
        position: by,
        ..default()
    };
    mesh.set_morph_targets(vec![target; mesh.count_vertices()]);
    let (mut room, object, still) = in_place_of_a_ball(mesh, WhiteRoom::new());
    let frames = [0.0, 0.5, 1.0].map(|weight| Transform::from_translation(weight * by));
    room.assert_stays(&still, frames, |world, frame| {
        let weights = vec![frame.translation.x / by.x];
        world.entity_mut(object).insert((
            MorphWeights::new(weights.clone(), None).expect("one weight"),
            MeshMorphWeights::Value { weights },
            NoFrustumCulling,
        ));
    });
}

/// Shadows of other things are hatched, with the tone of the light that is left.
#[test]
fn cast_shadows_are_hatched() {
    let mut small = room(SIZE, 0.2);
    // A texel is a hundredth of the picture.
    let map = DirectionalLightShadowMap { size: 1024 };
    small.world().insert_resource(map);
    let shadows = DirectionalLight {
        shadow_maps_enabled: true,
        ..bright(0.6)
    };
    sun(&mut small, Vec3::new(0.0, 0.6, 1.0), shadows);
    put(&mut small, wall(), &with(plain()), Transform::IDENTITY);
    // Its shadow covers the lower part of the picture; itself it is above.
    let above = Transform::from_xyz(0.0, 2.3, 3.0);
    let caster = Cuboid::new(9.0, 2.0, 0.2);
    put(&mut small, caster, &with(plain()), above);
    let found = covers(&mut small);
    let rows = |rows: Range<usize>| mean(&found[rows.start * 160..rows.end * 160]);
    // The shadow reaches from 1.5 to -0.5: rows 0 to 120.
    let (dark, light) = (rows(10..110), rows(130..160));
    let want = tone(&plain(), 0.25);
    assert!((dark - want).abs() < 0.03, "{dark}, {want}");
    assert!(light < 0.01, "{light}");
}

/// A material without strokes is what it was, to the bit, also if they are not seen.
#[test]
fn no_strokes_change_nothing() {
    let mut room = WhiteRoom::new();
    room.still();
    let small = &mut room.small;
    put(small, ball(), &ToonLight::default(), Transform::IDENTITY);
    let before = drawn(small);
    let unseen = Hatching {
        opacity: 0.0,
        ..default()
    };
    set_light(small, &with(unseen));
    assert_eq!(apart(&before, &drawn(small)), 0);
    // Where all light arrives, there are none.
    set_light(small, &with(default()));
    let after = drawn(small);
    assert_eq!(before.get_pixel(95, 60), after.get_pixel(95, 60));
    assert!(apart(&before, &after) > 50);
}

/// The color between strokes keeps the mean of a shade.
#[test]
fn shades_keep_their_mean_color() {
    let mut small = room(SIZE, 0.2);
    light_from(&mut small, -Vec3::Z, 0.6);
    let light = ToonLight::default();
    put(&mut small, wall(), &light, Transform::IDENTITY);
    let bare = mean(&covers(&mut small));
    let s = Hatching {
        ground: HatchingGround::Color,
        ..plain()
    };
    set_light(&mut small, &with(s));
    let found = covers(&mut small);
    let hatched = mean(&found);
    assert!((bare - hatched).abs() < 0.02, "{bare}, {hatched}");
    assert!(found.iter().any(|c| *c > 0.99), "no ink");
}

/// Every pixel is a number, whatever the settings and the mesh are.
#[test]
fn extreme_strokes_are_finite() {
    let mut room = WhiteRoom::new();
    room.still();
    let small = &mut room.small;
    small.headless.resize(UVec2::splat(48), 1.0);
    let target = small.headless.render_target();
    small.insert((Hdr, target));
    small.style(&ComicStyle::new().with(Vignette::default()));
    let mut bare = ball();
    bare.remove_attribute(Mesh::ATTRIBUTE_NORMAL);
    bare.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    let normals = vec![[0.0f32; 3]; ball().count_vertices()];
    let flat = ball().with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals);
    let light = ToonLight::default();
    for (x, mesh) in [(-0.4, ball()), (0.0, bare), (0.4, flat)] {
        put(small, mesh, &light, Transform::from_xyz(x, 0.0, 0.0));
    }
    let squashed = Transform::from_scale(Vec3::new(1.0, 0.0, 1e-20));
    put(small, ball(), &light, squashed);
    for x in EXTREMES {
        for anchor in [HatchingAnchor::Object, HatchingAnchor::Page] {
            let s = Hatching {
                anchor,
                ..extreme(HatchingKind::Strokes, x)
            };
            set_light(small, &with(s));
            small.headless.step(3);
            let found = small.loaded();
            let mut all = found.pixels.iter().flatten();
            assert!(all.all(|c| c.is_finite()), "{x}, {anchor:?}");
        }
    }
}
