//! Shared by the examples and the tests: scenes made by code, and an app that renders
//! without a window.
#![allow(dead_code, reason = "every example and test uses its own part of this")]

pub mod bench;
pub mod headless;
pub mod read_back;
pub mod scenes;
pub mod studio;
pub mod truth;
pub mod work;
