//! Paint against Kuwahara's filter.

use bevy_comics_testkit::painting::kuwahara_error;

/// Truth: where only the four boxes at the corners count, and the least variance decides, a picture
/// is painted as by the filter of Kuwahara (1976), computed from the pixels of its four squares.
#[test]
fn four_sharp_boxes_are_kuwaharas_filter() {
    for radius in [2, 4, 6] {
        let apart = kuwahara_error(radius);
        assert!(apart < 1e-3, "{radius}: {apart}");
    }
}
