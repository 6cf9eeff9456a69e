//! An app that renders one camera into an image, frame by frame, without a
//! window.

use std::time::{Duration, Instant};

use bevy::{
    app::{PluginGroupBuilder, PluginsState},
    asset::RenderAssetUsages,
    camera::{ImageRenderTarget, RenderTarget},
    ecs::schedule::SingleThreadedExecutor,
    log::LogPlugin,
    prelude::*,
    render::{
        RenderApp, RenderPlugin,
        render_asset::RenderAssets,
        render_resource::{
            PipelineCache, PipelineDescriptor, PollType, TextureFormat, TextureUsages,
        },
        renderer::RenderDevice,
        settings::WgpuSettings,
        texture::GpuImage,
    },
    time::TimeUpdateStrategy,
    window::ExitCondition,
    winit::WinitPlugin,
};

use bevy_comics::objects::MeshTasks;

use crate::{
    ROOT,
    pool::{self, Baseline, Pool},
    read_back, validation,
};

/// The command that installs an adapter that runs on the CPU, on Debian.
pub const INSTALL_ADAPTER: &str = "apt-get install mesa-vulkan-drivers libvulkan1";

/// The longest that a frame waits for shaders to load. A shader whose file is missing
/// never does.
const LOADING: Duration = Duration::from_secs(2);

/// What every frame takes of the app's time, so that tests are repeatable.
pub const FRAME: Duration = Duration::from_micros(16_667);

/// Options of a headless app.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadlessOptions {
    /// Size of the picture in pixels.
    pub size: UVec2,
    /// Format of the picture. Default: `Rgba8UnormSrgb`.
    pub format: TextureFormat,
    /// Physical pixels per logical pixel. Default: 1.
    pub scale_factor: f32,
    /// Whether errors of the engine and warnings of this crate are logged.
    pub log: bool,
    /// Folder of assets, absolute or relative to the working folder.
    pub assets: String,
    /// Whether an asset is loaded again when its file changes.
    pub watch: bool,
    /// Whether pipelines compile while frames are drawn, as in a game; else every
    /// pipeline is compiled before its first use.
    pub background_pipelines: bool,
    /// Whether systems run on several threads, as in a game. Default: one after another, because
    /// with small pictures up to half of a frame goes into waking threads.
    pub parallel_systems: bool,
    /// Limits of the device below those of the adapter.
    pub limits: Option<wgpu::Limits>,
    /// Graphics APIs that may be used. Default: those that `WGPU_BACKEND` names, else all but
    /// OpenGL.
    pub backends: wgpu::Backends,
}

impl Default for HeadlessOptions {
    fn default() -> Self {
        Self {
            size: UVec2::new(640, 480),
            format: TextureFormat::Rgba8UnormSrgb,
            scale_factor: 1.0,
            log: false,
            assets: format!("{ROOT}/assets"),
            watch: false,
            background_pipelines: false,
            parallel_systems: false,
            limits: None,
            backends: default_backends(),
        }
    }
}

/// The engine's plugins without a window and without pipelined rendering.
pub fn plugins(options: &HeadlessOptions) -> PluginGroupBuilder {
    let group = DefaultPlugins
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            render_creation: WgpuSettings {
                backends: Some(options.backends),
                constrained_limits: options
                    .limits
                    .clone()
                    .or_else(|| gl_limits(options.backends)),
                instance_flags: validation::instance_flags(),
                ..default()
            }
            .into(),
            synchronous_pipeline_compilation: !options.background_pipelines,
            ..default()
        })
        .set(AssetPlugin {
            file_path: options.assets.clone(),
            watch_for_changes_override: Some(options.watch),
            unapproved_path_mode: bevy::asset::UnapprovedPathMode::Allow,
            ..default()
        })
        .disable::<WinitPlugin>()
        .disable::<bevy::render::pipelined_rendering::PipelinedRenderingPlugin>();
    if options.log {
        group.set(LogPlugin {
            filter: "error,bevy_comics=warn".into(),
            ..default()
        })
    } else {
        group.disable::<LogPlugin>()
    }
}

/// The backends that `WGPU_BACKEND` names; by default all but OpenGL, which needs a
/// display.
fn default_backends() -> wgpu::Backends {
    wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY)
}

