//! Pairs of what a camera can be: samples, HDR, projection, renderer, anti-aliasing, viewport and
//! effects. Every pair that the engine supports is in a row, and every row is drawn and checked.

pub mod checks;
pub mod compare;
pub mod covering;
pub mod effects;
mod stage;

use bevy_comics_testkit::headless;
use checks::{
    Base, Shown, assert_drawn, assert_finite, assert_near, assert_outside, assert_silhouettes,
    assert_still, assert_styled,
};
use compare::{Mask, crop};
use covering::{AntiAliasing, Area, Row, View, rows};
use effects::GROUPS;
use stage::SIZE;

use crate::prelude::*;

/// How many tests the rows are divided among, which run at the same time.
const TESTS: usize = 3;

/// Apps that are used for all rows of a test: starting one takes longer than drawing a row.
struct Bench {
    forward: Small,
    deferred: Option<Small>,
    scales_up: bool,
    bases: HashMap<(View, usize, UVec2), Base>,
}

/// Where the view's main pass has drawn things, in pixels of the picture; `None` without a depth
/// prepass.
fn mask(small: &Small, row: &Row, rect: URect) -> Option<Mask> {
    let depth = small.depth()?;
    let size = rect.size();
    let pixels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
    let is_thing = |inside: UVec2| {
        let texel = match row.area {
            Area::SmallMainPass => inside / 2,
            Area::Whole | Area::Part => inside,
        };
        let at = rect.min + texel;
        // The sky is at 0.
        depth.at(at.x, at.y, 0) > 0.0
    };
    let things = pixels.map(is_thing).collect();
    Some(Mask { size, things })
}

impl Bench {
    /// Views with a small main pass need apps that scale up.
    fn new(scales_up: bool) -> Self {
        Self {
            forward: stage::app(false, scales_up),
            deferred: None,
            scales_up,
            bases: HashMap::new(),
        }
    }

    /// Draws the base of a row, unless it has been drawn.
    fn base(&mut self, row: &Row, size: UVec2) -> &Base {
        let plainest = Row {
            samples: 1,
            hdr: false,
            deferred: false,
            anti_aliasing: AntiAliasing::Off,
            area: Area::Whole,
            ..*row
        };
        let small = &mut self.forward;
        let key = (row.view, row.effects, size);
        self.bases.entry(key).or_insert_with(|| {
            let mut shoot = |style: Option<&ComicStyle>| {
                stage::shoot(small, &plainest, size, style);
                small.picture()
            };
            let (_, style) = GROUPS[row.effects];
            Base {
                plain: shoot(None),
                styled: shoot(Some(&style())),
            }
        })
    }

    fn check(&mut self, row: &Row) {
        let (name, style) = GROUPS[row.effects];
        let (what, style) = (format!("{name}, {row:?}"), style());
        let rect = stage::rect(row.area, SIZE);
        let small = if row.deferred {
            let new = || stage::app(true, self.scales_up);
            self.deferred.get_or_insert_with(new)
        } else {
            &mut self.forward
        };
        stage::shoot(small, row, SIZE, None);
        let plain = small.picture();
        let silhouettes = mask(small, row, rect).expect("a depth prepass");
        stage::shoot(small, row, SIZE, Some(&style));
        let styled = small.picture();
        for picture in [&plain, &styled] {
            assert_outside(picture, rect, &what);
        }
        let [plain, styled] = [plain, styled].map(|picture| crop(&picture, rect));
        let shown = Shown {
            what,
            rect,
            plain,
            styled,
        };
        assert_drawn(small, &style, &shown.what);
        assert_finite(small, &shown);
        assert_styled(&shown);
        assert_silhouettes(row, &silhouettes, mask(small, row, rect).as_ref(), &shown);
        assert_still(small, row, &shown);
        assert_eq!(small.errors(), 0, "{}", shown.what);
        assert_near(row, &shown, self.base(row, rect.size()));
        // Sees errors of the base, too.
        assert_eq!(self.forward.errors(), 0, "{}", shown.what);
    }
}

fn check_rows(test: usize) {
    let samples = headless::adapter().expect("an adapter").samples;
    let mut bench = Bench::new(true);
    // Rows of a group have a base in common.
    let rows = rows(&samples).into_iter();
    for row in rows.filter(|row| row.effects % TESTS == test) {
        bench.check(&row);
    }
}

#[test]
#[ignore = "long: a third of the pairs"]
fn pairs_are_drawn_as_on_a_plain_camera_1() {
    check_rows(0);
}

#[test]
#[ignore = "long: a third of the pairs"]
fn pairs_are_drawn_as_on_a_plain_camera_2() {
    check_rows(1);
}

#[test]
#[ignore = "long: a third of the pairs"]
fn pairs_are_drawn_as_on_a_plain_camera_3() {
    check_rows(2);
}

/// One of the rows, so that quick tests see what all rows see.
#[test]
fn a_multisampled_viewport_is_drawn_as_on_a_plain_camera() {
    let effects = GROUPS.iter().position(|(name, _)| *name == "sketch");
    Bench::new(false).check(&Row {
        samples: 4,
        hdr: true,
        view: View::Perspective,
        deferred: false,
        anti_aliasing: AntiAliasing::Off,
        area: Area::Part,
        effects: effects.expect("a group"),
    });
}
