//! What a scene asks of its materials while it is built.

use crate::bsdf::Coat;
use crate::census::Census;
use crate::description::{Bsdf, Colour, Material};

impl Material {
    pub(super) fn bsdfs(&self) -> impl Iterator<Item = &Bsdf> {
        [Some(&self.front), self.back.as_ref()].into_iter().flatten()
    }

    /// Whether its roughness differs along u and v.
    pub(crate) fn is_anisotropic(&self) -> bool {
        self.bsdfs().filter_map(Bsdf::roughness).any(|r| r.alpha_u != r.alpha_v)
    }

    /// The colours of its sides where they are Lambertian and nothing else.
    pub(super) fn lambertian(&self) -> [Option<Colour>; 2] {
        let colour = |bsdf: Option<&Bsdf>| match bsdf {
            Some(Bsdf::Diffuse { reflectance }) if self.opacity.is_none() => Some(*reflectance),
            _ => None,
        };
        let back = if self.front.transmits() { Some(&self.front) } else { self.back.as_ref() };
        [colour(Some(&self.front)), colour(back)]
    }

    /// The rough coats of its sides.
    pub(super) fn coats(&self) -> [Option<Coat>; 2] {
        let front = Coat::of(&self.front);
        let same = self.back == Some(self.front);
        [front, if same { front } else { self.back.as_ref().and_then(Coat::of) }]
    }

    /// All colours that it looks up.
    pub(super) fn colours(&self) -> impl Iterator<Item = Colour> {
        let mut colours: Vec<Colour> = self.opacity.into_iter().collect();
        for bsdf in self.bsdfs() {
            let _ = bsdf.map(|c| colours.push(c));
        }
        colours.into_iter()
    }
}

impl Census {
    /// Notes what a material with or without interpolated normals asks for.
    pub(super) fn count(&mut self, material: &Material, smooth: bool) {
        for bsdf in material.bsdfs() {
            self.shading_normals |= bsdf.gathers() && smooth;
            self.specular |= bsdf.has_specular() || material.opacity.is_some();
            self.refraction |= bsdf.transmits();
            self.narrow_gloss |= bsdf.has_specular() && bsdf.roughness().is_some();
            self.single_directions |=
                bsdf.has_specular() && bsdf.roughness().is_none() && !matches!(bsdf, Bsdf::Null);
            self.straight |=
                material.opacity.is_some() || matches!(bsdf, Bsdf::Null | Bsdf::ThinDielectric { .. });
            self.rough_coats |= matches!(bsdf, Bsdf::Plastic { roughness: Some(_), .. });
            self.gathered_gloss |= bsdf.gathers() && !matches!(bsdf, Bsdf::Diffuse { .. });
        }
    }
}
