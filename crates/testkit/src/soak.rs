//! A long run in which everything changes, again and again: sizes, cameras, objects, styles, files.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use bevy::{
    camera::{Hdr, RenderTarget},
    pbr::BinUnpackingBindGroups,
    prelude::*,
    render::{
        Render, RenderApp, RenderSystems,
        batching::gpu_preprocessing::BinUnpackingBuffers,
        error_handler::{RenderErrorHandler, RenderErrorPolicy},
        render_resource::TextureFormat,
        renderer::RenderInstance,
    },
};
use bevy_comics::{
    Comic, ComicStyle, ComicsDiagnostics, ComicsPlugin, OutlineStyle, Outlines, ToonLight,
    ToonScene, diagnostics::ComicsStage, presets,
};

use crate::headless::{Headless, HeadlessOptions, new_target};

/// Frames of a cycle of the long run, after which everything is as it was at the start.
pub const CYCLE: u64 = 720;
/// Cycles of the long run until every combination has been drawn once: what is compiled stays.
pub const WARM_UP: u64 = Pace::LONG.kinds.len() as u64;

/// How fast things change.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// A frame of this run stands for so many of the long run: 1, 2 or 4, which divide the times of
    /// all changes; or 20, with which fewer sizes and objects come.
    pub frames: u64,
    /// Frames of the long run until the next style.
    pub style: u64,
    /// The kinds of the first camera, one for each cycle in turn: 1 for multisampled, plus 2 for
    /// HDR.
    pub kinds: &'static [u64],
}

impl Pace {
    pub const LONG: Self = Self {
        frames: 1,
        style: 20,
        kinds: &[0, 1, 2, 3],
    };
    /// That of a test. The driver compiles shaders again for a style: there are few.
    pub const SHORT: Self = Self {
        frames: 4,
        style: 120,
        kinds: &[0, 3],
    };
    /// The shortest, with one kind of camera.
    pub const SHORTEST: Self = Self {
        frames: 20,
        style: 360,
        kinds: &[0],
    };
}

const SIZES: [UVec2; 6] = [
    UVec2::new(64, 36),
    UVec2::new(33, 17),
    UVec2::new(1, 1),
    UVec2::new(96, 64),
    UVec2::new(128, 8),
    UVec2::new(7, 90),
];

/// Errors of the renderer.
#[derive(Resource, Default)]
struct Errors(usize);

/// What exists at the end of a cycle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sample {
    pub frame: u64,
    /// Resident memory of the process in KiB; `None` where the system does not say.
    pub resident: Option<u64>,
    /// Resources of the GPU, by their kinds.
    pub resources: Vec<(&'static str, usize)>,
    /// Errors of the renderer so far.
    pub errors: usize,
    /// Whether the style of the first camera is drawn.
    pub styled: bool,
}

/// What changes in a run: to find out what is left of which change.
#[derive(Clone, Copy, Debug)]
pub struct Changes {
    pub sizes: bool,
    /// How many styles follow each other.
    pub looks: usize,
    pub cameras: bool,
    pub materials: bool,
    pub objects: bool,
    pub files: bool,
    /// Nothing of this crate is used: what then grows is the engine's.
    pub plain: bool,
}

impl Default for Changes {
    fn default() -> Self {
        Self::of("")
    }
}

impl Changes {
    /// Those that a text names, with commas between them, as `sizes,looks=3`; all for an empty one.
    pub fn of(names: &str) -> Self {
        let own = || names.split(',');
        let has = |name| names.is_empty() || own().any(|own| own == name);
        let styles = own().find_map(|own| own.strip_prefix("looks=")?.parse().ok());
        let all = has("looks").then_some(presets::STYLES.len());
        Self {
            sizes: has("sizes"),
            looks: all.or(styles).unwrap_or(0),
            cameras: has("cameras"),
            materials: has("materials"),
            objects: has("objects"),
            files: has("files"),
            plain: own().any(|own| own == "plain"),
        }
    }
}

/// The run.
pub struct Soak {
    changes: Changes,
    pace: Pace,
    headless: Headless,
    /// Has one style after the other.
    camera: Entity,
    root: Entity,
    visitor: Option<Entity>,
    crowd: Vec<Entity>,
    folder: PathBuf,
    frame: u64,
}

const FILE: &str = "soak.comic.ron";
const BROKEN: &str = "(version: 3, outlines: (width: \"wide\"))";

fn mended(k: u64) -> String {
    let width = 1.0 + (k % 4) as f32;
    format!("(version: 3, outlines: (width: {width:?}))")
}

