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
        view::Msaa,
    },
};
use bevy_comics::{
    CartoonLight, CartoonScene, ComicStyle, ComicStyleHandle, ComicsPlugin, OutlineStyle, Outlines,
    presets,
};

use crate::headless::{Headless, HeadlessOptions, new_target};

/// Frames after which everything is as it was at the start.
pub const CYCLE: u64 = 720;
/// Cycles until every combination has been drawn once: what is compiled stays.
pub const WARM_UP: u64 = 4;

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
}

/// What changes in a run: to find out what is left of which change.
#[derive(Clone, Copy, Debug)]
pub struct Changes {
    pub sizes: bool,
    /// How many looks follow each other.
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
        Self {
            sizes: true,
            looks: presets::LOOKS.len(),
            cameras: true,
            materials: true,
            objects: true,
            files: true,
            plain: false,
        }
    }
}

impl Changes {
    /// Those that a text names, with commas between them, as `sizes,looks=3`; all for an empty one.
    pub fn of(names: &str) -> Self {
        let has = |name| names.is_empty() || names.split(',').any(|own| own == name);
        Self {
            sizes: has("sizes"),
            looks: if has("looks") {
                presets::LOOKS.len()
            } else {
                names
                    .split(',')
                    .find_map(|own| own.strip_prefix("looks=")?.parse().ok())
                    .unwrap_or(0)
            },
            cameras: has("cameras"),
            materials: has("materials"),
            objects: has("objects"),
            files: has("files"),
            plain: names.split(',').any(|own| own == "plain"),
        }
    }
}

/// The run.
pub struct Soak {
    changes: Changes,
    headless: Headless,
    /// Wears one look after the other.
    camera: Entity,
    root: Entity,
    visitor: Option<Entity>,
    crowd: Vec<Entity>,
    folder: PathBuf,
    frame: u64,
}

const FILE: &str = "soak.comic.ron";
const BROKEN: &str = "(version: 2, outlines: (width: \"wide\"))";

fn mended(k: u64) -> String {
    let width = 1.0 + (k % 4) as f32;
    format!("(version: 2, outlines: (width: {width:?}))")
}

impl Soak {
    /// `folder`: for the file of a style; it is made if it is not there.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn new(folder: &Path, changes: Changes) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        fs::write(folder.join(FILE), mended(0))?;
        let options = HeadlessOptions {
            size: SIZES[0],
            assets: folder.display().to_string(),
            ..default()
        };
        let mut headless = if changes.plain {
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
        let target = headless.render_target();
        let world = headless.app.world_mut();
        let root = world
            .spawn((Transform::default(), Visibility::default()))
            .id();
        for k in 0..3 {
            let cube = object(world, k);
            world.entity_mut(cube).insert(ChildOf(root));
        }
        world.spawn((
            DirectionalLight::default(),
            Transform::from_xyz(1.0, 3.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y),
        ));
        let camera = world.spawn(view(target)).id();
        let small = new_target(world, UVec2::new(40, 24), TextureFormat::Rgba8UnormSrgb);
        let second = world.spawn(view(small.into())).id();
        if !changes.plain {
            // Wears a file that breaks and is mended.
            let style = world.resource::<AssetServer>().load::<ComicStyle>(FILE);
            world.entity_mut(second).insert(ComicStyleHandle(style));
        }
        Ok(Self {
            changes,
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
        let number = self.frame / CYCLE;
        for at in 0..CYCLE {
            self.change(number, at)?;
            self.headless.step(1);
            self.frame += 1;
        }
        Ok(self.sample())
    }

    /// What changes before a frame of a cycle.
    fn change(&mut self, number: u64, at: u64) -> io::Result<()> {
        let changes = self.changes;
        if changes.sizes && at.is_multiple_of(12) {
            let size = if at == CYCLE - 12 { 0 } else { at / 12 };
            self.resize(SIZES[size as usize % SIZES.len()]);
        }
        if changes.looks > 0 && at.is_multiple_of(20) {
            let look = presets::LOOKS[(at / 20) as usize % changes.looks];
            let world = self.headless.app.world_mut();
            look.style()
                .apply(&mut world.commands().entity(self.camera));
            world.flush();
        }
        match at {
            0 if changes.cameras => self.set_up_camera(number),
            60 if changes.cameras => self.come(),
            200 if changes.cameras => self.go(),
            260 if changes.materials => self.be_cartoon(true),
            460 if changes.materials => self.be_cartoon(false),
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

    fn be_cartoon(&mut self, is_cartoon: bool) {
        let mut root = self.headless.app.world_mut().entity_mut(self.root);
        if is_cartoon {
            root.insert(CartoonScene::new(CartoonLight::default()));
        } else {
            root.remove::<CartoonScene>();
        }
    }

    /// Samples and range of colours change from cycle to cycle.
    fn set_up_camera(&mut self, number: u64) {
        let camera = self.camera;
        let mut camera = self.headless.app.world_mut().entity_mut(camera);
        camera.insert(if number.is_multiple_of(2) {
            Msaa::Off
        } else {
            Msaa::Sample4
        });
        if (number / 2).is_multiple_of(2) {
            camera.remove::<Hdr>();
        } else {
            camera.insert(Hdr);
        }
    }

    fn resize(&mut self, size: UVec2) {
        self.headless.resize(size, 1.0);
        let target = self.headless.render_target();
        let camera = self.camera;
        self.headless
            .app
            .world_mut()
            .entity_mut(camera)
            .insert(target);
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
        self.headless
            .app
            .world()
            .resource::<AssetServer>()
            .reload(FILE);
        Ok(())
    }

    fn sample(&self) -> Sample {
        let world = self.headless.app.sub_app(RenderApp).world();
        let report = world.resource::<RenderInstance>().generate_report();
        let resources = report.map_or_else(Vec::new, |report| {
            let hub = report.hub_report();
            vec![
                ("buffers", hub.buffers.num_allocated),
                ("textures", hub.textures.num_allocated),
                ("texture views", hub.texture_views.num_allocated),
                ("bind groups", hub.bind_groups.num_allocated),
                ("bind group layouts", hub.bind_group_layouts.num_allocated),
                ("samplers", hub.samplers.num_allocated),
                ("query sets", hub.query_sets.num_allocated),
                ("render pipelines", hub.render_pipelines.num_allocated),
                ("compute pipelines", hub.compute_pipelines.num_allocated),
            ]
        });
        Sample {
            frame: self.frame,
            resident: resident(),
            resources,
            errors: self.headless.app.world().resource::<Errors>().0,
        }
    }
}

/// Bevy 0.19.1 keeps bind groups of cameras that are gone (`BinUnpackingBindGroups`): three for each
/// camera, six with a prepass. Without them, what grows is this crate's.
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
    let mesh = world
        .resource_mut::<Assets<Mesh>>()
        .add(Cuboid::from_length(size));
    let color = Color::hsl((k * 37 % 360) as f32, 0.6, 0.5);
    let material = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial::from(color));
    let at = Transform::from_xyz((k % 7) as f32 * 0.5 - 1.5, 0.4, (k % 5) as f32 * 0.4 - 1.0);
    world
        .spawn((Mesh3d(mesh), MeshMaterial3d(material), at))
        .id()
}

/// Resident memory of this process in KiB, from `/proc`.
fn resident() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
