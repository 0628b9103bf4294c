//! What a scene asks of its materials while it is built.

use crate::bsdf::{Coat, LobeFlags};
use crate::census::{BsdfKind, Census};
use crate::description::{Bsdf, Colour, Material, Number};

/// A glossy lobe of at most this roughness α throws caustics: nearly as sharp as those of a mirror.
const MAX_CASTER_ROUGHNESS: f32 = 0.1;

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
        if self.relief.is_some() || !self.mixture.is_empty() {
            return [None; 2];
        }
        let colour = |bsdf: Option<&Bsdf>| bsdf.filter(|_| self.opacity.is_none()).and_then(Bsdf::lambertian);
        let back = if self.front.transmits() { Some(&self.front) } else { self.back.as_ref() };
        [colour(Some(&self.front)), colour(back)]
    }

    /// The rough coats of its sides.
    pub(super) fn coats(&self) -> [Option<Coat>; 2] {
        let front = self.front.rough_coat();
        let same = self.back == Some(self.front);
        [front, if same { front } else { self.back.as_ref().and_then(Bsdf::rough_coat) }]
    }

    /// All colours that it looks up.
    pub(super) fn colours(&self) -> impl Iterator<Item = Colour> {
        let mut colours: Vec<Colour> = self.opacity.into_iter().collect();
        for bsdf in self.bsdfs() {
            let _ = bsdf.map(|c| colours.push(c));
        }
        colours.into_iter()
    }

    /// All textures that it looks up.
    pub(super) fn textures(&self) -> impl Iterator<Item = usize> {
        let of_colours =
            self.colours().filter_map(|c| if let Colour::Texture(t) = c { Some(t) } else { None });
        let of_weights = self
            .mixture
            .iter()
            .filter_map(|b| if let Number::Texture(t) = b.weight { Some(t) } else { None });
        of_colours.chain(of_weights).chain(self.relief.map(|relief| relief.texture))
    }

    /// Whether it throws caustics.
    pub(super) fn casts(&self) -> bool {
        self.bsdfs().any(|bsdf| {
            bsdf.flags().intersects(LobeFlags::DELTA)
                || bsdf.transmits()
                || bsdf.roughness().is_some_and(|r| r.widest() <= MAX_CASTER_ROUGHNESS)
        })
    }

    /// Whether it spreads light, so that photons may be stored there.
    pub(super) fn spreads(&self) -> bool {
        self.bsdfs().any(|bsdf| bsdf.flags().spreads())
    }
}

impl Census {
    /// Notes what a material with or without interpolated normals asks for.
    pub(super) fn count(&mut self, material: &Material, interpolated_normals: bool) {
        for bsdf in material.bsdfs() {
            let (flags, masked) = (bsdf.flags(), material.opacity.is_some());
            let roughness = bsdf.roughness().map(|r| r.widest());
            let lambertian = bsdf.lambertian().is_some();
            let interpolated_normals = interpolated_normals || material.relief.is_some();
            let kind = BsdfKind { flags, roughness, interpolated_normals, lambertian, masked };
            if !self.bsdfs.contains(&kind) {
                self.bsdfs.push(kind);
            }
            self.reliefs |= material.relief.is_some();
            self.mixtures |= !material.mixture.is_empty();
            self.refraction |= bsdf.transmits();
            self.straight |= masked || flags.intersects(LobeFlags::STRAIGHT);
            self.rough_coats |= matches!(bsdf, Bsdf::Plastic(plastic) if plastic.roughness.is_some());
        }
    }
}
