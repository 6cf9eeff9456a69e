//! Shadows of the sun with a hard edge. The shipped functions read real shadow maps.

use bevy_comics_testkit::{
    device::gpu,
    reference::toon::lamp_shadow::{Cascade, Receiver, ShadowMap, Sun, hard_shadow},
};

use super::Numbers;
use crate::prelude::*;

/// Texels along the side of a map, and the depths in them, in steps of 1 / 65535.
const SIZE: u32 = 32;
const LEVELS: [u16; 4] = [13_107, 26_214, 39_321, 52_428];
/// The layer of the first cascade. The layers before it belong to other lights.
const BASE: usize = 1;
const CASCADES: usize = 2;
/// Where the cascades end, exact in both number formats.
const FAR: [f32; CASCADES] = [8.0, 24.0];

/// Of a row: position, normal, two steps, z in view space, biases along the normal and towards the
/// light; the direction to the light; how many cascades there are and how far they overlap.
const TO_LIGHT: usize = 15;
const COUNT: usize = 18;
const OVERLAP: usize = 19;
/// Of each cascade: its matrix, the size of a texel, and where it ends.
const CASCADE: usize = 20;
const CASCADE_SIZE: usize = 18;

type Row = [f32; CASCADE + CASCADES * CASCADE_SIZE];

/// Every name is that of the shipped WGSL.
const READ: &str = "#import bevy_comics::toon::lamp_shadow::{shadow_in_cascade, sun_shadow}
    #import bevy_comics::toon::surface::Surface
    #import bevy_pbr::mesh_view_bindings::lights
    fn v(n: u32) -> vec3<f32> { return vec3(i(n), i(n + 1u), i(n + 2u)); }
    fn column(n: u32) -> vec4<f32> { return vec4(v(n), i(n + 3u)); }
    fn read_cascade(k: u32) {
        let n = 20u + 18u * k;
        lights.directional_lights[0].cascades[k].clip_from_world =
            mat4x4(column(n), column(n + 4u), column(n + 8u), column(n + 12u));
        lights.directional_lights[0].cascades[k].texel_size = i(n + 16u);
        lights.directional_lights[0].cascades[k].far_bound = i(n + 17u);
    }
    fn read_sun() -> Surface {
        lights.directional_lights[0].shadow_normal_bias = i(13u);
        lights.directional_lights[0].shadow_depth_bias = i(14u);
        lights.directional_lights[0].direction_to_light = v(15u);
        lights.directional_lights[0].num_cascades = u(18u);
        lights.directional_lights[0].cascades_overlap_proportion = i(19u);
        lights.directional_lights[0].depth_texture_base_index = 1u;
        read_cascade(0u);
        read_cascade(1u);
        var s: Surface;
        s.position = v(0u);
        s.mesh_normal = v(3u);
        s.foot.position_x = v(6u);
        s.foot.position_y = v(9u);
        s.view_z = i(12u);
        return s;
    }";

/// Areas of equal depth, and scattered texels.
fn layers() -> Vec<Vec<u16>> {
    let mut n = Numbers::new(81);
    let mut layers = Vec::new();
    for _ in 0..BASE + CASCADES {
        let mut depth = LEVELS[0];
        let mut layer = Vec::new();
        for _ in 0..SIZE * SIZE {
            if n.once_in(3) {
                depth = LEVELS[(n.part() * 3.99) as usize];
            }
            layer.push(depth);
        }
        layers.push(layer);
    }
    layers
}

/// Towards a light, around a place, with reversed depth. `half`: of its width, height and depth.
fn clip_from_world(to_light: DVec3, turn: f64, around: DVec3, half: f64) -> DMat4 {
    let turned = DQuat::from_rotation_z(turn) * DQuat::from_rotation_arc(to_light, DVec3::Z);
    DMat4::from_translation(DVec3::new(0.0, 0.0, 0.5))
        * DMat4::from_scale(DVec3::new(1.0, 1.0, 0.5) / half)
        * DMat4::from_quat(turned)
        * DMat4::from_translation(-around)
}

