//! References of the modules of `toon/` that say what a surface reflects of the lights. Those of
//! its pure functions lie beside this folder.

pub mod light_shadow;
pub mod reflected;
pub mod tones;
