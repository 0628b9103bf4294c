//! What each scattering plugin says: diffuse, glass, metal and plastic, smooth and rough.

use foton_input::quoted;
use foton_math::Rgb;
use foton_scene::description::{
    Bsdf, Conductor, Dielectric, Diffuse, MicrofacetDistribution, Microfacets, Mirror, Null, Plastic,
    ThinDielectric,
};

use crate::metals;
use crate::names::{REFRACTION, did_you_mean};
use crate::properties::{Located, Properties};
use crate::reader::Reader;

/// Mitsuba takes smaller values of alpha for this.
const MIN_ALPHA: f32 = 1e-4;

impl Reader<'_> {
    /// The BSDF of a plugin that has no others inside.
    pub(crate) fn bsdf(&mut self, plugin: &str, p: &mut Properties<'_>) -> Option<Bsdf> {
        match plugin {
            "diffuse" => Some(Bsdf::Diffuse(Diffuse { reflectance: self.share(p, "reflectance", 0.5) })),
            "null" => Some(Bsdf::Null(Null)),
            "conductor" => self.conductor(p, false),
            "roughconductor" => self.conductor(p, true),
            "plastic" => self.plastic(p, false),
            "roughplastic" => self.plastic(p, true),
            "thindielectric" => self.thin_dielectric(p),
            "roughdielectric" => self.dielectric(p, true),
            _ => self.dielectric(p, false),
        }
    }

    fn dielectric(&mut self, p: &mut Properties<'_>, rough: bool) -> Option<Bsdf> {
        let iors = self.refractions(p, 1.5046);
        let roughness = if rough { self.roughness(p, true).map(Some) } else { Some(None) };
        let specular_reflectance = self.share(p, "specular_reflectance", 1.0);
        let specular_transmittance = self.share(p, "specular_transmittance", 1.0);
        let ((int_ior, ext_ior), roughness) = iors.zip(roughness)?;
        Some(Bsdf::Dielectric(Dielectric {
            int_ior,
            ext_ior,
            specular_reflectance,
            specular_transmittance,
            roughness,
        }))
    }

    fn thin_dielectric(&mut self, p: &mut Properties<'_>) -> Option<Bsdf> {
        let iors = self.refractions(p, 1.5046);
        let specular_reflectance = self.share(p, "specular_reflectance", 1.0);
        let specular_transmittance = self.share(p, "specular_transmittance", 1.0);
        let (int_ior, ext_ior) = iors?;
        Some(Bsdf::ThinDielectric(ThinDielectric {
            int_ior,
            ext_ior,
            specular_reflectance,
            specular_transmittance,
        }))
    }

    fn plastic(&mut self, p: &mut Properties<'_>, rough: bool) -> Option<Bsdf> {
        let iors = self.refractions(p, 1.49);
        let roughness = if rough { self.roughness(p, false).map(Some) } else { Some(None) };
        let diffuse_reflectance = self.share(p, "diffuse_reflectance", 0.5);
        let specular_reflectance = self.share(p, "specular_reflectance", 1.0);
        let nonlinear = p.boolean("nonlinear", &mut self.report).is_some_and(|n| n.value);
        let ((int_ior, ext_ior), roughness) = iors.zip(roughness)?;
        Some(Bsdf::Plastic(Plastic {
            int_ior,
            ext_ior,
            diffuse_reflectance,
            specular_reflectance,
            nonlinear,
            roughness,
        }))
    }

    /// A metal by name, or by its indices of refraction; without either a mirror.
    fn conductor(&mut self, p: &mut Properties<'_>, rough: bool) -> Option<Bsdf> {
        let material = p.string("material", &mut self.report);
        let indices = ["eta", "k"].iter().any(|name| p.has(name));
        let stated = (self.optical(p, "eta", 0.0), self.optical(p, "k", 1.0));
        let outside = p.has("ext_eta").then(|| self.refraction(p, "ext_eta", 1.0));
        let roughness = if rough { self.roughness(p, true).map(Some) } else { Some(None) };
        let specular_reflectance = self.share(p, "specular_reflectance", 1.0);
        let metal = material.filter(|m| m.value != "none");
        if let Some(metal) = metal.as_ref().filter(|_| indices) {
            let message = "a conductor has a \"material\" or \"eta\" and \"k\", not both";
            self.report.error(metal.place, message);
            return None;
        }
        let (eta, k) = match metal {
            Some(metal) => metals::find(&metal.value).map_err(|m| self.report.error(metal.place, m)).ok()?,
            None => stated,
        };
        let relative = 1.0 / outside.unwrap_or(Some(1.0))?;
        let roughness = roughness?;
        if !indices && eta == Rgb::BLACK && roughness.is_none() {
            return Some(Bsdf::Mirror(Mirror { reflectance: specular_reflectance }));
        }
        Some(Bsdf::Conductor(Conductor {
            eta: eta * relative,
            k: k * relative,
            specular_reflectance,
            roughness,
        }))
    }

    /// `int_ior` and `ext_ior`, which is air by default.
    fn refractions(&mut self, p: &mut Properties<'_>, inside: f32) -> Option<(f32, f32)> {
        let int_ior = self.refraction(p, "int_ior", inside);
        int_ior.zip(self.refraction(p, "ext_ior", 1.000_277))
    }

    /// An index of refraction, a number or the name of a substance.
    #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
    fn refraction(&mut self, p: &mut Properties<'_>, name: &'static str, default: f32) -> Option<f32> {
        if p.is_string(name) {
            let substance = p.string(name, &mut self.report)?;
            let lower = substance.value.to_lowercase();
            let found = REFRACTION.iter().find(|(known, _)| *known == lower);
            if found.is_none() {
                let hint = did_you_mean(&lower, REFRACTION.iter().map(|(known, _)| *known));
                let message =
                    format!("no index of refraction is known for {}{hint}", quoted(&substance.value));
                self.report.error(substance.place, message);
            }
            return found.map(|(_, ior)| *ior);
        }
        let Some(ior) = p.number(name, &mut self.report) else { return Some(default) };
        let single = ior.value as f32;
        if single.is_normal() && single > 0.0 {
            return Some(single);
        }
        self.report.error(ior.place, "an index of refraction must be above zero");
        None
    }

    /// `distribution` and `alpha`, or `alpha_u` and `alpha_v` where the plugin has them.
    fn roughness(&mut self, p: &mut Properties<'_>, two_axes: bool) -> Option<Microfacets> {
        let distribution = self.distribution(p);
        p.ignore(&["sample_visible"]);
        let alpha = self.alpha(p, "alpha");
        let mut alphas = (alpha, alpha);
        if two_axes && (p.has("alpha_u") || p.has("alpha_v")) {
            if !(p.has("alpha_u") && p.has("alpha_v")) || p.has("alpha") {
                let message = "a rough surface has an \"alpha\", or both \"alpha_u\" and \"alpha_v\"";
                self.report.error(p.place, message);
            }
            alphas = (self.alpha(p, "alpha_u"), self.alpha(p, "alpha_v"));
        }
        let (alpha_u, alpha_v) = alphas;
        Some(Microfacets { distribution: distribution?, alpha_u: alpha_u?, alpha_v: alpha_v? })
    }

    fn distribution(&mut self, p: &mut Properties<'_>) -> Option<MicrofacetDistribution> {
        let Some(Located { value, place }) = p.string("distribution", &mut self.report) else {
            return Some(MicrofacetDistribution::Beckmann);
        };
        match value.as_str() {
            "beckmann" => Some(MicrofacetDistribution::Beckmann),
            "ggx" => Some(MicrofacetDistribution::Ggx),
            _ => {
                let hint = did_you_mean(&value, ["beckmann", "ggx"]);
                let hint = if hint.is_empty() { ", only \"beckmann\" and \"ggx\"".to_owned() } else { hint };
                self.report.error(place, format!("no distribution {} is known{hint}", quoted(&value)));
                None
            }
        }
    }

    #[allow(clippy::cast_possible_truncation, reason = "optics is single precision")]
    fn alpha(&mut self, p: &mut Properties<'_>, name: &'static str) -> Option<f32> {
        let Some(alpha) = p.number(name, &mut self.report) else { return Some(0.1) };
        if !(0.0..=1e6).contains(&alpha.value) {
            self.report.error(alpha.place, format!("\"{name}\" must not be negative or above a million"));
            return None;
        }
        Some((alpha.value as f32).max(MIN_ALPHA))
    }
}
