//! Queries of a render while it runs: single hit points, the photons of the last pass, the spread of radii.
//!
//! Nothing here is on the path of a pass. World units.

use foton_math::Rgb;
use foton_math::glam::{DVec3, Vec3};
use foton_transport::photon_map::{LANES, PathClass, Photon};

use super::algorithm::Ppm;
use super::statistics::Statistics;

/// A hit point's disc, as a person sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its centre.
    pub position: DVec3,
    /// Unit geometric normal on the eye's side.
    pub normal: DVec3,
    /// Its radius now.
    pub radius: f64,
    /// Photons found in all passes.
    pub photons_found: u64,
}

/// A photon of the last pass: of its last batch, where it was so large that it had several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredPhoton {
    /// Where it was stored.
    pub position: DVec3,
    /// How it came there.
    pub class: PathClass,
    /// Its power per channel, its share of the emitters' whole (W): photons of one pass, or of one batch, add up to that.
    pub power: Rgb,
}

/// The spread of all radii; zeros without hit points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Radii {
    /// The smallest.
    pub smallest: f64,
    /// Half are smaller.
    pub median: f64,
    /// The largest.
    pub largest: f64,
}

impl Ppm {
    /// The spread of radii as it is now.
    #[must_use]
    pub(crate) fn radii(&self) -> Radii {
        let mut radius2: Vec<f64> = match &self.renewal {
            None => self.hit_points.in_sample_order().map(|s| s.radius2()).collect(),
            // Of pixels: hit points come and go, also while a pass is under way.
            Some(renewal) => {
                let seen = (0..self.shapes.len()).filter(|&pixel| renewal.pixels.is_seen(pixel));
                seen.map(|pixel| renewal.pixels.mean_radius(pixel).powi(2)).collect()
            }
        };
        if radius2.is_empty() {
            return Radii::default();
        }
        let world = |r2: f64| self.scene.normalisation().world_length(r2.sqrt());
        let (below, middle, above) = {
            let middle = radius2.len() / 2;
            radius2.select_nth_unstable_by(middle, f64::total_cmp)
        };
        let median = *middle;
        let smallest = below.iter().copied().fold(median, f64::min);
        let largest = above.iter().copied().fold(median, f64::max);
        Radii { smallest: world(smallest), median: world(median), largest: world(largest) }
    }

    /// The discs of a pixel's hit points, in the order of its samples. `pixel` counts along rows from the top left; one beyond
    /// the image has none.
    #[must_use]
    pub(crate) fn discs(&self, pixel: usize) -> Vec<Disc> {
        if pixel >= self.shapes.len() {
            return Vec::new();
        }
        self.hit_points.of_pixel(pixel).map(|h| self.disc(pixel, h)).collect()
    }

    fn disc(&self, pixel: usize, h: usize) -> Disc {
        let slot = self.hit_points.slot_of[h] as usize;
        let normalisation = self.scene.normalisation();
        let packet = &self.hit_points.packets[slot / LANES];
        let vector = |rows: &[[f32; LANES]; 3]| Vec3::from_array(rows.map(|row| row[slot % LANES]));
        let statistics = self.statistics(pixel, h);
        Disc {
            position: normalisation.world_point(vector(&packet.position)),
            normal: vector(&packet.normal).as_dvec3().normalize_or_zero(),
            radius: normalisation.world_length(statistics.radius2().sqrt()),
            photons_found: statistics.photons_found(),
        }
    }

    /// Photons of the last batch, `at_most` of them, spread evenly over the scene's cells.
    #[must_use]
    pub(crate) fn stored_photons(&self, at_most: usize) -> Vec<StoredPhoton> {
        let photons = self.map.photons();
        let step = photons.len().div_ceil(at_most.max(1)).max(1);
        photons.iter().step_by(step).map(|p| self.stored(p)).collect()
    }

    /// Photons of the last batch within `radius` of a point, `at_most` of them.
    #[must_use]
    pub(crate) fn photons_near(&self, position: DVec3, radius: f64, at_most: usize) -> Vec<StoredPhoton> {
        let normalisation = self.scene.normalisation();
        let centre = normalisation.point(position);
        let radius2 = normalisation.length(radius).powi(2);
        let near = self.map.photons().iter().filter(|p| p.position.distance_squared(centre) <= radius2);
        near.take(at_most).map(|p| self.stored(p)).collect()
    }

    fn stored(&self, photon: &Photon) -> StoredPhoton {
        let normalisation = self.scene.normalisation();
        let scale = normalisation.scale();
        let watts = 1.0 / (self.map_photons.max(1) as f64 * scale * scale);
        StoredPhoton {
            position: normalisation.world_point(photon.position),
            class: PathClass::ALL[photon.class_index()],
            power: photon.power * watts as f32,
        }
    }

    /// Mean radius of each pixel's hit points, in world units; 0 without hit points.
    #[must_use]
    pub(crate) fn mean_radii(&self) -> Vec<f32> {
        let world = self.scene.normalisation().world_length(1.0);
        if let Some(renewal) = &self.renewal {
            let of = |pixel| (renewal.pixels.mean_radius(pixel) * world) as f32;
            return (0..self.shapes.len()).map(of).collect();
        }
        self.per_pixel(|statistics| {
            let n = statistics.len().max(1) as f64;
            (statistics.iter().map(|s| s.radius2().sqrt()).sum::<f64>() / n * world) as f32
        })
    }

    /// Photons found by each pixel's hit points in all passes.
    #[must_use]
    pub(crate) fn photons_found(&self) -> Vec<u32> {
        if let Some(renewal) = &self.renewal {
            let of = |pixel| u32::try_from(renewal.pixels.photons_found(pixel)).unwrap_or(u32::MAX);
            return (0..self.shapes.len()).map(of).collect();
        }
        self.per_pixel(|statistics| {
            let found = statistics.iter().map(Statistics::photons_found).sum::<u64>();
            u32::try_from(found).unwrap_or(u32::MAX)
        })
    }

    /// Per pixel, the share of its hit points that have found no photon in any pass: unknown, not dark.
    #[must_use]
    pub(crate) fn unknown_share(&self) -> Vec<f32> {
        if let Some(renewal) = &self.renewal {
            let of = |pixel| f32::from(u8::from(renewal.pixels.is_unknown(pixel)));
            return (0..self.shapes.len()).map(of).collect();
        }
        self.per_pixel(|statistics| {
            let unknown = statistics.iter().filter(|s| s.is_unknown()).count();
            unknown as f32 / statistics.len().max(1) as f32
        })
    }
}
