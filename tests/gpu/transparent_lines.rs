//! Transparent meshes with `DepthWrite`: lines and colour effects see them.

use bevy::render::render_resource::AsBindGroup;

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

fn change(small: &mut Small, object: Entity, change: impl Fn(&mut StandardMaterial)) {
    let world = small.world();
    let id = world
        .get::<MeshMaterial3d<StandardMaterial>>(object)
        .expect("it has one")
        .0
        .id();
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    change(&mut materials.get_mut(id).expect("it is there"));
}

fn write_depth(small: &mut Small, object: Entity) {
    small
        .world()
        .entity_mut(object)
        .insert(DepthWrite::default());
}

fn faithful() -> Outlines {
    let form = Equations::Faithful;
    Outlines {
        silhouettes: Some(Silhouettes {
            equations: form,
            ..default()
        }),
        creases: Some(Creases {
            equations: form,
            ..default()
        }),
        ..default()
    }
}

/// Styles that together read everything that the pass writes.
fn styles() -> [ComicStyle; 5] {
    [
        outlined(Outlines::default()),
        outlined(faithful()),
        outlined(Outlines {
            opacity_fade: 0.7,
            weight: LineWeight {
                shade: 1.5,
                ..default()
            },
            ..default()
        }),
        ComicStyle::default()
            .with(Desaturation::default())
            .with(Colorization::default())
            .with(Contours::default()),
        ComicStyle::default().with(Sketch {
            // Its strokes move with time.
            rate: 0.0,
            ..default()
        }),
    ]
}

/// An opaque mesh and a transparent one whose alpha is 1 have the same colours, so that the
/// styled pictures are equal, if the transparent one is in depth, normals and ids.
#[test]
fn it_is_drawn_as_an_opaque_mesh_would_be() {
    let [outlines, .., colors, _] = styles();
    assert_drawn_as_opaque(&[Msaa::Off], &[outlines, colors]);
}

#[test]
#[ignore = "long: more styles, with and without multisampling"]
fn it_is_drawn_in_every_style_as_an_opaque_mesh_would_be() {
    assert_drawn_as_opaque(&[Msaa::Off, Msaa::Sample4], &styles());
}

fn assert_drawn_as_opaque(msaas: &[Msaa], styles: &[ComicStyle]) {
    let mut small = Small::new(size(), Msaa::Off);
    for &msaa in msaas {
        small.restart(msaa);
        let pane = pane(&mut small, unlit(Color::srgb(0.3, 0.8, 0.9)));
        let map = DepthMap {
            smoothing: None,
            ..default()
        };
        small.insert((VisibleDepthRange::default(), map));
        for (i, style) in styles.iter().enumerate() {
            let draw = |small: &mut Small, alpha_mode, writes: bool| {
                change(small, pane, |m| m.alpha_mode = alpha_mode);
                small.world().entity_mut(pane).remove::<DepthWrite>();
                if writes {
                    write_depth(small, pane);
                }
                small.style(style);
                small.settle();
                (small.pass(), small.range())
            };
            let opaque = draw(&mut small, AlphaMode::Opaque, false);
            let without = draw(&mut small, AlphaMode::Blend, false);
            let with = draw(&mut small, AlphaMode::Blend, true);
            assert_eq!(opaque.0.0.pixels, with.0.0.pixels, "{msaa:?}: inputs");
            assert_eq!(without.0.0.pixels, with.0.0.pixels, "{msaa:?}: inputs");
            assert_ne!(without.0.1.pixels, with.0.1.pixels, "{msaa:?}, {i}");
            let same = opaque.0.1.pixels == with.0.1.pixels;
            assert!(same, "{msaa:?}, {i}");
            assert_eq!(opaque.1, with.1, "{msaa:?}, {i}: the visible range");
        }
        assert_eq!(small.errors(), 0);
    }
}

/// The debug views, which show depth, normals' creases and ids themselves.
#[test]
fn debug_views_show_it() {
    assert_debug_views_show_it(Msaa::Sample4);
}

#[test]
#[ignore = "long: shaders of their own; `debug_views_show_it` has those of four samples"]
fn debug_views_of_one_sample_show_it() {
    assert_debug_views_show_it(Msaa::Off);
}

