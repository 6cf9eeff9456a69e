//! Painted ramps of the toon material: tones, edges, shadows, rows, files, and images that cannot
//! be used.

use bevy_comics::ToonShadingHandle;
use bevy_comics_testkit::reference::{Rgb, color::srgb_encode, toon::tones::Tones};
use image::RgbaImage;

use crate::{
    prelude::*,
    ramp::{
        EDGE_SIZE, MODES, bright, check_borders, check_caps, check_edge, drawn, leaning, put, room,
        set_light, stage, sun, with,
    },
    styles::Folder,
    toon_shading::{load, mesh_with_shading, wait, watching},
};

const BLACK: Rgb = [0.0; 3];
const WHITE: Rgb = [1.0; 3];
const RED: Rgb = [1.0, 0.0, 0.0];
const GREEN: Rgb = [0.0, 1.0, 0.0];
const BLUE: Rgb = [0.0, 0.0, 1.0];

/// An image of rows of tones in linear light.
fn painted(rows: &[Vec<Rgb>]) -> Image {
    let texel = |color: &Rgb| [color[0] as f32, color[1] as f32, color[2] as f32, 1.0];
    let bytes = (rows.iter().flatten())
        .flat_map(texel)
        .flat_map(f32::to_le_bytes);
    Image::new(
        Extent3d {
            width: rows[0].len() as u32,
            height: rows.len() as u32,
            depth_or_array_layers: 1,
        },
        TextureDimension::D2,
        bytes.collect(),
        TextureFormat::Rgba32Float,
        RenderAssetUsages::default(),
    )
}

fn add(small: &mut Small, image: Image) -> RampMap {
    let mut images = small.world().resource_mut::<Assets<Image>>();
    images.add(image).into()
}

/// The tones of rows, as colors of surfaces, or as factors of the light.
fn light_of(small: &mut Small, mode: RampMode, blend: RampBlend, rows: &[Vec<Rgb>]) -> ToonLight {
    ToonLight {
        ramp_map: add(small, painted(rows)),
        ..with(Ramp {
            mode,
            blend,
            keep_intensity: 1.0,
            ..Ramp::default()
        })
    }
}

/// Truth: tones of a ball have the areas of its caps.
#[test]
fn painted_tones_of_a_ball_have_the_areas_of_its_caps() {
    let row = vec![BLACK, RED, GREEN, BLUE];
    check_caps([0.25, 0.5, 0.75], |small, mode| {
        light_of(small, mode, RampBlend::Absolute, std::slice::from_ref(&row))
    });
}

/// Truth: no tone between is drawn along the border of a shadow.
#[test]
fn borders_of_shadows_have_no_painted_bands() {
    let row = vec![BLACK, RED, GREEN, WHITE];
    check_borders(|small, mode| {
        light_of(small, mode, RampBlend::Multiply, std::slice::from_ref(&row))
    });
}

/// Soft tones, so that 1024 texels have them within a code.
fn soft() -> Ramp {
    Ramp::new([
        RampStop::new(0.0, Color::linear_rgb(0.15, 0.1, 0.3)),
        RampStop::new(0.35, Color::linear_rgb(0.5, 0.4, 0.6)).soft(0.6),
        RampStop::new(0.7, Color::linear_rgb(1.0, 0.9, 0.8)).soft(0.5),
    ])
}

/// Checks that an image of a soft ramp is that ramp, in these modes and blends, under several
/// lights with shadows of these strengths.
fn check_soft_ramps(cases: impl IntoIterator<Item = (RampMode, RampBlend, f32)>) {
    let tones = Tones::new(&soft(), 1.0);
    let tone = |k: u32| tones.at((f64::from(k) + 0.5) / 1024.0, 0.0).to_array();
    let row: Vec<Rgb> = (0..1024).map(tone).collect();
    let mut small = stage(&ToonLight::default());
    for (mode, blend, strength) in cases {
        let stops = ToonLight {
            shadow_strength: strength,
            ..with(Ramp {
                mode,
                blend,
                ..soft()
            })
        };
        let map = ToonLight {
            ramp_map: add(&mut small, painted(std::slice::from_ref(&row))),
            ..stops.clone()
        };
        set_light(&mut small, &stops);
        let wanted = drawn(&mut small);
        set_light(&mut small, &map);
        let found = drawn(&mut small);
        // Half a texel of a tone that rises by 3 per unit is 0.4 of a code of linear light, and up
        // to 1.2 of a dark display. Along the borders of shadows, stops and images do not weaken
        // soft tones alike.
        let off = [2, 60].map(|codes| differ(&found, &wanted, codes));
        let what = format!("{mode:?}, {blend:?}, {strength}: {off:?}");
        let all = found.pixels().len();
        assert!(off[0] * 50 < all && off[1] * 1000 < all, "{what}");
    }
}

