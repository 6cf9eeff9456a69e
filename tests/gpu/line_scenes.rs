//! Short forms for the scenes of which lines are measured.

use bevy_comics_testkit::read_back;
use image::RgbaImage;

use crate::prelude::*;

impl Small {
    /// An object of the scene, to be changed.
    pub fn on(&mut self, object: Entity) -> EntityWorldMut<'_> {
        self.world().entity_mut(object)
    }

    /// The picture in a style that has no effect but these outlines.
    pub fn outlined(&mut self, outlines: Outlines) -> RgbaImage {
        self.shot(&ComicStyle::new().with(outlines))
    }

    /// Starts over with an empty perspective view along -z. It is 90 degrees high: at a distance of
    /// half of the height of the picture, a unit is a pixel.
    pub fn empty_view(&mut self, msaa: Msaa, sky: Color) {
        self.restart(msaa);
        self.clear();
        let fov = std::f32::consts::FRAC_PI_2;
        let projection = PerspectiveProjection { fov, ..default() };
        self.insert((Transform::IDENTITY, Projection::Perspective(projection)));
        self.camera_settings().clear_color = sky.into();
    }

    /// The pictures of the next frames.
    pub fn film(&mut self, frames: usize) -> Vec<RgbaImage> {
        let frames = (0..frames).map(|_| {
            self.headless.step(1);
            self.picture()
        });
        frames.collect()
    }

    /// Says that the camera has moved to another place.
    pub fn cut(&mut self) {
        let entity = self.camera;
        self.world().trigger(CameraCut { entity });
    }

    pub fn camera_settings(&mut self) -> Mut<'_, Camera> {
        let camera = self.camera;
        self.world().get_mut(camera).expect("a camera")
    }

    /// Draws to a part of the target: x, y, width, height.
    pub fn see_in(&mut self, [x, y, width, height]: [u32; 4]) {
        self.camera_settings().viewport = Some(Viewport {
            physical_position: UVec2::new(x, y),
            physical_size: UVec2::new(width, height),
            ..default()
        });
    }

    /// Whether the camera has a component.
    pub fn has<C: Component>(&self) -> bool {
        let world = self.headless.app.world();
        world.entity(self.camera).contains::<C>()
    }

    /// The object id of every pixel.
    pub fn ids(&self) -> Vec<u32> {
        let ids = self.object_ids().expect("drawn").pixels;
        ids.into_iter().map(|[id, _]| id).collect()
    }

    /// The id of an object that some view shows.
    pub fn id_of(&self, object: Entity) -> u32 {
        read_back::id_of(self.render_world(), object)
    }

    /// The number of pixels that show an object.
    pub fn pixels_of(&self, object: Entity) -> usize {
        let ids = self.ids().into_iter();
        let own = self.id_of(object);
        ids.filter(|id| *id == own && own != 0).count()
    }

    pub fn outcome(&self, stage: ComicsStage) -> Option<StageOutcome> {
        let world = self.headless.app.world();
        let diagnostics = world.resource::<ComicsDiagnostics>();
        diagnostics.cameras.get(&self.camera)?.outcome(stage)
    }
}

/// How often a picture is shown in a row, and the next one, and so on.
pub fn runs(film: &[RgbaImage]) -> Vec<usize> {
    let runs = film.chunk_by(|a, b| a == b);
    runs.map(<[RgbaImage]>::len).collect()
}

/// Silhouettes of one width, and no other lines.
pub fn silhouettes(width: f32) -> Outlines {
    Outlines {
        width,
        ..Outlines::SILHOUETTES
    }
}

/// Turned about the axis of the view.
pub fn turned(x: f32, y: f32, z: f32, angle: f32) -> Transform {
    Transform::from_xyz(x, y, z).with_rotation(Quat::from_rotation_z(angle))
}

/// What draws in a part of the target.
pub fn viewport(at: UVec2, size: UVec2) -> Camera {
    Camera {
        viewport: Some(Viewport {
            physical_position: at,
            physical_size: size,
            ..default()
        }),
        ..default()
    }
}

/// Whether two colors are equal within a code of the picture.
pub fn alike(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.006)
}

pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub fn deviation(values: &[f64]) -> f64 {
    let middle = mean(values);
    let squares: Vec<f64> = values.iter().map(|v| (v - middle).powi(2)).collect();
    mean(&squares).sqrt()
}

/// A mesh whose vertices follow one of some joints each, and its skin.
pub fn skinned(
    small: &mut Small,
    mut mesh: Mesh,
    joints: &[Entity],
    joint_of: impl Fn(usize) -> u16,
) -> (Mesh3d, SkinnedMesh) {
    let count = mesh.count_vertices();
    let indices = (0..count).map(|vertex| [joint_of(vertex), 0, 0, 0]);
    let indices = VertexAttributeValues::Uint16x4(indices.collect());
    mesh.insert_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, indices);
    let weights = vec![[1.0, 0.0, 0.0, 0.0]; count];
    mesh.insert_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights);
    let world = small.world();
    let poses = SkinnedMeshInverseBindposes::from(vec![Mat4::IDENTITY; joints.len()]);
    let skin = SkinnedMesh {
        inverse_bindposes: world.resource_mut::<Assets<_>>().add(poses),
        joints: joints.to_vec(),
    };
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    (Mesh3d(mesh), skin)
}
