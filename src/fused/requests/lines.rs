//! Turns the plan of a view into a request for its lines.

use crate::effect::{AffectedArea, EffectContext, Needs};
use bevy::math::Vec4Swizzles;

use super::scene::Scene;
use crate::{
    depth::{ProjectionKind, view::ViewUniform},
    fused::{Plan, ViewPlan},
    lines::{
        FogUniform, HistoryRequest, LineFog, LineModifiers, LineRequest, LineWeight, MapJumps,
        Outlines, Sheet, SheetUniform,
    },
    objects::Pressure,
};

/// The largest [`Effect::line_reach`](crate::effect::Effect::line_reach); `None` if an effect that
/// reads lines does not know it.
pub(crate) fn line_reach(plan: &Plan, view: &EffectContext) -> Option<f32> {
    plan.drawn()
        .filter(|effect| effect.any_needs().contains(Needs::LINES))
        .try_fold(0.0_f32, |reach, effect| {
            Some(reach.max(effect.any_line_reach(view)?))
        })
}

/// The jumps of the depth map that effects of the plan are limited to. `None` also if
/// they are not looked for: in multisampled views, in views whose main pass has a
/// resolution of its own, beside faithful lines, and under a debug view.
pub(crate) fn map_jumps(plan: &Plan, scene: &Scene, context: &EffectContext) -> Option<MapJumps> {
    let (_, samples) = scene.depth?;
    let is_faithful = plan.lines.is_some_and(|lines| lines.has_faithful());
    let has_window = samples == 1 && scene.main_pass_size.is_none();
    if !has_window || is_faithful || plan.view.is_some() {
        return None;
    }
    let jumps = plan
        .drawn()
        .filter_map(|effect| match effect.any_affected_area(context) {
            AffectedArea::AtJumps(jumps) => Some(jumps),
            _ => None,
        });
    jumps.reduce(MapJumps::or)
}

/// The request for the lines of a plan; `None` if there is nothing to find.
pub(crate) fn line_request(
    view: &ViewPlan,
    (plan, context): (&Plan, &EffectContext),
    scene: &Scene,
    (uniform, jumps): (ViewUniform, Option<MapJumps>),
) -> Option<LineRequest> {
    let lines = plan.lines.filter(|_| plan.draws());
    let settings = lines.or(jumps.map(|_| Outlines::BARE))?;
    let widest_object = if plan.objects.any {
        view.widest_object
    } else {
        0.0
    };
    let widest = (widest_object, plan.objects.widths);
    let modifiers = plan.line_modifiers(context);
    Some(LineRequest {
        boil: settings.boil.uniform(
            view.scale_factor,
            view.time,
            settings.widest(widest_object, plan.objects.widths),
        ),
        motion: has_motion(scene),
        fog: plan.fog.then(|| fog(view, settings.fog)),
        fade: modifiers
            .fade
            .map(|fade| fade.uniform(context.depth_axis, context.depth_reference)),
        middle: modifiers.fade.is_some_and(|fade| fade.distance.is_none())
            && plan.needs().contains(Needs::MIDDLE_DEPTH),
        layers: modifiers.layers,
        simplification: modifiers.simplification,
        sheet: sheet(context),
        reach: settings.reach(view.scale_factor, widest, context.sheet),
        visible_range: plan.depth_map.mapping.follows_visible_range(),
        ids: plan.draws_ids(),
        sections: plan.sections,
        object_styles: plan.objects.any,
        widths: plan.draws_widths(),
        line_reach: line_reach(plan, context).unwrap_or(0.0),
        jumps,
        map_flags: uniform.depth.flags,
        ..plain_request(view, settings, scene, uniform)?
    })
}

