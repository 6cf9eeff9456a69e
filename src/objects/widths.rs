//! The factor of the width of lines that comes from meshes: pressure, which is noise that is
//! anchored to objects, and the widths of vertices. It is drawn together with the object ids.

use bevy::{
    ecs::component::Component,
    render::{
        render_resource::{
            BindGroupLayoutEntry, ShaderStages, ShaderType, Texture, TextureFormat, TextureView,
        },
        texture::CachedTexture,
    },
};

use crate::gpu::{UNFILTERABLE, sampled};

/// Format of the texture of [`ViewLineWidths`].
pub(crate) const WIDTH_FORMAT: TextureFormat = TextureFormat::R8Unorm;

/// The largest factor that the texture stores.
pub(crate) const LARGEST_FACTOR: f32 = 2.0;

/// `Pressure` of `pressure.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pressure {
    /// By what fraction lines become wider or narrower at most.
    pub amount: f32,
    /// Length of the waves, in pixels of the viewport.
    pub wavelength: f32,
    unused_x: f32,
    unused_y: f32,
}

impl Pressure {
    pub fn new(amount: f32, wavelength: f32) -> Self {
        Self {
            amount,
            wavelength,
            ..Self::default()
        }
    }
}

/// On a view in the render world: the factor of the width of lines at each pixel, if lines
/// have [pressure](crate::lines::LineWeight::pressure) or some mesh has
/// [`LineWidths`](crate::objects::LineWidths).
///
/// The texture has the size and the number of samples of the depth texture. It can be another
/// texture in every frame.
#[derive(Component, Clone, Debug)]
pub struct ViewLineWidths {
    /// `R8Unorm`: 127 of 255 is the factor 1, also where no object is; 254 is 2, the largest
    /// factor.
    pub texture: Texture,
    pub(crate) view: TextureView,
}

impl From<CachedTexture> for ViewLineWidths {
    fn from(cached: CachedTexture) -> Self {
        Self {
            texture: cached.texture,
            view: cached.default_view,
        }
    }
}

/// The layout entry of the texture of factors.
pub(crate) fn widths_entry(multisampled: bool, stages: ShaderStages) -> BindGroupLayoutEntry {
    sampled(multisampled, UNFILTERABLE).build(9, stages)
}
