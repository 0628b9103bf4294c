//! What travels with an image: enough to make it again. Nothing of when or where, so that equal renders give equal files.

use foton_film::Metadata;
use foton_integrator::{LayerKind, Method, PpmSettings, RadiusScale, Render, RenderSettings};
use foton_scene::Sensor;

/// The scene as metadata names it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneIdentity {
    /// Its name, such as that of its file.
    pub name: String,
    /// Hash of what it was read from, and of all edits since.
    pub hash: u64,
}

/// The part of an image that is rendered, if it is not all of it.
fn region(sensor: &Sensor) -> String {
    if !sensor.is_cropped() {
        return String::new();
    }
    let [width, height] = sensor.whole();
    format!(" region={} of={width}x{height}", sensor.window())
}

/// Settings of photons.
fn photons(s: &PpmSettings) -> String {
    let radius = s.radius.map_or("footprint".to_owned(), |r| r.to_string());
    let radius = if s.radius_scale == RadiusScale::default() {
        radius
    } else {
        format!("{radius}*{}", s.radius_scale)
    };
    format!(
        "alpha={} photons={} first_pass={} radius={radius} radius_rule={} radius_floor={} direct={} guide={} ",
        s.alpha,
        s.photons_per_pass,
        s.first_pass,
        s.radius_rule.name(),
        s.radius_floor,
        s.direct_light.name(),
        if s.guided { "auto" } else { "off" }
    )
}

/// Settings of two-pass photon mapping.
fn maps(settings: &RenderSettings) -> String {
    let s = &settings.photon_map;
    format!(
        "global_photons={} caustic_photons={} neighbours={} photon_filter={} map_display={} gather_rays={} shadow_photons={} direct={} ",
        s.global_photons,
        s.caustic_photons,
        s.neighbours,
        s.filter.name(),
        s.display.name(),
        s.gather_rays,
        s.shadow_photons,
        settings.ppm.direct_light.name()
    )
}

/// The cameras whose renders shared their photons: to make one of them again, all are to be rendered.
fn cameras(render: &Render) -> String {
    let name = |&i: &usize| render.scene().sensors()[i].name.as_str();
    render.cameras().iter().map(name).collect::<Vec<_>>().join(", ")
}

/// Metadata of an image with layers of a render as it stands.
pub(crate) fn of(render: &Render, layers: &[LayerKind], scene: &SceneIdentity) -> Metadata {
    let s = render.settings();
    let sensor = &render.scene().sensors()[s.sensor];
    let common = format!(
        "max_depth={} spp={} size={}x{} sensor={}",
        s.max_depth_in(render.scene()),
        s.samples_per_pixel,
        sensor.width,
        sensor.height,
        sensor.name,
    );
    let settings = format!(
        "integrator={} {}{common} {}layers={}{}",
        s.method.name(),
        match s.method {
            Method::PhotonMap => maps(s),
            method if method.has_photons() => photons(&s.ppm),
            _ => String::new(),
        },
        if s.method.has_photons() {
            format!("hit_points_per_sample={} ", s.ppm.hit_points_per_sample)
        } else {
            String::new()
        },
        layers.iter().any(|layer| layer.needs_classes()),
        region(sensor)
    );
    let changes: Vec<String> =
        render.changes().iter().map(|(pass, change)| format!("{pass} {change}")).collect();
    let error = render.error().map(|e| {
        let classes = e.classes.map_or_else(String::new, |classes| {
            let [direct, caustic, indirect] = classes.map(|c| c.total());
            format!(" direct={direct:.4} caustic={caustic:.4} indirect={indirect:.4}")
        });
        format!(
            "relative={:.4} noise={:.4} bias={:.4} low={:.4} high={:.4} unknown={:.4}{classes}",
            e.total, e.noise, e.bias, e.low, e.high, e.unknown_share
        )
    });
    [
        ("foton:version", env!("CARGO_PKG_VERSION").to_owned()),
        ("foton:scene", scene.name.clone()),
        ("foton:scene-hash", format!("{:016x}", scene.hash)),
        ("foton:passes", render.passes().to_string()),
        ("foton:photons", render.photons_emitted().to_string()),
        ("foton:seed", s.seed.to_string()),
        ("foton:settings", settings),
        ("foton:changes", changes.join("\n")),
    ]
    .into_iter()
    .chain((!render.cameras().is_empty()).then(|| ("foton:cameras", cameras(render))))
    .chain(s.photon_seed.map(|seed| ("foton:photon-seed", seed.to_string())))
    .chain(error.map(|error| ("foton:error", error)))
    .collect()
}
