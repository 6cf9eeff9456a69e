//! The visible ranges of all views and the scales of their lengths, for materials: a texture with a
//! column for each view.
//!
//! A bind group of a material belongs to no view, so its shader looks for the column of the view
//! that it draws. The CPU writes what tells views apart before the frame is drawn; each view copies
//! its range there between its prepass and its main pass, so the range is that of the frame itself.

use bevy::{
    asset::{RenderAssetUsages, uuid_handle},
    camera::MainPassResolutionOverride,
    core_pipeline::schedule::{Core3d, Core3dSystems},
    ecs::entity::EntityHashMap,
    prelude::*,
    render::{
        Render, RenderApp,
        render_asset::RenderAssets,
        render_resource::{
            Extent3d, Origin3d, TexelCopyBufferInfo, TexelCopyBufferLayout, TexelCopyTextureInfo,
            TextureDimension, TextureFormat,
        },
        renderer::{RenderContext, RenderQueue, ViewQuery},
        texture::GpuImage,
        view::ExtractedView,
    },
};

use super::{DetailAxis, ToonMaterial};
use crate::{
    depth::{
        DepthMap, DepthMapping, MaterialsReadRange, prepare::ViewDepthRange, request::RangeRequest,
    },
    fused::ViewPlan,
    schedule::{ComicsSystems, PrepareComics},
};

/// The texture of all ranges.
const TEXTURE: Handle<Image> = uuid_handle!("b7c1f5a2-0e4d-4f5e-8c1f-3d9a6c02e871");

/// Views that have a column.
const COLUMNS: u32 = 64;

/// Texels of 16 bytes in a column.
const ROWS: usize = 6;

/// Binds the texture of all ranges. It has no settings.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ViewRanges;

impl From<&ViewRanges> for Option<&'static Handle<Image>> {
    fn from(_: &ViewRanges) -> Self {
        static BOUND: Handle<Image> = TEXTURE;
        Some(&BOUND)
    }
}

pub(super) fn add_texture(images: &mut Assets<Image>) {
    let size = Extent3d {
        width: COLUMNS,
        height: ROWS as u32,
        ..default()
    };
    let empty = vec![0; COLUMNS as usize * ROWS * 16];
    let image = Image::new(
        size,
        TextureDimension::D2,
        empty,
        TextureFormat::Rgba32Uint,
        RenderAssetUsages::all(),
    );
    // A handle with an id of its own always has a place.
    let _ = images.insert(&TEXTURE, image);
}

/// Says whether some material reads the range, so that it is found.
pub(super) fn ask_for_range(
    mut events: MessageReader<AssetEvent<ToonMaterial>>,
    materials: Res<Assets<ToonMaterial>>,
    mut read: ResMut<MaterialsReadRange>,
) {
    if events.read().count() == 0 {
        return;
    }
    let reads = |material: &ToonMaterial| {
        let ramp = material.extension.ramp.as_ref();
        let detail = ramp.and_then(|ramp| ramp.detail.as_ref());
        detail.is_some_and(|detail| detail.axis == DetailAxis::VisibleRange)
    };
    let any = materials.iter().any(|(_, material)| reads(material));
    if read.0 != any {
        read.0 = any;
    }
}

/// The part that needs the engine's renderer.
pub(super) fn build_render(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render_app
        .init_resource::<RangeColumns>()
        .add_systems(Render, write_columns.in_set(PrepareComics::Services))
        .add_systems(
            Core3d,
            copy_range
                .after(ComicsSystems::DepthRange)
                .before(Core3dSystems::MainPass),
        );
}

/// The column of each view with a range in this frame.
#[derive(Resource, Default)]
struct RangeColumns(EntityHashMap<u32>);

/// Pixels of the main pass per unit of the lengths of materials.
fn scale_of(
    view: &ExtractedView,
    plan: &ViewPlan,
    size: Option<&MainPassResolutionOverride>,
) -> f32 {
    // Without a page, the unit is a pixel of the main pass.
    if !plan.has_page {
        return 1.0;
    }
    let height = size.map_or(view.viewport.w, |size| size.0.y);
    plan.scale_factor * (height as f32 / view.viewport.w.max(1) as f32)
}