fn assert_debug_views_show_it(msaa: Msaa) {
    let mut small = Small::new(size(), msaa);
    let pane = pane(&mut small, unlit(Color::srgb(0.3, 0.8, 0.9)));
    for view in [
        DebugView::DepthMap,
        DebugView::RawRange,
        DebugView::Silhouettes,
        DebugView::Creases,
        DebugView::ObjectIds,
    ] {
        small.insert(view);
        let mut draw = |alpha_mode| {
            change(&mut small, pane, |m| m.alpha_mode = alpha_mode);
            write_depth(&mut small, pane);
            small.settle();
            small.picture()
        };
        let opaque = draw(AlphaMode::Opaque);
        assert!(opaque == draw(AlphaMode::Blend), "{msaa:?}: {view:?}");
    }
    assert_eq!(small.errors(), 0);
}

/// The engine's depth, and the picture that the pass reads, are bit for bit as without.
#[test]
fn the_engine_draws_what_it_drew() {
    let mut small = Small::new(size(), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        let glass = pane(
            &mut small,
            StandardMaterial {
                base_color: Color::srgba(0.9, 0.2, 0.2, 0.6),
                alpha_mode: AlphaMode::Blend,
                ..default()
            },
        );
        let lamp = PointLight {
            shadow_maps_enabled: true,
            ..default()
        };
        small.world().spawn((Object, lamp));
        small.style(&outlined(Outlines::default()));
        let mut draw = || {
            small.settle();
            let depth = small.depth().expect("a prepass").bits;
            let normals = small.normals().expect("a prepass").pixels;
            let (input, output) = small.pass();
            (depth, normals, input.pixels, output.pixels)
        };
        let before = draw();
        write_depth(&mut small, glass);
        let mut draw = || {
            small.settle();
            let depth = small.depth().expect("a prepass").bits;
            let normals = small.normals().expect("a prepass").pixels;
            let (input, output) = small.pass();
            (depth, normals, input.pixels, output.pixels)
        };
        let after = draw();
        assert_eq!(before.0, after.0, "{msaa:?}: depth");
        assert_eq!(before.1, after.1, "{msaa:?}: normals");
        assert_eq!(before.2, after.2, "{msaa:?}: picture");
        assert_ne!(before.3, after.3, "{msaa:?}: it does something");
        // Removing the component restores today's picture; so does despawning the mesh.
        small.world().entity_mut(glass).remove::<DepthWrite>();
        small.settle();
        assert_eq!(before.3, small.pass().1.pixels, "{msaa:?}: removed");
        assert!(!small.ran(ComicsStage::TransparentDepth));
        small.world().despawn(glass);
        small.settle();
        let empty = small.pass().1.pixels;
        let glass = pane(
            &mut small,
            StandardMaterial {
                base_color: Color::srgba(0.9, 0.2, 0.2, 0.6),
                alpha_mode: AlphaMode::Blend,
                ..default()
            },
        );
        write_depth(&mut small, glass);
        small.settle();
        small.world().despawn(glass);
        small.settle();
        assert_eq!(empty, small.pass().1.pixels, "{msaa:?}: despawned");
        assert_eq!(small.errors(), 0);
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
    small.restart(msaa);
    small.clear();
    small.insert((
        Transform::from_xyz(0.0, 0.0, 0.5 * SIDE as f32),
        Projection::Perspective(PerspectiveProjection {
            fov: std::f32::consts::FRAC_PI_2,
            ..default()
        }),
    ));
    let camera = small.camera;
    let mut camera = small.world().get_mut::<Camera>(camera).expect("a camera");
    camera.clear_color = Color::WHITE.into();
}

fn white_glass(alpha: f32, alpha_mode: AlphaMode) -> StandardMaterial {
    StandardMaterial {
        alpha_mode,
        ..unlit(Color::linear_rgba(1.0, 1.0, 1.0, alpha))
    }
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
        let glass = small.put(
            Rectangle::new(61.0, 41.0),
            white_glass(0.6, AlphaMode::Blend),
            Transform::IDENTITY,
        );
        let outlines = Outlines::default();
        let without = ink(&mut small, outlines);
        let inside = UVec2::new(27, 17);
        let whole = UVec2::new(34, 24);
        assert!(total(&without, inside) > 60.0, "the cube has lines");
        assert_eq!(total(&without, whole) - total(&without, inside), 0.0);
        write_depth(&mut small, glass);
        let with = ink(&mut small, outlines);
        assert_eq!(total(&with, inside), 0.0, "{msaa:?}");
        // Its border is 204 pixels long, and lines are two pixels wide.
        let around = total(&with, whole);
        assert!((350.0..460.0).contains(&around), "{msaa:?}: {around}");
        assert_eq!(total(&with, UVec2::splat(60)), around);
        assert_eq!(small.errors(), 0);
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
        Extent3d {
            width: side,
            height: side,
            depth_or_array_layers: 1,
        },
        TextureDimension::D2,
        (0..side * side).flat_map(texel).collect(),
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::default(),
    );
    small.world().resource_mut::<Assets<Image>>().add(image)
}