fn random_row(n: &mut Numbers) -> Row {
    let position = [0; 3].map(|_| n.within(-5.0, 5.0));
    let to_light = n.unit();
    let halves = [n.within(6.0, 9.0), n.within(12.0, 18.0)];
    let texels = halves.map(|half| 2.0 * half / SIZE as f32);
    // Up to 1.5 texels; a surface that does not change has a hard shadow.
    let longest = if n.once_in(16) { 0.0 } else { 1.5 * texels[0] };
    let mut steps = [0.0; 6];
    for step in steps.chunks_mut(3) {
        let long = longest * n.part();
        step.copy_from_slice(&n.unit().map(|x| long * x));
    }
    // At the ends of cascades, where the second one begins to replace the first, and behind the eye.
    let distance = match (n.part() * 8.0) as u32 {
        0 => FAR[0],
        1 => 0.75 * FAR[0],
        2 => FAR[1],
        3 => -1.0,
        _ => n.within(0.0, 26.0),
    };
    let count = match (n.part() * 8.0) as u32 {
        0 => 0.0,
        1 => 1.0,
        _ => 2.0,
    };
    let overlap = if n.once_in(4) { 0.0 } else { 0.25 };
    let biases = [-distance, n.within(0.0, 2.0), n.within(0.0, 0.1)];
    let parts = [
        &position[..],
        &n.unit(),
        &steps,
        &biases,
        &to_light,
        &[count, overlap],
    ];
    let mut row = [0.0; CASCADE + CASCADES * CASCADE_SIZE];
    row[..CASCADE].copy_from_slice(&parts.concat());
    for k in 0..CASCADES {
        let offset = n.unit().map(f64::from);
        // Some places lie beside the map.
        let away = f64::from(1.2 * halves[k] * n.part());
        let around = DVec3::from_array(position.map(f64::from)) + away * DVec3::from_array(offset);
        let axis = DVec3::from_array(to_light.map(f64::from)).normalize();
        let turn = f64::from(n.within(0.0, 6.0));
        let matrix = clip_from_world(axis, turn, around, halves[k].into());
        let cascade = &mut row[CASCADE + k * CASCADE_SIZE..][..CASCADE_SIZE];
        cascade[..16].copy_from_slice(&matrix.to_cols_array().map(|x| x as f32));
        cascade[16..].copy_from_slice(&[texels[k], FAR[k]]);
    }
    row
}

fn vector(row: &Row, k: usize) -> DVec3 {
    DVec3::new(row[k].into(), row[k + 1].into(), row[k + 2].into())
}

fn receiver(row: &Row) -> Receiver {
    Receiver {
        position: vector(row, 0),
        normal: vector(row, 3),
        steps: [vector(row, 6), vector(row, 9)],
        distance: -f64::from(row[12]),
    }
}

/// The light of a row with all of its cascades.
fn whole_sun<'a>(row: &Row, maps: &'a [ShadowMap]) -> Sun<'a> {
    let cascade = |k: usize| {
        let numbers = &row[CASCADE + k * CASCADE_SIZE..][..CASCADE_SIZE];
        let matrix: [f64; 16] = std::array::from_fn(|i| numbers[i].into());
        Cascade {
            clip_from_world: DMat4::from_cols_array(&matrix),
            texel_size: numbers[16].into(),
            far: numbers[17].into(),
            map: &maps[BASE + k],
        }
    };
    Sun {
        to_light: vector(row, TO_LIGHT),
        normal_bias: row[13].into(),
        depth_bias: row[14].into(),
        overlap: row[OVERLAP].into(),
        cascades: (0..CASCADES).map(cascade).collect(),
    }
}

/// Whether a place is outside of its map.
fn is_beside(at: DVec3) -> bool {
    at.min_element() < 0.0 || at.max_element() > 1.0
}

