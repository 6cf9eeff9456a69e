//! Transparent meshes with `DepthWrite`: lines and color effects see them.

use bevy::{image::ToExtents, render::render_resource::AsBindGroup};

use crate::{
    outlines::{ink, removed},
    pictures::outlined,
    prelude::*,
};

/// The blend modes that the engine's depth prepass leaves out.
const MODES: [AlphaMode; 4] = [
    AlphaMode::Blend,
    AlphaMode::Premultiplied,
    AlphaMode::Add,
    AlphaMode::Multiply,
];

/// A tilted cube before the small scene.
fn pane(small: &mut Small, material: StandardMaterial) -> Entity {
    let turned = Quat::from_euler(EulerRot::XYZ, 0.5, 0.7, 0.1);
    let at = Transform::from_xyz(0.4, 1.0, 2.2).with_rotation(turned);
    small.put(Cuboid::from_length(1.3), material, at)
}

/// Changes the material of an object.
pub fn change(small: &mut Small, object: Entity, change: impl Fn(&mut StandardMaterial)) {
    let world = small.world();
    let material = world.get::<MeshMaterial3d<StandardMaterial>>(object);
    let id = material.expect("it has one").0.id();
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    change(&mut materials.get_mut(id).expect("it is there"));
}

/// An opaque mesh and a transparent one whose alpha is 1 have the same colors, so that the
/// styled pictures are equal, if the transparent one is in depth, normals and ids.
#[test]
fn it_is_drawn_as_an_opaque_mesh_would_be() {
    let mut small = Small::new(size(), Msaa::Off);
    let pane = pane(&mut small, unlit(Color::srgb(0.3, 0.8, 0.9)));
    let map = DepthMap {
        smoothing: None,
        ..default()
    };
    small.insert((VisibleDepthRange::default(), map));
    for style in [
        outlined(Outlines::default()),
        ComicStyle::default()
            .with(Desaturation::default())
            .with(Colorization::default())
            .with(Contours::default()),
    ] {
        small.style(&style);
        let mut draw = |alpha_mode, writes: bool| {
            change(&mut small, pane, |m| m.alpha_mode = alpha_mode);
            small.on(pane).remove::<DepthWrite>();
            if writes {
                small.on(pane).insert(DepthWrite::default());
            }
            let (input, output) = small.settle().pass();
            (input.pixels, output.pixels, small.range())
        };
        let opaque = draw(AlphaMode::Opaque, false);
        let without = draw(AlphaMode::Blend, false);
        let with = draw(AlphaMode::Blend, true);
        assert!(opaque == with, "{style:?}");
        assert!(without.0 == with.0, "inputs");
        assert!(without.1 != with.1, "{style:?}");
    }
}

/// The debug views, which show depth, normals' creases and ids themselves.
#[test]
fn debug_views_show_it() {
    let mut small = Small::new(size(), Msaa::Sample4);
    let pane = pane(&mut small, unlit(Color::srgb(0.3, 0.8, 0.9)));
    small.on(pane).insert(DepthWrite::default());
    for view in [
        DebugView::DepthMap,
        DebugView::RawRange,
        DebugView::Silhouettes,
        DebugView::Creases,
        DebugView::ObjectIds,
    ] {
        small.insert(view);
        let [opaque, blended] = [AlphaMode::Opaque, AlphaMode::Blend].map(|alpha_mode| {
            change(&mut small, pane, |m| m.alpha_mode = alpha_mode);
            small.settle().picture()
        });
        assert!(opaque == blended, "{view:?}");
    }
}

/// The engine's depth, and the picture that the pass reads, are bit for bit as without.
#[test]
fn the_engine_draws_what_it_drew() {
    let mut small = Small::new(size(), Msaa::Off);
    let red = StandardMaterial {
        base_color: Color::srgba(0.9, 0.2, 0.2, 0.6),
        alpha_mode: AlphaMode::Blend,
        ..default()
    };
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        let glass = pane(&mut small, red.clone());
        let lamp = PointLight {
            shadow_maps_enabled: true,
            ..default()
        };
        small.world().spawn((Object, lamp));
        small.style(&outlined(Outlines::default()));
        let draw = |small: &mut Small| {
            small.settle();
            let depth = small.depth().expect("a prepass").bits;
            let normals = small.normals().expect("a prepass").pixels;
            let (input, output) = small.pass();
            ((depth, normals, input.pixels), output.pixels)
        };
        let before = draw(&mut small);
        small.on(glass).insert(DepthWrite::default());
        let with = draw(&mut small);
        assert!(before.0 == with.0, "{msaa:?}: depth, normals, picture");
        assert_ne!(before.1, with.1, "{msaa:?}: it does something");
        // Removing the component restores today's picture; so does despawning the mesh.
        small.on(glass).remove::<DepthWrite>();
        assert!(before == draw(&mut small), "{msaa:?}: removed");
        assert!(!small.ran(ComicsStage::TransparentDepth));
        small.world().despawn(glass);
        let empty = draw(&mut small);
        let glass = pane(&mut small, red.clone());
        small.on(glass).insert(DepthWrite::default());
        small.settle();
        small.world().despawn(glass);
        assert!(empty == draw(&mut small), "{msaa:?}: despawned");
    }
}

