//! `cargo xtask screenshots`: a picture of each state of the panels, in both themes and several sizes, to be looked at.

use std::env;
use std::path::{Path, PathBuf};
use std::time::Duration;

use foton_tests::window::{Display, Opening, Window};

/// Width and height of the window in points, and pixels a point.
const SIZES: [([u32; 2], f64); 3] = [([900, 600], 1.0), ([1280, 800], 1.0), ([720, 450], 2.0)];

/// Passes before the first picture.
const PASSES: f64 = 12.0;

/// What is done before a picture, in words of [`Shots::act`], and the picture's name.
const STATES: [(&str, &[&str]); 19] = [
    ("01-start", &[]),
    ("02-selection", &["choose"]),
    ("03-photons-as-dots", &["key Escape", "key o"]),
    ("04-unlit", &["key o", "key 5"]),
    ("05-radius", &["key 3"]),
    ("06-paused-pinned", &["key 1", "key space", "key k"]),
    ("07-draft", &["key k", "key space", "down left", "click seed", "key 7", "key Return", "down left"]),
    ("08-wrong-number", &["up left", "click alpha field", "type 7x", "key Return"]),
    ("09-menu", &["click file menu"]),
    ("10-view-list", &["key Escape", "click view list"]),
    ("11-diagnostics", &["key Escape", "down right", "click diagnostics", "down right"]),
    ("12-keys", &["canvas", "key question"]),
    ("13-open", &["key Escape", "key ctrl+o"]),
    ("14-panels-hidden", &["key Escape", "canvas", "key Tab"]),
    ("15-histogram", &["key Tab", "key l", "key c"]),
    ("16-photon-paths", &["key l", "key c", "hover", "key v", "wait"]),
    ("17-history", &["key v", "key t", "key b", "wait", "key b", "wait"]),
    ("18-region-drag", &["key t", "click view menu", "click region entry", "drag"]),
    ("19-region", &["mouseup 1"]),
];

struct Shots {
    display: Display,
    window: Window,
    scale: f64,
}

fn main() {
    let arguments: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let [foton, target, only @ ..] = arguments.as_slice() else {
        panic!("usage: screenshots FOTON FOLDER [SIZE]")
    };
    std::fs::create_dir_all(target).expect("a folder");
    for (size, scale) in SIZES {
        let pixels = size.map(|v| (f64::from(v) * scale) as u32);
        let name = format!("{}x{}", pixels[0], pixels[1]);
        if only.first().is_some_and(|only| only.as_path() != Path::new(&name)) {
            continue;
        }
        for is_dark in [true, false] {
            shoot(foton, target, size, scale, is_dark);
        }
    }
}

fn shoot(foton: &Path, target: &Path, size: [u32; 2], scale: f64, is_dark: bool) {
    let folder = env::temp_dir().join(format!("foton-screenshots-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let pixels = size.map(|v| (f64::from(v) * scale) as u32);
    let display = Display::start(pixels);
    let opening = Opening { foton, scene: None, folder: &folder, size, is_dark, fault: None };
    let window = Window::open_scaled(&display, &opening, scale);
    let mut shots = Shots { display, window, scale };
    shots
        .window
        .frame("passes", |f| (f["pass"].as_f64()? >= PASSES && f["activity"] == "rendering").then_some(()));
    let theme = if is_dark { "dark" } else { "light" };
    for (name, acts) in STATES {
        acts.iter().for_each(|act| shots.act(act));
        shots.settle();
        let _ =
            shots.display.picture(&target.join(format!("{}x{}-{theme}-{name}.png", pixels[0], pixels[1])));
    }
    drop(shots);
    std::fs::remove_dir_all(&folder).expect("removed");
}

impl Shots {
    fn act(&mut self, act: &str) {
        match act.split_once(' ').unwrap_or((act, "")) {
            ("click", place) => {
                let at = self.share_of(place, [0.5, 0.5]);
                self.display.hand(&format!("mousemove {at} click 1"));
            }
            // The ring of the scene that ships with the program.
            ("choose", _) => {
                let [x, y] = self.window.on_film([0.8145, 0.843]).map(|v| v * self.scale);
                self.display.hand(&format!("mousemove {x:.0} {y:.0} click 1"));
                self.window.frame("a choice", |f| f.get("chosen").map(|_| ()));
            }
            // A pixel of the paper, beside the ring.
            ("hover", _) => {
                let [x, y] = self.window.on_film([0.66, 0.8]).map(|v| v * self.scale);
                self.display.hand(&format!("mousemove {x:.0} {y:.0}"));
            }
            // Across a part of the picture, and not let go.
            ("drag", _) => {
                let [from, to] = [[0.55, 0.5], [0.95, 0.95]]
                    .map(|share| self.window.on_film(share).map(|v| v * self.scale));
                self.display.hand(&format!("mousemove {:.0} {:.0} mousedown 1", from[0], from[1]));
                self.settle();
                self.display.hand(&format!("mousemove {:.0} {:.0}", to[0], to[1]));
            }
            // To the end of a panel.
            (way @ ("down" | "up"), side) => {
                let canvas = self.window.place("canvas").map(|v| v * self.scale);
                let x = if side == "left" { canvas[0] - 60.0 } else { canvas[0] + canvas[2] + 60.0 };
                let y = canvas[1] + 0.8 * canvas[3];
                let button = if way == "down" { 5 } else { 4 };
                self.display.hand(&format!("mousemove {x:.0} {y:.0} click --repeat 30 --delay 10 {button}"));
            }
            // What is traced or written for it takes a moment.
            ("wait", _) => std::thread::sleep(Duration::from_secs(6)),
            ("canvas", _) => {
                let at = self.share_of("canvas", [0.02, 0.02]);
                self.display.hand(&format!("mousemove {at}"));
            }
            _ => self.display.hand(act),
        }
        self.settle();
    }

    /// A while and some frames, so that what was asked for is on the screen.
    fn settle(&mut self) {
        std::thread::sleep(Duration::from_millis(500));
        self.window.log.skip();
        for _ in 0..3 {
            // What stands still is drawn when the pointer moves.
            self.display.hand("mousemove_relative -- 1 0 mousemove_relative -- -1 0");
            self.window.wait("a frame", |line| (line["event"] == "drawn").then_some(()));
        }
    }

    /// A position within a control, in pixels.
    fn share_of(&mut self, place: &str, share: [f64; 2]) -> String {
        let [left, top, width, height] = self.window.place(place).map(|v| v * self.scale);
        format!("{:.0} {:.0}", left + share[0] * width, top + share[1] * height)
    }
}
