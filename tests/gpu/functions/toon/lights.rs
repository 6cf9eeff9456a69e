//! What arrives of the engine's light sources, and of light from all around.

use bevy::math::DVec4;
use bevy_comics_testkit::{
    device::gpu,
    reference::{
        ribbon,
        toon::{
            light_textures,
            lights::{self, Cone, Lamp, RectLamp},
            surface::{Surface, pixel_size},
        },
    },
};

use super::{Numbers, READ};
use crate::prelude::*;

/// A surface as in `super::READ`, then 32 numbers.
const LAMP_ROW: usize = super::SETTINGS + 32;

type LampRow = [f32; LAMP_ROW];

const LAMP: &str =
    "#import bevy_comics::toon::lights::{clustered_light, directional_light_through, rect_light_at}
    #import bevy_pbr::mesh_view_bindings::{clustered_lights, lights, atmosphere}
    #import bevy_pbr::shadows::border
    fn read_lamp() {
        view.exposure = i(92u);
        toon.light.falloff = i(93u);
        clustered_lights.data[0].position_radius = vec4(v(94u), 0.0);
        clustered_lights.data[0].color_inverse_square_range = vec4(v(97u), i(100u));
        // As the engine packs spot lights.
        clustered_lights.data[0].light_custom_data = vec4(i(101u), i(103u), i(104u), i(105u));
        clustered_lights.data[0].flags = u(106u);
        clustered_lights.data[0].shadow_map_near_z = 0.1;
        border = vec4(v(107u), i(110u));
    }";

/// A lamp at 0.3 to 12 units.
fn lamp_rows(count: usize, seed: u64) -> Vec<LampRow> {
    let mut n = Numbers::new(seed);
    let surfaces = super::rows(count, seed);
    let row = |surface: &super::Row| {
        let mut row = [0.0; LAMP_ROW];
        row[super::SURFACE..super::SETTINGS]
            .copy_from_slice(&surface[super::SURFACE..super::SETTINGS]);
        let offset = n.unit().map(|x| x * 0.3 * 40f32.powf(n.part()));
        let at: Vec<f32> = (0..3).map(|k| row[79 + k] + offset[k]).collect();
        let axis = n.unit();
        let outer = n.within(0.2, 0.9);
        let inner = outer + n.within(0.05, 0.09);
        let scale = 1.0 / (inner - outer);
        let color = 10f32.powf(n.within(-2.0, 3.0));
        let range = if n.once_in(4) {
            0.0
        } else {
            n.within(1.0, 15.0)
        };
        let per_range = if range > 0.0 { range.powi(-2) } else { 0.0 };
        let negative = if axis[1] < 0.0 { 2.0 } else { 0.0 };
        let shadows = if n.once_in(2) { 1.0 } else { 0.0 };
        let baked = if n.once_in(2) { 8.0 } else { 0.0 };
        let border = n.unit();
        let place: f32 = (0..3).map(|k| row[79 + k] * border[k]).sum();
        row[92..].copy_from_slice(
            &[
                &[
                    n.within(0.2, 2.0),
                    if n.once_in(3) {
                        0.0
                    } else {
                        n.within(0.25, 4.0)
                    },
                ][..],
                &at,
                &[color * n.part(), color * n.part(), color, per_range],
                &[axis[0], axis[1], axis[2], scale, -outer * scale],
                &[negative + shadows + baked],
                // The border of the shadow is near the surface.
                &border,
                &[0.5 - place + n.within(-0.6, 0.6) * n.part()],
                &[inner, outer, range],
                &[0.0; 10],
            ]
            .concat(),
        );
        row
    };
    surfaces.iter().map(row).collect()
}

fn surface_of(row: &LampRow) -> Surface {
    let mut all = [0.0; super::ROW];
    all[..LAMP_ROW].copy_from_slice(row);
    super::surface(&all)
}

fn three(row: &LampRow, k: usize) -> DVec3 {
    DVec3::new(row[k].into(), row[k + 1].into(), row[k + 2].into())
}

