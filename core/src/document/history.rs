//! Undo and redo: the documents before each edit, sharing what they have in common.

use std::sync::Arc;

use super::Document;

/// Edits of the same kind to the same thing within this many seconds of each other are one step.
const COALESCE_SECS: f64 = 0.5;
/// Steps that are kept; the oldest are forgotten.
const MAX_STEPS: usize = 1000;
/// Label of every step that moves the camera: a run of them is one step however long it takes.
pub const VIEW_LABEL: &str = "Move camera";

/// An edit that can be undone.
#[derive(Clone, Debug)]
pub struct Step {
    /// For people, such as `Roughness`.
    pub label: String,
    /// What was edited, such as the material's name; empty for the document.
    pub target: String,
    /// When it was last added to, in seconds of the caller's clock.
    time_secs: f64,
    /// The document before it.
    before: Arc<Document>,
}

/// The current document with its past and future.
#[derive(Clone, Debug)]
pub struct History {
    current: Arc<Document>,
    past: Vec<Step>,
    /// Undone steps with the document after each, the next to redo last.
    future: Vec<(Step, Arc<Document>)>,
    /// The next edit starts a step of its own.
    sealed: bool,
}

impl History {
    /// No past.
    pub fn new(document: Document) -> History {
        History { current: Arc::new(document), past: Vec::new(), future: Vec::new(), sealed: true }
    }

    /// The document as it is now.
    pub fn current(&self) -> &Arc<Document> {
        &self.current
    }

    /// Changes the document under a label. An edit that changes nothing leaves no trace. `now_secs` is any steady
    /// clock. Returns whether something changed.
    pub fn edit(&mut self, label: &str, target: &str, now_secs: f64, change: impl FnOnce(&mut Document)) -> bool {
        let mut document = Document::clone(&self.current);
        change(&mut document);
        if document == *self.current {
            return false;
        }
        let before = std::mem::replace(&mut self.current, Arc::new(document));
        self.future.clear();
        let sealed = std::mem::take(&mut self.sealed);
        if let Some(last) = self.past.last_mut().filter(|last| !sealed && last.label == label && last.target == target)
            && (label == VIEW_LABEL || (0.0..=COALESCE_SECS).contains(&(now_secs - last.time_secs)))
        {
            last.time_secs = now_secs;
            return true;
        }
        self.past.push(Step { label: label.into(), target: target.into(), time_secs: now_secs, before });
        if self.past.len() > MAX_STEPS {
            self.past.remove(0);
        }
        true
    }

    /// Ends the running step: the next edit is one of its own, such as after a mouse button was let go.
    pub fn seal(&mut self) {
        self.sealed = true;
    }

    /// Takes back the last step and returns it; `None` at the start.
    pub fn undo(&mut self) -> Option<&Step> {
        let step = self.past.pop()?;
        let after = std::mem::replace(&mut self.current, step.before.clone());
        self.sealed = true;
        self.future.push((step, after));
        self.future.last().map(|(step, _)| step)
    }

    /// Does the last undone step again and returns it; `None` when there is none.
    pub fn redo(&mut self) -> Option<&Step> {
        let (step, after) = self.future.pop()?;
        self.current = after;
        self.sealed = true;
        self.past.push(step);
        self.past.last()
    }

    /// Steps that undo takes back, oldest first.
    pub fn past(&self) -> &[Step] {
        &self.past
    }

    /// Steps that redo does again, the next first.
    pub fn future(&self) -> impl Iterator<Item = &Step> {
        self.future.iter().rev().map(|(step, _)| step)
    }

    /// Goes to the state after `count` steps from the start.
    pub fn go_to(&mut self, count: usize) {
        while self.past.len() > count && self.undo().is_some() {}
        while self.past.len() < count && self.redo().is_some() {}
    }
}
