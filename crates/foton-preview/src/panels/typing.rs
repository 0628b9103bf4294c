//! Whether keys belong to what someone types, or are shortcuts.

use egui::{Context, Id, Key};

use crate::state::State;

fn mark() -> Id {
    Id::unique("typing at a disabled field")
}

/// From a click on a disabled field on, keys are no shortcuts until another click, Enter, Tab or Esc: whoever types means that
/// field.
pub(super) fn rest_until_a_click(ctx: &Context) {
    ctx.data_mut(|d| d.insert_temp(mark(), true));
}

/// Looks, at the beginning of a frame, whether someone types.
pub(super) fn is_under_way(ctx: &Context, state: &State) -> bool {
    let at_nothing = ctx.data(|d| d.get_temp::<bool>(mark())).unwrap_or_default();
    let ends = |i: &egui::InputState| {
        i.pointer.any_pressed()
            || [Key::Escape, Key::Enter, Key::Tab].into_iter().any(|key| i.key_pressed(key))
    };
    if at_nothing && ctx.input(ends) {
        ctx.data_mut(|d| d.remove::<bool>(mark()));
    }
    // Esc takes the focus before any panel is asked, and the field that had it gives its text up.
    ctx.text_edit_focused() || state.is_typing || at_nothing
}
