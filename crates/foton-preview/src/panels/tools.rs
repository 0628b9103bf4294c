//! What handles do to what is selected, and whether in round steps.

use foton_edit::Tool;
use foton_session::engine::Selection;

use super::gizmo;
use crate::state::State;

/// The tools for what is selected; those that can do nothing to it are disabled.
pub(super) fn show(ui: &mut egui::Ui, state: &mut State, selection: &Selection) {
    ui.horizontal_wrapped(|ui| {
        let now = selection.gizmo.as_ref().map(|gizmo| gizmo::tool(state, gizmo));
        for (tool, help) in [
            (Tool::Move, "Arrows move along an axis, squares in a plane, the middle across the view (M)"),
            (Tool::Rotate, "Rings turn it about an axis of the world (R)"),
            (Tool::Scale, "Boxes scale it along its own axes, the middle evenly (X)"),
        ] {
            let can = selection.gizmo.as_ref().is_some_and(|gizmo| gizmo.has(tool));
            let button = ui.add_enabled(can, egui::Button::selectable(now == Some(tool), tool.name()));
            if button.on_hover_text(help).clicked() {
                state.editing.tool = tool;
            }
        }
        let snap = ui.toggle_value(&mut state.editing.snap, "Snap");
        snap.on_hover_text("Drags go in round steps, 15° and tenths (N); Ctrl does the other thing");
        if selection.inspection.can_aim {
            let aim = ui.toggle_value(&mut state.editing.aiming, "Aim at a point");
            aim.on_hover_text("The next click in the picture says where it shines; Esc leaves it");
        }
    });
}
