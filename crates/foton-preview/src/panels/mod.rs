//! The panels: pure functions of the window's state. What they ask for goes into its outbox.

mod actions;
mod camera;
mod canvas;
mod convergence;
mod diagnostics;
mod dot_legend;
mod dropping;
mod exposure;
mod fields;
mod figures;
mod film_place;
mod gallery;
mod gizmo;
mod help;
mod hint;
mod histogram;
mod history;
mod icons;
mod inspector;
mod keys;
mod legend;
mod live;
mod material;
mod menu;
mod messages;
mod number;
mod opening;
mod optional;
mod outliner;
mod output;
mod overlay;
mod pixel_values;
mod pointer;
mod presets;
mod region;
mod setup;
mod slider;
mod status;
mod text;
mod toolbar;
mod tools;
mod typing;
mod unsaved;
mod views;
mod warnings;
mod widgets;

#[cfg(test)]
mod tests;

use foton_session::engine::{Command, SceneEdit, ViewMode};

use crate::files::Outcome;
use crate::state::{DialogPurpose, State};
use widgets::{as_wide_as_seen, section, within};

/// Height of the menu bar in points.
const MENU: f32 = 26.0;

/// Height of the toolbar in points.
const TOOLBAR: f32 = 30.0;

/// Height of the line at the bottom in points.
const STATUS: f32 = 26.0;

/// Height of the strip of kept passes in points.
const HISTORY: f32 = 148.0;

/// Widths of the panels at the sides in points, left and right; they go by the window alone.
const WIDTHS: [f32; 2] = [264.0, 272.0];

/// The same in a window of less than [`NARROW`].
const NARROW_WIDTHS: [f32; 2] = [236.0, 236.0];

/// Share of the right panel's height that convergence and diagnostics take at most beside a selection, and without one.
const LOWER: f32 = 0.5;
const LOWER_ALONE: f32 = 0.9;

/// Points between the two parts of the right panel.
const GAP: f32 = 8.0;

/// Width of a window in points.
const NARROW: f32 = 880.0;

/// What the window is cleared to before [`show`] is drawn over it.
pub(crate) fn ground(visuals: &egui::Visuals) -> egui::Color32 {
    visuals.panel_fill
}

/// Everything in the window, over a [`ground`].
pub(crate) fn show(ui: &mut egui::Ui, state: &mut State) {
    state.places.clear();
    state.tell_look();
    if !views::is_there(state.view, state) {
        // The render is by another method now.
        state.choose_view(ViewMode::Radiance);
    }
    if ui.input(|i| i.pointer.any_pressed()) {
        state.editing.is_press_spent = egui::Popup::is_any_open(ui.ctx());
    }
    // Screen readers say a window's name first.
    ui.ctx().accesskit_node_builder(egui::accesskit_root_id(), |window| window.set_label("foton"));
    keys::obey(ui, state);
    // The window is cleared to the panels' colour (see `ground`), so that they need not be filled: on a software adapter egui's
    // shader takes some 60 ns of a core for each pixel, which makes fills the most of a frame.
    let frame = egui::Frame::side_top_panel(ui.style()).fill(egui::Color32::TRANSPARENT);
    let bar = frame.inner_margin(egui::Margin::symmetric(8, 2));
    egui::Panel::top("menu")
        .frame(bar)
        .exact_size(MENU)
        .show(ui, |ui| within(ui, |ui| menu::show(ui, state)));
    egui::Panel::top("toolbar")
        .frame(bar)
        .exact_size(TOOLBAR)
        .show(ui, |ui| within(ui, |ui| toolbar::show(ui, state)));
    egui::Panel::bottom("status")
        .frame(bar)
        .exact_size(STATUS)
        .show(ui, |ui| within(ui, |ui| status::show(ui, state)));
    if state.looking.show_history && !state.hides_panels {
        let strip = egui::Panel::bottom("history").frame(frame).resizable(false).exact_size(HISTORY);
        strip.show(ui, |ui| within(ui, |ui| history::show(ui, state)));
    }
    if !state.hides_panels {
        // Of constant width: the picture stays where it is, whatever they show.
        let widths = if ui.available_width() < NARROW { NARROW_WIDTHS } else { WIDTHS };
        let side = |panel: egui::Panel, width: f32| panel.frame(frame).resizable(false).exact_size(width);
        side(egui::Panel::left("left"), widths[0]).show(ui, |ui| within(ui, |ui| left(ui, state)));
        side(egui::Panel::right("right"), widths[1]).show(ui, |ui| within(ui, |ui| right(ui, state)));
    }
    let canvas =
        egui::CentralPanel::default().frame(egui::Frame::NONE).show(ui, |ui| canvas::show(ui, state));
    histogram::show(ui.ctx(), state, canvas.response.rect);
    messages::show(ui.ctx(), state);
    help::show(ui.ctx(), state);
    unsaved::show(ui.ctx(), state);
    dialog(ui.ctx(), state);
    dropping::show(ui.ctx(), canvas.response.rect);
    state.is_typing = ui.ctx().text_edit_focused();
    state.has_focused_control = ui.memory(|m| m.focused()).is_some_and(|id| Some(id) != state.canvas);
}

