//! What a person should know of the render and of the scene: all that the command line warns of, for as long as it is so.

use egui::Ui;
use foton_session::findings::Finding;

use crate::state::State;

pub(super) fn show(ui: &mut Ui, state: &State) {
    let Some(frame) = &state.frame else { return };
    for finding in &*frame.stats.findings {
        say(ui, finding);
    }
    let of_scene = &frame.scene.warnings;
    if of_scene.is_empty() {
        return;
    }
    let count = of_scene.len();
    let name = if count == 1 {
        "A warning in the scene".to_owned()
    } else {
        format!("{count} warnings in the scene")
    };
    egui::CollapsingHeader::new(name).id_salt("scene warnings").show(ui, |ui| {
        for warning in of_scene.iter() {
            ui.add(egui::Label::new(foton_input::printable(warning)).wrap());
        }
    });
}

fn say(ui: &mut Ui, finding: &Finding) {
    let text = egui::RichText::new(foton_input::printable(&finding.text));
    let text = if finding.kind.is_note() { text.weak() } else { text.color(ui.visuals().warn_fg_color) };
    ui.add(egui::Label::new(text).wrap());
}
