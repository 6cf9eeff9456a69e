//! What strokes on surfaces look like: for the effect `Hatching` and the toon material.

use bevy::{
    math::{Mat3, Vec3},
    render::render_resource::ShaderType,
};

/// `Strokes` in `strokes.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Strokes {
    pub(crate) axes: Mat3,
    pub(crate) ink: Vec3,
    pub(crate) opacity: f32,
    pub(crate) paper: Vec3,
    pub(crate) spacing: f32,
    pub(crate) length: f32,
    pub(crate) layers: u32,
    pub(crate) layer_darkness: f32,
    pub(crate) shadows: f32,
    pub(crate) highlights: f32,
    pub(crate) gamma: f32,
    pub(crate) levels: f32,
    pub(crate) breaks: f32,
    pub(crate) wobble: f32,
    pub(crate) pressure: f32,
    pub(crate) seed: u32,
    pub(crate) ground: u32,
}
