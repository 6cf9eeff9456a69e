//! Prepares the textures and uniforms of the views whose lines are requested.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::{
    prelude::*,
    render::{
        render_resource::{TextureUsages, UniformBuffer},
        renderer::{RenderDevice, RenderQueue},
        texture::{CachedTexture, TextureCache},
    },
};

use super::{
    cracks::{CrackBuffers, CrackStore, LineDensities, ViewCracks},
    draw::StrokeList,
    find::Resolved,
    history::{LineHistory, LineHolds},
    key::LineKey,
    passes::{FindPass, LinePasses},
    request::{LinePassUniform, LineRequest, blocks},
    settings::LineEdge,
    textures::{BLOCK_FORMAT, COLUMN_FORMAT, CRACK_FORMAT, INK_FORMAT, OWNER_FORMAT, texture},
    tiles::TileLists,
};

/// On a view in the render world: the lines of this frame.
#[derive(Component, Default)]
pub(crate) struct ViewLines {
    pub uniform: UniformBuffer<LinePassUniform>,
    /// One sample of every pixel, if the view is multisampled.
    pub resolved: Option<Resolved>,
    /// The cracks, if lines are found along cracks.
    pub cracks: Option<Cracks>,
    /// The blocks that have cracks, and the tiles that are drawn; `None` if all pixels
    /// are.
    pub tiles: Option<Tiles>,
    /// The ink of every pixel of the viewport, see `draw.wgsl`.
    pub ink: Option<CachedTexture>,
    /// The pixels that own its lines, if their color depends on them.
    pub owners: Option<CachedTexture>,
    /// The ink of this frame and of those before, if lines have a history.
    pub history: Option<LineHistory>,
    /// How long lines stay where their edges have become weak, if they do.
    pub holds: Option<LineHolds>,
    /// Whether the passes of this frame were recorded.
    pub found: AtomicBool,
}

/// The cracks of a view.
pub(crate) struct Cracks {
    pub store: CrackStore,
    /// How densely lines lie, if they have a budget.
    pub densities: Option<LineDensities>,
    /// The best cracks of each pixel's column, unless only neighbors are searched.
    pub columns: Option<CachedTexture>,
    /// The strokes beyond loose ends, if lines have such.
    pub strokes: Option<StrokeList>,
}

/// Where a view may have ink.
pub(crate) struct Tiles {
    pub blocks: CachedTexture,
    pub lists: TileLists,
}

impl ViewLines {
    /// The tiles that may have ink; `None` unless the passes of this frame were recorded.
    pub fn tiles(&self) -> Option<&TileLists> {
        let found = self.found.load(Ordering::Relaxed);
        self.tiles
            .as_ref()
            .filter(|_| found)
            .map(|tiles| &tiles.lists)
    }

    /// The ink; `None` unless the passes of this frame were recorded.
    pub fn found(&self) -> Option<&CachedTexture> {
        let found = self.found.load(Ordering::Relaxed);
        let history = self.history.as_ref().map(LineHistory::ink);
        history.or(self.ink.as_ref()).filter(|_| found)
    }
}

fn cracks(
    before: Option<Cracks>,
    (textures, device, queue): (&mut TextureCache, &RenderDevice, &RenderQueue),
    passes: &LinePasses,
    rect: UVec4,
) -> Option<Cracks> {
    let cracks = passes.cracks.as_ref()?;
    let mut drawn = |label, format| {
        let usage = TextureUsages::RENDER_ATTACHMENT;
        texture((textures, device), label, rect.zw(), (format, usage))
    };
    let columns = cracks
        .columns
        .map(|_| drawn("comics_line_columns", COLUMN_FORMAT));
    let before = before.map(|b| (Some(b.store), b.densities, b.strokes));
    let (store, densities, strokes) = before.unwrap_or_default();
    let densities =
        (passes.key.contains(LineKey::BUDGET)).then(|| LineDensities::new(densities, device, rect));
    let strokes = (cracks.strokes).map(|_| StrokeList::new(strokes, (device, queue), rect));
    let store = match cracks.find {
        FindPass::Cells(_) => {
            let before = store.and_then(|store| match store {
                CrackStore::Buffers(buffers) => Some(buffers),
                CrackStore::Texture(_) => None,
            });
            let bends = passes.key.contains(LineKey::SMOOTH);
            CrackStore::Buffers(CrackBuffers::new(before, device, rect, bends))
        }
        FindPass::Pixels(_) => CrackStore::Texture(drawn("comics_cracks", CRACK_FORMAT)),
    };
    Some(Cracks {
        store,
        densities,
        columns,
        strokes,
    })
}

