//! An effect of a game, with types that this crate does not know.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use super::Page;
use bevy_comics::{
    ComicStyle, Effect,
    effect::{EffectContext, EffectShader, EffectStage, EffectType, FieldRange, NoUniform},
};

#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Rain {
    /// How it falls.
    gusts: Option<Gusts>,
    /// What falls.
    drops: Drops,
}

#[derive(Reflect, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
struct Gusts {
    /// How strong they are.
    #[reflect(@FieldRange::linear(0.0, 9.0))]
    strength: f32,
}

impl Default for Gusts {
    fn default() -> Self {
        Self { strength: 4.0 }
    }
}

#[derive(Reflect, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
enum Drops {
    #[default]
    Water,
    Frogs(u32, bool),
}

impl Effect for Rain {
    const NAME: &'static str = "rain";
    const STAGE: EffectStage = EffectStage::Page;
    const SHADER: EffectShader = EffectShader {
        path: "my_game::rain",
        source: "",
        settings: None,
    };
    type Uniform = NoUniform;

    fn sanitized(self) -> Self {
        self
    }

    fn strength(&self) -> f32 {
        1.0
    }

    fn faded(self, _: f32) -> Self {
        self
    }

    fn uniform(&self, _: &EffectContext) -> NoUniform {
        NoUniform::default()
    }
}

#[test]
fn options_and_modes_of_a_games_effect_have_widgets() {
    let mut page = Page::of(
        ComicStyle::new().with(Rain::default()),
        &[EffectType::of::<Rain>()],
    );
    page.show();
    page.click("rain.open");
    page.click("rain.gusts.on");
    let rain = |page: &Page| page.style.get::<Rain>().cloned().expect("rain");
    assert_eq!(rain(&page).gusts, Some(Gusts::default()));
    assert!(page.has("rain.gusts.strength"));
    page.style.insert(Rain {
        gusts: Some(Gusts { strength: 8.0 }),
        drops: Drops::Frogs(3, true),
    });
    page.click("rain.gusts.on");
    assert_eq!(rain(&page).gusts, None);
    page.click("rain.gusts.on");
    assert_eq!(rain(&page).gusts, Some(Gusts { strength: 8.0 }));
    // Modes keep their values as well.
    page.click("rain.drops");
    page.click("rain.drops.Water");
    assert_eq!(rain(&page).drops, Drops::Water);
    page.click("rain.drops");
    page.click("rain.drops.Frogs");
    assert_eq!(rain(&page).drops, Drops::Frogs(3, true));
    page.click("rain.drops.reset");
    assert_eq!(rain(&page).drops, Drops::Water);
}