/// Truth: an image of a soft ramp is that ramp, in every mode.
#[test]
fn images_of_soft_ramps_are_these_ramps() {
    check_soft_ramps([
        (RampMode::LightFraction, RampBlend::Multiply, 0.6),
        (RampMode::PerLight, RampBlend::Absolute, 0.6),
        (RampMode::Brightest, RampBlend::Multiply, 1.0),
    ]);
}

/// The same in every blend, with whole and weaker shadows.
#[test]
#[ignore = "long: every mode with every blend and strength"]
fn images_of_soft_ramps_are_these_ramps_in_full() {
    let blends = [RampBlend::Multiply, RampBlend::Absolute];
    let cases = MODES.into_iter().flat_map(|mode| {
        let with = move |blend| [1.0, 0.6].map(|strength| (mode, blend, strength));
        blends.into_iter().flat_map(with)
    });
    check_soft_ramps(cases);
}

fn is_near(found: Rgb, wanted: Rgb, most: f64) -> bool {
    (0..3).all(|c| (found[c] - wanted[c]).abs() < most)
}

/// Checks that in these modes rows lie along the second axis, the first one where there is all
/// detail; between rows, tones are mixed in linear light.
fn check_rows(modes: &[RampMode]) {
    let mut small = room(UVec2::splat(120), 0.0);
    let rows = [vec![RED, RED], vec![GREEN, GREEN], vec![BLUE, BLUE]];
    let mut light = light_of(
        &mut small,
        RampMode::LightFraction,
        RampBlend::Absolute,
        &rows,
    );
    let ball = Sphere::new(0.95).mesh().uv(128, 64);
    put(&mut small, ball, &light, Transform::IDENTITY);
    sun(&mut small, Vec3::Z, bright(1.0));
    let detail = |axis| {
        Some(RampDetail {
            plain: Vec::new(),
            axis,
        })
    };
    for mode in modes.iter().copied() {
        // Without an axis, the first row.
        light.ramp = with(Ramp {
            mode,
            blend: RampBlend::Absolute,
            keep_intensity: 1.0,
            ..Ramp::default()
        })
        .ramp;
        set_light(&mut small, &light);
        assert_eq!(drawn(&mut small).get_pixel(60, 60).0[..3], [255, 0, 0]);
        for (amount, wanted) in [
            (1.0, RED),
            (0.75, [0.5, 0.5, 0.0]),
            (0.5, GREEN),
            (0.125, [0.0, 0.25, 0.75]),
            (0.0, BLUE),
        ] {
            let ramp = light.ramp.as_mut().expect("a ramp");
            ramp.detail = detail(DetailAxis::Constant(amount));
            set_light(&mut small, &light);
            let found = linear(&drawn(&mut small), 60, 60);
            assert!(
                is_near(found, wanted, 0.005),
                "{mode:?}, {amount}: {found:?}"
            );
        }
        // The cosine between normal and eye: red in the middle, blue at the rim.
        let ramp = light.ramp.as_mut().expect("a ramp");
        ramp.detail = detail(DetailAxis::Rim { power: 1.0 });
        set_light(&mut small, &light);
        let picture = drawn(&mut small);
        for x in 60..112 {
            let [across, up] = [f64::from(x) - 59.5, 0.5].map(|p| p / 57.0);
            let row = 2.0 * (1.0 - (1.0 - across * across - up * up).sqrt());
            let wanted = match row < 1.0 {
                true => [1.0 - row, row, 0.0],
                false => [0.0, 2.0 - row, row - 1.0],
            };
            let found = linear(&picture, x, 60);
            let what = format!("{mode:?}, {x}: {found:?}, not {wanted:?}");
            assert!(is_near(found, wanted, 0.02), "{what}");
        }
    }
}

/// Truth: rows are the second axis of fractions of the light.
#[test]
fn rows_are_the_second_axis() {
    check_rows(&MODES[..1]);
}

#[test]
#[ignore = "long: the pipelines of every mode"]
fn rows_are_the_second_axis_in_every_mode() {
    check_rows(&MODES);
}

