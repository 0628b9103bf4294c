//! The state of a render as bytes: all that passes have changed. What the start of a render makes anew, bit for bit, is not in it.

use std::num::NonZeroU32;

use foton_transport::codec::{Reader, StateError, Writer};
use foton_transport::photon_map::LANES;
use foton_transport::{Ledger, LightUse, Loss};

use super::algorithm::Ppm;
use super::kept::{KeptRadius, KeptStatistics};
use super::settings::Alpha;
use super::statistics::Statistics;
use crate::changes::Changes;
use crate::settings::SettingChange;

impl Ppm {
    /// All that passes have changed. [`Ppm::restore`] takes it back into a render that was started with the same scene and
    /// settings, and the passes after that give the same bits as if there had been no break.
    #[must_use]
    pub(crate) fn save(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.u64(self.passes);
        out.u64(self.photons_emitted);
        out.u64(self.last_photons);
        let settings = &self.settings;
        out.f64(settings.ppm.alpha.get());
        out.u64(settings.ppm.photons_per_pass.get().into());
        out.u64(self.changes().len() as u64);
        for (pass, change) in self.changes() {
            let (kind, bits) = match change {
                SettingChange::Alpha(alpha) => (0, alpha.get().to_bits()),
                SettingChange::PhotonsPerPass(photons) => (1, photons.get().into()),
                SettingChange::CutPass(batches) => (2, batches.get().into()),
                SettingChange::PhotonsOnce(photons) => (3, photons.get().into()),
            };
            [*pass, kind, bits].into_iter().for_each(|n| out.u64(n));
        }
        let ledger = &self.ledger;
        let sums = [ledger.emitted, ledger.absorbed, ledger.escaped, ledger.roulette, ledger.truncated];
        sums.into_iter().for_each(|sum| out.f64(sum));
        out.f64(ledger.shading_normals);
        out.f64(ledger.shading_gain);
        out.f64(ledger.lost);
        out.u64(ledger.dropped);
        out.u64(self.lights.len() as u64);
        for light in &self.lights {
            out.u64(light.emitted);
            out.u64(light.reached);
            out.u64(light.dropped);
        }
        out.u64(self.losses.len() as u64);
        for loss in &self.losses {
            out.f64(loss.truncated);
            out.u64(loss.dropped);
        }
        if let Some(renewal) = &self.renewal {
            out.u64(self.shapes.len() as u64);
            renewal.write(&mut out);
        } else {
            self.write_hit_points(&mut out);
        }
        self.light.write(&mut out);
        if let Some(direct) = &self.direct {
            direct.write(&mut out);
        }
        out.u64(u64::from(self.error.is_some()));
        if let Some(error) = &self.error {
            error.write(&mut out);
        }
        self.guidance.write(&mut out);
        self.light.write_classes(&mut out);
        out.finish()
    }

    /// Takes a [`Ppm::save`] back. After an error the render is not to be used.
    ///
    /// # Errors
    /// When the bytes are no state, or that of another render; see [`StateError`].
    pub(crate) fn restore(&mut self, state: &[u8]) -> Result<(), StateError> {
        let mut input = Reader::new(state);
        let passes = input.count()?;
        let (emitted, last) = (input.count()?, input.count()?);
        let alpha = Alpha::new(input.f64()?).ok_or(StateError::Impossible)?;
        let photons = nonzero(input.u64()?)?;
        let changes = (0..input.u64()?).map(|_| change(&mut input)).collect::<Result<_, _>>()?;
        (self.passes, self.photons_emitted, self.last_photons, self.changes) =
            (passes, emitted, last, Changes::restored(changes));
        self.settings.ppm.alpha = alpha;
        self.settings.ppm.photons_per_pass = photons;
        self.restore_accounts(&mut input)?;
        if let Some(renewal) = &mut self.renewal {
            input.expect(self.shapes.len())?;
            renewal.read(&mut input)?;
        } else {
            self.restore_hit_points(&mut input)?;
        }
        self.light.read(&mut input)?;
        if let Some(direct) = &mut self.direct {
            direct.read(&mut input)?;
        }
        let error = self.error.as_mut();
        input.expect(usize::from(error.is_some()))?;
        if let Some(error) = error {
            error.read(&mut input)?;
        }
        self.guidance.read(&mut input, self.scene.emitters().len())?;
        self.light.read_classes(&mut input)?;
        input.finish()?;
        if self.renewal.is_some() {
            self.lay_out_last();
        } else {
            self.mark_all_cells();
        }
        Ok(())
    }

