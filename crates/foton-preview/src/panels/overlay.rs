//! What is drawn over the picture: the outline of what is chosen, lights, photons, the disc under the pointer.

use egui::{Color32, Pos2, Shape, Stroke};
use foton_edit::Segment;
use foton_session::engine::{Dot, Frame};

use super::dot_legend;
use super::film_place::Film;
use crate::looking::Compare;
use crate::state::State;

const CHOSEN: Color32 = Color32::from_rgb(255, 170, 40);
const LIGHT: Color32 = Color32::from_rgb(255, 225, 120);
const DISC: Color32 = Color32::from_rgb(120, 220, 255);

pub(super) fn draw(painter: &egui::Painter, state: &State, frame: &Frame, film: Film) {
    if state.show_photons {
        dots(painter, &frame.dots, film, 1.2);
    }
    for segment in &frame.lights {
        line(painter, segment, film, Stroke::new(1.2, LIGHT));
    }
    if let Some(selection) = &frame.selection {
        for segment in &selection.outline {
            line(painter, segment, film, Stroke::new(1.6, CHOSEN));
        }
    }
    if let Some(probe) = frame.probe.as_ref().filter(|p| Some(p.pixel) == state.probed) {
        let corners: Vec<Pos2> = probe.disc.iter().map(|&c| film.to_points(c)).collect();
        if corners.len() > 2 {
            painter.add(Shape::closed_line(corners, Stroke::new(1.2, DISC)));
        }
        dots(painter, &probe.photons, film, 1.6);
    }
    if let Some(pinned) = state.pinned.as_ref().filter(|_| state.looking.compare == Compare::Wipe) {
        let x = film.rect.left() + film.rect.width() * state.wipe;
        let font = egui::FontId::proportional(12.0);
        let at = Pos2::new(x + 8.0, film.rect.bottom() - 10.0);
        painter.text(at, egui::Align2::LEFT_BOTTOM, &pinned.label, font.clone(), Color32::WHITE);
        let now = format!("pass {}", frame.stats.passes);
        let at = Pos2::new(x - 8.0, film.rect.bottom() - 10.0);
        painter.text(at, egui::Align2::RIGHT_BOTTOM, now, font, Color32::WHITE);
    }
}

fn line(painter: &egui::Painter, segment: &Segment, film: Film, stroke: Stroke) {
    painter.line_segment(segment.map(|end| film.to_points(end)), stroke);
}

fn dots(painter: &egui::Painter, dots: &[Dot], film: Film, radius: f32) {
    let inside =
        dots.iter().map(|d| (film.to_points(d.film), d.class)).filter(|(at, _)| film.rect.contains(*at));
    let mut mesh = egui::Mesh::default();
    for (at, class) in inside {
        mesh.add_colored_rect(
            egui::Rect::from_center_size(at, egui::Vec2::splat(2.0 * radius)),
            dot_legend::colour(class),
        );
    }
    painter.add(mesh);
}
