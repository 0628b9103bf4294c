//! BSDFs: a file for each model, with its parameters, its lobes, their values, pdfs and sampling; the enum of all of them; and a
//! BSDF at a point of a surface.
//!
//! Which lobes paths follow and for which hit points gather photons is no business of this folder: who asks passes a set of
//! lobes ([`LobeFlags`]). No texture lookups and no geometry either: correcting for shading normals is the path's business.

mod coat;
mod coating;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmitter;
mod flags;
mod fresnel;
mod info;
mod layer;
mod lobe_sample;
mod microfacet;
mod mirror;
mod mixed;
mod model;
mod null;
mod phong;
mod plastic;
mod principled;
mod reflect;
mod rough_diffuse;
mod scattering;
mod thin_dielectric;
mod ward;

use crate::description::{Amount, Colour, Number};
use crate::parameter::Binding;
pub use coat::Coat;
pub(crate) use coat::Coats;
pub use coating::Coating;
pub(crate) use coating::{COATING, ROUGH_COATING};
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use diffuse_transmitter::DiffuseTransmitter;
pub use flags::LobeFlags;
use foton_math::Rgb;
pub use info::BsdfInfo;
use info::Described;
pub use lobe_sample::{BsdfSample, LobeSample, LobeSamples, Transport};
pub use microfacet::{ISOTROPIC_ROUGHNESS, MicrofacetDistribution, Microfacets, ROUGHNESS};
pub use mirror::Mirror;

pub use null::Null;
pub use phong::Phong;
pub use plastic::Plastic;
pub use principled::{Principled, PrincipledThin, index_of_specular};
pub use rough_diffuse::RoughDiffuse;
pub use scattering::{Cover, Scattering};
pub use thin_dielectric::ThinDielectric;
pub use ward::Ward;

/// A bidirectional scattering distribution function, over colours `C` and numbers `N`: [`Colour`] and [`Number`] in a description,
/// [`Rgb`] and [`f32`] at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf<C = Colour, N = Number> {
    /// Lambertian reflection.
    Diffuse(Diffuse<C>),
    /// A boundary of two transparent media.
    Dielectric(Dielectric<C, N>),
    /// A thin pane of glass.
    ThinDielectric(ThinDielectric<C>),
    /// A smooth mirror that reflects the same share at every angle.
    Mirror(Mirror<C>),
    /// A metal.
    Conductor(Conductor<C, N>),
    /// A clear coat over a diffuse base.
    Plastic(Plastic<C, N>),
    /// Disney's principled model, of a closed body.
    Principled(Principled<C, N>),
    /// The same of a thin sheet.
    PrincipledThin(PrincipledThin<C, N>),
    /// Lambertian facets that shadow, hide and light each other.
    RoughDiffuse(RoughDiffuse<C, N>),
    /// A diffuse base and a lobe around the mirror direction.
    Phong(Phong<C, N>),
    /// A diffuse base and a highlight of Gaussian slopes.
    Ward(Ward<C, N>),
    /// Lambertian transmission.
    DiffuseTransmitter(DiffuseTransmitter<C>),
    /// Nothing: light passes as if there were no surface.
    Null(Null),
}

/// Evaluates an expression of whichever model a BSDF is, or for plastic, whose coat counts at a point, another one.
macro_rules! each {
    ($bsdf:expr, $model:ident => $result:expr) => {
        each!($bsdf, $model => $result, $model => $result)
    };
    ($bsdf:expr, $model:ident => $result:expr, $plastic:ident => $of_plastic:expr) => {
        match $bsdf {
            Bsdf::Diffuse($model) => $result,
            Bsdf::Dielectric($model) => $result,
            Bsdf::ThinDielectric($model) => $result,
            Bsdf::Mirror($model) => $result,
            Bsdf::Conductor($model) => $result,
            Bsdf::Plastic($plastic) => $of_plastic,
            Bsdf::RoughDiffuse($model) => $result,
            Bsdf::Phong($model) => $result,
            Bsdf::Ward($model) => $result,
            Bsdf::DiffuseTransmitter($model) => $result,
            Bsdf::Principled($model) => $result,
            Bsdf::PrincipledThin($model) => $result,
            Bsdf::Null($model) => $result,
        }
    };
}
use each;

