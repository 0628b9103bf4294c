//! What a render models, and why: each part is in the passes only if the scene or the settings ask for it.

use foton_scene::{Emitter, Scene};
use foton_transport::camera_paths::Gloss;

use super::adaptive::RadiusStatistics;
use super::hit_points::ShadowOrigin;
use super::lobes::lobe_use;
use super::radiance::Radiance;
use super::settings::{DirectLight, RadiusRule};
use crate::error::ErrorSums;
use crate::settings::RenderSettings;

/// A part of the renderer that a scene may or may not need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Feature {
    /// Its name.
    pub name: &'static str,
    /// Whether it is in the passes.
    pub on: bool,
    /// What was found, or not found.
    pub why: &'static str,
    /// What it costs while it is on.
    pub cost: &'static str,
    /// Bytes a hit point while it is on.
    pub bytes_per_hit_point: usize,
    /// Bytes a pixel while it is on.
    pub bytes_per_pixel: usize,
}

/// All parts that can be left out, with whether they are.
#[must_use]
pub fn features(scene: &Scene, settings: &RenderSettings) -> Vec<Feature> {
    let census = scene.census();
    let lobes = lobe_use(scene);
    let feature = |name, on, found, absent, cost, bytes_per_hit_point, bytes_per_pixel| Feature {
        name,
        on,
        why: if on { found } else { absent },
        cost,
        bytes_per_hit_point,
        bytes_per_pixel,
    };
    let shadow_rays = settings.ppm.direct_light == DirectLight::ShadowRays;
    let layers = Radiance::<3>::BYTES_PER_PIXEL - Radiance::<1>::BYTES_PER_PIXEL;
    vec![
        feature(
            "followed paths",
            lobes.specular,
            "mirrors, glass, narrow gloss or openings",
            "every surface spreads light",
            "eye rays beyond the first",
            0,
            0,
        ),
        feature(
            "splitting at glass",
            census.refraction,
            "surfaces refract",
            "nothing refracts",
            "up to hit_points_per_sample hit points a sample",
            0,
            0,
        ),
        feature(
            "narrow gloss",
            lobes.specular_gloss,
            "lobes of roughness up to 0.1 are followed, each in one direction a sample",
            "no followed lobe is rough",
            "noise that one eye pass freezes: more --spp lowers it",
            0,
            0,
        ),
        feature(
            "looking at lights from narrow gloss",
            lobes.highlights,
            "small lamps, points, spots and suns are rarely met by following",
            "no narrow gloss, or no light but from the sky",
            "up to 17 shadow rays where an eye path meets narrow gloss",
            0,
            0,
        ),
        feature(
            "photons in narrow gloss",
            lobes.highlights_by_photons,
            "mirrors and smooth glass may throw light of points, spots and suns on it, where no eye path finds that",
            "no narrow gloss, no such light, or nothing that throws it there",
            "a hit point wherever narrow gloss is followed, two in rough glass",
            size_of::<Option<Gloss>>(),
            0,
        ),
        feature(
            "glossy hit points",
            lobes.gathered_gloss,
            "gathered lobes that are not Lambertian",
            "all gathered lobes are Lambertian",
            "a BSDF's value for each photon that counts there",
            size_of::<Option<Gloss>>(),
            0,
        ),
        feature(
            "rough coats",
            census.rough_coats,
            "clear coats with facets",
            "no coat is rough",
            "an integral a material before the first pass, a series of eight terms a value",
            0,
            0,
        ),
        feature(
            "shading normals' correction",
            lobes.shading_normals,
            "interpolated normals on surfaces that spread light",
            "such surfaces are flat or round",
            "a direction decoded for each photon that counts",
            3 * size_of::<f32>(),
            0,
        ),
        feature(
            "textures",
            census.textures,
            "colours come from textures",
            "all colours are constant",
            "a lookup at each surface, 24 bytes a triangle",
            0,
            0,
        ),
        feature(
            "anisotropic frames",
            census.anisotropy,
            "roughness differs along u and v",
            "roughness is the same all around",
            "a tangent at each surface",
            0,
            0,
        ),
        feature(
            "environment",
            census.environment,
            "light comes from infinity",
            "no light comes from infinity",
            "radiance for rays that escape, photons that miss",
            0,
            0,
        ),
        feature(
            "aiming at casters",
            scene.emitters().iter().any(Emitter::aims_at_casters),
            "light from infinity, and mirrors or glass in a small part of the scene",
            "no light from infinity, or nothing small to aim at",
            "two densities a photon",
            0,
            0,
        ),
        feature(
            "shadow rays",
            shadow_rays,
            "asked for by --direct",
            "direct light comes by photons",
            "a ray a hit point and pass",
            size_of::<ShadowOrigin>(),
            0,
        ),
        feature(
            "light by path class",
            settings.layers,
            "asked for by --layers",
            "no layer asks for it",
            "sums three times as large",
            24,
            layers,
        ),
        feature(
            "radii that adapt",
            settings.ppm.radius_rule == RadiusRule::Adaptive,
            "asked for by --radius-rule",
            "radii shrink as photons are found",
            "five moments of each photon that counts",
            size_of::<RadiusStatistics>(),
            0,
        ),
        feature(
            "live error",
            settings.error,
            "the error is asked for",
            "nothing asks how wrong the image is",
            "two moments of each photon that counts, squares of each pass",
            ErrorSums::BYTES_PER_HIT_POINT,
            ErrorSums::BYTES_PER_PIXEL,
        ),
    ]
}