impl Soak {
    /// The long run. `folder`: for the file of a style; it is made if it is not there.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn new(folder: &Path, changes: Changes) -> io::Result<Self> {
        Self::with_pace(folder, changes, Pace::LONG)
    }

    /// The same at another pace.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn with_pace(folder: &Path, changes: Changes, pace: Pace) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        fs::write(folder.join(FILE), mended(0))?;
        let mut headless = app(folder, changes.plain, pace);
        let target = headless.render_target();
        let world = headless.app.world_mut();
        let root = spawn_scene(world);
        let camera = world.spawn(view(target)).id();
        let small = new_target(world, UVec2::new(40, 24), TextureFormat::Rgba8UnormSrgb);
        let second = world.spawn(view(small.into())).id();
        if !changes.plain {
            // Has the style of a file that breaks and is mended.
            let style = world.resource::<AssetServer>().load::<ComicStyle>(FILE);
            world.entity_mut(second).insert(Comic(style));
        }
        Ok(Self {
            changes,
            pace,
            headless,
            camera,
            root,
            visitor: None,
            crowd: Vec::new(),
            folder: folder.to_owned(),
            frame: 0,
        })
    }

    /// Draws the frames of a cycle.
    ///
    /// # Errors
    /// If the file of the style cannot be written.
    pub fn cycle(&mut self) -> io::Result<Sample> {
        let frames = CYCLE / self.pace.frames;
        let kinds = self.pace.kinds;
        let number = (self.frame / frames) as usize % kinds.len();
        for frame in 0..frames {
            self.change((number as u64, kinds[number]), frame * self.pace.frames)?;
            self.headless.step(1);
            self.frame += 1;
        }
        Ok(self.sample())
    }

    /// What changes before a frame of a cycle, of which the number and the kind of the camera are
    /// given.
    fn change(&mut self, (number, kind): (u64, u64), at: u64) -> io::Result<()> {
        let changes = self.changes;
        if changes.sizes && at.is_multiple_of(12) {
            let size = if at == CYCLE - 12 { 0 } else { at / 12 };
            self.resize(SIZES[size as usize % SIZES.len()]);
        }
        if changes.looks > 0 && at.is_multiple_of(self.pace.style) {
            let preset = presets::STYLES[(at / self.pace.style) as usize % changes.looks];
            let world = self.headless.app.world_mut();
            let mut commands = world.commands();
            preset.style().apply(&mut commands.entity(self.camera));
            world.flush();
        }
        match at {
            0 if changes.cameras => self.set_up_camera(kind),
            60 if changes.cameras => self.come(),
            200 if changes.cameras => self.go(),
            260 if changes.materials => self.be_toon(true),
            460 if changes.materials => self.be_toon(false),
            500 if changes.files => self.write(BROKEN)?,
            560 if changes.files => self.write(&mended(number))?,
            _ => {}
        }
        if changes.objects && at.is_multiple_of(5) {
            self.crowd(at);
        }
        Ok(())
    }

    /// Twenty objects come one after the other, and go.
    fn crowd(&mut self, at: u64) {
        let world = self.headless.app.world_mut();
        if (300..400).contains(&at) {
            let new = object(world, at);
            world.entity_mut(new).insert(OutlineStyle::default());
            self.crowd.push(new);
        }
        if (400..600).contains(&at)
            && let Some(old) = self.crowd.pop()
        {
            world.despawn(old);
        }
    }

    fn be_toon(&mut self, is_toon: bool) {
        let mut root = self.headless.app.world_mut().entity_mut(self.root);
        if is_toon {
            root.insert(ToonScene::new(ToonLight::default()));
        } else {
            root.remove::<ToonScene>();
        }
    }

    /// Samples and range of colors change from cycle to cycle.
    fn set_up_camera(&mut self, kind: u64) {
        let mut camera = self.headless.app.world_mut().entity_mut(self.camera);
        let samples = [Msaa::Off, Msaa::Sample4];
        camera.insert(samples[(kind & 1) as usize]);
        if kind & 2 == 0 {
            camera.remove::<Hdr>();
        } else {
            camera.insert(Hdr);
        }
    }

    fn resize(&mut self, size: UVec2) {
        self.headless.resize(size, 1.0);
        let target = self.headless.render_target();
        let world = self.headless.app.world_mut();
        world.entity_mut(self.camera).insert(target);
    }

    /// Another camera with a target of its own.
    fn come(&mut self) {
        let world = self.headless.app.world_mut();
        let target = new_target(world, UVec2::new(50, 30), TextureFormat::Rgba8UnormSrgb);
        let mut visitor = world.spawn(view(target.into()));
        if !self.changes.plain {
            visitor.insert(Outlines::default());
        }
        self.visitor = Some(visitor.id());
    }

    fn go(&mut self) {
        if let Some(visitor) = self.visitor.take() {
            self.headless.app.world_mut().despawn(visitor);
        }
    }

    fn write(&self, text: &str) -> io::Result<()> {
        fs::write(self.folder.join(FILE), text)?;
        let world = self.headless.app.world();
        world.resource::<AssetServer>().reload(FILE);
        Ok(())
    }

    fn sample(&self) -> Sample {
        let world = self.headless.app.sub_app(RenderApp).world();
        let report = world.resource::<RenderInstance>().generate_report();
        let resources = report.map_or_else(Vec::new, |report| {
            let hub = report.hub_report();
            let counted = [
                ("buffers", &hub.buffers),
                ("textures", &hub.textures),
                ("texture views", &hub.texture_views),
                ("bind groups", &hub.bind_groups),
                ("bind group layouts", &hub.bind_group_layouts),
                ("samplers", &hub.samplers),
                ("query sets", &hub.query_sets),
                ("render pipelines", &hub.render_pipelines),
                ("compute pipelines", &hub.compute_pipelines),
            ];
            counted.map(|(kind, of)| (kind, of.num_allocated)).to_vec()
        });
        let world = self.headless.app.world();
        let diagnostics = world.get_resource::<ComicsDiagnostics>();
        Sample {
            frame: self.frame,
            resident: resident(),
            resources,
            errors: world.resource::<Errors>().0,
            styled: diagnostics.is_some_and(|d| d.ran(self.camera, ComicsStage::Stylize)),
        }
    }
}