/// Truth: many tones in a pixel are their mean, without moire; over 64 shifts by parts of a pixel,
/// an edge covers what it should.
#[test]
fn pixels_have_the_mean_of_painted_tones() {
    let mut small = room(EDGE_SIZE, 0.0);
    let stripes: Vec<Rgb> = (0..1024).map(|k| [f64::from(k % 2); 3]).collect();
    let light = light_of(
        &mut small,
        RampMode::PerLight,
        RampBlend::Absolute,
        &[stripes],
    );
    let square = put(&mut small, leaning(), &light, Transform::IDENTITY);
    sun(&mut small, Vec3::X, bright(1.0));
    let picture = drawn(&mut small);
    // The cosine is t / sqrt(1 + t^2) at t = x / 32 pixels: near the middle it changes by 32 texels
    // a pixel. Of the mean, half a texel may be left over.
    for x in 34..56 {
        let t = (f64::from(x) + 0.5 - 32.0) / 32.0;
        let texels = 1024.0 / 32.0 * (1.0 + t * t).powf(-1.5);
        let off = (linear(&picture, x, 16)[0] - 0.5).abs();
        assert!(off < 0.5 / texels + 0.004, "{x}: {off}");
    }
    let halves = light_of(
        &mut small,
        RampMode::PerLight,
        RampBlend::Absolute,
        &[vec![BLACK, BLACK, WHITE, WHITE, WHITE]],
    );
    set_light(&mut small, &halves);
    small.headless.step(2);
    // The area of a pixel is exact on a straight cosine: what is left is the codes of two pixels.
    check_edge(&mut small, square, 0.4, 0.02);
}

/// A material with a map and no ramp has the settings of the default ramp.
#[test]
fn a_map_without_a_ramp_has_the_default_settings() {
    let mut small = stage(&ToonLight::default());
    let map = add(&mut small, painted(&[vec![[0.2, 0.1, 0.4], WHITE, WHITE]]));
    let alone = ToonLight {
        ramp_map: map.clone(),
        ..default()
    };
    set_light(&mut small, &alone);
    let found = drawn(&mut small);
    let default = ToonLight {
        ramp: Some(Ramp::default()),
        ..alone.clone()
    };
    set_light(&mut small, &default);
    assert_eq!(apart(&found, &drawn(&mut small)), 0);
    let none = ToonLight {
        ramp_map: RampMap::default(),
        ..alone
    };
    set_light(&mut small, &none);
    assert!(apart(&found, &drawn(&mut small)) > 20);
}

/// Images that cannot be used, and files that are not there, leave the stops of the ramp.
#[test]
fn bad_images_leave_the_stops() {
    let stops = with(Ramp::default());
    let mut small = stage(&stops);
    let wanted = drawn(&mut small);
    let row = |width: usize| painted(&[vec![RED; width]]);
    let mut gone = row(4);
    gone.asset_usage = RenderAssetUsages::RENDER_WORLD;
    let gone = add(&mut small, gone);
    // It is moved to the render world before a material has it.
    small.headless.step(3);
    let [wide, narrow] = [1025, 1].map(|width| add(&mut small, row(width)));
    for map in [wide, narrow, gone] {
        let bad = ToonLight {
            ramp_map: map.clone(),
            ..stops.clone()
        };
        set_light(&mut small, &bad);
        assert_eq!(apart(&wanted, &drawn(&mut small)), 0, "{map:?}");
    }
    // Materials that never had another one.
    let missing = ToonLight {
        ramp_map: RampMap::at("nowhere.png"),
        ..stops.clone()
    };
    let mut other = stage(&missing);
    let mut found = drawn(&mut other);
    for _ in 0..100 {
        if apart(&wanted, &found) <= 1 {
            break;
        }
        std::thread::sleep(Duration::from_millis(25));
        found = drawn(&mut other);
    }
    // Compared within one app: another may draw in another order.
    set_light(&mut other, &stops);
    assert_eq!(apart(&found, &drawn(&mut other)), 0, "a missing file");
    // The next good one is drawn.
    let good = ToonLight {
        ramp_map: add(&mut small, row(1024)),
        ..stops
    };
    set_light(&mut small, &good);
    assert!(apart(&wanted, &drawn(&mut small)) > 100);
}

/// An image of 16 tones of one gray, in 8 bits.
fn grays(code: u8) -> RgbaImage {
    RgbaImage::from_pixel(16, 1, image::Rgba([code, code, code, 255]))
}

