//! The uniform of the passes that find and draw lines: `pass.wgsl`.

use bevy::{
    math::{IVec2, IVec4, Vec4},
    render::render_resource::ShaderType,
};

use super::{
    abstraction::LineAbstractionUniform, boil::BoilUniform, focus::LineFocusUniform,
    fog::FogUniform, layer_lines::LineLayersUniform, memory::MemoryUniform, settings::LinesUniform,
    sheet::SheetUniform, weight::WeightUniform,
};
use crate::depth::view::ViewUniform;

/// `Grid` of `edge.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub(crate) struct Grid {
    pub rect: IVec4,
    pub from_viewport: Vec4,
    pub reach: i32,
    pub inked: i32,
    pub jump_least: f32,
    pub jump_radius: f32,
    pub words: IVec2,
    pub steps: i32,
    pub specks: i32,
    pub bridge: i32,
    pub persistence: i32,
    pub overshoot: f32,
    pub unused: i32,
}

/// The uniform of the passes that find and draw lines.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub(crate) struct LinePassUniform {
    pub view: ViewUniform,
    pub lines: LinesUniform,
    pub grid: Grid,
    pub weight: WeightUniform,
    pub fog: FogUniform,
    pub focus: LineFocusUniform,
    pub layers: LineLayersUniform,
    pub abstraction: LineAbstractionUniform,
    pub boil: BoilUniform,
    pub memory: MemoryUniform,
    pub sheet: SheetUniform,
}
