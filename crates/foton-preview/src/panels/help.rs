//! The overlay of keys and gestures.

use crate::state::State;

const KEYS: [(&str, &str); 34] = [
    ("Drag", "orbit the camera"),
    ("Shift+drag, right drag", "pan the camera"),
    ("Wheel", "camera nearer, farther"),
    ("W A S D Q E", "fly"),
    ("H", "reset the camera"),
    ("Click", "select a shape or light"),
    ("Drag a handle", "move, rotate or scale what is selected; Ctrl: round steps"),
    ("M, R, X", "handles that move, rotate, scale"),
    ("N", "round steps on and off"),
    ("F2, Ctrl+D, Del", "rename, duplicate, delete what is selected"),
    ("Arrow keys, Page up, Page down", "move it a little"),
    ("Ctrl+Z, Ctrl+Shift+Z", "undo, redo"),
    ("Esc", "cancel, deselect, close"),
    ("Ctrl+wheel, Ctrl+drag", "zoom and move the image"),
    ("F, double click", "fit the image"),
    ("Space", "pause, resume"),
    (".", "render one pass"),
    ("Ctrl+R", "restart"),
    ("P", "snapshot: EXR and PNG"),
    ("O", "photons as dots"),
    ("V", "paths of the photons that lit the pixel under the pointer"),
    ("K", "pin this pass, compare"),
    ("B", "keep this pass in the history"),
    ("T", "the history: compare, return, films"),
    ("L", "histogram"),
    ("C", "mark clipped and black pixels"),
    ("1 … 5", "radiance, luminance, radius, photons found, unlit hit points"),
    ("Enter, Esc in a field", "commit what was typed, give it up"),
    ("Tab", "hide or show the panels"),
    ("F6, Shift+Tab", "from the picture to the controls, and back"),
    ("Ctrl+O", "open a scene"),
    ("Ctrl+S", "save the edited scene"),
    ("Ctrl+Q", "close the window"),
    ("?", "this list"),
];

pub(super) fn show(ctx: &egui::Context, state: &mut State) {
    if !state.show_help {
        return;
    }
    let mut open = true;
    let window = egui::Window::new("Keys and gestures").open(&mut open).resizable(false).collapsible(false);
    // What does not fit into a small window is scrolled to.
    let height = ctx.content_rect().height() - 90.0;
    window.anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]).show(ctx, |ui| {
        egui::ScrollArea::vertical().max_height(height).show(ui, |ui| {
            egui::Grid::new("keys").num_columns(2).spacing([24.0, 4.0]).show(ui, |ui| {
                for (keys, what) in KEYS {
                    ui.strong(keys);
                    ui.label(what);
                    ui.end_row();
                }
            });
        });
    });
    state.show_help = open;
}