impl ViewLines {
    /// Prepares them for a frame. Returns the cracks that other systems may read.
    fn fill(
        &mut self,
        (request, passes): (&LineRequest, &LinePasses),
        textures: &mut TextureCache,
        (device, queue): (&RenderDevice, &RenderQueue),
    ) -> Option<ViewCracks> {
        let key = passes.key.for_resolve();
        self.resolved =
            (passes.resolve).map(|_| Resolved::new((textures, device), key, request.depth_size));
        let before = self.cracks.take();
        self.cracks = cracks(before, (textures, device, queue), passes, request.rect);
        let before = self.tiles.take().map(|tiles| tiles.lists);
        self.tiles = passes.search.map(|_| Tiles {
            blocks: texture(
                (textures, device),
                "comics_line_blocks",
                blocks(request.rect),
                (BLOCK_FORMAT, TextureUsages::STORAGE_BINDING),
            ),
            lists: TileLists::new(before, (device, queue), request),
        });
        let mut drawn = |label, format| {
            let usage = TextureUsages::RENDER_ATTACHMENT;
            texture((textures, device), label, request.size, (format, usage))
        };
        let ink = passes.has_ink();
        self.ink = ink.then(|| drawn("comics_line_ink", INK_FORMAT));
        self.owners = (ink && passes.key.contains(LineKey::SURFACE))
            .then(|| drawn("comics_line_owners", OWNER_FORMAT));
        let before = self.history.take();
        let kept = self.found.load(Ordering::Relaxed);
        let history = request.history.filter(|_| passes.history.is_some());
        self.history = history.map(|history| {
            let request = (&history, request.size, &request.settings);
            LineHistory::next(before, kept, device, request)
        });
        let before = self.holds.take();
        self.holds = passes
            .key
            .contains(LineKey::HOLDS)
            .then(|| LineHolds::next(before, kept, device, request));
        self.found = AtomicBool::new(false);
        let is_new = self.history.as_ref().is_none_or(|history| history.is_new);
        let past_size = self.holds.as_ref().map(LineHolds::past_size);
        let uniform = request.uniform(is_new, past_size.unwrap_or_default());
        self.uniform.set(uniform);
        self.uniform.set_label(Some("comics_lines"));
        self.uniform.write_buffer(device, queue);
        match &self.cracks.as_ref()?.store {
            CrackStore::Buffers(buffers) => Some(buffers.shown(request.rect, request.copies())),
            CrackStore::Texture(_) => None,
        }
    }
}

pub(crate) fn prepare_view_lines(
    mut commands: Commands,
    mut views: Query<(Entity, &LineRequest, &LinePasses, Option<&mut ViewLines>)>,
    stale: Query<Entity, (With<ViewLines>, Without<LineRequest>)>,
    mut textures: ResMut<TextureCache>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    for (entity, request, passes, lines) in &mut views {
        if request.settings.edge == LineEdge::Hard && request.samples > 1 {
            warn_once!(
                "{} has lines with `LineEdge::Hard` and a multisampled picture, whose edges are \
                 smooth: give it `Msaa::Off`",
                request.camera
            );
        }
        let mut new = ViewLines::default();
        let known = lines.map(|lines| lines.into_inner());
        let is_new = known.is_none();
        let lines = known.unwrap_or(&mut new);
        let shown = lines.fill((request, passes), &mut textures, (&device, &queue));
        let mut view = commands.entity(entity);
        match shown {
            Some(cracks) => view.insert(cracks),
            None => view.remove::<ViewCracks>(),
        };
        if is_new {
            view.insert(new);
        }
    }
    for entity in &stale {
        commands.entity(entity).remove::<(ViewLines, ViewCracks)>();
    }
}
