//! What happens to a photon at a surface: it is stored where light spreads, absorbed, or sent on.

use foton_math::glam::Vec3;
use foton_math::{Frame, Ray, Rgb};
use foton_scene::{Surface, Transport};

use super::draws::Draw;
use super::pass::{Path, PhotonPass};
use crate::ledger::{Ledger, energy, left_out};
use crate::lobes::Bounce;
use crate::not_finite::{self, LeftOut, Quantity};
use crate::photon_map::{Chunk, PathClass, Photon};
use crate::shading::{
    MIN_COSINE, leaves_wrongly, normals_agree, on_the_right_side, shading_normal_towards, shading_view,
};

/// A direction that a photon leaves in, before it is known whether it does.
struct Leaving {
    direction: Vec3,
    /// `f · |cos θ| / pdf` by the shading normal.
    weight: Rgb,
    /// The shading normal.
    normal: Vec3,
    /// By which kind of lobe.
    bounce: Bounce,
    /// Whether on the side that it came from.
    reflects: bool,
}

impl PhotonPass<'_> {
    /// Stores the photon where light spreads, and sends it on. Whether it has been stored anywhere so far.
    #[inline(always)]
    pub(super) fn scatter(
        &self,
        path: &Path,
        surface: &Surface,
        draw: Draw,
        chunk: &mut Chunk,
        next: &mut Vec<Path>,
    ) -> bool {
        let wo = -path.ray.direction;
        let Some(reflectance) = self.scene.lambertian(surface, wo.dot(surface.normal) > 0.0) else {
            return self.scatter_otherwise(path, surface, draw, chunk, next);
        };
        let stored = self.store(path, surface, wo, chunk);
        let normal = shading_normal_towards(surface, wo);
        let wi = if wo.dot(normal) < 0.0 { -draw.diffuse } else { draw.diffuse };
        let leaving = Leaving {
            direction: Frame::from_normal(normal).to_outer(wi).normalize(),
            weight: reflectance,
            normal,
            bounce: Bounce::Gathered,
            reflects: true,
        };
        self.send_on(path, stored, surface, &leaving, draw.survival, chunk, next);
        stored
    }

    /// The same for everything but Lambertian surfaces. A function of its own, so that the loop around the others stays small.
    #[inline(never)]
    fn scatter_otherwise(
        &self,
        path: &Path,
        surface: &Surface,
        draw: Draw,
        chunk: &mut Chunk,
        next: &mut Vec<Path>,
    ) -> bool {
        let wo = -path.ray.direction;
        let outward = wo.dot(surface.normal) > 0.0;
        // Whichever component this photon takes, hit points of all of them may gather it.
        let gathers = |(surface, _): (Surface, f32)| {
            let scattering = self.scene.scattering(&surface, outward);
            let split = scattering.map(|s| self.policy.split(&s));
            split.is_some_and(|split| split.gathers() || path.lone && split.follows_gloss())
        };
        let counts = self.scene.is_mixture(surface) && self.scene.components(surface, outward).any(gathers);
        let mut stored = if counts { self.store(path, surface, wo, chunk) } else { path.stored };
        let mut chosen = *surface;
        let u_lobe = self.scene.choose_component(&mut chosen, outward, draw.lobe);
        let surface = &chosen;
        let Some(scattering) = self.scene.scattering(surface, outward) else {
            chunk.ledger.absorbed += energy(path.power);
            return stored;
        };
        let split = self.policy.split(&scattering);
        if !counts && (split.gathers() || path.lone && split.follows_gloss()) {
            stored = self.store(path, surface, wo, chunk);
        }
        let (frame, local) = shading_view(self.scene, surface, wo);
        let sample = scattering.sample(local, Transport::Importance, u_lobe, draw.direction, split.specular);
        let Some(sample) = sample else {
            chunk.ledger.absorbed += energy(path.power);
            return stored;
        };
        let mut leaving = Leaving {
            direction: frame.to_outer(sample.wi).normalize(),
            weight: sample.weight,
            normal: frame.normal,
            bounce: split.bounce(sample.lobe),
            reflects: sample.wi.z * local.z > 0.0,
        };
        if surface.is_relieved && leaving.bounce == Bounce::Gathered {
            leave_relief(&mut leaving, surface, wo, draw, scattering.lambertian().is_some());
        }
        self.send_on(path, stored, surface, &leaving, draw.survival, chunk, next);
        stored
    }

    /// Weighs and, by `u`, thins out a photon that leaves, and says in the ledger what became of the rest.
    #[inline(always)]
    #[allow(
        clippy::too_many_arguments,
        reason = "all of one photon's step; a struct of them is a copy of them"
    )]
    fn send_on(
        &self,
        path: &Path,
        stored: bool,
        surface: &Surface,
        leaving: &Leaving,
        u: f32,
        chunk: &mut Chunk,
        next: &mut Vec<Path>,
    ) {
        let wo = -path.ray.direction;
        let &Leaving { direction, weight, normal, bounce, reflects } = leaving;
        let is_specular = bounce != Bounce::Gathered;
        if self.ends_where_light_spreads && !is_specular {
            chunk.ledger.absorbed += energy(path.power);
            return;
        }
        let scattered = path.power * weight;
        let correction = if !is_specular && leaves_wrongly(surface, wo, direction, reflects) {
            0.0
        } else if bounce == Bounce::Straight {
            1.0
        } else {
            adjoint_correction(surface.normal, normal, wo, direction)
        };
        let corrected = scattered * correction;
        if !corrected.is_finite() {
            return self.drop_photon(path, surface, chunk);
        }
        chunk.ledger.absorbed += left_out(path.power, weight);
        if correction != 1.0 {
            let lost = left_out(scattered, Rgb::splat(correction));
            chunk.ledger.shading_normals += lost;
            chunk.ledger.shading_gain += (-lost).max(0.0);
        }
        if corrected.is_black() {
            return;
        }
        if path.edges + 1 >= self.max_depth {
            chunk.ledger.truncated += energy(corrected);
            chunk.losses[self.material(surface)].truncated += energy(corrected);
            return;
        }
        let Some(power) = roulette(corrected, path.power, u, &mut chunk.ledger) else { return };
        let direction =
            if is_specular { on_the_right_side(surface, wo, direction, reflects) } else { direction };
        next.push(Path {
            ray: Ray::new(surface.ray_origin(direction), direction),
            power,
            class: path.class.scattered(bounce),
            lone: self.stays_lone(path, bounce),
            stored,
            edges: path.edges + 1,
            emitter: path.emitter,
            sample: path.sample,
            stream: path.stream.clone(),
        });
    }

    /// Drops a photon whose power is no longer a number, before it reaches a sum: one NaN would be all that is left of the image.
    #[inline(always)]
    fn drop_photon(&self, path: &Path, surface: &Surface, chunk: &mut Chunk) {
        chunk.ledger.dropped += 1;
        chunk.ledger.lost += energy(path.power);
        chunk.losses[self.material(surface)].dropped += 1;
        chunk.leave_out(LeftOut {
            quantity: Quantity::ScatteredPower,
            light: Some(path.emitter),
            surface: not_finite::Surface::Shape(surface.shape),
            position: surface.position,
        });
    }

    /// Whether the photon is one that [`Photon::is_lone`] means after one more bounce.
    fn stays_lone(&self, path: &Path, bounce: Bounce) -> bool {
        match bounce {
            Bounce::Gathered | Bounce::Glossy => false,
            Bounce::Straight => path.lone,
            Bounce::Delta => {
                path.lone
                    || path.class == PathClass::Direct
                        && self.scene.emitters()[path.emitter as usize].is_delta()
            }
        }
    }

    /// Index of the surface's material.
    fn material(&self, surface: &Surface) -> usize {
        self.scene.shapes()[surface.shape as usize].material as usize
    }

    /// Stores the photon if a hit point may gather it. Whether it has been stored anywhere so far.
    #[inline(always)]
    fn store(&self, path: &Path, surface: &Surface, wo: Vec3, chunk: &mut Chunk) -> bool {
        if path.class == PathClass::Direct && !self.stores_direct {
            return path.stored;
        }
        // Before the grid is asked, whose cells depend on radii.
        if let (Some(training), Some(sample)) = (&self.training, chunk.samples.get_mut(path.sample as usize))
        {
            sample.is_stored(path.power, training.worth.at(surface.position));
        }
        let Some(cell) = self.grid.number(surface.position) else { return path.stored };
        let outward = wo.dot(surface.normal);
        let (normal, patch) = (surface.normal * 1f32.copysign(outward), surface.patch_towards(outward > 0.0));
        let edges = path.edges.min(255) as u8;
        let from = self.directions.then_some(wo);
        chunk.photons.push(
            Photon::new(surface.position, normal, patch, from, path.power, path.class, edges)
                .marked(path.lone),
        );
        chunk.cells.push(cell);
        true
    }
}

