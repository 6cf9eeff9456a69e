//! Regions with a style of their own.

use bevy::{
    camera::visibility::RenderLayers, ecs::system::SystemChangeTick, math::Affine3A, prelude::*,
};

use super::{
    ComicStyle, StyleTransition,
    layer::{PlaceStyle, SeenVolume, StyleLayer, applied_style, graded, lay_over, own_style},
};

/// A region with a style of its own: the unit cube under the entity's transform, as of Bevy's
/// `FogVolume`. Cameras with [`InStyleVolumes`] have its style while they are in it.
///
/// The weight of the style depends only on the position of the camera, so it is the same at every
/// frame rate and in both directions. Volumes with a higher priority lie over the others; among
/// equal priorities, that of the later entity lies on top. Each is [blended](ComicStyle::blend)
/// into what is below it. A hidden volume, one that is scaled to 0, one whose style has not loaded,
/// and one without a render layer of the camera count as absent.
///
/// ```
/// # use bevy::prelude::*;
/// use bevy_comics::{presets, style::{InStyleVolumes, StyleVolume}};
///
/// fn spawn(mut commands: Commands, assets: Res<AssetServer>) {
///     commands.spawn((
///         StyleVolume {
///             style: assets.load(presets::NOIR.path()),
///             margin: 4.0,
///             ..default()
///         },
///         Transform::from_xyz(0.0, 3.0, -14.0).with_scale(Vec3::new(24.0, 12.0, 24.0)),
///     ));
///     commands.spawn((Camera3d::default(), InStyleVolumes));
/// }
/// ```
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
#[require(Transform, Visibility)]
pub struct StyleVolume {
    /// The style inside. A partial style lies over what the camera has without this volume.
    pub style: Handle<ComicStyle>,
    /// Distance around the cube over which the style fades out, in world units. Infinite: the style
    /// is seen everywhere. Negative and NaN count as 0. Default: 0.
    pub margin: f32,
    /// The volume with the highest number lies over the others. Default: 0.
    pub priority: i32,
}

/// On a camera: it has the styles of the [`StyleVolume`]s that it is in, over its own style and
/// that of its [`Comic`](super::Comic).
///
/// Outside of all volumes, and after this component was removed, the camera has the style that it
/// had before. A [`StyleTransition`] comes before volumes, which wait until it has finished.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct InStyleVolumes;

/// How much of a volume is seen from a place, 0 to 1.
fn weight(volume: &Affine3A, margin: f32, eye: Vec3A) -> f32 {
    let half = Vec3A::splat(0.5);
    let inside = volume.inverse().transform_point3a(eye);
    if !inside.is_finite() {
        // It is flat.
        return 0.0;
    }
    if inside.abs().cmple(half).all() {
        return 1.0;
    }
    let nearest = volume.transform_point3a(inside.clamp(-half, half));
    (1.0 - nearest.distance(eye) / margin.max(0.0)).max(0.0)
}

type Volume<'w> = (
    Entity,
    &'w StyleVolume,
    &'w GlobalTransform,
    &'w InheritedVisibility,
    Option<&'w RenderLayers>,
);

type StyledCamera<'w> = (
    Entity,
    &'w GlobalTransform,
    Option<&'w RenderLayers>,
    (Has<InStyleVolumes>, Has<StyleTransition>),
    Option<Ref<'w, StyleLayer>>,
    Option<Ref<'w, PlaceStyle>>,
);

