//! The keys that select the variants of the line passes, and what their shaders bind.

use bevy::{
    math::{UVec4, Vec2},
    render::render_resource::{
        BindGroupLayoutDescriptor, BindGroupLayoutEntry, ShaderStages, ShaderType,
        StorageTextureAccess, TextureFormat, TextureSampleType,
        binding_types::{
            storage_buffer_read_only_sized, storage_buffer_sized, texture_2d, texture_storage_2d,
            uniform_buffer, uniform_buffer_sized,
        },
    },
    shader::ShaderDefVal,
};

use super::request::{LinePassUniform, LineRequest};
use crate::{
    objects::{ids_entry, object_styles_entry},
    settings::Form,
};

/// The two cracks of a pixel, see `Crack` in `edge.wgsl`.
pub(crate) const CRACK_FORMAT: TextureFormat = TextureFormat::Rg32Uint;
/// The two best cracks of a pixel's column, see `columns.wgsl`.
pub(crate) const COLUMN_FORMAT: TextureFormat = TextureFormat::Rgba32Uint;
/// The rows with cracks in a block of pixels.
pub(crate) const BLOCK_FORMAT: TextureFormat = TextureFormat::R32Uint;
/// The ink of a pixel, see `draw.wgsl`.
pub(crate) const INK_FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;

/// Columns and rows of a block: an invocation of `walk.wgsl` walks through one.
pub(crate) const BLOCK: [u32; 2] = [4, 32];
/// Blocks in a workgroup, side by side.
pub(crate) const WORKGROUP: u32 = 32;

/// The largest half width of a line in physical pixels: that of `pack_width` in
/// `edge.wgsl`.
const LARGEST_HALF_WIDTH: f32 = 31.0;

/// Distance within which lines of this half width are searched around a pixel, both in
/// physical pixels.
pub(crate) fn reach(half_width: f32) -> i32 {
    (half_width.min(LARGEST_HALF_WIDTH) + 1.0).ceil() as i32 - 1
}

/// How cracks near a pixel are searched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Search {
    /// One pixel around it, without a loop.
    #[default]
    Neighbours,
    /// All pixels within reach.
    Around,
    /// The best crack of each column within reach, see `columns.wgsl`.
    Columns,
}

/// What selects the shader variants of the passes that find and draw lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct LineKey {
    pub oblique: bool,
    /// Measured silhouettes and creases: those of the corrected form.
    pub silhouettes: bool,
    pub creases: bool,
    pub object_edges: bool,
    pub ids: bool,
    pub object_styles: bool,
    pub fading: bool,
    pub visible_range: bool,
    /// Whether there are silhouettes and creases of the faithful form.
    pub faithful: [bool; 2],
    /// The depth texture has one pixel per pixel of the viewport.
    pub same_size: bool,
    pub search: Search,
    /// Jumps of the depth map are searched too, with these flags of the map.
    pub jumps: bool,
    map_flags: u32,
    /// The device has no compute shaders: the passes draw all pixels, not tiles.
    pub by_fragments: bool,
}

impl LineKey {
    pub fn new(request: &LineRequest, by_fragments: bool) -> Self {
        let lines = &request.settings;
        let forms = [
            lines.silhouettes.map(|s| s.form),
            lines.creases.map(|c| c.form),
        ];
        let [silhouettes, creases] = forms.map(|form| form == Some(Form::Corrected));
        Self {
            oblique: request.oblique,
            silhouettes,
            creases,
            object_edges: lines.objects.is_some() && request.ids,
            ids: request.ids,
            object_styles: request.object_styles,
            fading: lines.fades(),
            visible_range: request.visible_range,
            faithful: forms.map(|form| form == Some(Form::Faithful)),
            same_size: request.view.depth_scale == Vec2::ONE,
            search: request.search(),
            jumps: request.jumps.is_some(),
            map_flags: request.map_flags,
            by_fragments,
        }
    }

    /// Whether there are lines along cracks, besides those of the faithful forms.
    pub fn has_cracks(&self) -> bool {
        self.silhouettes || self.creases || self.object_edges
    }

    pub fn has_faithful(&self) -> bool {
        self.faithful.contains(&true)
    }

