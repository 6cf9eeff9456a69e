//! Edits and grades over styles.

use super::*;
use crate::style::ComicGrade;

#[test]
fn edits_under_a_grade_stay_without_it() {
    let (mut app, camera) = app();
    apply(&mut app, camera, &ComicStyle::new().with(contours(3.0)));
    let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
    let grade = ComicGrade(styles.add(ComicStyle::new().with(Vignette::default())));
    let gray = ComicStyle::new().with(Desaturation::default()).partial();
    let volume = StyleVolume {
        style: styles.add(gray),
        ..StyleVolume::default()
    };
    let set_grade = |app: &mut App, is_on: bool| {
        let mut entity = app.world_mut().entity_mut(camera);
        if is_on {
            entity.insert(grade.clone());
        } else {
            entity.remove::<ComicGrade>();
        }
        app.update();
        let look = look(app, camera);
        let width = look.get::<Contours>().map(|lines| lines.width);
        (width, look.get::<Vignette>().is_some())
    };
    assert_eq!(set_grade(&mut app, true), (Some(3.0), true));
    let edited = look(&app, camera).with(contours(9.0));
    edited.edit(&mut app.world_mut().commands().entity(camera));
    app.world_mut().flush();
    assert_eq!(look(&app, camera), edited);
    assert_eq!(set_grade(&mut app, false), (Some(9.0), false));

    // An edit of a component, and then a volume.
    set_grade(&mut app, true);
    let parts = (InStyleVolumes, contours(5.0));
    app.world_mut().entity_mut(camera).insert(parts);
    let shown = InheritedVisibility::VISIBLE;
    app.world_mut()
        .spawn((volume, GlobalTransform::IDENTITY, shown));
    let inside = look_at(&mut app, camera, 0.0);
    assert_eq!(inside.get(), Some(&Desaturation::default()));
    assert_eq!(inside.get(), Some(&Vignette::default()));
    assert_eq!(set_grade(&mut app, false), (Some(5.0), false));

    // In the volume.
    set_grade(&mut app, true);
    let edited = look(&app, camera).with(contours(7.0));
    edited.edit(&mut app.world_mut().commands().entity(camera));
    app.world_mut().flush();
    assert_eq!(set_grade(&mut app, false), (Some(7.0), false));
}

#[test]
fn a_grade_lies_over_a_new_own_style() {
    let (mut app, camera) = app();
    let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
    let grade = ComicGrade(styles.add(ComicStyle::new().with(Vignette::default())));
    app.world_mut().entity_mut(camera).insert(grade);
    app.update();
    let own = ComicStyle::new().with(contours(3.0));
    own.set_as_own(&mut app.world_mut().commands().entity(camera));
    app.world_mut().flush();
    let graded = own.clone().with(Vignette::default());
    assert_eq!(look(&app, camera), graded);
    app.world_mut().entity_mut(camera).remove::<ComicGrade>();
    app.update();
    assert_eq!(look(&app, camera), own);
}

#[test]
fn a_style_is_applied_once_until_it_changes() {
    let (mut app, camera) = app();
    let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
    let grade = ComicGrade(styles.add(ComicStyle::new().with(Vignette::default())));
    let preset = presets::LIGNE_CLAIRE;
    let parts = (preset.comic(), grade);
    app.world_mut().entity_mut(camera).insert(parts);
    app.update();
    let dark = Vignette {
        amount: 0.125,
        ..Vignette::default()
    };
    let edits = (outlines(9.0), dark);
    app.world_mut().entity_mut(camera).insert(edits);
    for _ in 0..2 {
        app.update();
    }
    let edited = look(&app, camera);
    assert_eq!(edited.get(), Some(&outlines(9.0)));
    assert_eq!(
        edited.get::<Vignette>().map(|corners| corners.amount),
        Some(0.125)
    );

    // Another asset under the same handle.
    let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
    styles.remove(&preset.handle());
    for _ in 0..2 {
        app.update();
    }
    assert_eq!(look(&app, camera).get(), Some(&outlines(9.0)));
    let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
    let wide = ComicStyle::new().with(outlines(7.0));
    styles.insert(&preset.handle(), wide).expect("an asset");
    app.update();
    assert_eq!(look(&app, camera).get(), Some(&outlines(7.0)));
}
