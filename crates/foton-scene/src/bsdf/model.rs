//! What the file of each BSDF says: what the model is called, and what it does with light.

use foton_math::Rgb;
use foton_math::glam::{Vec2, Vec3};

use super::flags::LobeFlags;
use super::lobe_sample::{BsdfSample, LobeSample, LobeSamples, Transport};

/// What a model does with light. Directions are local: z is the shading normal on the outside, `wo` points to where the path
/// came from, `wi` to where it goes. Sets of lobes go by how they spread light ([`LobeFlags::spreading`]).
///
/// The default is a BSDF of delta lobes alone.
pub(super) trait Model {
    /// The lobes that it has.
    fn flags(&self) -> LobeFlags;

    /// The larger roughness α of its glossy lobes, if it has any: that of the microfacets, or of those that would be as wide.
    fn gloss(&self) -> Option<f32> {
        None
    }

    /// The value `f(wo, wi)` of those of its `lobes` that are not delta ones, without the cosine (sr⁻¹).
    fn eval(&self, _wo: Vec3, _wi: Vec3, _lobes: LobeFlags) -> Rgb {
        Rgb::BLACK
    }

    /// The pdf (sr⁻¹) with which [`Model::sample`] chooses `wi`, delta lobes left out, the probability of lobes included.
    fn pdf(&self, _wo: Vec3, _wi: Vec3) -> f32 {
        0.0
    }

    /// The pdf (sr⁻¹) of `wi` in [`Model::lobes`], for a glossy reflection; 0 where that is not known.
    fn glossy_pdf(&self, _wo: Vec3, _wi: Vec3) -> f32 {
        0.0
    }

    /// One direction of each delta or glossy lobe among `lobes`; a glossy one's is chosen by `u`.
    fn lobes(&self, _wo: Vec3, _transport: Transport, _u: Vec2, _lobes: LobeFlags) -> LobeSamples {
        [None; 4]
    }

    /// The share of light from `wo` that passes straight on, tinted.
    fn straight(&self, _wo: Vec3) -> Option<LobeSample> {
        None
    }

    /// One direction chosen among all lobes; those in `apart` are not weighted together with others that overlap them.
    fn sample(
        &self,
        wo: Vec3,
        transport: Transport,
        u_lobe: f32,
        u: Vec2,
        _apart: LobeFlags,
    ) -> Option<BsdfSample> {
        let (lobe, chosen) = choose(&self.lobes(wo, transport, u, LobeFlags::ALL), self.flags(), u_lobe)?;
        Some(BsdfSample { wi: chosen.wi, weight: chosen.weight / chosen.probability, lobe })
    }
}

/// One of the lobes of a BSDF with these flags, chosen by `u` in [0, 1) with their probabilities; its weight is not divided by its
/// probability. `None` with the probability of lobes that are absent: glossy ones that would leave below the surface.
pub(super) fn choose(lobes: &LobeSamples, flags: LobeFlags, u: f32) -> Option<(LobeFlags, LobeSample)> {
    // Probabilities that sum to 1 but for rounding leave no gap at the end.
    const ROUNDING: f32 = 1e-6;
    let bent = if flags.intersects(LobeFlags::GLOSSY) { LobeFlags::GLOSSY } else { LobeFlags::DELTA };
    let kinds = [
        bent.or(LobeFlags::REFLECTION),
        bent.or(LobeFlags::TRANSMISSION),
        LobeFlags::DELTA.or(LobeFlags::TRANSMISSION).or(LobeFlags::STRAIGHT),
        bent.or(LobeFlags::REFLECTION),
    ];
    let mut left = u;
    for (kind, lobe) in kinds.into_iter().zip(lobes) {
        let Some(lobe) = lobe else { continue };
        if left < lobe.probability + ROUNDING {
            return Some((kind, *lobe)).filter(|_| lobe.probability > 0.0);
        }
        left -= lobe.probability;
    }
    None
}
