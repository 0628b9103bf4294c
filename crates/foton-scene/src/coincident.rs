//! Surfaces that lie in one another: which of them a ray meets, and what the boundary of two clear ones is.
//!
//! Exporters set a glass block exactly on a floor and state the face between water and glass twice. A ray meets both at one
//! distance, or in the order that rounding gives them, and the next ray starts beyond both. So pairs of primitives that share a
//! part of a surface, within what single precision can tell apart, are found when a scene is built, and where a ray hits one of
//! them the hit is settled: an emitter before what is opaque, that before what is clear, then the order of the file; the faces
//! of two dielectrics become the one boundary between their inner media. Scenes without such pairs pay a look at an empty list.

mod sheet;

use foton_math::glam::DVec3;
use foton_math::{Aabb, Cancelled, Ray};
use rayon::prelude::*;

use crate::build::{BuildOptions, BuildStep};
use crate::description::{Bsdf, Colour, Material};
use crate::scene::Scene;
use crate::surface::Surface;
use sheet::{Face, Sheet, coincide, meet_at, tolerance, weights};

/// Surfaces that are told apart at one point.
const MOST: usize = 8;

/// What a primitive has in common with others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Share {
    /// Whether a part of its surface.
    pub(crate) any: bool,
    /// Whether another may count there, or it is one boundary with another, for light from inside and from outside.
    unsettled: [bool; 2],
}

impl Share {
    /// Whether hits from a side are to be settled.
    #[inline(always)]
    pub(crate) const fn is_unsettled(self, outward: bool) -> bool {
        self.unsettled[outward as usize]
    }
}

/// Of the primitives near another, so many are looked at, and so many kept: a heap of thousands in one place must not take for ever.
const MOST_NEAR: usize = 512;
const MOST_PARTNERS: usize = 16;

/// The primitives that share a part of their surface with another.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coincidences {
    /// By primitive in the tree's order; empty where there are none.
    shared: Vec<Share>,
    /// Pairs of shapes that share a part of a surface, the lower index first, each once, and whether their normals agree.
    shapes: Vec<([u32; 2], bool)>,
    /// By shape: how far apart its surface and those in it may be, for rays that start there.
    gaps: Vec<f32>,
}

impl Coincidences {
    /// Finds all pairs.
    pub(crate) fn find(scene: &Scene, options: &BuildOptions<'_>) -> Result<Self, Cancelled> {
        let accel = &scene.accel;
        let (primitives, shape_of) = (accel.primitives(), |i: usize| scene.shape_of(i));
        let gauge = options.step(BuildStep::Coincidences, primitives.len());
        let mut pairs: Vec<[u32; 2]> = (0..primitives.len())
            .into_par_iter()
            .filter(|&i| gauge.item(i).is_ok() && gauge.check().is_ok())
            .flat_map_iter(|i| {
                let (mut partners, own) = (Vec::new(), Face::of(&primitives[i]));
                // A small face on a large floor is found from its own side, whatever else lies near the floor.
                accel.for_each_near(&primitives[i].bounds(), MOST_NEAR, |j| {
                    if j != i && partners.len() < MOST_PARTNERS && coincide(&own, &Face::of(&primitives[j])) {
                        partners.push([i.min(j) as u32, i.max(j) as u32]);
                    }
                });
                partners
            })
            .collect();
        gauge.check()?;
        pairs.par_sort_unstable();
        pairs.dedup();
        if pairs.is_empty() {
            return Ok(Self::default());
        }
        let count = scene.shapes.len();
        let (mut shared, mut gaps) = (vec![Share::default(); primitives.len()], vec![0f32; count]);
        let mut shapes = Vec::with_capacity(pairs.len());
        for (number, pair) in pairs.into_iter().enumerate() {
            gauge.item(number)?;
            let [a, b] = pair.map(|i| i as usize);
            let gap = 2.0 * tolerance(&primitives[a], &primitives[b]) as f32;
            let normal = |i: usize| Sheet::of(&primitives[i], primitives[i].bounds().max.as_dvec3()).normal;
            let agree = normal(a).dot(normal(b)) > 0.0;
            for (i, other) in [(a, b), (b, a)] {
                shared[i].any = true;
                for outward in [false, true] {
                    shared[i].unsettled[usize::from(outward)] |= !scene.counts(i, other, outward, agree);
                }
                gaps[shape_of(i) as usize] = gaps[shape_of(i) as usize].max(gap);
            }
            let mut pair = pair.map(|i| shape_of(i as usize));
            pair.sort_unstable();
            shapes.push((pair, agree));
        }
        shapes.sort_unstable();
        shapes.dedup();
        shapes.retain(|([a, b], _)| a != b);
        Ok(Self { shared, shapes, gaps })
    }

    /// What a primitive has in common with others.
    #[inline(always)]
    pub(crate) fn share(&self, primitive: u32) -> Share {
        self.shared.get(primitive as usize).copied().unwrap_or_default()
    }

    /// How far from a shape's surface another may lie that counts as the same.
    pub(crate) fn gap(&self, shape: usize) -> f32 {
        self.gaps.get(shape).copied().unwrap_or(0.0)
    }
}

/// A surface as a ray that comes to it may meet it.
#[derive(Clone, Copy)]
struct Candidate {
    primitive: u32,
    shape: u32,
    rank: u8,
    normal: DVec3,
    gap: f64,
}

