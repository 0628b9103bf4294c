//! Light as it is summed: in one, or by path class where layers are asked for.

use foton_math::Rgb;
use foton_transport::Omissions;
use foton_transport::codec::{Reader, StateError, Writer};
use foton_transport::photon_map::PathClass;

use super::arrived::Arrived;
use super::direct::Direct;
use super::hit_points::HitPoints;
use super::radiance::Radiance;
use crate::error::{self, ErrorSums, PassFacts};
use crate::sppm::Renewal;

/// Light of one pass at the hit points, and of all passes in the pixels.
pub(crate) struct Sums<const LAYERS: usize> {
    arrived: Arrived<LAYERS>,
    radiance: Radiance,
}

/// Picks at start what is summed, so that a render without layers neither stores nor moves them.
pub(crate) enum Light {
    /// All classes in one.
    Whole(Sums<1>),
    /// All classes in one, with the same bits; and caustic and indirect light once more.
    ByClass(Sums<3>),
}

impl<const LAYERS: usize> Sums<LAYERS> {
    /// Where the gather puts what it finds.
    pub(super) const fn arrived(&mut self) -> &mut Arrived<LAYERS> {
        &mut self.arrived
    }

    fn new(emission: Vec<Rgb>, hit_points: &HitPoints, samples: u32) -> Self {
        Self {
            arrived: Arrived::none(hit_points.packets.len()),
            radiance: Radiance::new(emission, samples, LAYERS > 1),
        }
    }

    fn make_room_for(&mut self, hit_points: &HitPoints) {
        self.arrived = Arrived::none(hit_points.packets.len());
    }

    fn bytes(&self) -> usize {
        self.arrived.bytes() + self.radiance.bytes()
    }
}

/// The same expression for either arm.
macro_rules! each {
    ($light:expr, $sums:ident => $body:expr) => {
        match $light {
            Light::Whole($sums) => $body,
            Light::ByClass($sums) => $body,
        }
    };
}

impl Light {
    pub(crate) fn new(emission: Vec<Rgb>, hit_points: &HitPoints, samples: u32, by_class: bool) -> Self {
        if by_class {
            Self::ByClass(Sums::new(emission, hit_points, samples))
        } else {
            Self::Whole(Sums::new(emission, hit_points, samples))
        }
    }

    /// Makes room for the light of new hit points.
    pub(crate) fn make_room_for(&mut self, hit_points: &HitPoints) {
        each!(self, s => s.make_room_for(hit_points));
    }

    /// Adds the pass of so many photons to the pixels; says what was left out because it was not finite.
    pub(crate) fn add_pass(&mut self, hit_points: &HitPoints, photons: u64) -> Omissions {
        each!(self, s => s.radiance.add(hit_points, &s.arrived, photons))
    }

    /// Adds a pass, which is in the pixels already, to the error.
    pub(crate) fn add_error(
        &self,
        error: &mut ErrorSums,
        hit_points: &HitPoints,
        (direct, renewal): (Option<&Direct>, Option<&Renewal>),
        facts: PassFacts,
    ) {
        each!(self, s => error.add(&error::Pass {
            hit_points,
            arrived: &s.arrived,
            radiance: &s.radiance,
            direct,
            renewal,
            facts,
        }));
    }

    /// What photons have brought to all pixels in all passes: luminance times photons.
    pub(crate) fn luminance_sum(&self) -> f64 {
        each!(self, s => s.radiance.luminance_sums())
    }

    /// Noise and bias by pixel.
    pub(crate) fn error_planes(
        &self,
        error: &ErrorSums,
        (direct, renewal): (Option<&Direct>, Option<&Renewal>),
    ) -> (Vec<f32>, Vec<f32>) {
        each!(self, s => error.planes(&s.radiance, direct, renewal))
    }

    /// All radiance after `photons`, emission included.
    pub(crate) fn total(&self, photons: u64) -> Vec<Rgb> {
        each!(self, s => s.radiance.total(photons))
    }

    /// All radiance of one pixel; black beyond the image.
    pub(crate) fn pixel(&self, pixel: usize, photons: u64) -> Rgb {
        each!(self, s => s.radiance.pixel(pixel, photons))
    }

    /// Reflected radiance of one class; `None` where classes are not summed separately.
    pub(crate) fn class(&self, class: PathClass) -> Option<Vec<Rgb>> {
        each!(self, s => s.radiance.class(class))
    }

    /// Photons of the passes whose light was summed by class.
    pub(crate) fn photons_by_class(&self) -> Option<u64> {
        each!(self, s => s.radiance.photons_by_class())
    }

    pub(crate) fn write(&self, out: &mut Writer) {
        each!(self, s => s.radiance.write(out));
    }

    pub(crate) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        each!(self, s => s.radiance.read(input))
    }

    pub(crate) fn write_classes(&self, out: &mut Writer) {
        each!(self, s => s.radiance.write_classes(out));
    }

    pub(crate) fn read_classes(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        each!(self, s => s.radiance.read_classes(input))
    }

    /// The last pass's own estimate of reflected radiance, times the photons it emitted.
    pub(crate) fn last_pass(&self) -> Vec<Rgb> {
        each!(self, s => s.radiance.last.clone())
    }

    /// Radiance of emitters, seen directly or by specular bounces.
    pub(crate) fn emission(&self) -> &[Rgb] {
        each!(self, s => &s.radiance.emission)
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        each!(self, s => s.bytes())
    }

    /// Bytes held between the batches of a pass alone.
    #[cfg(test)]
    pub(super) fn bytes_between_batches(&self) -> usize {
        each!(self, s => s.arrived.bytes_between_batches())
    }
}
