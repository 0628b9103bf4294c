//! Glass, smooth and rough: reflection and refraction by the surface's normal or by a facet's.

use foton_math::glam::{Vec2, Vec3};
use foton_math::{Frame, Rgb};

use super::fresnel;
use super::lobe::{LOBES, SpecularLobe, Transport};
use super::reflect::mirrored;
use crate::description::Microfacets;

/// Reflection and refraction at glass, by the surface's normal or by a facet's.
pub(super) fn glass_lobes(
    wo: Vec3,
    transport: Transport,
    u: Vec2,
    [int_ior, ext_ior]: [f32; 2],
    [reflected, refracted]: [Rgb; 2],
    roughness: Option<Microfacets>,
) -> [Option<SpecularLobe>; LOBES] {
    let side = 1f32.copysign(wo.z);
    let h = roughness.map_or(Vec3::Z, |r| r.sample(wo * side, u)) * side;
    // The boundary in the facet's own frame, whose z is the facet's normal on the outside.
    let frame = Frame::from_normal(h * side);
    let local = if roughness.is_some() { frame.to_local(wo) } else { wo };
    let back = |w: Vec3| if roughness.is_some() { frame.to_outer(w) } else { w };
    let boundary = fresnel::dielectric(local, int_ior, ext_ior);
    let f = boundary.reflectance;
    let visible = |wi: Vec3, same_side: bool| match roughness {
        None => 1.0,
        Some(_) if (wi.z * wo.z > 0.0) != same_side => 0.0,
        Some(r) => r.visible(wi, h * side),
    };
    let spread = match transport {
        Transport::Radiance => boundary.relative_ior * boundary.relative_ior,
        Transport::Importance => 1.0,
    };
    let lobe = |wi: Vec3, chance: f32, tint: Rgb, same_side: bool| {
        let weight = tint * (chance * visible(wi, same_side));
        (!weight.is_black()).then_some(SpecularLobe { wi, weight, probability: chance })
    };
    let reflection = (f > 0.0).then(|| lobe(back(mirrored(local)), f, reflected, true)).flatten();
    let refraction = boundary
        .refracted
        .filter(|_| f < 1.0)
        .and_then(|wi| lobe(back(wi), 1.0 - f, refracted * spread, false));
    [reflection, refraction, None]
}

/// `f(wo, wi)` of rough glass for radiance, reflection and refraction. `[WML07]` equations 20 and 21
pub(super) fn rough_glass(
    r: &Microfacets,
    wo: Vec3,
    wi: Vec3,
    int_ior: f32,
    ext_ior: f32,
    reflected: Rgb,
    refracted: Rgb,
) -> Rgb {
    let Some(facet) = GlassFacet::between(wo, wi, int_ior, ext_ior) else { return Rgb::BLACK };
    let g = r.visible(wo, facet.normal) * r.visible(wi, facet.normal);
    let d = r.density(facet.normal) * g / (wo.z * wi.z).abs();
    if wo.z * wi.z > 0.0 {
        return reflected * (facet.reflectance * d * 0.25);
    }
    let jacobian = (wo.dot(facet.normal) * wi.dot(facet.normal)).abs() / facet.denominator(wo, wi).powi(2);
    // Radiance: the squared relative index of both sides cancels the jacobian's.
    refracted * ((1.0 - facet.reflectance) * d * jacobian * facet.eta * facet.eta)
}

/// The density of directions that sampling rough glass has.
pub(super) fn rough_glass_pdf(r: &Microfacets, wo: Vec3, wi: Vec3, int_ior: f32, ext_ior: f32) -> f32 {
    let Some(facet) = GlassFacet::between(wo, wi, int_ior, ext_ior) else { return 0.0 };
    let side = 1f32.copysign(wo.z);
    let pdf = r.pdf(wo * side, facet.normal);
    if wo.z * wi.z > 0.0 {
        return facet.reflectance * pdf / (4.0 * wo.dot(facet.normal).abs());
    }
    let jacobian = wi.dot(facet.normal).abs() / facet.denominator(wo, wi).powi(2);
    (1.0 - facet.reflectance) * pdf * jacobian
}

/// The facet that takes one direction to another.
struct GlassFacet {
    /// Its normal, with z > 0.
    normal: Vec3,
    reflectance: f32,
    /// Index on `wo`'s side over that on the other.
    eta: f32,
}

impl GlassFacet {
    fn between(wo: Vec3, wi: Vec3, int_ior: f32, ext_ior: f32) -> Option<Self> {
        let eta = if wo.z > 0.0 { ext_ior / int_ior } else { int_ior / ext_ior };
        let sum = if wo.z * wi.z > 0.0 { wo + wi } else { wo * eta + wi };
        let normal = sum.try_normalize()?;
        let normal = normal * 1f32.copysign(normal.z);
        let faces = wo.dot(normal) * wo.z > 0.0 && wi.dot(normal) * wi.z > 0.0;
        let local = Frame::from_normal(normal).to_local(wo);
        let reflectance = fresnel::dielectric(local, int_ior, ext_ior).reflectance;
        faces.then_some(Self { normal, reflectance, eta })
    }

    /// η (wo·h) + (wi·h), the indices being relative to `wi`'s side.
    fn denominator(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eta * wo.dot(self.normal) + wi.dot(self.normal)
    }
}
