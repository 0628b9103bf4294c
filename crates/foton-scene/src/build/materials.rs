//! What a scene asks of its materials while it is built.

use std::sync::Arc;

use foton_math::Rgb;

use crate::bsdf::{Coats, LobeFlags};
use crate::census::{BsdfKind, Census};
use crate::description::{Bsdf, Coating, Colour, Material, Number};
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
        let colour = |bsdf: Option<&Bsdf>, i: usize| {
            let is_bare = self.opacity.is_none() && self.coatings[i].is_none();
            bsdf.filter(|_| is_bare).and_then(Bsdf::lambertian)
        };
        let back = if self.front.has_two_sides() { Some(&self.front) } else { self.back.as_ref() };
        [colour(Some(&self.front), 0), colour(back, usize::from(!self.front.has_two_sides()))]
    }

    /// The BSDFs of its sides with what lies over them.
    fn covered(&self) -> impl Iterator<Item = (&Bsdf, Option<&Coating>)> {
        let front = (&self.front, self.coatings[0].as_ref());
        let back = self.back.as_ref().map(|back| (back, self.coatings[1].as_ref()));
        std::iter::once(front).chain(back)
    }

    /// What gets through the rough coats and coatings of its sides.
    pub(super) fn coats(&self, textures: &[Arc<Sampler>]) -> [Option<Coats>; 2] {
        let ends = |n, range| ends(n, range, textures);
        let coats = |bsdf: &Bsdf, coating: Option<Coating>| {
            coating.map_or_else(|| bsdf.rough_coats(ends), |coating| coating.rough_coats(ends))
        };
        let [over_front, over_back] = self.coatings;
        let front = coats(&self.front, over_front);
        let same = self.back == Some(self.front) && over_front == over_back;
        let back = if same { front.clone() } else { self.back.as_ref().and_then(|b| coats(b, over_back)) };
        [front, back]
    }

    /// All colours that it looks up and that are shares of light.
    pub(super) fn colours(&self) -> impl Iterator<Item = Colour> {
        let mut colours: Vec<Colour> = self.opacity.into_iter().collect();
        for bsdf in self.bsdfs() {
            let _ = bsdf.map(|c| colours.push(c), |_, _| ());
        }
        colours.into_iter()
    }

    /// All textures that it looks up itself, by index: for colours, numbers or normals. Those of materials that are blended with it are
    /// not among them.
    pub fn textures(&self) -> impl Iterator<Item = usize> {
        let mut numbers: Vec<Number> = self.mixture.iter().map(|blend| blend.weight).collect();
        for bsdf in self.bsdfs() {
            let _ = bsdf.map(|_| (), |n, _| numbers.push(n));
        }
        let mut colours: Vec<Colour> = self.colours().collect();
        for coating in self.coatings.iter().flatten() {
            let _ = coating.map(|c| colours.push(c), |n, _| numbers.push(n));
        }
        let of_numbers = numbers.into_iter().filter_map(|n| match n {
            Number::Texture(i) => Some(i),
            Number::Constant(_) => None,
        });
        let of_colours = colours.into_iter().filter_map(|c| match c {
            Colour::Texture(i) => Some(i),
            Colour::Constant(_) => None,
        });
        of_colours.chain(of_numbers).chain(self.relief.map(|relief| relief.texture))
    }

    /// Whether it throws caustics.
    pub(super) fn casts(&self, textures: &[Arc<Sampler>]) -> bool {
        self.covered().any(|(bsdf, coating)| {
            bsdf.refracts()
                || ends_of_lobes(bsdf, coating, textures).iter().any(|(flags, gloss)| {
                    let is_narrow = gloss.is_some_and(|alpha| alpha <= MAX_CASTER_ROUGHNESS);
                    is_narrow || flags.intersects(LobeFlags::DELTA)
                })
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

/// The lobes of a BSDF under what lies over it and the roughness of the glossy ones, for the least and the greatest values of its
/// numbers; the smaller roughness first.
fn ends_of_lobes(
    bsdf: &Bsdf,
    coating: Option<&Coating>,
    textures: &[Arc<Sampler>],
) -> [(LobeFlags, Option<f32>); 2] {
    // A model's roughness grows or falls with each of its numbers.
    let [a, b] = [0, 1].map(|end| {
        let number = |n, range| ends(n, range, textures)[end];
        let gloss = bsdf.map(|_| Rgb::BLACK, number).gloss();
        let coating = coating.map(|c| c.map(|_| Rgb::BLACK, number));
        coating.map_or((bsdf.flags(), gloss), |c| c.over(bsdf.flags(), gloss))
    });
    if a.1 <= b.1 { [a, b] } else { [b, a] }
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
        for (bsdf, coating) in material.covered() {
            let masked = material.opacity.is_some();
            let lambertian = bsdf.lambertian().is_some() && coating.is_none();
            let interpolated_normals = interpolated_normals || material.relief.is_some();
            for (flags, roughness) in ends_of_lobes(bsdf, coating, textures) {
                let kind = BsdfKind { flags, roughness, interpolated_normals, lambertian, masked };
                if !self.bsdfs.contains(&kind) {
                    self.bsdfs.push(kind);
                }
            }
            self.reliefs |= material.relief.is_some();
            self.mixtures |= !material.mixture.is_empty();
            self.refraction |= bsdf.refracts();
            self.straight |= masked || bsdf.flags().intersects(LobeFlags::STRAIGHT);
            self.rough_coats |= matches!(bsdf, Bsdf::Plastic(plastic) if plastic.roughness.is_some())
                || coating.is_some_and(|c| c.roughness.is_some());
        }
    }
}
