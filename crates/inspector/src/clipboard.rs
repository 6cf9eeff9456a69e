//! The clipboard.

/// The system's clipboard, or a text of the panel's own where the system has no
/// clipboard.
#[derive(Default)]
pub struct Clipboard {
    system: Option<arboard::Clipboard>,
    own: Option<String>,
}

impl Clipboard {
    fn system(&mut self) -> Option<&mut arboard::Clipboard> {
        if self.system.is_none() {
            self.system = arboard::Clipboard::new().ok();
        }
        self.system.as_mut()
    }

    pub fn copy(&mut self, text: String) {
        if let Some(system) = self.system() {
            // If the system refuses, `paste` gives the panel's own text.
            let _ = system.set_text(text.clone());
        }
        self.own = Some(text);
    }

    pub fn paste(&mut self) -> Option<String> {
        let system = self.system().and_then(|system| system.get_text().ok());
        system.or_else(|| self.own.clone())
    }
}