/// Tones follow when code changes an image. One that cannot be used leaves the stops, of which the
/// last one is white; images in sRGB and in linear light give the colors that they mean.
#[test]
fn tones_follow_their_image() {
    let mut small = room(UVec2::splat(16), 0.0);
    let (mode, blend) = (RampMode::PerLight, RampBlend::Absolute);
    let light = light_of(&mut small, mode, blend, &[vec![RED; 4]]);
    let wall = Plane3d::new(Vec3::Z, Vec2::splat(4.0));
    put(&mut small, wall.mesh(), &light, Transform::IDENTITY);
    sun(&mut small, Vec3::Z, bright(1.0));
    assert_eq!(drawn(&mut small).get_pixel(8, 8).0[..3], [255, 0, 0]);
    let coded = |format| {
        let mut image = painted(&[vec![RED; 2]]);
        image.texture_descriptor.format = format;
        image.data = Some(vec![60; 8]);
        image
    };
    let linear_code = (255.0 * srgb_encode([60.0 / 255.0; 3])[0]).round() as u8;
    let changes = [
        (painted(&[vec![GREEN; 7], vec![RED; 7]]), [0, 255, 0], 0),
        (painted(&[vec![BLUE; 1]]), [255; 3], 0),
        (painted(&[vec![BLUE; 2]]), [0, 0, 255], 0),
        (coded(TextureFormat::Rgba8UnormSrgb), [60; 3], 1),
        (coded(TextureFormat::Rgba8Unorm), [linear_code; 3], 1),
    ];
    let image = light.ramp_map.image().expect("an image").id();
    for (to, wanted, most) in changes {
        let what = format!("{:?}", to.texture_descriptor);
        let mut images = small.world().resource_mut::<Assets<Image>>();
        *images.get_mut(image).expect("it is there") = to;
        let found = drawn(&mut small).get_pixel(8, 8).0;
        let is_wanted = (0..3).all(|c| found[c].abs_diff(wanted[c]) <= most);
        assert!(is_wanted, "{what}: {found:?}, not {wanted:?}");
    }
}

/// A shading names its image by its path, which is loaded with it, and read again when its file
/// changes.
#[test]
fn shadings_name_their_images_by_path() {
    let folder = Folder::new("ramp-map");
    let file = folder.0.join("tones.png");
    grays(100).save(&file).expect("written");
    let text = "(version: 2, light: (highlight: 0.0, ramp_map: \"tones.png\",
        ramp: (mode: PerLight, blend: Absolute)))";
    std::fs::write(folder.0.join("hero.toon.ron"), text).expect("written");
    let mut small = watching(&folder);
    small.clear();
    let shading = load(&mut small, "hero.toon.ron");
    let mesh = mesh_with_shading(&mut small, shading.clone());
    let image = move |world: &World| {
        let handle = world.get::<MeshMaterial3d<ToonMaterial>>(mesh)?;
        let material = world.resource::<Assets<ToonMaterial>>().get(&handle.0)?;
        material.extension.ramp_map.image().cloned()
    };
    let loaded = wait(&mut small, 400, |world| image(world).is_some());
    assert!(loaded, "the shading did not load");
    let server = small.world().resource::<AssetServer>().clone();
    let is_loaded = |_: &mut World| server.is_loaded_with_dependencies(&shading);
    assert!(wait(&mut small, 400, is_loaded));
    let handle = image(small.world()).expect("an image");
    assert_eq!(handle.path().expect("of a file").to_string(), "tones.png");
    // By code, a path is the same image.
    let same = ToonLight {
        ramp_map: server.load("tones.png").into(),
        ..default()
    };
    assert_eq!(same.ramp_map.image(), Some(&handle));
    // A box right before the eye, in full light.
    small.insert((
        Transform::from_xyz(0.0, 0.0, 1.2),
        Projection::Perspective(PerspectiveProjection::default()),
    ));
    sun(&mut small, Vec3::Z, bright(1.0));
    small.world().insert_resource(GlobalAmbientLight::NONE);
    let gray = |small: &mut Small| drawn(small).get_pixel(48, 32).0[0];
    assert!(gray(&mut small).abs_diff(100) <= 1);
    grays(200).save(&file).expect("written");
    let changed = (0..100).any(|_| {
        std::thread::sleep(Duration::from_millis(25));
        gray(&mut small).abs_diff(200) <= 1
    });
    assert!(changed, "the change did not arrive");
    // Without the component the material stays; the shading is written with the path.
    small.world().entity_mut(mesh).remove::<ToonShadingHandle>();
    let shadings = small.world().resource::<Assets<ToonShading>>();
    let text = shadings
        .get(&shading)
        .expect("loaded")
        .to_ron()
        .expect("text");
    assert!(text.contains("ramp_map: \"tones.png\""), "{text}");
}
