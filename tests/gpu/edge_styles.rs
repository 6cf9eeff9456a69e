//! Convex and concave creases with styles of their own.

use std::f32::consts::{FRAC_PI_2, TAU};

use bevy::mesh::PrimitiveTopology;
use bevy_comics::lines::{CreaseSource, EdgeColor, EdgeStyle};
use bevy_comics_testkit::reference::color::{linear_to_oklab, oklab_to_linear};

use image::RgbaImage;

use crate::{line_scenes::alike, prelude::*, sections, walls::unit_per_pixel};

const SIZE: UVec2 = UVec2::new(160, 120);
const CONVEX: Color = Color::srgb(1.0, 0.0, 0.0);
const CONCAVE: Color = Color::srgb(0.0, 0.0, 1.0);

fn ink(color: Color) -> Option<EdgeStyle> {
    Some(EdgeStyle {
        color: EdgeColor::Ink { color },
        ..default()
    })
}

/// Red convex creases, blue concave ones, and silhouettes and edges between objects in black.
fn signs(source: CreaseSource) -> Outlines {
    Outlines {
        creases: Some(Creases {
            source,
            convex: ink(CONVEX),
            concave: ink(CONCAVE),
            ..default()
        }),
        ..default()
    }
}

/// The pixels that are mostly red, and mostly blue.
fn counted(picture: &RgbaImage) -> [usize; 2] {
    let more = |a: u8, b: u8| i32::from(a) > i32::from(b) + 60;
    [[0, 2], [2, 0]].map(|[own, other]| {
        let is = |p: &&image::Rgba<u8>| more(p.0[own], p.0[other]) && more(p.0[own], p.0[1]);
        picture.pixels().filter(is).count()
    })
}

/// A prism with flat sides, 2 units high. `inside`: its faces are seen from inside.
fn prism(sides: u32, inside: bool) -> Mesh {
    let ring = |y: f32| {
        (0..sides).map(move |i| {
            let angle = TAU * (i as f32 + 0.5) / sides as f32;
            Vec3::new(angle.cos(), y, angle.sin())
        })
    };
    let [top, bottom] = [1.0, -1.0].map(|y| ring(y).collect::<Vec<_>>());
    let mut corners = Vec::new();
    for i in 0..sides as usize {
        let next = (i + 1) % sides as usize;
        corners.extend([
            bottom[i],
            top[i],
            top[next],
            bottom[i],
            top[next],
            bottom[next],
        ]);
        corners.extend([Vec3::Y, top[next], top[i]]);
        corners.extend([Vec3::NEG_Y, bottom[i], bottom[next]]);
    }
    if inside {
        corners
            .chunks_exact_mut(3)
            .for_each(|corner| corner.swap(1, 2));
    }
    Mesh::new(PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, corners)
        .with_computed_flat_normals()
}

/// A direction of 64 that are spread evenly.
fn turned(i: u32) -> Quat {
    let i = i as f32;
    Quat::from_euler(
        EulerRot::XYZ,
        2.39996 * i,
        FRAC_PI_2 * (i / 32.0 - 1.0),
        0.7 * i,
    )
}

/// The corners of a prism in the picture.
fn projected(mesh: &Mesh, at: Transform, fov: f32) -> Vec<Vec2> {
    let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
    let positions = positions.and_then(|values| values.as_float3());
    let half = 0.5 * SIZE.as_vec2();
    let scale = half.y / (0.5 * fov).tan();
    let corners = positions.expect("positions").iter();
    let corners = corners.map(|p| at.transform_point(Vec3::from(*p)));
    let seen = corners.filter(|p| p.z < -0.01);
    seen.map(|p| half + scale * Vec2::new(p.x, -p.y) / -p.z)
        .collect()
}

/// Counts the red and blue pixels of a solid in some rotations, or of a room seen from its middle.
/// Near corners, faces may be thinner than the pixels by which signs are found.
fn rotations(
    small: &mut Small,
    sides: u32,
    inside: bool,
    (source, count): (CreaseSource, u32),
) -> [usize; 2] {
    let fov = if inside { 1.6 } else { 0.6 };
    let projection = PerspectiveProjection { fov, ..default() };
    small.insert((Transform::IDENTITY, Projection::Perspective(projection)));
    let mesh = prism(sides, inside);
    let at = Transform::from_xyz(0.0, 0.0, if inside { -0.2 } else { -5.0 });
    small.clear();
    let entity = small.put(mesh.clone(), unlit(Color::WHITE), at);
    small.outlined(signs(source));
    if source != CreaseSource::Normals {
        sections::wait(small, sections::some_has_sections);
    }
    let mut sum = [0, 0];
    for i in 0..count {
        let at = at.with_rotation(turned(i * 64 / count));
        small.on(entity).insert(at);
        small.headless.step(1);
        let mut picture = small.picture();
        let corners = projected(&mesh, at, fov);
        for (x, y, pixel) in picture.enumerate_pixels_mut() {
            let place = Vec2::new(x as f32, y as f32) + 0.5;
            if corners.iter().any(|corner| corner.distance(place) < 4.0) {
                pixel.0 = [255; 4];
            }
        }
        let found = counted(&picture);
        sum = [sum[0] + found[0], sum[1] + found[1]];
    }
    sum
}

