//! The BSDF at a point, its colours and numbers looked up.

use std::cell::LazyCell;

use foton_math::Rgb;

use super::{Footprint, Scene};
use crate::bsdf::{Cover, Scattering};
use crate::description::{Bsdf, Coating, Colour, Diffuse, Number};
use crate::surface::Surface;

/// The side that a material does not describe.
const BLACK: Bsdf = Bsdf::Diffuse(Diffuse { reflectance: Colour::Constant(Rgb::BLACK) });

impl Scene {
    /// How the surface scatters light on the side of `outward` (whether the light's direction is on the normal's side), with
    /// its colours and numbers looked up. `None`: that side is black. A side without a BSDF takes all light that meets it, and where there is
    /// an opacity the rest passes it all the same.
    #[must_use]
    #[inline(always)]
    pub fn scattering(&self, surface: &Surface, outward: bool) -> Option<Scattering> {
        self.scattering_seen(surface, outward, None)
    }

    /// The same, its colours the means over what an eye sample sees around the point. Without a footprint those at the point.
    #[must_use]
    #[inline(always)]
    pub fn scattering_seen(
        &self,
        surface: &Surface,
        outward: bool,
        footprint: Option<&Footprint>,
    ) -> Option<Scattering> {
        let index = self.material_index(surface);
        let material = &self.materials[index];
        let front = outward || material.front.has_two_sides();
        let bsdf = match &material.back {
            _ if front => &material.front,
            Some(back) => back,
            None if material.opacity.is_some() => &BLACK,
            None => return None,
        };
        let coats = self.coats.get(index);
        let coats = coats.and_then(|c| c[usize::from(!front)].as_ref());
        let coating = &material.coatings[usize::from(!front)];
        let complete = |bsdf: Bsdf<Rgb, f32>, coating: Option<Coating<Rgb, f32>>, opacity: f32| {
            let coat = match coating {
                None => coats.map(|coats| Cover::Coat(coats.at(bsdf.gloss().unwrap_or(0.0)))),
                Some(coating) => Some(Cover::Layer(coating.layer(coats))),
            };
            Some(Scattering { bsdf: surface.between(bsdf), opacity, coat })
        };
        if !self.census.textures {
            let constant = |c: Colour| if let Colour::Constant(c) = c { c } else { Rgb::BLACK };
            let opacity = material.opacity.map_or(1.0, |c| constant(c).mean());
            let number = |n: Number, _| if let Number::Constant(x) = n { x } else { 0.0 };
            return complete(bsdf.map(constant, number), coating.map(|c| c.map(constant, number)), opacity);
        }
        let lookup = LazyCell::new(|| self.lookup(surface, footprint));
        let opacity = material.opacity.map_or(1.0, |c| match c {
            Colour::Constant(c) => c.mean(),
            Colour::Texture(t) => lookup.scalar(&self.textures[t]),
        });
        let colour = |c: Colour| match c {
            Colour::Constant(c) => c,
            Colour::Texture(t) => lookup.colour(&self.textures[t]),
        };
        let number = |n: Number, [low, high]: [f32; 2]| match n {
            Number::Constant(x) => x,
            Number::Texture(t) => lookup.scalar(&self.textures[t]).clamp(low, high),
        };
        let (found, coating) = (bsdf.map(colour, number), coating.map(|c| c.map(colour, number)));
        // Light passes elsewhere on the surface and not here: this side is black.
        let is_behind = front && !outward && !found.has_two_sides();
        let black = Bsdf::Diffuse(Diffuse { reflectance: Rgb::BLACK });
        if is_behind {
            return complete(black, None, opacity.clamp(0.0, 1.0));
        }
        complete(found, coating, opacity.clamp(0.0, 1.0))
    }

    /// The reflectance of a side that is Lambertian and nothing else, its colour looked up: what most photons meet, and with a
    /// fraction of what [`Scene::scattering`] costs. `None` for all others.
    #[must_use]
    #[inline(always)]
    pub fn lambertian(&self, surface: &Surface, outward: bool) -> Option<Rgb> {
        match self.lambertian[surface.shape as usize][usize::from(!outward)]? {
            Colour::Constant(c) => Some(c),
            Colour::Texture(t) => Some(self.lookup(surface, None).colour(&self.textures[t])),
        }
    }
}
