//! The real window, driven by pointer and keys on a display that nobody sees: what a person sees and saves is what the
//! headless program renders. One test for that, because one window tells it all.
#![cfg(target_os = "linux")]

mod window_system;

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use foton_film::{Image, read_exr};
use foton_tests::window::{Display, Opening, PATIENCE, Window};
use serde_json::Value;

/// Small, so that passes are quick on any machine: a floor, a chalk ball in the middle, a lamp above the camera.
const SCENE: &str = r#"<scene version="3.0.0">
    <integrator type="ppm"><integer name="photon_count" value="40000"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="37.123456"/>
        <transform name="to_world"><lookat origin="0, 2.5, 7" target="0, 0.8, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm">
            <integer name="width" value="120"/><integer name="height" value="90"/><rfilter type="box"/>
        </film>
    </sensor>
    <bsdf type="diffuse" id="grey"><rgb name="reflectance" value="0.4"/></bsdf>
    <bsdf type="diffuse" id="chalk"><rgb name="reflectance" value="0.9, 0.5, 0.3"/></bsdf>
    <shape type="rectangle" id="floor">
        <transform name="to_world"><scale value="8"/><rotate x="1" angle="-90"/></transform>
        <ref id="grey"/>
    </shape>
    <shape type="sphere" id="ball">
        <point name="center" x="0" y="0.8" z="0"/><float name="radius" value="0.8"/>
        <ref id="chalk"/>
    </shape>
    <emitter type="point" id="lamp">
        <point name="position" x="2" y="5" z="4"/><rgb name="intensity" value="40"/>
    </emitter>
</scene>
"#;

/// The image's size in pixels.
const SIZE: [f64; 2] = [120.0, 90.0];

const WINDOW: [u32; 2] = [1000, 640];

/// A folder that goes with the test, unless it fails.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = fs::remove_dir_all(&self.0);
        }
    }
}

/// The program as the sources are now: the one that whoever runs all tests says that they come with, or one built here. (Built
/// alone it has other features in its dependencies than among all tests, which takes minutes.)
fn foton() -> PathBuf {
    if let Some(program) = env::var_os("FOTON_PROGRAM") {
        return program.into();
    }
    let target =
        env::current_exe().expect("this program").ancestors().nth(2).expect("deps lie in it").to_owned();
    let program = target.join("foton");
    if !is_newer_than_its_sources(&program) {
        let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let built = Command::new(cargo).args(["build", "--package", "foton"]).status();
        assert!(built.is_ok_and(|status| status.success()), "cargo build --package foton");
    }
    program
}

/// Whether it was built after the last change, by the list of its sources that cargo keeps beside it.
fn is_newer_than_its_sources(program: &Path) -> bool {
    let changed = |path: &Path| fs::metadata(path).and_then(|m| m.modified()).ok();
    let (Some(built), Ok(list)) = (changed(program), fs::read_to_string(program.with_extension("d"))) else {
        return false;
    };
    let mut sources = list.split_whitespace().skip(1).map(Path::new);
    sources.all(|source| changed(source).is_some_and(|at| at <= built))
}

/// The window and how to point at what it shows.
struct Driver {
    display: Display,
    window: Window,
    folder: PathBuf,
}