/// Turns a photon that leaves a relief, by a lobe for which hit points gather, to where eyes see it: also to those above the surface from
/// which the relief turns away. They see it as their mirror images at the relief's horizon do (`shading_view`), and light of a
/// relief that turns away from where the photon came from they do not see at all.
fn leave_relief(leaving: &mut Leaving, surface: &Surface, wo: Vec3, draw: Draw, is_lambertian: bool) {
    if !normals_agree(surface, wo) {
        leaving.weight = Rgb::BLACK;
        return;
    }
    let normal = leaving.normal;
    if is_lambertian {
        // As bright from all of these directions.
        let side = 1f32.copysign(wo.dot(surface.normal));
        leaving.direction = Frame::from_normal(surface.normal * side).to_outer(draw.diffuse).normalize();
        leaving.weight *= wo.dot(normal).abs() / wo.dot(surface.normal).abs().max(MIN_COSINE);
        leaving.normal = surface.normal;
        return;
    }
    let seen = |direction: Vec3| !leaves_wrongly(surface, wo, direction, leaving.reflects);
    let mirrored = leaving.direction.reflect(normal);
    match (seen(leaving.direction), seen(mirrored)) {
        (true, true) => {
            // Digits of the number that roulette hardly looks at.
            let takes_mirrored = (draw.survival * 4096.0).fract() < 0.5;
            leaving.weight *= 2.0;
            leaving.direction = if takes_mirrored { mirrored } else { leaving.direction };
        }
        (false, true) => leaving.direction = mirrored,
        _ => {}
    }
}

/// |ωi·n_s| |ωo·n_g| / (|ωi·n_g| |ωo·n_s|) for light from `wo` scattered to `wi`: photons see the adjoint of a BSDF with
/// interpolated normals. `[VEA97]` section 5.3
fn adjoint_correction(n_g: Vec3, n_s: Vec3, wo: Vec3, wi: Vec3) -> f32 {
    if n_g == n_s {
        return 1.0;
    }
    let upper = wo.dot(n_s).abs() * wi.dot(n_g).abs();
    let lower = wo.dot(n_g).abs().max(MIN_COSINE) * wi.dot(n_s).abs().max(MIN_COSINE);
    upper / lower
}

/// Survival in proportion to the power that is left, so that all photons carry about the same.
fn roulette(power: Rgb, before: Rgb, u: f32, ledger: &mut Ledger) -> Option<Rgb> {
    let chance = power.max_component() / before.max_component();
    if chance >= 1.0 {
        return Some(power);
    }
    ledger.roulette += energy(power);
    if u >= chance {
        return None;
    }
    let survivor = power / chance;
    ledger.roulette -= energy(survivor);
    Some(survivor)
}
