//! The key that selects a pipeline of the fused pass.

pub(super) mod drawn_area;
pub(super) mod intermediate;

use crate::effect::{
    AffectedArea, AnyEffect, EffectContext, EffectStage, Needs, Variants, definition,
};
use bevy::{
    camera::CompositingSpace,
    math::{UVec2, Vec2, Vec4Swizzles},
    render::render_resource::{
        BindGroupLayoutDescriptor, SamplerBindingType, ShaderStages, TextureFormat,
        TextureSampleType,
        binding_types::{sampler, texture_2d, uniform_buffer_sized},
    },
    shader::ShaderDefVal,
};

use self::{
    drawn_area::DrawnArea,
    intermediate::{Boxes, Drawn, PACKED_FORMAT, PASS_FORMAT, Read},
};
use super::{
    Plan,
    compose::{left_out, masked_by},
    plan::passes::{Pass, Reads},
};
use crate::{
    composite::{BeyondPrepass, DRAWN_DEPTH_BINDING, DebugView, OwnPixels},
    depth::view::ViewUniform,
    gpu::{UNFILTERABLE, sampled, stored},
    lines::{Outlines, ink_entry, owners_entry, range_entry},
    objects::{ids_entry, object_depths_entry, object_styles_entry},
    samples,
    tones::tones_entry,
};

/// The properties of a view that select a pipeline, besides its plan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KeyInputs {
    pub format: TextureFormat,
    pub space: Option<CompositingSpace>,
    /// Samples per pixel of the depth texture, if there is one.
    pub samples: Option<u32>,
    pub oblique: bool,
    pub view: ViewUniform,
    /// The largest line width that an object overrides, in logical pixels.
    pub widest_object: f32,
}

/// Everything that is compiled into the fused pass: the effects, their modes and
/// their inputs. All other settings are in the uniform.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct StylizeKey {
    pub format: TextureFormat,
    space: CompositingSpace,
    pub samples: u32,
    oblique: bool,
    effects: Vec<&'static str>,
    variants: Variants,
    pub needs: Needs,
    /// Whether the depth texture is bound.
    pub depth: bool,
    visible_range: bool,
    pub lines: bool,
    /// Lines have the color of surfaces.
    surface: bool,
    /// Convex and concave creases differ.
    edge_styles: bool,
    /// Lines have other colors in near, middle and far.
    pub layer_ink: bool,
    /// Tones are brought into a range.
    pub tones: bool,
    pub object_styles: bool,
    /// Some objects are left alone: by the color effects of the pass, by its prints.
    unstyled_colors: bool,
    unstyled_print: bool,
    own_pixels: Option<OwnPixels>,
    /// How far lines reach out of their objects in pixels, if these are found by their ids.
    mask_reach: u32,
    pub beyond: BeyondPrepass,
    /// Whether color effects of the pass, and its prints, change only some pixels.
    masked_colors: bool,
    masked_print: bool,
    /// Of the effects that come after prints: whether they draw lines.
    masked: Vec<(&'static str, bool)>,
    view: Option<DebugView>,
    map_flags: u32,
    composite: bool,
    same_size: bool,
    pub area: DrawnArea,
    /// The pass starts from a picture of an earlier one; it draws one for a later one.
    pub continued: bool,
    pub is_earlier: bool,
    pub draws: Drawn,
    pub reads: Read,
    /// All pixels that are drawn lie inside the viewport.
    inside: bool,
    /// Effects that are left out of [`DrawnArea::Base`] or belong to other passes, and whether
    /// lines are left out too.
    left_out: Vec<&'static str>,
    without_lines: bool,
}