/// What the CPU knows of a column, row by row. See `view_range.wgsl`.
fn column(view: &ExtractedView, request: Option<&RangeRequest>, scale: f32) -> [[u32; 4]; ROWS] {
    let frame = |request: &RangeRequest| {
        request.projection.frame(&DepthMap {
            mapping: DepthMapping::MinMaxLogarithmic,
            ..request.map
        })
    };
    // Without a range, the shader does not read these.
    let frame = request.map(frame).unwrap_or_default();
    let nearest = request.map_or(0.0, |request| request.raw.nearest);
    let bits = |v: Vec3, w: f32| v.extend(w).to_array().map(f32::to_bits);
    let clip = view.clip_from_view;
    let [x, y] = Vec2::new(clip.x_axis.x, clip.y_axis.y).to_array();
    [
        // The range, which is copied later.
        [0; 4],
        [frame.offset, frame.floor, frame.plane_far, frame.extent].map(f32::to_bits),
        [frame.flags, nearest.to_bits(), x.to_bits(), y.to_bits()],
        view.viewport.as_vec4().to_array().map(f32::to_bits),
        bits(view.world_from_view.translation(), scale),
        bits(view.world_from_view.to_matrix().z_axis.truncate(), 0.0),
    ]
}

/// Gives a column to each view that has a range, while some material reads it, or a scale other
/// than 1.
fn write_columns(
    views: Query<(
        Entity,
        &ExtractedView,
        &ViewPlan,
        Option<&RangeRequest>,
        Option<&MainPassResolutionOverride>,
    )>,
    images: Res<RenderAssets<GpuImage>>,
    queue: Res<RenderQueue>,
    mut ranges: ResMut<RangeColumns>,
    mut has_columns: Local<bool>,
) {
    ranges.0.clear();
    let Some(image) = images.get(&TEXTURE) else {
        return;
    };
    let mut written = Vec::new();
    let mut read = views
        .iter()
        .filter_map(|(entity, view, plan, request, size)| {
            let request = request.filter(|request| request.materials);
            let scale = scale_of(view, plan, size);
            (request.is_some() || scale != 1.0).then_some((entity, view, request, scale))
        });
    for (entity, view, request, scale) in read.by_ref().take(COLUMNS as usize) {
        if request.is_some() {
            ranges.0.insert(entity, written.len() as u32);
        }
        written.push(column(view, request, scale));
    }
    if read.next().is_some() {
        warn_once!(
            "in more than {COLUMNS} views, materials do not find the visible range and the page"
        );
    }
    if written.is_empty() && !*has_columns {
        return;
    }
    *has_columns = !written.is_empty();
    if written.len() < COLUMNS as usize {
        // An empty one ends the search.
        written.push([[0; 4]; ROWS]);
    }
    let rows = (0..ROWS).flat_map(|row| written.iter().flat_map(move |column| column[row]));
    let bytes: Vec<u8> = rows.flat_map(u32::to_le_bytes).collect();
    let width = written.len() as u32;
    let layout = TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(16 * width),
        rows_per_image: None,
    };
    let size = Extent3d {
        width,
        height: ROWS as u32,
        ..default()
    };
    queue.write_texture(image.texture.as_image_copy(), &bytes, layout, size);
}

/// Copies the range of a view, if it was found in this frame.
fn copy_range(
    view: ViewQuery<(Entity, &ViewDepthRange)>,
    columns: Res<RangeColumns>,
    images: Res<RenderAssets<GpuImage>>,
    mut ctx: RenderContext,
) {
    let (entity, range) = view.into_inner();
    let (Some(column), Some(image)) = (columns.0.get(&entity), images.get(&TEXTURE)) else {
        return;
    };
    let Some(buffer) = range.drawn() else {
        return;
    };
    let from = TexelCopyBufferInfo {
        buffer,
        layout: TexelCopyBufferLayout::default(),
    };
    let to = TexelCopyTextureInfo {
        origin: Origin3d {
            x: *column,
            ..default()
        },
        ..image.texture.as_image_copy()
    };
    // One texel.
    ctx.command_encoder()
        .copy_buffer_to_texture(from, to, Extent3d::default());
}
