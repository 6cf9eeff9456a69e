//! The built-in scenes, made by code. Each has lights, a sky and a vantage for the
//! camera.

pub mod buildings;
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
    camera::ScalingMode, core_pipeline::tonemapping::Tonemapping, ecs::system::SystemParam,
    light::Skybox, prelude::*,
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

    /// Those that the report measures.
    pub const MEASURED: [Self; 4] = [Self::Mountains, Self::Teapot, Self::Theatre, Self::Village];

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

    /// A rough material that leaves the colour to the vertices.
    pub fn matt(&mut self) -> Handle<StandardMaterial> {
        self.materials.add(StandardMaterial {
            perceptual_roughness: 0.95,
            reflectance: 0.15,
            ..default()
        })
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
