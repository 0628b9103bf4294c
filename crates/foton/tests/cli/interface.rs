//! What scripts rely on: options with the values that they take, defaults, and the keys of what is written. Names here are public:
//! a change of one is a change of the interface.

use super::*;

/// Options of `foton render` with values of each that must be accepted.
const OPTIONS: &[(&str, &[&str])] = &[
    ("--integrator", &["ppm", "sppm", "path", "whitted", "photon-map", "auto"]),
    ("--global-photons", &["500"]),
    ("--caustic-photons", &["0", "500"]),
    ("--neighbours", &["20"]),
    ("--photon-filter", &["box", "cone", "gaussian"]),
    ("--map-display", &["final-gathering", "direct"]),
    ("--gather-rays", &["2"]),
    ("--shadow-photons", &[""]),
    ("--save-maps", &["x.maps --integrator photon-map"]),
    ("--maps", &["x.maps --integrator photon-map"]),
    ("--preset", &["preview", "balanced", "final"]),
    ("--radius-rule", &["local", "global", "adaptive"]),
    ("--radius", &["0.2", "x0.5"]),
    ("--radius-floor", &["0", "1.5"]),
    ("--direct", &["auto", "photons", "shadow-rays"]),
    ("--guide", &["auto", "off"]),
    ("--photons", &["500"]),
    ("--alpha", &["0.5", "1"]),
    ("--error", &["off", "2%", "0.02"]),
    ("--time", &["90s", "10m", "1.5h"]),
    ("--size", &["8x4"]),
    ("--region", &["2,3,8,4"]),
    ("--spp", &["2"]),
    ("--max-depth", &["3"]),
    ("--seed", &["7"]),
    ("--threads", &["1"]),
    ("--sensor", &["front"]),
    ("--show", &["direct,caustic,indirect,emission", "photons"]),
    ("-D", &["white=0.6"]),
    ("--allow-missing", &[""]),
    ("--memory", &["800M", "8G"]),
    ("--every", &["pow2", "2"]),
    ("--checkpoint", &["x.ck", "x.ck --checkpoint-every 10m"]),
    ("--resume", &["x.ck"]),
    ("--exposure", &["-1.5", "2"]),
    ("--tone-map", &["linear", "pbr-neutral", "agx"]),
    ("--strict", &[""]),
    ("--json", &[""]),
];

/// The names of layers in an EXR.
const LAYERS: &str =
    "direct caustic indirect emission radius photon_count shape_id error_noise error_bias error_total";

/// Keys of an estimated error, in events of passes and of the end.
const ERROR: &str = "error noise bias error_low error_high error_focus unknown_share classes";

/// Stages of a render, whose times `done` has.
const STAGES: &str = "eye_pass layout trace sort gather shadow_rays radiance";

/// What a scene may switch on, as `foton info` names it.
const FEATURES: [&str; 19] = [
    "followed paths",
    "splitting at glass",
    "narrow gloss",
    "looking at lights from narrow gloss",
    "photons in narrow gloss",
    "glossy hit points",
    "rough coats",
    "shading normals' correction",
    "textures",
    "blends",
    "bump and normal maps",
    "anisotropic frames",
    "environment",
    "aiming at casters",
    "guided emission",
    "shadow rays",
    "light by path class",
    "radii that adapt",
    "live error",
];

/// Checks that an object has these keys, which are separated by spaces, and no others.
#[track_caller]
pub(super) fn has_keys(value: &Value, expected: &str) {
    let object = value.as_object().unwrap_or_else(|| panic!("an object: {value}"));
    let mut keys: Vec<&str> = object.keys().map(String::as_str).collect();
    let mut expected: Vec<&str> = expected.split_whitespace().collect();
    keys.sort_unstable();
    expected.sort_unstable();
    assert_eq!(keys, expected, "{value}");
}

fn named<'a>(events: &'a [Value], name: &str) -> &'a Value {
    events.iter().find(|event| event["event"] == name).unwrap_or_else(|| panic!("no {name}: {events:?}"))
}

#[test]
fn options_take_the_values_that_scripts_give_them() {
    let folder = Folder::new("values");
    let render = "render scene.xml -o x.exr --passes 2";
    for (option, values) in OPTIONS {
        // These are how a PNG looks.
        let render = if ["--exposure", "--tone-map"].contains(option) {
            &render.replace(".exr", ".png")
        } else {
            render
        };
        for value in *values {
            folder.done(&format!("{render} {option} {value}"));
        }
    }
    for layer in LAYERS.split(' ') {
        folder.done(&format!("{render} --layers {layer}"));
    }
    folder.done(&format!("{render} --layers {}", LAYERS.replace(' ', ",")));
}

#[test]
fn help_has_every_option_and_default() {
    let folder = Folder::new("help");
    let help = text(&folder.done("render --help").stdout);
    let options = OPTIONS.iter().map(|(option, _)| *option);
    for option in options.chain(["-o", "--passes", "--checkpoint-every", "--layers"]) {
        assert!(
            help.contains(&format!("{option} ")) || help.contains(&format!("{option}\n")),
            "{option}: {help}"
        );
    }
    let lines: Vec<&str> = help.lines().map(str::trim).collect();
    let default = |option: &str| {
        let after = lines.iter().skip_while(|line| !line.starts_with(option));
        after
            .copied()
            .find_map(|line| line.split_once("[default: ")?.1.split_once(']'))
            .map(|(value, _)| value)
    };
    for (option, value) in [
        ("--integrator", "ppm"),
        ("--radius-rule", "adaptive"),
        ("--radius-floor", "1"),
        ("--direct", "auto"),
        ("--guide", "auto"),
        ("--seed", "0"),
        ("--spp", "4, or 1 in each pass"),
        ("--checkpoint-every", "30s"),
    ] {
        assert_eq!(default(option), Some(value), "{option}: {help}");
    }
    let commands = text(&folder.done("--help").stdout);
    for command in ["render", "convert", "info", "compare", "measure"] {
        assert!(commands.contains(&format!("\n  {command} ")), "{command}: {commands}");
    }
    assert!(commands.contains("--frame-log"), "{commands}");
}

