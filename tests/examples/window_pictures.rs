//! Pictures of the window for the documents: `cargo xtask pictures` runs it.

use std::env;
use std::path::PathBuf;

use foton_tests::window::{Display, Opening, Window};

const WINDOW: [u32; 2] = [1280, 800];

/// Passes before a picture is taken.
const PASSES: f64 = 40.0;

fn main() {
    let arguments: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let [foton, target] = arguments.as_slice() else { panic!("usage: window_pictures FOTON FOLDER") };
    let folder = env::temp_dir().join(format!("foton-pictures-{}", std::process::id()));
    for (name, is_dark, click) in [("window", true, None), ("window-inspector", true, Some([0.8145, 0.843]))]
    {
        std::fs::create_dir_all(&folder).expect("a folder");
        let display = Display::start(WINDOW);
        let opening = Opening { foton, scene: None, folder: &folder, size: WINDOW, is_dark, fault: None };
        let mut window = Window::open(&display, &opening);
        // Out of the picture, where nothing is pointed at.
        display.hand("mousemove 1279 799");
        window.frame("passes", |f| {
            (f["pass"].as_f64()? >= PASSES && f["activity"] == "rendering").then_some(())
        });
        if let Some(at) = click {
            let [x, y] = window.on_film(at);
            display.hand(&format!("mousemove {x:.0} {y:.0} click 1"));
            window.frame("a choice", |f| f.get("chosen").map(|_| ()));
            display.hand("mousemove 1279 799");
            window.frame("a frame", |f| f.get("chosen").map(|_| ()));
            window.frame("another", |f| f.get("chosen").map(|_| ()));
        }
        let _ = display.picture(&target.join(name).with_extension("png"));
        drop(window);
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
