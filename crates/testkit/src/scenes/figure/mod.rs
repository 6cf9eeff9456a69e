//! A character in close-up, who waves: face, eyes, hair, a hand, and cloth. A game shows these most
//! of all.

mod body;
mod clay;
mod face;
mod hair;
pub mod motion;
mod shading;

use bevy::{light::NotShadowCaster, prelude::*};
use bevy_comics::{OutlineGroup, objects::MeshSections, toon::MaterialName};

use super::{
    ScenePart, Stage, ToonPart, Vantage, shadows_within, shape::Shape, sky::Sky, sunlight,
};
use motion::{Lids, Sway};

/// The materials: name, sRGB code, perceptual roughness.
const MATERIALS: [(&str, u32, f32); 16] = [
    ("face", 0xffd2ae, 0.75),
    ("skin", 0xffd2ae, 0.75),
    ("hair", 0x7580b6, 0.5),
    ("eye", 0xfbf7f0, 0.9),
    ("iris", 0x2f9a8c, 0.3),
    ("iris shade", 0x17605e, 0.9),
    ("ink", 0x231a2c, 0.9),
    ("light", 0xffffff, 0.9),
    ("brow", 0x333a66, 0.9),
    ("blush", 0xf7a592, 0.9),
    ("mouth", 0x8a2c38, 0.9),
    ("tongue", 0xe5787b, 0.9),
    ("scarf", 0xd8463c, 0.9),
    ("coat", 0xe8b552, 0.85),
    ("button", 0x7a4a34, 0.85),
    ("cuff", 0xf6ead0, 0.9),
];

/// What is spawned, part by part.
struct Workshop<'a, 'w, 's> {
    stage: &'a mut Stage<'w, 's>,
    materials: Vec<Handle<StandardMaterial>>,
}

impl<'a, 'w, 's> Workshop<'a, 'w, 's> {
    fn new(stage: &'a mut Stage<'w, 's>) -> Self {
        let material = |(name, color, roughness): (&str, u32, f32)| {
            let [_, r, g, b] = color.to_be_bytes();
            stage.materials.add(StandardMaterial {
                base_color: Color::srgb_u8(r, g, b),
                perceptual_roughness: roughness,
                unlit: name == "light",
                ..default()
            })
        };
        let materials = MATERIALS.into_iter().map(material).collect();
        Self { stage, materials }
    }

    /// An entity that turns, with its origin at a point of its parent.
    fn joint(&mut self, parent: Entity, sway: Sway) -> Entity {
        let bundle = (sway.at(0.0), sway, Visibility::default(), ChildOf(parent));
        self.stage.commands.spawn(bundle).id()
    }

    /// A mesh below an entity, with its origin there.
    fn put(&mut self, parent: Entity, material: &'static str, shape: Shape) -> Entity {
        let known = MATERIALS.iter().position(|(name, ..)| *name == material);
        let handle = self.materials[known.expect("a material of the figure")].clone();
        let mesh = self.stage.meshes.add(shape.into_mesh());
        let part = (Mesh3d(mesh), MeshMaterial3d(handle), ChildOf(parent));
        self.stage
            .commands
            .spawn((part, MaterialName::from(material)))
            .id()
    }

    /// What is painted onto a surface. It casts no shadows on it.
    fn paint(&mut self, surface: Entity, paint: face::Paint, lids: Option<Lids>) {
        let painted = self.put(surface, paint.name, paint.shape);
        let mut painted = self.stage.commands.entity(painted);
        painted.insert(NotShadowCaster);
        if paint.name == "blush" {
            // A flush has no outline.
            painted.insert(MeshSections::NONE);
        }
        match lids {
            Some(Lids::Closed) => painted.insert((Lids::Closed, Visibility::Hidden)),
            Some(lids) => painted.insert(lids),
            None => &mut painted,
        };
    }
}

