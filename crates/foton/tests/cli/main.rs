//! The `foton` program as scripts see it: files, lines of JSON, exit codes. Scenes are tiny and written here.
//!
//! Not here: whether images are right. Signals are sent with `kill`, so their part runs on Unix alone.

#[cfg(debug_assertions)]
mod faults;
mod interface;
mod methods;
#[cfg(target_os = "linux")]
mod places;
mod refusals;
mod regions;
mod resuming;
mod roles;
mod scene_says;
mod sensors;
mod show;
#[cfg(unix)]
mod signals;
#[cfg(target_os = "linux")]
mod strangers;
#[cfg(target_os = "linux")]
mod streams;
mod strict;
#[cfg(target_os = "linux")]
mod write_faults;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Arc;

use foton_film::{Image, LayerData, Metadata, ToneMap, read_exr, write_exr, write_png};
use foton_integrator::{Alpha, LayerKind, PpmSettings, RenderSettings, SettingChange};
use foton_scene::Scene;
use foton_session::{Interrupt, Session, StopRule};
use serde_json::{Value, json};

/// A lamp over a floor with a glass ball and a small mesh, and two sensors.
const SCENE: &str = r#"<scene version="3.0.0">
    <default name="width" value="24"/>
    <default name="white" value="0.7"/>
    <sensor type="perspective" id="front">
        <float name="fov" value="45"/>
        <transform name="to_world"><lookat origin="0, 1, 4" target="0, 0.5, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="$width"/><integer name="height" value="16"/></film>
    </sensor>
    <sensor type="perspective" id="from above">
        <transform name="to_world"><lookat origin="0, 1.9, 0" target="0, 0, 0" up="0, 0, -1"/></transform>
        <film type="hdrfilm"><integer name="width" value="20"/><integer name="height" value="20"/></film>
    </sensor>
    <bsdf type="twosided" id="white"><bsdf type="diffuse"><rgb name="reflectance" value="$white"/></bsdf></bsdf>
    <shape type="rectangle">
        <transform name="to_world"><scale value="3"/><rotate x="1" angle="-90"/></transform>
        <ref id="white"/>
    </shape>
    <shape type="rectangle">
        <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/><translate y="2"/></transform>
        <emitter type="area"><rgb name="radiance" value="9, 8, 7"/></emitter>
    </shape>
    <shape type="sphere">
        <point name="center" x="-0.5" y="0.5" z="0"/>
        <float name="radius" value="0.5"/>
        <bsdf type="dielectric"/>
    </shape>
    <shape type="obj">
        <string name="filename" value="gem.obj"/>
        <transform name="to_world"><scale value="0.4"/><translate x="0.7" y="0.4"/></transform>
        <ref id="white"/>
    </shape>
</scene>
"#;

/// An octahedron.
const GEM: &str = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n\
    f 3 5 1\nf 3 1 6\nf 3 6 2\nf 3 2 5\nf 4 1 5\nf 4 6 1\nf 4 2 6\nf 4 5 2\n";

/// A folder with the scene in it that goes away with the value. The program runs in it.
struct Folder(PathBuf);

impl Folder {
    /// `name` is unique among the tests.
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("foton-cli-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).expect("a folder for temporary files");
        let folder = Self(path);
        folder.write("scene.xml", SCENE);
        folder.write("gem.obj", GEM);
        folder
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.file(name), text).expect("the folder is ours");
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.file(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn exr(&self, name: &str) -> (Image, Metadata) {
        read_exr(&self.file(name)).expect("an image")
    }

    /// What the program left in the folder, sorted.
    fn images(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("the folder is there");
        let names = entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned());
        let mut names: Vec<_> = names.filter(|name| !["scene.xml", "gem.obj"].contains(&&**name)).collect();
        names.sort();
        names
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_foton"));
        command.args(arguments.split_whitespace()).current_dir(&self.0).stdin(Stdio::null());
        // What is rescued goes there.
        command.env("TMPDIR", &self.0);
        command
    }

    fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().expect("the program starts")
    }

    /// Runs what must succeed.
    #[track_caller]
    fn done(&self, arguments: &str) -> Output {
        let output = self.run(arguments);
        assert!(output.status.success(), "foton {arguments}: {}", text(&output.stderr));
        output
    }

    /// Runs what must fail with `code`; returns what it said.
    #[track_caller]
    fn fails(&self, code: i32, arguments: &str) -> String {
        let output = self.run(arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "foton {arguments}: {said}");
        said
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// One JSON object a line, nothing else.
fn events(stdout: &[u8]) -> Vec<Value> {
    text(stdout).lines().map(|line| serde_json::from_str(line).expect("a JSON object a line")).collect()
}

fn number(event: &Value, field: &str) -> f64 {
    event[field].as_f64().unwrap_or_else(|| panic!("{field} is a number: {event}"))
}

#[test]
fn json_has_a_line_for_each_pass_and_one_for_the_end() {
    let folder = Folder::new("json");
    let output = folder.done("render scene.xml -o x.exr --direct photons --passes 3 --photons 2000 --json");
    let events = events(&output.stdout);
    assert_eq!(events.len(), 4, "{events:?}");
    for (pass, event) in (1u64..).zip(&events[..3]) {
        assert_eq!((&event["event"], &event["pass"]), (&json!("pass"), &json!(pass)));
        assert_eq!(event["photons"], 2000 * pass);
        for field in ["seconds", "photons_per_s", "rays_per_s", "radius_median", "bytes"] {
            assert!(number(event, field) > 0.0, "{field}: {event}");
        }
        assert!((0.0..1.0).contains(&number(event, "no_photon_share")), "{event}");
    }
    assert!(number(&events[0], "radius_median") > number(&events[2], "radius_median"));
    assert!(number(&events[0], "seconds") < number(&events[2], "seconds"));
    let done = &events[3];
    assert_eq!((&done["event"], &done["passes"]), (&json!("done"), &json!(3)));
    assert_eq!((&done["photons"], &done["outputs"]), (&json!(6000), &json!(["x.exr"])));
    assert!(number(done, "seconds") >= number(&events[2], "seconds"));
    // The lamp is a square metre: π times its radiance, by the mean of the channels. Of guided photons that is an estimate.
    let emitted = number(&done["ledger"], "emitted");
    assert!((emitted / (8.0 * std::f64::consts::PI) - 1.0).abs() < 1e-2, "{emitted}");
}

#[test]
fn a_render_stops_at_the_error_asked_for_and_not_before_it_is_known() {
    let folder = Folder::new("error");
    let output = folder
        .done("render scene.xml -o x.exr --error 20% --radius-floor 0 --photons 20000 --passes 400 --json");
    let events = events(&output.stdout);
    let done = events.last().expect("a line for the end");
    let passes = number(done, "passes");
    assert!((8.0..400.0).contains(&passes), "{done}");
    assert!(events[0]["error"].is_null() && number(done, "error_high") <= 0.2, "{done}");
    assert!(number(&events[events.len() - 3], "error_high") > 0.2 || passes < 10.0, "{passes}");
    assert!(folder.exr("x.exr").1.get("foton:error").is_some_and(|e| e.contains("noise=")));
    let part = |class: &str| number(&done["classes"][class], "error").powi(2);
    let parts = part("direct") + part("caustic") + part("indirect");
    assert!((parts.sqrt() / number(done, "error") - 1.0).abs() < 1e-6, "{done}");
}

#[test]
fn an_error_that_the_smallest_radii_do_not_allow_is_said_once() {
    let folder = Folder::new("out-of-reach");
    let output = folder.done("render scene.xml -o x.exr --error 2% --spp 1 --photons 20000 --passes 40");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(said.matches("will not fall to 2.000 %").count(), 1, "{said}");
    assert!(said.contains("--spp 4") && said.contains("--radius-floor 0"), "{said}");
}

#[test]
fn an_image_carries_what_it_takes_to_make_it_again() {
    let folder = Folder::new("metadata");
    folder.done("render scene.xml -o x.exr --passes 3 --photons 2000 --seed 7 --alpha 0.75 --spp 2");
    let (image, metadata) = folder.exr("x.exr");
    assert_eq!((image.width, image.height), (24, 16));
    assert!(image.pixels.iter().all(|c| c.is_finite()) && image.pixels.iter().any(|c| !c.is_black()));
    let get = |key: &str| metadata.get(key).unwrap_or_else(|| panic!("{key} is in {metadata:?}"));
    assert_eq!((get("foton:passes"), get("foton:photons"), get("foton:seed")), ("3", "6000", "7"));
    assert_eq!((get("foton:scene"), get("foton:version")), ("scene.xml", env!("CARGO_PKG_VERSION")));
    let hash = get("foton:scene-hash");
    assert!(hash.len() == 16 && hash.chars().all(|c| c.is_ascii_hexdigit()), "{hash}");
    let settings = get("foton:settings");
    for setting in ["alpha=0.75", "photons=2000", "spp=2", "size=24x16", "sensor=front", "integrator=ppm"] {
        assert!(settings.split(' ').any(|s| s == setting), "{setting}: {settings}");
    }
    // A parameter and a mesh are parts of the scene.
    folder.done("render scene.xml -o define.exr --passes 1 --photons 500 -D white=0.6");
    folder.write("gem.obj", &GEM.replace("v 0 1 0", "v 0 2 0"));
    folder.done("render scene.xml -o mesh.exr --passes 1 --photons 500");
    for other in ["define.exr", "mesh.exr"] {
        assert_ne!(folder.exr(other).1.get("foton:scene-hash"), Some(hash));
    }
}

/// Three chunks of 4096 photons, the last one not full.
#[test]
fn the_same_render_gives_the_same_bytes_on_any_number_of_threads() {
    let folder = Folder::new("threads");
    let render = "render scene.xml -o x.exr --passes 3 --photons 10000";
    let bytes = |arguments: &str| {
        folder.done(&format!("{render} {arguments}"));
        folder.bytes("x.exr")
    };
    let first = bytes("");
    for arguments in ["", "--json", "--threads 1", "--threads 2", "--threads 7", "--seed 0"] {
        assert!(bytes(arguments) == first, "{arguments}");
    }
    let image = folder.exr("x.exr").0;
    bytes("--seed 1");
    assert!(folder.exr("x.exr").0 != image, "another seed gives another image");
}

#[test]
fn images_on_the_way_are_those_of_shorter_renders() {
    let folder = Folder::new("every");
    let render = "render scene.xml --photons 2000 --json";
    let output = folder.done(&format!("{render} -o out.exr --passes 5 --every pow2"));
    let expected = ["out-000001.exr", "out-000002.exr", "out-000004.exr", "out.exr"];
    assert_eq!(folder.images(), expected);
    assert_eq!(events(&output.stdout).last().expect("the end")["outputs"], json!(expected));
    folder.done(&format!("{render} -o two.exr --passes 2"));
    assert!(folder.bytes("two.exr") == folder.bytes("out-000002.exr"));
    folder.done(&format!("{render} -o by-two.exr --passes 4 --every 2"));
    let by_two: Vec<_> = folder.images().into_iter().filter(|name| name.starts_with("by")).collect();
    assert_eq!(by_two, ["by-two-000002.exr", "by-two-000004.exr", "by-two.exr"]);
    for (name, same) in [("by-two-000002.exr", "two.exr"), ("by-two.exr", "out-000004.exr")] {
        assert!(folder.bytes(name) == folder.bytes(same), "{name}");
    }
}

#[test]
fn a_png_is_the_tone_mapped_image_with_the_same_metadata() {
    let folder = Folder::new("png");
    let render = "render scene.xml --passes 2 --photons 2000";
    for name in ["x.exr", "x.png"] {
        folder.done(&format!("{render} -o {name}"));
    }
    let (image, mut metadata) = folder.exr("x.exr");
    metadata.set("foton:look", "exposure=0 tone_map=pbr-neutral");
    write_png(&folder.file("expected.png"), &image, ToneMap::default(), 0.0, &metadata).expect("a PNG");
    assert!(folder.bytes("x.png") == folder.bytes("expected.png"));
    // As a window shows it, an exposure and another tone map are the PNG's own.
    folder.done(&format!("{render} -o shown.png --exposure -1.5 --tone-map agx"));
    metadata.set("foton:look", "exposure=-1.5 tone_map=agx");
    write_png(&folder.file("expected.png"), &image, ToneMap::AgX, -1.5, &metadata).expect("a PNG");
    assert!(folder.bytes("shown.png") == folder.bytes("expected.png"));
    let said = folder.fails(2, &format!("{render} -o x.exr --exposure 1"));
    assert!(said.contains("x.exr is an EXR, which holds linear radiance; write to x.png instead"), "{said}");
}

/// Two passes of the scene with its path classes kept apart.
fn session(scene: &Path) -> Session {
    let opened = foton_format::open(scene, &foton_format::Options::default()).expect("the scene opens");
    let scene = Arc::new(Scene::build(&opened.description).expect("the scene is sound"));
    let photons_per_pass = 2000.try_into().expect("above zero");
    let settings = RenderSettings {
        layers: true,
        error: true,
        ppm: PpmSettings { photons_per_pass, ..PpmSettings::default() },
        ..RenderSettings::default()
    };
    let interrupt = Interrupt::default();
    let mut session = Session::start(scene, settings, Some(2), interrupt.cancel()).expect("starts");
    session.run(&StopRule::passes(2), &interrupt, &mut |_| ());
    session
}

/// Whether two images agree to five digits in every pixel.
fn close(a: &Image, b: &Image) -> bool {
    let mut pixels = a.pixels.iter().zip(&b.pixels);
    (a.width, a.height) == (b.width, b.height)
        && pixels.all(|(&a, &b)| (a - b).map(f32::abs).max_component() <= 1e-5 * (1.0 + a.max_component()))
}

#[test]
fn layers_are_prefixed_channels_and_the_kinds_of_light_sum_to_the_image() {
    let folder = Folder::new("layers");
    let names = LayerKind::ALL.map(LayerKind::name).join(",");
    let render = "render scene.xml --passes 2 --photons 2000";
    folder.done(&format!("{render} -o plain.exr"));
    folder.done(&format!("{render} -o layers.exr --layers {names}"));
    let (image, metadata) = folder.exr("layers.exr");
    assert!(close(&image, &folder.exr("plain.exr").0), "the image is the same but for rounding");
    let bytes = folder.bytes("layers.exr");
    let has = |channel: &str| bytes.windows(channel.len()).any(|window| window == channel.as_bytes());
    for channel in ["R", "direct.R", "caustic.G", "indirect.B", "emission.R", "radius.Y", "photon_count.Y"] {
        assert!(has(&format!("\0{channel}\0")), "{channel}");
    }
    // The file holds what the library makes, channel for channel.
    let session = session(&folder.file("scene.xml"));
    let layers = LayerKind::ALL.map(|kind| session.render().layer(kind).expect("layers are on"));
    write_exr(&folder.file("expected.exr"), &session.render().image(), &layers, &metadata).expect("an EXR");
    assert!(bytes == folder.bytes("expected.exr"));
    let light: Vec<&Image> = layers
        .iter()
        .filter_map(|layer| match &layer.channels {
            LayerData::Rgb(image) => Some(image),
            _ => None,
        })
        .collect();
    assert_eq!(light.len(), 4, "direct, caustic, indirect and emission");
    assert!(light.iter().all(|image| image.pixels.iter().any(|c| !c.is_black())), "each is somewhere");
    let sum = |i| light.iter().map(|image| image.pixels[i]).reduce(|a, b| a + b).expect("four kinds");
    let pixels = (0..image.pixels.len()).map(sum).collect();
    assert!(close(&image, &Image { pixels, ..image }), "the kinds of light are all the light");
}

#[test]
fn parameters_size_and_sensor_are_those_asked_for() {
    let folder = Folder::new("choices");
    let render = |arguments: &[&str]| {
        let mut command = folder.command("render scene.xml -o x.exr --passes 1 --photons 500");
        let output = command.args(arguments).output().expect("the program starts");
        assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
        let (image, metadata) = folder.exr("x.exr");
        (image, metadata.get("foton:settings").expect("settings").to_owned())
    };
    let size = |image: &Image| (image.width, image.height);
    let (plain, _) = render(&[]);
    let (narrow, _) = render(&["-D", "width=17"]);
    assert_eq!((size(&plain), size(&narrow)), ((24, 16), (17, 16)));
    let (dark, _) = render(&["-D", "white=0.1"]);
    let light = |image: &Image| image.pixels.iter().map(|c| c.mean()).sum::<f32>();
    assert!(light(&dark) < 0.8 * light(&plain));
    let (resized, settings) = render(&["--size", "31x9"]);
    assert_eq!(size(&resized), (31, 9));
    assert!(settings.contains("size=31x9"), "{settings}");
    let (above, settings) = render(&["--sensor", "from above"]);
    assert_eq!(size(&above), (20, 20));
    assert!(settings.contains("sensor=from above"), "{settings}");
}
