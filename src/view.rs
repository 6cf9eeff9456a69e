//! What a camera asks for: its components become one plan, and the plan one
//! render-world component. Whatever is absent from the plan is neither
//! compiled, bound nor dispatched.

use bevy::{
    camera::{Camera, Camera3d, MainPassResolutionOverride, Projection},
    ecs::{
        component::Component,
        entity::{Entity, EntityHashSet},
        query::{Has, Or, QueryData, With},
        system::{Commands, Local, Query, Res},
    },
    math::{Mat4, UVec2},
    render::{Extract, sync_world::RenderEntity},
    time::{Real, Time},
};

use crate::{
    depth::{
        DepthHistogram, DepthMap, VisibleDepthRange, frame::DepthProjection, smoothing::CameraCuts,
    },
    diagnostics::{ComicsStage, LeftOut},
    finish::{DebugView, Finish, SplitView, StyleWeight},
    objects::ObjectStyles,
    styles::{
        BlackFlats, Colorization, Contours, Creases, Desaturation, Look, Outlines, Silhouettes,
        Sketch, ToneBands,
    },
};

/// Every component that makes a camera a comics camera.
#[derive(QueryData)]
pub(crate) struct ComicsComponents {
    look: Look,
    range: Has<VisibleDepthRange>,
    histogram: Has<DepthHistogram>,
    weight: Option<&'static StyleWeight>,
    split: Option<&'static SplitView>,
    view: Option<&'static DebugView>,
}

/// Matches a camera with at least one component that asks for something.
pub(crate) type AnyComics = Or<(
    With<ToneBands>,
    With<Desaturation>,
    With<Colorization>,
    With<BlackFlats>,
    With<Contours>,
    With<Outlines>,
    With<Sketch>,
    With<VisibleDepthRange>,
    With<DepthHistogram>,
    With<DebugView>,
)>;

/// The sanitised styles of a camera; `None` is absent or without effect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Plan {
    pub depth_map: DepthMap,
    pub tone_bands: Option<ToneBands>,
    pub desaturation: Option<Desaturation>,
    pub colorization: Option<Colorization>,
    pub black_flats: Option<BlackFlats>,
    pub contours: Option<Contours>,
    pub outlines: Option<Outlines>,
    pub sketch: Option<Sketch>,
    /// Objects have lines of their own, or none.
    pub object_styles: bool,
    /// The game reads the range.
    pub readback: bool,
    /// The game reads how the depths are distributed.
    pub histogram: bool,
    /// The outlines are the camera's own, not only a sketch's.
    pub own_lines: bool,
    pub finish: Finish,
    /// What is shown instead of the picture.
    pub view: Option<DebugView>,
    negligible: [bool; 7],
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

/// What a sketch draws on a camera without outlines of its own.
pub(crate) fn sketched_outlines() -> Outlines {
    Outlines {
        objects: None,
        width: 1.5,
        ..Outlines::default()
    }
}

impl Plan {
    pub fn new(item: &ComicsComponentsItem<'_, '_>, object_styles: bool) -> Self {
        let (tone_bands, n0) = kept(
            item.look.tone_bands,
            ToneBands::sanitized,
            ToneBands::is_negligible,
        );
        let (desaturation, n1) = kept(
            item.look.desaturation,
            Desaturation::sanitized,
            Desaturation::is_negligible,
        );
        let (colorization, n2) = kept(
            item.look.colorization,
            Colorization::sanitized,
            Colorization::is_negligible,
        );
        let (black_flats, n3) = kept(
            item.look.black_flats,
            BlackFlats::sanitized,
            BlackFlats::is_negligible,
        );
        let (contours, n4) = kept(
            item.look.contours,
            Contours::sanitized,
            Contours::is_negligible,
        );
        let (sketch, n6) = kept(item.look.sketch, Sketch::sanitized, Sketch::is_negligible);
        let sketched = sketched_outlines();
        let (outlines, n5) = kept(
            item.look.outlines.or(sketch.map(|_| &sketched)),
            |o| o.sanitized().effective(),
            Outlines::is_negligible,
        );
        let plan = Self {
            depth_map: item.look.depth_map.copied().unwrap_or_default().sanitized(),
            tone_bands,
            desaturation,
            colorization,
            black_flats,
            contours,
            outlines,
            // Without lines there is nothing to sketch: the picture stays.
            sketch: sketch.filter(|_| outlines.is_some()),
            object_styles: object_styles && outlines.is_some(),
            readback: item.range,
            histogram: item.histogram,
            own_lines: item.look.outlines.is_some(),
            finish: Finish::new(item.weight, item.split),
            view: item
                .view
                .copied()
                .filter(|view| !view.reads_ids() || cfg!(feature = "objects")),
            negligible: [n0, n1, n2, n3, n4, n5, n6],
        };
        match plan.view {
            Some(view) => plan.shown_as(view),
            None if plan.finish.weight == 0.0 || plan.finish.split >= 1.0 => plan.unseen(),
            None => plan,
        }
    }