#[test]
fn events_of_a_render_have_their_keys() {
    let folder = Folder::new("render-keys");
    let output = folder.done("render scene.xml -o x.exr --passes 3 --photons 2000 --max-depth 2 --json");
    let found = events(&output.stdout);
    let pass = "event pass photons seconds photons_per_s rays_per_s radius_median no_photon_share bytes stored \
                candidates accepted radii_at_floor";
    has_keys(named(&found, "pass"), &format!("{pass} {ERROR}"));
    let done = named(&found, "done");
    let keys = "event passes photons seconds outputs ledger hit_points eye_rays stages lights";
    has_keys(done, &format!("{keys} {ERROR}"));
    let ledger = "emitted absorbed escaped roulette truncated shading_normals shading_normals_gain lost \
                  dropped_photons imbalance";
    has_keys(&done["ledger"], ledger);
    has_keys(&done["lights"][0], "name photons reached hit_rate");
    has_keys(&done["stages"], STAGES);
    has_keys(named(&found, "warning"), "event message");
}

#[test]
fn events_of_failures_have_their_keys() {
    let folder = Folder::new("failure-keys");
    let unknown = folder.run("render scene.xml -o x.exr --sensor none --json");
    has_keys(named(&events(&unknown.stdout), "error"), "event message");
    folder.write("bad.xml", &SCENE.replace("dielectric", "dielectrc"));
    let bad = folder.run("info bad.xml --json");
    has_keys(named(&events(&bad.stdout), "error"), "event message file line column");
}

#[test]
fn what_info_says_of_a_scene_has_its_keys() {
    let folder = Folder::new("info-keys");
    let found = events(&folder.done("info scene.xml --json").stdout);
    let info = named(&found, "info");
    has_keys(info, "event scene hash census sensors emitters integrator features memory");
    has_keys(&info["census"], "shapes triangles spheres discs tubes instances degenerate_triangles emitters");
    has_keys(&info["sensors"][0], "name width height");
    has_keys(&info["emitters"][0], "name type watts share");
    has_keys(&info["features"][0], "name on why cost bytes_per_hit_point bytes_per_pixel");
    has_keys(&info["memory"], "bytes scene hit_points pixels photons layout expected_hit_points");
    let features = info["features"].as_array().expect("a list");
    let names: Vec<&str> = features.iter().filter_map(|feature| feature["name"].as_str()).collect();
    assert_eq!(names, FEATURES);
    // The default number, not the name of a setting.
    assert_eq!(features[1]["cost"], "up to 8 hit points per eye sample");
}

#[test]
fn what_compare_says_of_images_has_its_keys() {
    let folder = Folder::new("compare-keys");
    folder.done("render scene.xml -o x.exr --passes 1 --photons 500");
    let found = events(&folder.done("compare x.exr x.exr --json").stdout);
    let compare = named(&found, "compare");
    let keys = "event a b width height non_finite mean_a mean_b ratio rmse rel_mse flip output scale_top";
    has_keys(compare, keys);
    has_keys(&compare["non_finite"], "a b left_out");
    has_keys(&compare["rmse"], "rgb all");
}

#[test]
fn events_of_a_sweep_have_their_keys() {
    let folder = Folder::new("sweep-keys");
    let sweep = "measure scene.xml -o sweep --budget 1ms --seeds 2 --spp 1 --photons 500 --size 8x6 --json";
    let found = events(&folder.done(sweep).stdout);
    has_keys(named(&found, "reference"), "event origin noise smooth_share");
    let job = "event photons_per_pass configurations passes least_error was_finished";
    has_keys(named(&found, "job"), job);
    let done = "event outputs recommendation jobs_done jobs interrupted";
    has_keys(named(&found, "done"), done);
}

#[test]
fn images_and_checkpoints_name_what_they_hold() {
    let folder = Folder::new("names");
    folder.done("render scene.xml -o x.exr --passes 12 --photons 2000 --checkpoint x.ck");
    let (_, metadata) = folder.exr("x.exr");
    let keys: Vec<&str> =
        metadata.iter().map(|(key, _)| key).filter(|key| key.starts_with("foton:")).collect();
    let expected =
        ["version", "scene", "scene-hash", "passes", "photons", "seed", "settings", "changes", "error"];
    assert_eq!(keys, expected.map(|key| format!("foton:{key}")));
    let names = |pairs: &str, between: char| -> Vec<String> {
        let pairs = pairs.split(between).filter_map(|pair| pair.split_once('='));
        pairs.map(|(name, _)| name.to_owned()).collect()
    };
    let settings = metadata.get("foton:settings").expect("settings");
    assert_eq!(
        names(settings, ' ').join(" "),
        "integrator alpha photons first_pass radius radius_rule radius_floor direct guide max_depth spp size sensor \
         hit_points_per_sample layers"
    );
    // The text of a checkpoint begins after 44 bytes; its length is at the twelfth.
    let bytes = folder.bytes("x.ck");
    let length = u64::from_le_bytes(bytes[12..20].try_into().expect("eight bytes")) as usize;
    let stored = text(&bytes[44..44 + length]);
    assert_eq!(
        names(&stored, '\n').join(", "),
        "scene, integrator, sensor, size, seed, photon-seed, spp, radius, radius-rule, radius-floor, direct, guide, max-depth, kinds of light, error, \
         photons of the first pass, hit points a sample, hit points"
    );
}
