//! A scene that renders quickly: three cubes on a ground, with sky behind.

use bevy::{
    app::Plugins,
    camera::{CameraProjection, SubCameraView},
    math::Vec3A,
    render::error_handler::RenderErrorPolicy,
    time::TimeUpdateStrategy,
};
use bevy_comics_testkit::{
    before::BeforeStylize,
    pool::Pool,
    read_back::{self, CrackWords, DepthImage, WidthImage},
    reference::{color, resolve::Prepass},
};

use crate::{prelude::*, upscaled::OverrideMainPass};

/// Errors that the renderer reported. The first one ends a test that does not count them.
#[derive(Resource, Default)]
pub struct RenderErrors {
    pub count: usize,
    pub are_counted: bool,
}

pub struct Small {
    pub headless: Headless,
    pub camera: Entity,
}

pub fn size() -> UVec2 {
    UVec2::new(96, 64)
}

pub fn options(size: UVec2) -> HeadlessOptions {
    HeadlessOptions { size, ..default() }
}

/// The camera of the small scene.
pub fn camera(target: RenderTarget, msaa: Msaa) -> impl Bundle {
    (
        Camera3d::default(),
        Camera {
            clear_color: Color::srgb(0.3, 0.5, 0.8).into(),
            ..default()
        },
        Transform::from_xyz(1.5, 2.4, 6.0).looking_at(Vec3::new(0.0, 0.4, 0.0), Vec3::Y),
        Tonemapping::None,
        // Dither would differ in every comparison.
        DebandDither::Disabled,
        target,
        msaa,
    )
}

/// A new app. Errors of its renderer end the test, unless it calls [`Small::count_errors`].
pub fn start<M>(options: HeadlessOptions, more: impl Plugins<M>) -> Headless {
    let usual = (ComicsPlugin, BeforeStylize::Copy, OverrideMainPass);
    let mut headless = Headless::new(options, (usual, more));
    headless
        .app
        .init_resource::<RenderErrors>()
        .insert_resource(RenderErrorHandler(|error, main, _| {
            println!("{}", error.description);
            let mut errors = main.resource_mut::<RenderErrors>();
            errors.count += 1;
            assert!(errors.are_counted, "an error of the renderer: {error:?}");
            RenderErrorPolicy::Ignore
        }));
    headless
}

/// The apps of most tests.
static POOL: Pool = Pool::new(|options| start(options, ()), draw_once);

/// Draws the small scene with lines, with an image that is new.
pub fn draw_once(headless: &mut Headless) {
    let target = headless.render_target();
    let world = headless.app.world_mut();
    spawn_objects(world);
    let camera = world.spawn(camera(target, Msaa::Off)).id();
    let style = ComicStyle::new().with(Outlines::default());
    style.apply(&mut world.commands().entity(camera));
    let image = world.resource_mut::<Assets<Image>>().add(Image::default());
    headless.step(2);
    drop(image);
    headless.step(1);
}

impl Small {
    pub fn new(size: UVec2, msaa: Msaa) -> Self {
        Self::with(options(size), msaa)
    }

    /// The app may have drawn other tests before ([`Pool`]). A test of what an app does first, or
    /// of what it finds out for good, needs [`Small::alone`].
    pub fn with(options: HeadlessOptions, msaa: Msaa) -> Self {
        Self::of(POOL.take(options), msaa)
    }

    /// The same in a new app.
    pub fn alone(options: HeadlessOptions, msaa: Msaa) -> Self {
        Self::with_plugins(options, msaa, ())
    }

    /// The same with more plugins.
    pub fn with_plugins<M>(options: HeadlessOptions, msaa: Msaa, more: impl Plugins<M>) -> Self {
        Self::of(start(options, more), msaa)
    }

    /// The small scene in an app that has the plugins of [`start`].
    pub fn of(mut headless: Headless, msaa: Msaa) -> Self {
        spawn_objects(headless.app.world_mut());
        let target = headless.render_target();
        let camera = headless.app.world_mut().spawn(camera(target, msaa)).id();
        Self { headless, camera }
    }

    /// Starts over: the small scene, and a new camera without history.
    pub fn restart(&mut self, msaa: Msaa) {
        self.clear();
        let old = self.camera;
        let target = self.headless.render_target();
        let world = self.world();
        world.despawn(old);
        spawn_objects(world);
        self.camera = world.spawn(camera(target, msaa)).id();
    }

    pub fn world(&mut self) -> &mut World {
        self.headless.app.world_mut()
    }