/// Limits under which the engine draws with OpenGL: with more storage textures it compiles its
/// screen-space ambient occlusion, which OpenGL refuses, and stops drawing (Bevy 0.19.1).
fn gl_limits(backends: wgpu::Backends) -> Option<wgpu::Limits> {
    if backends != wgpu::Backends::GL {
        return None;
    }
    let adapter = adapter_of(backends).ok()?;
    Some(wgpu::Limits {
        max_storage_textures_per_shader_stage: 4,
        ..adapter.limits
    })
}

/// The adapter that renders, and its limits.
#[derive(Clone, Debug)]
pub struct Adapter {
    pub info: wgpu::AdapterInfo,
    pub limits: wgpu::Limits,
    /// Largest width and height of a picture in pixels.
    pub max_size: u32,
    /// Sample counts that targets of color, HDR color and depth all support.
    pub samples: Vec<u32>,
}

/// Finds the adapter; the error names the command that installs one.
pub fn adapter() -> Result<Adapter, String> {
    adapter_of(default_backends())
}

/// The same of some graphics APIs.
pub fn adapter_of(backends: wgpu::Backends) -> Result<Adapter, String> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let request = instance.request_adapter(&wgpu::RequestAdapterOptions::default());
    let Ok(adapter) = bevy::tasks::block_on(request) else {
        return Err(format!(
            "no graphics adapter; on Debian this installs one that runs on the CPU: {INSTALL_ADAPTER}"
        ));
    };
    let supported = |count: &u32| {
        use wgpu::TextureFormat::{Depth32Float, Rgba8UnormSrgb, Rgba16Float};
        [Rgba8UnormSrgb, Rgba16Float, Depth32Float]
            .into_iter()
            .all(|format| {
                adapter
                    .get_texture_format_features(format)
                    .flags
                    .sample_count_supported(*count)
            })
    };
    Ok(Adapter {
        info: adapter.get_info(),
        limits: adapter.limits(),
        max_size: adapter.limits().max_texture_dimension_2d,
        samples: [1, 2, 4, 8].into_iter().filter(supported).collect(),
    })
}

/// A running headless app.
pub struct Headless {
    pub app: App,
    pub target: Handle<Image>,
    pub options: HeadlessOptions,
    /// For an app of a pool: the pool, and the state of the app before.
    pub(crate) lent: Option<(&'static Pool, Baseline)>,
}

impl Headless {
    /// Starts the engine with `extra` plugins. Without an adapter it panics, with the
    /// command that installs one.
    pub fn new<M>(options: HeadlessOptions, extra: impl bevy::app::Plugins<M>) -> Self {
        Self::start(options, |app, engine| {
            app.add_plugins(engine).add_plugins(extra);
        })
    }

    /// The same with `first` added before the engine's plugins.
    pub fn with_plugins_first<M>(
        options: HeadlessOptions,
        first: impl bevy::app::Plugins<M>,
    ) -> Self {
        Self::start(options, |app, engine| {
            app.add_plugins(first).add_plugins(engine);
        })
    }

    fn start(
        options: HeadlessOptions,
        add_plugins: impl FnOnce(&mut App, PluginGroupBuilder),
    ) -> Self {
        if let Err(message) = adapter_of(options.backends) {
            panic!("{message}");
        }
        let mut app = App::new();
        add_plugins(&mut app, plugins(&options));
        Self::of(app, options)
    }