/// A light, its colours, and what is left of it, in three calls.
fn arriving(definitions: &[Definition], call: &str, rows: &[LampRow]) -> Vec<[[f32; 4]; 4]> {
    let import = format!("{READ}{LAMP}");
    let of = |what: &str| {
        let body = format!("read_lamp(); let l = {call}; return {what};");
        gpu().evaluate_alone(definitions, &import, &body, rows)
    };
    let parts = [
        of("vec4(l.color, l.lit)"),
        of("vec4(l.smooth_color, l.diffuse)"),
        of("vec4(l.to_light, l.per_distance)"),
        of("vec4(l.to_highlight, l.shine)"),
    ];
    (0..rows.len())
        .map(|k| parts.each_ref().map(|part| part[k]))
        .collect()
}

fn assert_near(row: &LampRow, what: &str, found: [f32; 4], reference: DVec3, tolerance: f64) {
    for (found, reference) in found.into_iter().zip(reference.to_array()) {
        let off = (f64::from(found) - reference).abs();
        assert!(
            off <= tolerance,
            "{what} of {row:?}: {found}, not {reference} within {tolerance}"
        );
    }
}

/// Point lights and spot lights: rings, cones and shadows.
#[test]
fn lamps_match_the_reference() {
    for (is_spot, has_lightmap) in [(false, false), (true, false), (false, true)] {
        let definitions: &[Definition] = if has_lightmap {
            &[("LIGHTMAP", None)]
        } else {
            &[]
        };
        let rows = lamp_rows(4096, 70);
        let call = format!("clustered_light(0u, {is_spot}, surface(), toon.light)");
        let (mut wide, mut shadowed) = (0, 0);
        for (row, found) in rows.iter().zip(arriving(definitions, &call, &rows)) {
            let s = surface_of(row);
            let axis = three(row, 101);
            let [inner, outer, range] = [111, 112, 113].map(|k| f64::from(row[k]));
            let lamp = Lamp {
                at: three(row, 94),
                color: three(row, 97),
                range,
                cone: is_spot.then_some(Cone { axis, inner, outer }),
            };
            let light = ToonLight {
                falloff: row[93],
                ..ToonLight::default()
            };
            let exposure = f64::from(row[92]);
            let at = |lamp: &Lamp| lights::clustered_light(&light, &s, lamp, exposure);
            let reference = at(&lamp);
            // Rings are hard: a change of the distance by rounding moves their borders.
            let offset = lamp.at - s.position;
            let moved = |by: f64| {
                at(&Lamp {
                    at: s.position + offset * (1.0 + by),
                    ..lamp
                })
            };
            let ring = (moved(1e-5).color - moved(-1e-5).color).abs().max_element();
            // The y of a spot light's axis is a root, and cancels where it is small.
            let scale = 1.0 / (inner - outer);
            let pixel = pixel_size(&s.foot) * reference.per_distance * scale;
            let inside = scale * (1e-6 + 3e-7 / axis.y.abs().max(1e-3));
            let doubt = match is_spot {
                true => (1.5 * inside / pixel.max(2e-5)).min(1.0),
                false => 0.0,
            };
            let whole = lights::clustered_light(&light, &s, &Lamp { cone: None, ..lamp }, exposure);
            let slack = |all: DVec3| (doubt + 2e-4) * all.max_element();
            assert_near(
                row,
                "color",
                found[0],
                reference.color,
                slack(whole.color) + 2.0 * ring,
            );
            let smooth = slack(whole.smooth_color)
                + (moved(1e-5).smooth_color - moved(-1e-5).smooth_color)
                    .abs()
                    .max_element();
            assert_near(
                row,
                "smooth_color",
                found[1],
                reference.smooth_color,
                smooth,
            );
            assert_near(row, "to_light", found[2], reference.to_light, 2e-5);
            assert_near(row, "to_highlight", found[3], reference.to_light, 2e-5);
            let off = (f64::from(found[2][3]) - reference.per_distance).abs();
            assert!(off <= 1e-5 * reference.per_distance, "{row:?}");
            assert_eq!(found[3][3], 1.0);
            let flags = row[106] as u32;
            let diffuse = if has_lightmap && flags & 8 == 0 {
                0.0
            } else {
                1.0
            };
            assert_eq!(found[1][3], diffuse, "{row:?}");
            let near = if is_spot { 0.1 } else { 0.0 };
            let filtered =
                |at: DVec3| (three(row, 107).dot(at) + f64::from(row[110]) + near).clamp(0.0, 1.0);
            let here = filtered(s.position);
            let change: f64 = (s.foot.position.iter())
                .map(|step| (filtered(s.position + *step) - here).abs())
                .sum();
            let lit = match flags & 1 == 1 {
                true => lights::hard_shadow(here, change),
                false => 1.0,
            };
            let slack = (1.5 * 3e-6 / change.max(2e-5)).min(1.0);
            let off = (f64::from(found[0][3]) - lit).abs();
            // Beside the soft border, rounding may decide whether it is there at all.
            let is_border = here.min(1.0 - here) < 3e-6;
            assert!(
                off <= slack || is_border,
                "{row:?}: {}, not {lit}",
                found[0][3]
            );
            wide += usize::from(reference.color.max_element() > 0.0 && doubt < 0.05);
            shadowed += usize::from(lit > 0.0 && lit < 1.0 && slack < 0.05);
        }
        assert!(wide > 400 && shadowed > 20, "{wide}, {shadowed}");
    }
}

