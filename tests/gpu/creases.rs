//! Where creases lie: between pixels, where the two sides meet.

use bevy_comics::objects::ObjectSimplification;

use crate::{
    prelude::*,
    walls::{towards_the_sky, towards_the_sky_again, wall},
};

const SIZE: UVec2 = UVec2::new(96, 64);
const WIDTH: f32 = 4.0;

/// Starts over with a cube that is seen along one of its edges.
fn cube(small: &mut Small, msaa: Msaa, style: &ComicStyle) -> Entity {
    towards_the_sky_again(small, msaa);
    let at = leaning(0.0, 0.0);
    let cube = small.put(Cuboid::from_length(300.0), unlit(Color::WHITE), at);
    small.style(style).settle();
    cube
}

fn creases(weight: LineWeight) -> ComicStyle {
    ComicStyle::new().with(Outlines {
        silhouettes: None,
        objects: None,
        width: WIDTH,
        weight,
        ..default()
    })
}

/// The same lines, with or without those of normal maps.
fn bumpy_creases(normal_maps: bool) -> ComicStyle {
    let creases = Creases {
        normal_maps,
        ..default()
    };
    ComicStyle::new().with(Outlines {
        silhouettes: None,
        objects: None,
        creases: Some(creases),
        width: WIDTH,
        ..default()
    })
}

/// The place of the cube of which the edge leans by an angle and passes the middle of the picture
/// at a distance in pixels.
fn leaning(lean: f32, shift: f32) -> Transform {
    let turned = Quat::from_rotation_z(lean) * Quat::from_rotation_y(45f32.to_radians());
    Transform::from_xyz(shift, 0.0, -400.0).with_rotation(turned)
}

/// The next picture, with the cube at a place.
fn moved(small: &mut Small, cube: Entity, at: Transform) -> image::RgbaImage {
    small.world().entity_mut(cube).insert(at);
    small.headless.step(1);
    small.picture()
}

/// The middle of the ink of every row, less where the edge is, and the ink.
fn rows(picture: &image::RgbaImage, lean: f32, shift: f32) -> Vec<[f64; 2]> {
    let row = |y: u32| {
        let ink = |x: u32| 1.0 - linear(picture, x, y)[0];
        let sum: f64 = (0..SIZE.x).map(ink).sum();
        let moment: f64 = (0..SIZE.x).map(|x| ink(x) * (f64::from(x) + 0.5)).sum();
        let up = 32.0 - (f64::from(y) + 0.5);
        let edge = 48.0 + f64::from(shift) - up * f64::from(lean).tan();
        [moment / sum - edge, sum]
    };
    (12..52).map(row).collect()
}

/// Truth: over slopes from 0.05 to 0.9 and places between pixels, the line is where the edge
/// of the cube is, and as wide as asked. By the runs of cracks alone, lines strayed from
/// their mean by up to 0.15 pixels (root mean square); with four samples by up to 0.35, and
/// were up to 0.5 pixels wider, because normals were those of the nearest sample.
#[test]
fn creases_lie_where_their_sides_meet() {
    let mut small = towards_the_sky(SIZE);
    for (msaa, shifted, spread, wider) in [
        (Msaa::Off, 0.05, 0.09, 0.1),
        (Msaa::Sample4, 0.15, 0.16, 0.2),
    ] {
        let cube = cube(&mut small, msaa, &creases(LineWeight::EVEN));
        for slope in [0.05f32, 0.2, 0.35, 0.5, 0.7, 0.9] {
            let mut errors = vec![];
            let mut widths = vec![];
            for shift in [0.0, 0.27, 0.61] {
                let lean = slope.atan();
                let picture = moved(&mut small, cube, leaning(lean, shift));
                for [error, ink] in rows(&picture, lean, shift) {
                    errors.push(error * f64::from(lean.cos()));
                    widths.push(ink * f64::from(lean.cos()));
                }
            }
            let count = errors.len() as f64;
            let mean = errors.iter().sum::<f64>() / count;
            let off = (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / count).sqrt();
            let width = widths.iter().sum::<f64>() / count;
            println!("{msaa:?}, {slope}: {mean:.3} +- {off:.3}, {width:.3} wide");
            assert!(mean.abs() < shifted, "{msaa:?}, {slope}: {mean}");
            assert!(off < spread, "{msaa:?}, {slope}: {off}");
            assert!((width - 4.0).abs() < wider, "{msaa:?}, {slope}: {width}");
        }
    }
}

