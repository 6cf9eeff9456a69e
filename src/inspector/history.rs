//! Undo and redo.

use crate::ComicStyle;

/// So many steps are kept.
const DEPTH: usize = 256;

/// The styles that a camera had.
#[derive(Debug, Default)]
pub struct History {
    undo: Vec<ComicStyle>,
    redo: Vec<ComicStyle>,
    /// What the last step was a part of: a drag is one step.
    gesture: Option<u64>,
}

impl History {
    /// A change away from `before`. Changes of one gesture, a drag or a hold of
    /// a key, are one step.
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

    pub fn undo(&mut self, now: &ComicStyle) -> Option<ComicStyle> {
        self.gesture = None;
        let before = self.undo.pop()?;
        self.redo.push(now.clone());
        Some(before)
    }

    pub fn redo(&mut self, now: &ComicStyle) -> Option<ComicStyle> {
        self.gesture = None;
        let after = self.redo.pop()?;
        self.undo.push(now.clone());
        Some(after)
    }

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
    fn only_so_many_steps_are_kept() {
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