    pub fn camera_mut(&mut self) -> EntityWorldMut<'_> {
        let camera = self.camera;
        self.world().entity_mut(camera)
    }

    pub fn insert(&mut self, bundle: impl Bundle) -> &mut Self {
        let camera = self.camera;
        self.world().entity_mut(camera).insert(bundle);
        self
    }

    /// Removes every object of the scene.
    pub fn clear(&mut self) {
        let world = self.world();
        let mut objects = world.query_filtered::<Entity, With<Object>>();
        for object in objects.iter(world).collect::<Vec<_>>() {
            world.despawn(object);
        }
    }

    /// Adds an object with a material of its own.
    pub fn put(
        &mut self,
        mesh: impl Into<Mesh>,
        material: StandardMaterial,
        at: Transform,
    ) -> Entity {
        let material = self
            .world()
            .resource_mut::<Assets<StandardMaterial>>()
            .add(material);
        self.put_shared(mesh, MeshMaterial3d(material), at)
    }

    /// Adds an object with a material that others may have too.
    pub fn put_shared(
        &mut self,
        mesh: impl Into<Mesh>,
        material: impl Bundle,
        at: Transform,
    ) -> Entity {
        let world = self.world();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        world.spawn((Object, Mesh3d(mesh), material, at)).id()
    }

    pub fn style(&mut self, style: &ComicStyle) -> &mut Self {
        let camera = self.camera;
        let world = self.world();
        style.apply(&mut world.commands().entity(camera));
        world.flush();
        self
    }

    /// Renders until a change has reached the picture and the diagnostics: until two frames in turn
    /// report the same stages. The depth range arrives in the game a few frames later than the
    /// picture, so an app whose camera reads it back renders all frames.
    pub fn settle(&mut self) -> &mut Self {
        const LEAST: usize = 3;
        const MOST: usize = 5;
        let mut before = None;
        for frame in 1..=MOST {
            self.headless.step(1);
            let world = self.headless.app.world();
            let now = world.resource::<ComicsDiagnostics>().cameras.clone();
            let reads_range = world.get::<VisibleDepthRange>(self.camera).is_some();
            if frame >= LEAST && before.as_ref() == Some(&now) && !reads_range {
                break;
            }
            before = Some(now);
        }
        self
    }

    /// Lets time pass, in frames of 100 ms.
    pub fn wait(&mut self, seconds: f32) {
        let longer = TimeUpdateStrategy::ManualDuration(Duration::from_millis(100));
        let mut strategy = self.world().resource_mut::<TimeUpdateStrategy>();
        let usual = std::mem::replace(&mut *strategy, longer);
        self.headless.step((10.0 * seconds).round() as usize);
        self.world().insert_resource(usual);
    }

    pub fn picture(&mut self) -> image::RgbaImage {
        self.headless.picture()
    }

    /// The picture in a style.
    pub fn shot(&mut self, style: &ComicStyle) -> image::RgbaImage {
        self.style(style).settle().picture()
    }

    pub fn ran(&self, stage: ComicsStage) -> bool {
        let world = self.headless.app.world();
        world
            .resource::<ComicsDiagnostics>()
            .ran(self.camera, stage)
    }

    /// From now on, errors of the renderer are counted and do not end the test.
    pub fn count_errors(&mut self) {
        self.world().resource_mut::<RenderErrors>().are_counted = true;
    }

    pub fn errors(&self) -> usize {
        self.headless.app.world().resource::<RenderErrors>().count
    }

    pub fn range(&self) -> Option<VisibleDepthRange> {
        self.headless.app.world().get(self.camera).copied()
    }

    fn view(&self) -> Entity {
        let view = self.headless.app.world().get::<RenderEntity>(self.camera);
        view.expect("extracted").id()
    }

    pub fn render_world(&self) -> &World {
        self.headless.app.sub_app(RenderApp).world()
    }

    pub fn depth(&self) -> Option<DepthImage> {
        read_back::depth(self.render_world(), self.view())
    }

    pub fn normals(&self) -> Option<FloatImage> {
        read_back::normals(self.render_world(), self.view())
    }

    pub fn motion_vectors(&self) -> Option<FloatImage> {
        read_back::motion_vectors(self.render_world(), self.view())
    }

    /// All samples of the prepass textures; `None` without a depth prepass.
    pub fn prepass(&self) -> Option<Prepass> {
        let (world, view) = (self.render_world(), self.view());
        let depth = self.depth()?;
        let samples = 0..depth.samples;
        Some(Prepass {
            normals: (samples.clone())
                .filter_map(|s| read_back::normals_of(world, view, s))
                .collect(),
            ids: (samples.clone())
                .filter_map(|s| read_back::object_ids_of(world, view, s))
                .collect(),
            widths: samples
                .filter_map(|s| read_back::line_widths_of(world, view, s))
                .collect(),
            depth,
        })
    }

    /// The factors of the width of lines, at the first sample of each pixel.
    pub fn line_widths(&self) -> Option<WidthImage> {
        read_back::line_widths_of(self.render_world(), self.view(), 0)
    }

    pub fn object_ids(&self) -> Option<IdImage> {
        read_back::object_ids(self.render_world(), self.view())
    }

    /// The cracks of the last frame.
    pub fn cracks(&self) -> Option<CrackWords> {
        read_back::cracks(self.render_world(), self.view())
    }

    /// The picture that the fused pass read, as the adapter decodes it.
    pub fn loaded(&self) -> FloatImage {
        read_back::loaded_picture(self.render_world(), self.view()).expect("a copy")
    }

    /// The pictures that the fused pass read and wrote.
    pub fn pass(&self) -> (FloatImage, FloatImage) {
        let (before, after) =
            read_back::pictures(self.render_world(), self.view()).expect("a picture");
        (before.expect("a copy"), after)
    }
}

