use super::*;
use bevy_comics::{
    BlackFlats, Contours, DepthMapping, Outlines, ToneBands,
    depth::{RangeSmoothing, ReductionMethod},
    effects::ContourOperator,
    lines::Silhouettes,
};

fn code(value: &dyn PartialReflect) -> String {
    let mut types = TypeRegistry::default();
    types.register::<DepthMap>();
    types.register::<Outlines>();
    types.register::<Game>();
    Writer { types }.value(value)
}

/// As a game might define it.
#[derive(Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Default)]
#[type_path = "my_game::rain"]
struct Game {
    wind: Vec2,
    title: String,
    drops: Vec<u32>,
    inner: Option<Inner>,
    pair: (f32, bool),
}

#[derive(Reflect, Clone, Debug, Default, PartialEq)]
#[type_path = "my_game::rain"]
struct Inner {
    size: f32,
    letter: char,
}

#[derive(Reflect)]
#[type_path = "my_game::rain"]
struct Wrapped(f32, Option<bool>);

#[test]
fn numbers_read_back_as_the_same_bits() {
    for value in [
        0.0f32,
        -0.5,
        3.0,
        0.1,
        1e-6,
        1e36,
        1.0 / 16384.0,
        f32::MIN_POSITIVE,
        f32::MAX,
    ] {
        let text = code(&value);
        assert_eq!(text.parse(), Ok(value), "{text}");
        assert!(text.contains(['.', 'e']), "{text} is a float literal");
    }
    assert_eq!(code(&f32::NAN), "f32::NAN");
    assert_eq!(code(&f32::INFINITY), "f32::INFINITY");
    assert_eq!(code(&f32::NEG_INFINITY), "f32::NEG_INFINITY");
    assert_eq!(code(&f64::NAN), "f64::NAN");
    assert_eq!(code(&7u32), "7");
    assert_eq!(code(&-7i64), "-7");
    assert_eq!(code(&true), "true");
    assert_eq!(code(&String::from("a \"b\"\n")), r#""a \"b\"\n".into()"#);
}

#[test]
fn colors_keep_their_space_and_value() {
    for (color, text) in [
        (Color::BLACK, "Color::BLACK"),
        (Color::WHITE, "Color::WHITE"),
        (Color::srgb_u8(158, 128, 87), "Color::srgb_u8(158, 128, 87)"),
        (
            Color::srgb(0.97, 0.955, 0.915),
            "Color::srgb(0.97, 0.955, 0.915)",
        ),
        (
            Color::srgba(1.0, 0.0, 0.0, 0.5),
            "Color::srgba(1.0, 0.0, 0.0, 0.5)",
        ),
        (
            Color::linear_rgb(0.5, 2.0, 0.0),
            "Color::linear_rgb(0.5, 2.0, 0.0)",
        ),
        (
            Color::hsva(200.0, 0.5, 0.25, 0.75),
            "Color::hsva(200.0, 0.5, 0.25, 0.75)",
        ),
        (
            Color::srgb(f32::NAN, 0.0, 0.0),
            "Color::srgb(f32::NAN, 0.0, 0.0)",
        ),
    ] {
        assert_eq!(code(&color), text);
    }
}

#[test]
fn options_and_variants() {
    assert_eq!(code(&None::<f32>), "None");
    assert_eq!(code(&Some(0.25f32)), "Some(0.25)");
    assert_eq!(
        code(&Some(Silhouettes::default())),
        "Some(bevy_comics::lines::Silhouettes::default())"
    );
    assert_eq!(
        code(&ContourOperator::Sobel),
        "bevy_comics::effects::ContourOperator::Sobel"
    );
    assert_eq!(
        code(&DepthMapping::Fixed {
            from: 1.0,
            to: 30.0
        }),
        "DepthMapping::Fixed {\n    from: 1.0,\n    to: 30.0,\n}"
    );
    // Not in the prelude.
    assert_eq!(
        code(&ReductionMethod::PingPong),
        "bevy_comics::depth::ReductionMethod::PingPong"
    );
}

#[test]
fn types_of_other_crates_are_written_by_their_path() {
    let game = Game {
        wind: Vec2::new(1.0, -2.0),
        title: "Rain".into(),
        drops: vec![1, 2],
        inner: Some(Inner {
            size: 2.0,
            letter: 'x',
        }),
        pair: (0.5, true),
    };
    let inner = "Some(my_game::rain::Inner {\n        size: 2.0,\n        letter: 'x',\n    })";
    let wind = "bevy::math::Vec2 {\n        x: 1.0,\n        y: -2.0,\n    }";
    assert_eq!(
        code(&game),
        format!(
            "my_game::rain::Game {{\n    wind: {wind},\n    title: \"Rain\".into(),\n    \
             drops: vec![1, 2],\n    inner: {inner},\n    pair: (0.5, true,),\n}}"
        )
    );
    assert_eq!(
        code(&Game {
            drops: vec![3],
            ..Game::default()
        }),
        "my_game::rain::Game {\n    drops: vec![3],\n    ..default()\n}"
    );
    assert_eq!(
        code(&Wrapped(1.0, None)),
        "my_game::rain::Wrapped(1.0, None)"
    );
    // Without a registered default every field is written.
    assert!(code(&Inner::default()).contains("size: 0.0"));
}

#[test]
fn only_what_differs_from_the_default_is_written() {
    let style = ComicStyle {
        name: "Old \"photograph\"".into(),
        depth_map: Some(DepthMap {
            smoothing: None,
            ..DepthMap::default()
        }),
        page: Some(540.0),
        ..ComicStyle::new()
    }
    .with(ToneBands::default())
    .with(BlackFlats {
        value: None,
        slope: Some(0.5),
        ..BlackFlats::default()
    })
    .with(Outlines {
        silhouettes: Some(Silhouettes {
            threshold: 0.1,
            ..Silhouettes::default()
        }),
        objects: None,
        ..Outlines::default()
    });
    assert_eq!(
        rust_code(&style),
        r#"ComicStyle {
    name: "Old \"photograph\"".into(),
    ..ComicStyle::new()
}
.with_depth_map(DepthMap {
    smoothing: None,
    ..default()
})
.with_page(540.0)
.with(ToneBands::default())
.with(BlackFlats {
    slope: Some(0.5),
    value: None,
    ..default()
})
.with(Outlines {
    silhouettes: Some(bevy_comics::lines::Silhouettes {
        threshold: 0.1,
        ..default()
    }),
    objects: None,
    ..default()
})"#
    );
    assert_eq!(rust_code(&ComicStyle::new()), "ComicStyle::new()");
    let tonemapped =
        "(version: 3, camera: (tonemapping: AcesFitted), scene: (light: (highlight: 0)))";
    assert_eq!(
        rust_code(&ComicStyle::from_ron(tonemapped).expect("readable")),
        r"ComicStyle {
    camera: bevy_comics::style::StyleCamera {
        tonemapping: Some(bevy::core_pipeline::tonemapping::Tonemapping::AcesFitted),
        ..default()
    },
    scene: Some(bevy_comics::toon::StyleScene {
        light: bevy_comics::toon::ToonLight {
            highlight: 0.0,
            ..default()
        },
        ..default()
    }),
    ..ComicStyle::new()
}"
    );
    let partial = ComicStyle::new().partial();
    assert_eq!(rust_code(&partial), "ComicStyle::new().partial()");
    assert_eq!(
        rust_code(&partial.turn_off::<Contours>()),
        "ComicStyle {\n    off: [\"contours\"].into(),\n    ..ComicStyle::new()\n}\n.partial()"
    );
    let two = ComicStyle::new()
        .with(ToneBands::default())
        .with(Contours::default());
    assert_eq!(
        rust_code(&two),
        "ComicStyle::new()\n    .with(ToneBands::default())\n    .with(Contours::default())"
    );
    assert_eq!(
        code(&RangeSmoothing::default()),
        "bevy_comics::depth::RangeSmoothing::default()"
    );
}