    /// The part that the search for blocks with cracks depends on.
    pub fn for_walk(self) -> Self {
        Self {
            ids: self.object_edges,
            object_styles: false,
            fading: false,
            visible_range: self.jumps && self.visible_range,
            jumps: self.jumps,
            map_flags: if self.jumps { self.map_flags } else { 0 },
            ..self.for_find()
        }
    }

    /// The part that finding depends on.
    pub fn for_find(self) -> Self {
        Self {
            faithful: [false; 2],
            search: Search::default(),
            visible_range: self.fading && self.visible_range,
            jumps: false,
            map_flags: 0,
            ..self
        }
    }

    /// The part that the faithful forms depend on.
    pub fn for_faithful(self) -> Self {
        Self {
            silhouettes: false,
            creases: false,
            object_edges: false,
            search: Search::default(),
            visible_range: self.fading && self.visible_range,
            jumps: false,
            map_flags: 0,
            by_fragments: false,
            ..self
        }
    }

    /// The part that the search in columns depends on.
    pub fn for_columns(self) -> Self {
        Self {
            by_fragments: self.by_fragments,
            ..Self::default()
        }
    }

    /// The part that drawing depends on.
    pub fn for_draw(self) -> Self {
        Self {
            ids: self.object_styles,
            object_styles: self.object_styles,
            search: self.search,
            by_fragments: self.by_fragments,
            ..Self::default()
        }
    }

    fn common(&self) -> impl Iterator<Item = ShaderDefVal> + use<> {
        [
            (self.same_size, "SAME_SIZE"),
            (self.oblique, "OBLIQUE"),
            (self.ids, "OBJECT_IDS"),
            (self.object_styles, "OBJECT_STYLES"),
        ]
        .into_iter()
        .filter(|(on, _)| *on)
        .map(|(_, name)| name.into())
    }

    pub fn find_defs(&self) -> Vec<ShaderDefVal> {
        self.crack_defs(self.silhouettes || self.creases)
    }

    /// `excess`: the excess of steps in depth is computed. It excludes creases too.
    fn crack_defs(&self, excess: bool) -> Vec<ShaderDefVal> {
        self.common()
            .chain(names([
                (true, "DEPTH"),
                (excess, "EXCESS"),
                (self.silhouettes, "SILHOUETTES"),
                (self.creases, "CREASES"),
                (self.creases, "NORMALS"),
                (self.object_edges, "OBJECT_EDGES"),
                (self.fading, "FADING"),
                (self.visible_range, "VISIBLE_RANGE"),
            ]))
            .collect()
    }

    pub fn walk_defs(&self) -> Vec<ShaderDefVal> {
        let jumps = [
            "JUMPS".into(),
            ShaderDefVal::UInt("MAP_FLAGS".into(), self.map_flags),
        ];
        let jumps = self.jumps.then_some(jumps);
        let cracks = self.has_cracks().then(|| "CRACKS".into());
        self.crack_defs(self.silhouettes)
            .into_iter()
            .chain(cracks)
            .chain(jumps.into_iter().flatten())
            .collect()
    }

    pub fn faithful_defs(&self) -> Vec<ShaderDefVal> {
        self.common()
            .chain(names([
                (true, "DEPTH"),
                (self.faithful[0], "FAITHFUL_SILHOUETTES"),
                (self.faithful[1], "FAITHFUL_CREASES"),
                (self.faithful[1], "NORMALS"),
                (self.fading, "FADING"),
                (self.visible_range, "VISIBLE_RANGE"),
            ]))
            .collect()
    }

    pub fn draw_defs(&self) -> Vec<ShaderDefVal> {
        self.common()
            .chain(names([
                (self.search == Search::Neighbours, "NEIGHBOURS"),
                (self.search == Search::Columns, "COLUMNS"),
                (!self.by_fragments, "BLOCKS"),
            ]))
            .collect()
    }

    /// The layout entries of what finding reads. `normals`: the normals are read.
    fn inputs(&self, normals: bool, stages: ShaderStages) -> Vec<BindGroupLayoutEntry> {
        let float = || texture_2d(TextureSampleType::Float { filterable: false });
        let mut entries = vec![
            uniform_buffer::<LinePassUniform>(false).build(1, stages),
            float().build(2, stages),
        ];
        let seen = |mut entry: BindGroupLayoutEntry| {
            entry.visibility = stages;
            entry
        };
        if self.visible_range {
            entries.push(seen(range_entry()));
        }
        if self.object_styles {
            entries.push(seen(object_styles_entry()));
        }
        if normals {
            entries.push(float().build(7, stages));
        }
        if self.ids {
            entries.push(seen(ids_entry(false)));
        }
        entries
    }

