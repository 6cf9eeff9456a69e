//! What passes draw and read instead of pictures: means over boxes, and pictures with numbers.

use bevy::{render::render_resource::TextureFormat, shader::ShaderDefVal};

use crate::fused::compose::{aux_scalar_of, boxes_of};

/// Linear light, multiplied by the opacity, and the opacity.
pub(crate) const PASS_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
/// As `box_statistics.wgsl` and `aux_scalar.wgsl` pack them.
pub(crate) const PACKED_FORMAT: TextureFormat = TextureFormat::Rgba32Uint;

/// What a pass draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Drawn {
    /// The picture, for the view or for the next pass.
    #[default]
    Picture,
    /// The picture with the numbers of this effect, for the next pass.
    WithScalar(&'static str),
    /// Means of the rows of a picture.
    Across(Boxes),
    /// Means of boxes, from those of rows.
    Down(Boxes),
}

/// What the effects of a pass read besides their own pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Read {
    /// Nothing, or the picture before the pass.
    #[default]
    Picture,
    /// The picture with numbers.
    WithScalar,
    /// Means over boxes, and the picture.
    Means,
}

/// The boxes that means are drawn of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Boxes {
    pub effect: &'static str,
    /// How many pixels they reach from their middle at most, if that is compiled in.
    pub reach: Option<u32>,
}

/// The shader definitions of boxes that may reach so many pixels.
const REACHES: [&str; 6] = [
    "REACHES_ONE",
    "REACHES_TWO",
    "REACHES_THREE",
    "REACHES_FOUR",
    "REACHES_FIVE",
    "REACHES_SIX",
];

impl Read {
    /// The binding of the texture besides the picture.
    pub fn binding(self) -> Option<u32> {
        match self {
            Self::Picture => None,
            Self::Means => Some(12),
            Self::WithScalar => Some(13),
        }
    }

    pub fn shader_def(self) -> Option<ShaderDefVal> {
        match self {
            Self::Picture => None,
            Self::Means => Some("BOX_STATISTICS".into()),
            Self::WithScalar => Some("AUX_SCALAR".into()),
        }
    }
}

impl Drawn {
    /// The entry point of the pass.
    pub fn entry_point(self) -> &'static str {
        match self {
            Self::Picture => "stylize",
            Self::WithScalar(_) => "with_scalar",
            Self::Across(_) | Self::Down(_) => "means",
        }
    }

    pub fn shader_defs(self) -> Vec<ShaderDefVal> {
        match self {
            Self::Picture => vec![],
            Self::WithScalar(effect) => {
                vec!["DRAWS_AUX_SCALAR".into(), aux_scalar_of(effect).into()]
            }
            Self::Across(boxes) => boxes.shader_defs(),
            Self::Down(boxes) => {
                let mut defs = boxes.shader_defs();
                defs.push("BOX_STATISTICS_DOWN".into());
                defs
            }
        }
    }
}

impl Boxes {
    fn shader_defs(self) -> Vec<ShaderDefVal> {
        let mut defs = vec!["DRAWS_BOX_STATISTICS".into(), boxes_of(self.effect).into()];
        if let Some(steps) = self.reach.and_then(|reach| REACHES.get(..reach as usize)) {
            defs.push("BOX_REACH".into());
            defs.extend(steps.iter().map(|name| ShaderDefVal::from(*name)));
        }
        defs
    }
}
