//! What is drawn over the picture: the outline of what is chosen, lights, photons, the disc under the pointer.

use egui::{Color32, Pos2, Shape, Stroke};
use foton_edit::Segment;
use foton_session::engine::{Dot, DrawnPath, Frame};

use super::actions;
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
        if state.show_paths {
            paths(painter, &probe.paths, film);
        }
        dots(painter, &probe.photons, film, 1.6);
    }
    if let Some(pinned) = state.pinned.as_ref().filter(|_| state.looking.compare == Compare::Wipe) {
        wipe_labels(painter, film, state.wipe, sides(&pinned.label, &actions::pass_of(frame)));
    }
}

/// What the sides of the wipe say: on the left the render as it is now, on the right what is pinned.
fn sides(pinned: &str, now: &str) -> [String; 2] {
    [format!("Now: {now}"), format!("Pinned: {pinned}")]
}

/// The words on either side of the wipe's line, to be read over any picture and beside it.
fn wipe_labels(painter: &egui::Painter, film: Film, wipe: f32, [left, right]: [String; 2]) {
    let x = film.rect.left() + film.rect.width() * wipe;
    let bottom = film.rect.bottom() - 10.0;
    for (text, at, align) in [
        (left, Pos2::new(x - 10.0, bottom), egui::Align2::RIGHT_BOTTOM),
        (right, Pos2::new(x + 10.0, bottom), egui::Align2::LEFT_BOTTOM),
    ] {
        let galley = painter.layout_no_wrap(text, egui::FontId::proportional(13.0), Color32::WHITE);
        let place = align.anchor_size(at, galley.size());
        painter.rect_filled(place.expand2(egui::vec2(5.0, 3.0)), 3.0, Color32::from_black_alpha(190));
        painter.galley(place.min, galley, Color32::WHITE);
    }
}

fn line(painter: &egui::Painter, segment: &Segment, film: Film, stroke: Stroke) {
    painter.line_segment(segment.map(|end| film.to_points(end)), stroke);
}

/// Paths of photons: thin, for there are many; the last edge, by which the light came, is the brightest.
fn paths(painter: &egui::Painter, paths: &[DrawnPath], film: Film) {
    for path in paths {
        let colour = dot_legend::colour(path.class);
        for (i, edge) in path.edges.iter().enumerate() {
            let is_last = i + 1 == path.edges.len();
            let colour = if is_last { colour } else { colour.gamma_multiply(0.55) };
            line(painter, edge, film, Stroke::new(1.0, colour));
        }
    }
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

#[cfg(test)]
mod tests {
    use egui::{Rect, Vec2};
    use foton_session::PathClass;

    use super::*;

    #[test]
    fn paths_of_photons_have_the_colour_of_their_light_and_end_at_the_pixel() {
        let edges = vec![[[2.0, 2.0], [40.0, 20.0]], [[40.0, 20.0], [40.0, 38.0]]];
        let drawn = DrawnPath { edges, class: PathClass::Indirect };
        let rect = Rect::from_min_size(Pos2::ZERO, Vec2::new(120.0, 80.0));
        let film = Film { rect, image: rect, size: Vec2::new(60.0, 40.0) };
        let ctx = egui::Context::default();
        let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
            paths(&ui.painter_at(rect), std::slice::from_ref(&drawn), film);
        });
        output.textures_delta.clear();
        let lines = output.shapes.iter().filter_map(|shape| match &shape.shape {
            Shape::LineSegment { points, stroke } => Some((*points, stroke.color)),
            _ => None,
        });
        let [(_, dim), (last, bright)] = lines.collect::<Vec<_>>()[..] else { panic!("two edges") };
        assert_eq!(bright, dot_legend::colour(PathClass::Indirect));
        assert_eq!(last[1], Pos2::new(80.0, 76.0));
        assert_ne!(dim, bright);
    }

    #[test]
    fn the_wipe_says_which_side_is_pinned() {
        let said = ["Now: path, pass 18", "Pinned: ppm, pass 16"];
        assert_eq!(sides("ppm, pass 16", "path, pass 18"), said);
    }
}
