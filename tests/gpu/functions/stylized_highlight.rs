//! Stylized highlights where directions are opposite or zero.

use super::{toon::Numbers, *};

#[test]
fn highlights_of_degenerate_directions_are_finite() {
    let import = "#import bevy_comics::toon::stylized_highlight::{StylizedHighlight, frame_along, \
        stylized_highlight_coverage, faithful_distance, place_of, planar_distance}";
    // Seven shapes, split or not.
    let body = "let split = vec2(f32(u(0u) / 7u), 0.0);
         let g = StylizedHighlight(vec2(i(2u), i(3u)), vec2(1.6, 0.7), split, vec2(0.8, 0.6), i(4u),
             i(5u), i(6u), 1.0, 5.0, 3.0, u(0u) % 7u);
         var n = vec3(0.0, 0.0, 1.0);
         var h = vec3(0.0, 0.0, -1.0);
         if u(1u) == 1u { n = vec3(0.0); } else if u(1u) == 2u { h = vec3(1.0, 0.0, 0.0); }
         let f = frame_along(n, n, vec3(0.0, 1.0, 0.0));
         let a = faithful_distance(g, f, 0.3, n, h);
         let b = planar_distance(g, 0.3, place_of(f, n, h));
         let faithful = stylized_highlight_coverage(g, a, a, a);
         return vec4(b, faithful, stylized_highlight_coverage(g, b, b, b), 0.0);";
    let mut n = Numbers::new(1);
    let mut row = |k: usize| {
        let [offset, at] = [0; 2].map(|_| n.within(-3.0, 3.0));
        let kind = [(k % 14) as f32, (k / 14 % 3) as f32];
        let size = n.within(0.3, 3.0);
        [kind[0], kind[1], offset, at, size, n.part(), n.part()]
    };
    let rows: Vec<[f32; 7]> = (0..2048).map(&mut row).collect();
    for (row, found) in rows.iter().zip(gpu().evaluate(import, body, &rows)) {
        assert!(found.iter().all(|x| x.is_finite()), "{row:?}: {found:?}");
    }
}

/// Truth: along a small movement, the direction to a place changes as it should. The rest is of the
/// second order, and what single precision rounds.
#[test]
fn directions_swing_with_movements() {
    let import = "#import bevy_comics::toon::stylized_highlight_light::swing";
    let body = "let to = vec3(i(0u), i(1u), i(2u));
         return vec4(swing(to, vec3(i(3u), i(4u), i(5u)), i(6u)), 0.0);";
    let mut n = Numbers::new(50);
    let rows: Vec<[f32; 7]> = (0..1000)
        .map(|_| {
            let [to, movement] = [n.unit(), n.unit().map(|x| 0.01 * x)];
            let near = n.within(0.05, 2.0);
            [
                to[0],
                to[1],
                to[2],
                movement[0],
                movement[1],
                movement[2],
                near,
            ]
        })
        .collect();
    for (row, found) in rows
        .iter()
        .zip(gpu().evaluate_alone(&[], import, body, &rows))
    {
        let vector = |at: usize| DVec3::new(row[at].into(), row[at + 1].into(), row[at + 2].into());
        let (to, movement) = (vector(0).normalize(), vector(3));
        let distance = f64::from(row[6]).recip();
        let change = (distance * to - movement).normalize() - to;
        let swing = DVec3::new(found[0].into(), found[1].into(), found[2].into());
        let part = movement.length() / distance;
        let apart = (change - swing).length();
        assert!(apart < 2.0 * part * part + 1e-6 * part, "{row:?}: {apart}");
    }
}
