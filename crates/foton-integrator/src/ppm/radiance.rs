//! From hit points to pixels: each pass's estimate, and the running mean of all passes.

use foton_math::Rgb;
use foton_transport::Omissions;
use foton_transport::codec::{Reader, StateError, Writer};
use foton_transport::photon_map::PathClass;
use rayon::prelude::*;

use super::arrived::Arrived;
use super::hit_points::HitPoints;

/// Pixels of one task.
const BLOCK: usize = 1024;

/// Path classes.
const CLASSES: usize = PathClass::ALL.len();

/// Sums of radiance per pixel.
pub(crate) struct Radiance {
    /// Radiance that each pixel sees of emitters, directly or by specular bounces.
    pub(crate) emission: Vec<Rgb>,
    /// Σ over passes of Σ W Φ/(π r²) / samples; divided by the photons emitted it is reflected radiance.
    sums: Vec<[f64; 3]>,
    /// The last pass's addend: its own estimate of the pixel, times its photons. An error figure squares this.
    pub(crate) last: Vec<Rgb>,
    /// Whether a photon has counted in the last pass for any hit point of the pixel.
    lit: Vec<bool>,
    /// The same sums by path class, where they are asked for.
    classes: Option<ClassSums>,
    samples: f32,
}

/// Sums of reflected radiance by path class, beside those of all of it.
struct ClassSums {
    sums: Vec<[[f64; 3]; CLASSES]>,
    /// Photons of the passes in them: fewer than in the whole where a state without classes was restored.
    photons: u64,
}

impl Radiance {
    pub(crate) fn new(emission: Vec<Rgb>, samples: u32, by_class: bool) -> Self {
        let pixels = emission.len();
        let none = || ClassSums { sums: vec![[[0.0; 3]; CLASSES]; pixels], photons: 0 };
        Self {
            emission,
            sums: vec![[0.0; 3]; pixels],
            last: vec![Rgb::BLACK; pixels],
            lit: vec![false; pixels],
            classes: by_class.then(none),
            samples: samples as f32,
        }
    }

    /// Adds a pass of so many photons; says what it left out because it was not finite.
    pub(crate) fn add<const LAYERS: usize>(
        &mut self,
        hit_points: &HitPoints,
        arrived: &Arrived<LAYERS>,
        photons: u64,
    ) -> Omissions {
        let (samples, is_dark) = (self.samples, arrived.is_none());
        let classes = self.classes.as_mut().map_or_else(Vec::new, |classes| {
            classes.photons += photons;
            classes.sums.chunks_mut(BLOCK).collect()
        });
        let mut classes: Vec<&mut [_]> = classes;
        classes.resize_with(self.sums.len().div_ceil(BLOCK), Default::default);
        let blocks = self.last.par_chunks_mut(BLOCK).zip(self.lit.par_chunks_mut(BLOCK));
        let blocks = blocks.zip(self.sums.par_chunks_mut(BLOCK)).zip(classes);
        let pass = blocks.enumerate().map(|(block, (((last, lit), sums), classes))| {
            let mut omissions = Omissions::default();
            for (i, ((last, lit), sum)) in last.iter_mut().zip(lit).zip(sums).enumerate() {
                let range = hit_points.of_pixel(block * BLOCK + i);
                let first = range.start as u32;
                let mut layers = [Rgb::BLACK; LAYERS];
                (*last, *lit) = (Rgb::BLACK, false);
                if is_dark {
                    continue;
                }
                for (h, &slot) in range.clone().zip(&hit_points.slot_of[range]) {
                    let Some(irradiance) = arrived.irradiance(slot as usize) else { continue };
                    *lit = true;
                    for (layer, irradiance) in layers.iter_mut().zip(irradiance) {
                        *layer += hit_points.weights[h] * *irradiance;
                    }
                }
                if !*lit {
                    continue;
                }
                *last = layers[0] / samples;
                if !last.is_finite() {
                    *last = Rgb::BLACK;
                    omissions.add(hit_points.left_out_at(first));
                }
                add_to(sum, *last);
                if let Some(sums) = classes.get_mut(i) {
                    add_classes(sums, *last, &layers[1..], samples);
                }
            }
            omissions
        });
        pass.reduce(Omissions::default, Omissions::followed_by)
    }

    /// Whether the last pass has brought a pixel any photon.
    #[inline]
    pub(crate) fn is_lit(&self, pixel: usize) -> bool {
        self.lit[pixel]
    }

    /// Reflected radiance of one class; `None` where they are not summed.
    pub(crate) fn class(&self, class: PathClass) -> Option<Vec<Rgb>> {
        let ClassSums { sums, photons } = self.classes.as_ref()?;
        let scale = per_photon(*photons);
        let rgb = |s: &[f64; 3]| Rgb::from_array(s.map(|c| (c * scale) as f32));
        Some(sums.iter().map(|s| rgb(&s[class as usize])).collect())
    }