/// Pixels across and down the white scene, in which a unit of the scene's z = 0 is a pixel.
const SIDE: u32 = 120;

/// A white scene, so that only lines change the picture, seen along z.
fn white() -> Small {
    let mut small = Small::new(UVec2::splat(SIDE), Msaa::Off);
    empty(&mut small, Msaa::Off);
    small
}

/// Starts over with the white scene.
fn empty(small: &mut Small, msaa: Msaa) {
    small.empty_view(msaa, Color::WHITE);
    small.insert(Transform::from_xyz(0.0, 0.0, 0.5 * SIDE as f32));
}

fn white_glass(alpha: f32) -> StandardMaterial {
    StandardMaterial {
        alpha_mode: AlphaMode::Blend,
        ..unlit(Color::linear_rgba(1.0, 1.0, 1.0, alpha))
    }
}

/// The white scene with a square pane of white glass.
fn white_pane() -> (Small, Entity) {
    let mut small = white();
    let pane = put_glass(&mut small, Rectangle::from_length(60.0));
    (small, pane)
}

fn put_glass(small: &mut Small, mesh: Rectangle) -> Entity {
    small.put(mesh, white_glass(0.6), Transform::IDENTITY)
}

/// The ink in a rectangle around the middle of the picture.
fn total(ink: &[f32], half: UVec2) -> f32 {
    let middle = SIDE / 2;
    let rows = middle - half.y..middle + half.y;
    rows.flat_map(|y| (middle - half.x..middle + half.x).map(move |x| (x, y)))
        .map(|(x, y)| ink[(y * SIDE + x) as usize])
        .sum()
}

/// A pane of 61 by 41 pixels before a cube: with the component, the lines of the cube are
/// gone where the pane is, and the pane has a line around it.
#[test]
fn it_has_a_line_and_hides_those_behind_it() {
    let mut small = white();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        empty(&mut small, msaa);
        let turned = Quat::from_euler(EulerRot::XYZ, 0.5, 0.7, 0.1);
        let behind = Transform::from_xyz(0.0, 0.0, -60.0).with_rotation(turned);
        small.put(Cuboid::from_length(34.0), unlit(Color::WHITE), behind);
        let glass = put_glass(&mut small, Rectangle::new(61.0, 41.0));
        let without = ink(&mut small, Outlines::default());
        let (inside, whole) = (UVec2::new(27, 17), UVec2::new(34, 24));
        assert!(total(&without, inside) > 60.0, "the cube has lines");
        assert_eq!(total(&without, whole) - total(&without, inside), 0.0);
        small.on(glass).insert(DepthWrite::default());
        let with = ink(&mut small, Outlines::default());
        assert_eq!(total(&with, inside), 0.0, "{msaa:?}");
        // Its border is 204 pixels long, and lines are two pixels wide.
        let around = total(&with, whole);
        assert!((350.0..460.0).contains(&around), "{msaa:?}: {around}");
        assert_eq!(total(&with, UVec2::splat(60)), around);
    }
}

/// Alpha falls from 1 in the middle of the disc to 0 at this radius, in pixels.
const RAMP: f32 = 50.0;

fn disc(small: &mut Small) -> Handle<Image> {
    let side = 256;
    let texel = |i: u32| {
        let at = Vec2::new((i % side) as f32, (i / side) as f32) + 0.5;
        // The quad is 120 pixels wide.
        let radius = (at - 0.5 * side as f32).length() / side as f32 * SIDE as f32;
        let alpha = (1.0 - radius / RAMP).max(0.0);
        [255, 255, 255, (alpha * 255.0).round() as u8]
    };
    let image = Image::new(
        UVec2::splat(side).to_extents(),
        TextureDimension::D2,
        (0..side * side).flat_map(texel).collect(),
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::default(),
    );
    small.world().resource_mut::<Assets<Image>>().add(image)
}

/// The middle of a pixel, from the middle of the picture.
fn from_middle(pixel: usize) -> Vec2 {
    let at = UVec2::new(pixel as u32 % SIDE, pixel as u32 / SIDE);
    at.as_vec2() + 0.5 - 0.5 * SIDE as f32
}

