//! `lines/flood.wgsl`: wide lines against a search of everything.

use bevy::{prelude::*, render::view::Msaa};
use bevy_comics::Outlines;

use crate::{
    pictures::{assert_pass_is_its_twin, outlined},
    small::Small,
};

/// A flood knows one line a pixel; where two objects' lines cross, a jump can
/// land on the other. Wide lines of one colour have no such places.
#[test]
fn wide_lines_are_their_twin() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for width in [5.0, 6.5, 8.0, 12.0, 16.0] {
        let style = outlined(Outlines { width, ..default() });
        assert_pass_is_its_twin(&mut small, &style, None, &format!("{width} px"));
    }
}
