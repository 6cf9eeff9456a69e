//! Strokes of tonal art maps on the toon material: `art_map.wgsl`, `stroke_level.wgsl`.

use bevy_comics::toon::TonalArtMap;

use crate::{
    hatched_material::{
        SIZE, WhiteRoom, ball, covers, frames, light_from, plain, tone, turned, wall, with,
    },
    hatching::{differ, least_and_most},
    line_scenes::mean,
    prelude::*,
    ramp::{put, room, set_light},
};

fn image(small: &mut Small, image: Image) -> Handle<Image> {
    small.world().resource_mut::<Assets<Image>>().add(image)
}

/// The default map.
fn default_map(small: &mut Small) -> Handle<Image> {
    image(small, TonalArtMap::default().image())
}

fn drawn_with(map: &Handle<Image>, repeat: f32, s: Hatching) -> ToonLight {
    ToonLight {
        art_map: Some(map.clone()),
        art_map_repeat: repeat,
        ..with(s)
    }
}

/// A mesh with its texture coordinates or without.
fn mapped(mut mesh: Mesh, has_uvs: bool) -> Mesh {
    if !has_uvs {
        mesh.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    }
    mesh
}

/// A room in which a quarter of the light arrives at what faces the eye.
fn dim() -> Small {
    let mut small = room(SIZE, 0.2);
    light_from(&mut small, -Vec3::Z, 0.6);
    small
}

/// Truth: maps have the tone of the light at every size and angle, on texture coordinates and on
/// planes.
#[test]
fn flat_walls_have_the_tone_of_their_light() {
    let walls: &[(f32, &[f32])] = &[(0.0, &[0.5, 60.0]), (50.0, &[1.6]), (75.0, &[1.0, 8.0])];
    // They take turns over five sizes: on planes, each has the other gamma.
    walls_have_the_tone_of_their_light(walls, &[&[0.5], &[2.5]]);
}

#[test]
#[ignore = "long: every size at every angle"]
fn flat_walls_have_the_tone_of_their_light_at_every_size() {
    let repeats = &[0.5, 1.0, 1.6, 3.0, 8.0, 60.0][..];
    let walls = [0.0, 50.0, 75.0].map(|degrees| (degrees, repeats));
    walls_have_the_tone_of_their_light(&walls, &[&[0.5, 2.5]]);
}

/// `walls`: degrees, and how often each map is seen. `gammas`: those of each size in turn.
fn walls_have_the_tone_of_their_light(walls: &[(f32, &[f32])], gammas: &[&[f32]]) {
    let mut small = dim();
    let mut gammas = gammas.iter().cycle();
    let map = default_map(&mut small);
    for (has_uvs, scale) in [(true, 9.0), (false, 0.5)] {
        for &(degrees, sizes) in walls {
            small.clear();
            light_from(&mut small, -Vec3::Z, 0.6);
            let at = Transform::from_rotation(turned(degrees));
            let mesh = mapped(wall(), has_uvs);
            put(&mut small, mesh, &ToonLight::default(), at);
            // The view shows 2 of 18 units: from half a repeat of the map to 60 of them.
            for &repeats in sizes {
                for &gamma in *gammas.next().expect("some") {
                    let s = Hatching { gamma, ..plain() };
                    set_light(&mut small, &drawn_with(&map, scale * repeats, s));
                    let (got, want) = (mean(&covers(&mut small)), tone(&s, 0.25));
                    // Less than a whole map is seen: it is not equally dark everywhere.
                    let whole = if repeats < 1.0 { 0.5 } else { 1.0 };
                    let off = (got - want).abs() * whole;
                    let what = format!("uvs {has_uvs}, {degrees} degrees, {repeats} repeats");
                    assert!(off < 0.03, "{what}: {got}, {want}");
                }
            }
        }
    }
}

/// Strokes of a map are ink and paper, not gray, and stay about as wide while things come nearer.
#[test]
fn strokes_of_maps_have_their_width_at_every_size() {
    let mut small = dim();
    let map = TonalArtMap {
        crossing: 1.0,
        spread: 0.0,
        ..default()
    };
    let map = image(&mut small, map.image());
    put(&mut small, wall(), &ToonLight::default(), default());
    // Two octaves.
    let edges = [0.0f64, 1.0, 2.0, 3.0, 4.0, 5.0].map(|k| {
        let repeats = (k / 2.5).exp2() as f32;
        set_light(&mut small, &drawn_with(&map, 9.0 * repeats, plain()));
        let found = covers(&mut small);
        // Ink that begins or ends from row to row, for each row.
        let below = &found[SIZE.x as usize..];
        let steps = found.iter().zip(below).map(|(a, b)| (a - b).abs());
        steps.sum::<f64>() / found.len() as f64
    });
    let [low, high] = least_and_most(&edges);
    // Texels are 0.7 to 1.4 pixels, and two levels are mixed between.
    assert!(high < 2.0 * low, "{edges:?}");
}

/// Truth: strokes of maps stay on what moves, with texture coordinates and without.
#[test]
fn strokes_of_maps_stay_on_what_moves() {
    let mut room = WhiteRoom::new();
    let light = drawn_with(&default_map(&mut room.small), 3.0, plain());
    for has_uvs in [true, false] {
        let mesh = mapped(ball(), has_uvs);
        let object = put(&mut room.small, mesh, &light, Transform::IDENTITY);
        let still = room.still();
        room.assert_stays(&still, frames(), |world, frame| {
            world.entity_mut(object).insert(frame);
        });
        room.small.world().despawn(object);
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
    let usage = RenderAssetUsages::default();
    let stripes = Image::new(
        size,
        TextureDimension::D2,
        rows,
        TextureFormat::R8Unorm,
        usage,
    );
    let map = image(&mut small, stripes);
    put(&mut small, wall(), &ToonLight::default(), default());
    set_light(&mut small, &drawn_with(&map, 9.0, plain()));
    let found = covers(&mut small);
    let half = mean(&found);
    assert!((half - 0.5).abs() < 0.02, "{half}");
    // The map is drawn once over the whole view.
    let [ink, paper] = [20, 100].map(|row| found[row * SIZE.x as usize + 80]);
    assert!((ink > 0.99) != (paper > 0.99), "{ink}, {paper}");
    let other = default_map(&mut small);
    set_light(&mut small, &drawn_with(&other, 9.0, plain()));
    assert!(differ(&found, &covers(&mut small), 2.0 / 255.0) > found.len() / 4);
}
