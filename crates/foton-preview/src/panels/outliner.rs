//! The list of all shapes, lights and cameras: selecting, hiding, renaming, copying, deleting and adding them.

use egui::{Key, Ui};
use foton_edit::{Item, NewThing, Target};
use foton_session::engine::{Command, SceneEdit};

use super::actions;
use super::widgets::tight;
use crate::editing::Renaming;
use crate::files::{FileDialog, MESHES};
use crate::state::{DialogPurpose, State};

/// The list is at most so high, in points; what does not fit is scrolled to.
const HEIGHT: f32 = 210.0;

/// A line of the list.
enum Row<'a> {
    Heading(&'static str),
    Item(&'a Item),
}

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    let Some(frame) = &state.frame else { return };
    let (contents, camera) = (frame.scene.contents.clone(), frame.settings.sensor);
    let selected = frame.selection.as_ref().map(|s| s.target);
    buttons(ui, state);
    let rows = rows(&contents);
    let height = ui.spacing().interact_size.y;
    let area = egui::ScrollArea::vertical().id_salt("outliner").max_height(HEIGHT).auto_shrink([false, true]);
    area.show_rows(ui, height, rows.len(), |ui, range| {
        for row in &rows[range] {
            match row {
                Row::Heading(text) => {
                    ui.add(egui::Label::new(egui::RichText::new(*text).strong()).selectable(false));
                }
                Row::Item(item) => {
                    let is_active = item.target == Target::Sensor(camera);
                    line(ui, state, item, selected == Some(item.target), is_active);
                }
            }
        }
    });
}

fn rows(contents: &[Item]) -> Vec<Row<'_>> {
    let is_camera = |item: &&Item| matches!(item.target, Target::Sensor(_));
    let groups: [(&str, Vec<&Item>); 3] = [
        ("Shapes", contents.iter().filter(|i| !i.is_light && !is_camera(i)).collect()),
        ("Lights", contents.iter().filter(|i| i.is_light).collect()),
        ("Cameras", contents.iter().filter(is_camera).collect()),
    ];
    let filled = groups.into_iter().filter(|(_, items)| !items.is_empty());
    filled
        .flat_map(|(heading, items)| {
            std::iter::once(Row::Heading(heading)).chain(items.into_iter().map(Row::Item))
        })
        .collect()
}

/// What a button does.
type Act = fn(&mut State);

/// What can be done to the list and to what is selected in it.
fn buttons(ui: &mut Ui, state: &mut State) {
    ui.horizontal(|ui| {
        tight(ui);
        let add = ui.menu_button("Add", |ui| add_menu(ui, state));
        add.response.on_hover_text("Puts a shape or a light where the camera looks");
        let is_selected = actions::selected(state).is_some();
        let all: [(&str, &str, Act); 3] = [
            ("Rename", "Another name for what is selected (F2)", actions::rename),
            ("Duplicate", "A copy of what is selected (Ctrl+D)", actions::duplicate),
            ("Delete", "Takes what is selected out of the scene (Del)", actions::delete),
        ];
        for (label, help, act) in all {
            if ui.add_enabled(is_selected, egui::Button::new(label)).on_hover_text(help).clicked() {
                act(state);
            }
        }
    });
}

fn add_menu(ui: &mut Ui, state: &mut State) {
    for thing in NewThing::ALL {
        if thing == NewThing::AreaLight {
            if ui.button("Mesh from a file…").clicked() {
                let folder = state.preferences.scene_folder.clone();
                state.dialog = Some((DialogPurpose::ImportMesh, FileDialog::open(&folder, MESHES)));
            }
            ui.separator();
        }
        if ui.button(thing.name()).clicked() {
            state.ask(Command::Edit(SceneEdit::Add(thing)));
        }
    }
}

fn line(ui: &mut Ui, state: &mut State, item: &Item, is_selected: bool, is_active: bool) {
    if state.editing.renaming.as_ref().is_some_and(|r| r.target == item.target) {
        return rename(ui, state);
    }
    ui.horizontal(|ui| {
        eye(ui, state, item);
        let mut text = egui::RichText::new(if is_active {
            format!("{} (in use)", item.name)
        } else {
            item.name.clone()
        });
        if item.is_hidden {
            text = text.weak().italics();
        }
        let row = ui.add(egui::Button::selectable(is_selected, text).truncate());
        let spoken = format!("{}, {}{}", item.name, item.kind, if item.is_hidden { ", hidden" } else { "" });
        let enabled = ui.is_enabled();
        row.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, enabled, is_selected, &spoken));
        let row = row.on_hover_text(&item.kind);
        state.place(format!("row {}", item.name), &row);
        if row.clicked() && !is_selected {
            state.ask(Command::Select(Some(item.target)));
        }
        if row.double_clicked() {
            state.editing.renaming = Some(Renaming::of(item));
        }
        row.context_menu(|ui| item_menu(ui, state, item));
    });
}

/// The switch that hides a shape or a light; cameras have none, but its place.
fn eye(ui: &mut Ui, state: &mut State, item: &Item) {
    let size = egui::vec2(22.0, ui.spacing().interact_size.y);
    if matches!(item.target, Target::Sensor(_)) {
        ui.allocate_space(size);
        return;
    }
    let (icon, verb) = if item.is_hidden { ("🚫", "Show") } else { ("👁", "Hide") };
    let button = ui.add_sized(size, egui::Button::new(icon).frame(false));
    let (enabled, spoken) = (ui.is_enabled(), format!("{verb} {}", item.name));
    button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, enabled, &spoken));
    if button.on_hover_text(spoken.as_str()).clicked() {
        let hide = !item.is_hidden;
        state.ask(Command::Edit(SceneEdit::Hide { target: item.target, hide }));
    }
}

fn item_menu(ui: &mut Ui, state: &mut State, item: &Item) {
    if ui.button("Rename").clicked() {
        state.editing.renaming = Some(Renaming::of(item));
    }
    if ui.button("Duplicate").clicked() {
        state.ask(Command::Edit(SceneEdit::Duplicate(item.target)));
    }
    if ui.button("Delete").clicked() {
        state.ask(Command::Edit(SceneEdit::Delete(item.target)));
    }
}

/// The field in which a name is typed: Enter or leaving it takes the name, Esc leaves the old one.
fn rename(ui: &mut Ui, state: &mut State) {
    let Some(mut draft) = state.editing.renaming.take() else { return };
    let field = egui::TextEdit::singleline(&mut draft.text).desired_width(f32::INFINITY);
    let field = ui.add(field);
    let (enabled, text) = (ui.is_enabled(), draft.text.clone());
    field.widget_info(|| {
        let mut info = egui::WidgetInfo::text_edit(enabled, &text, &text, "");
        info.label = Some("Name".to_owned());
        info
    });
    if std::mem::take(&mut draft.wants_focus) {
        field.request_focus();
        state.editing.renaming = Some(draft);
        return;
    }
    if !field.lost_focus() {
        state.editing.renaming = Some(draft);
        return;
    }
    let name = draft.text.trim().to_owned();
    if !ui.input(|i| i.key_pressed(Key::Escape)) && !name.is_empty() && name != draft.before {
        state.ask(Command::Edit(SceneEdit::Rename { target: draft.target, name }));
    }
}
