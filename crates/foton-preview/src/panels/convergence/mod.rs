//! Convergence: how wrong the image still is, what makes it wrong, and when it will be good enough.

mod bars;
mod left;
mod plot;

use egui::Ui;

pub(super) use left::{Left, duration, left};

use super::figures::Figure;
use super::text::percent;
use super::warnings;
use crate::state::State;

const HELP: &str = "Root mean square error of the image over its mean reflected light, estimated from the passes. Noise is what more \
                    photons take away, bias what smaller radii do. Left out: what the eye samples miss, light that no photon has \
                    found, most of the bias right at edges";

pub(super) fn show(ui: &mut Ui, state: &State) {
    let Some(frame) = &state.frame else { return };
    match &frame.stats.error {
        Some(error) => {
            plot::show(ui, state, left::goal(frame));
            figures(state).iter().for_each(|figure| figure.show(ui));
            if frame.settings.method.has_discs() {
                bars::noise_and_bias(ui, error);
            }
            bars::light_paths(ui, error);
        }
        None => {
            ui.weak("The error is known after a few passes.");
        }
    }
    warnings::show(ui, state);
}

/// The figures of the error.
fn figures(state: &State) -> Vec<Figure> {
    let Some((frame, e)) = state.frame.as_ref().and_then(|f| Some((f, f.stats.error?))) else {
        return Vec::new();
    };
    let mut rows = vec![
        Figure::new("Error", percent(e.total), HELP),
        Figure::new(
            "90 % interval",
            format!("{} \u{2013} {}", percent(e.low), percent(e.high)),
            "The error lies between these, nine times in ten; the upper end takes all bias to be that of edges, of which the \
             estimate sees a half",
        ),
    ];
    if e.is_of_narrow_light() {
        rows.push(Figure::new(
            "Narrow light",
            percent(e.focus),
            "Light narrower than the discs (foci, beams) may add this: a few bright pixels decide, and how much is uncertain. More \
             samples/pixel make the smallest radius smaller",
        ));
    }
    let goal = left::goal(frame);
    let time = if e.total <= goal {
        "reached".to_owned()
    } else {
        left::seconds_to(&state.error, goal)
            .map_or_else(|| "–".to_owned(), |s| format!("about {}", duration(s)))
    };
    let name = if frame.stop.error.is_some() { "Time to target" } else { "Time to 2 %" };
    rows.push(Figure::new(name, time, "From the slope of the error over time, both as logarithms"));
    rows
}
