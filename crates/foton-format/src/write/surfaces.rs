//! Materials and textures as the plugins of Mitsuba 3 that mean the same.

use foton_film::WriteError;
use foton_math::Rgb;
use foton_math::glam::{DAffine2, DAffine3, DMat3};
use foton_scene::description::{
    Bsdf, Colour, Conductor, Dielectric, Diffuse, Material, MicrofacetDistribution, Microfacets, Mirror,
    Null, Plastic, Texture, TextureKind, ThinDielectric, Wrap,
};

use super::Writer;
use super::xml::{colour, single};
use crate::textures::TURN;

impl Writer<'_> {
    /// Writes a texture and returns its id.
    pub(super) fn texture(&mut self, texture: &Texture) -> Result<String, WriteError> {
        let id = self.id(&texture.name);
        match &texture.kind {
            TextureKind::Bitmap { bitmap, wrap, bilinear } => {
                let filename = self.bitmap(bitmap, &id)?;
                let xml = &mut self.xml;
                xml.open("texture", &[("type", "bitmap"), ("id", &id)]);
                xml.value("string", "filename", &filename);
                xml.value("string", "filter_type", if *bilinear { "bilinear" } else { "nearest" });
                let wrap = match wrap {
                    Wrap::Repeat => "repeat",
                    Wrap::Mirror => "mirror",
                    Wrap::Clamp => "clamp",
                };
                xml.value("string", "wrap_mode", wrap);
                // The description's v points up, Mitsuba's down.
                xml.transform("to_uv", &in_space(TURN * texture.to_uv));
            }
            TextureKind::Checkerboard { colours } => {
                let xml = &mut self.xml;
                xml.open("texture", &[("type", "checkerboard"), ("id", &id)]);
                xml.value("rgb", "color0", &colour(colours[0]));
                xml.value("rgb", "color1", &colour(colours[1]));
                xml.transform("to_uv", &in_space(texture.to_uv));
            }
        }
        self.xml.close("texture");
        Ok(id)
    }

    /// Writes a material and returns its id.
    pub(super) fn material(&mut self, material: &Material) -> String {
        let id = self.id(&material.name);
        let mut attributes = vec![("id", id.as_str())];
        if let Some(opacity) = &material.opacity {
            self.xml.open("bsdf", &[("type", "mask"), attributes.remove(0)]);
            match *opacity {
                Colour::Constant(share) => self.xml.value("float", "opacity", &single(mean(share))),
                texture @ Colour::Texture(_) => self.colour("opacity", texture),
            }
        }
        match material.back {
            Some(back) if !is_transmitting(&material.front) => {
                let mut outer = vec![("type", "twosided")];
                outer.append(&mut attributes);
                self.xml.open("bsdf", &outer);
                self.bsdf(&material.front, &[]);
                if back != material.front {
                    self.bsdf(&back, &[]);
                }
                self.xml.close("bsdf");
            }
            _ => self.bsdf(&material.front, &attributes),
        }
        if material.opacity.is_some() {
            self.xml.close("bsdf");
        }
        id
    }

    fn bsdf(&mut self, bsdf: &Bsdf, more: &[(&str, &str)]) {
        let mut attributes = vec![("type", plugin(bsdf))];
        attributes.extend(more);
        self.xml.open("bsdf", &attributes);
        match *bsdf {
            Bsdf::Diffuse(Diffuse { reflectance }) => self.colour("reflectance", reflectance),
            Bsdf::Dielectric(Dielectric {
                int_ior,
                ext_ior,
                specular_reflectance,
                specular_transmittance,
                roughness,
            }) => {
                self.refraction(int_ior, ext_ior);
                self.factor("specular_reflectance", specular_reflectance);
                self.factor("specular_transmittance", specular_transmittance);
                self.roughness(roughness.as_ref());
            }
            Bsdf::ThinDielectric(ThinDielectric {
                int_ior,
                ext_ior,
                specular_reflectance,
                specular_transmittance,
            }) => {
                self.refraction(int_ior, ext_ior);
                self.factor("specular_reflectance", specular_reflectance);
                self.factor("specular_transmittance", specular_transmittance);
            }
            Bsdf::Mirror(Mirror { reflectance }) => {
                self.xml.value("string", "material", "none");
                self.colour("specular_reflectance", reflectance);
            }
            Bsdf::Conductor(Conductor { eta, k, specular_reflectance, roughness }) => {
                self.xml.value("rgb", "eta", &colour(eta));
                self.xml.value("rgb", "k", &colour(k));
                self.factor("specular_reflectance", specular_reflectance);
                self.roughness(roughness.as_ref());
            }
            Bsdf::Plastic(Plastic {
                int_ior,
                ext_ior,
                diffuse_reflectance,
                specular_reflectance,
                nonlinear,
                roughness,
            }) => {
                self.refraction(int_ior, ext_ior);
                self.colour("diffuse_reflectance", diffuse_reflectance);
                self.factor("specular_reflectance", specular_reflectance);
                self.xml.value("boolean", "nonlinear", if nonlinear { "true" } else { "false" });
                self.roughness(roughness.as_ref());
            }
            Bsdf::Null(Null) => {}
        }
        self.xml.close("bsdf");
    }

    fn refraction(&mut self, int_ior: f32, ext_ior: f32) {
        self.xml.value("float", "int_ior", &single(int_ior));
        self.xml.value("float", "ext_ior", &single(ext_ior));
    }

    fn roughness(&mut self, roughness: Option<&Microfacets>) {
        let Some(Microfacets { distribution, alpha_u, alpha_v }) = roughness else { return };
        let name = match distribution {
            MicrofacetDistribution::Beckmann => "beckmann",
            MicrofacetDistribution::Ggx => "ggx",
        };
        self.xml.value("string", "distribution", name);
        if alpha_u == alpha_v {
            self.xml.value("float", "alpha", &single(*alpha_u));
        } else {
            self.xml.value("float", "alpha_u", &single(*alpha_u));
            self.xml.value("float", "alpha_v", &single(*alpha_v));
        }
    }

    fn colour(&mut self, name: &str, value: Colour) {
        match value {
            Colour::Constant(c) => self.xml.value("rgb", name, &colour(c)),
            Colour::Texture(i) => self.xml.leaf("ref", &[("name", name), ("id", &self.texture_ids[i])]),
        }
    }

    /// A colour that need not stand where it is 1.
    fn factor(&mut self, name: &str, value: Colour) {
        if value != Colour::Constant(Rgb::WHITE) {
            self.colour(name, value);
        }
    }
}

