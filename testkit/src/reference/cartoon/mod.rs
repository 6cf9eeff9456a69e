//! Twins of the modules of `cartoon/` that say what a surface reflects of the lights. Those of its
//! pure functions lie beside this folder.

pub mod brightest;
pub mod glint_light;
pub mod lamp_shadow;
pub mod lamps;
pub mod light_textures;
pub mod per_light;
pub mod ramp_light;
pub mod reflect;
pub mod rim_light;
pub mod share;
pub mod shine;
pub mod surface;
pub mod two_shades;