/// Distance of the middle of a pixel from the middle of the picture.
fn radius(pixel: usize) -> f32 {
    let at = UVec2::new(pixel as u32 % SIDE, pixel as u32 / SIDE);
    (at.as_vec2() + 0.5 - 0.5 * SIDE as f32).length()
}

/// The border lies where the ramp of alpha reaches the threshold, and the line along it.
#[test]
fn the_line_follows_the_threshold() {
    let mut small = white();
    let texture = disc(&mut small);
    let material = StandardMaterial {
        base_color_texture: Some(texture),
        ..white_glass(0.9, AlphaMode::Blend)
    };
    let glass = small.put(
        Rectangle::new(SIDE as f32, SIDE as f32),
        material,
        Transform::IDENTITY,
    );
    for alpha_cutoff in [0.2, 0.4, 0.6] {
        let write = DepthWrite {
            alpha_cutoff,
            ..default()
        };
        small.world().entity_mut(glass).insert(write);
        let border = RAMP * (1.0 - alpha_cutoff / 0.9);
        let ink = ink(&mut small, Outlines::default());
        let ids = small.object_ids().expect("drawn").pixels;
        let id = u32::from(object_id(glass));
        // A code of the texture is 0.22 pixels of the ramp, a texel 0.5.
        for (i, found) in ids.iter().enumerate() {
            if (radius(i) - border).abs() > 0.5 {
                let want = if radius(i) < border { id } else { 0 };
                assert_eq!(found[0], want, "{alpha_cutoff}: pixel {i}");
            }
        }
        let (mut sums, mut radii) = ([0.0; 16], [0.0; 16]);
        for (i, ink) in ink.iter().enumerate() {
            let at = Vec2::new((i as u32 % SIDE) as f32, (i as u32 / SIDE) as f32);
            let angle = (at + 0.5 - 0.5 * SIDE as f32).to_angle();
            let sector = ((angle / std::f32::consts::TAU + 0.5) * 16.0) as usize % 16;
            sums[sector] += ink;
            radii[sector] += ink * radius(i);
            // The line is two pixels wide, with a soft rim.
            let far = (radius(i) - border).abs() > 2.5;
            assert!(!far || *ink == 0.0, "{alpha_cutoff}: pixel {i}");
        }
        for (sum, radii) in sums.iter().zip(radii) {
            let mean = radii / sum;
            assert!((mean - border).abs() < 0.5, "{mean} instead of {border}");
        }
    }
    assert_eq!(small.errors(), 0);
}

