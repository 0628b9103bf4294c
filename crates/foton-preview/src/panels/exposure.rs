//! The exposure: a view's own, in stops, set by hand or from the picture.

use egui::Ui;
use foton_session::engine::Picture;

use super::icons::Icon;
use super::number::{Change, Digits, Number};
use super::slider::Slider;
use super::{histogram, widgets};
use crate::state::State;

/// Stops either way that can be set.
const MOST: f64 = 16.0;

/// Stops either way that the slider reaches.
const SLIDER: f64 = 8.0;

/// The luminance that the middle of a picture's luminances, as the eye weighs them, is brought to.
const MIDDLE_GREY: f64 = 0.18;

pub(super) fn show(ui: &mut Ui, state: &mut State, has_slider: bool) {
    widgets::icon(ui, Icon::Exposure, "Exposure");
    let stops = f64::from(state.exposure_stops);
    let number = Number::new("Exposure", -MOST..=MOST).unit("EV").digits(Digits::Decimals(1)).speed(0.05);
    let number = number.width(64.0);
    let (response, change) = if has_slider {
        let ([slider, field], change) =
            Slider::new("Exposure", -SLIDER..=SLIDER).width(80.0).show(ui, number, stops);
        (slider | field, change)
    } else {
        number.show(ui, stops)
    };
    state.place("exposure", &response);
    if response.enabled() {
        histogram::turn(ui, state, &response);
    }
    response.on_hover_text(
        "Each stop doubles the light on the screen; nothing is rendered again. The wheel changes it too",
    );
    if let Some(Change::Moving(stops) | Change::Done(stops)) = change {
        state.exposure_stops = ((stops * 10.0).round() / 10.0) as f32;
    }
    let auto = ui
        .button("Auto")
        .on_hover_text("Sets the exposure so that the picture is neither dark nor burnt out");
    if auto.clicked()
        && let Some(Picture::Colour(image)) = state.frame.as_ref().and_then(|f| f.picture.as_ref())
        && let Some(stops) = automatic(image.pixels.iter().map(|c| f64::from(c.luminance())))
    {
        state.exposure_stops = stops;
    }
}

/// The stops that bring the geometric mean of luminances to middle grey; `None` where all is black.
fn automatic(luminances: impl Iterator<Item = f64>) -> Option<f32> {
    let (mut sum, mut count) = (0.0, 0_u64);
    for luminance in luminances.filter(|l| *l > 1e-9 && l.is_finite()) {
        sum += luminance.log2();
        count += 1;
    }
    let mean = (count > 0).then(|| sum / count as f64)?;
    let stops = (MIDDLE_GREY.log2() - mean).clamp(-MOST, MOST);
    Some(((stops * 10.0).round() / 10.0) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_automatic_exposure_brings_the_picture_to_middle_grey() {
        assert_eq!(automatic([0.18, 0.18].into_iter()), Some(0.0));
        assert_eq!(automatic([0.045, 0.18, 0.72].into_iter()), Some(0.0));
        assert_eq!(
            automatic([0.0225, 0.0, f64::NAN].into_iter()),
            Some(3.0),
            "what is black or no number does not count"
        );
        assert_eq!(automatic([0.0].into_iter()), None);
    }
}