/// The small scene in a window of its own, with a fault to come if one is named. The folder is to go last.
fn opened(name: &str, fault: Option<&str>) -> (Folder, Driver) {
    let folder = env::temp_dir().join(format!("foton-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let scene = folder.join("small.xml");
    fs::write(&scene, SCENE).expect("written");
    let display = Display::start(WINDOW);
    let opening =
        Opening { foton: &foton(), scene: Some(&scene), folder: &folder, size: WINDOW, is_dark: true, fault };
    let window = Window::open(&display, &opening);
    (Folder(folder.clone()), Driver { display, window, folder })
}

impl Driver {
    /// Where a position of the image is on the screen.
    fn at(&mut self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, width, height] = self.window.place("canvas");
        let scale = (width / SIZE[0]).min(height / SIZE[1]);
        [left + width / 2.0 + (x - SIZE[0] / 2.0) * scale, top + height / 2.0 + (y - SIZE[1] / 2.0) * scale]
    }

    fn point(&mut self, film: [f64; 2]) {
        let [x, y] = self.at(film);
        self.display.hand(&format!("mousemove {x:.0} {y:.0}"));
    }

    fn key(&self, key: &str) {
        self.display.hand(&format!("key {key}"));
    }

    fn click(&mut self, name: &str) {
        let [x, y, width, height] = self.window.place(name);
        self.display.hand(&format!("mousemove {:.0} {:.0} click 1", x + width / 2.0, y + height / 2.0));
    }

    /// The canvas as it is on the screen; with a name, because a failed test leaves its pictures.
    fn canvas(&mut self, name: &str) -> Image {
        let all = self.display.picture(&self.folder.join(name).with_extension("png"));
        let [left, top, width, height] = self.window.place("canvas").map(|v| v as u32);
        let row = |y| (y * all.width + left) as usize;
        let pixels = (top..top + height).flat_map(|y| all.pixels[row(y)..row(y) + width as usize].to_vec());
        Image { width, height, pixels: pixels.collect() }
    }

    /// Looks at the canvas until it is as it should be: the screen shows a frame a little after the log has it.
    #[track_caller]
    fn until(&mut self, name: &str, is_it: impl Fn(&Image) -> bool) -> Image {
        let begin = Instant::now();
        loop {
            let image = self.canvas(name);
            if is_it(&image) {
                return image;
            }
            assert!(begin.elapsed() < PATIENCE, "{name}.png in {}", self.folder.display());
        }
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_default()
}

/// Mean luminance of a square around a place of the image, 0 to 1 across and down.
fn light(image: &Image, [x, y]: [f64; 2]) -> f64 {
    let (x, y) = ((x * f64::from(image.width)) as u32, (y * f64::from(image.height)) as u32);
    let mut sum = 0.0;
    for j in y - 10..y + 10 {
        for i in x - 10..x + 10 {
            sum += f64::from(image.pixels[(j * image.width + i) as usize].luminance());
        }
    }
    sum / 400.0
}

#[test]
fn what_a_person_sees_steers_and_saves_is_what_the_program_renders() {
    let (_folder, mut driver) = opened("window", None);
    let (foton, scene) = (foton(), driver.folder.join("small.xml"));

    it_opens_and_converges(&mut driver);
    what_is_saved_is_what_is_rendered(&mut driver, &foton, &scene);
    passes_go_on_while_alpha_moves(&mut driver);
    numbers_are_what_was_typed(&mut driver);
    an_object_is_dragged(&mut driver);
    copies_come_and_go_and_unsaved_edits_are_asked_about(&mut driver);
    errors_are_none_and_it_closes(&mut driver);
}

fn it_opens_and_converges(driver: &mut Driver) {
    driver
        .window
        .frame("a pass", |f| (f["activity"] == "rendering" && number(&f["pass"]) > 1.0).then_some(()));
    let first = driver.until("opened", |image| light(image, [0.5, 0.5]) > 0.02);
    let pass = driver.window.frame("a pass", |f| Some(number(&f["pass"])));
    driver.window.frame("another pass", |f| (number(&f["pass"]) > pass).then_some(()));
    driver.until("later", |image| image.pixels != first.pixels);
}

fn what_is_saved_is_what_is_rendered(driver: &mut Driver, foton: &Path, scene: &Path) {
    driver.point([60.0, 45.0]);
    driver.window.frame("the pointer", |f| f.get("probe").map(|_| ()));
    driver.key("space");
    let pass = driver.window.frame("the pause", |f| (f["activity"] == "paused").then(|| number(&f["pass"])));
    // On the ball, on the floor before it, and far behind.
    let mut probed = Vec::new();
    for pixel in [[60, 40], [20, 80], [100, 20]] {
        driver.point(pixel.map(|v| f64::from(v) + 0.5));
        let radiance = driver.window.frame("the probe", |f| {
            let probe = f.get("probe").filter(|p| p["pixel"] == serde_json::json!(pixel))?;
            Some(probe["radiance"].as_array()?.iter().map(number).collect::<Vec<_>>())
        });
        probed.push((pixel, radiance));
    }
    driver.key("p");
    let saved = driver.window.wait("it saved", |l| {
        let path = l["message"].as_str()?.strip_prefix("Saved ")?;
        path.ends_with(".exr").then(|| PathBuf::from(path))
    });
    driver.window.wait("the other", |l| l["message"].as_str().filter(|m| m.ends_with(".png")).map(|_| ()));
    let name = format!("Pictures/foton/small-001-p{pass:06}.exr");
    assert_eq!(saved, driver.folder.join(name), "among the user's pictures, by scene, run and pass");
    let (image, metadata) = read_exr(&saved).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(metadata.get("foton:passes"), Some(format!("{pass}").as_str()));
    for (pixel, radiance) in probed {
        let c = image.pixels[(pixel[1] * image.width + pixel[0]) as usize];
        let shown: Vec<f32> = radiance.iter().map(|v| *v as f32).collect();
        assert_eq!(shown, [c.r, c.g, c.b], "at {pixel:?}");
    }
    for extension in ["exr", "png"] {
        let rendered = driver.folder.join("rendered").with_extension(extension);
        let mut render = Command::new(foton);
        render.arg("render").arg(scene).arg("-o").arg(&rendered).args(["--passes", &format!("{pass}")]);
        assert!(render.output().is_ok_and(|o| o.status.success()));
        let bytes = |path: &Path| fs::read(path).expect("it is there");
        assert!(
            bytes(&rendered) == bytes(&saved.with_extension(extension)),
            "{extension} after {pass} passes"
        );
    }
    driver.key("space");
    driver.window.frame("it going on", |f| (number(&f["pass"]) > pass).then_some(()));
}

fn passes_go_on_while_alpha_moves(driver: &mut Driver) {
    let [x, y, width, height] = driver.window.place("alpha");
    let before = driver.window.frame("a frame", |f| Some((number(&f["pass"]), number(&f["render"]))));
    driver.display.hand(&format!("mousemove {:.0} {:.0} mousedown 1", x + 0.66 * width, y + height / 2.0));
    let mut alphas = Vec::new();
    for step in 1..=5 {
        driver.display.hand(&format!(
            "mousemove {:.0} {:.0}",
            x + (0.66 - 0.1 * f64::from(step)) * width,
            y + height / 2.0
        ));
        let last = alphas.last().copied().unwrap_or(1.0);
        alphas.push(
            driver
                .window
                .frame("a smaller alpha", |f| Some(number(&f["alpha"])).filter(|a| *a < last - 0.02)),
        );
    }
    let during = driver.window.frame("a pass meanwhile", |f| {
        Some((number(&f["pass"]), number(&f["render"]))).filter(|now| now.0 > before.0)
    });
    assert_eq!(during.1, before.1, "nothing starts anew");
    driver.display.hand("mouseup 1");
    assert!(alphas[4] < 0.4, "{alphas:?}");
    driver.window.frame("passes after it", |f| (number(&f["pass"]) > during.0 + 1.0).then_some(()));
}

fn numbers_are_what_was_typed(driver: &mut Driver) {
    for (place, figure, text, value) in
        [("alpha field", "alpha", "0.5", 0.5), ("photons per pass", "photons_per_pass", "65432", 65_432.0)]
    {
        driver.click(place);
        driver.window.log.skip();
        driver.window.wait("the field", |line| (line["event"] == "drawn").then_some(()));
        driver.window.wait("the field", |line| (line["event"] == "drawn").then_some(()));
        for key in text.chars() {
            driver.display.hand(&format!("type {key}"));
            // Frames arrive meanwhile.
            driver.window.wait("a frame", |line| (line["event"] == "drawn").then_some(()));
        }
        let before = driver.window.frame("a frame", |f| Some((number(&f["render"]), number(&f[figure]))));
        assert!((before.1 - value).abs() > 1e-9, "{figure} before it is committed");
        driver.key("Return");
        let render = driver.window.frame(figure, |f| {
            (number(&f[figure]) != before.1).then(|| (number(&f["render"]), number(&f[figure])))
        });
        assert_eq!(render, (before.0, value), "{figure}");
    }
    // Keys are shortcuts again after a click in the picture.
    driver.point([5.0, 5.0]);
    driver.display.hand("click 1");
    driver.key("space");
    driver.window.frame("the pause", |f| (f["activity"] == "paused").then_some(()));
    driver.key("space");
    driver.window.frame("it going on", |f| (f["activity"] == "rendering").then_some(()));
}

fn an_object_is_dragged(driver: &mut Driver) {
    let ball = [60.0, 45.0];
    driver.point(ball);
    driver.display.hand("click 1");
    driver.window.frame("the choice", |f| (f["chosen"] == "ball").then_some(()));
    // The inspector has taken room, so the places are those of the next frame.
    driver.window.frame("the next frame", |f| (f["activity"] == "rendering").then_some(()));
    let render = driver.window.frame("a frame", |f| Some(number(&f["render"])));
    let before = driver.canvas("chosen");
    driver.point(ball);
    driver.display.hand("mousedown 1");
    for x in [64.0, 72.0, 84.0, 90.0] {
        driver.point([x, ball[1]]);
        driver.window.wait("a frame", |line| (line["event"] == "drawn").then_some(()));
    }
    driver.window.frame("the move", |f| (number(&f["render"]) > render && f["edited"] == true).then_some(()));
    driver.display.hand("mouseup 1");
    driver.window.frame("the whole picture", |f| {
        (f["activity"] == "rendering"
            && f["edited"] == true
            && f["size"] == f["picture"]
            && number(&f["pass"]) > 1.0)
            .then_some(())
    });
    // Where the ball was there is floor, and the other way round.
    driver.point([5.0, 85.0]);
    let changed = |image: &Image, at| (light(image, at) / light(&before, at) - 1.0).abs() > 0.1;
    driver.until("moved", |image| changed(image, [0.5, 0.45]) && changed(image, [0.75, 0.45]));
    driver.key("ctrl+z");
    driver
        .window
        .frame("it undone", |f| (f["edited"] == false && f["activity"] == "rendering").then_some(()));
    driver.click("pause");
    driver.window.frame("the pause", |f| (f["activity"] == "paused").then_some(()));
    driver.click("pause");
}

fn copies_come_and_go_and_unsaved_edits_are_asked_about(driver: &mut Driver) {
    driver.window.frame("the ball", |f| (f["chosen"] == "ball").then_some(()));
    driver.key("ctrl+d");
    driver.window.frame("the copy", |f| (f["chosen"] == "ball-2" && f["edited"] == true).then_some(()));
    driver.key("Delete");
    driver.window.frame("it gone", |f| f["chosen"].is_null().then_some(()));
    driver.key("ctrl+q");
    driver.window.wait("the question", |l| l.get("places")?.get("discard").map(|_| ()));
    driver.key("Escape");
    driver.window.wait("it gone", |l| l.get("places")?.get("discard").is_none().then_some(()));
    // Faster than frames are drawn: Esc is for the question all the same, and the keys after it for the scene.
    driver.key("ctrl+q Escape ctrl+z ctrl+z");
    driver
        .window
        .frame("all undone", |f| (f["edited"] == false && f["activity"] == "rendering").then_some(()));
}

fn errors_are_none_and_it_closes(driver: &mut Driver) {
    driver.window.frame("passes", |f| (f["activity"] == "rendering").then_some(()));
    driver.point([5.0, 85.0]);
    driver.key("ctrl+q");
    let (took, is_well) = driver.window.end();
    assert!(is_well);
    // 200 ms on an idle machine; a pass or a file in the way would take longer than this on any.
    assert!(took.as_secs() < 10, "{took:?} from closing to the end");
    let errors: Vec<&Value> =
        driver.window.log.lines().iter().filter(|line| line["event"] == "error").collect();
    assert!(errors.is_empty(), "{errors:?}");
}
