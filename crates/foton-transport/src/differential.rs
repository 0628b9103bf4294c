//! Ray differentials: how far neighbouring eye samples are apart on their way, to first order. `[IGE99]`
//!
//! Where a path meets a surface they give its footprint, over which textures are looked up. Mirrors and glass keep them, with the
//! curvature of the surface and of its interpolated normals; a rough lobe widens them by its share among the pixel's samples.
//! What a relief does to neighbouring normals is left out.

use foton_math::glam::Vec3;
use foton_math::{Frame, Ray};
use foton_scene::{Bsdf, Footprint, Scattering, Scene, Sensor, Surface};

/// Cosines below this count as this: a footprint at grazing angles stays finite.
const MIN_COSINE: f32 = 1e-3;

/// Differentials of a direction are cut to this.
const WIDEST: f32 = 1.0;

/// The square of a distance of unit directions below which a path goes straight on.
const STRAIGHT: f32 = 1e-9;

/// Samples that are renewed in each pass are looked up as if a pixel had the square of this many: enough to see little of what is narrower
/// than a pixel as noise, and few enough to blur nothing. `[PBR16]` section 10.1
const RENEWED: f32 = 8.0;

/// How far neighbouring samples are apart: where their rays begin, and in which unit directions they go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differential {
    origin: [Vec3; 2],
    direction: [Vec3; 2],
    /// Share of a pixel's width between neighbouring samples.
    spacing: f32,
}

/// A path at a surface, about to leave it.
#[derive(Clone, Copy)]
pub struct Bend<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The surface.
    pub surface: &'a Surface,
    /// How it scatters there.
    pub scattering: &'a Scattering,
    /// The unit normal about which it scatters.
    pub normal: Vec3,
    /// The unit direction in which the path came.
    pub arriving: Vec3,
    /// What its sample covers there.
    pub footprint: Footprint,
}

impl Differential {
    /// Of a ray that leaves a camera; `None` where nothing asks for it. `renewed`: whether each pass follows other samples.
    #[must_use]
    pub fn of_eye(
        scene: &Scene,
        sensor: &Sensor,
        ray: &Ray,
        samples_per_pixel: u32,
        renewed: bool,
    ) -> Option<Self> {
        if !scene.census().textures {
            return None;
        }
        let spacing = if renewed { 1.0 / RENEWED } else { 1.0 / (samples_per_pixel as f32).sqrt() };
        let [origin, direction] =
            sensor.change_of_ray(ray.direction).map(|change| change.map(|d| d * spacing));
        Some(Self { origin, direction, spacing })
    }

    /// What the sample covers of a surface that its ray meets.
    #[must_use]
    pub fn footprint(&self, ray: &Ray, surface: &Surface) -> Footprint {
        let (distance, normal) = ((surface.position - ray.origin).length(), surface.normal);
        let cosine = ray.direction.dot(normal);
        let cosine = cosine.abs().max(MIN_COSINE).copysign(cosine);
        let side = |i: usize| {
            let across = self.origin[i] + self.direction[i] * distance;
            across - ray.direction * (across.dot(normal) / cosine)
        };
        Footprint { sides: [side(0), side(1)] }
    }

    /// Those of the path that leaves a surface in a unit direction.
    #[must_use]
    pub fn bent(&self, at: &Bend<'_>, leaving: Vec3) -> Self {
        let origin = at.footprint.sides;
        if leaving.distance_squared(at.arriving) < STRAIGHT {
            return Self { origin, ..*self };
        }
        let spread = self.spread(at);
        let mut direction = [0, 1].map(|i| {
            let d = at.change(leaving, self.direction[i], origin[i]);
            let length = d.length();
            if length <= WIDEST { d } else { d * (WIDEST / length) }
        });
        if !direction.iter().all(|d| d.is_finite()) {
            direction = [Vec3::ZERO; 2];
        }
        if spread > 0.0 {
            let frame = Frame::from_normal(leaving);
            let first = direction[0].try_normalize().unwrap_or(frame.tangent);
            let second = leaving.cross(first);
            for (d, axis) in direction.iter_mut().zip([first, second]) {
                *d += axis * spread.copysign(d.dot(axis));
            }
        }
        Self { origin, direction, ..*self }
    }

    /// How far the samples of a rough lobe are apart.
    fn spread(&self, at: &Bend<'_>) -> f32 {
        // A reflected direction turns by twice as much as the facet.
        2.0 * at.scattering.bsdf.gloss().unwrap_or(0.0) * self.spacing
    }
}

impl Bend<'_> {
    /// How the direction that leaves changes, where the one that arrives changes by `change` and the point by `along`.
    fn change(&self, leaving: Vec3, change: Vec3, along: Vec3) -> Vec3 {
        // On the side from which the path comes.
        let side = -1f32.copysign(self.arriving.dot(self.normal));
        let is_shaded = self.normal.dot(self.surface.shading_normal).abs() > 1.0 - 1e-5;
        let dn = if is_shaded { self.scene.change_of_normal(self.surface, along) } else { Vec3::ZERO };
        let dn = dn * side.copysign(self.normal.dot(self.surface.shading_normal) * side);
        let reflects = leaving.dot(self.surface.normal) * self.arriving.dot(self.surface.normal) < 0.0;
        if reflects {
            // The normal of the facet, which is the surface's for a mirror.
            let n = (leaving - self.arriving).normalize_or(self.normal * side);
            let d_cosine = change.dot(n) + self.arriving.dot(dn);
            return change - 2.0 * (self.arriving.dot(n) * dn + d_cosine * n);
        }
        let n = self.normal * side;
        let eta = self.eta(leaving, n);
        let (before, after) = (self.arriving.dot(n), leaving.dot(n));
        let d_before = change.dot(n) + self.arriving.dot(dn);
        let mu = eta * before - after;
        let d_mu = (eta - eta * eta * before / after.abs().max(MIN_COSINE).copysign(after)) * d_before;
        change * eta - (mu * dn + d_mu * n)
    }

    /// The index of refraction on this side over the one behind: of the glass, or as the directions say.
    fn eta(&self, leaving: Vec3, normal: Vec3) -> f32 {
        if let Bsdf::Dielectric(glass) = &self.scattering.bsdf {
            let outside = self.arriving.dot(self.surface.normal) < 0.0;
            let (from, to) =
                if outside { (glass.ext_ior, glass.int_ior) } else { (glass.int_ior, glass.ext_ior) };
            return from / to;
        }
        let sine = |d: Vec3| d.cross(normal).length();
        let (before, after) = (sine(self.arriving), sine(leaving));
        if before > 0.05 { (after / before).clamp(0.25, 4.0) } else { 1.0 }
    }
}