    pub fn walk_layout(&self) -> BindGroupLayoutDescriptor {
        let mut entries = self.inputs(self.creases, ShaderStages::COMPUTE);
        let blocks = texture_storage_2d(BLOCK_FORMAT, StorageTextureAccess::WriteOnly);
        entries.push(blocks.build(10, ShaderStages::COMPUTE));
        if self.has_cracks() {
            for binding in [16, 17] {
                let cells = storage_buffer_sized(false, None);
                entries.push(cells.build(binding, ShaderStages::COMPUTE));
            }
        }
        BindGroupLayoutDescriptor::new("comics_walk", &entries)
    }

    pub fn cells_layout(&self) -> BindGroupLayoutDescriptor {
        let mut entries = self.inputs(self.creases, ShaderStages::COMPUTE);
        for binding in [16, 17] {
            let cells = storage_buffer_read_only_sized(false, None);
            entries.push(cells.build(binding, ShaderStages::COMPUTE));
        }
        let cracks = texture_storage_2d(CRACK_FORMAT, StorageTextureAccess::WriteOnly);
        entries.push(cracks.build(18, ShaderStages::COMPUTE));
        BindGroupLayoutDescriptor::new("comics_find_in_cells", &entries)
    }

    pub fn find_layout(&self) -> BindGroupLayoutDescriptor {
        let entries = self.inputs(self.creases, ShaderStages::FRAGMENT);
        BindGroupLayoutDescriptor::new("comics_find_lines", &entries)
    }

    pub fn faithful_layout(&self) -> BindGroupLayoutDescriptor {
        let entries = self.inputs(self.faithful[1], ShaderStages::FRAGMENT);
        BindGroupLayoutDescriptor::new("comics_faithful_lines", &entries)
    }

    pub fn columns_layout(&self) -> BindGroupLayoutDescriptor {
        let mut entries = self.searched(11);
        if !self.by_fragments {
            let blocks = texture_2d(TextureSampleType::Uint);
            entries.push(blocks.build(12, ShaderStages::FRAGMENT));
        }
        BindGroupLayoutDescriptor::new("comics_line_columns", &entries)
    }

    /// The layout entries of a pass that searches cracks in the texture at this binding.
    fn searched(&self, binding: u32) -> Vec<BindGroupLayoutEntry> {
        let cracks = texture_2d(TextureSampleType::Uint);
        vec![
            uniform_buffer::<LinePassUniform>(false).build(1, ShaderStages::FRAGMENT),
            cracks.build(binding, ShaderStages::FRAGMENT),
        ]
    }

    pub fn tiles_layout() -> BindGroupLayoutDescriptor {
        let compute = ShaderStages::COMPUTE;
        let entries = [
            uniform_buffer::<LinePassUniform>(false).build(1, compute),
            texture_2d(TextureSampleType::Uint).build(12, compute),
            storage_buffer_sized(false, None).build(14, compute),
            storage_buffer_sized(false, None).build(15, compute),
        ];
        BindGroupLayoutDescriptor::new("comics_list_tiles", &entries)
    }

    pub fn draw_layout(&self) -> BindGroupLayoutDescriptor {
        let columns = self.search == Search::Columns;
        let mut entries = self.searched(if columns { 13 } else { 11 });
        if self.object_styles {
            entries.push(ids_entry(false));
        }
        BindGroupLayoutDescriptor::new("comics_draw_lines", &entries)
    }
}

fn names<const N: usize>(flags: [(bool, &'static str); N]) -> impl Iterator<Item = ShaderDefVal> {
    flags
        .into_iter()
        .filter(|(on, _)| *on)
        .map(|(_, name)| name.into())
}

/// The layout entry of the visible range, the same in all passes.
pub(crate) fn range_entry() -> BindGroupLayoutEntry {
    uniform_buffer_sized(false, Some(UVec4::min_size())).build(3, ShaderStages::FRAGMENT)
}

/// The layout entry of the ink in the fused pass.
pub(crate) fn ink_entry() -> BindGroupLayoutEntry {
    texture_2d(TextureSampleType::Float { filterable: false }).build(4, ShaderStages::FRAGMENT)
}
