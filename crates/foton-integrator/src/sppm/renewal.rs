//! What a render keeps beside its passes where each of them has new eye samples.

use std::ops::Range;
use std::sync::Arc;

use foton_math::Rgb;
use foton_scene::Scene;
use foton_transport::camera_paths::EyePaths;
use foton_transport::codec::{Reader, StateError, Writer};
use foton_transport::direct_light::Lights;
use foton_transport::{Cancel, Cancelled, Halt, ShouldSuspend};

use super::pixels::{Pixels, Shrinkage};
use super::samples::{Samples, radius2};
use super::seen::Seen;
use crate::ppm::direct::{Lighting, Lit};
use crate::ppm::hit_points::HitPoints;
use crate::ppm::statistics::Statistics;
use crate::settings::RenderSettings;
use crate::shutter::at_pass;

/// Pixels that one task lights.
pub(super) const LIT_BLOCK: usize = 256;

/// What stays while eye samples come and go.
pub(crate) struct Renewal {
    pub(crate) pixels: Pixels,
    pub(crate) seen: Seen,
    samples: Samples,
    /// Of the hit points that are laid out, in sample order.
    first_radius2: Vec<f32>,
    /// Where shadow rays bring direct light.
    pub(crate) lights: Option<Lights>,
    /// Whether the hit points that are laid out are those of the next pass, and none has gathered with them.
    pub(super) is_fresh: bool,
}

impl Renewal {
    /// A render whose first samples see that emission and find hit points of such first r², which are then multiplied by `widened`
    /// squared.
    pub(crate) fn new(
        (scene, shadow_rays): (&Scene, bool),
        emission: Vec<Rgb>,
        (first_radius2, widened): (Vec<f32>, f32),
        radius_statistics: bool,
    ) -> Self {
        Self {
            pixels: Pixels::new(emission.len(), widened, radius_statistics),
            seen: Seen::new(emission),
            samples: Samples::default(),
            first_radius2,
            lights: shadow_rays.then(|| Lights::new(scene)),
            is_fresh: true,
        }
    }

    /// Brings everything that moves to where it is in the pass after so many others, unless samples of it have been followed already.
    ///
    /// # Errors
    /// When cancelled.
    pub(super) fn open_shutter(
        &mut self,
        (scene, settings, pass): (&mut Arc<Scene>, &RenderSettings, u64),
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        if scene.blurs(settings.sensor) && !self.samples.is_begun() {
            *scene = at_pass(scene, settings, pass, cancel)?;
            if let Some(lights) = &mut self.lights {
                *lights = Lights::new(scene);
            }
        }
        Ok(())
    }

    /// Follows the samples of the pass after so many others.
    ///
    /// # Errors
    /// When cancelled or suspended.
    pub(super) fn follow(
        &mut self,
        of: (&Scene, &RenderSettings, u64),
        cancel: &Cancel,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<(EyePaths, Vec<f32>), Halt> {
        self.samples.follow(of, &self.pixels, cancel, should_suspend)
    }

    /// Gives up the samples of a pass that has not happened, also those that have gathered some of its photons.
    pub(crate) fn discard(&mut self) {
        self.samples.clear();
        self.is_fresh = false;
    }

    /// Takes the samples of a pass that are laid out.
    pub(super) fn take(&mut self, emission: Vec<Rgb>, first_radius2: Vec<f32>) {
        self.seen.emission = emission;
        self.first_radius2 = first_radius2;
        self.is_fresh = true;
    }

    /// Lights some pixels by shadow rays from their hit points in the pass after so many others.
    pub(super) fn light(lighting: &Lighting<'_>, pass: u64, pixels: Range<usize>) -> Lit {
        let mut lit = Lit::with_room_for(pixels.len(), 0);
        for pixel in pixels {
            let light = lighting.anew(pixel, pass, &mut lit);
            lit.light.push(light);
        }
        lit
    }

    /// Takes a pass of so many photons into account, which hit points have gathered and shadow rays have lit.
    ///
    /// `by_photons` is what photons have brought to all pixels in all passes, this one too, of `all` photons.
    pub(super) fn add(
        &mut self,
        hit_points: &HitPoints,
        how: Shrinkage,
        (photons, direct): (u64, Vec<Rgb>),
        (by_photons, all): (f64, u64),
    ) {
        self.pixels.refine(hit_points, &self.first_radius2, how);
        self.seen.add(photons, direct, (by_photons, self.pixels.seen(), all));
    }

    /// The statistics of a hit point in sample order, with the radius that its pixel has come to and the photons of all the pixel's.
    pub(crate) fn statistics(&self, hit_points: &HitPoints, pixel: usize, h: usize) -> Statistics {
        let slot = hit_points.slot_of[h] as usize;
        let smallest2 = hit_points.smallest2[hit_points.place(slot)];
        let r2 = radius2(self.pixels.factor(pixel), self.first_radius2[h], smallest2);
        Statistics::of_display(r2, self.pixels.photons_found(pixel))
    }

    pub(crate) fn write(&self, out: &mut Writer) {
        self.pixels.write(out);
        self.seen.write(out);
    }

    pub(crate) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        self.pixels.read(input)?;
        self.seen.read(input)
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self, radius_statistics: bool) -> usize {
        self.seen.emission.len() * Self::bytes_per_pixel(radius_statistics)
            + self.first_radius2.len() * size_of::<f32>()
    }

    /// Bytes held a pixel.
    pub(crate) const fn bytes_per_pixel(radius_statistics: bool) -> usize {
        Pixels::bytes_per_pixel(radius_statistics) + Seen::BYTES_PER_PIXEL
    }
}
