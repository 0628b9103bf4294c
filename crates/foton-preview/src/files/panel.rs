//! How the dialog looks and what its keys do: arrows select while the name is edited, Enter takes, Alt and up leaves the folder,
//! Escape closes.

use std::path::{Path, PathBuf};

use egui::{Align, Key, Layout, Modifiers, Ui, WidgetInfo};

use super::{FileDialog, Outcome, Purpose};

/// Wide enough for most names, in points.
const WIDTH: f32 = 520.0;

const LIST_HEIGHT: f32 = 260.0;

impl FileDialog {
    /// Draws the dialog over everything else and says what became of it.
    pub(crate) fn show(&mut self, ctx: &egui::Context) -> Outcome {
        let modal = egui::Modal::new(egui::Id::unique("file dialog")).show(ctx, |ui| self.ui(ui));
        match modal.inner {
            Outcome::Browsing if modal.should_close() => Outcome::Cancelled,
            outcome => outcome,
        }
    }

    fn ui(&mut self, ui: &mut Ui) -> Outcome {
        ui.set_width(WIDTH);
        ui.heading(match self.purpose {
            Purpose::Open => "Open",
            Purpose::Save => "Save as",
        });
        if ui.input_mut(|input| input.consume_key(Modifiers::ALT, Key::ArrowUp)) {
            self.leave();
        }
        self.breadcrumbs(ui);
        ui.separator();
        // Before the list, which scrolls to what was selected, but below it.
        let name_id = ui.scope_id().with("name");
        let moved = ui.memory(|memory| memory.has_focus(name_id)) && self.arrows(ui);
        let mut chosen = self.list_ui(ui, moved);
        ui.separator();
        chosen = chosen.or(self.name_ui(ui, name_id));
        if let Some(trouble) = &self.trouble {
            ui.colored_label(ui.visuals().warn_fg_color, trouble);
        }
        self.buttons(ui, chosen)
    }

    /// The folder and those above it, each a button, and one for the folder above.
    fn breadcrumbs(&mut self, ui: &mut Ui) {
        let mut target: Option<PathBuf> = None;
        ui.horizontal_wrapped(|ui| {
            let parent = self.folder.parent();
            let up = ui.add_enabled(parent.is_some(), egui::Button::new("Up"));
            if up.on_hover_text("The folder above (Alt + Up)").clicked() {
                target = parent.map(Path::to_path_buf);
            }
            let above: Vec<&Path> = self.folder.ancestors().collect();
            for folder in above.into_iter().rev() {
                let name = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy();
                let here = folder == self.folder;
                let crumb = ui.add(egui::Button::selectable(here, name.as_ref()));
                if crumb.on_hover_text(folder.to_string_lossy()).clicked() {
                    target = Some(folder.to_path_buf());
                }
            }
        });
        if let Some(folder) = target {
            self.enter(&folder);
        }
    }

    /// Moves the selection by the arrow keys; whether it moved.
    fn arrows(&mut self, ui: &Ui) -> bool {
        let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        let (down, up) = (pressed(Key::ArrowDown), pressed(Key::ArrowUp));
        if down != up {
            self.step(down);
        }
        down != up
    }

    /// The list; returns a file that was chosen in it.
    fn list_ui(&mut self, ui: &mut Ui, scroll_to_selected: bool) -> Option<PathBuf> {
        let row_height = ui.spacing().interact_size.y;
        let mut area = egui::ScrollArea::vertical().auto_shrink(false).max_height(LIST_HEIGHT);
        if let (true, Some(selected)) = (scroll_to_selected, self.selected) {
            let top = selected as f32 * (row_height + ui.spacing().item_spacing.y);
            area = area.vertical_scroll_offset((top - 0.5 * LIST_HEIGHT).max(0.0));
        }
        if self.entries.is_empty() {
            let nothing = match self.purpose {
                Purpose::Open => "Nothing here that can be opened",
                Purpose::Save => "No file here would be replaced",
            };
            ui.allocate_ui(egui::vec2(WIDTH, LIST_HEIGHT), |ui| {
                ui.centered_and_justified(|ui| ui.weak(nothing));
            });
            return None;
        }
        let (mut clicked, mut activated) = (None, None);
        area.show_rows(ui, row_height, self.entries.len(), |ui, rows| {
            for index in rows {
                let row = self.row(ui, index);
                if row.double_clicked() || row.has_focus() && ui.input(|input| input.key_pressed(Key::Enter))
                {
                    activated = Some(index);
                } else if row.clicked() {
                    clicked = Some(index);
                }
            }
        });
        if let Some(index) = clicked {
            self.select(index);
        }
        activated.and_then(|index| self.activate(index))
    }

    /// One line of the list, as wide as it.
    fn row(&self, ui: &mut Ui, index: usize) -> egui::Response {
        let entry = &self.entries[index];
        let selected = self.selected == Some(index);
        let (text, spoken) = if entry.is_folder {
            (format!("{}/", entry.name), format!("Folder {}", entry.name))
        } else {
            (entry.name.clone(), entry.name.clone())
        };
        let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        let layout = Layout::left_to_right(Align::Center).with_main_justify(true).with_main_align(Align::Min);
        let button = egui::Button::selectable(selected, text).truncate();
        let row = ui.allocate_ui_with_layout(size, layout, |ui| ui.add(button)).inner;
        let enabled = ui.is_enabled();
        row.widget_info(|| WidgetInfo::selected(egui::Role::Button, enabled, selected, &spoken));
        row
    }

    /// The name and which files are listed; returns a file that was chosen by Enter.
    fn name_ui(&mut self, ui: &mut Ui, id: egui::Id) -> Option<PathBuf> {
        let mut chosen = None;
        ui.horizontal(|ui| {
            let label = ui.label("Name");
            let edit = egui::TextEdit::singleline(&mut self.typed).id(id).desired_width(300.0);
            let edit = ui.add(edit.hint_text("a name or a path")).labelled_by(label.id);
            if std::mem::take(&mut self.wants_focus) {
                edit.request_focus();
            }
            if edit.changed() {
                self.replaces = None;
                self.trouble = None;
            }
            if edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
                chosen = self.submit();
                self.wants_focus = true;
            }
            let scenes =
                self.extensions.iter().map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(" ");
            let before = self.every_file;
            egui::ComboBox::from_id_salt("kinds")
                .selected_text(if before { "All files" } else { scenes.as_str() })
                .show_ui(ui, |ui| {
                    ui.selectable_value(&mut self.every_file, false, scenes.as_str());
                    ui.selectable_value(&mut self.every_file, true, "All files");
                })
                .response
                .on_hover_text("Which files are listed");
            if self.every_file != before {
                self.list();
            }
        });
        chosen
    }

    fn buttons(&mut self, ui: &mut Ui, chosen: Option<PathBuf>) -> Outcome {
        let take = match self.purpose {
            Purpose::Open => "Open",
            Purpose::Save if self.replaces.is_some() => "Replace",
            Purpose::Save => "Save",
        };
        let mut outcome = chosen.map_or(Outcome::Browsing, Outcome::Chosen);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button(take).clicked()
                && let Some(path) = self.submit()
            {
                outcome = Outcome::Chosen(path);
            }
            if ui.button("Cancel").clicked() {
                outcome = Outcome::Cancelled;
            }
        });
        outcome
    }
}