fn head(shop: &mut Workshop, figure: Entity) {
    // It turns about the neck.
    let neck = Vec3::new(0.0, -1.0, -0.2);
    let rest = Transform::from_translation(neck);
    let turned = shop.joint(figure, Sway::new(rest, Vec3::Y, 0.09, 5.0, 0.0));
    let tilt = Transform::from_translation(-neck);
    let tilt = Transform::from_rotation(Quat::from_rotation_z(-0.09)) * tilt;
    let tilted = (tilt, Visibility::default(), ChildOf(turned));
    let head = shop.stage.commands.spawn(tilted).id();

    let skin = shop.put(head, "face", face::head());
    // Face and paint are one object: no lines between them.
    shop.stage.commands.entity(skin).insert(OutlineGroup);
    for paint in face::features() {
        shop.paint(skin, paint, None);
    }
    for paint in face::eyes() {
        shop.paint(skin, paint, Some(Lids::Open));
    }
    shop.paint(skin, face::closed_eyes(), Some(Lids::Closed));

    for shape in [hair::cap(), hair::back(), hair::fringe()] {
        shop.put(head, "hair", shape);
    }
    for (side, phase) in [(-1.0, 0.1), (1.0, 0.0)] {
        let (root, shape) = hair::side_lock(side);
        let rest = Transform::from_translation(root);
        let lock = shop.joint(head, Sway::new(rest, Vec3::Z, 0.05, 2.6, phase));
        shop.put(lock, "hair", shape);
    }
    let (root, shape) = hair::cowlick();
    let rest = Transform::from_translation(root);
    let lock = shop.joint(head, Sway::new(rest, Vec3::Z, 0.14, 1.7, 0.0));
    shop.put(lock, "hair", shape);
}

fn body(shop: &mut Workshop, figure: Entity) {
    let coat = shop.put(figure, "coat", body::coat());
    shop.put(coat, "coat", body::placket());
    shop.put(coat, "button", body::buttons());
    shop.put(figure, "scarf", body::scarf());
    let rest = Transform::from_translation(body::KNOT);
    let tail = shop.joint(
        figure,
        Sway::new(rest, Vec3::new(0.0, 0.6, 1.0), 0.1, 1.9, 0.0),
    );
    shop.put(tail, "scarf", body::tail());
    shop.put(tail, "cuff", body::bands());

    let rest = Transform::from_translation(body::ELBOW);
    let arm = shop.joint(figure, Sway::new(rest, Vec3::Z, 0.1, 1.5, 0.0));
    shop.put(arm, "coat", body::sleeve());
    shop.put(arm, "cuff", body::cuff());
    let turn = Quat::from_rotation_z(-0.06) * Quat::from_rotation_y(-0.12);
    let rest = Transform::from_translation(body::WRIST - body::ELBOW).with_rotation(turn);
    let hand = shop.joint(arm, Sway::new(rest, Vec3::Z, 0.16, 1.5, 0.9));
    let hand = shop.put(hand, "skin", body::hand());
    // Its shadow on the coat would look like a stain.
    shop.stage.commands.entity(hand).insert(NotShadowCaster);
}

/// Hills far behind the figure.
fn hills(shop: &mut Workshop) {
    let mut hills = Shape::default();
    for (x, y, z, radius, color) in [
        (-26.0, -17.0, -46.0, 19.0, 0x8fbf8a),
        (20.0, -24.0, -52.0, 27.0, 0x84b58d),
        (-7.0, -30.0, -34.0, 28.0, 0xa4cb7c),
    ] {
        let size = Vec3::new(1.5, 1.0, 1.0) * radius;
        let at = Vec3::new(x, y, z);
        hills.ellipsoid(at, size, 48, color);
    }
    let matt = shop.stage.matt();
    let mesh = shop.stage.meshes.add(hills.into_mesh());
    shop.stage.solid(mesh, matt, Transform::IDENTITY);
}

pub fn spawn(stage: &mut Stage) -> Vantage {
    let sun = Vec3::new(-0.6, 0.75, 0.85);
    let sky = Sky {
        zenith: 0x5f9bd1,
        middle: 0xa9d4ea,
        horizon: 0xf7efd8,
        ground: 0xa8c48a,
        cloud: 0xffffff,
        cover: 0.46,
        sun,
    };
    let mut shop = Workshop::new(stage);
    let rest = Transform::from_rotation(Quat::from_rotation_y(0.12));
    let figure = (ScenePart, rest, Visibility::default(), Name::new("figure"));
    let figure = shop.stage.commands.spawn(figure).id();
    head(&mut shop, figure);
    body(&mut shop, figure);
    hills(&mut shop);
    if let Some(styles) = &mut stage.looks {
        let toon = ToonPart(shading::scene(styles));
        stage.commands.entity(figure).insert(toon);
    }

    let shadows = shadows_within(11.0);
    let light = sunlight(sun, 3000.0, [1.0, 0.96, 0.88], shadows);
    stage.commands.spawn(light);
    stage.ambient([0.82, 0.86, 1.0], 480.0);

    Vantage {
        eye: Vec3::new(0.2, -0.2, 7.75),
        target: Vec3::new(0.2, -0.27, 0.0),
        fov: 27f32.to_radians(),
        ortho: (Vec3::new(2.5, 1.0, 8.0), Vec3::new(0.2, -0.45, 0.0)),
        ortho_height: 3.8,
        ..stage.under(&sky)
    }
}
