//! Undo and redo.

use crate::ComicStyle;

/// The largest number of steps that can be undone.
const DEPTH: usize = 256;

/// The styles that a camera had before and after the current one.
#[derive(Debug, Default)]
pub struct History {
    undo: Vec<ComicStyle>,
    redo: Vec<ComicStyle>,
    /// The gesture of the last step.
    gesture: Option<u64>,
}

impl History {
    /// Records a change away from `before`. All changes of one gesture, such as a
    /// drag, are one step.
    pub fn record(&mut self, before: ComicStyle, gesture: Option<u64>) {
        self.redo.clear();
        if gesture.is_some() && self.gesture == gesture {
            return;
        }
        self.gesture = gesture;
        if self.undo.len() == DEPTH {
            self.undo.remove(0);
        }
        self.undo.push(before);
    }

    /// The style before the last step, which becomes the current one.
    pub fn undo(&mut self, now: &ComicStyle) -> Option<ComicStyle> {
        self.gesture = None;
        let before = self.undo.pop()?;
        self.redo.push(now.clone());
        Some(before)
    }

    /// The style after the step that was undone last.
    pub fn redo(&mut self, now: &ComicStyle) -> Option<ComicStyle> {
        self.gesture = None;
        let after = self.redo.pop()?;
        self.undo.push(now.clone());
        Some(after)
    }

    /// The numbers of steps that can be undone and redone.
    pub fn steps(&self) -> (usize, usize) {
        (self.undo.len(), self.redo.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> ComicStyle {
        ComicStyle {
            name: name.into(),
            ..ComicStyle::default()
        }
    }

    #[test]
    fn back_and_forth() {
        let mut history = History::default();
        history.record(named("a"), Some(1));
        history.record(named("a and a half"), Some(1));
        history.record(named("b"), Some(2));
        let now = named("c");
        let b = history.undo(&now).expect("one step");
        assert_eq!(b.name, "b");
        let a = history.undo(&b).expect("two steps");
        assert_eq!(a.name, "a", "a drag is one step");
        assert!(history.undo(&a).is_none());
        assert_eq!(history.redo(&a).expect("redo").name, "b");
        assert_eq!(history.redo(&b).expect("redo").name, "c");
        assert!(history.redo(&now).is_none());
    }

    #[test]
    fn a_change_after_an_undo_ends_the_redo() {
        let mut history = History::default();
        history.record(named("a"), None);
        history.undo(&named("b"));
        history.record(named("a"), None);
        assert_eq!(history.steps(), (1, 0));
    }

    #[test]
    fn the_number_of_steps_is_limited() {
        let mut history = History::default();
        for i in 0..DEPTH + 10 {
            history.record(named(&i.to_string()), None);
        }
        assert_eq!(history.steps(), (DEPTH, 0));
        assert_eq!(
            history.undo(&named("now")).expect("a step").name,
            (DEPTH + 9).to_string()
        );
    }
}
