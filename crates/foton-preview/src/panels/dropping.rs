//! What is said while a file is held over the window: that it may be let go, and what comes of it.

/// Shows it over the canvas.
pub(super) fn show(ctx: &egui::Context, canvas: egui::Rect) {
    // Of several, the last one is opened.
    let Some(name) = ctx.input(|i| i.raw.hovered_files.last().map(name)) else { return };
    let area = egui::Area::new(egui::Id::unique("dropping")).order(egui::Order::Foreground);
    area.fixed_pos(canvas.center()).pivot(egui::Align2::CENTER_CENTER).interactable(false).show(ctx, |ui| {
        let stroke = egui::Stroke::new(3.0, ui.visuals().selection.bg_fill);
        let painter = ui.painter().with_clip_rect(canvas);
        painter.rect_stroke(canvas.shrink(4.0), 6.0, stroke, egui::StrokeKind::Inside);
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_max_width(canvas.width() - 80.0);
            ui.heading(format!("Drop to open {name}"));
        });
    });
}

fn name(file: &egui::HoveredFile) -> String {
    let path = file.path.as_deref();
    path.and_then(|p| p.file_name()).map_or_else(|| "it".to_owned(), |n| n.to_string_lossy().into_owned())
}
