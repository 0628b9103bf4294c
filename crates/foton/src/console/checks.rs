//! Warnings after a render: emitters whose photons were wasted, power that was lost.

use foton_input::quoted;
use foton_integrator::{DirectLight, Render};

use super::Console;
use super::failure::MAX_NAMES;
use super::json::not_finite;

/// Power that is cut off beyond this share of what is emitted is worth a warning.
const WORTH_A_WARNING: f64 = 1e-3;

impl Console {
    /// Warns of emitters that most photons leave in vain.
    pub(crate) fn check_lights(&self, render: &Render) {
        // With shadow rays the photons of a light need not reach anything that it lights directly.
        if render.settings().ppm.direct_light == DirectLight::ShadowRays {
            return;
        }
        let photons = render.photons_emitted();
        for (emitter, light) in render.scene().emitters().iter().zip(render.light_use()) {
            if light.is_starved(photons) {
                self.warning(&format!(
                    "{} takes {:.0} % of the photons, and {:.2} % of those come near anything that is seen: what it lights \
                     converges slowly",
                    quoted(&emitter.name),
                    100.0 * light.emitted as f64 / photons as f64,
                    100.0 * light.hit_rate()
                ));
            }
        }
    }

    /// Warns of light that went missing, and says where.
    pub(crate) fn check_ledger(&self, render: &Render) {
        let ledger = render.ledger();
        let materials =
            || render.scene().materials().iter().map(|m| m.name.as_str()).zip(render.material_losses());
        let share = ledger.truncated / ledger.emitted.max(f64::MIN_POSITIVE);
        if share > WORTH_A_WARNING {
            let most = materials().max_by(|a, b| a.1.truncated.total_cmp(&b.1.truncated));
            let place = most.map_or_else(String::new, |(name, loss)| {
                format!(", {:.0} % of that at {}", 100.0 * loss.truncated / ledger.truncated, quoted(name))
            });
            self.warning(&format!(
                "{:.1} % of the emitted power was cut off at the longest path{place}; --max-depth sets it",
                share * 100.0
            ));
        }
        let eye_paths = render.start_report().dropped;
        if eye_paths > 0 {
            self.warning(&format!("{eye_paths} eye paths were dropped because their weight was not finite"));
        }
        if ledger.dropped > 0 {
            let lights = render.scene().emitters().iter().zip(render.light_use());
            let lights = lights.map(|(emitter, light)| (emitter.name.as_str(), light.dropped));
            let all: Vec<_> = lights.chain(materials().map(|(name, loss)| (name, loss.dropped))).collect();
            let gathered = ledger.dropped - all.iter().map(|(_, n)| n).sum::<u64>().min(ledger.dropped);
            let named =
                all.iter().filter(|(_, n)| *n > 0).map(|(name, n)| format!("{n} at {}", quoted(name)));
            let gathered = (gathered > 0).then(|| format!("{gathered} where light was gathered"));
            let places: Vec<String> = named.take(MAX_NAMES).chain(gathered).collect();
            self.warning(&format!(
                "{} photons or sums of them were dropped because they were not finite: {}",
                ledger.dropped,
                places.join(", ")
            ));
        }
        if let Some(place) = render.first_not_finite() {
            self.event(&not_finite(place));
            self.line(&format!("the first of those: {place}; --strict stops there"));
        }
    }
}
