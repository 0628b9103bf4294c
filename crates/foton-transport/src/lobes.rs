//! Which lobes of a surface eye paths follow, and for which hit points gather photons.
//!
//! A method states its rule as a [`LobePolicy`]; what follows from it for one BSDF is a [`LobeSplit`], and for a whole scene a
//! [`LobeUse`]. The rule holds for the whole render: emission counts where eye paths meet emitters by specular lobes, and photons
//! count where hit points gather, so nothing counts twice.

use foton_scene::{Census, LobeFlags, Scattering};

/// The rule by which lobes are divided: *specular* ones, which eye paths follow, and *gathered* ones, for which hit points gather
/// photons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobePolicy {
    /// Glossy reflections of at most this roughness α are specular: the narrower a lobe, the fewer photons a hit point finds in it.
    pub max_specular_roughness: f32,
}

/// How the lobes of one BSDF are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LobeSplit {
    /// Lobes that eye paths follow.
    pub specular: LobeFlags,
    /// Lobes for which hit points gather photons.
    pub gathered: LobeFlags,
}

impl LobePolicy {
    /// How the lobes of a BSDF are divided, by the parameters that it has at a point.
    #[must_use]
    pub fn split(&self, scattering: &Scattering) -> LobeSplit {
        self.split_flags(scattering.flags(), scattering.gloss())
    }

    /// Delta lobes are specular, diffuse ones gathered. Of glossy ones, narrow reflections are specular, and so is all that rough
    /// glass does, since photons would have to be looked up on both sides.
    fn split_flags(&self, flags: LobeFlags, roughness: Option<f32>) -> LobeSplit {
        let is_narrow = roughness.is_some_and(|r| r <= self.max_specular_roughness);
        let glossy_is_specular = is_narrow || flags.intersects(LobeFlags::TRANSMISSION);
        let gathered =
            if glossy_is_specular { LobeFlags::DIFFUSE } else { LobeFlags::DIFFUSE | LobeFlags::GLOSSY };
        let all = flags.spreading();
        LobeSplit { specular: all.without(gathered), gathered: all.without(all.without(gathered)) }
    }
}

impl LobeSplit {
    /// Whether hit points gather photons for any lobe.
    #[must_use]
    pub fn gathers(&self) -> bool {
        self.gathered != LobeFlags::NONE
    }

    /// The sides on which light that arrives is gathered, by the flags of the BSDF: that of the path (false), and behind the surface
    /// (true) where diffuse light passes through.
    pub fn sides(&self, flags: LobeFlags) -> impl Iterator<Item = bool> + use<> {
        let passes =
            self.gathered.intersects(LobeFlags::DIFFUSE) && flags.intersects(LobeFlags::TRANSMISSION);
        let reflects = self.gathers() && flags.intersects(LobeFlags::REFLECTION);
        [reflects.then_some(false), passes.then_some(true)].into_iter().flatten()
    }

    /// Whether eye paths follow any lobe.
    #[must_use]
    pub fn follows(&self) -> bool {
        self.specular != LobeFlags::NONE
    }

    /// Whether eye paths follow a glossy lobe, in a direction chosen at random.
    #[must_use]
    pub const fn follows_gloss(&self) -> bool {
        self.specular.intersects(LobeFlags::GLOSSY)
    }

    /// What a path did that took a lobe.
    #[must_use]
    pub const fn bounce(&self, lobe: LobeFlags) -> Bounce {
        if lobe.intersects(LobeFlags::STRAIGHT) {
            Bounce::Straight
        } else if !self.specular.intersects(lobe.spreading()) {
            Bounce::Gathered
        } else if lobe.intersects(LobeFlags::DELTA) {
            Bounce::Delta
        } else {
            Bounce::Glossy
        }
    }
}

/// What a path did at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounce {
    /// It took a lobe for which hit points gather photons.
    Gathered,
    /// It took a single direction, such as that of a mirror.
    Delta,
    /// It took a direction of a specular lobe that is glossy.
    Glossy,
    /// It went straight on, as if there were no surface.
    Straight,
}

/// What paths meet in a scene by a rule: what no lobe asks for is left out of a render.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LobeUse {
    /// Whether eye paths follow a lobe of any surface: mirrors, glass, narrow gloss, things that light passes through.
    pub specular: bool,
    /// Whether any specular lobe is glossy: eye paths follow it in a random direction, which one eye pass freezes.
    pub specular_gloss: bool,
    /// Whether there are emitters to be looked up from such lobes.
    pub highlights: bool,
    /// Whether mirrors or smooth glass may throw the light of delta emitters on such lobes: no eye path meets those emitters, so
    /// photons are gathered there.
    pub highlights_by_photons: bool,
    /// Whether hit points gather photons for any lobe that is not Lambertian: photons are weighted one by one there.
    pub gathered_gloss: bool,
    /// Whether any surface that gathers has interpolated normals: photons need their adjoint correction there.
    pub shading_normals: bool,
}

