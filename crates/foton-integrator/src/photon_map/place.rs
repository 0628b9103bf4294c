//! A point of a surface for which photons are looked up.

use std::f32::consts::TAU;

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Ray, Stream};
use foton_scene::{Scene, Surface};
use foton_transport::camera_paths::{HitPoint, slab2};
use foton_transport::kd_tree::{MAX_EDGES, PackedPhoton};

/// What coordinates of a thousand scene units round to, and some.
const ROUNDING: f32 = 1e-3;

/// Points of the disc that are looked at.
const PROBES: u32 = 16;

/// Surfaces above one that are passed on the way to it.
const MAX_PASSED: u32 = 16;

/// A point of a surface that light is looked up for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) position: Vec3,
    /// Unit geometric normal on the side of the light.
    pub(super) normal: Vec3,
    /// The patch and its side.
    pub(super) patch: u8,
    /// Squared sine up to which photons may lie off the tangent plane.
    slope2: f32,
    /// Edges that a photon's path may have.
    edges: u32,
}

impl Place {
    /// On the side of a surface that `wo` points to.
    pub(super) fn on(surface: &Surface, wo: Vec3, edges: u32) -> Self {
        let outward = wo.dot(surface.normal) > 0.0;
        Self {
            position: surface.position,
            normal: if outward { surface.normal } else { -surface.normal },
            patch: surface.patch_towards(outward),
            slope2: slab2(surface.curved),
            edges,
        }
    }

    /// Where an eye path ends.
    pub(super) fn at(point: &HitPoint) -> Self {
        let HitPoint { position, normal, patch, curved, .. } = *point;
        Self { position, normal, patch, slope2: slab2(curved), edges: u32::from(point.remaining_edges) }
    }

    /// Whether a photon at an offset lies on the same surface, on its side, and came by few enough edges. More than [`MAX_EDGES`] are not
    /// told apart.
    #[inline(always)]
    pub(super) fn counts(&self, photon: &PackedPhoton, offset: Vec3) -> bool {
        let height = offset.dot(self.normal);
        photon.patch() == self.patch
            && height * height <= self.slope2 * offset.length_squared() + ROUNDING * ROUNDING
            && (u32::from(photon.edges()) <= self.edges || self.edges >= u32::from(MAX_EDGES))
    }

    /// About what share of a disc around it lies on the same surface, seen from its side: near an edge photons lie in that part alone.
    /// Adds to the number of rays.
    pub(super) fn share_of_disc(
        &self,
        scene: &Scene,
        radius: f32,
        stream: &mut Stream,
        rays: &mut u64,
    ) -> f32 {
        let frame = Frame::from_normal(self.normal);
        let (turn, first) = (stream.next_1d(), stream.next_1d());
        let height = radius * self.slope2.sqrt() + 2.0 * ROUNDING;
        let mut found = 0;
        for i in 0..PROBES {
            // A sunflower: all points stand for equal areas.
            let r = radius * ((i as f32 + first) / PROBES as f32).sqrt();
            let (sin, cos) = (TAU * (turn + i as f32 * 0.618_034)).sin_cos();
            let at = Vec2::new(cos, sin) * r;
            let above = self.position + frame.to_outer(at.extend(height));
            found += u32::from(self.lies_below(scene, above, height, rays));
        }
        // The middle of the disc is on the surface, whatever the probes say.
        found.max(1) as f32 / PROBES as f32
    }

    /// Whether the surface lies within the slab below a point above it.
    fn lies_below(&self, scene: &Scene, above: Vec3, height: f32, rays: &mut u64) -> bool {
        let mut ray = Ray { t_max: 2.0 * height, ..Ray::new(above, -self.normal) };
        for _ in 0..MAX_PASSED {
            *rays += 1;
            let Some(surface) = scene.nearest(ray) else { return false };
            let outward = self.normal.dot(surface.normal) > 0.0;
            if surface.patch_towards(outward) == self.patch {
                return true;
            }
            let origin = surface.ray_origin(ray.direction);
            ray = Ray { origin, t_max: ray.t_max - (origin - ray.origin).dot(ray.direction), ..ray };
            if ray.t_max <= 0.0 {
                return false;
            }
        }
        false
    }
}
