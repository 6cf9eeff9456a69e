//! Shadows of the sun with a hard edge. The shipped functions read real shadow maps.

use bevy_comics_testkit::{
    device::gpu,
    reference::toon::light_shadow::{Cascade, Receiver, ShadowMap, Sun, hard_shadow},
};

use super::Numbers;
use crate::prelude::*;

/// Texels along the side of a map, and the depths in them, in steps of 1 / 65535.
const SIZE: u32 = 32;
const LEVELS: [u16; 4] = [13_107, 26_214, 39_321, 52_428];
/// The layer of the first cascade. The layers before it belong to other lights.
const BASE: usize = 1;
/// Half of the size of cascades, and where they end, exact in both number formats.
const HALVES: [f32; 2] = [7.5, 15.0];
const FAR: [f32; 2] = [8.0, 24.0];

/// Position, normal, two steps, and the distance from the camera.
type Row = [f32; 13];

/// Every name is that of the shipped WGSL.
const READ: &str = "#import bevy_comics::toon::light_shadow::{shadow_in_cascade, sun_shadow}
    #import bevy_comics::toon::surface::Surface
    #import bevy_pbr::mesh_view_bindings::lights
    fn v(n: u32) -> vec3<f32> { return vec3(i(n), i(n + 1u), i(n + 2u)); }
    fn receiver() -> Surface {
        var s: Surface;
        s.position = v(0u);
        s.mesh_normal = v(3u);
        s.foot.position_x = v(6u);
        s.foot.position_y = v(9u);
        s.view_z = -i(12u);
        return s;
    }";

/// Areas of equal depth, and scattered texels.
fn layers() -> Vec<Vec<u16>> {
    let mut n = Numbers::new(81);
    let mut depth = LEVELS[0];
    let mut texel = || {
        if n.once_in(3) {
            depth = LEVELS[(n.part() * 3.99) as usize];
        }
        depth
    };
    let layer = |_| (0..SIZE * SIZE).map(|_| texel()).collect();
    (0..BASE + 2).map(layer).collect()
}

fn unit(n: &mut Numbers) -> DVec3 {
    DVec3::from_array(n.unit().map(f64::from))
}

/// A sun whose numbers are exact in both number formats.
fn random_sun<'a>(n: &mut Numbers, count: usize, overlap: f64, maps: &'a [ShadowMap]) -> Sun<'a> {
    let to_light = unit(n);
    let cascade = |k: usize| {
        let half = f64::from(HALVES[k]);
        let turned = DQuat::from_rotation_z(f64::from(n.within(0.0, 6.0)))
            * DQuat::from_rotation_arc(to_light.normalize(), DVec3::Z);
        // Towards the light, with reversed depth.
        let matrix = DMat4::from_translation(DVec3::new(0.0, 0.0, 0.5))
            * DMat4::from_scale(DVec3::new(1.0, 1.0, 0.5) / half)
            * DMat4::from_quat(turned)
            * DMat4::from_translation(half * f64::from(n.within(0.0, 0.3)) * unit(n));
        Cascade {
            clip_from_world: matrix.as_mat4().as_dmat4(),
            texel_size: 2.0 * half / f64::from(SIZE),
            far: FAR[k].into(),
            map: &maps[BASE + k],
        }
    };
    let cascades = (0..count).map(cascade).collect();
    Sun {
        to_light,
        normal_bias: n.within(0.0, 2.0).into(),
        depth_bias: n.within(0.0, 0.1).into(),
        overlap,
        cascades,
    }
}

/// Sets the sun of the engine.
fn text_of(sun: &Sun) -> String {
    let DVec3 { x, y, z } = sun.to_light;
    let mut text = format!(
        "let sun = &lights.directional_lights[0];
         (*sun).shadow_normal_bias = {:?};
         (*sun).shadow_depth_bias = {:?};
         (*sun).direction_to_light = vec3({x:?}, {y:?}, {z:?});
         (*sun).num_cascades = {}u;
         (*sun).cascades_overlap_proportion = {:?};
         (*sun).depth_texture_base_index = {BASE}u;\n",
        sun.normal_bias,
        sun.depth_bias,
        sun.cascades.len(),
        sun.overlap
    );
    for (k, cascade) in sun.cascades.iter().enumerate() {
        let matrix = cascade.clip_from_world.to_cols_array();
        let matrix = matrix.map(|number| format!("{number:?}")).join(", ");
        text += &format!(
            "(*sun).cascades[{k}].clip_from_world = mat4x4<f32>({matrix});
             (*sun).cascades[{k}].texel_size = {:?};
             (*sun).cascades[{k}].far_bound = {:?};\n",
            cascade.texel_size, cascade.far
        );
    }
    text
}

