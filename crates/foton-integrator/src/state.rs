//! The state of a render as bytes: all that passes have changed. What the start of a render makes anew, bit for bit, is not in it.

use std::num::NonZeroU32;

use foton_math::Rgb;
use thiserror::Error;

use crate::adaptive::Evidence;
use crate::ledger::{Ledger, Loss};
use crate::light::Light;
use crate::light_use::LightUse;
use crate::packet::LANES;
use crate::ppm::Ppm;
use crate::refine::Statistics;
use crate::settings::{Alpha, Change};

/// Why bytes are no state of a render.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum StateError {
    /// They end too early, or go on.
    #[error("the state of the render is {0} bytes too short or too long")]
    Length(i64),
    /// They are of another scene, or of other settings.
    #[error("the state of the render is of another scene or of other settings")]
    OtherRender,
    /// A number that no render can have.
    #[error("the state of the render holds a value that cannot be")]
    Impossible,
}

/// Little-endian numbers, appended.
#[derive(Default)]
pub(crate) struct Writer(Vec<u8>);

impl Writer {
    pub(crate) fn u64(&mut self, value: u64) {
        self.0.extend_from_slice(&value.to_le_bytes());
    }

    pub(crate) fn f64(&mut self, value: f64) {
        self.u64(value.to_bits());
    }

    pub(crate) fn rgb(&mut self, colour: Rgb) {
        for channel in colour.to_array() {
            self.0.extend_from_slice(&channel.to_le_bytes());
        }
    }
}

/// The same numbers in the same order.
pub(crate) struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], StateError> {
        let (head, tail) =
            self.0.split_first_chunk::<N>().ok_or(StateError::Length(self.0.len() as i64 - N as i64))?;
        self.0 = tail;
        Ok(*head)
    }

    pub(crate) fn u64(&mut self) -> Result<u64, StateError> {
        Ok(u64::from_le_bytes(self.take()?))
    }

    pub(crate) fn f64(&mut self) -> Result<f64, StateError> {
        Ok(f64::from_bits(self.u64()?))
    }

    /// A number of things that were counted one by one: more than 2⁵³ no render lives to see, and sums with them would overflow.
    pub(crate) fn count(&mut self) -> Result<u64, StateError> {
        self.u64().and_then(|n| if n <= 1 << 53 { Ok(n) } else { Err(StateError::Impossible) })
    }

    /// One that must be finite: a NaN would go on to spoil the image.
    pub(crate) fn finite(&mut self) -> Result<f64, StateError> {
        self.f64().and_then(|x| if x.is_finite() { Ok(x) } else { Err(StateError::Impossible) })
    }

    /// A colour, which must be finite.
    pub(crate) fn rgb(&mut self) -> Result<Rgb, StateError> {
        let mut channel = || self.take().map(f32::from_le_bytes);
        let colour = Rgb::from_array([channel()?, channel()?, channel()?]);
        if colour.is_finite() { Ok(colour) } else { Err(StateError::Impossible) }
    }

    /// A count that must be what this render has.
    fn expect(&mut self, count: usize) -> Result<(), StateError> {
        if self.u64()? == count as u64 { Ok(()) } else { Err(StateError::OtherRender) }
    }
}

impl Ppm {
    /// All that passes have changed. [`Ppm::restore`] takes it back into a render that was started with the same scene and
    /// settings, and the passes after that give the same bits as if there had been no break.
    #[must_use]
    pub fn state(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.u64(self.passes());
        out.u64(self.photons_emitted());
        out.u64(self.photons_in_last_pass());
        let settings = self.settings();
        out.f64(settings.alpha.get());
        out.u64(settings.photons_per_pass.get().into());
        out.u64(self.changes().len() as u64);
        for (pass, change) in self.changes() {
            let (kind, bits) = match change {
                Change::Alpha(alpha) => (0, alpha.get().to_bits()),
                Change::PhotonsPerPass(photons) => (1, photons.get().into()),
            };
            [*pass, kind, bits].into_iter().for_each(|n| out.u64(n));
        }
        let ledger = self.ledger();
        let sums = [ledger.emitted, ledger.absorbed, ledger.escaped, ledger.roulette, ledger.truncated];
        sums.into_iter().for_each(|sum| out.f64(sum));
        out.f64(ledger.shading_normals);
        out.f64(ledger.shading_gain);
        out.f64(ledger.lost);
        out.u64(ledger.dropped);
        out.u64(self.light_use().len() as u64);
        for light in self.light_use() {
            out.u64(light.emitted);
            out.u64(light.reached);
            out.u64(light.dropped);
        }
        out.u64(self.material_losses().len() as u64);
        for loss in self.material_losses() {
            out.f64(loss.truncated);
            out.u64(loss.dropped);
        }
        let statistics = &self.hit_points().statistics_slots;
        out.u64(statistics.len() as u64);
        statistics.iter().for_each(|s| s.write(&mut out));
        self.hit_points().evidence_slots.iter().for_each(|e| e.write(&mut out));
        match self.light() {
            Light::Whole(sums) => sums.write(&mut out),
            Light::ByClass(sums) => sums.write(&mut out),
        }
        out.u64(u64::from(self.error_sums().is_some()));
        if let Some(error) = self.error_sums() {
            error.write(&mut out);
        }
        out.0
    }

