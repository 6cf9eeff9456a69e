//! A picture of strokes on the toon material.

use bevy::{
    camera::visibility::NoFrustumCulling,
    mesh::{
        CylinderMeshBuilder, VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};
use bevy_comics::{
    Hatching, ToonLight,
    effects::HatchingGround,
    toon::{Ramp, RampMode, RampStop, TonalArtMap},
};
use image::RgbaImage;

use crate::toon::{Room, bumpy, matt};

/// From shade to light without a step.
fn soft() -> Ramp {
    Ramp {
        mode: RampMode::PerLight,
        ..Ramp::new([
            RampStop::new(0.0, Color::BLACK),
            RampStop::new(0.4, Color::WHITE).soft(0.8),
        ])
    }
}

fn light(hatching: Hatching) -> ToonLight {
    ToonLight {
        ramp: Some(soft()),
        hatching: Some(hatching),
        highlight: 0.0,
        ..default()
    }
}

fn on_paper() -> Hatching {
    Hatching {
        ground: HatchingGround::Paper,
        paper: Color::srgb(0.98, 0.95, 0.88),
        ink: Color::srgb(0.12, 0.1, 0.16),
        spacing: 3.0,
        solid_below: 0.0,
        bare_above: 1.0,
        at_near: 0.8,
        ..default()
    }
}

/// Things with strokes by planes and by maps.
pub fn picture() -> RgbaImage {
    let eye = Transform::from_xyz(0.0, 2.0, 9.0).looking_at(Vec3::new(0.0, 0.68, 0.0), Vec3::Y);
    let mut room = Room::new(UVec2::new(900, 260), eye, 0.21);
    let shadow = Hatching {
        spacing: 3.0,
        at_near: 0.7,
        ..default()
    };
    room.ground_with(&ToonLight {
        hatching: Some(shadow),
        ..default()
    });
    let at = |k: usize, y: f32| Transform::from_xyz(-2.5 + 1.25 * k as f32, y, 0.0);
    let over_color = Hatching {
        spacing: 3.0,
        solid_below: 0.0,
        bare_above: 1.0,
        at_near: 0.8,
        ..default()
    };
    let knot = Torus::new(0.2, 0.5)
        .mesh()
        .major_resolution(64)
        .minor_resolution(32);
    let lean = at(0, 0.6).with_rotation(Quat::from_euler(EulerRot::YXZ, 0.5, 1.1, 0.0));
    room.put(
        knot.build(),
        matt(Color::srgb(0.85, 0.5, 0.3)),
        &light(over_color),
        lean,
    );
    let ball = Sphere::new(0.55).mesh().uv(96, 48);
    room.put(ball, matt(Color::WHITE), &light(on_paper()), at(1, 0.55));
    bent_tube(&mut room, at(2, 0.0));
    let map = TonalArtMap {
        length: 0.8,
        width: 1.5,
        ..default()
    };
    let map = room.image(map.image());
    let mapped = ToonLight {
        art_map: Some(map.clone()),
        art_map_repeat: 1.0,
        ..light(on_paper())
    };
    let jar = ConicalFrustum {
        radius_top: 0.3,
        radius_bottom: 0.5,
        height: 1.2,
    };
    let jar = jar.mesh().resolution(64).build();
    room.put(jar, matt(Color::WHITE), &mapped, at(3, 0.6));
    let mut stone = bumpy(0.12);
    stone.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    let mapped = ToonLight {
        art_map_repeat: 0.6,
        ..mapped
    };
    room.put(stone, matt(Color::WHITE), &mapped, at(4, 0.6));
    room.picture()
}

/// A tube whose upper half a joint bends.
fn bent_tube(room: &mut Room, at: Transform) {
    let mut mesh = CylinderMeshBuilder::new(0.28, 1.3, 48).segments(24).build();
    let Some(VertexAttributeValues::Float32x3(places)) = mesh.attribute(Mesh::ATTRIBUTE_POSITION)
    else {
        return;
    };
    let weights: Vec<[f32; 4]> = (places.iter())
        .map(|place| {
            let upper = (place[1] / 0.8 + 0.5).clamp(0.0, 1.0);
            [1.0 - upper, upper, 0.0, 0.0]
        })
        .collect();
    let joints = vec![[0u16, 1, 0, 0]; weights.len()];
    mesh.insert_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights);
    let joints = VertexAttributeValues::Uint16x4(joints);
    mesh.insert_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, joints);
    let object = room.put(
        mesh,
        matt(Color::srgb(0.4, 0.62, 0.6)),
        &light(on_paper()),
        at,
    );
    let world = room.headless.app.world_mut();
    let poses = SkinnedMeshInverseBindposes::from(vec![Mat4::IDENTITY; 2]);
    let inverse_bindposes = world
        .resource_mut::<Assets<SkinnedMeshInverseBindposes>>()
        .add(poses);
    let lower = at * Transform::from_xyz(0.0, 0.65, 0.0);
    let upper = lower * Transform::from_rotation(Quat::from_rotation_z(-0.9));
    let joints = [lower, upper].map(|joint| world.spawn(joint).id()).to_vec();
    let skin = SkinnedMesh {
        inverse_bindposes,
        joints,
    };
    world.entity_mut(object).insert((skin, NoFrustumCulling));
}
