//! The colors of near, middle and far.

use super::*;

/// Truth: near and far look as they would alone, and a plain layer changes nothing. Here what is
/// behind 0.6 is gray, over a border that is 0.2 wide.
#[test]
fn a_layer_has_its_own_look_alone() {
    let color = (0.02f32..=0.98, 0.02f32..=0.98, 0.02f32..=0.98, 0.0f32..=1.0);
    for_batches(color.prop_map(|(r, g, b, d)| [r, g, b, d]), |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::depth::map::layer_weights
             #import bevy_comics::effects::depth_layers::{LayerColors, DepthLayers, layers_color}",
            "let plain = LayerColors(vec2(0.0), 1.0, 1.0, 0.0, 0.0, vec2(0.0));
             var gray = plain; gray.chroma = 0.0;
             let s = DepthLayers(plain, plain, gray, vec2(0.3, 0.6), 0.2, 1.0);
             let w = layer_weights(s.borders, s.softness, i(3u));
             return vec4(layers_color(s, vec3(i(0u), i(1u), i(2u)), w, 0.1), 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [r, g, b, _] = found;
            if row[3] < 0.5 {
                let same = (0..3).all(|i| (found[i] - row[i]).abs() < 1e-5);
                assert!(same, "{row:?} became {found:?}");
            } else if row[3] > 0.7 {
                let spread = r.max(g).max(b) - r.min(g).min(b);
                assert!(spread < 1e-5, "{row:?} became {found:?}");
                let [before, after] = [rgb(row), rgb(&found)].map(|c| color::linear_to_oklab(c)[0]);
                assert!((before - after).abs() < 1e-5, "{row:?} became {found:?}");
            }
        }
    });
}