    /// Photons of the passes whose light was summed by class.
    pub(crate) fn photons_by_class(&self) -> Option<u64> {
        self.classes.as_ref().map(|classes| classes.photons)
    }

    /// All radiance, emission included.
    pub(crate) fn total(&self, photons: u64) -> Vec<Rgb> {
        (0..self.sums.len()).map(|pixel| self.pixel(pixel, photons)).collect()
    }

    /// All radiance of one pixel, emission included; black beyond the image.
    pub(crate) fn pixel(&self, pixel: usize, photons: u64) -> Rgb {
        let (Some(emission), Some(sums)) = (self.emission.get(pixel), self.sums.get(pixel)) else {
            return Rgb::BLACK;
        };
        let scale = per_photon(photons);
        let e = emission.to_array();
        Rgb::from_array([0, 1, 2].map(|c| (f64::from(e[c]) + sums[c] * scale) as f32))
    }

    pub(crate) fn write(&self, out: &mut Writer) {
        for (sums, &last) in self.sums.iter().zip(&self.last) {
            sums.iter().for_each(|&sum| out.f64(sum));
            out.rgb(last);
        }
    }

    pub(crate) fn read(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        for (sums, last) in self.sums.iter_mut().zip(&mut self.last) {
            for sum in sums.iter_mut() {
                *sum = input.finite()?;
            }
            *last = input.rgb()?;
        }
        Ok(())
    }

    /// Sums by class, where there are any: they come last in a state, so that one without them is the same but for these.
    pub(crate) fn write_classes(&self, out: &mut Writer) {
        if let Some(ClassSums { sums, photons }) = &self.classes {
            out.u64(*photons);
            sums.iter().flatten().flatten().for_each(|&sum| out.f64(sum));
        }
    }

    /// Takes sums by class back. Where only the state or only this render has them, it goes on without those of the state.
    pub(crate) fn read_classes(&mut self, input: &mut Reader<'_>) -> Result<(), StateError> {
        let pixels = self.sums.len();
        let mut read = ClassSums { sums: vec![[[0.0; 3]; CLASSES]; pixels], photons: 0 };
        if !input.is_at_end() {
            read.photons = input.count()?;
            for sum in read.sums.iter_mut().flatten().flatten() {
                *sum = input.finite()?;
            }
        }
        if let Some(classes) = &mut self.classes {
            *classes = read;
        }
        Ok(())
    }

    /// Luminance of a pixel's reflected radiance, times the photons emitted.
    pub(crate) fn luminance_sum(&self, pixel: usize) -> f64 {
        let [r, g, b] = self.sums[pixel];
        let [red, green, blue] = Rgb::LUMINANCE;
        f64::from(red) * r + f64::from(green) * g + f64::from(blue) * b
    }

    /// The same of all pixels.
    pub(crate) fn luminance_sums(&self) -> f64 {
        (0..self.sums.len()).map(|pixel| self.luminance_sum(pixel)).sum()
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        let by_class = if self.classes.is_some() { Self::BYTES_BY_CLASS } else { 0 };
        self.sums.len() * (Self::BYTES_PER_PIXEL + by_class)
    }

    /// Bytes held per pixel.
    pub(crate) const BYTES_PER_PIXEL: usize =
        2 * size_of::<Rgb>() + size_of::<bool>() + size_of::<[f64; 3]>();
    /// Bytes held per pixel more by path class.
    pub(crate) const BYTES_BY_CLASS: usize = size_of::<[[f64; 3]; CLASSES]>();
}

fn per_photon(photons: u64) -> f64 {
    if photons == 0 { 0.0 } else { 1.0 / photons as f64 }
}

fn add_to(sum: &mut [f64; 3], light: Rgb) {
    for (sum, add) in sum.iter_mut().zip(light.to_array()) {
        *sum += f64::from(add);
    }
}

/// Adds a pass to a pixel's sums by class: caustic and indirect light as they were gathered, direct light as what is left of all.
fn add_classes(sums: &mut [[f64; 3]; CLASSES], whole: Rgb, gathered: &[Rgb], samples: f32) {
    let finite = |light: Rgb| if light.is_finite() { light } else { Rgb::BLACK };
    let mut rest = whole;
    for (class, &light) in [PathClass::Caustic, PathClass::Indirect].into_iter().zip(gathered) {
        let light = finite(light / samples);
        add_to(&mut sums[class as usize], light);
        rest = rest - light;
    }
    // Rounding alone is nobody's light.
    let rounding = 1e-5 * whole.max_component();
    add_to(&mut sums[PathClass::Direct as usize], rest.map(|v| if v > rounding { v } else { 0.0 }));
}