impl Scene {
    /// Makes of the surface that a ray hit the one that counts among those that lie in it.
    #[inline(never)]
    pub(crate) fn settle(&self, ray: &Ray, hit: &mut Surface) {
        let primitives = self.accel.primitives();
        let (own, p) = (&primitives[hit.primitive as usize], hit.position.as_dvec3());
        let mut found = [None; MOST];
        let mut count = 0;
        let reach = hit.error.max_element() + 2.0 * self.coincidences.gap(hit.shape as usize);
        self.accel.for_each_near(&Aabb::around(hit.position, reach), MOST_NEAR, |j| {
            let primitive = &primitives[j];
            let is_own = j as u32 == hit.primitive;
            if !is_own && (!self.coincidences.share(j as u32).any || !meet_at(own, primitive, p)) {
                return;
            }
            let sheet = Sheet::of(primitive, p);
            let (shape, gap) = (self.shape_of(j), sheet.distance.abs() + tolerance(own, primitive));
            let rank = self.rank(shape, -ray.direction.as_dvec3().dot(sheet.normal) > 0.0);
            // Two triangles of one shape share a diagonal.
            let known = found[..count]
                .iter()
                .flatten()
                .any(|c: &Candidate| c.shape == shape && c.normal.dot(sheet.normal) > 0.0 && !is_own);
            if !known && count < MOST {
                found[count] =
                    Some(Candidate { primitive: j as u32, shape, rank, normal: sheet.normal, gap });
                count += 1;
            }
        });
        let found = &mut found[..count];
        // The order of the tree is none of the file's.
        found.sort_unstable_by_key(|c| c.map(|c| (std::cmp::Reverse(c.rank), c.shape, c.primitive)));
        let Some(first) = found.first().copied().flatten().filter(|_| count > 1) else { return };
        if first.primitive != hit.primitive {
            let primitive = &primitives[first.primitive as usize];
            *hit = self.surface_of(ray, first.primitive, weights(primitive, p), hit.position);
        }
        let gap = found.iter().flatten().map(|c| c.gap).fold(0.0, f64::max) as f32;
        hit.error += hit.normal.abs() * (2.0 * gap);
        hit.interface = self.merged(first, found.iter().flatten().skip(1));
    }

    /// Which surface counts: the highest on the side that a ray comes to.
    fn rank(&self, shape: u32, outward: bool) -> u8 {
        let material = self.material(shape);
        match self.shapes[shape as usize].emitter {
            Some(_) if outward => 4,
            _ if material.shows(outward) => 3,
            _ if material.is_opaque() => 2,
            _ => u8::from(material.front != Bsdf::Null),
        }
    }

    /// Whether of two primitives that share a part of a surface the first counts there on a side of its own, as it is.
    fn counts(&self, first: usize, other: usize, outward: bool, agree: bool) -> bool {
        let [shape, its_shape] = [first, other].map(|i| self.shape_of(i));
        let fronts = [shape, its_shape].map(|s| self.material(s).front);
        let two_dielectrics = fronts.iter().all(|f| matches!(f, Bsdf::Dielectric { .. }));
        let (rank, its_rank) = (self.rank(shape, outward), self.rank(its_shape, outward == agree));
        !two_dielectrics && (rank > its_rank || rank == its_rank && (shape, first) < (its_shape, other))
    }

    /// The indices inside and outside of a dielectric in which others lie, by its own normal.
    fn merged<'a>(&self, first: Candidate, others: impl Iterator<Item = &'a Candidate>) -> Option<[f32; 2]> {
        let indices = |c: &Candidate| match self.material(c.shape).front {
            Bsdf::Dielectric { int_ior, ext_ior, .. } => Some([int_ior, ext_ior]),
            _ => None,
        };
        let [mut inside, mut outside] = indices(&first)?;
        let mut merged = false;
        for other in others.filter(|c| c.shape != first.shape) {
            let Some([its_inside, its_outside]) = indices(other) else { continue };
            merged = true;
            if other.normal.dot(first.normal) < 0.0 {
                outside = its_inside;
            } else if its_outside == inside {
                inside = its_inside;
            } else if its_inside == outside {
                outside = its_outside;
            }
        }
        merged.then_some([inside, outside])
    }

    /// Whether any surfaces lie in one another.
    #[must_use]
    pub fn has_coincident_surfaces(&self) -> bool {
        !self.coincidences.shared.is_empty()
    }

    /// Pairs of shapes of which the first hides the second where both lie in one surface and face the same way: the first is
    /// opaque, the second is too or is a mask. Emitters are none of them, nor is what stands on a floor.
    pub fn hidden_shapes(&self) -> impl Iterator<Item = [u32; 2]> {
        self.coincidences.shapes.iter().filter(|(_, agree)| *agree).filter_map(|&([a, b], _)| {
            let hides = |a: u32, b: u32| {
                let (over, under) = (self.material(a), self.material(b));
                over.is_opaque() && (under.is_opaque() || under.opacity.is_some())
            };
            let emits = |s: u32| self.shapes[s as usize].emitter.is_some();
            match (emits(a) || emits(b), hides(a, b), hides(b, a)) {
                (true, ..) | (_, false, false) => None,
                (_, true, _) => Some([a, b]),
                (_, false, true) => Some([b, a]),
            }
        })
    }
}

impl Material {
    /// Whether nothing passes through.
    fn is_opaque(&self) -> bool {
        self.opacity.is_none() && !self.front.transmits()
    }

    /// Whether it is opaque and described on a side.
    fn shows(&self, outward: bool) -> bool {
        self.is_opaque() && (outward || self.back.is_some())
    }
}

impl Surface {
    /// A BSDF with the indices of what lies on both sides here.
    #[inline(always)]
    pub(crate) fn between(&self, bsdf: Bsdf<Colour>) -> Bsdf<Colour> {
        match (self.interface, bsdf) {
            (
                Some([int_ior, ext_ior]),
                Bsdf::Dielectric { specular_reflectance, specular_transmittance, roughness, .. },
            ) => {
                Bsdf::Dielectric { int_ior, ext_ior, specular_reflectance, specular_transmittance, roughness }
            }
            _ => bsdf,
        }
    }
}
