//! Materials: how surfaces scatter light.

use foton_math::Rgb;

use super::texture::Colour;

/// How a surface scatters, on each side.
#[derive(Clone, Debug)]
pub struct Material {
    /// The id in the file, or a name made from the type.
    pub name: String,
    /// On the side that the normal points to. A dielectric describes both sides by itself.
    pub front: Bsdf,
    /// On the other side. `None`: a reflector is black there.
    pub back: Option<Bsdf>,
    /// Share of light that meets the surface at all; the rest passes straight through. `None`: all. Of a colour the mean channel
    /// counts, of a bitmap's the luminance, as in Mitsuba 3.
    pub opacity: Option<Colour>,
}

/// A bidirectional scattering distribution function, over colours `C`: [`Colour`] in a description, [`Rgb`] at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf<C = Colour> {
    /// Lambertian reflection.
    Diffuse {
        /// Share of light reflected, in [0, 1].
        reflectance: C,
    },
    /// A boundary of two transparent media.
    Dielectric {
        /// Index of refraction on the side away from the normal.
        int_ior: f32,
        /// Index of refraction on the side that the normal points to.
        ext_ior: f32,
        /// Factor on reflected light, physically 1.
        specular_reflectance: C,
        /// Factor on refracted light, physically 1.
        specular_transmittance: C,
        /// `None`: smooth.
        roughness: Option<Microfacets>,
    },
    /// A thin pane of glass: light passes straight on, reflections between its faces included.
    ThinDielectric {
        /// Index of refraction of the pane.
        int_ior: f32,
        /// Index of refraction around it.
        ext_ior: f32,
        /// Factor on reflected light, physically 1.
        specular_reflectance: C,
        /// Factor on transmitted light, physically 1.
        specular_transmittance: C,
    },
    /// A smooth mirror that reflects the same share at every angle (Mitsuba's material `none`).
    Mirror {
        /// Share of light reflected, in [0, 1].
        reflectance: C,
    },
    /// A metal.
    Conductor {
        /// Real part of the index of refraction per channel, relative to the outside.
        eta: Rgb,
        /// Imaginary part per channel.
        k: Rgb,
        /// Factor on reflected light, physically 1.
        specular_reflectance: C,
        /// `None`: smooth.
        roughness: Option<Microfacets>,
    },
    /// A clear coat over a diffuse base.
    Plastic {
        /// Index of refraction of the coat.
        int_ior: f32,
        /// Index of refraction outside.
        ext_ior: f32,
        /// Share of light that the base reflects, in [0, 1].
        diffuse_reflectance: C,
        /// Factor on light reflected by the coat, physically 1.
        specular_reflectance: C,
        /// Whether light that is reflected inside the coat takes on the base's colour each time.
        nonlinear: bool,
        /// `None`: a smooth coat.
        roughness: Option<Microfacets>,
    },
    /// Nothing: light passes as if there were no surface.
    Null,
}

/// A distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacets {
    /// Its shape.
    pub distribution: MicrofacetDistribution,
    /// Roughness α along the texture's u, above 0.
    pub alpha_u: f32,
    /// Roughness α along the texture's v, above 0.
    pub alpha_v: f32,
}

/// The shape of a distribution of microfacet normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MicrofacetDistribution {
    /// Gaussian slopes.
    #[default]
    Beckmann,
    /// Longer tails; also known as Trowbridge–Reitz.
    Ggx,
}
