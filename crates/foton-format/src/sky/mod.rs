//! Skies and suns of scene files, as environment maps.
//!
//! The sky is the model of Hošek and Wilkie `[HW12]`, the sun an even disc. Both are drawn on a latitude–longitude map, which emits and is
//! sampled as any other environment does. Its +y is up.

mod place;
mod sun_table;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::Bitmap;
use hw_skymodel::rgb::{Channel, SkyParams, SkyState};

pub(crate) use place::PlaceAndTime;
use sun_table::{ELEVATIONS, RADIANCES};

/// Pixels of a map's height where there is a sun, which is then 3 pixels across, and where there is none. The width is twice that, plus
/// what makes rows from pole to pole as high as columns are wide.
const HEIGHTS: [u32; 2] = [1025, 257];

/// What turns the model's numbers into the radiance of Mitsuba 3's `sunsky`.
const RADIANCE_OF_MODEL: f64 = 1.0 / 106.75;

/// The aperture of the sun, in degrees, for which its radiance is known.
pub(crate) const APERTURE: f64 = 0.5358;

/// Parts of a pixel's side by which it is known how much of the pixel the sun covers.
const PARTS: i32 = 16;

/// A sky with its sun.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sky {
    /// Where the sun is, +y up; of unit length, y above zero.
    pub(crate) sun: DVec3,
    /// How hazy the air is, in [1, 10].
    pub(crate) turbidity: f64,
    /// Share of light that the ground reflects, in [0, 1].
    pub(crate) albedo: Rgb,
    /// Factors on the radiance of sky and sun.
    pub(crate) scales: [f64; 2],
    /// How large the sun is, in degrees. Its power does not depend on that.
    pub(crate) aperture: f64,
}

impl Sky {
    /// Its picture.
    #[allow(clippy::cast_possible_truncation, reason = "radiance is single precision")]
    pub(crate) fn bitmap(&self) -> Bitmap {
        let [of_sky, of_sun] = self.scales;
        let height = HEIGHTS[usize::from(of_sun == 0.0)];
        let width = 2 * (height - 1);
        let model = self.model().filter(|_| of_sky > 0.0);
        let mut pixels = Vec::with_capacity((width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                let direction = direction(f64::from(x), f64::from(y), height);
                let sky = model.as_ref().map_or([0.0; 3], |model| self.radiance(model, direction));
                pixels.push(Rgb::from_array(sky.map(|c| (c * of_sky) as f32)));
            }
        }
        let mut bitmap = Bitmap::new(width, height, pixels);
        if of_sun > 0.0 {
            self.add_sun(&mut bitmap.pixels, height, of_sun);
        }
        bitmap
    }

    #[allow(clippy::cast_possible_truncation, reason = "the model is single precision")]
    fn model(&self) -> Option<SkyState> {
        let elevation = self.sun.y.clamp(0.0, 1.0).asin().clamp(0.0, FRAC_PI_2 - 1e-6) as f32;
        let albedo = self.albedo.to_array();
        SkyState::new(&SkyParams { elevation, turbidity: self.turbidity as f32, albedo }).ok()
    }

    /// Radiance of the sky from a direction; none comes from below.
    #[allow(clippy::cast_possible_truncation, reason = "the model is single precision")]
    fn radiance(&self, model: &SkyState, direction: DVec3) -> [f64; 3] {
        if direction.y < 0.0 {
            return [0.0; 3];
        }
        let (theta, gamma) = (direction.y.min(1.0).acos() as f32, direction.angle_between(self.sun) as f32);
        [Channel::R, Channel::G, Channel::B]
            .map(|channel| f64::from(model.radiance(theta, gamma, channel)).max(0.0) * RADIANCE_OF_MODEL)
    }

    /// Adds the sun to the pixels that it covers, such that the map has all of its power.
    #[allow(clippy::cast_possible_truncation, reason = "radiance is single precision")]
    fn add_sun(&self, pixels: &mut [Rgb], height: u32, scale: f64) {
        let radius = (0.5 * self.aperture).to_radians();
        let cosine = radius.cos();
        let width = 2 * (height - 1);
        let pixel = PI / f64::from(height - 1);
        let zenith = self.sun.y.clamp(-1.0, 1.0).acos();
        let (first, last) = ((zenith - radius) / pixel - 1.0, (zenith + radius) / pixel + 1.0);
        let rows = first.max(0.0) as u32..(last.min(f64::from(height - 1)) as u32 + 1);
        let mut covered = Vec::new();
        let mut power = 0.0;
        for y in rows {
            // What a pixel stands for: interpolation gives it all of the band above and below.
            let solid_angle = pixel * pixel * (f64::from(y) * pixel).sin().max(0.25 * pixel);
            for x in 0..width {
                let towards = direction(f64::from(x), f64::from(y), height);
                if towards.dot(self.sun) < (radius + 2.0 * pixel).cos() {
                    continue;
                }
                let part = |i: i32| (f64::from(i) + 0.5) / f64::from(PARTS) - 0.5;
                let inside = (0..PARTS * PARTS).filter(|i| {
                    let (dx, dy) = (part(i % PARTS), part(i / PARTS));
                    direction(f64::from(x) + dx, f64::from(y) + dy, height).dot(self.sun) > cosine
                });
                let share = inside.count() as f64 / f64::from(PARTS * PARTS);
                power += share * solid_angle;
                covered.push(((y * width + x) as usize, share));
            }
        }
        let wanted = TAU * (1.0 - (0.5 * APERTURE).to_radians().cos());
        let radiance = self.sun_radiance().map(|c| c * scale * wanted / power.max(f64::MIN_POSITIVE));
        for (pixel, share) in covered {
            pixels[pixel] += Rgb::from_array(radiance.map(|c| (c * share) as f32));
        }
    }

    /// Radiance of the sun at [`APERTURE`]. Between rows of the table its logarithm is linear in the mass of air that the light has passed, as
    /// Bouguer's law says.
    fn sun_radiance(&self) -> [f64; 3] {
        let elevation = self.sun.y.clamp(0.0, 1.0).asin().to_degrees();
        let after = ELEVATIONS.iter().position(|&e| e > elevation).unwrap_or(ELEVATIONS.len() - 1).max(1);
        let [low, high] = [ELEVATIONS[after - 1], ELEVATIONS[after]].map(air_mass);
        let upper = ((low - air_mass(elevation)) / (low - high)).clamp(0.0, 1.0);
        let haze = (self.turbidity - 1.0).clamp(0.0, 9.0);
        let (step, between) = (haze.floor().min(8.0), haze - haze.floor().min(8.0));
        std::array::from_fn(|c| {
            let of = |row: usize| {
                let at = |i: f64| RADIANCES[row][i as usize][c];
                at(step) + (at(step + 1.0) - at(step)) * between
            };
            let (below, above) = (of(after - 1).max(1e-2).ln(), of(after).max(1e-2).ln());
            (below + (above - below) * upper).exp()
        })
    }
}

/// The mass of air that light passes from an elevation in degrees, by that from the zenith. `[KY89]`
fn air_mass(elevation: f64) -> f64 {
    1.0 / (elevation.to_radians().sin() + 0.50572 * (elevation + 6.07995).powf(-1.6364))
}

/// The direction of a place on a map, in pixels.
fn direction(x: f64, y: f64, height: u32) -> DVec3 {
    let bands = f64::from(height - 1);
    let (theta, phi) = (PI * y / bands, PI * (x + 0.5) / bands);
    DVec3::new(phi.sin() * theta.sin(), theta.cos(), -phi.cos() * theta.sin())
}

#[cfg(test)]
mod tests;