impl Bsdf {
    /// Every model as a file means it that gives no parameters; smooth, or where it can be, rough. In the order of the window.
    #[must_use]
    pub fn defaults(rough: bool) -> [Self; 13] {
        [
            Self::Diffuse(Described::default(rough)),
            Self::Dielectric(Described::default(rough)),
            Self::ThinDielectric(Described::default(rough)),
            Self::Mirror(Described::default(rough)),
            Self::Conductor(Described::default(rough)),
            Self::Plastic(Described::default(rough)),
            Self::Principled(Described::default(rough)),
            Self::PrincipledThin(Described::default(rough)),
            Self::RoughDiffuse(Described::default(rough)),
            Self::Phong(Described::default(rough)),
            Self::Ward(Described::default(rough)),
            Self::DiffuseTransmitter(Described::default(rough)),
            Self::Null(Described::default(rough)),
        ]
    }

    /// What a plugin of Mitsuba means where it gives no parameters; `None`: no model is read from it.
    #[must_use]
    pub fn of_plugin(plugin: &str) -> Option<Self> {
        let models = Self::defaults(false).into_iter().chain(Self::defaults(true));
        let mut readable = models.filter(|b| b.info().stated.is_none());
        readable.find(|b| b.plugin() == plugin)
    }

    /// The same model as a surface begins that becomes one in the window.
    #[must_use]
    pub fn preset(&self) -> Self {
        /// Of the model of the value.
        fn of<M: Described>(_: &M) -> M {
            M::preset()
        }
        match self {
            Self::Diffuse(m) => Self::Diffuse(of(m)),
            Self::Dielectric(m) => Self::Dielectric(of(m)),
            Self::ThinDielectric(m) => Self::ThinDielectric(of(m)),
            Self::Mirror(m) => Self::Mirror(of(m)),
            Self::Conductor(m) => Self::Conductor(of(m)),
            Self::Plastic(m) => Self::Plastic(of(m)),
            Self::RoughDiffuse(m) => Self::RoughDiffuse(of(m)),
            Self::Phong(m) => Self::Phong(of(m)),
            Self::Ward(m) => Self::Ward(of(m)),
            Self::DiffuseTransmitter(m) => Self::DiffuseTransmitter(of(m)),
            Self::Principled(m) => Self::Principled(of(m)),
            Self::PrincipledThin(m) => Self::PrincipledThin(of(m)),
            Self::Null(m) => Self::Null(of(m)),
        }
    }

    /// What the model is called.
    #[must_use]
    pub fn info(&self) -> BsdfInfo {
        /// Of the model of the value.
        fn of<M: Described>(_: &M) -> BsdfInfo {
            M::INFO
        }
        each!(self, model => of(model))
    }

    /// The plugin of Mitsuba that means the same.
    #[must_use]
    pub fn plugin(&self) -> &'static str {
        let info = self.info();
        info.rough_plugin.filter(|_| self.roughness().is_some()).unwrap_or(info.plugin)
    }

    /// Whether Mitsuba 3 has its plugin and its microfacets; others are of Mitsuba 0.6.
    #[must_use]
    pub fn is_of_mitsuba_3(&self) -> bool {
        let is_phong = |r: Microfacets| r.distribution == MicrofacetDistribution::Phong;
        self.info().is_of_mitsuba_3 && !self.roughness().is_some_and(is_phong)
    }

    /// Its parameters, in the order of files and of the inspector, with the places of their values.
    #[must_use]
    pub fn parameters(&mut self) -> Vec<Binding<'_>> {
        each!(self, model => model.parameters())
    }
}

impl<C: Copy, N: Amount> Bsdf<C, N> {
    /// The lobes that it has.
    #[must_use]
    pub fn flags(&self) -> LobeFlags {
        each!(self, model => model.flags())
    }

    /// Whether light passes through.
    #[must_use]
    pub fn transmits(&self) -> bool {
        self.flags().intersects(LobeFlags::TRANSMISSION)
    }