impl LobeUse {
    /// What a scene asks for.
    #[must_use]
    pub fn of(census: &Census, policy: &LobePolicy) -> Self {
        let mut it = Self::default();
        let mut bends = false;
        for kind in &census.bsdfs {
            let split = policy.split_flags(kind.flags, kind.roughness);
            it.specular |= split.follows() || kind.masked;
            it.specular_gloss |= split.follows_gloss();
            it.gathered_gloss |= split.gathers() && !kind.lambertian;
            it.shading_normals |= split.gathers() && kind.interpolated_normals;
            bends |= split.specular.intersects(LobeFlags::DELTA) && kind.bends_light();
        }
        it.highlights = it.specular_gloss && (census.delta_emitters || census.area_emitters);
        it.highlights_by_photons = it.specular_gloss && census.delta_emitters && bends;
        it
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foton_math::Rgb;
    use foton_scene::Bsdf;
    use foton_scene::bsdf::{Dielectric, Diffuse, MicrofacetDistribution, Microfacets, Null, Plastic};

    const POLICY: LobePolicy = LobePolicy { max_specular_roughness: 0.1 };

    fn at(bsdf: Bsdf<Rgb, f32>) -> Scattering {
        Scattering { bsdf, opacity: 1.0, coat: None }
    }

    fn rough(alpha: f32) -> Option<Microfacets<f32>> {
        Some(Microfacets::isotropic(MicrofacetDistribution::Ggx, alpha))
    }

    fn plastic(roughness: Option<Microfacets<f32>>) -> Bsdf<Rgb, f32> {
        let white = Rgb::WHITE;
        Bsdf::Plastic(Plastic {
            int_ior: 1.5,
            ext_ior: 1.0,
            diffuse_reflectance: white,
            specular_reflectance: white,
            nonlinear: false,
            roughness,
        })
    }

    #[test]
    fn lobes_are_divided_by_how_narrow_they_are() {
        let (diffuse, glossy, delta) = (LobeFlags::DIFFUSE, LobeFlags::GLOSSY, LobeFlags::DELTA);
        let glass = |roughness| {
            let (specular_reflectance, specular_transmittance) = (Rgb::WHITE, Rgb::WHITE);
            Bsdf::Dielectric(Dielectric {
                int_ior: 1.5,
                ext_ior: 1.0,
                specular_reflectance,
                specular_transmittance,
                roughness,
            })
        };
        for (bsdf, specular, gathered) in [
            (Bsdf::Diffuse(Diffuse { reflectance: Rgb::WHITE }), LobeFlags::NONE, diffuse),
            (Bsdf::Null(Null), delta, LobeFlags::NONE),
            (glass(None), delta, LobeFlags::NONE),
            (glass(rough(0.5)), glossy, LobeFlags::NONE),
            (plastic(None), delta, diffuse),
            (plastic(rough(0.1)), glossy, diffuse),
            (plastic(rough(0.11)), LobeFlags::NONE, diffuse | glossy),
        ] {
            assert_eq!(POLICY.split(&at(bsdf)), LobeSplit { specular, gathered }, "{bsdf:?}");
        }
        // The rule is the method's own.
        let none = LobePolicy { max_specular_roughness: 0.0 };
        assert_eq!(none.split(&at(plastic(rough(0.05)))).gathered, diffuse | glossy);
    }

    #[test]
    fn a_bounce_goes_by_the_lobe_and_the_rule() {
        let split = POLICY.split(&at(plastic(rough(0.05))));
        let reflection = LobeFlags::REFLECTION;
        assert_eq!(split.bounce(LobeFlags::GLOSSY | reflection), Bounce::Glossy);
        assert_eq!(split.bounce(LobeFlags::DIFFUSE | reflection), Bounce::Gathered);
        let wide = POLICY.split(&at(plastic(rough(0.5))));
        assert_eq!(wide.bounce(LobeFlags::DIFFUSE | LobeFlags::GLOSSY | reflection), Bounce::Gathered);
        assert_eq!(POLICY.split(&at(plastic(None))).bounce(LobeFlags::DELTA | reflection), Bounce::Delta);
        let hole = LobeFlags::DELTA | LobeFlags::TRANSMISSION | LobeFlags::STRAIGHT;
        assert_eq!(wide.bounce(hole), Bounce::Straight);
    }
}
