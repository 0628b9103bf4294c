//! What a render models, and why: each part is in the passes only if the scene or the settings ask for it.

use foton_scene::{Census, Emitter, Scene};
use foton_transport::LobeUse;
use foton_transport::camera_paths::Gloss;

use super::direct::{Direct, by_shadow_rays};
use super::kept::KeptRadius;
use super::lobes::lobe_use;
use super::radiance::Radiance;
use super::settings::{DirectLight, RadiusRule};
use crate::error::ErrorSums;
use crate::feature::Feature;
use crate::settings::RenderSettings;
use crate::sppm::Renewal;

/// All parts that can be left out, with whether they are.
pub(crate) fn features(scene: &Scene, settings: &RenderSettings) -> Vec<Feature> {
    let (census, lobes) = (scene.census(), lobe_use(scene));
    let aims = scene.emitters().iter().any(Emitter::aims_at_casters);
    let parts = eye_paths(census, lobes, settings)
        .into_iter()
        .chain(new_eye_samples(settings))
        .chain(surfaces(census, lobes))
        .chain(emitters(census, aims));
    let emits = census.emitters > 0;
    let shared = [guidance(emits, settings), shadow_rays(scene, settings)];
    parts.chain(shared).chain(asked_for(settings)).collect()
}

/// Only of a method that has them: whether it does is no finding about the scene.
fn new_eye_samples(settings: &RenderSettings) -> Option<Feature> {
    let adapts = settings.error || settings.ppm.radius_rule == RadiusRule::Adaptive;
    let feature = Feature::new(
        "new eye samples in each pass",
        settings.method.renews_eye_samples(),
        ["the method is stochastic progressive photon mapping", ""],
        "an eye pass before each photon pass",
    );
    feature.on.then(|| feature.with_bytes(size_of::<f32>(), Renewal::bytes_per_pixel(adapts)))
}

fn eye_paths(census: &Census, lobes: LobeUse, settings: &RenderSettings) -> [Feature; 5] {
    let hit_points_per_sample = settings.ppm.hit_points_per_sample;
    [
        Feature::new(
            "followed paths",
            lobes.specular,
            ["mirrors, glass, narrow gloss or openings", "every surface spreads light"],
            "eye rays beyond the first",
        ),
        Feature::new(
            "splitting at glass",
            census.refraction,
            ["surfaces refract", "nothing refracts"],
            format!("up to {hit_points_per_sample} hit points per eye sample"),
        ),
        Feature::new(
            "narrow gloss",
            lobes.specular_gloss,
            [
                "lobes of roughness up to 0.1 count as specular, each sampled once per eye sample",
                "no specular lobe is rough",
            ],
            if settings.method.renews_eye_samples() {
                "noise that falls from pass to pass"
            } else {
                "noise that one eye pass freezes: more --spp lowers it"
            },
        ),
        Feature::new(
            "looking at lights from narrow gloss",
            lobes.highlights,
            [
                "eye paths rarely meet small area emitters, points, spots and suns",
                "no narrow gloss, or no light but from the environment",
            ],
            "up to 17 shadow rays where an eye path meets narrow gloss",
        ),
        Feature::new(
            "photons in narrow gloss",
            lobes.highlights_by_photons,
            [
                "mirrors and smooth glass may cast light of points, spots and suns on it, which no eye path finds",
                "no narrow gloss, no such light, or nothing that casts it there",
            ],
            "a hit point wherever narrow gloss is sampled, two in rough glass",
        )
        .with_bytes(size_of::<Option<Gloss>>(), 0),
    ]
}

