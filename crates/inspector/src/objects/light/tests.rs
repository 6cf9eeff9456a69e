use super::*;
use bevy_comics::{
    ToonMaterial, ToonScene,
    toon::{RampDetail, ToonShading},
};

fn stop(at: f32) -> RampStop {
    RampStop::new(at, Color::WHITE)
}

/// The light in range is what the material draws, with the stops in the order of the panel.
#[test]
fn stops_keep_their_order_and_every_number_its_range() {
    let stops = vec![stop(0.75), stop(f32::NAN), stop(9.0), stop(0.25)];
    let light = ToonLight {
        highlight: -3.0,
        falloff: f32::NAN,
        ramp: Some(Ramp {
            detail: Some(RampDetail {
                plain: vec![stop(2.0), stop(0.5)],
                ..RampDetail::default()
            }),
            ..Ramp::new(stops)
        }),
        ..ToonLight::default()
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
    let of = |ramp| ToonLight {
        ramp: Some(ramp),
        ..ToonLight::default()
    };
    let count = |light: ToonLight| in_ranges(light).ramp.expect("a ramp").stops.len();
    assert_eq!(count(of(many)), Ramp::MOST_STOPS);
    assert_eq!(in_ranges(of(Ramp::new([]))), of(Ramp::default()));
}

#[test]
fn the_panel_says_what_it_edits() {
    let mut world = World::new();
    let mut shadings = Assets::<ToonShading>::default();
    let shading = shadings.add(ToonShading {
        name: "Skin".into(),
        ..ToonShading::default()
    });
    let nameless = shadings.add(ToonShading::default());
    world.insert_resource(shadings);
    let scene = (Name::new("Hero"), ToonScene::default());
    let root = world.spawn(scene).id();
    let material = Handle::<ToonMaterial>::default();
    for (place, count, wanted) in [
        (
            LightOwner::Shading(shading),
            3,
            "Edits the shading “Skin”, which is made by code. 3 meshes have it.",
        ),
        (
            LightOwner::Shading(nameless),
            1,
            "Edits the shading, which is made by code. Only this mesh has it.",
        ),
        (
            LightOwner::Scene(root),
            2,
            "Edits ToonScene::light of Hero. 2 meshes have it.",
        ),
        (
            LightOwner::Material(material),
            1,
            "Edits the material, which is made by code. Only this mesh has it.",
        ),
    ] {
        assert_eq!(what_is_edited(&world, &place, count), wanted);
    }
}