/// The alphas of base colour and vertices are factors, in all modes and on both backs.
#[test]
fn every_alpha_counts_in_every_mode() {
    let mut small = white();
    let mut mesh = Mesh::from(Rectangle::new(60.0, 60.0));
    // Alpha 0.25 to the left, 1 to the right.
    let Some(VertexAttributeValues::Float32x3(places)) = mesh.attribute(Mesh::ATTRIBUTE_POSITION)
    else {
        panic!("it has positions");
    };
    let colors: Vec<[f32; 4]> = places
        .iter()
        .map(|p| [1.0, 1.0, 1.0, if p[0] < 0.0 { 0.25 } else { 1.0 }])
        .collect();
    mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    let glass = small.put(
        mesh,
        white_glass(0.8, AlphaMode::Blend),
        Transform::IDENTITY,
    );
    let id = u32::from(object_id(glass));
    small.style(&outlined(Outlines::default()));
    for alpha_mode in MODES {
        change(&mut small, glass, |m| m.alpha_mode = alpha_mode);
        small.world().entity_mut(glass).remove::<DepthWrite>();
        small.settle();
        assert!(
            small
                .object_ids()
                .expect("drawn")
                .pixels
                .iter()
                .all(|p| p[0] == 0)
        );
        write_depth(&mut small, glass);
        small.settle();
        let ids = small.object_ids().expect("drawn").pixels;
        // 0.8 (0.25 + 0.75 x / 60) is 0.5 where x is 30, in the middle.
        for x in 0..SIDE {
            let found = ids[(SIDE / 2 * SIDE + x) as usize][0] == id;
            assert_eq!(found, (60..90).contains(&x), "{alpha_mode:?}: column {x}");
        }
    }
    assert_eq!(small.errors(), 0);
}

/// Components of objects apply to it as to any other mesh.
#[test]
fn it_is_an_object_like_others() {
    let mut small = white();
    let glass = small.put(
        Rectangle::new(60.0, 60.0),
        white_glass(0.6, AlphaMode::Blend),
        Transform::IDENTITY,
    );
    let root = small
        .world()
        .spawn((Transform::default(), Visibility::default()))
        .add_child(glass)
        .id();
    let outlines = Outlines::default();
    small.world().entity_mut(root).insert(DepthWrite {
        inherit: false,
        ..default()
    });
    let none = ink(&mut small, outlines);
    assert_eq!(total(&none, UVec2::splat(60)), 0.0, "not inherited");
    small.world().entity_mut(root).insert(DepthWrite::default());
    let plain = ink(&mut small, outlines);
    assert!(total(&plain, UVec2::splat(60)) > 400.0, "inherited");
    let ids = small.object_ids().expect("drawn").pixels;
    let middle = (SIDE / 2 * SIDE + SIDE / 2) as usize;
    assert_eq!(ids[middle][0], u32::from(object_id(glass)));

    let style = OutlineStyle {
        width: Some(4.0),
        ..default()
    };
    small.world().entity_mut(glass).insert(style);
    let wide = ink(&mut small, outlines);
    let ratio = total(&wide, UVec2::splat(60)) / total(&plain, UVec2::splat(60));
    assert!((1.8..2.2).contains(&ratio), "{ratio}");
    small
        .world()
        .entity_mut(glass)
        .insert(NoOutlines::default());
    let without = ink(&mut small, outlines);
    assert_eq!(total(&without, UVec2::splat(60)), 0.0);

    // Colour effects leave it alone.
    small.world().entity_mut(glass).remove::<NoOutlines>();
    change(&mut small, glass, |m| {
        m.base_color = Color::srgba(0.9, 0.1, 0.1, 0.7);
    });
    let sepia = Colorization {
        amount: 1.0,
        ..Colorization::SEPIA
    };
    let red = |small: &mut Small| {
        small.style(&ComicStyle::default().with(sepia));
        small.settle();
        removed(small)[middle]
    };
    assert!(red(&mut small) != 0.0);
    small.world().entity_mut(glass).insert(NoStyle::default());
    assert_eq!(red(&mut small), 0.0);
    assert_eq!(small.errors(), 0);
}

fn outcome(small: &Small) -> StageOutcome {
    let diagnostics = small.headless.app.world().resource::<ComicsDiagnostics>();
    let stages = &diagnostics.cameras[&small.camera];
    stages
        .outcome(ComicsStage::TransparentDepth)
        .expect("reported")
}

