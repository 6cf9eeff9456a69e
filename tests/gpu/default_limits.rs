//! Everything at once within the default limits of WebGPU. They count the entries of bind group
//! layouts, in use or not; `scripts/translate` counts what shaders use.

use bevy_comics::toon::TonalArtMap;

use crate::{
    pairwise::{compare::changed, effects::GROUPS},
    prelude::*,
    sections::{none_has_sections, wait},
    toon, toon_shading,
};

/// A row of four tones, which can be filtered.
fn tones() -> Image {
    let texel = |tone: u8| [tone, tone, tone, 255];
    Image::new(
        Extent3d {
            width: 4,
            height: 1,
            depth_or_array_layers: 1,
        },
        TextureDimension::D2,
        [0, 80, 160, 240].map(texel).concat(),
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::default(),
    )
}

/// A ball with every attribute that the toon material reads.
fn ball() -> Mesh {
    let ball = Sphere::new(0.3).mesh().uv(24, 12);
    let mut ball = ball.with_generated_tangents().expect("coordinates");
    let colors = vec![[1.0f32, 1.0, 1.0, 0.5]; ball.count_vertices()];
    ball.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    ball
}

/// Balls with shadings of the toon material under a light, and a cube with sections. All have
/// every texture, and together every option.
fn put_things(small: &mut Small, shadings: Range<usize>) {
    let world = small.world();
    let towards = Transform::from_xyz(3.0, 5.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y);
    world.spawn((Object, DirectionalLight::default(), towards));
    let mut images = world.resource_mut::<Assets<Image>>();
    let map = images.add(tones());
    let art_map = images.add(TonalArtMap::default().image());
    for (k, shading) in toon_shading::all_kinds().into_iter().enumerate() {
        if !shadings.contains(&k) {
            continue;
        }
        let mut light = shading.light;
        light.threshold_map = Some(map.clone());
        light.ramp_map = map.clone().into();
        // Strokes by planes on every other ball.
        light.art_map = (k % 2 == 0).then(|| art_map.clone());
        let material = toon::material(small, light);
        let at = Transform::from_xyz(0.5 * k as f32 - 1.75, 0.4, 2.2);
        small.put_shared(ball(), material, at);
    }
    let cube = Cuboid::from_length(0.7);
    let at = Transform::from_xyz(0.5, 1.3, 2.0);
    let cube = small.put(cube, StandardMaterial::default(), at);
    small
        .world()
        .entity_mut(cube)
        .insert(MeshSections::default());
}

/// `styles`: how many of two are drawn, all effects with outlines and with a sketch.
fn check(msaa: Msaa, shadings: Range<usize>, styles: usize) {
    let limits = wgpu::Limits::default();
    let options = HeadlessOptions {
        limits: Some(limits.clone()),
        ..options(size())
    };
    let mut small = Small::with(options, msaa);
    let of_device = small.render_world().resource::<RenderDevice>().limits();
    let most = |limits: &wgpu::Limits| limits.max_sampled_textures_per_shader_stage;
    assert!(most(&of_device) <= most(&limits), "other limits");
    // Materials read all of them.
    small.insert((DepthPrepass, NormalPrepass, MotionVectorPrepass));
    let bare = small.settle().picture();
    put_things(&mut small, shadings);
    let plain = small.settle().picture();
    let seen = changed(&bare, &plain);
    assert!(seen > 0.05, "{msaa:?}: {seen} of the picture is new");
    let (_, all) = GROUPS.last().expect("groups");
    // A sketch takes the place of outlines.
    let both = [("outlines", all().without::<Sketch>()), ("sketch", all())];
    for (name, style) in both.into_iter().take(styles) {
        small.style(&style);
        wait(&mut small, |ids| !none_has_sections(ids));
        assert!(small.ran(ComicsStage::Stylize), "{msaa:?}: {name}");
        let off = changed(&plain, &small.picture());
        assert!(off > 0.1, "{msaa:?}: {name} changes {off} of the picture");
    }
}

/// A shading with strokes of a map.
#[test]
fn everything_is_drawn_within_the_default_limits() {
    check(Msaa::Off, 2..3, 1);
}

#[test]
fn everything_is_drawn_within_the_default_limits_with_four_samples() {
    check(Msaa::Sample4, 2..3, 1);
}

#[ignore = "long: every shading of the toon material has large shaders"]
#[test]
fn every_shading_is_drawn_within_the_default_limits() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        check(msaa, 0..toon_shading::all_kinds().len(), 2);
    }
}
