//! What a scene asks of its materials while it is built.

use std::sync::Arc;

use foton_math::Rgb;

use crate::bsdf::{Coats, LobeFlags};
use crate::census::{BsdfKind, Census};
use crate::description::{Bsdf, Colour, Material, Number};
use crate::texture::Sampler;

/// A glossy lobe of at most this roughness α throws caustics: nearly as sharp as those of a mirror.
const MAX_CASTER_ROUGHNESS: f32 = 0.1;

impl Material {
    pub(super) fn bsdfs(&self) -> impl Iterator<Item = &Bsdf> {
        [Some(&self.front), self.back.as_ref()].into_iter().flatten()
    }

    /// Whether its roughness differs along u and v.
    pub(crate) fn is_anisotropic(&self) -> bool {
        self.bsdfs().any(Bsdf::is_anisotropic)
    }

    /// The colours of its sides where they are Lambertian and nothing else.
    pub(super) fn lambertian(&self) -> [Option<Colour>; 2] {
        if self.relief.is_some() || !self.mixture.is_empty() {
            return [None; 2];
        }
        let colour = |bsdf: Option<&Bsdf>| bsdf.filter(|_| self.opacity.is_none()).and_then(Bsdf::lambertian);
        let back = if self.front.has_two_sides() { Some(&self.front) } else { self.back.as_ref() };
        [colour(Some(&self.front)), colour(back)]
    }

    /// The rough coats of its sides.
    pub(super) fn coats(&self, textures: &[Arc<Sampler>]) -> [Option<Coats>; 2] {
        let coats = |bsdf: &Bsdf| bsdf.rough_coats(|n, range| ends(n, range, textures));
        let front = coats(&self.front);
        let same = self.back == Some(self.front);
        let back = if same { front.clone() } else { self.back.as_ref().and_then(coats) };
        [front, back]
    }

    /// All colours that it looks up.
    pub(super) fn colours(&self) -> impl Iterator<Item = Colour> {
        let mut colours: Vec<Colour> = self.opacity.into_iter().collect();
        for bsdf in self.bsdfs() {
            let _ = bsdf.map(|c| colours.push(c), |_, _| ());
        }
        colours.into_iter()
    }

    /// All textures that it looks up, for colours, numbers or normals.
    pub(super) fn textures(&self) -> impl Iterator<Item = usize> {
        let mut numbers: Vec<Number> = self.mixture.iter().map(|blend| blend.weight).collect();
        for bsdf in self.bsdfs() {
            let _ = bsdf.map(|_| (), |n, _| numbers.push(n));
        }
        let of_numbers = numbers.into_iter().filter_map(|n| match n {
            Number::Texture(i) => Some(i),
            Number::Constant(_) => None,
        });
        let of_colours = self.colours().filter_map(|c| match c {
            Colour::Texture(i) => Some(i),
            Colour::Constant(_) => None,
        });
        of_colours.chain(of_numbers).chain(self.relief.map(|relief| relief.texture))
    }

    /// Whether it throws caustics.
    pub(super) fn casts(&self, textures: &[Arc<Sampler>]) -> bool {
        self.bsdfs().any(|bsdf| {
            bsdf.flags().intersects(LobeFlags::DELTA)
                || bsdf.refracts()
                || gloss(bsdf, textures).is_some_and(|[least, _]| least <= MAX_CASTER_ROUGHNESS)
        })
    }

    /// Whether it spreads light, so that photons may be stored there.
    pub(super) fn spreads(&self) -> bool {
        self.bsdfs().any(|bsdf| bsdf.flags().spreads())
    }
}

/// The least and the greatest value of a number, within the range that it may have.
fn ends(number: Number, [low, high]: [f32; 2], textures: &[Arc<Sampler>]) -> [f32; 2] {
    match number {
        Number::Constant(x) => [x; 2],
        Number::Texture(i) => textures[i].scalar_range().map(|x| x.clamp(low, high)),
    }
}

/// The least and the greatest roughness of a BSDF's glossy lobes, if it has any.
fn gloss(bsdf: &Bsdf, textures: &[Arc<Sampler>]) -> Option<[f32; 2]> {
    // A model's roughness grows or falls with each of its numbers.
    let [a, b] = [0, 1].map(|end| bsdf.map(|_| Rgb::BLACK, |n, range| ends(n, range, textures)[end]).gloss());
    a.zip(b).map(|(a, b)| [a.min(b), a.max(b)])
}

impl Census {
    /// Notes what a material with or without interpolated normals asks for. Where a texture gives its roughness, its least and its
    /// greatest count.
    pub(super) fn count(
        &mut self,
        material: &Material,
        textures: &[Arc<Sampler>],
        interpolated_normals: bool,
    ) {
        for bsdf in material.bsdfs() {
            let (flags, masked) = (bsdf.flags(), material.opacity.is_some());
            let lambertian = bsdf.lambertian().is_some();
            let interpolated_normals = interpolated_normals || material.relief.is_some();
            let ends = gloss(bsdf, textures);
            for roughness in [ends.map(|e| e[0]), ends.map(|e| e[1])] {
                let kind = BsdfKind { flags, roughness, interpolated_normals, lambertian, masked };
                if !self.bsdfs.contains(&kind) {
                    self.bsdfs.push(kind);
                }
            }
            self.reliefs |= material.relief.is_some();
            self.mixtures |= !material.mixture.is_empty();
            self.refraction |= bsdf.refracts();
            self.straight |= masked || flags.intersects(LobeFlags::STRAIGHT);
            self.rough_coats |= matches!(bsdf, Bsdf::Plastic(plastic) if plastic.roughness.is_some());
        }
    }
}
