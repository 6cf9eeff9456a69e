//! Split screen: two players in one scene, each with a camera and a look of their own.

use std::process::ExitCode;

use bevy::{camera::Viewport, prelude::*, render::view::Msaa};
use bevy_comics::{Outlines, ToonScene, presets};
use bevy_comics_testkit::{
    demo::{Demo, Screen},
    scenes::{BuiltIn, ScenePart, Stage},
    studio::set_style,
};

/// 0 is the left player, 1 the right one.
#[derive(Component)]
struct Player(u32);

/// Where the players stand, and what they look at.
const VIEWS: [(Vec3, Vec3); 2] = [
    (Vec3::new(1.4, 2.2, 11.0), Vec3::new(-1.2, 3.6, -8.0)),
    (Vec3::new(-2.6, 5.4, 3.0), Vec3::new(2.2, 2.6, -12.0)),
];

fn spawn(mut stage: Stage, screen: Res<Screen>) {
    let vantage = stage.spawn(BuiltIn::Street);
    let looks = [
        presets::COBALT_NIGHT.style().with(Outlines::default()),
        presets::COPPER_AND_TEAL.style(),
    ];
    for (player, look) in (0..).zip(&looks) {
        let camera = Camera {
            order: player as isize,
            ..default()
        };
        let mut view = stage.commands.spawn(vantage.camera());
        view.insert((Player(player), camera, screen.target.clone(), Msaa::Sample4));
        set_style(&mut view, look);
    }
}

fn flatten(mut commands: Commands, parts: Query<Entity, (With<ScenePart>, Without<ChildOf>)>) {
    for part in &parts {
        commands.entity(part).insert(ToonScene::default());
    }
}

/// Left and right half of the window, with a gutter between them, whatever its size.
fn fit(mut cameras: Query<(&Player, &mut Camera)>) {
    for (player, mut camera) in &mut cameras {
        let Some(size) = camera.physical_target_size() else {
            continue;
        };
        let gutter = size.x / 160;
        let half = UVec2::new((size.x - gutter) / 2, size.y).max(UVec2::ONE);
        let corner = UVec2::new(player.0 * (half.x + gutter), 0);
        let fits = camera
            .viewport
            .as_ref()
            .is_some_and(|now| now.physical_size == half && now.physical_position == corner);
        if !fits {
            camera.viewport = Some(Viewport {
                physical_position: corner,
                physical_size: half,
                ..default()
            });
        }
    }
}

/// W and S move the left player, the arrow keys the right one; A, D, left and right turn.
fn steer(
    keys: Res<ButtonInput<KeyCode>>,
    time: Res<Time>,
    mut players: Query<(&Player, &mut Transform)>,
) {
    const KEYS: [[KeyCode; 4]; 2] = [
        [KeyCode::KeyW, KeyCode::KeyS, KeyCode::KeyA, KeyCode::KeyD],
        [
            KeyCode::ArrowUp,
            KeyCode::ArrowDown,
            KeyCode::ArrowLeft,
            KeyCode::ArrowRight,
        ],
    ];
    for (player, mut view) in &mut players {
        let [ahead, back, left, right] = KEYS[player.0 as usize].map(|key| keys.pressed(key));
        let axis = |plus: bool, minus: bool| f32::from(i8::from(plus) - i8::from(minus));
        let step = view.forward() * axis(ahead, back) * 4.0 * time.delta_secs();
        view.translation += Vec3::new(step.x, 0.0, step.z);
        view.rotate_y(axis(left, right) * time.delta_secs());
    }
}

fn place(mut players: Query<(&Player, &mut Transform)>) {
    for (player, mut view) in &mut players {
        let (eye, target) = VIEWS[player.0 as usize];
        *view = Transform::from_translation(eye).looking_at(target, Vec3::Y);
    }
}

fn main() -> ExitCode {
    let demo = Demo {
        title: "Split screen",
        keys: "Left player: W, S, A, D. Right player: the arrow keys.",
        size: UVec2::new(1200, 480),
        frames: 5,
    };
    demo.run(|app| {
        app.insert_resource(ClearColor(Color::WHITE))
            .add_systems(Startup, (spawn, flatten, place).chain())
            .add_systems(Update, (fit, steer));
    })
}
