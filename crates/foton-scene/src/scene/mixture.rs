//! Surfaces that are blended of several materials, and normals that a relief perturbs.
//!
//! A path that meets such a surface first takes a *component* of it: one of the materials, which is the surface's own from then on.
//! Photons and path tracers choose it at random by the weights there; eye paths that hit points come from take every component with its
//! weight.

use std::cell::LazyCell;

use super::Scene;
use super::lookup::Footprint;
use crate::build::BuildError;
use crate::description::{Material, Number};
use crate::surface::Surface;

/// More components than this make no material.
const MAX_COMPONENTS: usize = 64;

/// A material of a mixture.
#[derive(Clone, Debug)]
struct Component {
    /// Index of the material.
    material: u32,
    /// Its weight is the product of these: a blend's weight, or what a blend leaves of it.
    factors: Vec<Factor>,
}

#[derive(Clone, Copy, Debug)]
struct Factor {
    weight: Number,
    /// Whether one less the weight counts.
    is_rest: bool,
}

/// What each material is blended of.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mixtures(Vec<Vec<Component>>);

impl Mixtures {
    /// Resolves what materials say of each other.
    pub(crate) fn new(materials: &[Material]) -> Result<Self, BuildError> {
        if materials.iter().all(|m| m.mixture.is_empty()) {
            return Ok(Self::default());
        }
        let of = |index: usize| {
            let mut components = Vec::new();
            if materials[index].mixture.is_empty() || flatten(materials, index, &[], 0, &mut components) {
                Ok(components)
            } else {
                Err(BuildError::BadMixture(materials[index].name.clone()))
            }
        };
        (0..materials.len()).map(of).collect::<Result<_, _>>().map(Self)
    }

    /// Whether any material is blended of several.
    pub(crate) const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn of(&self, material: u32) -> &[Component] {
        self.0.get(material as usize).map_or(&[], Vec::as_slice)
    }

    /// The index of the material that a component of a material is.
    #[inline]
    pub(crate) fn material(&self, material: u32, component: u16) -> u32 {
        self.of(material).get(usize::from(component)).map_or(material, |p| p.material)
    }

    /// The materials that a material is blended of, itself first.
    pub(crate) fn materials(&self, material: usize) -> impl Iterator<Item = usize> + Clone {
        let components = self.of(material as u32);
        let alone = components.is_empty().then_some(material);
        alone.into_iter().chain(components.iter().map(|p| p.material as usize))
    }
}

/// Adds the components of a material; whether it is made of others that are there, and not of itself.
fn flatten(
    materials: &[Material],
    index: usize,
    factors: &[Factor],
    depth: usize,
    components: &mut Vec<Component>,
) -> bool {
    let Some(material) =
        materials.get(index).filter(|_| depth < MAX_COMPONENTS && components.len() < MAX_COMPONENTS)
    else {
        return false;
    };
    // What is blended in last leaves the least of what came first.
    let rests = material.mixture.iter().map(|blend| Factor { weight: blend.weight, is_rest: true });
    let rests: Vec<Factor> = rests.collect();
    let own = factors.iter().chain(&rests).copied().collect();
    components.push(Component { material: index as u32, factors: own });
    material.mixture.iter().enumerate().all(|(i, blend)| {
        let mut factors = factors.to_vec();
        factors.push(Factor { weight: blend.weight, is_rest: false });
        factors.extend(&rests[i + 1..]);
        flatten(materials, blend.material, &factors, depth + 1, components)
    })
}

impl Scene {
    /// Whether the material of a surface is blended of several.
    #[must_use]
    #[inline(always)]
    pub fn is_mixture(&self, surface: &Surface) -> bool {
        !self.mixtures.is_empty() && self.mixtures.of(self.own_material(surface)).len() > 1
    }

    /// The components of a surface with their weights, which sum to 1: for most surfaces it is one, itself. `outward`: on which side the
    /// path is, whose normal a relief perturbs.
    pub fn components(&self, surface: &Surface, outward: bool) -> impl Iterator<Item = (Surface, f32)> {
        self.components_seen(surface, outward, None)
    }

    /// The same, weights and normals the means over what an eye sample sees around the point.
    pub fn components_seen(
        &self,
        surface: &Surface,
        outward: bool,
        footprint: Option<&Footprint>,
    ) -> impl Iterator<Item = (Surface, f32)> {
        let components =
            if self.is_mixture(surface) { self.mixtures.of(self.own_material(surface)) } else { &[] };
        let alone = components.is_empty().then(|| (self.relieved(*surface, outward, footprint), 1.0));
        let all = (0u16..).zip(components).map(move |(component, it)| {
            let weight = self.weight(surface, it, footprint);
            (self.relieved(Surface { component, ..*surface }, outward, footprint), weight)
        });
        alone.into_iter().chain(all.filter(|(_, weight)| *weight > 0.0))
    }

    /// Makes of a surface one of its components, chosen with its weight by `u` in [0, 1); returns what the choice leaves of `u`: again in
    /// [0, 1).
    #[inline(always)]
    pub fn choose_component(&self, surface: &mut Surface, outward: bool, u: f32) -> f32 {
        if self.mixtures.is_empty() && !self.census.reliefs {
            return u;
        }
        self.choose_among(surface, outward, u)
    }

    #[inline(never)]
    fn choose_among(&self, surface: &mut Surface, outward: bool, u: f32) -> f32 {
        if !self.is_mixture(surface) {
            *surface = self.relieved(*surface, outward, None);
            return u;
        }
        let mut left = u;
        let mut chosen = (0, 1.0);
        for (component, it) in (0u16..).zip(self.mixtures.of(self.own_material(surface))) {
            let weight = self.weight(surface, it, None);
            if weight > 0.0 {
                chosen = (component, weight);
                if left < weight {
                    break;
                }
                left -= weight;
            }
        }
        let (component, weight) = chosen;
        // Weights sum to 1 but for rounding.
        *surface = self.relieved(Surface { component, ..*surface }, outward, None);
        (left / weight).clamp(0.0, 1.0 - f32::EPSILON)
    }

    /// Index of the material of a surface's shape.
    fn own_material(&self, surface: &Surface) -> u32 {
        self.shapes[surface.shape as usize].material
    }

    /// Index of the material that counts at a surface: that of the component that has been taken.
    #[inline(always)]
    pub(crate) fn material_index(&self, surface: &Surface) -> usize {
        let own = self.own_material(surface);
        (if surface.component == 0 { own } else { self.mixtures.material(own, surface.component) }) as usize
    }

    fn weight(&self, surface: &Surface, component: &Component, footprint: Option<&Footprint>) -> f32 {
        let lookup = LazyCell::new(|| self.lookup(surface, footprint));
        let factor = |factor: &Factor| {
            let weight = match factor.weight {
                Number::Constant(weight) => weight,
                Number::Texture(texture) => lookup.scalar(&self.textures[texture]),
            };
            let weight = weight.clamp(0.0, 1.0);
            if factor.is_rest { 1.0 - weight } else { weight }
        };
        component.factors.iter().map(factor).product()
    }
}