/// The border lies where the ramp of alpha reaches the threshold, and the line along it.
#[test]
fn the_line_follows_the_threshold() {
    let mut small = white();
    let texture = disc(&mut small);
    let material = StandardMaterial {
        base_color_texture: Some(texture),
        ..white_glass(0.9)
    };
    let square = Rectangle::from_length(SIDE as f32);
    let glass = small.put(square, material, Transform::IDENTITY);
    for alpha_cutoff in [0.2, 0.4, 0.6] {
        small.on(glass).insert(DepthWrite {
            alpha_cutoff,
            ..default()
        });
        let border = RAMP * (1.0 - alpha_cutoff / 0.9);
        let ink = ink(&mut small, Outlines::default());
        let ids = small.ids();
        let (mut sums, mut radii) = ([0.0; 16], [0.0; 16]);
        for (i, ink) in ink.into_iter().enumerate() {
            let at = from_middle(i);
            let radius = at.length();
            let away = (radius - border).abs();
            // A code of the texture is 0.22 pixels of the ramp, a texel 0.5.
            let want = if radius < border {
                small.id_of(glass)
            } else {
                0
            };
            assert!(away <= 0.5 || ids[i] == want, "{alpha_cutoff}: {at}");
            let sector = ((at.to_angle() / std::f32::consts::TAU + 0.5) * 16.0) as usize % 16;
            sums[sector] += ink;
            radii[sector] += ink * radius;
            // The line is two pixels wide, with a soft rim.
            assert!(away <= 2.5 || ink == 0.0, "{alpha_cutoff}: {at}");
        }
        for (sum, radii) in sums.iter().zip(radii) {
            let mean = radii / sum;
            assert!((mean - border).abs() < 0.5, "{mean} instead of {border}");
        }
    }
}

/// The alphas of base color and vertices are factors, in all modes and on both backs.
#[test]
fn every_alpha_counts_in_every_mode() {
    let mut small = white();
    let mut mesh = Mesh::from(Rectangle::new(60.0, 60.0));
    // Alpha 0.25 to the left, 1 to the right.
    let places = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
    let places = places.and_then(|values| values.as_float3());
    let alpha = |place: &[f32; 3]| if place[0] < 0.0 { 0.25 } else { 1.0 };
    let colors: Vec<[f32; 4]> = (places.expect("it has positions").iter())
        .map(|place| [1.0, 1.0, 1.0, alpha(place)])
        .collect();
    mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    let glass = white_glass(0.8);
    let glass = small.put(mesh, glass, Transform::IDENTITY);
    small.style(&outlined(Outlines::default()));
    for alpha_mode in MODES {
        change(&mut small, glass, |m| m.alpha_mode = alpha_mode);
        small.on(glass).remove::<DepthWrite>();
        assert!(small.settle().ids().iter().all(|id| *id == 0));
        small.on(glass).insert(DepthWrite::default());
        let ids = small.settle().ids();
        // 0.8 (0.25 + 0.75 x / 60) is 0.5 where x is 30, in the middle.
        for x in 0..SIDE {
            let found = ids[(SIDE / 2 * SIDE + x) as usize] == small.id_of(glass);
            assert_eq!(found, (60..90).contains(&x), "{alpha_mode:?}: column {x}");
        }
    }
}

/// Components of objects apply to it as to any other mesh.
#[test]
fn it_is_an_object_like_others() {
    let (mut small, glass) = white_pane();
    let parts = (Transform::default(), Visibility::default());
    let root = small.world().spawn(parts).add_child(glass).id();
    let lines = |small: &mut Small| -> f32 { ink(small, Outlines::default()).iter().sum() };
    let own = DepthWrite {
        inherit: false,
        ..default()
    };
    small.on(root).insert(own);
    assert_eq!(lines(&mut small), 0.0, "not inherited");
    small.on(root).insert(DepthWrite::default());
    let plain = lines(&mut small);
    assert!(plain > 400.0, "inherited");
    let middle = (SIDE / 2 * SIDE + SIDE / 2) as usize;
    assert_eq!(small.ids()[middle], small.id_of(glass));

    small.on(glass).insert(OutlineStyle {
        width: Some(4.0),
        ..default()
    });
    let ratio = lines(&mut small) / plain;
    assert!((1.8..2.2).contains(&ratio), "{ratio}");
    small.on(glass).insert(NoOutlines::default());
    assert_eq!(lines(&mut small), 0.0);

    // Color effects leave it alone.
    small.on(glass).remove::<NoOutlines>();
    let red = Color::srgba(0.9, 0.1, 0.1, 0.7);
    change(&mut small, glass, |m| m.base_color = red);
    let sepia = Colorization {
        amount: 1.0,
        ..Colorization::SEPIA
    };
    small.style(&ComicStyle::default().with(sepia)).settle();
    assert!(removed(&small)[middle] != 0.0);
    small.on(glass).insert(NoStyle::default());
    small.settle();
    assert_eq!(removed(&small)[middle], 0.0);
}