impl StylizeKey {
    pub fn new(plan: &Plan, inputs: &KeyInputs, context: &EffectContext) -> Self {
        let needs = plan.needs();
        let depth = needs.intersects(Needs::MAP | Needs::DEPTH);
        let reads_pixels = depth || needs.intersects(Needs::NORMALS | Needs::IDS);
        let lines = needs.intersects(Needs::LINES);
        let mut variants = Variants::default();
        for effect in plan.drawn() {
            variants.effect = effect.name();
            effect.any_variants(context, &mut variants);
        }
        variants.effect = "";
        Self {
            format: inputs.format,
            space: inputs.space.unwrap_or(CompositingSpace::Linear),
            // A pass that reads no prepass texture is the same for any number of
            // samples.
            samples: inputs.samples.filter(|_| reads_pixels).unwrap_or(1),
            oblique: depth && inputs.oblique,
            effects: plan.drawn().map(|e| e.name()).collect(),
            variants,
            needs,
            depth,
            visible_range: plan.draws_with_range(),
            lines,
            surface: lines && plan.lines.is_some_and(|lines| lines.has_surface_colors()),
            edge_styles: lines && plan.lines.is_some_and(|lines| lines.has_edge_styles()),
            layer_ink: lines
                && plan
                    .line_modifiers(context)
                    .layers
                    .is_some_and(|p| p.has_colors()),
            tones: plan.tones().is_some(),
            object_styles: (lines && plan.objects.any)
                || plan.objects.unstyled
                || needs.contains(Needs::OBJECT_ANCHORS),
            unstyled_colors: plan.objects.unstyled,
            unstyled_print: plan.objects.unstyled,
            own_pixels: plan.own_pixels,
            mask_reach: mask_reach(plan, inputs.widest_object, context),
            beyond: plan.beyond,
            masked_colors: plan.is_masked(),
            masked_print: plan.is_masked(),
            masked: masked(plan, context),
            view: plan.view,
            map_flags: if needs.contains(Needs::MAP) {
                inputs.view.depth.flags
            } else {
                0
            },
            composite: plan.composite.weight < 1.0 || plan.composite.split > 0.0,
            same_size: reads_pixels && inputs.view.depth_scale == Vec2::ONE,
            area: DrawnArea::Whole,
            continued: false,
            is_earlier: false,
            draws: Drawn::Picture,
            reads: Read::Picture,
            inside: context.viewport.xy() == UVec2::ZERO
                && context.viewport.zw() == context.target_size,
            left_out: vec![],
            without_lines: false,
        }
    }

    /// Whether all effects draw over the picture, and their sum can be blended over it.
    /// Not if the picture may have values that are no numbers: only a pass that reads the
    /// picture replaces them.
    pub fn can_overlay(&self, plan: &Plan, context: &EffectContext) -> bool {
        let bytes = matches!(self.format.block_copy_size(None), Some(..=4));
        let plain = bytes
            && self.format != TextureFormat::Rg11b10Ufloat
            && self.view.is_none()
            && !self.composite
            && !self.continued
            && !self.tones
            && self.reads == Read::Picture
            && !self.reads_owners();
        let local =
            |effect: &dyn AnyEffect| effect.any_affected_area(context) != AffectedArea::Everywhere;
        plain && self.space == CompositingSpace::Linear && plan.drawn().all(local)
    }

    /// The key of one of the passes of a plan.
    pub fn of_pass(&self, plan: &Plan, pass: &Pass) -> Self {
        let inside = |i: &usize| pass.effects.contains(i);
        let drawn = || plan.drawn().enumerate();
        let has = |stage: fn(EffectStage) -> bool| {
            drawn().any(|(i, effect)| inside(&i) && stage(effect.effect_type().stage))
        };
        let others = drawn().filter(|(i, _)| !inside(i));
        Self {
            format: if pass.is_earlier {
                PASS_FORMAT
            } else {
                self.format
            },
            unstyled_colors: self.unstyled_colors && has(|stage| stage <= EffectStage::Color),
            unstyled_print: self.unstyled_print && has(|stage| stage == EffectStage::Print),
            masked_colors: self.masked_colors && has(|stage| stage <= EffectStage::Color),
            masked_print: self.masked_print && has(|stage| stage == EffectStage::Print),
            view: self.view.filter(|_| !pass.is_earlier),
            composite: self.composite && !pass.is_earlier,
            continued: pass.continued && !matches!(pass.reads, Some(Reads::AuxScalar(_))),
            is_earlier: pass.is_earlier,
            reads: match pass.reads {
                Some(Reads::BoxStatistics(_)) => Read::Means,
                Some(Reads::AuxScalar(_)) => Read::WithScalar,
                None => Read::Picture,
            },
            inside: self.inside || pass.is_earlier,
            left_out: others.map(|(_, effect)| effect.name()).collect(),
            ..self.clone()
        }
    }

    /// The key of a pass that draws its picture with the numbers of an effect.
    pub fn with_scalar(&self, effect: &'static str) -> Self {
        Self {
            format: PACKED_FORMAT,
            draws: Drawn::WithScalar(effect),
            ..self.clone()
        }
    }

    /// The keys of the passes that draw the means for this one, for an effect.
    pub fn means_for(
        &self,
        plan: &Plan,
        effect: &'static str,
        context: &EffectContext,
    ) -> [Self; 2] {
        let found = plan.drawn().find(|e| e.name() == effect);
        let reach = found.and_then(|effect| effect.any_max_radius(context));
        let boxes = Boxes { effect, reach };
        let rows = (Drawn::Across(boxes), Read::Picture);
        [rows, (Drawn::Down(boxes), Read::Means)].map(|(draws, reads)| Self {
            format: PACKED_FORMAT,
            view: None,
            composite: false,
            continued: true,
            is_earlier: true,
            inside: true,
            draws,
            reads,
            ..self.clone()
        })
    }