    /// Starts an app that has the engine's [`plugins`].
    pub fn of(mut app: App, options: HeadlessOptions) -> Self {
        app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME))
            .insert_resource(MeshTasks::Immediate);
        let target = new_target(app.world_mut(), options.size, options.format);
        while app.plugins_state() == PluginsState::Adding {
            bevy::tasks::tick_global_task_pools_on_main_thread();
        }
        app.finish();
        app.cleanup();
        if !options.parallel_systems {
            run_systems_in_turn(&mut app);
        }
        Self {
            app,
            target,
            options,
            lent: None,
        }
    }

    /// The render target of the picture, for a camera.
    pub fn render_target(&self) -> RenderTarget {
        RenderTarget::Image(ImageRenderTarget {
            handle: self.target.clone(),
            scale_factor: self.options.scale_factor,
        })
    }

    /// Replaces the target by one of another size. Cameras keep the old one.
    pub fn resize(&mut self, size: UVec2, scale_factor: f32) {
        self.options.size = size;
        self.options.scale_factor = scale_factor;
        self.target = new_target(self.app.world_mut(), size, self.options.format);
    }

    /// Renders frames, each to its end. Shaders of the engine load in the background:
    /// a frame that misses one (without it, a scene has no lamps, for example) is drawn
    /// again, while time stands still. With `background_pipelines` it is not, as in a
    /// game.
    pub fn step(&mut self, frames: usize) {
        for _ in 0..frames {
            self.app.update();
            if !self.options.background_pipelines && self.is_compiling() {
                self.draw_until_compiled();
            }
            self.wait_for_the_gpu();
        }
    }

    /// Whether any pipeline is missing, the engine's included.
    pub fn is_compiling(&self) -> bool {
        let Some(cache) = self.in_render_world::<PipelineCache>() else {
            return false;
        };
        let pipelines: Vec<_> = cache.pipelines().collect();
        (cache.waiting_pipelines()).any(|id| has_shader(&pipelines[id].descriptor))
    }

    fn draw_until_compiled(&mut self) {
        let stopped = TimeUpdateStrategy::ManualDuration(Duration::ZERO);
        let mut strategy = self.app.world_mut().resource_mut::<TimeUpdateStrategy>();
        let time = std::mem::replace(&mut *strategy, stopped);
        let until = Instant::now() + LOADING;
        while self.is_compiling() && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(2));
            self.app.update();
        }
        self.app.insert_resource(time);
    }

    /// The engine reads back how many lights its clusters hold, and how far they reach:
    /// the next frame uses both.
    fn wait_for_the_gpu(&self) {
        if let Some(device) = self.in_render_world::<RenderDevice>() {
            device
                .poll(PollType::wait_indefinitely())
                .expect("the device answers");
        }
        validation::check();
    }

    pub(crate) fn in_render_world<R: Resource>(&self) -> Option<&R> {
        self.app.get_sub_app(RenderApp)?.world().get_resource()
    }

    /// The last picture, read back.
    pub fn picture(&mut self) -> image::RgbaImage {
        let target = self.target.clone();
        self.picture_of(&target)
    }

    /// The last picture of another target.
    pub fn picture_of(&mut self, target: &Handle<Image>) -> image::RgbaImage {
        let world = self.app.sub_app(RenderApp).world();
        let gpu_image = world
            .resource::<RenderAssets<GpuImage>>()
            .get(target)
            .expect("the target was rendered to at least once");
        let texture = gpu_image.texture.clone();
        let size = gpu_image.texture_descriptor.size;
        let bytes = read_back::texture_bytes(world, &texture);
        image::RgbaImage::from_raw(size.width, size.height, bytes).expect("four bytes a pixel")
    }
}

impl Drop for Headless {
    /// Gives an app of a pool back. Ends any other, and checks what Vulkan's validation layer said
    /// since the last frame, and while the app ended.
    fn drop(&mut self) {
        pool::give_back(self);
        drop(std::mem::replace(&mut self.app, App::empty()));
        if !std::thread::panicking() {
            validation::check();
        }
    }
}

/// Whether a pipeline can ever compile. On devices with few storage buffers, the engine's pipeline
/// that updates buffers in part has no shader (Bevy 0.19.1), and a wait for it would take
/// [`LOADING`] each frame.
fn has_shader(pipeline: &PipelineDescriptor) -> bool {
    match pipeline {
        PipelineDescriptor::ComputePipelineDescriptor(compute) => {
            compute.shader != Handle::default()
        }
        PipelineDescriptor::RenderPipelineDescriptor(_) => true,
    }
}

/// Gives every schedule of the game and of the renderer an executor on one thread.
fn run_systems_in_turn(app: &mut App) {
    let in_turn = |world: &mut World| {
        for (_, schedule) in world.resource_mut::<Schedules>().iter_mut() {
            schedule.set_executor(SingleThreadedExecutor::new());
        }
    };
    in_turn(app.world_mut());
    if let Some(renderer) = app.get_sub_app_mut(RenderApp) {
        in_turn(renderer.world_mut());
    }
}

/// An image that can be rendered to and read back.
pub fn new_target(world: &mut World, size: UVec2, format: TextureFormat) -> Handle<Image> {
    let mut image = Image::new_target_texture(size.x, size.y, format, None);
    image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    image.asset_usage = RenderAssetUsages::default();
    world.resource_mut::<Assets<Image>>().add(image)
}