    /// Nothing of the style is seen, so nothing of it runs.
    fn unseen(self) -> Self {
        Self {
            depth_map: self.depth_map,
            readback: self.readback,
            histogram: self.histogram,
            finish: self.finish,
            negligible: [true; 7],
            ..Self::default()
        }
    }

    /// The plan with what a view shows, whether a style asks for it or not.
    fn shown_as(mut self, view: DebugView) -> Self {
        self.finish.weight = 1.0;
        let lines = self.outlines.unwrap_or(Outlines {
            silhouettes: None,
            creases: None,
            objects: None,
            ..Outlines::default()
        });
        match view {
            DebugView::Silhouettes => {
                let silhouettes = lines.silhouettes.or(Some(Silhouettes::default()));
                self.outlines = Some(Outlines {
                    silhouettes,
                    ..lines
                });
            }
            DebugView::Creases => {
                let creases = lines.creases.or(Some(Creases::default()));
                self.outlines = Some(Outlines { creases, ..lines });
            }
            DebugView::ToneBands => {
                self.tone_bands = self.tone_bands.or(Some(ToneBands::default()));
            }
            _ => {}
        }
        self
    }

    /// Whether any style draws.
    pub fn draws(&self) -> bool {
        self.tone_bands.is_some()
            || self.desaturation.is_some()
            || self.colorization.is_some()
            || self.black_flats.is_some()
            || self.contours.is_some()
            || self.outlines.is_some()
            || self.sketch.is_some()
            || self.view.is_some()
    }

    /// Whether the fused pass reads the depth map.
    pub fn draws_with_depth(&self) -> bool {
        self.desaturation.is_some()
            || self.contours.is_some()
            || self.colorization.is_some_and(|c| c.depends_on_depth())
            || self.black_flats.is_some_and(|b| b.depends_on_depth())
            || self.view.is_some_and(|v| v.reads_map() || v.reads_ids())
    }

    /// Whether the fused pass reads the visible range.
    pub fn draws_with_range(&self) -> bool {
        self.draws_with_depth() && self.depth_map.mapping.follows_visible_range()
    }

    /// Whether outlines fade with the depth map.
    fn lines_fade(&self) -> bool {
        self.outlines
            .is_some_and(|o| o.width_fade > 0.0 || o.opacity_fade > 0.0)
    }

    /// Whether the range that is drawn with is more than this frame's own.
    pub fn smooths(&self) -> bool {
        let map = self.draws_with_depth() || self.lines_fade();
        map && self.depth_map.mapping.follows_visible_range()
            && (self.depth_map.smoothing.is_some() || self.depth_map.locked)
    }

    /// Whether the range goes through the step that smooths it, which also
    /// keeps the histogram.
    pub fn follows_range(&self) -> bool {
        self.smooths() || self.histogram
    }

    pub fn needs_range(&self) -> bool {
        let map = self.draws_with_depth() || self.lines_fade();
        self.readback || self.histogram || (map && self.depth_map.mapping.follows_visible_range())
    }

    pub fn needs_depth(&self) -> bool {
        self.readback || self.histogram || self.draws_with_depth() || self.outlines.is_some()
    }

    pub fn needs_normals(&self) -> bool {
        self.outlines.is_some_and(|o| o.creases.is_some())
    }

    /// Whether the ids of objects are drawn for this camera.
    pub fn draws_ids(&self) -> bool {
        let lines = self
            .outlines
            .is_some_and(|o| o.objects.is_some() || self.object_styles);
        lines || self.view.is_some_and(DebugView::reads_ids)
    }

