use super::*;

/// A root, an entity below it, and a mesh below that.
fn hierarchy() -> (World, [Entity; 3]) {
    let mut world = World::new();
    let root = world.spawn_empty().id();
    let limb = world.spawn(ChildOf(root)).id();
    let mesh = world.spawn(ChildOf(limb)).id();
    (world, [root, limb, mesh])
}

/// The components are those that `assign_object_styles` takes.
#[test]
fn the_component_that_counts_is_edited() {
    let (mut world, [root, limb, mesh]) = hierarchy();
    assert_eq!(source::<OutlineStyle>(&world, mesh), None);
    world.entity_mut(root).insert(OutlineStyle {
        inherit: false,
        ..OutlineStyle::default()
    });
    assert_eq!(source::<OutlineStyle>(&world, mesh), None, "not inherited");
    assert_eq!(source::<OutlineStyle>(&world, root), Some(root));
    world.entity_mut(root).insert(OutlineStyle::default());
    assert_eq!(source::<OutlineStyle>(&world, mesh), Some(root));
    // One in between ends it, even if it is not inherited itself.
    world.entity_mut(limb).insert(NoOutlines { inherit: false });
    assert_eq!(source::<OutlineStyle>(&world, mesh), None);
    assert_eq!(source::<NoOutlines>(&world, mesh), None);
    world.entity_mut(limb).insert(NoOutlines::default());
    assert_eq!(source::<NoOutlines>(&world, mesh), Some(limb));
    world.entity_mut(mesh).insert(OutlineStyle::default());
    assert_eq!(source::<OutlineStyle>(&world, mesh), Some(mesh));
    // Sections are always inherited.
    world.entity_mut(root).insert(MeshSections::default());
    assert_eq!(source::<MeshSections>(&world, mesh), Some(root));
}

#[test]
fn a_step_brings_a_component_back_and_takes_it_away() {
    let (mut world, [_, _, mesh]) = hierarchy();
    let sections = MeshSections { angle: 30.0 };
    let step = Box::new(PartStep {
        entity: mesh,
        value: Some(sections),
    });
    let undo = step.exchange(&mut world).expect("the entity");
    assert_eq!(world.get::<MeshSections>(mesh), Some(&sections));
    let redo = undo.exchange(&mut world).expect("the entity");
    assert_eq!(world.get::<MeshSections>(mesh), None);
    let undo = redo.exchange(&mut world).expect("the entity");
    assert_eq!(world.get::<MeshSections>(mesh), Some(&sections));
    world.despawn(mesh);
    assert!(undo.exchange(&mut world).is_none());
}
