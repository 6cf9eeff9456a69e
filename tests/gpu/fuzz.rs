//! Files of strangers. `FUZZ_CASES=1000000` tries as many texts as are promised; without it, 2000.

use bevy::ecs::world::{CommandQueue, World};
use bevy::prelude::Commands;
use bevy_comics::{ComicStyle, ToonLook, presets};
use bevy_comics_testkit::fuzz::{Counting, Texts, cases, check};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A style that is read can be written, read again, and worn.
#[test]
fn no_text_of_a_style_is_dangerous() {
    let all = presets::LOOKS.iter().chain(presets::PAPERS);
    let mut texts = Texts::new(1, all.map(|preset| preset.source().to_owned()));
    // The first style that is read makes the tables of effects.
    let _ = presets::NOIR.style();
    let mut world = World::new();
    let camera = world.spawn_empty().id();
    let mut read_count = 0;
    for _ in 0..cases() {
        check(&texts.next_text(), |text| {
            let Ok(style) = ComicStyle::from_ron(text) else {
                return;
            };
            read_count += 1;
            let written = style.to_ron().expect("what was read can be written");
            let again = ComicStyle::from_ron(&written).expect("what was written can be read");
            assert_eq!(again.to_ron().expect("again"), written);
            let mut queue = CommandQueue::default();
            style.apply(&mut Commands::new(&mut queue, &world).entity(camera));
            queue.apply(&mut world);
        });
    }
    assert!(read_count * 20 > cases(), "{read_count} texts are right");
}

#[test]
fn no_text_of_a_look_is_dangerous() {
    let kinds = crate::looks::all_kinds();
    let written = kinds.iter().map(|look| look.to_ron().expect("written"));
    let mut texts = Texts::new(2, written);
    let mut read_count = 0;
    for _ in 0..cases() {
        check(&texts.next_text(), |text| {
            let Ok(look) = ToonLook::from_ron(text) else {
                return;
            };
            read_count += 1;
            let _ = look.light.clone().sanitized();
            let written = look.to_ron().expect("what was read can be written");
            let again = ToonLook::from_ron(&written).expect("what was written can be read");
            assert_eq!(again.to_ron().expect("again"), written);
        });
    }
    assert!(read_count * 20 > cases(), "{read_count} texts are right");
}
