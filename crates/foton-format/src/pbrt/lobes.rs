//! Materials that are sums of lobes, as those of version 3: a blend whose weights make up for what the lobes are scaled up to.

use std::rc::Rc;

use foton_math::Rgb;
use foton_scene::bsdf::{MicrofacetDistribution, Microfacets};
use foton_scene::description::{
    Bsdf, Conductor, Dielectric, Diffuse, DiffuseTransmitter, Number, RoughDiffuse,
};

use super::made::Coordinates;
use super::parameters::Parameters;
use super::pictures::Wanted;
use super::reader::Reader;
use super::texture::Picture;
use crate::diagnostic::Place;
use crate::image::Purpose;
use crate::mitsuba::read::known::Sides;

/// Mitsuba and foton take smaller values of alpha for this; pbrt's facets below it are a mirror.
const MIRROR_BELOW: f32 = 1e-3;

/// A lobe, and its colour.
pub(super) struct Lobe {
    pub(super) kind: LobeKind,
    pub(super) colour: Rc<Picture>,
}

/// What a lobe does with light.
pub(super) enum LobeKind {
    /// Reflects it in all directions, from facets of that deviation in radians.
    Diffuse { sigma: f32 },
    /// Passes it on in all directions.
    Passing,
    /// Reflects it as a clear boundary does.
    Gloss { ior: f32, roughness: Option<Microfacets> },
    /// Refracts it as a clear boundary does, and reflects nothing.
    Refraction { ior: f32, roughness: Option<Microfacets> },
}

/// A surface that is the same from both sides.
pub(super) fn both_sides(front: Bsdf) -> Sides {
    let back = (!front.has_two_sides()).then_some(front);
    Sides { back, ..Sides::of(front) }
}

