//! References of the modules of `toon/` that say what a surface reflects of the lights. Those of its
//! pure functions lie beside this folder.

pub mod ambient;
pub mod brightest;
pub mod lamp_shadow;
pub mod light_fraction;
pub mod light_textures;
pub mod lights;
pub mod per_light;
pub mod ramp_light;
pub mod reflect;
pub mod rim;
pub mod rim_light;
pub mod specular;
pub mod stylized_highlight_light;
pub mod surface;
pub mod two_shades;
