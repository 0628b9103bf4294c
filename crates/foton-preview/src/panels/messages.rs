//! Short messages in a corner of the window. Notices go by themselves, errors are closed.

use crate::message::{MESSAGE_SECONDS, Message, Tone};
use crate::state::State;

/// The most points that messages are wide, and those that show lines of a file.
const WIDTH: f32 = 460.0;
const WIDTH_OF_LINES: f32 = 760.0;

pub(super) fn show(ctx: &egui::Context, state: &mut State) {
    let now = ctx.input(|i| i.time);
    for message in &mut state.messages {
        message.since.get_or_insert(now);
    }
    let is_over = |since: Option<f64>| since.is_some_and(|s| now - s > MESSAGE_SECONDS);
    state.messages.retain(|m| m.tone == Tone::Error || !is_over(m.since));
    if state.messages.is_empty() {
        return;
    }
    ctx.request_repaint_after(std::time::Duration::from_secs_f64(0.5));
    let mut closed = None;
    egui::Area::new(egui::Id::unique("messages")).anchor(egui::Align2::RIGHT_BOTTOM, [-12.0, -40.0]).show(
        ctx,
        |ui| {
            let has_lines = state.messages.iter().any(|message| message.text.contains('\n'));
            ui.set_max_width(if has_lines {
                WIDTH_OF_LINES.min(0.9 * ctx.content_rect().width())
            } else {
                WIDTH
            });
            for (i, message) in state.messages.iter().enumerate().rev().take(5) {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    if show_one(ui, i, message) {
                        closed = Some(i);
                    }
                });
            }
        },
    );
    if let Some(i) = closed {
        state.messages.remove(i);
    }
}

/// Shows a message; whether it is to go.
fn show_one(ui: &mut egui::Ui, index: usize, message: &Message) -> bool {
    let times = if message.times > 1 { format!(" ({} times)", message.times) } else { String::new() };
    let is_error = message.tone == Tone::Error;
    let colour = is_error.then(|| ui.visuals().error_fg_color);
    if !message.text.contains('\n') {
        let shown = ui.horizontal_wrapped(|ui| {
            line(ui, &format!("{}{times}", message.text), colour);
            is_error && ui.small_button("Dismiss").clicked()
        });
        return shown.inner;
    }
    let height = 0.5 * ui.ctx().content_rect().height();
    let lines = egui::ScrollArea::both().id_salt(("message", index)).max_height(height);
    lines.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for text in message.text.lines() {
            line(ui, text, colour);
        }
        line(ui, &times, colour);
    });
    is_error && ui.small_button("Dismiss").clicked()
}

/// A line of a message; those of a file, and the marks below them, one letter below the other.
fn line(ui: &mut egui::Ui, text: &str, colour: Option<egui::Color32>) {
    if is_of_file(text) {
        ui.add(egui::Label::new(egui::RichText::new(text).monospace()).extend());
    } else if !text.is_empty() {
        let text = egui::RichText::new(text);
        ui.add(egui::Label::new(colour.map_or(text.clone(), |colour| text.color(colour))).wrap());
    }
}

/// Whether a line of a message shows one of a file, with its number, or what belongs to that.
fn is_of_file(text: &str) -> bool {
    let rest = text.trim_start().trim_start_matches(|c: char| c.is_ascii_digit()).trim_start();
    rest.starts_with("| ") || rest == "|" || rest.starts_with("= ")
}
