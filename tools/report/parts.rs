//! What single parts cost: factors of lines, highlighted objects, and effects of the page.

use bevy::{
    anti_alias::taa::TemporalAntiAliasing,
    core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass},
    prelude::*,
};
use bevy_comics::{
    ComicStyle, DepthLayers, Desaturation, NoStyle, OutlineStyle, Outlines, SelectionOutline,
    XRayOutline,
    lines::{CreaseSource, Creases, LineColor, LineResponse, LineWeight, Silhouettes},
    objects::{DepthWrite, LineWidths},
};

use bevy_comics_testkit::scenes::BuiltIn;

use crate::{
    Run,
    page_styles::{self, changed},
    rig::{self, Drawn, Rig},
};

/// Outlines of which one thing differs from the default.
fn lines() -> Vec<(&'static str, ComicStyle)> {
    let of = changed::<Outlines>;
    vec![
        ("outlines", of(|_| ())),
        ("gaps up to 3 pixels closed", of(|o| o.gap_closing = 3)),
        ("overshooting by 8 pixels", of(|o| o.overshoot = 8.0)),
        ("held for 4 frames", of(|o| o.hold_frames = 4)),
        ("under pressure", of(|o| o.weight = pressed())),
        ("without an ink budget", of(|o| o.ink_budget = 1.0)),
        ("with soft ink", of(soft)),
        (
            "in the color of surfaces",
            of(|o| o.color = LineColor::SURFACE),
        ),
        ("and depth layers", layer_lines()),
    ]
}

fn pressed() -> LineWeight {
    LineWeight {
        pressure: 0.5,
        ..LineWeight::EVEN
    }
}

fn soft(outlines: &mut Outlines) {
    let softness = 1.0;
    outlines.silhouettes = Some(Silhouettes {
        softness,
        ..default()
    });
    outlines.creases = Some(Creases {
        softness,
        ..default()
    });
    outlines.response = LineResponse::Both;
}

/// Outlines with another width and color in near, middle and far.
fn layer_lines() -> ComicStyle {
    let mut planes = DepthLayers::default();
    planes.background.line_color_amount = 1.0;
    ComicStyle::new().with(Outlines::default()).with(planes)
}

/// Marks every mesh of the scene.
fn mark<M: Component + Clone>(rig: &mut Rig, mark: M) {
    for mesh in rig.meshes() {
        let world = rig.headless.app.world_mut();
        world.entity_mut(mesh).insert(mark.clone());
    }
}

pub fn measure(run: &Run) -> Result<(), String> {
    let size = run.size([320, 180], [1280, 720]);
    let mut times = rig::times();
    let mut rig = Rig::new(Some(BuiltIn::Teapot), size);
    rig.unlight();
    let styles = rig::styles(run.some(2, lines()));
    rig::record(run, &mut times, "lines", "teapot", &mut rig, &styles);
    let styles = rig::styles(run.some(4, page_styles::all()));
    rig::record(run, &mut times, "page", "teapot", &mut rig, &styles);
    let variants = [
        ("nothing marked", Drawn::Nothing),
        ("selected", Drawn::Selected),
        ("seen through walls", Drawn::SeenThrough),
    ]
    .map(|(name, drawn)| (name.to_owned(), drawn));
    rig::record(run, &mut times, "marks", "teapot", &mut rig, &variants);
    run.save("part_times", &times)
}

/// A change of a scene whose cost is measured.
struct Part {
    name: &'static str,
    scene: BuiltIn,
    change: fn(&mut Rig),
    /// What is timed on the changed scene, with names.
    styles: Vec<(&'static str, ComicStyle)>,
    /// The change of the scene that this one is compared with, in the first of its styles.
    base: Option<fn(&mut Rig)>,
}

impl Part {
    /// One style on the changed teapot.
    fn new(name: &'static str, change: fn(&mut Rig), style: ComicStyle) -> Self {
        Self::on(BuiltIn::Teapot, name, change, vec![(name, style)])
    }

