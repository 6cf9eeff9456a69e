//! The scene of the matrix, and the camera of a row.

use bevy::{
    camera::{MainPassResolutionOverride, Projection, SubCameraView},
    core_pipeline::{
        schedule::{Core3d, Core3dSystems},
        tonemapping::tonemapping,
    },
    diagnostic::FrameCount,
    pbr::DefaultOpaqueRendererMethod,
    render::{
        renderer::{RenderContext, ViewQuery},
        view::ViewTarget,
    },
};
use wgpu::util::TextureBlitter;

use super::covering::{AntiAliasing, Area, Row, View};
use crate::{prelude::*, toon, upscaled::override_main_pass};

/// Size of the target.
pub const SIZE: UVec2 = UVec2::new(144, 96);
/// A viewport of the same shape, at odd places.
pub const PART: URect = URect {
    min: UVec2::new(13, 7),
    max: UVec2::new(103, 67),
};
/// The color of the target where no camera draws: magenta, which the scene does not have.
pub const OUTSIDE: [u8; 3] = [255, 0, 255];

/// Frames until a change has reached the picture and the diagnostics. The history of TAA takes
/// longer.
const SETTLE: usize = 5;
const SETTLE_HISTORY: usize = 32;

/// Stands for an upscaler: before the effects, the corner that the main pass has drawn fills the
/// picture. A texel becomes a square of pixels.
struct Upscaler;

impl Plugin for Upscaler {
    fn build(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        let upscale = upscale
            .in_set(Core3dSystems::PostProcess)
            .before(tonemapping);
        render_app.add_systems(Core3d, upscale);
    }
}

