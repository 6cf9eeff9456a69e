//! The uniform of the passes that find and draw lines: `pass.wgsl`.

use bevy::render::render_resource::ShaderType;

use super::{grid::Grid, history::HistoryUniform};
use crate::{
    depth::view::ViewUniform,
    lines::{
        modifiers::{LineFadeUniform, LineLayersUniform, LineSimplificationUniform, SheetUniform},
        settings::{BoilUniform, FogUniform, LinesUniform, WeightUniform},
    },
};

/// The uniform of the passes that find and draw lines.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub(crate) struct LinePassUniform {
    pub view: ViewUniform,
    pub lines: LinesUniform,
    pub grid: Grid,
    pub weight: WeightUniform,
    pub fog: FogUniform,
    pub fade: LineFadeUniform,
    pub layers: LineLayersUniform,
    pub simplification: LineSimplificationUniform,
    pub boil: BoilUniform,
    pub history: HistoryUniform,
    pub sheet: SheetUniform,
}