/// It runs only where a mesh asks for it, is visible, is transparent, and where depth is read.
#[test]
fn it_runs_only_where_it_does_something() {
    let mut small = white();
    let glass = small.put(
        Rectangle::new(60.0, 60.0),
        white_glass(0.6, AlphaMode::Blend),
        Transform::IDENTITY,
    );
    let no_meshes = StageOutcome::Skipped(SkipReason::NoSuchMeshes);
    small.style(&outlined(Outlines::SILHOUETTES));
    small.settle();
    assert_eq!(outcome(&small), no_meshes);
    write_depth(&mut small, glass);
    small.settle();
    assert_eq!(outcome(&small), StageOutcome::Ran);
    assert!(small.object_ids().is_none(), "nothing reads the ids");
    assert!(small.normals().is_none(), "nothing reads the normals");
    let hidden = |small: &mut Small, visibility: Visibility| {
        small.world().entity_mut(glass).insert(visibility);
        small.settle();
        outcome(small)
    };
    assert_eq!(hidden(&mut small, Visibility::Hidden), no_meshes);
    assert_eq!(hidden(&mut small, Visibility::Inherited), StageOutcome::Ran);
    change(&mut small, glass, |m| m.alpha_mode = AlphaMode::Opaque);
    small.settle();
    assert_eq!(outcome(&small), no_meshes, "the prepass has it");
    change(&mut small, glass, |m| m.alpha_mode = AlphaMode::Blend);
    let bands = ComicStyle::default().with(ToneBands::default());
    small.style(&bands);
    small.settle();
    assert_eq!(
        outcome(&small),
        StageOutcome::Skipped(SkipReason::NoDepthStyle)
    );
    assert_eq!(small.errors(), 0);
}

/// Temporal anti-aliasing adds motion vectors to the prepass.
#[test]
fn it_works_under_temporal_anti_aliasing() {
    let mut small = white();
    let glass = small.put(
        Rectangle::new(60.0, 60.0),
        white_glass(0.6, AlphaMode::Blend),
        Transform::IDENTITY,
    );
    small.insert(TemporalAntiAliasing::default());
    write_depth(&mut small, glass);
    small.style(&outlined(Outlines::default()));
    small.headless.step(20);
    assert_eq!(outcome(&small), StageOutcome::Ran);
    let ids = small.object_ids().expect("drawn").pixels;
    let id = u32::from(object_id(glass));
    let count = ids.iter().filter(|p| p[0] == id).count();
    // The view trembles by half a pixel.
    assert!((58 * 58..=62 * 62).contains(&count), "{count}");
    assert_eq!(small.errors(), 0);
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

fn ids_of_foreign<const PREPASS: bool>() -> usize {
    let plugin = MaterialPlugin::<Foreign<PREPASS>>::default();
    let mut small = Small::with_plugins(options(UVec2::splat(SIDE)), Msaa::Off, plugin);
    small.clear();
    small.insert(Transform::from_xyz(0.0, 0.0, 3.0));
    let world = small.world();
    let material = world
        .resource_mut::<Assets<Foreign<PREPASS>>>()
        .add(Foreign {});
    let at = Transform::IDENTITY;
    let mesh = small.put_shared(Rectangle::new(1.0, 1.0), MeshMaterial3d(material), at);
    write_depth(&mut small, mesh);
    small.style(&outlined(Outlines::default()));
    small.settle();
    assert_eq!(small.errors(), 0);
    let ids = small.object_ids().expect("drawn").pixels;
    let id = u32::from(object_id(mesh));
    ids.iter().filter(|p| p[0] == id).count()
}

/// Of a material that is not like the standard one, the whole mesh is drawn; without a prepass
/// of its own, nothing.
#[test]
fn other_materials_are_drawn_whole_or_not_at_all() {
    // One unit at distance 3, with the field of view of 45 degrees of the default.
    let side = SIDE as f32 / (2.0 * 3.0 * std::f32::consts::FRAC_PI_8.tan());
    let count = ids_of_foreign::<true>() as f32;
    assert!((count - side * side).abs() <= 2.0 * side + 1.0, "{count}");
    assert_eq!(ids_of_foreign::<false>(), 0);
}

#[test]
fn thresholds_are_clamped() {
    let used = |alpha_cutoff| {
        let write = DepthWrite {
            alpha_cutoff,
            ..default()
        };
        write.sanitized().alpha_cutoff
    };
    for (set, want) in [
        (-1.0, 0.01),
        (0.0, 0.01),
        (0.7, 0.7),
        (2.0, 1.0),
        (f32::NAN, 0.5),
        (f32::INFINITY, 0.5),
    ] {
        assert_eq!(used(set), want);
    }
}