/// A request for lines that depend on nothing but these settings and the view's depth.
pub(crate) fn plain_request(
    view: &ViewPlan,
    settings: Outlines,
    scene: &Scene,
    uniform: ViewUniform,
) -> Option<LineRequest> {
    let (depth_size, samples) = scene.depth?;
    let reference = view.projection.jump_reference(&view.clip_from_view);
    let drawn = scene.drawn();
    let bend = (view.projection).least_bend(&view.clip_from_view, drawn.zw(), samples);
    let grid_scale = view.scale_factor * uniform.depth_scale.max_element();
    Some(LineRequest {
        camera: view.camera,
        settings,
        view: uniform,
        lines: settings.uniform(view.scale_factor, reference, bend, scene.right),
        weight: settings.weight.uniform(
            grid_scale,
            view.to_light,
            (settings.ink_budget, least_budget_radius(view)),
        ),
        boil: settings.boil.uniform(view.scale_factor, view.time, 0.0),
        history: history_request(view, &settings, scene),
        cuts: view.cuts,
        motion: false,
        fog: None,
        fade: None,
        middle: false,
        layers: None,
        simplification: None,
        sheet: SheetUniform::default(),
        depth_size,
        samples,
        size: scene.viewport.zw(),
        rect: drawn,
        jitter: scene.jitter,
        reach: 0,
        steps: settings.steps(grid_scale),
        min_length: settings.min_length(grid_scale),
        extension: settings.extension(grid_scale),
        oblique: view.projection.kind() == ProjectionKind::Oblique,
        visible_range: false,
        ids: false,
        sections: false,
        highlights: false,
        object_styles: false,
        widths: false,
        line_reach: 0.0,
        jumps: None,
        map_flags: 0,
    })
}

/// The least radius of the areas in which lines share an ink budget, in physical pixels: on a page, that
/// of a view whose page pixels are physical pixels, so that a larger view has the same areas. 0 leaves
/// it to the shader.
fn least_budget_radius(view: &ViewPlan) -> f32 {
    /// Two of its smallest squares.
    const LEAST: f32 = 16.0;
    if view.has_page {
        LEAST * view.scale_factor
    } else {
        0.0
    }
}

/// The fog that lines fade into.
fn fog(view: &ViewPlan, lines: LineFog) -> FogUniform {
    let fog = lines.seen(view.fog).unwrap_or_default();
    fog.uniform(&view.projection, &view.clip_from_view)
}

/// What lines are drawn on.
fn sheet(context: &EffectContext) -> SheetUniform {
    let origin = context.viewport.xy().as_vec2();
    let uniform = |sheet: Sheet| sheet.uniform(origin);
    context.sheet.map(uniform).unwrap_or_default()
}

/// Whether the engine's motion vectors can be read.
fn has_motion(scene: &Scene) -> bool {
    scene.motion && scene.depth.is_some_and(|(_, samples)| samples == 1)
}

/// The history that lines are blended with under temporal anti-aliasing.
fn history_request(view: &ViewPlan, settings: &Outlines, scene: &Scene) -> Option<HistoryRequest> {
    let is_jittered = scene.jitter.is_some() && has_motion(scene);
    let uses_history = settings.history_weight > 0.0 && !settings.boil.moves();
    (is_jittered && uses_history).then_some(HistoryRequest {
        blend_factor: 1.0 - settings.history_weight,
        cuts: view.cuts,
    })
}

impl Plan {
    /// What the effects change about lines.
    pub fn line_modifiers(&self, context: &EffectContext) -> LineModifiers {
        let effects = self
            .drawn()
            .map(|effect| effect.any_line_modifiers(context));
        effects.fold(LineModifiers::default(), LineModifiers::or)
    }

    /// Whether the widths of lines are drawn with the ids of objects.
    pub fn draws_widths(&self) -> bool {
        let has_pressure = self
            .lines
            .is_some_and(|lines| lines.has_wide_lines() && lines.weight.pressure > 0.0);
        self.has_ids() && (has_pressure || self.objects.widths)
    }

    /// The pressure of the lines whose widths are drawn. `scale`: physical pixels per logical
    /// pixel.
    pub fn pressure(&self, scale: f32) -> Option<Pressure> {
        let lines = self.lines.filter(|_| self.draws_widths())?;
        let LineWeight {
            pressure,
            pressure_length,
            ..
        } = lines.weight;
        Some(Pressure::new(pressure, pressure_length * scale))
    }
}
