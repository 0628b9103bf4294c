//! What a person is in the middle of while editing the scene.

use foton_edit::{Handle, Item, Make, Target, Tool};

/// Tools, and what is under way.
#[derive(Clone, Debug, Default)]
pub(crate) struct Editing {
    /// What handles do.
    pub(crate) tool: Tool,
    /// Whether drags go in round steps; Ctrl does the other thing.
    pub(crate) snap: bool,
    /// Whether the next click aims the selected light.
    pub(crate) aiming: bool,
    /// Whether the next click focuses the lens.
    pub(crate) focusing: bool,
    /// Keys that are held to fly.
    pub(crate) flying: Vec<egui::Key>,
    /// The handle under the pointer, or the one that is dragged.
    pub(crate) handle: Option<Handle>,
    /// Whether the button went down to close a menu or a list: it does nothing else until it goes up.
    pub(crate) is_press_spent: bool,
    /// The name that is being typed.
    pub(crate) renaming: Option<Renaming>,
    /// The other material that is to have a name.
    pub(crate) remaking: Option<Remaking>,
}

/// A name that is being typed.
#[derive(Clone, Debug)]
pub(crate) struct Renaming {
    pub(crate) target: Target,
    pub(crate) before: String,
    pub(crate) text: String,
    /// The field takes the keyboard in the next frame.
    pub(crate) wants_focus: bool,
}

impl Renaming {
    pub(crate) fn of(item: &Item) -> Self {
        let (before, text) = (item.name.clone(), item.name.clone());
        Self { target: item.target, before, text, wants_focus: true }
    }
}

/// What the material of the selected shape is to become.
#[derive(Clone, Debug)]
pub(crate) struct Remaking {
    /// The shape that it is for.
    pub(crate) target: Target,
    pub(crate) make: Make,
    pub(crate) name: String,
    /// Whether all shapes that share the material get it.
    pub(crate) all: bool,
    /// The field takes the keyboard in the next frame.
    pub(crate) wants_focus: bool,
}

impl Remaking {
    pub(crate) fn new(target: Target, make: Make, name: &str) -> Self {
        let name = name.to_lowercase().replace(' ', "-");
        Self { target, make, name, all: false, wants_focus: true }
    }
}