/// An app that counts errors of the renderer. Systems run on several threads but at the shortest
/// pace.
fn app(folder: &Path, plain: bool, pace: Pace) -> Headless {
    let options = HeadlessOptions {
        size: SIZES[0],
        assets: folder.display().to_string(),
        parallel_systems: pace.frames < Pace::SHORTEST.frames,
        ..default()
    };
    let mut headless = if plain {
        Headless::new(options, ())
    } else {
        Headless::new(options, ComicsPlugin)
    };
    headless
        .app
        .sub_app_mut(RenderApp)
        .add_systems(Render, forget_gone_views.in_set(RenderSystems::Cleanup));
    headless
        .app
        .init_resource::<Errors>()
        .insert_resource(RenderErrorHandler(|error, main, _| {
            println!("{}", error.description);
            main.resource_mut::<Errors>().0 += 1;
            RenderErrorPolicy::Ignore
        }));
    headless
}

/// Three cubes below one root, in the light of the sun.
fn spawn_scene(world: &mut World) -> Entity {
    let root = (Transform::default(), Visibility::default());
    let root = world.spawn(root).id();
    for k in 0..3 {
        let cube = object(world, k);
        world.entity_mut(cube).insert(ChildOf(root));
    }
    world.spawn((
        DirectionalLight::default(),
        Transform::from_xyz(1.0, 3.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    root
}

/// Bevy 0.19.1 keeps bind groups of cameras that are gone (`BinUnpackingBindGroups`): three for
/// each camera, six with a prepass. Without them, what grows is this crate's.
fn forget_gone_views(
    mut groups: ResMut<BinUnpackingBindGroups>,
    buffers: Res<BinUnpackingBuffers>,
) {
    groups.retain(|view, _| buffers.view_phase_buffers.contains_key(view));
}

fn view(target: RenderTarget) -> impl Bundle {
    (
        Camera3d::default(),
        Transform::from_xyz(1.5, 2.4, 6.0).looking_at(Vec3::new(0.0, 0.4, 0.0), Vec3::Y),
        target,
        Msaa::Off,
    )
}

/// A cube with a mesh and a material of its own.
fn object(world: &mut World, k: u64) -> Entity {
    let size = 0.5 + (k % 3) as f32 * 0.3;
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    let mesh = Mesh3d(meshes.add(Cuboid::from_length(size)));
    let color = Color::hsl((k * 37 % 360) as f32, 0.6, 0.5);
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    let material = MeshMaterial3d(materials.add(StandardMaterial::from(color)));
    let at = Transform::from_xyz((k % 7) as f32 * 0.5 - 1.5, 0.4, (k % 5) as f32 * 0.4 - 1.0);
    world.spawn((mesh, material, at)).id()
}

/// Resident memory of this process in KiB, from `/proc`.
fn resident() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