/// A surface that touches a lamp: nothing is not a number.
#[test]
fn lamps_at_the_surface_are_finite() {
    let mut rows = lamp_rows(256, 71);
    for row in &mut rows {
        row.copy_within(79..82, 94);
    }
    for is_spot in [false, true] {
        let call = format!("clustered_light(0u, {is_spot}, surface(), toon.light)");
        for (row, found) in rows.iter().zip(arriving(&[], &call, &rows)) {
            assert!(
                found.iter().flatten().all(|x| x.is_finite()),
                "{row:?}: {found:?}"
            );
        }
    }
}

/// Directional lights, through the air if there is an atmosphere.
#[test]
fn directional_lights_match_the_reference() {
    let setup = "lights.directional_lights[0].color = vec4(v(97u), 1.0);
         lights.directional_lights[0].direction_to_light = v(101u);
         lights.directional_lights[0].sun_disk_angular_size = 0.5;
         lights.directional_lights[0].flags = u(106u) / 2u;
         atmosphere.inner_radius = 3.0;
         atmosphere.world_to_atmosphere = mat4x4(vec4(1.0, 0.0, 0.0, 0.0), vec4(0.0, 1.0, 0.0, 0.0),
             vec4(0.0, 0.0, 1.0, 0.0), vec4(0.5, 1.0, 0.0, 1.0));";
    let import = format!("{READ}{LAMP} fn sun() {{ {setup} }}");
    for definitions in [&[][..], &[("ATMOSPHERE", None)], &[("LIGHTMAP", None)]] {
        let rows = lamp_rows(2048, 72);
        let of = |what: &str| {
            let body = format!(
                "read_lamp(); sun();
                 let l = directional_light_through(0u, surface(), i(111u)); return {what};"
            );
            gpu().evaluate_alone(definitions, &import, &body, &rows)
        };
        let (light, rest) = (
            of("vec4(l.color, l.lit)"),
            of("vec4(l.to_light, l.diffuse)"),
        );
        let smooth = of("vec4(l.smooth_color, l.per_distance)");
        for (k, row) in rows.iter().enumerate() {
            let mut color = three(row, 97);
            let to_light = three(row, 101);
            if definitions == [("ATMOSPHERE", None)] {
                let at = three(row, 79) + DVec3::new(0.5, 1.0, 0.0);
                let place = at * (3.0 / at.length()).max(1.0);
                let height = to_light.dot(place.normalize());
                let through = DVec3::new(1.0, 0.5 + 0.5 * height, 1.0 / (1.0 + place.length()));
                color *= through * (0.5 + height / 0.5).clamp(0.0, 1.0);
            }
            let slack = 2e-6 * three(row, 97).max_element();
            assert_near(row, "color", light[k], color, slack);
            assert_near(row, "smooth_color", smooth[k], color, slack);
            assert_near(row, "to_light", rest[k], to_light, 0.0);
            assert_eq!((light[k][3], smooth[k][3]), (row[111], 0.0));
            let is_baked = definitions == [("LIGHTMAP", None)] && (row[106] as u32 / 2) & 4 == 0;
            assert_eq!(rest[k][3], if is_baked { 0.0 } else { 1.0 }, "{row:?}");
        }
    }
}

