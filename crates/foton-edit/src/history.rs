//! Undo and redo: whole descriptions with the names of the steps between them.
//!
//! Descriptions share their meshes and images, so a step costs little. A drag, or a slider that is held, is one step
//! however many descriptions it goes through.

use std::collections::VecDeque;
use std::sync::Arc;

use foton_scene::description::SceneDescription;

/// Steps that can be undone; older ones are forgotten.
pub const MAX_STEPS: usize = 200;

#[derive(Clone, Debug)]
struct Step {
    name: String,
    /// The other side of the step: before it on the undo stack, after it on the redo stack.
    description: Arc<SceneDescription>,
    /// Whether both sides are the same picture.
    is_naming: bool,
}

/// A description with its past and its undone future.
#[derive(Clone, Debug)]
pub struct History {
    current: Arc<SceneDescription>,
    past: VecDeque<Step>,
    future: Vec<Step>,
    /// The step under way, with the description before it.
    open: Option<Step>,
    /// The description that was opened or saved last.
    saved: Arc<SceneDescription>,
}

impl History {
    /// The history of a scene just opened.
    #[must_use]
    pub fn new(description: Arc<SceneDescription>) -> Self {
        let saved = Arc::clone(&description);
        Self { current: description, past: VecDeque::new(), future: Vec::new(), open: None, saved }
    }

    /// The description as it is now.
    #[must_use]
    pub const fn current(&self) -> &Arc<SceneDescription> {
        &self.current
    }

    /// The description before the step under way; the current one if there is none. A drag applies its whole move to it.
    #[must_use]
    pub fn base(&self) -> &Arc<SceneDescription> {
        self.open.as_ref().map_or(&self.current, |step| &step.description)
    }

    /// Begins a step that [`proceed`](Self::proceed) may change many times; one under way is committed first.
    pub fn begin(&mut self, name: impl Into<String>) {
        self.commit();
        self.open =
            Some(Step { name: name.into(), description: Arc::clone(&self.current), is_naming: false });
    }

    /// The next description of the step under way; without one it is a step of its own, without a name.
    pub fn proceed(&mut self, next: SceneDescription) -> &Arc<SceneDescription> {
        if self.open.is_none() {
            self.record("edit", next);
        } else {
            self.current = Arc::new(next);
        }
        &self.current
    }

    /// Whether a step is under way.
    #[must_use]
    pub const fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Ends the step under way. It counts as one, or as none if nothing changed.
    pub fn commit(&mut self) {
        let Some(step) = self.open.take() else { return };
        if Arc::ptr_eq(&step.description, &self.current) {
            return;
        }
        self.future.clear();
        self.past.push_back(step);
        if self.past.len() > MAX_STEPS {
            self.past.pop_front();
        }
    }

    /// Drops the step under way: the description before it is back.
    pub fn cancel(&mut self) -> &Arc<SceneDescription> {
        if let Some(step) = self.open.take() {
            self.current = step.description;
        }
        &self.current
    }

    /// A step of one description.
    pub fn record(&mut self, name: impl Into<String>, next: SceneDescription) -> &Arc<SceneDescription> {
        self.begin(name);
        self.current = Arc::new(next);
        self.commit();
        &self.current
    }

    /// A step of one description in which things have other names and nothing else is different.
    pub fn record_naming(
        &mut self,
        name: impl Into<String>,
        next: SceneDescription,
    ) -> &Arc<SceneDescription> {
        self.begin(name);
        self.current = Arc::new(next);
        if let Some(step) = &mut self.open {
            step.is_naming = true;
        }
        self.commit();
        &self.current
    }

    /// Whether [`undo`](Self::undo) would give things other names and change nothing else.
    #[must_use]
    pub fn undoes_naming(&self) -> bool {
        self.open.as_ref().or_else(|| self.past.back()).is_some_and(|step| step.is_naming)
    }

    /// Whether [`redo`](Self::redo) would give things other names and change nothing else.
    #[must_use]
    pub fn redoes_naming(&self) -> bool {
        self.future.last().is_some_and(|step| step.is_naming)
    }

    /// Takes the last step back, one under way included. Its name, or `None` if there is none.
    pub fn undo(&mut self) -> Option<String> {
        self.commit();
        let Step { name, description, is_naming } = self.past.pop_back()?;
        let after = std::mem::replace(&mut self.current, description);
        self.future.push(Step { name: name.clone(), description: after, is_naming });
        Some(name)
    }

    /// Takes the last undone step again. Its name, or `None` if there is none.
    pub fn redo(&mut self) -> Option<String> {
        self.commit();
        let Step { name, description, is_naming } = self.future.pop()?;
        let before = std::mem::replace(&mut self.current, description);
        self.past.push_back(Step { name: name.clone(), description: before, is_naming });
        Some(name)
    }

    /// The step that [`undo`](Self::undo) would take back.
    #[must_use]
    pub fn undo_name(&self) -> Option<&str> {
        self.open.as_ref().or_else(|| self.past.back()).map(|s| s.name.as_str())
    }

    /// The step that [`redo`](Self::redo) would take again.
    #[must_use]
    pub fn redo_name(&self) -> Option<&str> {
        self.future.last().map(|s| s.name.as_str())
    }

    /// How many steps can be undone.
    #[must_use]
    pub fn len(&self) -> usize {
        self.past.len()
    }

    /// Whether no step can be undone.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.past.is_empty()
    }

    /// Says that the current description is on the disk.
    pub fn mark_saved(&mut self) {
        self.saved = Arc::clone(&self.current);
    }

    /// Whether the current description is another than that opened or saved last.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        !Arc::ptr_eq(&self.saved, &self.current)
    }
}
