//! A comic page: five cameras draw four places in five styles, each into the image of a panel.
//! Panels, captions and speech balloons are `bevy_ui`.
//!
//! `cargo run --example comic_page -- --out page.png` saves the page without a window.

mod page;
mod places;

use std::process::ExitCode;

use bevy::prelude::*;
use bevy_comics_testkit::{demo::Demo, scenes::figure::motion::MotionPlugin};

fn main() -> ExitCode {
    let demo = Demo {
        title: "A comic page",
        keys: "The figure in the second panel waves.",
        size: page::SIZE,
        frames: 8,
    };
    demo.run(|app| {
        app.add_plugins((page::PagePlugin, MotionPlugin))
            .add_systems(Startup, (places::spawn, page::spawn).chain());
    })
}
