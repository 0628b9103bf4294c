//! The views by name, and which kinds of light they show.

use egui::Ui;
use foton_session::engine::{ErrorPart, ViewMode};

use crate::state::State;

/// Views by name; the first five have the keys 1 to 5.
pub(super) const VIEWS: [(&str, ViewMode); 8] = [
    ("Radiance", ViewMode::Radiance),
    ("Luminance", ViewMode::Luminance),
    ("Radius", ViewMode::Radius),
    ("Photons found", ViewMode::PhotonCount),
    ("Unlit hit points", ViewMode::Unknown),
    ("Error", ViewMode::Error(ErrorPart::Total)),
    ("Noise", ViewMode::Error(ErrorPart::Noise)),
    ("Bias", ViewMode::Error(ErrorPart::Bias)),
];

/// What the present view is called.
pub(super) fn name(view: ViewMode) -> &'static str {
    VIEWS.iter().find(|(_, v)| *v == view).map_or("Light paths", |(name, _)| name)
}

/// Whether the present view is of light, which exposure and tone map apply to.
pub(super) const fn is_light(view: ViewMode) -> bool {
    matches!(view, ViewMode::Radiance | ViewMode::Classes { .. })
}

/// Whether the method of the render has such a view.
pub(super) fn is_there(view: ViewMode, state: &State) -> bool {
    let has_discs = state.frame.as_ref().is_none_or(|f| f.settings.method.has_discs());
    let is_of_discs = matches!(
        view,
        ViewMode::Radius
            | ViewMode::PhotonCount
            | ViewMode::Unknown
            | ViewMode::Error(ErrorPart::Noise | ErrorPart::Bias)
    );
    has_discs || !is_of_discs
}

/// A line for each view.
pub(super) fn choices(ui: &mut Ui, state: &mut State) {
    for (name, view) in VIEWS.into_iter().filter(|(_, view)| is_there(*view, state)).collect::<Vec<_>>() {
        if ui.selectable_label(state.view == view, name).clicked() {
            state.choose_view(view);
        }
    }
}

/// A switch for each kind of light.
pub(super) fn light_paths(ui: &mut Ui, state: &mut State) {
    let (mut reflected, mut emission) = match state.view {
        ViewMode::Classes { reflected, emission } => (reflected, emission),
        _ => ([true; 3], true),
    };
    let before = (reflected, emission);
    let names = ["Direct", "Caustic", "Indirect"];
    for (on, name) in reflected.iter_mut().zip(names) {
        ui.checkbox(on, name);
    }
    ui.checkbox(&mut emission, "Emitters");
    if (reflected, emission) == before {
        return;
    }
    if reflected == [true; 3] && emission {
        state.choose_view(ViewMode::Radiance);
        return;
    }
    state.choose_view(ViewMode::Classes { reflected, emission });
}

/// A switch for each thing that is drawn over the picture.
pub(super) fn over_the_picture(ui: &mut Ui, state: &mut State) {
    ui.checkbox(&mut state.looking.show_histogram, "Histogram (L)")
        .on_hover_text("How bright the pixels are, in stops");
    ui.checkbox(&mut state.looking.marks_clipping, "Mark clipping (C)").on_hover_text(
        "Red stripes over pixels that are 255 in a channel, blue over black ones: what a PNG clips",
    );
    ui.checkbox(&mut state.looking.show_history, "History (T)")
        .on_hover_text("The passes that were kept: to compare with, to return to, and to make films of");
}
