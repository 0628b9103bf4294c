//! The material of what is selected: who shares it, and another one in its place, under a name of its own.

use egui::{Key, Ui};
use foton_edit::Target;
use foton_session::engine::{Command, SceneEdit, Selection};

use super::presets;
use crate::state::State;

pub(super) fn show(ui: &mut Ui, state: &mut State, selection: &Selection) {
    let Some(material) = &selection.inspection.material else { return };
    if matches!(selection.target, Target::Shape(_)) && selection.inspection.is_light {
        // What a lamp reflects is of no account beside what it emits.
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.add(egui::Label::new(format!("Material {}", material.name)).truncate());
        if material.shapes > 1 {
            ui.weak(format!("shared by {} shapes", material.shapes));
            let own = ui.button("Make its own").on_hover_text("Edits then change this shape alone");
            if own.clicked() {
                state.ask(Command::Edit(SceneEdit::OwnMaterial));
            }
        }
        presets::menu(ui, state);
    });
    ask(ui, state, selection.target, material.shapes);
}

/// The question for the name; Enter takes it, Esc leaves the old material.
fn ask(ui: &mut Ui, state: &mut State, target: Target, shapes: usize) {
    let Some(mut draft) = state.editing.remaking.take().filter(|draft| draft.target == target) else {
        return;
    };
    let answer = egui::Frame::group(ui.style()).show(ui, |ui| {
        ui.label("Name of the new material");
        let field = ui.add(egui::TextEdit::singleline(&mut draft.name).desired_width(f32::INFINITY));
        let (enabled, text) = (ui.is_enabled(), draft.name.clone());
        field.widget_info(|| {
            let mut info = egui::WidgetInfo::text_edit(enabled, &text, &text, "");
            info.label = Some("Name of the new material".to_owned());
            info
        });
        if std::mem::take(&mut draft.wants_focus) {
            field.request_focus();
        }
        if shapes > 1 {
            ui.checkbox(&mut draft.all, format!("For all {shapes} shapes that share it"));
        }
        let pressed = |key| field.lost_focus() && ui.input(|i| i.key_pressed(key));
        let (enter, escape) = (pressed(Key::Enter), pressed(Key::Escape));
        ui.horizontal(|ui| {
            let apply = ui.add_enabled(!draft.name.trim().is_empty(), egui::Button::new("Apply"));
            let cancel = ui.button("Cancel");
            (apply.clicked() || (enter && apply.enabled()), cancel.clicked() || escape)
        })
        .inner
    });
    match answer.inner {
        (true, _) => {
            let (make, name, all) = (draft.make, draft.name.trim().to_owned(), draft.all);
            state.ask(Command::Edit(SceneEdit::Remake { make, name, all }));
        }
        (_, true) => {}
        _ => state.editing.remaking = Some(draft),
    }
}
