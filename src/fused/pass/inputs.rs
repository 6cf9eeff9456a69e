//! What the passes bind.

use bevy::{
    ecs::resource::Resource,
    render::{
        render_resource::{
            AddressMode, BindGroup, BindGroupEntry, BindingResource, FilterMode, IntoBinding,
            Sampler, SamplerDescriptor, TextureView,
        },
        renderer::RenderDevice,
        texture::CachedTexture,
        view::ViewDepthTexture,
    },
};

use super::blue_noise::BlueNoise;
use crate::{
    bind_groups::Binder,
    composite::DRAWN_DEPTH_BINDING,
    depth::{
        prepare::ViewDepthRange,
        surfaces::{SurfaceParts, Surfaces},
    },
    diagnostics::SkipReason,
    effect::Needs,
    fused::key::StylizeKey,
    gpu::entry,
    lines::ViewLines,
    objects::{OBJECT_DEPTHS_BINDING, ObjectDepths, ObjectStyleBuffer, ViewObjectIds},
    tones::{TONES_BINDING, prepare::ViewTones},
};

/// Reads between the centers of pixels.
#[derive(Resource)]
pub(crate) struct PassSampler(pub Sampler);

impl PassSampler {
    pub fn new(device: &RenderDevice) -> Self {
        Self(device.create_sampler(&SamplerDescriptor {
            label: Some("comics_pass"),
            address_mode_u: AddressMode::ClampToEdge,
            address_mode_v: AddressMode::ClampToEdge,
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            ..Default::default()
        }))
    }
}

/// The textures and buffers that the services have prepared for the view in this
/// frame.
pub(crate) type ViewInputs<'a> = (
    (SurfaceParts<'a>, Option<&'a ViewDepthTexture>),
    Option<&'a ViewDepthRange>,
    Option<&'a ViewLines>,
    (Option<&'a ViewObjectIds>, Option<&'a ObjectDepths>),
    Option<&'a ViewTones>,
);

/// What all passes of a view bind.
pub(crate) struct Inputs<'a> {
    pub entries: Vec<BindGroupEntry<'a>>,
    pub sampler: &'a PassSampler,
    pub binder: &'a Binder<'a>,
}

/// What the passes before a pass have drawn for it.
#[derive(Clone, Copy, Default)]
pub(crate) struct PreviousPass<'a> {
    pub picture: Option<&'a TextureView>,
    /// Means, or the picture with numbers.
    pub packed: Option<&'a TextureView>,
}

impl Inputs<'_> {
    pub fn bind_group(&self, key: &StylizeKey, before: &PreviousPass) -> BindGroup {
        let mut entries = self.entries.clone();
        if let Some(picture) = before.picture {
            entries.push(entry(9, picture.into_binding()));
            entries.push(entry(10, (&self.sampler.0).into_binding()));
        }
        if let (Some(packed), Some(binding)) = (before.packed, key.reads.binding()) {
            entries.push(entry(binding, packed.into_binding()));
        }
        (self.binder).group("comics_stylize", &key.layout(), &entries)
    }
}

/// The bindings of the pass besides the picture and the uniform; an error if one of
/// them is missing in this frame.
pub(crate) fn entries<'a>(
    key: &StylizeKey,
    ((surfaces, drawn), range, lines, (ids, depths), tones): ViewInputs<'a>,
    object_styles: &'a ObjectStyleBuffer,
    blue_noise: &'a BlueNoise,
) -> Result<Vec<BindGroupEntry<'a>>, SkipReason> {
    let not_ready = SkipReason::PipelineNotReady;
    let needs = |need| key.needs.contains(need);
    let surfaces = Surfaces::from(surfaces);
    let mut entries = Vec::new();
    if key.depth {
        let depth = surfaces.depth().ok_or(SkipReason::SampleCountMismatch)?;
        entries.push(entry(2, sampled(depth, key.samples)?));
    }
    if key.reads_range() {
        let keys = range.and_then(ViewDepthRange::drawn).ok_or(not_ready)?;
        entries.push(entry(3, keys.as_entire_binding()));
    }
    if key.lines {
        let lines = lines.ok_or(not_ready)?;
        let ink = lines.found().ok_or(not_ready)?;
        entries.push(entry(4, (&ink.default_view).into_binding()));
    }
    if key.reads_owners() {
        let owners = lines.and_then(|lines| lines.owners.as_ref());
        let owners = owners.ok_or(not_ready)?;
        entries.push(entry(5, (&owners.default_view).into_binding()));
    }
    if key.object_styles {
        let styles = object_styles.buffer().ok_or(not_ready)?;
        entries.push(entry(6, styles.as_entire_binding()));
    }
    if needs(Needs::NORMALS) {
        let normal = surfaces.normal().ok_or(not_ready)?;
        entries.push(entry(7, sampled(normal, key.samples)?));
    }
    if needs(Needs::IDS) {
        let ids = ids.ok_or(not_ready)?;
        entries.push(entry(8, (&ids.view).into_binding()));
    }
    if needs(Needs::OBJECT_DEPTHS) {
        let depths = depths.ok_or(not_ready)?;
        entries.push(entry(
            OBJECT_DEPTHS_BINDING,
            depths.table.as_entire_binding(),
        ));
    }
    if key.reads_drawn_depth() {
        let depth = drawn.ok_or(not_ready)?;
        if depth.texture.sample_count() != key.samples {
            return Err(SkipReason::SampleCountMismatch);
        }
        entries.push(entry(DRAWN_DEPTH_BINDING, depth.view().into_binding()));
    }
    if key.tones {
        let keys = tones.and_then(ViewTones::drawn).ok_or(not_ready)?;
        entries.push(entry(TONES_BINDING, keys.as_entire_binding()));
    }
    if needs(Needs::BLUE_NOISE) {
        let tile = blue_noise.view().ok_or(not_ready)?;
        entries.push(entry(11, tile.into_binding()));
    }
    Ok(entries)
}

/// The binding of a prepass texture; an error if its number of samples is not the
/// one that was compiled in.
fn sampled(texture: &CachedTexture, samples: u32) -> Result<BindingResource<'_>, SkipReason> {
    if texture.texture.sample_count() == samples {
        Ok((&texture.default_view).into_binding())
    } else {
        Err(SkipReason::SampleCountMismatch)
    }
}