fn upscale(
    view: ViewQuery<(&ViewTarget, &MainPassResolutionOverride)>,
    device: Res<RenderDevice>,
    mut ctx: RenderContext,
) {
    let (target, size) = view.into_inner();
    let picture = target.main_texture();
    let device = device.wgpu_device();
    let corner = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("corner of the main pass"),
        size: Extent3d {
            width: size.0.x,
            height: size.0.y,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: picture.format(),
        usage: wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let encoder = ctx.command_encoder();
    encoder.copy_texture_to_texture(
        picture.as_image_copy(),
        corner.as_image_copy(),
        corner.size(),
    );
    let corner = corner.create_view(&wgpu::TextureViewDescriptor::default());
    let blitter = TextureBlitter::new(device, picture.format());
    blitter.copy(device, encoder, &corner, target.main_texture_view());
}

/// An app with the scene, whose opaque standard materials are drawn by one method. For views with a
/// small main pass it has to scale up.
pub fn app(deferred: bool, scales_up: bool) -> Small {
    let mut small = if scales_up {
        Small::with_plugins(options(SIZE), Msaa::Off, Upscaler)
    } else {
        Small::new(SIZE, Msaa::Off)
    };
    small.clear();
    let [red, green, blue] = OUTSIDE.map(|code| f32::from(code) / 255.0);
    let world = small.world();
    world.insert_resource(ClearColor(Color::srgb(red, green, blue)));
    if deferred {
        world.insert_resource(DefaultOpaqueRendererMethod::deferred());
    }
    world.insert_resource(GlobalAmbientLight {
        brightness: 100.0,
        ..default()
    });
    world.spawn((
        DirectionalLight {
            illuminance: 1500.0,
            ..default()
        },
        Transform::from_xyz(3.0, 5.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    put_things(&mut small);
    put_cards(&mut small);
    small
}

/// A floor without light, a matt box with light, a toon sphere, and a pane of glass.
fn put_things(small: &mut Small) {
    let floor = Plane3d::default().mesh().size(6.0, 6.0);
    let sand = unlit(Color::srgb(0.8, 0.7, 0.5));
    small.put(floor, sand, Transform::IDENTITY);
    // Without highlights, which deferred pixels would have elsewhere.
    let matt = StandardMaterial {
        base_color: Color::srgb(0.85, 0.3, 0.2),
        perceptual_roughness: 1.0,
        reflectance: 0.0,
        ..default()
    };
    let turned = Transform::from_xyz(-0.8, 0.6, 0.8).with_rotation(Quat::from_rotation_y(0.5));
    small.put(Cuboid::from_length(1.2), matt, turned);
    let toon = toon::material(small, ToonLight::default());
    let sphere = Sphere::new(0.8).mesh().uv(32, 18);
    small.put_shared(sphere, toon, Transform::from_xyz(1.1, 0.8, -0.6));
    let glass = StandardMaterial {
        alpha_mode: AlphaMode::Blend,
        ..unlit(Color::srgba(0.3, 0.8, 0.9, 0.5))
    };
    small.put(
        Rectangle::new(1.0, 0.8),
        glass,
        Transform::from_xyz(0.4, 0.7, 1.6),
    );
}

fn eye() -> Transform {
    Transform::from_xyz(1.5, 2.4, 6.0).looking_at(Vec3::new(0.0, 0.4, 0.0), Vec3::Y)
}

/// The nearest and the farthest thing are cards across the view, each at one distance: so the range
/// of depth does not depend on which points of pixels are drawn, and pictures with other samples,
/// jitter or resolution have the same depth map.
fn put_cards(small: &mut Small) {
    let cards = [
        (Vec3::new(-1.0, -0.5, -2.5), Vec2::splat(0.5), 0.9),
        (Vec3::new(3.0, 2.4, -12.0), Vec2::new(3.0, 2.0), 0.6),
    ];
    for (at, size, gray) in cards {
        let card = unlit(Color::srgb(gray, gray, 0.7));
        let at = eye() * Transform::from_translation(at);
        small.put(Rectangle::new(size.x, size.y), card, at);
    }
}

fn projection(view: View) -> Projection {
    let perspective = PerspectiveProjection::default();
    match view {
        View::Perspective | View::OffCenter => Projection::Perspective(perspective),
        View::Orthographic => Projection::Orthographic(OrthographicProjection {
            near: 0.1,
            far: 40.0,
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: 4.6,
            },
            ..OrthographicProjection::default_3d()
        }),
        // Tilted by 6 degrees, and in front of the nearest card.
        View::ClipPlane => Projection::Perspective(PerspectiveProjection {
            near_clip_plane: Vec4::new(0.05, 0.1, -1.0, -0.5),
            ..perspective
        }),
    }
}

/// The part of the target that the camera draws.
pub fn rect(area: Area, target: UVec2) -> URect {
    match area {
        Area::Part => PART,
        Area::Whole | Area::SmallMainPass => URect {
            min: UVec2::ZERO,
            max: target,
        },
    }
}

fn camera(row: &Row) -> Camera {
    Camera {
        clear_color: Color::srgb(0.3, 0.5, 0.8).into(),
        viewport: (row.area == Area::Part).then(|| Viewport {
            physical_position: PART.min,
            physical_size: PART.size(),
            ..default()
        }),
        sub_camera_view: (row.view == View::OffCenter).then_some(SubCameraView {
            full_size: UVec2::new(180, 120),
            offset: Vec2::new(24.0, 6.0),
            size: SIZE,
        }),
        ..default()
    }
}

fn spawn_camera(world: &mut World, row: &Row, target: RenderTarget) -> Entity {
    let mut spawned = world.spawn((
        Camera3d::default(),
        camera(row),
        projection(row.view),
        eye(),
        (Tonemapping::None, DebandDither::Disabled),
        target,
        Msaa::from_samples(row.samples),
    ));
    if row.hdr {
        spawned.insert(Hdr);
    }
    if row.deferred {
        spawned.insert((DepthPrepass, DeferredPrepass));
    }
    match row.anti_aliasing {
        AntiAliasing::Off => {}
        AntiAliasing::Fxaa => {
            spawned.insert(Fxaa::default());
        }
        AntiAliasing::Smaa => {
            spawned.insert(Smaa::default());
        }
        AntiAliasing::Taa => {
            spawned.insert(TemporalAntiAliasing::default());
        }
    }
    spawned.id()
}

/// Replaces the camera by a new one, without history, and draws the scene with it until the picture
/// is settled. Without a style it has a depth prepass; a style requests what it needs.
pub fn shoot(small: &mut Small, row: &Row, size: UVec2, style: Option<&ComicStyle>) {
    if small.headless.options.size != size {
        small.headless.resize(size, 1.0);
    }
    let target = small.headless.render_target();
    let old = small.camera;
    let world = small.world();
    world.despawn(old);
    small.camera = spawn_camera(world, row, target);
    let half = (row.area == Area::SmallMainPass).then_some(size / 2);
    override_main_pass(small, half);
    match style {
        Some(style) => small.style(style),
        None => small.insert(DepthPrepass),
    };
    let frames = if row.is_temporal() {
        SETTLE_HISTORY
    } else {
        SETTLE
    };
    small.headless.step(frames);
    // The jitter of TAA repeats after eight frames. Where pipelines were compiled, there were more frames.
    while row.is_temporal() && !small.world().resource::<FrameCount>().0.is_multiple_of(8) {
        small.headless.step(1);
    }
}
