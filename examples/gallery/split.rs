//! The original on the left, the comic on the right of a line. The style's
//! depth map follows each camera's own half, as it would in split screen.

use bevy::{
    camera::{ClearColorConfig, Hdr, Viewport},
    core_pipeline::tonemapping::Tonemapping,
    light::Skybox,
    prelude::*,
    render::view::Msaa,
    window::PrimaryWindow,
};

use crate::Styled;

pub struct SplitPlugin;

impl Plugin for SplitPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Split { on: false, at: 0.5 })
            .add_systems(PostUpdate, follow);
    }
}

#[derive(Resource)]
pub struct Split {
    pub on: bool,
    /// Fraction of the window's width that shows the original.
    pub at: f32,
}

/// The camera of the original: a whole view, of which the left part is kept.
#[derive(Component)]
struct Original;

type Seen = (
    Entity,
    &'static Transform,
    &'static Projection,
    &'static Skybox,
    &'static Tonemapping,
    &'static Msaa,
    Has<Hdr>,
);

fn follow(
    mut commands: Commands,
    split: Res<Split>,
    window: Query<&Window, With<PrimaryWindow>>,
    styled: Query<Seen, (With<Styled>, Without<Original>)>,
    mut cameras: Query<&mut Camera, With<Styled>>,
    originals: Query<Entity, With<Original>>,
) {
    let (Ok(window), Ok((entity, transform, projection, sky, tonemapping, msaa, hdr))) =
        (window.single(), styled.single())
    else {
        return;
    };
    let size = window.physical_size();
    let left = (size.x as f32 * split.at) as u32;
    let half = |x: u32, width: u32| {
        (split.on && size.min_element() > 16).then(|| Viewport {
            physical_position: UVec2::new(x, 0),
            physical_size: UVec2::new(width.max(1), size.y),
            ..default()
        })
    };
    let sub_view = |x: u32, width: u32| {
        split.on.then(|| bevy::camera::SubCameraView {
            full_size: size,
            offset: Vec2::new(x as f32, 0.0),
            size: UVec2::new(width.max(1), size.y),
        })
    };
    if let Ok(mut camera) = cameras.get_mut(entity) {
        let right = (half(left, size.x - left), sub_view(left, size.x - left));
        let same = match (&camera.viewport, &right.0) {
            (Some(a), Some(b)) => {
                a.physical_position == b.physical_position && a.physical_size == b.physical_size
            }
            (None, None) => true,
            _ => false,
        };
        if !same {
            (camera.viewport, camera.sub_camera_view) = right;
        }
    }
    if !split.on {
        for original in &originals {
            commands.entity(original).despawn();
        }
        return;
    }
    let original = match originals.single() {
        Ok(original) => original,
        Err(_) => commands
            .spawn((
                Original,
                Camera3d::default(),
                Camera {
                    order: 1,
                    clear_color: ClearColorConfig::None,
                    ..default()
                },
            ))
            .id(),
    };
    let part = (half(0, left), sub_view(0, left));
    let mut original = commands.entity(original);
    // The camera component is edited, not replaced: it remembers its target.
    original.entry::<Camera>().and_modify(move |mut camera| {
        (camera.viewport, camera.sub_camera_view) = part;
    });
    original.insert((
        *transform,
        projection.clone(),
        sky.clone(),
        *tonemapping,
        *msaa,
    ));
    if hdr {
        original.insert(Hdr);
    } else {
        original.remove::<Hdr>();
    }
}
