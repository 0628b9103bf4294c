//! Which of several surfaces in one place a ray meets.

use foton_math::glam::DVec3;
use foton_math::{Aabb, Ray, Rgb};

use super::share::{MAX_NEAR, Share};
use super::sheet::{Sheet, meet_at, tolerance, weights};
use crate::description::{Bsdf, Dielectric, Material, Null};
use crate::scene::Scene;
use crate::surface::Surface;

/// Surfaces that are told apart at one point.
const MAX: usize = 8;

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
        let (own, p) = (&self.accel.primitive(hit.primitive), hit.position.as_dvec3());
        let mut found = [None; MAX];
        let mut count = 0;
        let reach = hit.error.max_element() + 2.0 * self.coincidences.gap(hit.shape as usize);
        self.accel.for_each_near_of_all(&Aabb::around(hit.position, reach), MAX_NEAR, |j| {
            let (j, primitive) = (j as u32, &self.accel.primitive(j as u32));
            let is_own = j == hit.primitive;
            if !is_own && (!self.share(j).any || !meet_at(own, primitive, p)) {
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
            if !known && count < MAX {
                found[count] = Some(Candidate { primitive: j, shape, rank, normal: sheet.normal, gap });
                count += 1;
            }
        });
        let found = &mut found[..count];
        // The order of the tree is none of the file's.
        found.sort_unstable_by_key(|c| c.map(|c| (std::cmp::Reverse(c.rank), c.shape, c.primitive)));
        let Some(first) = found.first().copied().flatten().filter(|_| count > 1) else { return };
        if first.primitive != hit.primitive {
            let primitive = &self.accel.primitive(first.primitive);
            *hit = self.surface_of(ray, first.primitive, weights(primitive, p), hit.position);
        }
        let gap = found.iter().flatten().map(|c| c.gap).fold(0.0, f64::max) as f32;
        hit.error += hit.normal.abs() * (2.0 * gap);
        hit.interface = self.merged(first, found.iter().flatten().skip(1));
    }

    /// Which surface counts: the highest on the side that a ray comes to.
    fn rank(&self, shape: u32, outward: bool) -> u8 {
        let shape = &self.shapes[shape as usize];
        let all = |is_so: &dyn Fn(&Material) -> bool| self.materials_of(shape).all(is_so);
        match shape.emitter {
            Some(_) if outward => 4,
            _ if all(&|m| m.shows(outward)) => 3,
            _ if all(&Material::is_opaque) => 2,
            _ => u8::from(!all(&|m| m.front == Bsdf::Null(Null))),
        }
    }

    /// Whether of two primitives that share a part of a surface the first counts there on a side of its own, as it is.
    pub(super) fn counts(&self, first: u32, other: u32, outward: bool, agree: bool) -> bool {
        let [shape, its_shape] = [first, other].map(|i| self.shape_of(i));
        let fronts = [shape, its_shape].map(|s| self.material(s).front);
        let two_dielectrics = fronts.iter().all(|f| matches!(f, Bsdf::Dielectric(Dielectric { .. })));
        let (rank, its_rank) = (self.rank(shape, outward), self.rank(its_shape, outward == agree));
        !two_dielectrics && (rank > its_rank || rank == its_rank && (shape, first) < (its_shape, other))
    }

    /// The indices inside and outside of a dielectric in which others lie, by its own normal.
    fn merged<'a>(&self, first: Candidate, others: impl Iterator<Item = &'a Candidate>) -> Option<[f32; 2]> {
        let indices = |c: &Candidate| match self.material(c.shape).front {
            Bsdf::Dielectric(Dielectric { int_ior, ext_ior, .. }) => Some([int_ior, ext_ior]),
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

    /// What a primitive has in common with others. Of an instance all primitives may have.
    #[inline(always)]
    pub(crate) fn share(&self, primitive: u32) -> Share {
        if primitive as usize >= self.parts.len() && self.part(primitive).coincides {
            return Share::UNSETTLED;
        }
        self.coincidences.share(primitive as usize)
    }

    /// Whether any surfaces lie in one another.
    #[must_use]
    pub fn has_coincident_surfaces(&self) -> bool {
        !self.coincidences.gaps.is_empty()
    }

    /// Pairs of shapes of which the first hides the second where both lie in one surface and face the same way: the first is
    /// opaque, the second is too or is a mask. Emitters are none of them, nor is what stands on a floor.
    pub fn hidden_shapes(&self) -> impl Iterator<Item = [u32; 2]> {
        self.coincidences.shapes.iter().filter(|(_, agree)| *agree).filter_map(|&([a, b], _)| {
            let hides = |a: u32, b: u32| {
                let all = |shape: u32, is_so: fn(&Material) -> bool| {
                    self.materials_of(&self.shapes[shape as usize]).all(is_so)
                };
                all(a, Material::is_opaque)
                    && (all(b, Material::is_opaque) || self.material(b).opacity.is_some())
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
        self.is_opaque() && (outward || self.back.is_some() || self.front.has_two_sides())
    }
}

impl Surface {
    /// A BSDF with the indices of what lies on both sides here.
    #[inline(always)]
    pub(crate) fn between(&self, mut bsdf: Bsdf<Rgb, f32>) -> Bsdf<Rgb, f32> {
        if let (Some([inside, outside]), Bsdf::Dielectric(Dielectric { int_ior, ext_ior, .. })) =
            (self.interface, &mut bsdf)
        {
            (*int_ior, *ext_ior) = (inside, outside);
        }
        bsdf
    }
}
