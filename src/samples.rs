//! Definitions of shaders that read multisampled textures.

use bevy::shader::ShaderDefVal;

/// `MULTISAMPLED` and the number `SAMPLES`, if there are several samples. A shader could ask the
/// texture for their number, but not in OpenGL ES.
pub(crate) fn definitions(samples: u32) -> impl Iterator<Item = ShaderDefVal> {
    let number = ShaderDefVal::UInt("SAMPLES".into(), samples);
    (samples > 1)
        .then(|| ["MULTISAMPLED".into(), number])
        .into_iter()
        .flatten()
}