/// Whether rounding decides nothing: not where the weights of texels have a corner, at a border of
/// the map, or at the depth of texels.
fn is_decided(sun: &Sun, r: &Receiver) -> bool {
    (0..CASCADES).all(|k| {
        let at = sun.place(k, r);
        let in_texel = |x: f64| (x * f64::from(SIZE) + 0.5).rem_euclid(1.0);
        let is_inside = |x: f64| (0.004..0.996).contains(&in_texel(x));
        let is_off = |x: f64, other: f64| (x - other).abs() > 1e-4;
        let borders = at
            .to_array()
            .iter()
            .all(|x| is_off(*x, 0.0) && is_off(*x, 1.0));
        let depths = LEVELS
            .iter()
            .all(|depth| is_off(at.z, f64::from(*depth) / 65535.0));
        is_inside(at.x) && is_inside(at.y) && borders && depths
    })
}

/// Places in maps are off by 7e-6 texels at most: ten roundings of numbers below 2.5, times half of
/// the 32 texels. Over a texel, a filtered shadow changes by up to two thirds along each axis, and
/// its slope by up to 4 / 9.
const SHADOW: f64 = 1e-5;
/// Two steps of up to 1.5 texels.
const CHANGE: f64 = 1e-5;

/// The darkest and the brightest hard shadow that rounding can make of a filtered one.
fn hard_ends([shadow, change]: [f64; 2]) -> [f64; 2] {
    let ends = [-SHADOW, SHADOW].map(|off| {
        let at = |change: f64| hard_shadow(shadow + off, change.max(0.0)).clamp(0.0, 1.0);
        [at(change - CHANGE), at(change + CHANGE)]
    });
    let ends = ends.as_flattened().iter().copied();
    [
        ends.clone().fold(1.0, f64::min) - 1e-5,
        ends.fold(0.0, f64::max) + 1e-5,
    ]
}

/// Each cascade, and the hard shadow of what they give together, also at the ends of cascades and
/// beyond the last one.
#[test]
fn shadows_of_the_sun_match_the_reference() {
    let layers = layers();
    let map = |layer: &Vec<u16>| ShadowMap {
        size: SIZE as usize,
        depths: (layer.iter())
            .map(|depth| f64::from(*depth) / 65535.0)
            .collect(),
    };
    let maps: Vec<ShadowMap> = layers.iter().map(map).collect();
    let mut n = Numbers::new(82);
    let random = std::iter::repeat_with(|| random_row(&mut n));
    let rows: Vec<Row> = random
        .filter(|row| is_decided(&whole_sun(row, &maps), &receiver(row)))
        .take(8192)
        .collect();
    let textures = gpu().shadow_maps(SIZE, &layers);
    let evaluate = |result: &str| {
        let body = format!("let s = read_sun(); return {result};");
        gpu().evaluate_shadows(&textures, READ, &body, &rows)
    };
    let each = evaluate("vec4(shadow_in_cascade(0u, 0u, s), shadow_in_cascade(0u, 1u, s))");
    let hard = evaluate("vec4(sun_shadow(0u, s))");
    let (mut beside, mut partly, mut blended, mut soft) = (0, 0, 0, 0);
    for (k, row) in rows.iter().enumerate() {
        let r = receiver(row);
        let mut sun = whole_sun(row, &maps);
        for index in 0..CASCADES {
            let reference = sun.shadow_in_cascade(index, &r);
            let found = [each[k][2 * index], each[k][2 * index + 1]].map(f64::from);
            let off = [0, 1].map(|i| (found[i] - reference[i]).abs());
            assert!(
                off[0] <= SHADOW && off[1] <= CHANGE,
                "cascade {index}, {row:?}: {found:?}, not {reference:?}"
            );
            beside += usize::from(is_beside(sun.place(index, &r)));
            partly += usize::from(reference[0] > 0.01 && reference[0] < 0.99);
        }
        sun.cascades.truncate(row[COUNT] as usize);
        let found = f64::from(hard[k][0]);
        let [low, high] = hard_ends(sun.blended(&r));
        let reference = sun.sun_shadow(&r);
        assert!(
            low <= found && found <= high,
            "{row:?}: {found}, not {reference}"
        );
        let is_last = sun.cascades.len() < 2;
        blended += usize::from(!is_last && (6.0..8.0).contains(&r.distance) && sun.overlap > 0.0);
        soft += usize::from(high - low < 0.05 && low > 0.05 && high < 0.95);
    }
    let seen = [beside, partly, blended, soft];
    assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
}