/// Rectangles, in front and behind.
#[test]
fn rect_lights_match_the_reference() {
    let setup = "lights.rect_lights[0].color = vec4(v(97u), 1.0);
         lights.rect_lights[0].position = v(94u);
         lights.rect_lights[0].right = v(101u);
         lights.rect_lights[0].up = v(104u);
         lights.rect_lights[0].width = i(107u);
         lights.rect_lights[0].height = i(108u);
         lights.rect_lights[0].range = i(109u);";
    let mut n = Numbers::new(73);
    let mut rows = lamp_rows(300, 73);
    for row in &mut rows {
        let right = DVec3::from_array(n.unit().map(f64::from));
        let up = DVec3::from_array(n.unit().map(f64::from))
            .reject_from(right)
            .normalize();
        let [a, b] = [right, up].map(|v| v.as_vec3().to_array());
        row[101..104].copy_from_slice(&a);
        row[104..107].copy_from_slice(&b);
        row[107..110].copy_from_slice(&[
            n.within(0.1, 0.4),
            n.within(0.1, 0.4),
            n.within(4.0, 20.0),
        ]);
        row[93] = 0.0;
    }
    let import = format!("{READ}{LAMP} fn rect() {{ {setup} }}");
    let of = |what: &str| {
        let body = format!(
            "read_lamp(); rect();
             let l = rect_light_at(0u, surface(), toon.light); return {what};"
        );
        gpu().evaluate_alone(&[], &import, &body, &rows)
    };
    let (color, to) = (of("vec4(l.color, l.lit)"), of("vec4(l.to_light, l.shine)"));
    let shown = of("vec4(l.to_highlight, l.per_distance)");
    let mut lit = 0;
    for (k, row) in rows.iter().enumerate() {
        let s = surface_of(row);
        let lamp = RectLamp {
            at: three(row, 94),
            color: three(row, 97),
            right: three(row, 101),
            up: three(row, 104),
            size: [row[107].into(), row[108].into()],
            range: row[109].into(),
        };
        let reference = lights::rect_light_at(&s, &lamp, 64);
        let at = s.position - lamp.at;
        let height = lamp.up.cross(lamp.right).dot(at);
        if height.abs() < 0.05 * at.length() {
            continue;
        }
        assert_eq!(f64::from(to[k][3]), reference.shine, "{row:?}");
        if reference.shine == 0.0 {
            assert_eq!(color[k], [0.0, 0.0, 0.0, 1.0], "{row:?}");
            continue;
        }
        // The sum: its cells are at most a fortieth of the distance. Far away, what cancels in
        // Lambert's formula is 1e-7 of the squared distance over the area.
        let small = 3e-7 * at.length_squared() / f64::from(row[107] * row[108]);
        let slack = 1e-3 + 4.0 * small;
        let most = reference.color.max_element();
        assert_near(row, "color", color[k], reference.color, slack * most);
        assert_near(row, "to_light", to[k], reference.to_light, slack);
        lit += 1;
        // A mirror that runs along the rectangle shows its border, and which one is not decided.
        let mirrored = 2.0 * s.normal.dot(s.to_eye) * s.normal - s.to_eye;
        let speed = lamp.up.cross(lamp.right).dot(mirrored).abs();
        if speed > 0.05 {
            assert_near(row, "to_highlight", shown[k], reference.to_highlight, 2e-4);
            let off = (f64::from(shown[k][3]) - reference.per_distance).abs();
            assert!(off < 2e-4 * reference.per_distance, "{row:?}");
        }
    }
    assert!(lit > 80, "{lit}");
}

