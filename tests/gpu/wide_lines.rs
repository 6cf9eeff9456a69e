//! Wide lines against an exhaustive search.

use bevy::{prelude::*, render::view::Msaa};
use bevy_comics::Outlines;

use crate::{
    pictures::{assert_pass_is_its_twin, outlined},
    small::Small,
};

#[test]
fn wide_lines_are_their_twin() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for width in [5.0, 6.5, 8.0, 12.0, 16.0] {
        let style = outlined(Outlines { width, ..default() });
        assert_pass_is_its_twin(&mut small, &style, None, &format!("{width} px"));
    }
}