    /// Whether light passes by a lobe that is narrower than a diffuse one.
    #[must_use]
    pub fn refracts(&self) -> bool {
        self.transmits() && self.flags().intersects(LobeFlags::DELTA.or(LobeFlags::GLOSSY))
    }

    /// Whether it describes both sides of the surface by itself: light passes through, or it is a sheet that is the same from both.
    #[must_use]
    pub fn has_two_sides(&self) -> bool {
        matches!(self, Self::PrincipledThin(_)) || self.transmits()
    }

    /// Whether its highlights are stretched along the texture's u or v.
    #[must_use]
    pub fn is_anisotropic(&self) -> bool
    where
        N: PartialEq,
    {
        match self {
            Self::Ward(Ward { alpha_u, alpha_v, .. }) => alpha_u != alpha_v,
            Self::Principled(Principled { anisotropic, .. })
            | Self::PrincipledThin(PrincipledThin { anisotropic, .. }) => anisotropic.most() > 0.0,
            _ => self.roughness().is_some_and(|r| r.alpha_u != r.alpha_v),
        }
    }

    /// Its microfacets, if any.
    #[must_use]
    pub const fn roughness(&self) -> Option<Microfacets<N>> {
        match self {
            Self::Dielectric(Dielectric { roughness, .. })
            | Self::Conductor(Conductor { roughness, .. })
            | Self::Plastic(Plastic { roughness, .. }) => *roughness,
            _ => None,
        }
    }

    /// The same BSDF with its colours and numbers replaced: numbers by what they are and the range that they may have.
    #[must_use]
    #[inline(always)]
    pub fn map<D, M>(
        &self,
        colours: impl FnMut(C) -> D,
        numbers: impl FnMut(N, [f32; 2]) -> M,
    ) -> Bsdf<D, M> {
        match self {
            Self::Diffuse(model) => Bsdf::Diffuse(model.map(colours)),
            Self::Dielectric(model) => Bsdf::Dielectric(model.map(colours, numbers)),
            Self::ThinDielectric(model) => Bsdf::ThinDielectric(model.map(colours)),
            Self::Mirror(model) => Bsdf::Mirror(model.map(colours)),
            Self::Conductor(model) => Bsdf::Conductor(model.map(colours, numbers)),
            Self::Plastic(model) => Bsdf::Plastic(model.map(colours, numbers)),
            Self::RoughDiffuse(model) => Bsdf::RoughDiffuse(model.map(colours, numbers)),
            Self::Phong(model) => Bsdf::Phong(model.map(colours, numbers)),
            Self::Ward(model) => Bsdf::Ward(model.map(colours, numbers)),
            Self::DiffuseTransmitter(model) => Bsdf::DiffuseTransmitter(model.map(colours)),
            Self::Principled(model) => Bsdf::Principled(model.map(colours, numbers)),
            Self::PrincipledThin(model) => Bsdf::PrincipledThin(model.map(colours, numbers)),
            Self::Null(model) => Bsdf::Null(*model),
        }
    }

    /// The reflectance of one that is Lambertian and nothing else.
    #[must_use]
    pub const fn lambertian(&self) -> Option<C> {
        if let Self::Diffuse(Diffuse { reflectance }) = self { Some(*reflectance) } else { None }
    }
}

impl Bsdf {
    /// What gets through its coat, integrated, where it has a rough one; `ends` says between which numbers a number is.
    pub(crate) fn rough_coats(&self, ends: impl Fn(Number, [f32; 2]) -> [f32; 2]) -> Option<Coats> {
        if let Self::Plastic(plastic) = self { plastic.rough_coats(ends) } else { None }
    }
}

impl Bsdf<Rgb, f32> {
    /// The larger roughness α of its glossy lobes, if it has any: that of its microfacets, or of those that would be as wide.
    #[must_use]
    pub fn gloss(&self) -> Option<f32> {
        each!(self, model => model::Model::gloss(model), plastic => plastic.roughness.map(|r| r.widest()))
    }
}

#[cfg(test)]
mod tests;