pub(crate) fn plugin(bsdf: &Bsdf) -> &'static str {
    match bsdf {
        Bsdf::Diffuse(Diffuse { .. }) => "diffuse",
        Bsdf::Dielectric(Dielectric { roughness: None, .. }) => "dielectric",
        Bsdf::Dielectric(Dielectric { .. }) => "roughdielectric",
        Bsdf::ThinDielectric(ThinDielectric { .. }) => "thindielectric",
        Bsdf::Mirror(Mirror { .. }) | Bsdf::Conductor(Conductor { roughness: None, .. }) => "conductor",
        Bsdf::Conductor(Conductor { .. }) => "roughconductor",
        Bsdf::Plastic(Plastic { roughness: None, .. }) => "plastic",
        Bsdf::Plastic(Plastic { .. }) => "roughplastic",
        Bsdf::Null(Null) => "null",
    }
}

/// Whether a BSDF describes both sides by itself.
fn is_transmitting(bsdf: &Bsdf) -> bool {
    matches!(
        bsdf,
        Bsdf::Dielectric(Dielectric { .. }) | Bsdf::ThinDielectric(ThinDielectric { .. }) | Bsdf::Null(Null)
    )
}

/// The mean channel; the channel itself where all are the same.
pub(crate) fn mean(c: Rgb) -> f32 {
    if c.r == c.g && c.g == c.b { c.r } else { c.mean() }
}

/// A transform of the plane as one of space.
fn in_space(t: DAffine2) -> DAffine3 {
    let m = t.matrix2;
    DAffine3::from_mat3_translation(
        DMat3::from_cols(m.x_axis.extend(0.0), m.y_axis.extend(0.0), foton_math::glam::DVec3::Z),
        t.translation.extend(0.0),
    )
}
