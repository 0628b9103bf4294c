//! The strip of passes that were kept: each with its picture, to compare with, to return to, and to make films of.

use std::num::NonZeroU32;

use egui::{Color32, ColorImage, Sense, Stroke, StrokeKind, TextureOptions, Vec2};
use foton_film::read_exr;
use foton_session::engine::{Command, HistoryEntry, Picture};

use crate::looking::Compare;
use crate::state::{Pinned, State};

/// Height of a thumbnail in points.
const HEIGHT: f32 = 72.0;

/// Steps and passes of a turntable that can be asked for.
const STEPS: std::ops::RangeInclusive<u64> = 2..=720;
const PASSES: std::ops::RangeInclusive<u64> = 1..=1_000_000;

/// The strip, if it is wanted.
pub(super) fn show(ui: &mut egui::Ui, state: &mut State) {
    let Some(frame) = &state.frame else { return };
    let (entries, turning) = (frame.history.clone(), frame.turntable);
    ui.horizontal(|ui| {
        buttons(ui, state, entries.last());
        ui.separator();
        turntable(ui, state, turning);
    });
    if entries.is_empty() {
        ui.label("Snapshots appear here, and passes that you keep: compare with them, or go on from them.");
        return;
    }
    state.looking.thumbnails.retain(|(id, _)| entries.iter().any(|entry| entry.id == *id));
    egui::ScrollArea::horizontal().id_salt("strip").stick_to_right(true).show(ui, |ui| {
        ui.horizontal(|ui| entries.iter().for_each(|entry| card(ui, state, entry)));
    });
}

fn buttons(ui: &mut egui::Ui, state: &mut State, last: Option<&HistoryEntry>) {
    let keep = ui.button("Keep this pass").on_hover_text(
        "Adds the pass to the history, with its state, as every snapshot does (B). The history takes 2 GB of disk at most and ends \
         with the window",
    );
    state.place("keep", &keep);
    if keep.clicked() {
        state.ask(Command::Remember);
    }
    let film = ui.add_enabled(last.is_some(), egui::Button::new("Export film")).on_hover_text(
        "Writes the kept passes of this render as numbered PNGs into a new folder among the snapshots, and as an MP4 where ffmpeg \
         is installed",
    );
    if let Some(last) = last.filter(|_| film.clicked()) {
        let folder = state.snapshot_folder();
        state.ask(Command::ExportFilm { of: last.id, folder });
    }
    ui.separator();
    ui.label("Compare by");
    for (compare, name, help) in [
        (
            Compare::Wipe,
            "wipe",
            "The present picture left of a line that can be dragged, the other right of it",
        ),
        (Compare::Difference, "difference", "How far the luminance of the two is apart, in false colours"),
    ] {
        ui.selectable_value(&mut state.looking.compare, compare, name).on_hover_text(help);
    }
}

fn turntable(ui: &mut egui::Ui, state: &mut State, turning: Option<[u32; 2]>) {
    if let Some([done, all]) = turning {
        ui.label(format!("Turntable: {done} of {all} frames"));
        if ui.button("End turntable").clicked() {
            state.ask(Command::EndTurntable);
        }
        return;
    }
    let begin = ui.button("Turntable").on_hover_text(
        "Turns the camera once around what it looks at, and writes a PNG of each step into a new folder among the snapshots; an \
         MP4 too where ffmpeg is installed. Moving the camera or an edit ends it",
    );
    let [steps, passes] = &mut state.looking.turntable;
    let label = ui.label("steps");
    ui.add(egui::DragValue::new(steps).range(STEPS)).labelled_by(label.id);
    let label = ui.label("passes each");
    ui.add(egui::DragValue::new(passes).range(PASSES)).labelled_by(label.id);
    if begin.clicked() {
        let [steps, passes] = state.looking.turntable;
        let steps = u32::try_from(steps).ok().and_then(NonZeroU32::new).unwrap_or(NonZeroU32::MIN);
        let folder = state.snapshot_folder();
        state.ask(Command::Turntable { steps, passes, folder });
    }
}

fn card(ui: &mut egui::Ui, state: &mut State, entry: &HistoryEntry) {
    let texture = thumbnail(ui.ctx(), state, entry);
    let [width, height] = entry.thumbnail.size.map(|side| side as f32);
    let size = Vec2::new((HEIGHT * width / height.max(1.0)).clamp(32.0, 3.0 * HEIGHT), HEIGHT);
    let is_pinned = state.pinned.as_ref().is_some_and(|pinned| pinned.entry == Some(entry.id));
    ui.vertical(|ui| {
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        let name = format!("{} pass {}", entry.scene, entry.passes);
        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_pinned, &name));
        let whole = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
        ui.painter().image(texture, rect, whole, Color32::WHITE);
        if is_pinned || response.hovered() || response.has_focus() {
            let stroke = Stroke::new(2.0, ui.visuals().selection.bg_fill);
            ui.painter().rect_stroke(rect, 2.0, stroke, StrokeKind::Inside);
        }
        if response.on_hover_text(in_words(entry)).clicked() {
            toggle(state, entry);
        }
        ui.horizontal(|ui| {
            let error = entry.error.map_or_else(String::new, |error| format!(" · {:.1} %", 100.0 * error));
            ui.label(format!("pass {}{error}", entry.passes));
            let back = ui.small_button("Return").on_hover_text(
                "Goes on from this pass, with its scene, camera, settings and state (restart)",
            );
            if back.clicked() {
                state.ask(Command::ReturnTo(entry.id));
            }
        });
    });
}

fn in_words(entry: &HistoryEntry) -> String {
    let seconds = entry.elapsed.as_secs_f64();
    let error = entry.error.map_or_else(|| "not known".to_owned(), |error| format!("{:.2} %", 100.0 * error));
    format!(
        "{}: pass {}, {} photons, {seconds:.1} s, error {error}\n{}\nClick to compare with it",
        entry.scene,
        entry.passes,
        super::text::grouped(entry.photons),
        entry.settings
    )
}

/// The texture of an entry's picture, made once.
fn thumbnail(ctx: &egui::Context, state: &mut State, entry: &HistoryEntry) -> egui::TextureId {
    if let Some((_, texture)) = state.looking.thumbnails.iter().find(|(id, _)| *id == entry.id) {
        return texture.id();
    }
    let image = ColorImage::from_rgb(entry.thumbnail.size.map(|side| side as usize), &entry.thumbnail.rgb);
    let texture = ctx.load_texture(format!("history {}", entry.id), image, TextureOptions::LINEAR);
    let id = texture.id();
    state.looking.thumbnails.push((entry.id, texture));
    id
}

/// Compares with an entry, or no more.
fn toggle(state: &mut State, entry: &HistoryEntry) {
    if state.pinned.take_if(|pinned| pinned.entry == Some(entry.id)).is_some() {
        return;
    }
    if state.frame.as_ref().is_some_and(|frame| frame.window != entry.window) {
        return state.notice("That pass shows another part of the image, or an image of another size");
    }
    match read_exr(&entry.picture) {
        Ok((image, _)) => {
            let label = format!("pass {} of {}", entry.passes, entry.scene);
            let picture = Picture::Colour(std::sync::Arc::new(image));
            state.pinned = Some(Pinned { picture, label, entry: Some(entry.id) });
        }
        Err(error) => state.notice(format!("That pass cannot be shown yet: {error}")),
    }
}
