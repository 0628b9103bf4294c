//! What travels with an image: enough to make it again. Nothing of when or where, so that equal renders give equal files.

use foton_film::Metadata;
use foton_integrator::{LayerKind, RadiusScale, Render};
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

/// Metadata of an image with layers of a render as it stands.
pub(crate) fn of(render: &Render, layers: &[LayerKind], scene: &SceneIdentity) -> Metadata {
    let s = render.settings();
    let sensor = &render.scene().sensors()[s.sensor];
    let radius = s.ppm.radius.map_or("footprint".to_owned(), |r| r.to_string());
    let radius = if s.ppm.radius_scale == RadiusScale::default() {
        radius
    } else {
        format!("{radius}*{}", s.ppm.radius_scale)
    };
    let rule = s.ppm.radius_rule.name();
    let direct = s.ppm.direct_light.name();
    let guide = if s.ppm.guided { "auto" } else { "off" };
    let region = region(sensor);
    let settings = format!(
        "integrator={} alpha={} photons={} first_pass={} radius={radius} radius_rule={rule} radius_floor={} direct={direct} guide={guide} max_depth={} spp={} \
         size={}x{} sensor={} hit_points_per_sample={} layers={}{region}",
        s.method.name(),
        s.ppm.alpha,
        s.ppm.photons_per_pass,
        s.ppm.first_pass,
        s.ppm.radius_floor,
        s.max_depth_in(render.scene()),
        s.samples_per_pixel,
        sensor.width,
        sensor.height,
        sensor.name,
        s.ppm.hit_points_per_sample,
        layers.iter().any(|layer| layer.needs_classes()),
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
    .chain(s.photon_seed.map(|seed| ("foton:photon-seed", seed.to_string())))
    .chain(error.map(|error| ("foton:error", error)))
    .collect()
}
