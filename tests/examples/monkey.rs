//! `cargo xtask monkey`: random clicks, drags, wheels and keys in the real window for some minutes. Fails on an error in the
//! log, on an end that nobody asked for, and on memory that grows.
//!
//! Not touched are the controls that ask for more memory (photons/pass, samples/pixel), files and the end.
#![allow(clippy::print_stdout, reason = "it talks to the person who started it")]

use std::env;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use foton_math::{Purpose, Stream};
use foton_tests::window::{Display, Opening, Window};

const WINDOW: [u32; 2] = [1000, 640];

/// Spells of clicking. After each it rests: the same view of the same picture is rendered, and the memory is read there, since a
/// picture that has just begun holds less than half of what one under way does.
const SPELLS: usize = 6;

/// Passes of the picture that are waited for.
const PASSES: u64 = 3;

/// The mean of the later half of the spells may be so much more than that of the earlier: single ones scatter by a tenth, as the
/// allocator keeps more or less.
const GROWTH: f64 = 1.05;

const KEYS: [&str; 30] = [
    "space",
    "space",
    "period",
    "f",
    "h",
    "o",
    "k",
    "l",
    "c",
    "t",
    "b",
    "1",
    "2",
    "3",
    "4",
    "5",
    "1",
    "Left",
    "Right",
    "Up",
    "Down",
    "Prior",
    "Next",
    "Escape",
    "ctrl+z",
    "ctrl+shift+z",
    "ctrl+r",
    "question",
    "w",
    "e",
];