/// The panel at the left: what is in the scene, and the settings.
fn left(ui: &mut egui::Ui, state: &mut State) {
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        if state.frame.is_none() {
            ui.label("No scene yet: open one, or drop a file here.");
            return;
        }
        section(ui, "Scene", true, |ui| outliner::show(ui, state));
        section(ui, "Live", true, |ui| live::show(ui, state));
        section(ui, "Camera", true, |ui| camera::show(ui, state));
        section(ui, "Settings (restart)", true, |ui| setup::show(ui, state));
        section(ui, "Output", true, |ui| output::show(ui, state));
    });
}

/// The panel at the right: the selection, and below it how the render does.
fn right(ui: &mut egui::Ui, state: &mut State) {
    let all = ui.available_rect_before_wrap();
    // As high as what is in it was in the last frame, if that leaves room for the selection.
    let id = egui::Id::unique("height of the convergence panel");
    let is_selected = state.frame.as_ref().is_some_and(|f| f.selection.is_some());
    let most = all.height() * if is_selected { LOWER } else { LOWER_ALONE };
    let height: f32 = ui.data(|d| d.get_temp(id)).unwrap_or(most);
    let split = all.bottom() - height.min(most);
    let upper = egui::UiBuilder::new().max_rect(all.with_max_y(split - GAP));
    egui::ScrollArea::vertical()
        .id_salt("selection")
        .auto_shrink(false)
        .show(&mut ui.new_child(upper), |ui| as_wide_as_seen(ui, |ui| inspector::show(ui, state)));
    ui.painter().hline(all.x_range(), split - 0.5 * GAP, ui.visuals().widgets.noninteractive.bg_stroke);
    let lower = egui::UiBuilder::new().max_rect(all.with_min_y(split));
    let shown = egui::ScrollArea::vertical().id_salt("progress").auto_shrink(false);
    let shown = shown.show(&mut ui.new_child(lower), |ui| {
        section(ui, "Convergence", true, |ui| convergence::show(ui, state));
        let header = section(ui, "Diagnostics", false, |ui| diagnostics::show(ui, state));
        state.place("diagnostics", &header);
    });
    if shown.content_size.y != height {
        ui.data_mut(|d| d.insert_temp(id, shown.content_size.y));
        ui.request_repaint();
    }
}

fn dialog(ctx: &egui::Context, state: &mut State) {
    let Some((purpose, mut dialog)) = state.dialog.take() else { return };
    match dialog.show(ctx) {
        Outcome::Browsing => state.dialog = Some((purpose, dialog)),
        Outcome::Cancelled => state.after_save = None,
        Outcome::Chosen(path) => {
            if let Some(folder) = path.parent() {
                state.preferences.scene_folder = folder.to_owned();
            }
            match purpose {
                DialogPurpose::OpenScene => state.open(path),
                DialogPurpose::SaveScene => state.ask(Command::SaveScene(path)),
                DialogPurpose::ImportMesh => state.ask(Command::Edit(SceneEdit::Import(path))),
                DialogPurpose::KeepCheckpoint => state.ask(Command::KeepCheckpoint(path)),
                DialogPurpose::ResumeCheckpoint => state.ask(Command::ResumeCheckpoint(path)),
            }
        }
    }
}
