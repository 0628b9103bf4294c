//! What surfaces and the surroundings emit, and the choice of an emitter.

use foton_math::Rgb;
use foton_math::glam::Vec3;

use super::{Footprint, Scene};
use crate::emitter::Kind;
use crate::surface::Surface;

impl Scene {
    /// Radiance that a surface emits towards `direction`.
    #[must_use]
    pub fn emitted(&self, surface: &Surface, direction: Vec3) -> Rgb {
        self.emitted_seen(surface, direction, None)
    }

    /// The same, the mean over what an eye sample sees around the point. Without a footprint that of the point.
    #[must_use]
    pub fn emitted_seen(&self, surface: &Surface, direction: Vec3, footprint: Option<&Footprint>) -> Rgb {
        let Some(emitter) = self.shapes[surface.shape as usize].emitter else { return Rgb::BLACK };
        match &self.emitters[emitter as usize].kind {
            Kind::Area(area) if direction.dot(surface.normal) > 0.0 => match &area.pattern {
                Some(pattern) => self.lookup(surface, footprint).colour(&pattern.sampler),
                None => area.radiance,
            },
            _ => Rgb::BLACK,
        }
    }

    /// The index of the emitter that a surface is.
    #[must_use]
    pub fn emitter_of(&self, surface: &Surface) -> Option<usize> {
        self.shapes[surface.shape as usize].emitter.map(|emitter| emitter as usize)
    }

    /// The pdf (sr⁻¹) of sampling this point of an area emitter from `position`, choice of the emitter included; 0 where the surface
    /// does not emit in that direction.
    #[must_use]
    pub fn area_emitter_pdf(&self, surface: &Surface, position: Vec3) -> f32 {
        let Some(emitter) = self.shapes[surface.shape as usize].emitter else { return 0.0 };
        match &self.emitters[emitter as usize].kind {
            Kind::Area(area) => area.pdf(surface, position) * self.emitter_share(emitter as usize) as f32,
            _ => 0.0,
        }
    }

    /// Radiance that a ray which hits nothing sees along `direction`.
    #[must_use]
    pub fn escaped_radiance(&self, direction: Vec3) -> Rgb {
        if !self.census.environment {
            return Rgb::BLACK;
        }
        self.environments.iter().map(|&i| self.emitters[i as usize].escaped_radiance(direction)).sum()
    }

    /// Chooses an emitter by `u` in [0, 1): in proportion to power, with a defensive share for each. Returns its index and
    /// the chance of it; `None` when nothing emits.
    #[must_use]
    pub fn choose_emitter(&self, u: f64) -> Option<(usize, f64)> {
        if self.emitter_choice.is_empty() {
            return None;
        }
        let i = self.emitter_choice.choose(u);
        Some((i, self.emitter_choice.probability(i)))
    }

    /// The chance that a photon starts from the emitter of that index.
    #[must_use]
    pub fn emitter_share(&self, index: usize) -> f64 {
        if self.emitter_choice.is_empty() { 0.0 } else { self.emitter_choice.probability(index) }
    }
}