struct Monkey {
    display: Display,
    window: Window,
    stream: Stream,
    actions: u64,
}

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [foton, minutes] = arguments.as_slice() else { panic!("usage: monkey FOTON MINUTES") };
    let minutes: f64 = minutes.parse().expect("a number of minutes");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the repository");
    let folder = env::temp_dir().join(format!("foton-monkey-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let display = Display::start(WINDOW);
    let scene = root.join("assets/cornell-spheres/scene.xml");
    let opening = Opening {
        foton: &PathBuf::from(foton),
        scene: Some(&scene),
        folder: &folder,
        size: WINDOW,
        is_dark: true,
        fault: None,
    };
    let mut window = Window::open(&display, &opening);
    window.frame("a pass", |f| (f["activity"] == "rendering").then_some(()));
    let mut monkey = Monkey { display, window, stream: Stream::new(0, Purpose::Test, 0, 0), actions: 0 };
    let memory = monkey.play(Duration::from_secs_f64(60.0 * minutes));
    let passes = monkey.window.log.lines().iter().filter(|line| line["event"] == "drawn").count();
    println!("{} actions, {passes} frames drawn", monkey.actions);
    monkey.finish();
    judge(&memory);
    std::fs::remove_dir_all(&folder).expect("removed");
}

impl Monkey {
    /// Plays for a while; what memory the window held after each spell.
    fn play(&mut self, time: Duration) -> Vec<u64> {
        let spell = |_| {
            let begin = Instant::now();
            while begin.elapsed() < time / SPELLS as u32 {
                self.act();
                self.actions += 1;
                assert!(
                    self.window.is_running(),
                    "it ended after {} actions\n{}",
                    self.actions,
                    self.window.log.tail()
                );
            }
            self.rest();
            // Renders that undo brings back are kept as far as there is room: what they take is no leak.
            let held = self.window.memory().expect("the process is there");
            held.saturating_sub(self.kept())
        };
        (0..SPELLS).map(spell).collect()
    }

    /// Waits for some passes of the scene's own view, shown as light.
    fn rest(&mut self) {
        let canvas = self.within("canvas");
        self.display.hand(&format!("mousemove {canvas} key Escape key h key f key 1 key ctrl+r"));
        self.window.log.skip();
        let display = &self.display;
        self.window.frame("passes", |f| {
            if f["activity"] == "paused" {
                // One pass more.
                display.hand("key period");
            }
            (f["picture"] == f["size"] && f["pass"].as_u64() >= Some(PASSES)).then_some(())
        });
    }

    /// A whole number below `n`.
    fn below(&mut self, n: u32) -> u32 {
        ((self.stream.next_1d() * n as f32) as u32).min(n - 1)
    }

    /// A point of a control.
    fn within(&mut self, place: &str) -> String {
        let [x, y, width, height] = self.window.place(place);
        let (u, v) = (f64::from(self.stream.next_1d()), f64::from(self.stream.next_1d()));
        format!("{:.0} {:.0}", x + 1.0 + u * (width - 2.0), y + 1.0 + v * (height - 2.0))
    }

    fn act(&mut self) {
        let from = self.within("canvas");
        match self.below(10) {
            0 | 1 => self.display.hand(&format!("mousemove {from} click 1")),
            2..=4 => {
                let to = self.within("canvas");
                let button = [1, 1, 2, 3][self.below(4) as usize];
                self.display.hand(&format!("mousemove {from} mousedown {button}"));
                self.display.hand(&format!("mousemove {to}"));
                self.display.hand(&format!("mousemove {from} mousemove {to} mouseup {button}"));
            }
            5 => {
                let wheel = 4 + self.below(2);
                self.display.hand(&format!("mousemove {from} click {wheel} click {wheel}"));
            }
            6 => {
                let place = ["alpha", "pause", "photons"][self.below(3) as usize];
                let at = self.within(place);
                self.display.hand(&format!("mousemove {at} click 1"));
            }
            _ => {
                let key = KEYS[self.below(KEYS.len() as u32) as usize];
                self.display.hand(&format!("mousemove {from} key {key}"));
            }
        }
    }

    /// Bytes of renders from before edits, as the last frame says.
    fn kept(&mut self) -> u64 {
        let lines = self.window.log.lines();
        let last = lines.iter().rev().find_map(|line| line.get("frame")?["kept_bytes"].as_f64());
        last.unwrap_or_default() as u64
    }

    /// Asks the window to close until it does, and answers the question about unsaved edits if that is put: a list or a field that is open
    /// may take the first key, and a busy window shows the question late.
    fn close(&mut self) {
        let mut asked = None::<Instant>;
        while self.window.is_running() {
            let lines = self.window.log.lines();
            if lines.iter().any(|line| line["event"] == "closing") {
                return;
            }
            if asked.is_none_or(|asked| asked.elapsed() > Duration::from_secs(5)) {
                self.display.hand("key Escape");
                self.display.hand("key ctrl+q");
                asked = Some(Instant::now());
            }
            let places = lines.iter().rev().find_map(|line| line.get("places"));
            if places.is_some_and(|places| places.get("discard").is_some()) {
                let [x, y, width, height] = self.window.place("discard");
                let at = format!("mousemove {:.0} {:.0}", x + width / 2.0, y + height / 2.0);
                self.display.hand(&at);
                std::thread::sleep(Duration::from_millis(300));
                self.display.hand("click 1");
                std::thread::sleep(Duration::from_millis(700));
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Closes the window, and looks for errors.
    fn finish(&mut self) {
        self.close();
        let (took, is_well) = self.window.end();
        println!("the process ended {took:?} after it was asked to");
        assert!(is_well, "it ended badly");
        let errors: Vec<String> = self
            .window
            .log
            .lines()
            .iter()
            .filter(|l| l["event"] == "error")
            .map(ToString::to_string)
            .collect();
        assert!(errors.is_empty(), "{}", errors.join("\n"));
    }
}

/// Fails if memory has grown from the earlier half of the spells to the later.
fn judge(memory: &[u64]) {
    let mib: Vec<f64> = memory.iter().map(|&bytes| bytes as f64 / f64::from(1 << 20)).collect();
    println!("memory after each spell, MiB: {mib:.1?}");
    let [earlier, later] = [&mib[..SPELLS / 2], &mib[SPELLS / 2..]].map(|half| half.iter().sum::<f64>());
    assert!(later <= earlier * GROWTH, "memory has grown");
}