/// Where lights read their pictures.
#[test]
fn places_in_light_textures_match_the_reference() {
    let import = "#import bevy_comics::toon::light_textures::{directional_uv, is_beside, spot_uv}";
    let body = "let at = vec3(i(0u), i(1u), i(2u));
         let uv = directional_uv(at);
         return vec4(spot_uv(at, i(3u)), uv.x, select(uv.y, 9.0, is_beside(uv)));";
    let mut n = Numbers::new(75);
    let rows: Vec<[f32; 4]> = (0..2048)
        .map(|_| {
            [
                n.within(-1.5, 1.5),
                n.within(-1.5, 1.5),
                -n.within(0.1, 20.0),
                n.within(0.05, 3.0),
            ]
        })
        .collect();
    for (row, found) in rows
        .iter()
        .zip(gpu().evaluate_alone(&[], import, body, &rows))
    {
        let at = DVec3::new(row[0].into(), row[1].into(), row[2].into());
        let spot = light_textures::spot_uv(at, row[3].into());
        let flat = light_textures::directional_uv(at);
        let beside = flat.min_element() < 0.0 || flat.max_element() > 1.0;
        let references = [spot.x, spot.y, flat.x, if beside { 9.0 } else { flat.y }];
        for (found, reference) in found.into_iter().zip(references) {
            let off = (f64::from(found) - reference).abs();
            assert!(
                off <= 1e-6 * reference.abs().max(1.0),
                "{row:?}: {found}, not {reference}"
            );
        }
    }
    // The axis of a spot light is the middle of its picture, the border of its cone a border.
    assert_eq!(
        light_textures::spot_uv(DVec3::NEG_Z, 0.7),
        DVec2::splat(0.5)
    );
    assert_eq!(
        light_textures::spot_uv(DVec3::new(0.7, 0.0, -1.0), 0.7).x,
        1.0
    );
}

/// Ribbons along paths: direction, width and what they cover.
#[test]
fn ribbons_match_the_reference() {
    let import =
        "#import bevy_comics::motion_lines::ribbon::{coverage, direction_on_screen, moved_across}
        fn clip(n: u32) -> vec4<f32> { return vec4(i(n), i(n + 1u), i(n + 2u), i(n + 3u)); }";
    let body = "let size = vec2(i(8u), i(9u));
         let along = direction_on_screen(clip(0u), clip(4u), size);
         let moved = moved_across(clip(0u), along, i(10u), size);
         return vec4(moved.xy, dot(along, along), coverage(i(10u), i(11u)));";
    let mut n = Numbers::new(76);
    let rows: Vec<[f32; 12]> = (0..4096)
        .map(|_| {
            let w = 10f32.powf(n.within(-2.0, 3.0));
            let at = [0; 3].map(|_| w * n.within(-1.2, 1.2));
            let mut step = [0; 3].map(|_| w * n.within(-0.02, 0.02));
            if n.once_in(20) {
                step = [0.0; 3];
            }
            let mut row = [
                at[0], at[1], at[2], w, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
            ];
            for k in 0..3 {
                row[4 + k] = at[k] + step[k];
            }
            row[7] = w * n.within(0.99, 1.01);
            row[8..].copy_from_slice(&[
                n.within(16.0, 4000.0),
                n.within(16.0, 4000.0),
                n.within(-12.0, 12.0),
                n.within(0.0, 8.0),
            ]);
            if n.once_in(20) {
                row[7] = 0.0;
            }
            row
        })
        .collect();
    for (row, found) in rows.iter().zip(gpu().evaluate(import, body, &rows)) {
        assert!(found.iter().all(|x| x.is_finite()), "{row:?}: {found:?}");
        let of = |k: usize| {
            DVec4::new(
                row[k].into(),
                row[k + 1].into(),
                row[k + 2].into(),
                row[k + 3].into(),
            )
        };
        let size = DVec2::new(row[8].into(), row[9].into());
        let (across, half_width) = (f64::from(row[10]), f64::from(row[11]));
        let cover = ribbon::coverage(across, half_width);
        assert!(
            (f64::from(found[3]) - cover).abs() < 3e-6,
            "{row:?}: {}, not {cover}",
            found[3]
        );
        assert!((found[2] - 1.0).abs() < 1e-4, "{row:?}: {found:?}");
        if row[7] == 0.0 {
            continue;
        }
        let along = ribbon::direction_on_screen(of(0), of(4), size);
        let [here, there] = [of(0), of(4)].map(|at| ribbon::on_screen(at, size));
        let length = here.distance(there);
        if length > 0.0 && length < 1e-2 {
            continue;
        }
        let wanted = here + along.perp() * across;
        let moved = DVec4::new(found[0].into(), found[1].into(), 0.0, row[3].into());
        // Rounding of both places turns the direction.
        let turn = if length > 0.0 {
            4e-7 * size.max_element() / length
        } else {
            0.0
        };
        let slack = across.abs() * (turn + 1e-5) + 4e-7 * size.max_element();
        let off = ribbon::on_screen(moved, size).distance(wanted);
        assert!(off <= slack, "{row:?}: {off} pixels, {slack}");
    }
}
