//! What a camera asks for: its components become one plan, and the plan one
//! render-world component. Whatever is absent from the plan is neither
//! compiled, bound nor dispatched.

use bevy::{
    camera::{Camera, Camera2d, Camera3d, MainPassResolutionOverride, Projection, RenderTarget},
    core_pipeline::prepass::DepthPrepass,
    ecs::{
        component::Component,
        entity::{Entity, EntityHashSet},
        query::{Has, Or, QueryData, With},
        system::{Commands, Local, Query},
    },
    log::warn_once,
    math::{Mat4, UVec2},
    render::{Extract, sync_world::RenderEntity},
};

use crate::{
    depth::{DepthMap, VisibleDepthRange, frame::DepthProjection},
    diagnostics::{ComicsStage, LeftOut},
    styles::{BlackFlats, Colorization, Contours, Desaturation},
};

/// Every component that makes a camera a comics camera.
#[derive(QueryData)]
pub(crate) struct ComicsComponents {
    depth_map: Option<&'static DepthMap>,
    desaturation: Option<&'static Desaturation>,
    colorization: Option<&'static Colorization>,
    black_flats: Option<&'static BlackFlats>,
    contours: Option<&'static Contours>,
    range: Has<VisibleDepthRange>,
}

/// Matches a camera with at least one component that asks for something.
type AnyComics = Or<(
    With<Desaturation>,
    With<Colorization>,
    With<BlackFlats>,
    With<Contours>,
    With<VisibleDepthRange>,
)>;

/// The sanitised styles of a camera; `None` is absent or without effect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Plan {
    pub depth_map: DepthMap,
    pub desaturation: Option<Desaturation>,
    pub colorization: Option<Colorization>,
    pub black_flats: Option<BlackFlats>,
    pub contours: Option<Contours>,
    /// The game reads the range.
    pub readback: bool,
    negligible: [bool; 4],
}

fn kept<T: Copy>(
    component: Option<&T>,
    sanitize: impl Fn(T) -> T,
    negligible: impl Fn(&T) -> bool,
) -> (Option<T>, bool) {
    let sanitized = component.map(|c| sanitize(*c));
    let skipped = sanitized.as_ref().is_some_and(&negligible);
    (sanitized.filter(|c| !negligible(c)), skipped)
}

impl Plan {
    fn new(item: &ComicsComponentsItem<'_, '_>) -> Self {
        let (desaturation, n0) = kept(
            item.desaturation,
            Desaturation::sanitized,
            Desaturation::is_negligible,
        );
        let (colorization, n1) = kept(
            item.colorization,
            Colorization::sanitized,
            Colorization::is_negligible,
        );
        let (black_flats, n2) = kept(
            item.black_flats,
            BlackFlats::sanitized,
            BlackFlats::is_negligible,
        );
        let (contours, n3) = kept(item.contours, Contours::sanitized, Contours::is_negligible);
        Self {
            depth_map: item.depth_map.copied().unwrap_or_default().sanitized(),
            desaturation,
            colorization,
            black_flats,
            contours,
            readback: item.range,
            negligible: [n0, n1, n2, n3],
        }
    }

    /// Whether any style draws.
    pub fn draws(&self) -> bool {
        self.desaturation.is_some()
            || self.colorization.is_some()
            || self.black_flats.is_some()
            || self.contours.is_some()
    }

    /// Whether any style reads the depth map.
    pub fn draws_with_depth(&self) -> bool {
        self.desaturation.is_some()
            || self.contours.is_some()
            || self.colorization.is_some_and(|c| c.depends_on_depth())
            || self.black_flats.is_some_and(|b| b.depends_on_depth())
    }

    /// Whether the fused pass reads the visible range.
    pub fn draws_with_range(&self) -> bool {
        self.draws_with_depth() && self.depth_map.mapping.follows_visible_range()
    }

    pub fn needs_range(&self) -> bool {
        self.readback || self.draws_with_range()
    }

    pub fn needs_depth(&self) -> bool {
        self.readback || self.draws_with_depth()
    }

    /// The plan without what reads depth, for views that have none.
    pub fn without_depth(self) -> Self {
        Self {
            desaturation: None,
            contours: None,
            colorization: self.colorization.filter(|c| !c.depends_on_depth()),
            black_flats: self
                .black_flats
                .map(|b| BlackFlats {
                    slope: None,
                    depth_weight: 0.0,
                    ..b
                })
                .filter(|b| !b.is_negligible()),
            readback: false,
            ..self
        }
    }

