//! The player's input, from keyboard and gamepad.

use bevy::prelude::*;

/// What the player does in this frame.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Input {
    /// Right and up are positive; its length is at most 1.
    pub steer: Vec2,
    pub boost: bool,
    pub slow: bool,
    /// This field and those below are true only in the frame in which the button was
    /// pressed.
    pub confirm: bool,
    pub pause: bool,
    pub photo: bool,
    pub restart: bool,
    pub quit: bool,
    /// The next level (1) or the one before (-1).
    pub choose: i32,
}

pub struct InputPlugin;

impl Plugin for InputPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Input>().add_systems(PreUpdate, read);
    }
}

/// Shorter deflections of a stick are ignored: sticks do not rest exactly in the middle.
const DEAD_ZONE: f32 = 0.15;

fn read(keys: Res<ButtonInput<KeyCode>>, pads: Query<&Gamepad>, mut input: ResMut<Input>) {
    let held = |codes: &[KeyCode]| keys.any_pressed(codes.iter().copied());
    let pressed = |codes: &[KeyCode]| keys.any_just_pressed(codes.iter().copied());
    let axis = |plus: &[KeyCode], minus: &[KeyCode]| {
        f32::from(i8::from(held(plus)) - i8::from(held(minus)))
    };
    let mut now = Input {
        steer: Vec2::new(
            axis(
                &[KeyCode::ArrowRight, KeyCode::KeyD],
                &[KeyCode::ArrowLeft, KeyCode::KeyA],
            ),
            axis(
                &[KeyCode::ArrowUp, KeyCode::KeyW],
                &[KeyCode::ArrowDown, KeyCode::KeyS],
            ),
        ),
        boost: held(&[KeyCode::Space]),
        slow: held(&[KeyCode::ShiftLeft, KeyCode::ShiftRight]),
        confirm: pressed(&[KeyCode::Enter, KeyCode::Space]),
        pause: pressed(&[KeyCode::Escape, KeyCode::KeyP]),
        photo: pressed(&[KeyCode::KeyF]),
        restart: pressed(&[KeyCode::KeyR]),
        quit: pressed(&[KeyCode::KeyQ]),
        choose: i32::from(pressed(&[KeyCode::ArrowRight, KeyCode::KeyD]))
            - i32::from(pressed(&[KeyCode::ArrowLeft, KeyCode::KeyA])),
    };
    for pad in &pads {
        let stick = pad.left_stick();
        if stick.length() > DEAD_ZONE {
            now.steer += stick;
        }
        now.boost |= pad.pressed(GamepadButton::RightTrigger2) || pad.pressed(GamepadButton::South);
        now.slow |= pad.pressed(GamepadButton::LeftTrigger2) || pad.pressed(GamepadButton::West);
        now.confirm |= pad.just_pressed(GamepadButton::South);
        now.pause |= pad.just_pressed(GamepadButton::Start);
        now.photo |= pad.just_pressed(GamepadButton::North);
        now.restart |= pad.just_pressed(GamepadButton::Select);
        now.quit |= pad.just_pressed(GamepadButton::East);
        now.choose += i32::from(pad.just_pressed(GamepadButton::DPadRight))
            - i32::from(pad.just_pressed(GamepadButton::DPadLeft));
    }
    now.steer = now.steer.clamp_length_max(1.0);
    *input = now;
}