/// A material that has its color whatever the light.
pub fn unlit(color: Color) -> StandardMaterial {
    StandardMaterial {
        base_color: color,
        unlit: true,
        ..default()
    }
}

/// A pixel of a picture in linear light.
pub fn linear(picture: &image::RgbaImage, x: u32, y: u32) -> [f64; 3] {
    let [r, g, b, _] = picture.get_pixel(x, y).0;
    color::srgb_decode([r, g, b].map(|c| f64::from(c) / 255.0))
}

/// The sum of black ink on white over pixels of a picture: 1 for a pixel that is all ink.
pub fn black_ink(picture: &image::RgbaImage, pixels: impl Iterator<Item = (u32, u32)>) -> f64 {
    pixels.map(|(x, y)| 1.0 - linear(picture, x, y)[0]).sum()
}

/// The largest difference of two pictures, in codes.
pub fn apart(a: &image::RgbaImage, b: &image::RgbaImage) -> u8 {
    let pairs = a.as_raw().iter().zip(b.as_raw());
    pairs.map(|(a, b)| a.abs_diff(*b)).max().expect("pixels")
}

/// How many pixels of two pictures differ by more than some codes.
pub fn differ(a: &image::RgbaImage, b: &image::RgbaImage, codes: u8) -> usize {
    let is_far = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > codes)
    };
    a.pixels().zip(b.pixels()).filter(is_far).count()
}

/// The same as a fraction of the picture.
pub fn changed(a: &image::RgbaImage, b: &image::RgbaImage, codes: u8) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    differ(a, b, codes) as f64 / f64::from(a.width() * a.height())
}

/// Adds an effect to a style; `None` adds nothing.
pub fn with_option<E: Effect>(style: ComicStyle, effect: Option<E>) -> ComicStyle {
    match effect {
        Some(effect) => style.with(effect),
        None => style,
    }
}

/// A perspective projection with another matrix, made from the projection and a plane.
#[derive(Clone, Debug)]
pub struct Reshaped {
    pub projection: PerspectiveProjection,
    pub plane: Vec4,
    pub matrix: fn(&PerspectiveProjection, Vec4) -> Mat4,
}

impl CameraProjection for Reshaped {
    fn get_clip_from_view(&self) -> Mat4 {
        (self.matrix)(&self.projection, self.plane)
    }
    fn get_clip_from_view_for_sub(&self, _: &SubCameraView) -> Mat4 {
        self.get_clip_from_view()
    }
    fn update(&mut self, width: f32, height: f32) {
        self.projection.update(width, height);
    }
    fn far(&self) -> f32 {
        self.projection.far
    }
    fn get_frustum_corners(&self, near: f32, far: f32) -> [Vec3A; 8] {
        self.projection.get_frustum_corners(near, far)
    }
}

/// Marks the objects of the small scene.
#[derive(Component)]
pub struct Object;

pub fn spawn_objects(world: &mut World) {
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    let cube = meshes.add(Cuboid::default());
    let ground = meshes.add(Plane3d::default().mesh().size(9.0, 9.0));
    let turned = Quat::from_rotation_y(0.5);
    for (mesh, color, at) in [
        (
            &cube,
            Color::srgb(0.85, 0.2, 0.15),
            Transform::from_xyz(-0.6, 0.5, 1.2).with_rotation(turned),
        ),
        (
            &cube,
            Color::srgb(0.15, 0.6, 0.3),
            Transform::from_xyz(1.1, 0.9, -0.9).with_scale(Vec3::splat(1.6)),
        ),
        (
            &cube,
            Color::srgb(0.5, 0.5, 0.5),
            Transform::from_xyz(-1.9, 0.6, -2.6),
        ),
        (&ground, Color::srgb(0.8, 0.7, 0.5), Transform::IDENTITY),
    ] {
        let material = world
            .resource_mut::<Assets<StandardMaterial>>()
            .add(unlit(color));
        world.spawn((Object, Mesh3d(mesh.clone()), MeshMaterial3d(material), at));
    }
}