fn surfaces(census: &Census, lobes: LobeUse) -> [Feature; 7] {
    [
        Feature::new(
            "glossy hit points",
            lobes.gathered_gloss,
            ["gathered lobes that are not Lambertian", "all gathered lobes are Lambertian"],
            "a BSDF's value for each photon that counts there",
        )
        .with_bytes(size_of::<Option<Gloss>>(), 0),
        Feature::new(
            "rough coats",
            census.rough_coats,
            ["rough clear coats", "no coat is rough"],
            "an integral per material before the first pass, a series of eight terms per value",
        ),
        Feature::new(
            "shading normals' correction",
            lobes.shading_normals,
            [
                "interpolated or perturbed normals on surfaces that spread light",
                "such surfaces are flat or round",
            ],
            "a direction decoded for each photon that counts",
        )
        .with_bytes(3 * size_of::<f32>(), 0),
        Feature::new(
            "textures",
            census.textures,
            ["colours or numbers come from textures", "all colours and numbers are constant"],
            "a lookup at each surface, 24 bytes per triangle",
        ),
        Feature::new(
            "blends",
            census.mixtures,
            ["materials are blended of several", "no material is a blend"],
            "a hit point for each component, a choice for each photon",
        ),
        Feature::new(
            "bump and normal maps",
            census.reliefs,
            ["textures perturb normals", "no texture perturbs a normal"],
            "up to four lookups and a frame at each surface",
        ),
        Feature::new(
            "anisotropic frames",
            census.anisotropy,
            ["roughness differs along u and v", "roughness is the same all around"],
            "a tangent at each surface",
        ),
    ]
}

fn emitters(census: &Census, aims_at_casters: bool) -> [Feature; 2] {
    [
        Feature::new(
            "environment",
            census.environment,
            ["light comes from infinity", "no light comes from infinity"],
            "radiance for rays that escape, photons that miss",
        ),
        Feature::new(
            "aiming at casters",
            aims_at_casters,
            [
                "light from infinity, and mirrors or glass in a small part of the scene",
                "no light from infinity, or nothing small to aim at",
            ],
            "two pdfs per photon",
        ),
    ]
}

fn shadow_rays(scene: &Scene, settings: &RenderSettings) -> Feature {
    let reasons = match settings.ppm.direct_light {
        DirectLight::Auto => [
            "what is seen sees the emitters",
            "photons bring direct light: some is a narrow beam, or what is seen hardly sees the emitters",
        ],
        _ => ["asked for by --direct", "--direct asks for photons"],
    };
    let feature =
        Feature::new("shadow rays", by_shadow_rays(scene, settings), reasons, "about a quarter of a pass");
    // Where eye samples are new in each pass, direct light is summed with all that they see.
    let of_pixel = if settings.method.renews_eye_samples() { 0 } else { Direct::BYTES_PER_PIXEL };
    feature.with_bytes(size_of::<f32>(), of_pixel)
}

fn guidance(emits: bool, settings: &RenderSettings) -> Feature {
    Feature::new(
        "guided emission",
        emits && settings.ppm.guided,
        [
            "photons start where those of earlier passes were worth their cost",
            if emits { "--guide off" } else { "nothing emits" },
        ],
        "a search among cells for each photon, notes of up to 131,072 in training passes (1, 2, 4, 8 … 64, then every 64th)",
    )
}

fn asked_for(settings: &RenderSettings) -> [Feature; 3] {
    [
        Feature::new(
            "light by path class",
            settings.layers,
            ["asked for by --layers", "no layer asks for it"],
            "sums of caustic and indirect light beside those of all",
        )
        .with_bytes(24, Radiance::BYTES_BY_CLASS),
        Feature::new(
            "radii that adapt",
            settings.ppm.radius_rule == RadiusRule::Adaptive,
            ["the default radius rule", "another --radius-rule"],
            "five moments of each photon that counts",
        )
        .with_bytes(size_of::<KeptRadius>(), 0),
        Feature::new(
            "live error",
            settings.error,
            ["the error is asked for", "the error is not asked for"],
            "two moments of each photon that counts, squares of each pass",
        )
        .with_bytes(
            ErrorSums::BYTES_PER_HIT_POINT,
            ErrorSums::bytes_per_pixel(settings.method.renews_eye_samples()),
        ),
    ]
}