    /// The key of the same pass with another drawn area.
    pub fn with_area(&self, area: DrawnArea) -> Self {
        Self {
            area,
            ..self.clone()
        }
    }

    /// The key of [`DrawnArea::Base`], without these effects and perhaps without lines.
    pub fn base(&self, left_out: &[&'static str], without_lines: bool) -> Self {
        Self {
            left_out: [&self.left_out, left_out].concat(),
            without_lines,
            ..self.with_area(DrawnArea::Base)
        }
    }

    /// Whether the pass applies an effect of the plan.
    pub fn applies(&self, effect: &str) -> bool {
        !self.left_out.contains(&effect)
    }

    /// Whether a debug view replaces the picture.
    pub fn is_view(&self) -> bool {
        self.view.is_some()
    }

    /// Whether the pixels that own lines are read.
    pub fn reads_owners(&self) -> bool {
        self.surface || self.edge_styles || self.layer_ink
    }

    /// Whether the buffer of the visible range is bound, which holds the borders and the middle too.
    pub fn reads_range(&self) -> bool {
        let beside = Needs::DEPTH_BORDERS | Needs::MIDDLE_DEPTH;
        self.visible_range || self.needs.intersects(beside)
    }

    /// Whether the depth of the main pass is read.
    pub fn reads_drawn_depth(&self) -> bool {
        self.beyond != BeyondPrepass::Styled
    }

    /// What says which pixels effects change, see `composite/mask.wgsl`.
    fn mask_definitions(&self) -> Vec<ShaderDefVal> {
        if self.own_pixels.is_none() && !self.reads_drawn_depth() {
            return vec![];
        }
        let mut found = vec!["MASK".into()];
        match self.own_pixels {
            Some(OwnPixels::Depth) => found.push("MASKED_BY_DEPTH".into()),
            Some(OwnPixels::Ids) => found.extend([
                "MASKED_BY_IDS".into(),
                ShaderDefVal::Int("MASK_REACH".into(), self.mask_reach as i32),
            ]),
            None => {}
        }
        if self.reads_drawn_depth() {
            found.push("BEYOND_PREPASS".into());
        }
        if self.beyond == BeyondPrepass::Plain {
            found.push("BEYOND_PLAIN".into());
        }
        let masked = |(name, is_line): &(&str, bool)| {
            ShaderDefVal::UInt(masked_by(name), u32::from(*is_line))
        };
        found.extend(self.masked.iter().map(masked));
        found
    }

    pub fn shader_defs(&self) -> Vec<ShaderDefVal> {
        let needs = |need| self.needs.contains(need);
        let number = |name: &str, value| ShaderDefVal::UInt(name.into(), value);
        [
            (self.depth, "DEPTH"),
            (needs(Needs::MAP), "MAP"),
            (self.visible_range, "VISIBLE_RANGE"),
            (needs(Needs::DEPTH_BORDERS), "DEPTH_BORDERS"),
            (needs(Needs::MIDDLE_DEPTH), "MIDDLE_DEPTH"),
            (self.oblique, "OBLIQUE"),
            (needs(Needs::NORMALS), "NORMALS"),
            (needs(Needs::IDS), "OBJECT_IDS"),
            (self.lines, "LINES"),
            (needs(Needs::LINES_ANYWHERE), "LINES_ANYWHERE"),
            (self.reads_owners(), "LINE_OWNERS"),
            (
                self.surface && self.area != DrawnArea::Base,
                "SURFACE_LINES",
            ),
            (
                self.edge_styles && self.area != DrawnArea::Base,
                "EDGE_STYLES",
            ),
            (self.layer_ink, "IN_LAYERS"),
            (self.layer_ink && self.area != DrawnArea::Base, "LAYER_INK"),
            (self.tones, "TONE_RANGE"),
            (self.object_styles, "OBJECT_STYLES"),
            (needs(Needs::OBJECT_ANCHORS), "OBJECT_ANCHORS"),
            (needs(Needs::OBJECT_DEPTHS), "OBJECT_DEPTHS"),
            (needs(Needs::WORLD_ORIGIN), "WORLD_ORIGIN"),
            (self.unstyled_colors || self.unstyled_print, "UNSTYLED"),
            (self.unstyled_colors, "UNSTYLED_COLORS"),
            (self.unstyled_print, "UNSTYLED_PRINT"),
            (self.masked_colors, "MASKED_COLORS"),
            (self.masked_print, "MASKED_PRINT"),
            (self.continued, "CONTINUED"),
            (self.is_earlier, "EARLIER_PASS"),
            (self.inside, "INSIDE"),
            (needs(Needs::LIGHTNESS_CHANGE), "LIGHTNESS_CHANGE"),
            (needs(Needs::BLUE_NOISE), "BLUE_NOISE"),
            (self.same_size, "SAME_SIZE"),
            (self.composite, "COMPOSITE"),
            (self.area.is_overlay(), "OVERLAY"),
            (self.without_lines, "WITHOUT_LINES"),
        ]
        .into_iter()
        .filter_map(|(on, name)| on.then_some(name))
        .map(ShaderDefVal::from)
        .chain(stored(self.space))
        .chain(self.view.map(|_| "DEBUG_VIEW".into()))
        .chain(self.view.into_iter().flat_map(view_definitions))
        .chain(self.effects.iter().map(|name| definition(name).into()))
        .chain(samples::definitions(self.samples))
        .chain(self.draws.shader_defs())
        .chain(self.reads.shader_def())
        .chain(self.left_out.iter().map(|name| left_out(name).into()))
        .chain([number("MAP_FLAGS", self.map_flags)])
        .chain(self.mask_definitions())
        .chain(self.variants.shader_defs())
        .collect()
    }

    pub fn layout(&self) -> BindGroupLayoutDescriptor {
        let needs = |need| self.needs.contains(need);
        let fragment = ShaderStages::FRAGMENT;
        let prepass = |binding| sampled(self.samples > 1, UNFILTERABLE).build(binding, fragment);
        let mut entries = vec![uniform_buffer_sized(false, None).build(1, fragment)];
        if !self.area.is_overlay() {
            entries.push(texture_2d(UNFILTERABLE).build(0, fragment));
        }
        let picture = texture_2d(TextureSampleType::Float { filterable: true });
        let between = sampler(SamplerBindingType::Filtering);
        let packed = texture_2d(TextureSampleType::Uint);
        let optional = [
            (self.depth, prepass(2)),
            (self.reads_range(), range_entry()),
            (self.lines, ink_entry()),
            (self.reads_owners(), owners_entry()),
            (self.object_styles, object_styles_entry()),
            (needs(Needs::NORMALS), prepass(7)),
            (needs(Needs::IDS), ids_entry(self.samples > 1)),
            (needs(Needs::OBJECT_DEPTHS), object_depths_entry()),
            (self.continued, picture.build(9, fragment)),
            (self.continued, between.build(10, fragment)),
            (needs(Needs::BLUE_NOISE), packed.build(11, fragment)),
            (self.reads_drawn_depth(), prepass(DRAWN_DEPTH_BINDING)),
            (self.tones, tones_entry()),
        ];
        entries.extend(
            optional
                .into_iter()
                .filter_map(|(on, entry)| on.then_some(entry)),
        );
        entries.extend(self.reads.binding().map(|at| packed.build(at, fragment)));
        BindGroupLayoutDescriptor::new("comics_stylize", &entries)
    }
}

/// How far the ink of lines may lie from their objects in pixels, if [`OwnPixels::Ids`] are read.
fn mask_reach(plan: &Plan, widest_object: f32, context: &EffectContext) -> u32 {
    let lines = plan
        .lines
        .filter(|_| plan.own_pixels == Some(OwnPixels::Ids));
    let widest = (widest_object, plan.objects.widths);
    let reach = |lines: Outlines| lines.reach(context.scale_factor, widest, context.sheet);
    lines.map_or(2, |lines| reach(lines).clamp(1, 32) as u32)
}

/// The effects that come after prints, where effects change only some pixels; and whether they draw
/// lines.
fn masked(plan: &Plan, context: &EffectContext) -> Vec<(&'static str, bool)> {
    if !plan.is_masked() {
        return vec![];
    }
    let later = plan
        .drawn()
        .filter(|effect| effect.effect_type().stage > EffectStage::Print);
    let masked = |effect: &dyn AnyEffect| {
        let is_line = effect.any_affected_area(context) != AffectedArea::Everywhere;
        (effect.name(), is_line)
    };
    later.map(masked).collect()
}

fn view_definitions(view: DebugView) -> Vec<ShaderDefVal> {
    match view {
        DebugView::Effect(name) => vec![
            "VIEW_EFFECT".into(),
            format!("VIEW_{}", definition(name)).into(),
        ],
        other => vec![other.shader_def().into()],
    }
}
