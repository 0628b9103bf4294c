//! The live error in words and in JSON.

use foton_integrator::{ClassError, ErrorEstimate, Method};
use serde_json::{Value, json};

/// Names of the path classes, in their order.
const CLASSES: [&str; 3] = ["direct", "caustic", "indirect"];

/// What direct, caustic and indirect light have of the error, in a few words.
pub(crate) fn classes_text(e: &ErrorEstimate) -> String {
    let parts = e.classes.iter().flat_map(|classes| CLASSES.into_iter().zip(classes));
    let parts: Vec<String> = parts.map(|(name, c)| format!("{name} {:.2}", 100.0 * c.total())).collect();
    if parts.is_empty() { String::new() } else { format!("; of it {}", parts.join(", ")) }
}

/// What the upper end of the error takes for granted, and what the error leaves out.
pub(crate) fn limits_text(e: &ErrorEstimate, method: Method) -> String {
    let upper_end = if !method.has_photons() {
        ""
    } else if e.is_of_narrow_light() {
        ", uncertain because light is narrower than the discs (foci, beams), so that a few bright pixels decide"
    } else {
        ", if all bias is at edges"
    };
    let missed = match (method.renews_eye_samples(), method.has_photons()) {
        (false, _) => "what eye samples miss and what no photon has found",
        (true, true) => "what no photon has found",
        (true, false) => "what no path has found",
    };
    format!("{upper_end}; without {missed}")
}

/// A share in per cent, with three digits.
pub(crate) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let digits = (2.0 - percent.abs().max(1e-9).log10().floor()).clamp(0.0, 4.0) as usize;
    format!("{percent:.digits$} %")
}

/// The error in a few words.
pub(crate) fn error_text(e: &ErrorEstimate) -> String {
    let percent = |share: f64| 100.0 * share;
    format!("error {:.2} % (noise {:.2}, bias {:.2})", percent(e.total), percent(e.noise), percent(e.bias))
}

/// Adds the error to an event: shares of the mean reflected light; null while nothing is known.
pub(crate) fn add_error(event: &mut Value, error: Option<&ErrorEstimate>) {
    let fields = |e: &ErrorEstimate| [e.total, e.noise, e.bias, e.low, e.high, e.focus, e.unknown_share];
    let names = ["error", "noise", "bias", "error_low", "error_high", "error_focus", "unknown_share"];
    for (i, name) in names.into_iter().enumerate() {
        event[name] = json!(error.map(|e| fields(e)[i]));
    }
    event["classes"] = json!(error.and_then(|e| e.classes).map(|classes| {
        let of = |(name, c): (&str, ClassError)| {
            (name.to_owned(), json!({ "error": c.total(), "noise": c.noise, "bias": c.bias }))
        };
        CLASSES.into_iter().zip(classes).map(of).collect::<serde_json::Map<_, _>>()
    }));
}