    fn on(
        scene: BuiltIn,
        name: &'static str,
        change: fn(&mut Rig),
        styles: Vec<(&'static str, ComicStyle)>,
    ) -> Self {
        Self {
            name,
            scene,
            change,
            styles,
            base: None,
        }
    }

    /// Compared with the scene as it is.
    fn compared(self) -> Self {
        self.compared_with(|_| ())
    }

    fn compared_with(self, base: fn(&mut Rig)) -> Self {
        let base = Some(base);
        Self { base, ..self }
    }

    fn rig(&self, run: &Run, change: fn(&mut Rig)) -> Rig {
        let mut rig = Rig::new(Some(self.scene), run.size([320, 180], [1280, 720]));
        rig.unlight();
        change(&mut rig);
        rig.headless.step(if run.quick { 5 } else { 30 });
        rig
    }
}

fn changes() -> Vec<Part> {
    let outlines = || ComicStyle::new().with(Outlines::default());
    let colors = || ComicStyle::new().with(Desaturation::default());
    let mut parts = vec![
        Part::new("outlines", |_| (), outlines()),
        Part::new("outlines; widths of vertices", widths, outlines()).compared(),
        Part::new("outlines; a width of each mesh", own_widths, outlines()).compared(),
        Part::new("outlines; 4 samples", samples, outlines()).compared(),
        Part::new("outlines; fog", fog, outlines()).compared(),
        Part::new("outlines; a mesh of glass", glass, outlines()).compared(),
        Part::new("outlines; it writes depth", glass_in_depth, outlines()).compared_with(glass),
        Part::new("desaturation", |_| (), colors()),
        Part::new("desaturation; a mesh without style", unstyled, colors()).compared(),
    ];
    // The village has lines in most of its tiles, the teapot in few.
    for scene in [BuiltIn::Teapot, BuiltIn::Village] {
        let without_history = changed::<Outlines>(|o| o.history_weight = 0.0);
        let styles = vec![
            (
                "outlines; temporal anti-aliasing; no history",
                without_history,
            ),
            ("outlines; temporal anti-aliasing; history", outlines()),
        ];
        parts.push(Part::on(scene, "temporal anti-aliasing", jitter, styles));
        let creases = |source| {
            let creases = Some(Creases {
                source,
                ..default()
            });
            ComicStyle::new().with(Outlines {
                creases,
                ..default()
            })
        };
        let styles = [
            ("outlines; creases of normals", CreaseSource::Normals),
            ("outlines; creases of meshes", CreaseSource::Meshes),
            ("outlines; creases of both", CreaseSource::Both),
        ];
        let styles = styles.map(|(name, source)| (name, creases(source)));
        let name = "what creases are found by";
        parts.push(Part::on(scene, name, |_| (), styles.to_vec()));
    }
    parts.extend([BuiltIn::Village, BuiltIn::Mountains].map(ink_budget));
    parts
}

/// Two passes measure how densely lines lie. They crowd on the meadow of the mountains.
fn ink_budget(scene: BuiltIn) -> Part {
    let styles = vec![
        (
            "outlines; no ink budget",
            changed::<Outlines>(|o| o.ink_budget = 1.0),
        ),
        (
            "outlines; ink budget",
            changed::<Outlines>(|o| o.ink_budget = 0.35),
        ),
    ];
    Part::on(scene, "ink budget", |_| (), styles)
}

/// Times each change on a scene of its own, in turn with the scene that it is compared with.
pub fn of_scenes(run: &Run) -> Result<(), String> {
    let mut times = rig::times();
    let rounds = run.rounds.min(3);
    let run = &run.with_rounds(1);
    for part in run.some(2, changes()) {
        let mut changed = part.rig(run, part.change);
        let mut base = part.base.map(|change| part.rig(run, change));
        let variants = rig::styles(part.styles.iter().cloned());
        let scene = part.scene.name();
        for _ in 0..rounds {
            if let Some(base) = &mut base {
                let section = format!("base of: {}", part.name);
                rig::record(run, &mut times, &section, scene, base, &variants);
            }
            let section = format!("part: {}", part.name);
            rig::record(run, &mut times, &section, scene, &mut changed, &variants);
        }
    }
    run.save("scene_part_times", &times)
}

/// Widths of 0.5 to 1.5, alternating from vertex to vertex.
fn widths(rig: &mut Rig) {
    mark(rig, LineWidths::default());
    let world = rig.headless.app.world_mut();
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    for (_, mesh) in meshes.iter_mut() {
        let count = mesh.count_vertices();
        let width = |i: usize| [1.0, 1.0, 1.0, 0.25 + 0.5 * (i % 2) as f32];
        let colors: Vec<[f32; 4]> = (0..count).map(width).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    }
}

/// Lines of 1, 2 and 3 pixels, in turn from mesh to mesh.
fn own_widths(rig: &mut Rig) {
    let all = rig.meshes();
    let world = rig.headless.app.world_mut();
    for (i, mesh) in all.into_iter().enumerate() {
        let style = OutlineStyle {
            width: Some(1.0 + (i % 3) as f32),
            ..default()
        };
        world.entity_mut(mesh).insert(style);
    }
}

fn samples(rig: &mut Rig) {
    let world = rig.headless.app.world_mut();
    world.entity_mut(rig.camera).insert(Msaa::Sample4);
}

/// The time of temporal anti-aliasing itself is not in that of the styles: it runs without them
/// too.
fn jitter(rig: &mut Rig) {
    let world = rig.headless.app.world_mut();
    world.entity_mut(rig.camera).insert((
        TemporalAntiAliasing::default(),
        DepthPrepass,
        MotionVectorPrepass,
    ));
}

fn fog(rig: &mut Rig) {
    let falloff = FogFalloff::Linear {
        start: 1.0,
        end: 20.0,
    };
    let world = rig.headless.app.world_mut();
    let fog = DistanceFog {
        falloff,
        ..default()
    };
    world.entity_mut(rig.camera).insert(fog);
}

/// Makes the mesh with most vertices transparent. Returns it.
fn turn_to_glass(rig: &mut Rig) -> Option<Entity> {
    let all = rig.meshes();
    let world = rig.headless.app.world_mut();
    let count = |entity: &Entity| {
        let mesh = world.get::<Mesh3d>(*entity);
        let mesh = mesh.and_then(|mesh| world.resource::<Assets<Mesh>>().get(&mesh.0));
        mesh.map_or(0, Mesh::count_vertices)
    };
    let largest = all.into_iter().max_by_key(count)?;
    let material = StandardMaterial {
        base_color: Color::srgba(0.6, 0.8, 0.9, 0.7),
        alpha_mode: AlphaMode::Blend,
        unlit: true,
        ..default()
    };
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    let material = materials.add(material);
    world.entity_mut(largest).insert(MeshMaterial3d(material));
    Some(largest)
}

fn glass(rig: &mut Rig) {
    turn_to_glass(rig);
}

fn glass_in_depth(rig: &mut Rig) {
    if let Some(mesh) = turn_to_glass(rig) {
        let world = rig.headless.app.world_mut();
        world.entity_mut(mesh).insert(DepthWrite::default());
    }
}

fn unstyled(rig: &mut Rig) {
    if let Some(mesh) = rig.meshes().first() {
        let world = rig.headless.app.world_mut();
        world.entity_mut(*mesh).insert(NoStyle::default());
    }
}

/// Marks the meshes of the scene as a variant asks.
pub fn set_marks(rig: &mut Rig, drawn: &Drawn) {
    let world = rig.headless.app.world_mut();
    let mut marked =
        world.query_filtered::<Entity, Or<(With<SelectionOutline>, With<XRayOutline>)>>();
    let marked: Vec<Entity> = marked.iter(world).collect();
    for mesh in marked {
        world
            .entity_mut(mesh)
            .remove::<(SelectionOutline, XRayOutline)>();
    }
    match drawn {
        Drawn::Selected => mark(rig, SelectionOutline::default()),
        Drawn::SeenThrough => mark(rig, XRayOutline::default()),
        _ => {}
    }
}
