//! Every effect in views beside others, and on meshes that the engine draws in other ways: compared
//! with views alone, and with plain meshes. The effects are in the groups of `pairwise`.

use bevy::{
    camera::{primitives::Aabb, visibility::NoAutoAabb},
    math::Vec3A,
};
use image::RgbaImage;

use crate::{
    line_scenes::skinned,
    pairwise::{
        checks::assert_drawn_by,
        compare::{changed, crop},
        effects::{GROUPS, Group},
    },
    prelude::*,
    small,
    transparent_lines::change,
};

const SIZE: UVec2 = UVec2::new(96, 64);

/// The group of all effects.
const ALL: Group = GROUPS[GROUPS.len() - 1];

/// A part of a target, and the eye that draws it.
#[derive(Clone)]
struct Seat {
    target: Handle<Image>,
    part: Option<URect>,
    eye: Transform,
}

impl Seat {
    fn spawn(&self, small: &mut Small, order: isize, style: Option<&ComicStyle>) -> Entity {
        let target = RenderTarget::Image(self.target.clone().into());
        let camera = Camera {
            order,
            clear_color: Color::srgb(0.3, 0.5, 0.8).into(),
            viewport: self.part.map(|part| Viewport {
                physical_position: part.min,
                physical_size: part.size(),
                ..default()
            }),
            ..default()
        };
        let world = small.world();
        let spawned = world.spawn(small::camera(target, Msaa::Off)).id();
        world.entity_mut(spawned).insert((camera, self.eye));
        if let Some(style) = style {
            style.apply(&mut world.commands().entity(spawned));
            world.flush();
        }
        spawned
    }

    fn picture(&self, small: &mut Small) -> RgbaImage {
        let whole = small.headless.picture_of(&self.target);
        match self.part {
            Some(part) => crop(&whole, part),
            None => whole,
        }
    }
}

/// An app whose cameras are those of seats.
fn app() -> Small {
    let mut small = Small::new(SIZE, Msaa::Off);
    let camera = small.camera;
    small.world().despawn(camera);
    small
}

fn target(small: &mut Small) -> Handle<Image> {
    new_target(small.world(), SIZE, TextureFormat::Rgba8UnormSrgb)
}

/// The pictures of seats whose cameras draw in the same frames. They are new, without history.
fn shoot(
    small: &mut Small,
    seats: &[&Seat],
    style: Option<&ComicStyle>,
    what: &str,
) -> Vec<RgbaImage> {
    let mut cameras = Vec::new();
    for (order, seat) in (0..).zip(seats) {
        cameras.push(seat.spawn(small, order, style));
    }
    small.settle();
    let pictures = seats.iter().map(|seat| seat.picture(small)).collect();
    for camera in cameras {
        if let Some(style) = style {
            assert_drawn_by(small, camera, style, what);
        }
        small.world().despawn(camera);
    }
    pictures
}

/// Cameras on one target, and on two, draw what each of them draws alone.
#[test]
fn views_beside_others_are_drawn_as_alone() {
    assert_drawn_as_alone(&[ALL]);
}

#[test]
#[ignore = "long: every group of effects"]
fn views_with_each_group_beside_others_are_drawn_as_alone() {
    assert_drawn_as_alone(&GROUPS);
}

fn assert_drawn_as_alone(groups: &[Group]) {
    let mut small = app();
    let targets = [target(&mut small), target(&mut small), target(&mut small)];
    let half = |x: u32| Some(URect::new(x, 0, x + SIZE.x / 2, SIZE.y));
    let eyes = [Vec3::new(1.5, 2.4, 6.0), Vec3::new(-2.5, 1.6, 4.6)]
        .map(|eye| Transform::from_translation(eye).looking_at(Vec3::new(0.0, 0.4, 0.0), Vec3::Y));
    let seat = |target: usize, part: Option<URect>, eye: usize| Seat {
        target: targets[target].clone(),
        part,
        eye: eyes[eye],
    };
    let split = [seat(0, half(0), 0), seat(0, half(SIZE.x / 2), 1)];
    let apart = [seat(1, None, 0), seat(2, None, 1)];
    for (place, seats) in [("one target", split), ("two targets", apart)] {
        let both = [&seats[0], &seats[1]];
        let plain = shoot(&mut small, &both, None, place);
        for (name, style) in groups {
            let (what, style) = (format!("{place}, {name}"), style());
            let found = shoot(&mut small, &both, Some(&style), &what);
            for (k, seat) in seats.iter().enumerate() {
                let alone = shoot(&mut small, &[seat], Some(&style), &what);
                let off = changed(&alone[0], &found[k]);
                assert_eq!(off, 0.0, "{what}: view {k} beside the other");
                let off = changed(&plain[k], &found[k]);
                assert!(off > 0.02, "{what}: {off} of view {k} is styled");
            }
        }
    }
    assert_eq!(small.errors(), 0);
}

/// What is drawn in other ways.
struct Things {
    boxes: [Entity; 2],
    pane: Entity,
    cubes: [Entity; 9],
}

/// A box with three different sides.
fn slab() -> Mesh {
    Cuboid::new(0.9, 0.6, 0.3).into()
}

/// The bounds of both boxes, whatever their shape: that of an object decides where its planes are.
fn bounds() -> impl Bundle {
    let bounds = Aabb {
        center: Vec3A::ZERO,
        half_extents: Vec3A::splat(0.45),
    };
    (bounds, NoAutoAabb)
}

/// Where the boxes are: turned about the vertical axis.
fn places() -> [Transform; 2] {
    [(-1.3, 0.5), (1.4, -0.4)].map(|(x, turn)| {
        Transform::from_xyz(x, 0.6, 0.8).with_rotation(Quat::from_rotation_y(turn))
    })
}

