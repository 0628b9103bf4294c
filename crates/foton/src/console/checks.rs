//! Findings in a render: emitters whose photons were wasted, power that was lost.

use foton_integrator::Render;
use foton_session::findings::{self, SettingNames};

use super::Console;
use super::json::not_finite;

impl Console {
    /// Warns of emitters that most photons leave in vain.
    pub(crate) fn starved_emitters(&self, render: &Render) {
        for finding in findings::of_emitters(render) {
            self.finding(&finding);
        }
    }

    /// Warns of light that went missing, and says where.
    pub(crate) fn losses(&self, render: &Render) {
        for finding in findings::of_ledger(render, &SettingNames::OPTIONS) {
            self.finding(&finding);
        }
        if let Some(place) = render.first_not_finite() {
            self.event(&not_finite(place));
            self.line(&format!("first occurrence: {place}; use --strict to stop there"));
        }
    }
}
