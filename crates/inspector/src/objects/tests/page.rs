//! Edits of different kinds in one history, and what they change.

use super::*;
use bevy_comics::{
    NoOutlines, OutlineStyle, ToonLight, ToonMaterial, ToonShadingHandle, objects::MeshSections,
    toon::ToonShading,
};

fn standard(page: &mut Page) -> Handle<StandardMaterial> {
    page.add(StandardMaterial {
        base_color: Color::srgb(0.9, 0.1, 0.2),
        ..StandardMaterial::default()
    })
}

/// The toon material of a mesh.
fn toon(page: &Page, mesh: Entity) -> Option<&ToonMaterial> {
    let handle = page.world.get::<MeshMaterial3d<ToonMaterial>>(mesh)?;
    page.world.resource::<Assets<ToonMaterial>>().get(&handle.0)
}

#[test]
fn a_standard_material_becomes_a_toon_material_and_back() {
    let mut page = Page::new();
    page.world.init_resource::<Assets<ToonMaterial>>();
    let [red, other] = [standard(&mut page), standard(&mut page)];
    let [mesh, other_mesh, other_material] = [&red, &red, &other]
        .map(|material| page.world.spawn(MeshMaterial3d(material.clone())).id());
    page.pick(mesh);
    page.click("light.convert");
    for mesh in [mesh, other_mesh] {
        let material = toon(&page, mesh).expect("a toon material");
        assert_eq!(material.base.base_color, Color::srgb(0.9, 0.1, 0.2));
        assert_eq!(material.extension, ToonLight::default());
        assert!(
            !page
                .world
                .entity(mesh)
                .contains::<MeshMaterial3d<StandardMaterial>>()
        );
    }
    assert!(toon(&page, other_material).is_none());
    assert!(page.has("light.shadow_threshold"), "and can be edited");
    page.drag("light.shadow_threshold", 0.1, 0.5);
    let edited = toon(&page, other_mesh).expect("shared").extension.clone();
    assert!(edited.shadow_threshold > 0.2);
    assert!(page.take(Way::Undo) && page.take(Way::Undo));
    for mesh in [mesh, other_mesh] {
        let material = page.world.get::<MeshMaterial3d<StandardMaterial>>(mesh);
        assert_eq!(material.map(|material| &material.0), Some(&red));
        assert!(toon(&page, mesh).is_none());
    }
    assert!(page.has("light.convert"));
    // The redo of the edit finds the material of the redone conversion.
    assert!(page.take(Way::Redo) && page.take(Way::Redo));
    assert_eq!(toon(&page, mesh).expect("again").extension, edited);
    assert_eq!(page.history.steps(CAMERA), (2, 0));
}

/// All edited values of an object.
#[derive(Clone, Debug, PartialEq)]
struct Edited {
    light: ToonLight,
    style: Option<OutlineStyle>,
    none: Option<NoOutlines>,
    sections: Option<MeshSections>,
}

#[test]
fn light_lines_and_sections_are_undone_in_one_order() {
    let mut page = Page::new();
    let shading = page.add(ToonShading::default());
    let (base, extension) = (StandardMaterial::default(), ToonLight::default());
    let material = page.add(ToonMaterial { base, extension });
    let bundle = (MeshMaterial3d(material), ToonShadingHandle(shading.clone()));
    let mesh = page.world.spawn(bundle).id();
    page.pick(mesh);
    let state = |page: &Page| Edited {
        light: {
            let shadings = page.world.resource::<Assets<ToonShading>>();
            shadings.get(&shading).expect("a shading").light.clone()
        },
        style: page.world.get::<OutlineStyle>(mesh).copied(),
        none: page.world.get::<NoOutlines>(mesh).copied(),
        sections: page.world.get::<MeshSections>(mesh).copied(),
    };
    let mut states = vec![state(&page)];
    let edit = |page: &mut Page, states: &mut Vec<Edited>, widget: &str| {
        if widget.ends_with("angle") || widget.ends_with("shadow_threshold") {
            page.drag(widget, 0.3, 0.6);
        } else {
            page.click(widget);
        }
        let now = state(page);
        assert_ne!(Some(&now), states.last(), "{widget} changes something");
        states.push(now);
    };
    for widget in [
        "light.ramp.on",
        "outline_style",
        "outline_style.width.on",
        "mesh_sections",
        "mesh_sections.angle",
        "light.shadow_threshold",
        "no_outlines",
        "light.ramp.stops.add",
        "outline_style",
    ] {
        edit(&mut page, &mut states, widget);
    }
    assert_eq!(page.history.steps(CAMERA), (states.len() - 1, 0));
    for wanted in states.iter().rev().skip(1) {
        assert!(page.take(Way::Undo));
        assert_eq!(state(&page), *wanted);
    }
    for wanted in &states[1..] {
        assert!(page.take(Way::Redo));
        assert_eq!(state(&page), *wanted);
    }
    // A width that was never on has the documented default, and comes back with the component.
    let style = states[3].style;
    assert_eq!(style.and_then(|style| style.width), Some(2.0));
    page.click("outline_style");
    assert_eq!(state(&page).style, style);
}

/// What is inherited is edited where it is set.
#[test]
fn the_style_of_a_figure_is_edited_on_its_root() {
    let mut page = Page::new();
    let style = OutlineStyle::default();
    let root = page.world.spawn((Name::new("Hero"), style)).id();
    let part = page.world.spawn(ChildOf(root)).id();
    page.pick(part);
    assert!(page.has("outline_style.source"));
    page.click("outline_style.open");
    page.click("outline_style.kinds.creases");
    let kinds = page.world.get::<OutlineStyle>(root).expect("a style").kinds;
    assert!(!kinds.creases && kinds.silhouettes);
    assert!(!page.world.entity(part).contains::<OutlineStyle>());
    page.click("outline_style.reset");
    assert_eq!(page.world.get::<OutlineStyle>(root), Some(&style));
}

/// The material that an edit changes is the one that the mesh shows last: its own, or the standard
/// material that a scene copies.
#[test]
fn the_material_of_an_object_is_edited_and_undone() {
    let mut page = Page::new();
    page.world.init_resource::<Assets<ToonMaterial>>();
    let red = standard(&mut page);
    let mesh = page.world.spawn(MeshMaterial3d(red.clone())).id();
    page.pick(mesh);
    let rough = |page: &Page| {
        let materials = page.world.resource::<Assets<StandardMaterial>>();
        materials.get(&red).expect("red").perceptual_roughness
    };
    page.drag("material.perceptual_roughness", 0.1, 0.5);
    assert!((rough(&page) - 0.5).abs() > 0.1, "{}", rough(&page));
    assert!(page.take(Way::Undo));
    assert_eq!(rough(&page), 0.5);
    // As a toon material of its own.
    page.click("light.convert");
    page.drag("material.metallic", 0.1, 0.5);
    let material = toon(&page, mesh).expect("a toon material");
    assert!(material.base.metallic > 0.2, "{}", material.base.metallic);
    assert_eq!(material.base.base_color, Color::srgb(0.9, 0.1, 0.2));
    assert!(page.take(Way::Undo));
    assert_eq!(toon(&page, mesh).expect("still").base.metallic, 0.0);
    // A material that has not loaded has no section.
    let none = page
        .world
        .spawn(MeshMaterial3d(Handle::<StandardMaterial>::default()))
        .id();
    page.pick(none);
    assert!(!page.has("material.metallic"));
}