/// Plain meshes: two boxes, a pane, and cubes that each have a mesh and a material of their own.
fn put_things(small: &mut Small) -> Things {
    small.clear();
    let ground = Plane3d::default().mesh().size(9.0, 9.0);
    let sand = unlit(Color::srgb(0.8, 0.7, 0.5));
    small.put(ground, sand, Transform::IDENTITY);
    let [left, right] = places();
    let boxes = [
        small.put(slab(), unlit(Color::srgb(0.85, 0.2, 0.15)), left),
        small.put(slab(), unlit(Color::srgb(0.15, 0.6, 0.3)), right),
    ];
    for entity in boxes {
        small.on(entity).insert(bounds());
    }
    let turned = Quat::from_euler(EulerRot::XYZ, 0.5, 0.7, 0.1);
    let pane = small.put(
        Cuboid::from_length(0.8),
        unlit(Color::srgb(0.3, 0.8, 0.9)),
        Transform::from_xyz(0.1, 1.2, 1.6).with_rotation(turned),
    );
    // Blended and skinned meshes have no creases at edges that only the mesh shows.
    for part in [boxes[0], pane] {
        small.on(part).insert(MeshSections::NONE);
    }
    let cubes = [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|k| {
        let at = Transform::from_xyz(0.55 * k as f32 - 2.2, 0.3, -1.6);
        let gray = unlit(Color::srgb(0.5, 0.5, 0.5));
        small.put(Cuboid::from_length(0.4), gray, at)
    });
    Things { boxes, pane, cubes }
}

/// One mesh and one material for all cubes: the engine draws them as instances.
fn share(small: &mut Small, things: &Things) {
    let first = small.on(things.cubes[0]);
    let (mesh, material) = first.components::<(&Mesh3d, &MeshMaterial3d<StandardMaterial>)>();
    let shared = (mesh.clone(), material.clone());
    for cube in &things.cubes {
        small.on(*cube).insert(shared.clone());
    }
}

/// A joint takes the place of the first box's transform. A quarter turn of the entity itself, which
/// the bounds do not show, changes nothing.
fn skin(small: &mut Small, things: &Things) {
    let [at, _] = places();
    let quarter = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
    let turned = at.with_rotation(at.rotation * quarter);
    let joint = small.world().spawn((Object, at)).id();
    let skin = skinned(small, slab(), &[joint], |_| 0);
    small.on(things.boxes[0]).insert((skin, turned));
}

/// The pictures of groups.
fn pictures(small: &mut Small, seat: &Seat, groups: &[Group], what: &str) -> Vec<RgbaImage> {
    // Until meshes and materials that changed are on the GPU.
    small.settle();
    let plain = shoot(small, &[seat], None, what);
    let mut pictures = Vec::new();
    for (name, style) in groups {
        let what = format!("{what}, {name}");
        let mut shot = shoot(small, &[seat], Some(&style()), &what);
        let off = changed(&plain[0], &shot[0]);
        assert!(off > 0.02, "{what}: {off} is styled");
        pictures.append(&mut shot);
    }
    pictures
}

/// The fraction of each picture that is not what it was.
fn apart(before: &[RgbaImage], now: &[RgbaImage]) -> impl Iterator<Item = f64> {
    before.iter().zip(now).map(|(a, b)| changed(a, b))
}

fn assert_same(before: &[RgbaImage], now: &[RgbaImage], most: f64, what: &str) {
    for (i, off) in apart(before, now).enumerate() {
        assert!(off <= most, "{what}, group {i}: {off} differs");
    }
}

/// Instances, blended meshes with `DepthWrite` and skinned meshes have the picture of plain meshes
/// that have their shape and color.
#[test]
fn meshes_of_every_kind_are_drawn_as_plain_ones() {
    assert_drawn_as_plain(&[ALL], 1);
}

/// Lines, the sketch of lines, and all see the depth of a blended mesh.
#[test]
#[ignore = "long: every group of effects"]
fn meshes_of_every_kind_are_drawn_as_plain_ones_by_each_group() {
    assert_drawn_as_plain(&GROUPS, 3);
}

/// `see_depth`: how many groups draw something else where a blended mesh has no depth, at least.
fn assert_drawn_as_plain(groups: &[Group], see_depth: usize) {
    let mut small = app();
    let things = put_things(&mut small);
    let pane = things.pane;
    let seat = Seat {
        target: target(&mut small),
        part: None,
        eye: Transform::from_xyz(1.5, 2.4, 6.0).looking_at(Vec3::new(0.0, 0.4, 0.0), Vec3::Y),
    };
    let shoot = |small: &mut Small, what: &str| pictures(small, &seat, groups, what);
    let plain = shoot(&mut small, "plain");
    share(&mut small, &things);
    let shared = shoot(&mut small, "instanced");
    assert_same(&plain, &shared, 0.0, "instanced");

    change(&mut small, pane, |m| m.alpha_mode = AlphaMode::Blend);
    let unseen = shoot(&mut small, "blended");
    let differ = apart(&plain, &unseen).filter(|off| *off > 0.0).count();
    assert!(differ >= see_depth, "without `DepthWrite`, it is not seen");
    small.on(pane).insert(DepthWrite::default());
    let blended = shoot(&mut small, "blended, with depth");
    assert_same(&plain, &blended, 0.0, "blended, with depth");
    // Plain again: what is next is compared alone.
    small.on(pane).remove::<DepthWrite>();
    change(&mut small, pane, |m| m.alpha_mode = AlphaMode::Opaque);

    // The GPU adds up joints: a vertex may be off by a last bit.
    let most = 0.01;
    skin(&mut small, &things);
    let skinned = shoot(&mut small, "skinned");
    assert_same(&plain, &skinned, most, "skinned");
    assert_eq!(small.errors(), 0);
}