    /// Takes a [`Ppm::state`] back. After an error the render is not to be used.
    ///
    /// # Errors
    /// When the bytes are no state, or that of another render; see [`StateError`].
    pub fn restore(&mut self, state: &[u8]) -> Result<(), StateError> {
        let mut input = Reader(state);
        let passes = input.count()?;
        let (emitted, last) = (input.count()?, input.count()?);
        let alpha = Alpha::new(input.f64()?).ok_or(StateError::Impossible)?;
        let photons = nonzero(input.u64()?)?;
        let changes = (0..input.u64()?).map(|_| change(&mut input)).collect::<Result<_, _>>()?;
        self.set_progress(passes, emitted, last, changes);
        self.settings_mut().alpha = alpha;
        self.settings_mut().photons_per_pass = photons;
        let ledger = self.ledger_mut();
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
        } = ledger;
        for sum in [emitted, absorbed, escaped, roulette, truncated, shading_normals, shading_gain, lost] {
            *sum = input.finite()?;
        }
        *dropped = input.count()?;
        input.expect(self.light_use().len())?;
        for light in self.lights_mut() {
            *light = LightUse { emitted: input.count()?, reached: input.count()?, dropped: input.count()? };
        }
        input.expect(self.material_losses().len())?;
        for loss in self.losses_mut() {
            *loss = Loss { truncated: input.finite()?, dropped: input.count()? };
        }
        let hit_points = self.hit_points_mut();
        input.expect(hit_points.statistics_slots.len())?;
        for (slot, statistics) in hit_points.statistics_slots.iter_mut().enumerate() {
            let read = Statistics::read(&mut input)?;
            // Slots without a hit point stay without.
            if (read.radius2() < 0.0) != (statistics.radius2() < 0.0) {
                return Err(StateError::Impossible);
            }
            *statistics = read;
            hit_points.packets[slot / LANES].radius2[slot % LANES] = statistics.radius2() as f32;
        }
        for evidence in &mut hit_points.evidence_slots {
            *evidence = Evidence::read(&mut input)?;
        }
        match self.light_mut() {
            Light::Whole(sums) => sums.read(&mut input)?,
            Light::ByClass(sums) => sums.read(&mut input)?,
        }
        let error = self.error_sums_mut();
        input.expect(usize::from(error.is_some()))?;
        if let Some(error) = error {
            error.read(&mut input)?;
        }
        if !input.0.is_empty() {
            return Err(StateError::Length(input.0.len() as i64));
        }
        self.mark_all_cells();
        Ok(())
    }
}

fn nonzero(n: u64) -> Result<NonZeroU32, StateError> {
    u32::try_from(n).ok().and_then(NonZeroU32::new).ok_or(StateError::Impossible)
}

fn change(input: &mut Reader<'_>) -> Result<(u64, Change), StateError> {
    let (pass, kind, bits) = (input.u64()?, input.u64()?, input.u64()?);
    let change = match kind {
        0 => Change::Alpha(Alpha::new(f64::from_bits(bits)).ok_or(StateError::Impossible)?),
        1 => Change::PhotonsPerPass(nonzero(bits)?),
        _ => return Err(StateError::Impossible),
    };
    Ok((pass, change))
}