    /// Why a stage of this plan does not run.
    pub fn reason(&self, stage: ComicsStage) -> LeftOut {
        let style = |index: usize| {
            if self.negligible[index] {
                LeftOut::Negligible
            } else {
                LeftOut::NotRequested
            }
        };
        match stage {
            ComicsStage::Desaturation => style(0),
            ComicsStage::Colorization => style(1),
            ComicsStage::BlackFlats => style(2),
            ComicsStage::Contours => style(3),
            ComicsStage::DepthPrepass => LeftOut::NoDepthStyle,
            ComicsStage::DepthRange if self.draws_with_depth() => LeftOut::FixedRange,
            ComicsStage::DepthRange => LeftOut::NoDepthStyle,
            ComicsStage::RangeReadback => LeftOut::NotRequested,
            ComicsStage::Stylize => LeftOut::NothingToDraw,
        }
    }
}

/// Marks a depth prepass that this crate asked for and takes away again.
#[derive(Component)]
pub(crate) struct OwnDepthPrepass;

/// Gives cameras a depth prepass while a style reads depth, and no longer.
pub(crate) fn request_depth_prepass(
    mut commands: Commands,
    styled: Query<
        (
            Entity,
            ComicsComponents,
            Has<DepthPrepass>,
            Has<OwnDepthPrepass>,
        ),
        (With<Camera3d>, Or<(AnyComics, With<OwnDepthPrepass>)>),
    >,
) {
    for (camera, components, has_prepass, own) in &styled {
        let needs_depth = Plan::new(&components).needs_depth();
        if needs_depth && !has_prepass {
            commands
                .entity(camera)
                .insert((DepthPrepass, OwnDepthPrepass));
        } else if !needs_depth && own {
            commands
                .entity(camera)
                .remove::<(DepthPrepass, OwnDepthPrepass)>();
        }
    }
}

/// Says once what will not work, instead of doing nothing in silence.
pub(crate) fn warn_unsupported(
    flat: Query<Entity, (With<Camera2d>, AnyComics)>,
    targets: Query<(Entity, &RenderTarget), (With<Camera3d>, AnyComics)>,
) {
    if let Some(camera) = flat.iter().next() {
        warn_once!("{camera} is a Camera2d: comics styles need a Camera3d and leave it alone");
    }
    for (camera, target) in &targets {
        if matches!(target, RenderTarget::None { .. }) {
            warn_once!("{camera} has no colour target: comics styles leave it alone");
        }
    }
}

/// A styled camera in the render world.
#[derive(Component, Clone, Debug)]
pub(crate) struct ComicsView {
    pub camera: Entity,
    pub plan: Plan,
    pub projection: DepthProjection,
    pub clip_from_view: Mat4,
    /// Physical pixels per logical pixel.
    pub scale_factor: f32,
    /// Size of the main pass, where it is not the viewport's.
    pub main_pass_size: Option<UVec2>,
}

pub(crate) fn extract_views(
    mut commands: Commands,
    cameras: Extract<
        Query<
            (
                Entity,
                RenderEntity,
                &Camera,
                Option<&Projection>,
                Option<&MainPassResolutionOverride>,
                ComicsComponents,
            ),
            (With<Camera3d>, AnyComics),
        >,
    >,
    stale: Query<Entity, With<ComicsView>>,
    mut seen: Local<EntityHashSet>,
) {
    seen.clear();
    for (entity, render_entity, camera, projection, resolution, components) in &cameras {
        if !camera.is_active {
            continue;
        }
        let plan = Plan::new(&components);
        let clip_from_view = camera.clip_from_view();
        seen.insert(render_entity);
        commands.entity(render_entity).insert(ComicsView {
            camera: entity,
            plan,
            projection: DepthProjection::new(&clip_from_view, projection),
            clip_from_view,
            scale_factor: camera.target_scaling_factor().unwrap_or(1.0),
            main_pass_size: resolution.map(|size| size.0),
        });
    }
    for entity in &stale {
        if !seen.contains(&entity) {
            commands.entity(entity).remove::<ComicsView>();
        }
    }
}
