//! Materials that a person takes as they are: what they are made of is measured, not chosen by taste.
//!
//! Indices of refraction are those at the sodium line (589 nm). Metals are the scene's own ([`METALS`]); brass is not among them and has
//! the indices of Cu70Zn30 at 650, 550 and 450 nm `[QUE85]`. Colours of sapphire, plastic and wax are chosen: they depend on what is in
//! them.

use foton_math::Rgb;
use foton_scene::bsdf::{MicrofacetDistribution, Microfacets};
use foton_scene::description::{Bsdf, Conductor, Dielectric, Material, Plastic};
use foton_scene::metals::METALS;

/// A material by its everyday name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset {
    /// Its name, in lower case: also that of its picture.
    pub name: &'static str,
    /// What it is, in a line.
    pub help: &'static str,
    front: Bsdf,
}

impl Preset {
    /// The material, under a name.
    #[must_use]
    pub fn material(&self, name: impl Into<String>) -> Material {
        let back = (!self.front.has_two_sides()).then_some(self.front);
        Material { name: name.into(), front: self.front, back, ..Material::default() }
    }
}

fn clear(int_ior: f32, transmittance: Rgb, alpha: Option<f32>) -> Bsdf {
    Bsdf::Dielectric(Dielectric {
        int_ior,
        ext_ior: 1.0,
        specular_reflectance: Rgb::WHITE.into(),
        specular_transmittance: transmittance.into(),
        roughness: alpha.map(rough),
    })
}

fn rough(alpha: f32) -> Microfacets {
    Microfacets::isotropic(MicrofacetDistribution::Ggx, alpha)
}

fn metal(eta: [f32; 3], k: [f32; 3]) -> Bsdf {
    Bsdf::Conductor(Conductor {
        eta: Rgb::from_array(eta),
        k: Rgb::from_array(k),
        specular_reflectance: Rgb::WHITE.into(),
        roughness: None,
    })
}

fn known_metal(symbol: &str) -> Bsdf {
    let known = METALS.iter().find(|m| m.0 == symbol);
    known.map_or_else(|| metal([0.0; 3], [0.0; 3]), |m| metal(m.1, m.2))
}

fn coated(base: Rgb, int_ior: f32, alpha: Option<f32>) -> Bsdf {
    Bsdf::Plastic(Plastic {
        int_ior,
        ext_ior: 1.0,
        diffuse_reflectance: base.into(),
        specular_reflectance: Rgb::WHITE.into(),
        nonlinear: false,
        roughness: alpha.map(rough),
    })
}

/// All presets, in the order of the window.
#[must_use]
pub fn presets() -> Vec<Preset> {
    let of = |name, help, front| Preset { name, help, front };
    let white = Rgb::WHITE;
    vec![
        of("water", "Clear, index 1.333", clear(1.333, white, None)),
        of("ice", "Clear, index 1.31", clear(1.31, white, None)),
        of("crown glass", "Clear, index 1.517 (BK7)", clear(1.5168, white, None)),
        of("frosted glass", "Rough glass, index 1.517", clear(1.5168, white, Some(0.25))),
        of("sapphire", "Blue, index 1.768", clear(1.768, Rgb::new(0.25, 0.45, 0.95), None)),
        of("diamond", "Clear, index 2.417", clear(2.417, white, None)),
        of("gold", "Smooth metal", known_metal("Au")),
        of("silver", "Smooth metal", known_metal("Ag")),
        of("copper", "Smooth metal", known_metal("Cu")),
        of(
            "brass",
            "Smooth metal: 70 % copper, 30 % zinc",
            metal([0.444, 0.527, 1.094], [3.695, 2.765, 1.829]),
        ),
        of("plastic", "Red under a clear coat, index 1.49", coated(Rgb::new(0.6, 0.05, 0.04), 1.49, None)),
        of(
            "white wax",
            "Pale under a dull coat, index 1.44",
            coated(Rgb::new(0.85, 0.82, 0.74), 1.44, Some(0.3)),
        ),
    ]
}
