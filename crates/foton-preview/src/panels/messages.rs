//! Short messages in a corner of the window. Notices go by themselves, errors are closed.

use crate::message::{MESSAGE_SECONDS, Tone};
use crate::state::State;

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
            ui.set_max_width(460.0);
            for (i, message) in state.messages.iter().enumerate().rev().take(5) {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.horizontal_wrapped(|ui| {
                        let times = if message.times > 1 {
                            format!(" ({} times)", message.times)
                        } else {
                            String::new()
                        };
                        let text = egui::RichText::new(format!("{}{times}", message.text));
                        let colour = ui.visuals().error_fg_color;
                        ui.label(if message.tone == Tone::Error { text.color(colour) } else { text });
                        if message.tone == Tone::Error && ui.small_button("Dismiss").clicked() {
                            closed = Some(i);
                        }
                    });
                });
            }
        },
    );
    if let Some(i) = closed {
        state.messages.remove(i);
    }
}