fn random_row(n: &mut Numbers) -> Row {
    // Up to 1.5 texels; a surface that does not change has a hard shadow.
    let longest = if n.once_in(16) {
        0.0
    } else {
        3.0 * HALVES[0] / SIZE as f32
    };
    let mut step = || n.unit().map(|x| longest * n.part() * x);
    let steps = [step(), step()];
    // At the ends of cascades, where the second one begins to replace the first, and behind the
    // eye.
    let distance = match (n.part() * 8.0) as u32 {
        0 => FAR[0],
        1 => 0.75 * FAR[0],
        2 => FAR[1],
        3 => -1.0,
        _ => n.within(0.0, 26.0),
    };
    // Some places lie beside the map.
    let position = [0; 3].map(|_| n.within(-6.0, 6.0));
    let row = [&position[..], &n.unit(), steps.as_flattened(), &[distance]].concat();
    Row::try_from(row).expect("13 numbers")
}

fn receiver(row: &Row) -> Receiver {
    let vector = |k: usize| DVec3::new(row[k].into(), row[k + 1].into(), row[k + 2].into());
    Receiver {
        position: vector(0),
        normal: vector(3),
        steps: [vector(6), vector(9)],
        distance: row[12].into(),
    }
}

/// Whether a place is outside of its map.
fn is_beside(at: DVec3) -> bool {
    at.min_element() < 0.0 || at.max_element() > 1.0
}

/// Whether rounding decides nothing: not where the weights of texels have a corner, at a border of
/// the map, or at the depth of texels.
fn is_decided(sun: &Sun, r: &Receiver) -> bool {
    (0..sun.cascades.len()).all(|k| {
        let at = sun.place(k, r);
        let in_texel = |x: f64| (x * f64::from(SIZE) + 0.5).rem_euclid(1.0);
        let is_inside = |x: f64| (0.004..0.996).contains(&in_texel(x));
        let is_off = |x: f64, other: f64| (x - other).abs() > 1e-4;
        let mut places = at.to_array().into_iter();
        let mut depths = LEVELS.iter().map(|depth| f64::from(*depth) / 65535.0);
        is_inside(at.x)
            && is_inside(at.y)
            && places.all(|x| is_off(x, 0.0) && is_off(x, 1.0))
            && depths.all(|depth| is_off(at.z, depth))
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
    let textures = gpu().shadow_maps(SIZE, &layers);
    let mut n = Numbers::new(82);
    let (mut beside, mut partly, mut blended, mut soft) = (0, 0, 0, 0);
    for (count, overlap) in [(2, 0.25), (2, 0.25), (2, 0.0), (1, 0.25), (0, 0.25)] {
        let sun = random_sun(&mut n, count, overlap, &maps);
        let random = std::iter::repeat_with(|| random_row(&mut n));
        let rows: Vec<Row> = random
            .filter(|row| is_decided(&sun, &receiver(row)))
            .take(2048)
            .collect();
        let evaluate = |result: &str| {
            let body = format!("{} let s = receiver(); return {result};", text_of(&sun));
            gpu().evaluate_shadows(&textures, READ, &body, &rows)
        };
        let each = evaluate("vec4(shadow_in_cascade(0u, 0u, s), shadow_in_cascade(0u, 1u, s))");
        let hard = evaluate("vec4(sun_shadow(0u, s))");
        for (k, row) in rows.iter().enumerate() {
            let r = receiver(row);
            for index in 0..count {
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
            let found = f64::from(hard[k][0]);
            let [low, high] = hard_ends(sun.blended(&r));
            assert!(
                low <= found && found <= high,
                "{row:?}: {found}, not {low} to {high}"
            );
            let is_between = count == 2 && overlap > 0.0 && (6.0..8.0).contains(&r.distance);
            blended += usize::from(is_between);
            soft += usize::from(high - low < 0.05 && low > 0.05 && high < 0.95);
        }
    }
    let seen = [beside, partly, blended, soft];
    assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
}
