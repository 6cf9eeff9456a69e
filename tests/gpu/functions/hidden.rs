//! Which pixels of highlighted objects are hidden in the picture.

use super::{
    bound::{floats, pairs, texture},
    *,
};

const IMPORTS: &str = "#import bevy_comics::depth::view::view
    #import bevy_comics::lines::hidden::highlighted_object
    #import bevy_comics::lines::pass::line_pass";

/// The object, its slot and section, and whether it is hidden, in the second of two pixels.
const BODY: &str = "view.raw.nearest = 1.0;
    view.raw.view_z = vec4(0.0, 0.0, 0.0, -1.0);
    view.raw.view_w = vec4(0.0, 0.0, 1.0, 0.0);
    line_pass.settings.jump = i(1u);
    line_pass.settings.reference_factor = i(2u);
    line_pass.settings.reference_constant = i(3u);
    let found = highlighted_object(vec2(1, 0), i(0u));
    return vec4(f32(found.x), f32(found.y & 0xffffu), f32(found.y >> 16u), 0.0);";

/// A picture at depth 0.5 hides what is more than a tenth of a jump behind it: of a jump that is a
/// fraction of the object's depth in perspective, and of a constant in an orthographic view. What
/// is in front of the picture, or where nothing else is, is not hidden.
#[test]
fn objects_are_hidden_by_what_is_a_tenth_of_a_jump_in_front() {
    let ids = pairs([2, 1], &[[7, 9], [70_000, 0xc801]]);
    for (shown, own, [jump, factor, constant], hidden) in [
        (0.5, 0.5, [0.3, 1.0, 0.0], false),
        (0.5, 0.486, [0.3, 1.0, 0.0], false),
        (0.5, 0.485, [0.3, 1.0, 0.0], true),
        (0.5, 0.486, [0.2, 1.0, 0.0], true),
        (0.5, 0.4951, [1.0, 0.0, 0.05], false),
        (0.5, 0.4949, [1.0, 0.0, 0.05], true),
        (0.5, 0.481, [0.3, 1.0, 0.2], false),
        (0.5, 0.479, [0.3, 1.0, 0.2], true),
        (0.5, 0.9, [0.3, 1.0, 0.0], false),
        (1.0, 0.9, [0.3, 1.0, 0.0], true),
        (0.0, 0.4, [0.3, 1.0, 0.0], false),
        (0.5, 0.0, [0.3, 1.0, 0.0], true),
    ] {
        let picture = floats([2, 1], &[0.25, shown]);
        let entries = [texture(8, &ids), texture(27, &picture)];
        let rows = [[own, jump, factor, constant]];
        let definitions = [("OBJECT_IDS", None)];
        let found = gpu().evaluate_bound(&definitions, &entries, IMPORTS, BODY, &rows);
        let bit = f32::from(u8::from(hidden));
        let want = [70_000.0, f32::from(0xc801u16), bit, 0.0];
        assert_eq!(found[0], want, "{shown}, {:?}", rows[0]);
    }
}
