//! What paint does to pictures: of its reference, which whole pictures equal.

use bevy_comics_testkit::{
    painting::{RADII, SLOPES, edge_moved, kuwahara_error, random},
    reference::{box_statistics::Sheet, paint::Scene},
};

use crate::prelude::*;

fn painted(sheet: &Sheet, depth: &dyn Fn([usize; 2]) -> f64, s: &Paint) -> Sheet {
    let scene = Scene {
        sheet,
        depth,
        id: &|_| 0,
        scale: 1.0,
    };
    scene.painted(s)
}

/// Truth: where only the four boxes at the corners count, and the least variance decides, a picture
/// is painted as by the filter of Kuwahara (1976), computed from the pixels of its four squares.
#[test]
fn four_sharp_boxes_are_kuwaharas_filter() {
    for radius in [2, 4, 6] {
        let apart = kuwahara_error(radius);
        assert!(apart < 1e-3, "{radius}: {apart}");
    }
}

const FORMS: [PaintKernel; 2] = [PaintKernel::Box, PaintKernel::Anisotropic];

/// Truth: the variance of noise on one color falls to less than a tenth; a mean over one box of
/// 25 pixels would be a twenty-fifth, but areas are chosen by their noise.
#[test]
fn noise_is_painted_over() {
    let size = [40, 30];
    let sheet = Sheet::new(size, |[x, y]| {
        let root = 0.5 + 0.1 * (random(y * 40 + x) - 0.5);
        [root * root, root * root, root * root, 1.0]
    });
    let variance = |sheet: &Sheet| {
        let inside = (8..22).flat_map(|y| (8..32).map(move |x| [x, y]));
        let values: Vec<f64> = inside.map(|at| sheet.at(at)[1].sqrt()).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = |v: &f64| (v - mean).powi(2);
        values.iter().map(square).sum::<f64>() / values.len() as f64
    };
    for form in FORMS {
        let s = Paint {
            kernel: form,
            ..Paint::default()
        };
        let fraction = variance(&painted(&sheet, &|_| 0.0, &s)) / variance(&sheet);
        assert!(fraction < 0.1, "{form:?}: {fraction}");
    }
}

/// Truth: edges of all directions, anti-aliased, stay within a tenth of a pixel on the mean of
/// their rows, measured as they are seen: in square roots of light.
#[test]
fn edges_stay_in_place() {
    for slope in SLOPES {
        for form in FORMS {
            for radius in RADII {
                let moved = edge_moved(form, radius, slope);
                assert!(moved.abs() < 0.1, "{form:?}, {radius}, {slope}: {moved}");
            }
        }
    }
}

/// Truth: a narrow brush on what is near does not carry its color into what is painted with a
/// wide brush behind it, nor the other way.
#[test]
fn brushes_of_two_widths_keep_to_their_sides() {
    let sheet = Sheet::new([40, 9], |[x, _]| {
        let light = if x < 20 { 0.9 } else { 0.2 };
        [light, light, light, 1.0]
    });
    for (near, far) in [(0.0, 8.0), (1.0, 8.0), (3.0, 5.0), (8.0, 1.0), (4.5, 4.0)] {
        let s = Paint {
            at_near: near,
            at_far: far,
            ..Paint::default()
        };
        let depth = |[x, _]: [usize; 2]| if x < 20 { 0.0 } else { 1.0 };
        let painted = painted(&sheet, &depth, &s);
        for (i, (before, after)) in sheet.pixels.iter().zip(&painted.pixels).enumerate() {
            let apart = (before[1] - after[1]).abs();
            assert!(apart < 0.02, "{near}, {far}: {}: {apart}", i % 40);
        }
    }
}
