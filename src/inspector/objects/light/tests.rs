use bevy::color::Color;

use super::*;
use crate::RampDetail;

fn stop(at: f32) -> RampStop {
    RampStop::new(at, Color::WHITE)
}

/// The light in range is what the material draws, with the stops in the order of the panel.
#[test]
fn stops_keep_their_order_and_every_number_its_range() {
    let stops = vec![stop(0.75), stop(f32::NAN), stop(9.0), stop(0.25)];
    let light = CartoonLight {
        highlight: -3.0,
        falloff: f32::NAN,
        ramp: Some(Ramp {
            detail: Some(RampDetail {
                plain: vec![stop(2.0), stop(0.5)],
                ..RampDetail::default()
            }),
            ..Ramp::new(stops)
        }),
        ..CartoonLight::default()
    };
    let used = in_ranges(light.clone());
    assert_eq!((used.highlight, used.falloff), (0.0, 1.0));
    let ramp = used.ramp.clone().expect("a ramp");
    let places = |stops: &[RampStop]| stops.iter().map(|s| s.at).collect::<Vec<_>>();
    assert_eq!(places(&ramp.stops), [0.75, 0.0, 1.0, 0.25]);
    let detail = ramp.detail.expect("a second ramp");
    assert_eq!(places(&detail.plain), [1.0, 0.5]);
    assert_eq!(in_ranges(used.clone()), used);
    assert_eq!(used.sanitized(), light.sanitized());
    // As many stops as count, and never none.
    let many = Ramp::new((0..20).map(|_| stop(0.5)));
    let of = |ramp| CartoonLight {
        ramp: Some(ramp),
        ..CartoonLight::default()
    };
    let count = |light: CartoonLight| in_ranges(light).ramp.expect("a ramp").stops.len();
    assert_eq!(count(of(many)), Ramp::MOST_STOPS);
    assert_eq!(in_ranges(of(Ramp::new([]))), of(Ramp::default()));
}