impl Reader<'_> {
    /// The shares that lobes reflect at most, and their sum.
    pub(super) fn bounds(
        &mut self,
        lobes: &[Lobe],
        coordinates: Coordinates,
        place: Place,
    ) -> (Vec<f32>, f32) {
        let wanted = Wanted { purpose: Purpose::Number, factor: Rgb::WHITE, coordinates, place };
        let bounds: Vec<f32> = lobes.iter().map(|lobe| self.most(&lobe.colour, wanted)).collect();
        let sum = bounds.iter().sum();
        (bounds, sum)
    }

    /// The sum of lobes. Where they may reflect more than all light together, they are scaled down.
    pub(super) fn sum(&mut self, lobes: Vec<Lobe>, coordinates: Coordinates, place: Place) -> Sides {
        let (bounds, sum) = self.bounds(&lobes, coordinates, place);
        if sum > 1.001 {
            let message =
                "the lobes of this material may reflect more than all light: they are scaled down together"
                    .to_owned();
            self.report.warn_once(place, message);
        }
        let kept = lobes.into_iter().zip(bounds).filter(|(_, bound)| *bound > 0.0);
        let mut found: Option<Sides> = None;
        // The weight of a lobe is its share of all bounds, and what its colour is scaled up to makes up for it.
        let mut before = 0.0;
        for (lobe, bound) in kept {
            let sides = self.lobe(&lobe, sum.min(1.0) / bound, coordinates, place);
            before += bound;
            match &mut found {
                None => found = Some(sides),
                Some(base) => base.mixture.push((sides, Number::Constant(bound / before))),
            }
        }
        found.unwrap_or_else(|| both_sides(Bsdf::Diffuse(Diffuse { reflectance: Rgb::BLACK.into() })))
    }

    /// A lobe whose colour is scaled.
    fn lobe(&mut self, lobe: &Lobe, factor: f32, coordinates: Coordinates, place: Place) -> Sides {
        let colour = self.share(&lobe.colour, factor, coordinates, place);
        both_sides(match lobe.kind {
            LobeKind::Diffuse { sigma } if sigma > 0.0 => Bsdf::RoughDiffuse(RoughDiffuse {
                reflectance: colour,
                // There alpha is the root mean square of slopes, √2 σ.
                alpha: (std::f32::consts::SQRT_2 * sigma).into(),
                use_fast_approx: true,
            }),
            LobeKind::Diffuse { .. } => Bsdf::Diffuse(Diffuse { reflectance: colour }),
            LobeKind::Passing => Bsdf::DiffuseTransmitter(DiffuseTransmitter { transmittance: colour }),
            LobeKind::Gloss { ior, roughness } => Bsdf::Conductor(Conductor {
                // A metal that absorbs nothing on the way reflects as a clear boundary does.
                eta: Rgb::splat(ior),
                k: Rgb::BLACK,
                specular_reflectance: colour,
                roughness,
            }),
            LobeKind::Refraction { ior, roughness } => Bsdf::Dielectric(Dielectric {
                int_ior: ior,
                ext_ior: 1.0,
                specular_reflectance: Rgb::BLACK.into(),
                specular_transmittance: colour,
                roughness,
            }),
        })
    }

    /// Microfacets by the names of their roughness; `None` for a mirror. Where `rough` is set, facets of version 3 whose roughness is
    /// 0 are still rough.
    pub(super) fn facets(
        &mut self,
        p: &Parameters,
        [both, along_u, along_v]: [&'static str; 3],
        (default, rough): (f32, bool),
        coordinates: Coordinates,
    ) -> Option<Microfacets> {
        let both = self.number_picture(p, both);
        let [u, v] = [along_u, along_v].map(|name| self.number_picture(p, name));
        let default = || Rc::new(Picture::Constant(Rgb::splat(default)));
        let [u, v] = [u, v].map(|one| one.or_else(|| both.clone()).unwrap_or_else(default));
        let is_zero = |picture: &Picture| picture.constant().is_some_and(|c| c.mean() <= 0.0);
        let remaps = p.boolean("remaproughness", &mut self.report).unwrap_or(true);
        if !rough && is_zero(&u) && is_zero(&v) {
            return None;
        }
        let by: fn(f32) -> f32 = match (remaps, self.is_old()) {
            (true, true) => alpha_of_roughness,
            (true, false) => |roughness| roughness.max(0.0).sqrt(),
            (false, _) => |alpha| alpha,
        };
        let [u, v] = [u, v].map(|picture| match picture.constant() {
            Some(roughness) => Number::Constant(by(roughness.mean())),
            None => {
                let curved = if remaps { Rc::new(Picture::Curved { of: picture, by }) } else { picture };
                self.number(&curved, coordinates, p.place)
            }
        });
        if [u, v].iter().all(|n| n.constant().is_some_and(|alpha| alpha < MIRROR_BELOW)) {
            return None;
        }
        let least = |n: Number| n.constant().map_or(n, |alpha| Number::Constant(alpha.max(1e-4)));
        // Coordinates of a disk are the other way around.
        let [u, v] = if coordinates == Coordinates::Disc { [v, u] } else { [u, v] };
        Some(Microfacets { distribution: MicrofacetDistribution::Ggx, alpha_u: least(u), alpha_v: least(v) })
    }
}

/// What version 3 makes of a roughness from 0 to 1: a polynomial in its logarithm.
fn alpha_of_roughness(roughness: f32) -> f32 {
    let x = roughness.max(1e-3).ln();
    let powers = [1.621_42, 0.819_955, 0.173_4, 0.017_120_1, 0.000_640_711];
    powers.into_iter().rev().fold(0.0, |sum, c| sum * x + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roughness_of_version_3_grows_from_nearly_a_mirror() {
        assert!((alpha_of_roughness(1.0) - 1.621_42).abs() < 1e-6);
        assert!((alpha_of_roughness(0.1) - 0.454_8).abs() < 2e-2, "{}", alpha_of_roughness(0.1));
        let alphas = [0.0, 1e-3, 0.01, 0.1, 0.5, 1.0].map(alpha_of_roughness);
        assert!(alphas.windows(2).all(|pair| pair[0] <= pair[1]) && alphas[0] > 0.02, "{alphas:?}");
    }
}
