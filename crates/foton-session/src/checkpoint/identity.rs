//! What must be the same in a render that goes on from a checkpoint. It stands in the file by name, so that whoever has changed
//! something is told what.

use foton_input::shown;
use foton_integrator::{KeptMaps, PhotonMapSettings, Render};
use foton_scene::Sensor;

use crate::metadata::SceneIdentity;

/// The name of the scene's hash, which no option sets.
const SCENE: &str = "scene";

/// The line that says whether a state has light by path class.
const CLASSES: &str = "kinds of light";

/// Why a state without light by path class does not do where that is asked for.
pub(super) const WITHOUT_CLASSES: &str =
    "was made with kinds of light summed, not kept apart, which cannot change on the way";

/// Differences that are said at most.
const MAX: usize = 20;

/// A line for each: its name, which is that of its option, and its value.
pub(super) fn of(render: &Render, scene: &SceneIdentity) -> String {
    let s = render.settings();
    let sensor = &render.scene().sensors()[s.sensor];
    let radius = match s.ppm.radius {
        Some(radius) => format!("{radius}*{}", s.ppm.radius_scale),
        None => format!("x{}", s.ppm.radius_scale),
    };
    let lines = [
        (SCENE, format!("{:016x}", scene.hash)),
        ("integrator", s.method.name().to_owned()),
        ("sensor", sensor.name.replace('\n', " ")),
        ("size", size(sensor)),
        ("seed", s.seed.to_string()),
        ("photon-seed", s.photon_seed.map_or_else(|| "that of all".to_owned(), |seed| seed.to_string())),
        ("spp", s.samples_per_pixel.to_string()),
        ("radius", radius),
        ("radius-rule", s.ppm.radius_rule.name().to_owned()),
        ("radius-floor", s.ppm.radius_floor.to_string()),
        ("direct", s.ppm.direct_light.name().to_owned()),
        ("guide", (if s.ppm.guided { "auto" } else { "off" }).to_owned()),
        ("max-depth", s.max_depth_in(render.scene()).to_string()),
        (CLASSES, (if s.layers { "kept apart" } else { "summed" }).to_owned()),
        ("error", (if s.error { "estimated" } else { "off" }).to_owned()),
        ("photons of the first pass", s.ppm.first_pass.to_string()),
        ("hit points a sample", s.ppm.hit_points_per_sample.to_string()),
        ("hit points", render.start_report().hit_points.to_string()),
    ];
    let maps = render.maps().map_or_else(String::new, |maps| of_maps(&s.photon_map, &maps));
    lines.map(|(name, value)| format!("{name}={value}\n")).concat() + &maps
}

/// Lines of two-pass photon mapping.
fn of_maps(s: &PhotonMapSettings, maps: &KeptMaps) -> String {
    let lines = [
        ("global-photons", s.global_photons.to_string()),
        ("caustic-photons", s.caustic_photons.to_string()),
        ("neighbours", s.neighbours.to_string()),
        ("photon-filter", s.filter.name().to_owned()),
        ("map-display", s.display.name().to_owned()),
        ("gather-rays", s.gather_rays.to_string()),
        ("shadow-photons", (if s.shadow_photons { "on" } else { "off" }).to_owned()),
        ("maps", format!("{:016x}", maps.fingerprint())),
    ];
    lines.map(|(name, value)| format!("{name}={value}\n")).concat()
}

/// Pixels that are rendered, and where in the image if that is not all of it.
fn size(sensor: &Sensor) -> String {
    let size = format!("{}x{}", sensor.width, sensor.height);
    if !sensor.is_cropped() {
        return size;
    }
    let [width, height] = sensor.whole();
    let window = sensor.window();
    format!("{size} at {},{} of {width}x{height}", window.x, window.y)
}

/// What differs between a checkpoint's lines and those of a render, in words; `None` if nothing does.
pub(super) fn difference(stored: &str, here: &str) -> Option<String> {
    if stored == here {
        return None;
    }
    let pairs = |text: &str| -> Vec<(String, String)> {
        let pairs = text.lines().filter_map(|line| line.split_once('='));
        // Light by path class is beside the rest and changes nothing of it.
        let all = pairs.filter(|(name, _)| *name != CLASSES);
        all.map(|(name, value)| (name.to_owned(), value.to_owned())).collect()
    };
    let (stored, here) = (pairs(stored), pairs(here));
    let mut differing = stored.iter().zip(&here).filter(|(stored, here)| stored != here).peekable();
    match differing.peek() {
        Some(((name, _), _)) if name == SCENE => {
            Some("is of another scene: its file, a file that it names, or a parameter is another".to_owned())
        }
        // Hit points differ along with anything that makes others of them.
        Some(_) => {
            let all: Vec<String> = differing
                .take(MAX)
                .map(|((name, stored), (_, here))| {
                    format!("{} {}, not {}", shown(name), shown(stored), shown(here))
                })
                .collect();
            let caused = if all.len() > 1 {
                all.iter().filter(|d| !d.starts_with("hit points ")).cloned().collect()
            } else {
                all
            };
            Some(format!("was made with {}, which cannot change on the way", caused.join("; ")))
        }
        None if stored == here && !here.is_empty() => None,
        None => Some("is of another render".to_owned()),
    }
}
