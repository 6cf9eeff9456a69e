//! The built-in scenes, made by code. Each has lights, a sky and a vantage for the
//! camera.

pub mod buildings;
pub mod environment;
pub mod figure;
pub mod hall;
pub mod lights;
pub mod mountains;
pub mod noise;
pub mod paper_plane;
pub mod shape;
pub mod sky;
pub mod street;
pub mod teapot;
pub mod theatre;
pub mod village;

use bevy::{
    camera::ScalingMode,
    core_pipeline::tonemapping::Tonemapping,
    ecs::system::SystemParam,
    light::{CascadeShadowConfigBuilder, Skybox},
    prelude::*,
};
use bevy_comics::{ToonScene, toon::ToonShading};

/// The built-in scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BuiltIn {
    Mountains,
    Teapot,
    Theatre,
    Village,
    Figure,
    Street,
    Hall,
}

impl BuiltIn {
    pub const ALL: [Self; 7] = [
        Self::Mountains,
        Self::Teapot,
        Self::Theatre,
        Self::Village,
        Self::Figure,
        Self::Street,
        Self::Hall,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Mountains => "mountains",
            Self::Teapot => "teapot",
            Self::Theatre => "theatre",
            Self::Village => "village",
            Self::Figure => "figure",
            Self::Street => "street",
            Self::Hall => "hall",
        }
    }

    /// Whether the scene is made for the toon material.
    pub fn is_toon(self) -> bool {
        matches!(self, Self::Theatre | Self::Figure)
    }

    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scene| scene.name() == name)
    }
}

/// The camera of a scene.
#[derive(Clone, Debug)]
pub struct Vantage {
    pub eye: Vec3,
    pub target: Vec3,
    /// Vertical field of view, radians.
    pub fov: f32,
    pub near: f32,
    pub far: f32,
    /// Position and target of the orthographic view.
    pub ortho: (Vec3, Vec3),
    /// Height of the orthographic view, world units.
    pub ortho_height: f32,
    pub sky: Handle<Image>,
    pub sky_brightness: f32,
}

/// What builds a scene.
#[derive(SystemParam)]
pub struct Stage<'w, 's> {
    pub commands: Commands<'w, 's>,
    pub meshes: ResMut<'w, Assets<Mesh>>,
    pub materials: ResMut<'w, Assets<StandardMaterial>>,
    pub images: ResMut<'w, Assets<Image>>,
    pub looks: Option<ResMut<'w, Assets<ToonShading>>>,
}

/// Marks all entities of the current scene: despawn them to remove it.
#[derive(Component, Clone, Copy, Default)]
pub struct ScenePart;

/// How a part is drawn with the toon material. Parts without it have the default look.
#[derive(Component, Clone, Default)]
pub struct ToonPart(pub ToonScene);

impl Stage<'_, '_> {
    pub fn spawn(&mut self, scene: BuiltIn) -> Vantage {
        match scene {
            BuiltIn::Mountains => mountains::spawn(self),
            BuiltIn::Teapot => teapot::spawn(self),
            BuiltIn::Theatre => theatre::spawn(self),
            BuiltIn::Village => village::spawn(self),
            BuiltIn::Figure => figure::spawn(self),
            BuiltIn::Street => street::spawn(self),
            BuiltIn::Hall => hall::spawn(self),
        }
    }

    /// Spawns a mesh as a part of the scene.
    pub fn solid(&mut self, mesh: Handle<Mesh>, material: Handle<StandardMaterial>, at: Transform) {
        self.commands
            .spawn((ScenePart, Mesh3d(mesh), MeshMaterial3d(material), at));
    }

    /// Spawns a shape where it is as a part of the scene.
    pub fn shape(&mut self, shape: shape::Shape, material: &Handle<StandardMaterial>) {
        let mesh = self.meshes.add(shape.into_mesh());
        self.solid(mesh, material.clone(), Transform::IDENTITY);
    }

    /// Light from all around.
    pub fn ambient(&mut self, [r, g, b]: [f32; 3], brightness: f32) {
        self.commands.insert_resource(GlobalAmbientLight {
            color: Color::srgb(r, g, b),
            brightness,
            ..default()
        });
    }

    /// A vantage under a sky, whose camera is still to be placed.
    fn under(&mut self, sky: &sky::Sky) -> Vantage {
        Vantage {
            eye: Vec3::ZERO,
            target: Vec3::ZERO,
            fov: 0.0,
            near: 0.1,
            far: 1000.0,
            ortho: (Vec3::ZERO, Vec3::ZERO),
            ortho_height: 0.0,
            sky: self.images.add(sky.image()),
            sky_brightness: 1000.0,
        }
    }

    /// A rough material that leaves the color to the vertices.
    pub fn matt(&mut self) -> Handle<StandardMaterial> {
        self.materials.add(StandardMaterial {
            perceptual_roughness: 0.95,
            reflectance: 0.15,
            ..default()
        })
    }
}

/// A lamp, with shadow maps or without.
pub fn lamplight(
    at: Vec3,
    intensity: f32,
    color: Color,
    range: f32,
    shadow_maps_enabled: bool,
) -> impl Bundle {
    let light = PointLight {
        intensity,
        color,
        range,
        shadow_maps_enabled,
        ..default()
    };
    (ScenePart, light, Transform::from_translation(at))
}

/// Light with shadows that comes from a direction, such as that of the sun. `shadows`: their
/// cascades.
pub fn sunlight(
    from: Vec3,
    illuminance: f32,
    [r, g, b]: [f32; 3],
    shadows: CascadeShadowConfigBuilder,
) -> impl Bundle {
    let light = DirectionalLight {
        illuminance,
        color: Color::srgb(r, g, b),
        shadow_maps_enabled: true,
        ..default()
    };
    let at = Transform::from_translation(from).looking_at(Vec3::ZERO, Vec3::Y);
    (ScenePart, light, at, shadows.build())
}

/// One cascade of shadows.
fn shadows_within(maximum_distance: f32) -> CascadeShadowConfigBuilder {
    CascadeShadowConfigBuilder {
        num_cascades: 1,
        maximum_distance,
        ..default()
    }
}

/// Several cascades of shadows, from where the first one ends.
fn shadow_cascades(num_cascades: usize, first: f32, reach: f32) -> CascadeShadowConfigBuilder {
    CascadeShadowConfigBuilder {
        num_cascades,
        first_cascade_far_bound: first,
        maximum_distance: reach,
        ..default()
    }
}

impl Vantage {
    pub fn transform(&self) -> Transform {
        Transform::from_translation(self.eye).looking_at(self.target, Vec3::Y)
    }

    pub fn perspective(&self) -> Projection {
        Projection::Perspective(PerspectiveProjection {
            fov: self.fov,
            near: self.near,
            far: self.far,
            ..default()
        })
    }

    pub fn orthographic(&self, height: f32) -> Projection {
        Projection::Orthographic(OrthographicProjection {
            near: 0.0,
            far: self.far,
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: height,
            },
            ..OrthographicProjection::default_3d()
        })
    }

    /// The same scene from the place of the orthographic view.
    pub fn orthographic_vantage(&self) -> Self {
        Self {
            eye: self.ortho.0,
            target: self.ortho.1,
            ..self.clone()
        }
    }

    /// The camera of this view, without a style.
    pub fn camera(&self) -> impl Bundle {
        (
            Camera3d::default(),
            self.transform(),
            self.perspective(),
            Tonemapping::AcesFitted,
            Skybox {
                image: Some(self.sky.clone()),
                brightness: self.sky_brightness,
                ..default()
            },
        )
    }
}