    /// The plan without what reads depth, for views that have none.
    pub fn without_depth(self) -> Self {
        Self {
            desaturation: None,
            contours: None,
            outlines: None,
            sketch: None,
            object_styles: false,
            colorization: self.colorization.filter(|c| !c.depends_on_depth()),
            black_flats: self
                .black_flats
                .map(|b| BlackFlats {
                    slope: None,
                    depth_weight: 0.0,
                    ..b
                })
                .filter(|b| !b.is_negligible()),
            view: self.view.filter(|v| !v.needs_depth()),
            histogram: false,
            readback: false,
            ..self
        }
    }

    /// The plan without creases, for views that have no normals (yet).
    pub fn without_normals(self) -> Self {
        let outlines = self.outlines.map(|o| Outlines { creases: None, ..o });
        let outlines = outlines.filter(|o| !o.is_negligible());
        Self {
            outlines,
            sketch: self.sketch.filter(|_| outlines.is_some()),
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
        let maps = self.draws_with_depth() || self.lines_fade();
        match stage {
            ComicsStage::ToneBands => style(0),
            ComicsStage::Desaturation => style(1),
            ComicsStage::Colorization => style(2),
            ComicsStage::BlackFlats => style(3),
            ComicsStage::Contours => style(4),
            ComicsStage::Outlines => style(5),
            ComicsStage::Sketch => style(6),
            ComicsStage::RangeReadback => LeftOut::NotRequested,
            ComicsStage::DepthPrepass => LeftOut::NoDepthStyle,
            ComicsStage::NormalPrepass | ComicsStage::ObjectIds | ComicsStage::OutlineEdges => {
                LeftOut::NoSuchLines
            }
            ComicsStage::LineFlood if self.outlines.is_some() => LeftOut::NarrowLines,
            ComicsStage::LineFlood => LeftOut::NoSuchLines,
            ComicsStage::RangeSmoothing
                if self.depth_map.smoothing.is_none() && !self.depth_map.locked =>
            {
                LeftOut::NotRequested
            }
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing if maps => LeftOut::FixedRange,
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing if self.outlines.is_some() => {
                LeftOut::NoMapStyle
            }
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing => LeftOut::NoDepthStyle,
            ComicsStage::Stylize => LeftOut::NothingToDraw,
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
    /// Which drawing of a sketch is shown.
    pub drawing: u32,
    /// The widest line of any object with one of its own, logical pixels.
    pub widest_object: f32,
    /// Real time since the last frame, seconds: a paused game still looks around.
    pub seconds: f32,
    /// How often the camera was cut.
    pub cuts: u32,
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
                Option<&CameraCuts>,
                ComicsComponents,
            ),
            (With<Camera3d>, AnyComics),
        >,
    >,
    time: Extract<Option<Res<Time>>>,
    real_time: Extract<Option<Res<Time<Real>>>>,
    objects: Extract<Res<ObjectStyles>>,
    stale: Query<Entity, With<ComicsView>>,
    mut seen: Local<EntityHashSet>,
) {
    seen.clear();
    let since_last = real_time.as_ref().map_or(0.0, |time| time.delta_secs());
    for (entity, render_entity, camera, projection, resolution, cuts, components) in &cameras {
        if !camera.is_active {
            continue;
        }
        let plan = Plan::new(&components, objects.any());
        let seconds = time.as_ref().map_or(0.0, |time| time.elapsed_secs_f64());
        let clip_from_view = camera.clip_from_view();
        seen.insert(render_entity);
        commands.entity(render_entity).insert(ComicsView {
            camera: entity,
            plan,
            projection: DepthProjection::new(&clip_from_view, projection),
            clip_from_view,
            scale_factor: camera.target_scaling_factor().unwrap_or(1.0),
            main_pass_size: resolution.map(|size| size.0),
            drawing: plan.sketch.map_or(0, |sketch| sketch.drawing(seconds)),
            widest_object: objects.max_width(),
            seconds: since_last,
            cuts: cuts.map_or(0, |cuts| cuts.0),
        });
    }
    for entity in &stale {
        if !seen.contains(&entity) {
            commands.entity(entity).remove::<ComicsView>();
        }
    }
}