/// An upright crease alone is as wide as its weight says, in every row. The ink of the pixels at
/// both borders of the line is rounded by less than 0.01 each.
#[test]
fn creases_are_as_wide_as_their_weight() {
    let mut small = towards_the_sky(SIZE);
    let cube = cube(&mut small, Msaa::Off, &creases(LineWeight::EVEN));
    for factor in [0.25, 0.6, 1.0, 2.0f32] {
        let weight = LineWeight {
            crease: factor,
            ..LineWeight::EVEN
        };
        small.style(&creases(weight)).settle();
        for shift in [0.0, 0.3] {
            let picture = moved(&mut small, cube, leaning(0.0, shift));
            let want = f64::from(WIDTH * factor);
            for y in 12..52 {
                let found = black_ink(&picture, (0..SIZE.x).map(|x| (x, y)));
                assert!(
                    (found - want).abs() < 0.02,
                    "{shift}, {factor}, row {y}: {found}, {want}"
                );
            }
        }
    }
}

/// Where something else is two pixels away, the planes are not those of the sides: the line
/// stays within half a pixel of its crack.
#[test]
fn other_edges_do_not_move_creases() {
    let mut small = towards_the_sky(SIZE);
    let cube = cube(&mut small, Msaa::Off, &creases(LineWeight::EVEN));
    small.world().entity_mut(cube).insert(leaning(0.0, 0.3));
    // A bar two pixels to the left of the edge, in front of it.
    wall(&mut small, [-20.0, -10.0], [-1.2, 10.0], 100.0);
    let found = rows(&small.settle().picture(), 0.0, 0.3);
    for [error, ink] in found {
        assert!(error.abs() < 0.5, "{error}");
        assert!(ink > 0.9 * f64::from(WIDTH), "{ink}");
    }
}

/// A normal map of squares that lean by 45 degrees to one side and the other.
fn studs(small: &mut Small) -> Handle<Image> {
    let lean = |n: u32| if n.is_multiple_of(2) { 218 } else { 38 };
    let squares = (0..16).flat_map(|y| (0..16).map(move |x| [lean(x + y), 128, 218, 255]));
    let size = Extent3d {
        width: 16,
        height: 16,
        ..default()
    };
    let data: Vec<u8> = squares.flatten().collect();
    let (dimension, format) = (TextureDimension::D2, TextureFormat::Rgba8Unorm);
    let mut image = Image::new(size, dimension, data, format, RenderAssetUsages::default());
    image.sampler = bevy::image::ImageSampler::nearest();
    small.world().resource_mut::<Assets<Image>>().add(image)
}

/// A cube with a normal map, seen along one of its edges: the bumps have lines only if they are asked
/// for, and the edge has its line.
#[test]
fn bumps_of_normal_maps_have_no_creases() {
    let mut small = towards_the_sky(SIZE);
    let bumpy = StandardMaterial {
        emissive: LinearRgba::WHITE,
        normal_map_texture: Some(studs(&mut small)),
        ..default()
    };
    let cube = Mesh::from(Cuboid::from_length(300.0)).with_generated_tangents();
    let cube = small.put(cube.expect("it has uvs"), bumpy, leaning(0.3, 0.0));
    small.world().entity_mut(cube).insert(MeshSections::NONE);
    let mut bumps = |normal_maps| {
        let picture = small.shot(&bumpy_creases(normal_maps));
        for y in 12..52 {
            let edge = 48.0 - (31.5 - f64::from(y)) * 0.3f64.tan();
            let middle = (edge - 4.0) as u32..(edge + 4.0) as u32;
            let ink = black_ink(&picture, middle.map(|x| (x, y)));
            let is_whole = ink > 0.9 * f64::from(WIDTH);
            assert!(normal_maps || is_whole, "row {y}: {ink}");
        }
        let is_beside = |x: u32, y: u32| {
            let edge = 48.0 - (31.5 - f64::from(y)) * 0.3f64.tan();
            (f64::from(x) + 0.5 - edge).abs() > 6.0
        };
        let all = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
        black_ink(&picture, all.filter(|(x, y)| is_beside(*x, *y)))
    };
    assert_eq!(bumps(false), 0.0);
    let found = bumps(true);
    assert!(found > 20.0, "{found}");
}

