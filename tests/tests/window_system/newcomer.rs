//! A newcomer's first minute: open, watch it converge, type numbers, select the ring, move it by its handles, make it of glass, take a
//! snapshot, undo, duplicate, delete, save and close, and no question is asked.

use std::fs;
use std::path::Path;

use super::super::{Driver, Folder, WINDOW, foton, number};
use foton_tests::window::{Display, Opening, Window};

/// The ring that ships with foton, small, so that renders are quick on any machine.
fn ring(folder: &Path) -> std::path::PathBuf {
    let asset = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/ring");
    let meshes = folder.join("meshes");
    fs::create_dir_all(&meshes).expect("a folder");
    for file in fs::read_dir(asset.join("meshes")).expect("it ships with foton") {
        let file = file.expect("it can be read");
        fs::copy(file.path(), meshes.join(file.file_name())).expect("copied");
    }
    let text = fs::read_to_string(asset.join("scene.xml")).expect("it ships with foton");
    let small = [("\"720\"", "\"180\""), ("\"480\"", "\"120\""), ("value=\"64\"", "value=\"1\"")];
    let scene = folder.join("ring.xml");
    fs::write(&scene, small.iter().fold(text, |text, (from, to)| text.replacen(from, to, 1)))
        .expect("written");
    scene
}

fn opened() -> (Folder, Driver) {
    let folder = std::env::temp_dir().join(format!("foton-newcomer-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let scene = ring(&folder);
    let display = Display::start(WINDOW);
    let opening = Opening {
        foton: &foton(),
        scene: Some(&scene),
        folder: &folder,
        size: WINDOW,
        is_dark: true,
        fault: None,
    };
    let window = Window::open(&display, &opening);
    (Folder(folder.clone()), Driver { display, window, folder })
}

/// Types into a field instead of what it holds.
fn type_into(driver: &mut Driver, field: &str, text: &str) {
    driver.click(field);
    frames(driver);
    driver.key("ctrl+a");
    driver.display.hand(&format!("type {text}"));
    driver.key("Return");
}

/// What was asked for is on the screen, and in its place.
fn frames(driver: &mut Driver) {
    driver.window.log.skip();
    for _ in 0..3 {
        driver.window.wait("a frame", |line| (line["event"] == "drawn").then_some(()));
    }
}

#[test]
fn a_newcomers_minute() {
    let (_folder, mut driver) = opened();
    let driver = &mut driver;
    driver.window.frame("passes", |f| (number(&f["pass"]) > 2.0).then_some(()));
    type_into(driver, "alpha field", "0.5");
    driver.window.frame("α", |f| (number(&f["alpha"]) == 0.5).then_some(()));
    type_into(driver, "photons per pass", "262144");
    driver.window.frame("photons", |f| (number(&f["photons_per_pass"]) == 262_144.0).then_some(()));
    it_is_edited(driver);
    it_is_saved_and_closed(driver);
}

/// By handles, by a preset, by keys.
fn it_is_edited(driver: &mut Driver) {
    driver.click("row ring");
    let chosen = driver.window.frame("the ring", |f| {
        (f["chosen"] == "ring" && f["material"] == "gold")
            .then(|| [number(&f["render"]), number(&f["shapes"])])
    });
    // Where its handles are is known once they are drawn.
    driver.window.wait("its handles", |line| line["places"].get("handle x").map(|_| ()));
    let [x, y, width, height] = driver.window.place("handle x");
    let (x, y) = (x + width / 2.0, y + height / 2.0);
    driver.display.hand(&format!("mousemove {x:.0} {y:.0} mousedown 1"));
    frames(driver);
    for step in 1..=4 {
        driver.display.hand(&format!("mousemove {:.0} {y:.0}", x + 6.0 * f64::from(step)));
        // A hand is slower than a frame.
        frames(driver);
    }
    driver.display.hand("mouseup 1");
    driver
        .window
        .frame("it moved", |f| (f["edited"] == true && number(&f["render"]) > chosen[0]).then_some(()));

    driver.click("presets");
    driver.window.wait("presets", |line| line["places"].get("preset crown glass").map(|_| ()));
    // A list finds its place in its second frame.
    frames(driver);
    driver.click("preset crown glass");
    // Its name is asked for, and proposed.
    frames(driver);
    driver.key("Return");
    driver
        .window
        .frame("glass", |f| f["material"].as_str().filter(|name| name.contains("crown")).map(|_| ()));
    driver.window.frame("a pass of glass", |f| {
        (f["activity"] == "rendering" && f["size"] == f["picture"] && number(&f["pass"]) > 0.0).then_some(())
    });
    driver.key("p");
    driver.window.wait("the snapshot", |line| {
        line["message"].as_str().filter(|text| text.contains("ring") && text.contains(".png")).map(|_| ())
    });
    driver.key("ctrl+z");
    driver.window.frame("gold", |f| (f["material"] == "gold").then_some(()));
    driver.key("ctrl+d");
    let more = |f: &serde_json::Value| number(&f["shapes"]) > chosen[1];
    driver.window.frame("two rings", |f| more(f).then_some(()));
    driver.key("Delete");
    driver.window.frame("one ring", |f| (!more(f)).then_some(()));
}

fn it_is_saved_and_closed(driver: &mut Driver) {
    let file = driver.folder.join("mine.xml");
    driver.key("ctrl+s");
    frames(driver);
    driver.key("ctrl+a");
    driver.display.hand(&format!("type {}", file.display()));
    driver.key("Return");
    driver.window.frame("it saved", |f| (f["edited"] == false).then_some(()));
    assert!(fs::read_to_string(&file).is_ok_and(|text| text.contains("ring")), "{}", file.display());
    driver.key("ctrl+q");
    assert!(driver.window.end().1, "all was well");
    let lines = driver.window.log.lines();
    let errors: Vec<_> = lines.iter().filter(|line| line["event"] == "error").collect();
    assert!(errors.is_empty(), "{errors:?}");
}
