//! Strokes of tonal art maps on the toon material: `art_map.wgsl`, `stroke_level.wgsl`.

use bevy_comics::toon::TonalArtMap;

use crate::{
    hatched_material::{
        SIZE, assert_same, covers, differ, frames, light_from, mean, plain, seen_from, studio, tone,
    },
    prelude::*,
    ramp::{put, room, set_light},
};

fn image(small: &mut Small, image: Image) -> Handle<Image> {
    small.world().resource_mut::<Assets<Image>>().add(image)
}

fn drawn_with(map: &Handle<Image>, repeat: f32) -> ToonLight {
    ToonLight {
        hatching: Some(Hatching { ..plain() }),
        art_map: Some(map.clone()),
        art_map_repeat: repeat,
        ..default()
    }
}

/// A wall of 18 units, with texture coordinates or without.
fn wall(has_uvs: bool) -> Mesh {
    let mut mesh = Plane3d::new(Vec3::Z, Vec2::splat(9.0)).mesh().build();
    if !has_uvs {
        mesh.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    }
    mesh
}

/// A room in which a quarter of the light arrives at what faces the eye.
fn dim() -> Small {
    let mut small = room(SIZE, 0.2);
    light_from(&mut small, Transform::IDENTITY, -Vec3::Z, 0.6);
    small
}

/// Truth: maps have the tone of the light at every size and angle, on texture coordinates and on planes.
#[test]
fn flat_walls_have_the_tone_of_their_light() {
    walls_have_the_tone_of_their_light(&[(0.0, &[0.5, 60.0]), (50.0, &[1.6]), (75.0, &[1.0, 8.0])]);
}

#[test]
#[ignore = "long: every size at every angle"]
fn flat_walls_have_the_tone_of_their_light_at_every_size() {
    let repeats = &[0.5, 1.0, 1.6, 3.0, 8.0, 60.0][..];
    walls_have_the_tone_of_their_light(&[0.0, 50.0, 75.0].map(|degrees| (degrees, repeats)));
}

/// `walls`: degrees, and how often each map is seen.
fn walls_have_the_tone_of_their_light(walls: &[(f32, &[f32])]) {
    let mut small = dim();
    let map = image(&mut small, TonalArtMap::default().image());
    let mut worst = 0.0f64;
    for has_uvs in [true, false] {
        for &(degrees, sizes) in walls {
            small.clear();
            light_from(&mut small, Transform::IDENTITY, -Vec3::Z, 0.6);
            let axis = Vec3::new(0.6, 0.8, 0.0);
            let turn = Quat::from_axis_angle(axis, degrees.to_radians());
            let at = Transform::from_rotation(turn);
            put(&mut small, wall(has_uvs), &ToonLight::default(), at);
            // The view shows 2 of 18 units: from half a repeat of the map to 60 of them.
            for &repeats in sizes {
                for gamma in [0.5f32, 2.5] {
                    let repeat = if has_uvs { 9.0 } else { 0.5 } * repeats;
                    let mut light = drawn_with(&map, repeat);
                    let s = Hatching { gamma, ..plain() };
                    light.hatching = Some(s);
                    set_light(&mut small, &light);
                    let (got, want) = (mean(&covers(&mut small)), tone(&s, 0.25));
                    println!(
                        "uvs {has_uvs}, {degrees} degrees, {repeats} repeats: {got:.3}, {want:.3}"
                    );
                    // Less than a whole map is seen: it is not equally dark everywhere.
                    let whole = if repeats < 1.0 { 0.5 } else { 1.0 };
                    worst = worst.max((got - want).abs() * whole);
                }
            }
        }
    }
    println!("mean tone off by up to {worst:.3}");
    assert!(worst < 0.03, "{worst}");
    assert_eq!(small.errors(), 0);
}

/// Strokes of a map are ink and paper, not grey, and stay about as wide while things come nearer.
#[test]
fn strokes_of_maps_have_their_width_at_every_size() {
    let mut small = dim();
    let map = TonalArtMap {
        crossing: 1.0,
        spread: 0.0,
        ..default()
    };
    let map = image(&mut small, map.image());
    put(&mut small, wall(true), &ToonLight::default(), default());
    let mut edges = Vec::new();
    for k in 0..6 {
        // Two octaves.
        let repeats = 1.0 * (f64::from(k) / 2.5).exp2() as f32;
        set_light(&mut small, &drawn_with(&map, 9.0 * repeats));
        let found = covers(&mut small);
        // Ink that begins or ends from row to row, for each row.
        let rows = found.chunks(SIZE.x as usize).collect::<Vec<_>>();
        let steps = rows.windows(2).flat_map(|pair| {
            let pairs = pair[0].iter().zip(pair[1]);
            pairs.map(|(a, b)| (a - b).abs())
        });
        edges.push(steps.sum::<f64>() / found.len() as f64);
    }
    println!("ink that changes from row to row: {edges:.3?}");
    let [low, high] =
        [f64::min, f64::max].map(|of| edges.iter().copied().reduce(of).expect("some"));
    // Texels are 0.7 to 1.4 pixels, and two levels are mixed between.
    assert!(high < 2.0 * low, "{edges:?}");
}

/// Truth: strokes of maps stay on what moves, with texture coordinates and without.
#[test]
fn strokes_of_maps_stay_on_what_moves() {
    let (mut small, sun) = studio();
    let map = image(&mut small, TonalArtMap::default().image());
    for has_uvs in [true, false] {
        let mut mesh = Sphere::new(0.8).mesh().uv(64, 32);
        if !has_uvs {
            mesh.remove_attribute(Mesh::ATTRIBUTE_UV_0);
        }
        let light = drawn_with(&map, 3.0);
        let object = put(&mut small, mesh, &light, Transform::IDENTITY);
        seen_from(&mut small, Transform::IDENTITY, sun);
        let still = covers(&mut small);
        for frame in frames() {
            small.world().entity_mut(object).insert(frame);
            seen_from(&mut small, frame, sun);
            assert_same(&still, &covers(&mut small), "moved");
        }
        small.world().despawn(object);
    }
}

/// Any image is a map: here stripes of two tones in one level, of which one is ink.
#[test]
fn images_are_maps() {
    let mut small = dim();
    let size = Extent3d {
        width: 4,
        height: 4,
        depth_or_array_layers: 1,
    };
    let rows = [[0u8; 4], [0; 4], [255; 4], [255; 4]].concat();
    let stripes = Image::new(
        size,
        TextureDimension::D2,
        rows,
        TextureFormat::R8Unorm,
        RenderAssetUsages::default(),
    );
    let map = image(&mut small, stripes);
    put(&mut small, wall(true), &ToonLight::default(), default());
    set_light(&mut small, &drawn_with(&map, 9.0));
    let found = covers(&mut small);
    let half = mean(&found);
    assert!((half - 0.5).abs() < 0.02, "{half}");
    // The map is drawn once over the whole view.
    let [ink, paper] = [20, 100].map(|row| found[row * SIZE.x as usize + 80]);
    assert!((ink > 0.99) != (paper > 0.99), "{ink}, {paper}");
    let other = image(&mut small, TonalArtMap::default().image());
    set_light(&mut small, &drawn_with(&other, 9.0));
    assert!(differ(&found, &covers(&mut small)) > found.len() / 4);
}