    /// Where power went, what the photons of each emitter were good for, and what went missing at each material.
    fn restore_accounts(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        let Ledger {
            emitted,
            absorbed,
            escaped,
            roulette,
            truncated,
            shading_normals,
            shading_gain,
            lost,
            dropped,
        } = &mut self.ledger;
        for sum in [emitted, absorbed, escaped, roulette, truncated, shading_normals, shading_gain, lost] {
            *sum = input.finite()?;
        }
        *dropped = input.count()?;
        input.expect(self.lights.len())?;
        for light in &mut self.lights {
            *light = LightUse { emitted: input.count()?, reached: input.count()?, dropped: input.count()? };
        }
        input.expect(self.losses.len())?;
        for loss in &mut self.losses {
            *loss = Loss { truncated: input.finite()?, dropped: input.count()? };
        }
        Ok(())
    }

    /// What hit points keep, by slot, with those that are empty.
    fn write_hit_points(&self, out: &mut Writer) {
        let slots = self.hit_points.packets.len() * LANES;
        out.u64(slots as u64);
        for slot in 0..slots {
            self.hit_points.statistics_at(slot).unwrap_or(Statistics::EMPTY_SLOT).write(out);
        }
        let slots = if self.hit_points.radius_statistics.is_empty() { 0 } else { slots };
        for slot in 0..slots {
            let of_hit_point = |_| self.hit_points.radius_statistics[self.hit_points.place(slot)];
            let kept = self.hit_points.statistics_at(slot).map_or_else(KeptRadius::default, of_hit_point);
            kept.write(out);
        }
    }

    fn restore_hit_points(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        let hit_points = &mut self.hit_points;
        let slots = hit_points.packets.len() * LANES;
        input.expect(slots)?;
        for slot in 0..slots {
            let (read, is_empty) = (Statistics::read(input)?, hit_points.statistics_at(slot).is_none());
            // Slots without a hit point stay without.
            if (read.radius2() < 0.0) != is_empty {
                return Err(StateError::Impossible);
            }
            if !is_empty {
                let place = hit_points.place(slot);
                hit_points.statistics[place] = KeptStatistics::new(&read);
                hit_points.packets[slot / LANES].radius2[slot % LANES] = read.radius2() as f32;
            }
        }
        let slots = if hit_points.radius_statistics.is_empty() { 0 } else { slots };
        for slot in 0..slots {
            let read = KeptRadius::read(input)?;
            if hit_points.statistics_at(slot).is_some() {
                let place = hit_points.place(slot);
                hit_points.radius_statistics[place] = read;
            }
        }
        hit_points.follow_radii();
        Ok(())
    }
}

fn nonzero(n: u64) -> Result<NonZeroU32, StateError> {
    u32::try_from(n).ok().and_then(NonZeroU32::new).ok_or(StateError::Impossible)
}

fn change(input: &mut Reader<'_>) -> Result<(u64, SettingChange), StateError> {
    let (pass, kind, bits) = (input.u64()?, input.u64()?, input.u64()?);
    let change = match kind {
        0 => SettingChange::Alpha(Alpha::new(f64::from_bits(bits)).ok_or(StateError::Impossible)?),
        1 => SettingChange::PhotonsPerPass(nonzero(bits)?),
        2 => SettingChange::CutPass(nonzero(bits)?),
        3 => SettingChange::PhotonsOnce(nonzero(bits)?),
        _ => return Err(StateError::Impossible),
    };
    Ok((pass, change))
}