/// Two walls at a right angle with a bevel of this width between them, over which their normals turn.
fn bevel(width: f32) -> Mesh {
    let across = [
        (-80.0, -80.0, -1.0),
        (-0.5 * width, 0.0, -1.0),
        (0.5 * width, 0.0, 1.0),
        (80.0, -80.0, 1.0f32),
    ];
    let both = across.map(|at| [(at, -60.0), (at, 60.0f32)]);
    let vertices = both.as_flattened();
    let positions: Vec<[f32; 3]> = vertices.iter().map(|((x, z, _), y)| [*x, *y, *z]).collect();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let normals: Vec<[f32; 3]> = (vertices.iter())
        .map(|((_, _, side), _)| [side * half, 0.0, half])
        .collect();
    let quads = [0, 2, 4].map(|i| [i, i + 2, i + 1, i + 2, i + 3, i + 1]);
    Mesh::new(bevy::mesh::PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_indices(Indices::U32(quads.concat()))
}

/// Normals fold most in the middle of a smooth bevel, where depth does not bend: no line is lost there.
#[test]
fn smooth_bevels_keep_their_creases() {
    let mut small = towards_the_sky(SIZE);
    for width in [1.0, 2.0, 3.0, 3.5] {
        towards_the_sky_again(&mut small, Msaa::Off);
        let at = Transform::from_xyz(0.0, 0.0, -400.0);
        let bevel = small.put(bevel(width), unlit(Color::WHITE), at);
        small.world().entity_mut(bevel).insert(MeshSections::NONE);
        let mut ink = |normal_maps| {
            small.style(&bumpy_creases(normal_maps)).settle();
            [0.0, 0.2, 0.4, 0.6, 0.8].map(|shift| {
                let at = Transform::from_xyz(shift, 0.0, -400.0);
                let picture = moved(&mut small, bevel, at);
                let rows = (12..52).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
                black_ink(&picture, rows)
            })
        };
        let [found, want] = [ink(false), ink(true)];
        assert!(want.iter().any(|ink| *ink > 20.0), "{width}: {want:?}");
        assert_eq!(found, want, "{width}");
    }
}

/// Where the picture is abstract, creases lose opacity, by the abstraction of their object. The
/// ink of six pixels is rounded by less than 0.01 each.
#[test]
fn creases_fade_with_abstraction() {
    let mut small = towards_the_sky(SIZE);
    let style = creases(LineWeight::EVEN).with(Abstraction {
        at_near: 0.5,
        at_far: 0.5,
        line_threshold: 1.0,
        crease_opacity: 0.2,
        ..default()
    });
    let cube = cube(&mut small, Msaa::Off, &style);
    for (level, left) in [(None, 0.6), (Some(1.0), 0.2), (Some(0.0), 1.0)] {
        if let Some(level) = level {
            let own = ObjectSimplification::fixed(level);
            small.world().entity_mut(cube).insert(own);
        }
        let picture = small.settle().picture();
        let found = black_ink(&picture, (0..SIZE.x).map(|x| (x, 32)));
        let want = f64::from(WIDTH) * left;
        assert!((found - want).abs() < 0.06, "{level:?}: {found}, {want}");
    }
}
