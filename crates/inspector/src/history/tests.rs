use super::*;

const FIRST: Entity = Entity::from_raw_u32(1).expect("an entity");
const SECOND: Entity = Entity::from_raw_u32(2).expect("an entity");

/// What is edited: the names of two styles, and of some objects.
#[derive(Resource, Default, Clone, Debug, PartialEq)]
struct Edited {
    styles: [&'static str; 2],
    objects: [Option<&'static str>; 3],
}

/// The name that an object had.
struct Named(usize, &'static str);

impl Exchange for Named {
    fn subject(&self) -> Subject {
        let place = Entity::from_raw_u32(100 + self.0 as u32).expect("an entity");
        Subject::Part(place, TypeId::of::<Named>())
    }

    fn exchange(self: Box<Self>, world: &mut World) -> Option<Box<dyn Exchange>> {
        let mut edited = world.resource_mut::<Edited>();
        let before = edited.objects[self.0].replace(self.1);
        let Some(before) = before else {
            // It was despawned.
            edited.objects[self.0] = None;
            return None;
        };
        Some(Box::new(Named(self.0, before)))
    }
}

/// The names by which styles are told apart.
const NAMES: &[&str] = &["", "a", "b", "c", "d", "e"];

fn style(name: &str) -> ComicStyle {
    ComicStyle {
        name: name.into(),
        ..ComicStyle::default()
    }
}

/// A world with a history, edited as the panel does it.
struct Session {
    world: World,
    history: History,
}

impl Session {
    fn new() -> Self {
        let mut world = World::new();
        world.insert_resource(Edited {
            objects: [Some(""); 3],
            ..Edited::default()
        });
        Self {
            world,
            history: History::default(),
        }
    }

    fn edited(&self) -> Edited {
        self.world.resource::<Edited>().clone()
    }

    fn restyle(&mut self, camera: Entity, name: &'static str, gesture: Option<u64>) {
        let at = usize::from(camera == SECOND);
        let mut edited = self.world.resource_mut::<Edited>();
        let before = std::mem::replace(&mut edited.styles[at], name);
        let step = Step::Style(camera, style(before));
        self.history.record(step, camera, gesture);
    }

    fn rename(&mut self, shown: Entity, (at, name): (usize, &'static str), gesture: Option<u64>) {
        let step = Box::new(Named(at, name)).exchange(&mut self.world);
        let step = Step::Object(step.expect("it exists"));
        self.history.record(step, shown, gesture);
    }

    fn take(&mut self, way: Way, shown: Entity) -> bool {
        let world = &mut self.world;
        self.history.take(way, shown, |step| match step {
            Step::Style(camera, before) => {
                let at = usize::from(camera == SECOND);
                let name = NAMES.iter().find(|name| **name == before.name);
                let mut edited = world.resource_mut::<Edited>();
                let now = std::mem::replace(&mut edited.styles[at], name.expect("a name"));
                Some(Step::Style(camera, style(now)))
            }
            Step::Object(value) => value.exchange(world).map(Step::Object),
        })
    }
}

#[test]
fn back_and_forth() {
    let mut session = Session::new();
    session.restyle(FIRST, "a", Some(1));
    session.restyle(FIRST, "b", Some(1));
    session.restyle(FIRST, "c", Some(2));
    assert_eq!(session.history.steps(FIRST), (2, 0));
    assert!(session.take(Way::Undo, FIRST));
    assert_eq!(session.edited().styles[0], "b");
    assert!(session.take(Way::Undo, FIRST));
    assert_eq!(session.edited().styles[0], "", "a drag is one step");
    assert!(!session.take(Way::Undo, FIRST));
    assert!(session.take(Way::Redo, FIRST));
    assert_eq!(session.edited().styles[0], "b");
    assert!(session.take(Way::Redo, FIRST));
    assert_eq!(session.edited().styles[0], "c");
    assert!(!session.take(Way::Redo, FIRST));
}

/// Whatever is edited, and in whatever order: undo goes through the same states backwards, and
/// redo forwards.
#[test]
fn steps_of_all_kinds_are_in_one_order() {
    let mut session = Session::new();
    let mut states = vec![session.edited()];
    type Edit = fn(&mut Session);
    let edits: [Edit; 6] = [
        |s| s.restyle(FIRST, "a", None),
        |s| s.rename(FIRST, (0, "x"), None),
        |s| s.rename(FIRST, (1, "y"), None),
        |s| s.restyle(FIRST, "b", None),
        |s| s.rename(FIRST, (0, "z"), None),
        |s| s.restyle(FIRST, "c", None),
    ];
    for edit in edits {
        edit(&mut session);
        states.push(session.edited());
    }
    for state in states.iter().rev().skip(1) {
        assert!(session.take(Way::Undo, FIRST));
        assert_eq!(session.edited(), *state);
    }
    assert_eq!(session.history.steps(FIRST), (0, 6));
    for state in &states[1..] {
        assert!(session.take(Way::Redo, FIRST));
        assert_eq!(session.edited(), *state);
    }
    assert_eq!(session.history.steps(FIRST), (6, 0));
}

/// A press can change two things, for example when a widget turns another one off.
#[test]
fn a_gesture_is_one_step_of_each_subject() {
    let mut session = Session::new();
    session.rename(FIRST, (0, "x"), Some(7));
    session.rename(FIRST, (0, "y"), Some(7));
    session.rename(FIRST, (1, "z"), Some(7));
    assert_eq!(session.history.steps(FIRST), (2, 0));
    session.take(Way::Undo, FIRST);
    session.take(Way::Undo, FIRST);
    assert_eq!(session.edited().objects, [Some(""); 3]);
}

/// Styles belong to cameras, objects to all of them.
#[test]
fn a_camera_undoes_its_own_style_and_objects() {
    let mut session = Session::new();
    session.restyle(FIRST, "a", None);
    session.rename(FIRST, (0, "x"), None);
    session.restyle(SECOND, "b", None);
    assert_eq!(session.history.steps(FIRST), (2, 0));
    assert_eq!(session.history.steps(SECOND), (2, 0));
    assert!(session.take(Way::Undo, FIRST));
    assert_eq!(session.edited().objects[0], Some(""));
    assert_eq!(session.edited().styles, ["a", "b"]);
    assert!(session.take(Way::Undo, FIRST));
    assert!(!session.take(Way::Undo, FIRST));
    assert_eq!(session.edited().styles, ["", "b"]);
    // The second camera can take the object's step again, and not the first one's.
    assert_eq!(session.history.steps(SECOND), (1, 1));
    assert!(session.take(Way::Redo, SECOND));
    assert!(!session.take(Way::Redo, SECOND));
    assert_eq!(session.edited().objects[0], Some("x"));
    assert_eq!(session.edited().styles, ["", "b"]);
    session.history.keep_cameras(|camera| camera == SECOND);
    assert_eq!(session.history.steps(FIRST), (1, 0), "the object's");
}

#[test]
fn a_change_after_an_undo_ends_the_redo() {
    let mut session = Session::new();
    session.restyle(SECOND, "e", None);
    session.take(Way::Undo, SECOND);
    session.restyle(FIRST, "a", None);
    session.take(Way::Undo, FIRST);
    session.rename(FIRST, (0, "x"), None);
    assert_eq!(session.history.steps(FIRST), (1, 0));
    // The other camera's style is not changed by it.
    assert_eq!(session.history.steps(SECOND), (1, 1));
}

/// An object that was despawned: the step before is taken.
#[test]
fn steps_of_what_is_gone_are_left_out() {
    let mut session = Session::new();
    session.rename(FIRST, (0, "x"), None);
    session.rename(FIRST, (1, "y"), None);
    session.rename(FIRST, (1, "z"), None);
    session.world.resource_mut::<Edited>().objects[1] = None;
    assert!(session.take(Way::Undo, FIRST));
    assert_eq!(session.edited().objects, [Some(""), None, Some("")]);
    assert_eq!(session.history.steps(FIRST), (0, 1));
}

#[test]
fn the_number_of_steps_is_limited() {
    let mut session = Session::new();
    session.rename(FIRST, (0, "x"), None);
    for _ in 0..DEPTH + 10 {
        session.restyle(FIRST, "a", None);
    }
    session.restyle(SECOND, "b", None);
    assert_eq!(session.history.steps(FIRST), (DEPTH + 1, 0));
    assert_eq!(session.history.steps(SECOND), (2, 0));
}