/// Truth: all creases of a solid are convex, and all of a room are concave, at 45 to 120 degrees.
fn assert_signs(shapes: &[u32], sources: &[CreaseSource], count: u32) {
    let mut small = Small::new(SIZE, Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.empty_view(msaa, Color::WHITE);
        for &sides in shapes {
            for source in sources {
                let solid = rotations(&mut small, sides, false, (*source, count));
                let room = rotations(&mut small, sides, true, (*source, count));
                println!("{msaa:?}, {sides} sides, {source:?}: {solid:?}, {room:?}");
                let least = 100 * count as usize;
                assert!(
                    solid[0] > least && solid[1] == 0,
                    "{sides} sides: {solid:?}"
                );
                assert!(room[0] == 0 && room[1] > least, "{sides} sides: {room:?}");
            }
        }
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn solids_are_convex_and_rooms_concave() {
    assert_signs(&[3, 8], &[CreaseSource::Both], 4);
}

#[test]
#[ignore = "long: 64 rotations"]
fn all_solids_are_convex_and_all_rooms_concave() {
    let sources = [CreaseSource::Normals, CreaseSource::Meshes];
    assert_signs(&[3, 4, 8], &sources, 64);
}

/// A wall with a plate before it, 5 cm in front, as one mesh, at 20 m: the sides of the plate are
/// thinner than a pixel. Truth: what is in front ends at its edges.
#[test]
fn steps_are_convex() {
    let mut small = Small::new(SIZE, Msaa::Off);
    small.empty_view(Msaa::Off, Color::WHITE);
    small.insert(Projection::Perspective(PerspectiveProjection::default()));
    let mut mesh: Mesh = Cuboid::new(30.0, 30.0, 1.0).into();
    let plate: Mesh = Cuboid::new(8.0, 6.0, 1.0).into();
    let plate = plate.translated_by(Vec3::new(0.2, 0.1, 0.05));
    mesh.merge(&plate).expect("the same attributes");
    let at = Transform::from_xyz(0.0, 0.0, -20.0).with_rotation(Quat::from_rotation_y(0.2));
    small.put(mesh, unlit(Color::WHITE), at);
    let found = counted(&small.outlined(signs(CreaseSource::Both)));
    assert!(found[0] > 200 && found[1] == 0, "{found:?}");
}

/// Where a box stands on a floor, two objects meet: that is no crease.
#[test]
fn contacts_are_edges_between_objects() {
    let mut small = Small::new(SIZE, Msaa::Off);
    small.empty_view(Msaa::Off, Color::WHITE);
    let camera = Transform::from_xyz(0.0, 300.0, 400.0).looking_at(Vec3::ZERO, Vec3::Y);
    small.insert((camera, Projection::Orthographic(unit_per_pixel(SIZE))));
    let floor = Plane3d::default().mesh().size(900.0, 900.0);
    small.put(floor, unlit(Color::WHITE), Transform::default());
    let solid: Mesh = Cuboid::new(60.0, 40.0, 40.0).into();
    let at = Transform::from_xyz(0.0, 20.0, 0.0);
    small.put(solid, unlit(Color::WHITE), at);
    let picture = small.outlined(signs(CreaseSource::Both));
    // Up the picture from the floor before the box: its lower edge, its upper edge, its far one.
    let column = (0..SIZE.y)
        .rev()
        .map(|y| picture.get_pixel(SIZE.x / 2, y).0);
    let mut kinds: Vec<&str> = Vec::new();
    for [r, g, b, _] in column {
        let kind = match [r, g, b].map(|c| c > 127) {
            [false, false, false] => "black",
            [true, false, false] => "red",
            [false, false, true] => "blue",
            _ => "white",
        };
        if kinds.last() != Some(&kind) {
            kinds.push(kind);
        }
    }
    assert_eq!(
        kinds,
        ["white", "black", "white", "red", "white", "black", "white"]
    );
}

/// The color of the upper edge of a box, with light from this direction.
fn highlight(
    small: &mut Small,
    source: CreaseSource,
    to_light: Vec3,
    style: EdgeStyle,
) -> [f64; 3] {
    let towards = Transform::default().looking_to(-to_light, Vec3::Y);
    let light = DirectionalLight::default();
    let light = small.world().spawn((KeyLight, light, towards, Object)).id();
    let mut lines = signs(source);
    lines.creases = lines.creases.map(|creases| Creases {
        convex: Some(style),
        ..creases
    });
    let picture = small.outlined(lines);
    small.world().despawn(light);
    // The edge between the upper side and the front.
    let edge = (0..SIZE.y).map(|y| linear(&picture, SIZE.x / 2, y));
    let flat = FLAT.map(f64::from);
    let far = |color: &[f64; 3]| {
        color
            .iter()
            .zip(flat)
            .map(|(a, b)| (a - b).abs())
            .sum::<f64>()
    };
    edge.max_by(|a, b| far(a).total_cmp(&far(b)))
        .expect("pixels")
}

const FLAT: [f32; 3] = [0.3, 0.05, 0.02];

/// A box that fills the picture, whose edge runs across its middle.
fn filled_by_an_edge(msaa: Msaa) -> Small {
    let mut small = Small::new(SIZE, msaa);
    small.empty_view(msaa, Color::WHITE);
    let camera = Transform::from_xyz(0.0, 600.0, 600.0).looking_at(Vec3::ZERO, Vec3::Y);
    small.insert((camera, Projection::Orthographic(unit_per_pixel(SIZE))));
    let solid: Mesh = Cuboid::from_length(400.0).into();
    let [r, g, b] = FLAT;
    let at = Transform::from_xyz(0.0, -200.0, -200.0);
    small.put(solid, unlit(Color::linear_rgb(r, g, b)), at);
    small
}

#[test]
fn highlights_are_lighter_than_their_surface() {
    let mut small = filled_by_an_edge(Msaa::Off);
    for (lighten, saturate) in [(0.4, 1.0), (0.4, 0.0), (1.0, 1.0), (-0.5, 1.0), (-1.0, 1.0)] {
        let color = EdgeColor::Surface { lighten, saturate };
        let style = EdgeStyle { color, ..default() };
        let found = highlight(&mut small, CreaseSource::Both, Vec3::Y, style);
        let [l, a, b] = linear_to_oklab(FLAT.map(f64::from));
        let amount = f64::from(lighten);
        let end = if amount > 0.0 { 1.0 } else { 0.0 };
        let chroma = f64::from(saturate) * (1.0 - 0.5 * amount.max(0.0)) * (1.0 + amount.min(0.0));
        let lightness = l + (end - l) * amount.abs();
        let wanted = oklab_to_linear([lightness, chroma * a, chroma * b]);
        let wanted = wanted.map(|c| c.clamp(0.0, 1.0));
        assert!(alike(found, wanted), "{lighten}: {found:?}, {wanted:?}");
    }
}

/// An edge is lit if one of its sides is; also where nothing else reads normals, and of several samples.
#[test]
fn highlights_need_light() {
    let views = [
        (Msaa::Off, CreaseSource::Both),
        (Msaa::Sample4, CreaseSource::Meshes),
    ];
    for (msaa, source) in views {
        let mut small = filled_by_an_edge(msaa);
        let style = EdgeStyle {
            color: EdgeColor::Ink { color: CONVEX },
            unlit_opacity: 0.25,
            ..default()
        };
        for to_light in [Vec3::Y, Vec3::Z] {
            let found = highlight(&mut small, source, to_light, style);
            assert!(alike(found, [1.0, 0.0, 0.0]), "{to_light}: {found:?}");
        }
        let found = highlight(&mut small, source, Vec3::NEG_Y, style);
        let flat = FLAT.map(f64::from);
        let wanted = [0.25 + 0.75 * flat[0], 0.75 * flat[1], 0.75 * flat[2]];
        assert!(alike(found, wanted), "{found:?}, {wanted:?}");
    }
}

/// Width and opacity of one sign are factors of the others'.
#[test]
fn each_sign_has_its_width_and_opacity() {
    let mut small = filled_by_an_edge(Msaa::Off);
    let red = |width, opacity| {
        let style = ink(CONVEX).map(|style| EdgeStyle {
            width,
            opacity,
            ..style
        });
        let mut lines = signs(CreaseSource::Both);
        lines.creases = lines.creases.map(|c| Creases { convex: style, ..c });
        lines
    };
    let mut sum = |lines| {
        let picture = small.outlined(lines);
        let green = |y| linear(&picture, SIZE.x / 2, y)[1];
        let flat = green(5);
        (0..SIZE.y).map(|y| 1.0 - green(y) / flat).sum::<f64>()
    };
    for (width, opacity, wanted) in [
        (1.0, 1.0, 2.0),
        (2.0, 1.0, 4.0),
        (1.0, 0.5, 1.0),
        (1.0, 0.0, 0.0),
    ] {
        let found = sum(red(width, opacity));
        assert!((found - wanted).abs() < 0.1, "{width}, {opacity}: {found}");
    }
}