/// It runs only where a mesh asks for it, is visible, is transparent, and where depth is read.
#[test]
fn it_runs_only_where_it_does_something() {
    let (mut small, glass) = white_pane();
    let outcome = |small: &mut Small| small.settle().outcome(ComicsStage::TransparentDepth);
    let skipped = |reason| Some(StageOutcome::Skipped(reason));
    let ran = Some(StageOutcome::Ran);
    let no_meshes = skipped(SkipReason::NoSuchMeshes);
    small.style(&outlined(Outlines::SILHOUETTES));
    assert_eq!(outcome(&mut small), no_meshes);
    small.on(glass).insert(DepthWrite::default());
    assert_eq!(outcome(&mut small), ran);
    assert!(small.object_ids().is_none(), "nothing reads the ids");
    assert!(small.normals().is_none(), "nothing reads the normals");
    small.on(glass).insert(Visibility::Hidden);
    assert_eq!(outcome(&mut small), no_meshes);
    small.on(glass).insert(Visibility::Inherited);
    assert_eq!(outcome(&mut small), ran);
    change(&mut small, glass, |m| m.alpha_mode = AlphaMode::Opaque);
    assert_eq!(outcome(&mut small), no_meshes, "the prepass has it");
    change(&mut small, glass, |m| m.alpha_mode = AlphaMode::Blend);
    small.style(&ComicStyle::default().with(ToneBands::default()));
    let no_style = skipped(SkipReason::NoDepthStyle);
    assert_eq!(outcome(&mut small), no_style);
}

/// Temporal anti-aliasing adds motion vectors to the prepass.
#[test]
fn it_works_under_temporal_anti_aliasing() {
    let (mut small, glass) = white_pane();
    small.insert(TemporalAntiAliasing::default());
    small.on(glass).insert(DepthWrite::default());
    small.style(&outlined(Outlines::default()));
    small.headless.step(20);
    let outcome = small.outcome(ComicsStage::TransparentDepth);
    assert_eq!(outcome, Some(StageOutcome::Ran));
    // The view trembles by half a pixel.
    let count = small.pixels_of(glass);
    assert!((58 * 58..=62 * 62).contains(&count), "{count}");
}

/// A transparent material of a game, whose alpha this crate does not know.
#[derive(Asset, AsBindGroup, TypePath, Clone)]
struct Foreign<const PREPASS: bool> {}

impl<const PREPASS: bool> Material for Foreign<PREPASS> {
    fn alpha_mode(&self) -> AlphaMode {
        AlphaMode::Blend
    }

    fn enable_prepass() -> bool {
        PREPASS
    }
}

fn pixels_of_foreign<const PREPASS: bool>(small: &mut Small) -> usize {
    small.restart(Msaa::Off);
    small.clear();
    small.insert(Transform::from_xyz(0.0, 0.0, 3.0));
    let mut materials = small.world().resource_mut::<Assets<Foreign<PREPASS>>>();
    let material = MeshMaterial3d(materials.add(Foreign {}));
    let square = Rectangle::new(1.0, 1.0);
    let mesh = small.put_shared(square, material, Transform::IDENTITY);
    small.on(mesh).insert(DepthWrite::default());
    small.style(&outlined(Outlines::default())).settle();
    small.pixels_of(mesh)
}

/// Of a material that is not like the standard one, the whole mesh is drawn; without a prepass
/// of its own, nothing.
#[test]
fn other_materials_are_drawn_whole_or_not_at_all() {
    // One unit at distance 3, with the field of view of 45 degrees of the default.
    let side = SIDE as f32 / (2.0 * 3.0 * std::f32::consts::FRAC_PI_8.tan());
    let plugins = (
        MaterialPlugin::<Foreign<true>>::default(),
        MaterialPlugin::<Foreign<false>>::default(),
    );
    let small = &mut Small::with_plugins(options(UVec2::splat(SIDE)), Msaa::Off, plugins);
    let count = pixels_of_foreign::<true>(small) as f32;
    assert!((count - side * side).abs() <= 2.0 * side + 1.0, "{count}");
    assert_eq!(pixels_of_foreign::<false>(small), 0);
}