pub(super) fn style_by_place(
    mut commands: Commands,
    places: Query<Volume>,
    cameras: Query<StyledCamera, Or<(With<InStyleVolumes>, With<PlaceStyle>)>>,
    tick: SystemChangeTick,
    mut events: MessageReader<AssetEvent<ComicStyle>>,
    styles: Res<Assets<ComicStyle>>,
) {
    let changed = events.read().filter_map(|event| match event {
        AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(*id),
        _ => None,
    });
    let changed: Vec<_> = changed.collect();
    for (entity, place, layers, (takes_part, in_transition), layer, known) in &cameras {
        if in_transition {
            continue;
        }
        // Another style was applied meanwhile, over that of the volumes.
        let is_new = known.as_ref().is_some_and(|known| {
            layer.is_none_or(|layer| {
                (layer.last_changed()).is_newer_than(known.last_changed(), tick.this_run())
            })
        });
        let layers = layers.unwrap_or_default();
        let mut seen: Vec<_> = (places.iter().filter(|_| takes_part))
            .filter(|(.., visibility, on)| {
                visibility.get() && on.unwrap_or_default().intersects(layers)
            })
            .filter_map(|(entity, volume, at, ..)| {
                let style = styles.get(&volume.style)?;
                let weight = weight(&at.affine(), volume.margin, place.translation_vec3a());
                (weight > 0.0).then_some(((volume.priority, entity), weight, volume, style))
            })
            .collect();
        seen.sort_by_key(|(order, ..)| *order);
        let edited = (seen.iter()).any(|(.., volume, _)| changed.contains(&volume.style.id()));
        let volumes: Vec<_> = seen
            .iter()
            .map(|((_, entity), weight, volume, _)| (*entity, volume.style.id(), *weight))
            .collect();
        let same = (known.as_ref()).map_or(volumes.is_empty(), |known| known.volumes == volumes);
        if same && !is_new && !edited {
            continue;
        }
        let below = known.filter(|_| !is_new).map(|known| known.below.clone());
        let seen = seen.into_iter();
        let parts: Vec<_> = seen
            .map(|(_, weight, _, style)| (style.clone(), weight))
            .collect();
        commands
            .entity(entity)
            .queue(move |mut camera: EntityWorldMut| {
                let below = below.unwrap_or_else(|| applied_style(&camera));
                apply(&mut camera, &parts, below, volumes);
            });
    }
}

/// Lays the styles of volumes over a camera's own style and the one that was applied to it.
fn apply(
    camera: &mut EntityWorldMut,
    parts: &[(ComicStyle, f32)],
    below: Option<ComicStyle>,
    volumes: Vec<SeenVolume>,
) {
    if parts.is_empty() {
        camera.remove::<PlaceStyle>();
        match below {
            Some(style) => style.lay_over(camera),
            None => ComicStyle::take_off(camera),
        }
        return;
    }
    let own = own_style(camera);
    // What all of them say nothing about belongs to the game.
    let base = below.clone().unwrap_or_else(|| ComicStyle::new().partial());
    let mut style = graded(camera, &base);
    let mut look = style.over(&own);
    for (part, weight) in parts {
        look = look.blend(&part.over(&look), *weight);
        style = part.over(&style);
    }
    lay_over(camera, own, [base, style], look);
    camera.insert(PlaceStyle { volumes, below });
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn the_weight_is_one_inside_and_falls_evenly_with_the_distance() {
        let turned = Quat::from_rotation_y(0.7);
        let at = Vec3::new(100.0, 0.0, -7.0);
        let volume =
            Affine3A::from_scale_rotation_translation(Vec3::new(4.0, 6.0, 8.0), turned, at);
        let seen = |place: Vec3, margin| weight(&volume, margin, (at + turned * place).into());
        assert_eq!(seen(Vec3::new(1.9, -2.9, 3.9), 5.0), 1.0);
        assert_eq!(seen(Vec3::new(0.0, 0.0, 9.1), 5.0), 0.0);
        assert!((seen(Vec3::new(0.0, 0.0, -6.5), 5.0) - 0.5).abs() < 1e-5);
        // From a corner, along its diagonal.
        let corner = Vec3::new(2.0, 3.0, 4.0);
        let away = corner + Vec3::ONE.normalize();
        assert!((seen(away, 5.0) - 0.8).abs() < 1e-5);
        assert_eq!(seen(corner * 1.01, 0.0), 0.0);
        assert_eq!(seen(corner * 0.99, 0.0), 1.0);
        assert_eq!(seen(corner * 50.0, f32::INFINITY), 1.0);
        for bad in [f32::NAN, -1.0] {
            assert_eq!(seen(corner * 1.01, bad), 0.0);
        }
        let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
        assert_eq!(weight(&flat, 5.0, Vec3A::Y), 0.0);
    }
}
