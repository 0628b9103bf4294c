//! A real window on a display that nobody sees, hands for it, and its log to wait on. Never on time: machines are loaded.

#[cfg(unix)]
mod client;
mod log;

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use foton_film::{Image, read_png};
use serde_json::Value;

#[cfg(unix)]
pub use client::Client;
pub use log::Log;

/// What takes longer has hung.
pub const PATIENCE: Duration = Duration::from_secs(180);

/// Between polls of what cannot be waited for.
const LOOK_AGAIN: Duration = Duration::from_millis(10);

const NEEDED: &str = "a window's tests need Xvfb, xdotool and ImageMagick (cargo xtask test --install)";

/// A display in memory.
pub struct Display {
    server: Child,
    name: String,
}

impl Display {
    /// Starts one under a number that is free.
    ///
    /// # Panics
    /// Where the programs for it are not installed.
    #[must_use]
    pub fn start([width, height]: [u32; 2]) -> Self {
        let screen = format!("{width}x{height}x24");
        let server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &screen, "-nolisten", "tcp"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = server.expect(NEEDED);
        let mut number = String::new();
        let says = server.stdout.take().expect("piped");
        BufReader::new(says).read_line(&mut number).expect("it says its number");
        assert!(!number.trim().is_empty(), "Xvfb did not start");
        Self { server, name: format!(":{}", number.trim()) }
    }

    /// Moves the pointer, presses keys: the words of one call of xdotool.
    ///
    /// # Panics
    /// If that fails.
    pub fn hand(&self, words: &str) {
        let done = Command::new("xdotool").args(words.split_whitespace()).env("DISPLAY", &self.name).status();
        assert!(done.expect(NEEDED).success(), "xdotool {words}");
    }

    /// Another program on it.
    ///
    /// # Panics
    /// If it cannot connect.
    #[cfg(unix)]
    #[must_use]
    pub fn client(&self) -> Client {
        Client::new(&self.name)
    }

    /// All that is on the display; the file stays.
    ///
    /// # Panics
    /// If that fails.
    #[must_use]
    pub fn picture(&self, path: &Path) -> Image {
        let mut target = std::ffi::OsString::from("PNG24:");
        target.push(path);
        let mut import = Command::new("import");
        import.args(["-window", "root", "-depth", "8"]).arg(target).env("DISPLAY", &self.name);
        assert!(import.status().expect(NEEDED).success(), "import");
        read_png(path).unwrap_or_else(|e| panic!("{e}"))
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// How a window begins.
pub struct Opening<'a> {
    /// The program.
    pub foton: &'a Path,
    /// What to open; `None`: the scene that ships with it.
    pub scene: Option<&'a Path>,
    /// Where it runs, and where its settings, its log and snapshots go.
    pub folder: &'a Path,
    /// Width and height in points.
    pub size: [u32; 2],
    /// Dark or light colours.
    pub is_dark: bool,
    /// A fault that it is to have, as `FOTON_FAULT` says it.
    pub fault: Option<&'a str>,
}

/// The program with its window open.
pub struct Window {
    process: Child,
    /// What it says.
    pub log: Log,
    folder: PathBuf,
}

impl Window {
    /// Opens the window on a display, and waits for its first frame.
    ///
    /// # Panics
    /// If the program cannot be started, or shows nothing.
    #[must_use]
    pub fn open(display: &Display, opening: &Opening<'_>) -> Self {
        Self::open_scaled(display, opening, 1.0)
    }

    /// The same on a display with so many pixels a point along each side.
    ///
    /// # Panics
    /// If the program cannot be started, or shows nothing.
    #[must_use]
    pub fn open_scaled(display: &Display, opening: &Opening<'_>, scale: f64) -> Self {
        let folder = opening.folder;
        let settings = folder.join("config/foton");
        fs::create_dir_all(&settings).expect("a folder");
        let text = serde_json::json!({ "window": opening.size, "dark": opening.is_dark }).to_string();
        fs::write(settings.join("window.json"), text).expect("written");
        let log = folder.join("log.jsonl");
        let errors = fs::File::create(folder.join("stderr.txt")).expect("created");
        let mut command = Command::new(opening.foton);
        command.args(opening.scene).arg("--frame-log").arg(&log).current_dir(folder);
        command.env("DISPLAY", &display.name).env_remove("WAYLAND_DISPLAY");
        command.env("XDG_CONFIG_HOME", folder.join("config")).env("XDG_CACHE_HOME", folder.join("cache"));
        command.env("HOME", folder);
        command.env("WINIT_X11_SCALE_FACTOR", scale.to_string());
        command.envs(opening.fault.map(|fault| ("FOTON_FAULT", fault)));
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(errors);
        let process = command.spawn().unwrap_or_else(|e| panic!("{}: {e}", opening.foton.display()));
        let mut window = Self { process, log: Log::new(log), folder: folder.to_owned() };
        window.wait("a first frame", |line| (line["event"] == "drawn").then_some(()));
        // There is no window manager that would give it the keys.
        display.hand("search --sync --onlyvisible --name foton$ windowfocus --sync");
        window
    }

    /// Waits for a line of the log after the last one waited for, and says what was looked for in it.
    ///
    /// # Panics
    /// If it does not come.
    #[track_caller]
    pub fn wait<T>(&mut self, what: &str, mut is_it: impl FnMut(&Value) -> Option<T>) -> T {
        let begin = Instant::now();
        loop {
            if let Some(found) = self.log.find(&mut is_it) {
                return found;
            }
            let ended = self.process.try_wait().expect("a child");
            if ended.is_some() || begin.elapsed() > PATIENCE {
                let errors = fs::read_to_string(self.folder.join("stderr.txt")).unwrap_or_default();
                panic!("never saw {what}; ended: {ended:?}\n{}\n{errors}", self.log.tail());
            }
            std::thread::sleep(LOOK_AGAIN);
        }
    }

    /// Waits for a frame on the screen.
    ///
    /// # Panics
    /// If it does not come.
    #[track_caller]
    pub fn frame<T>(&mut self, what: &str, mut is_it: impl FnMut(&Value) -> Option<T>) -> T {
        self.wait(what, |line| line.get("frame").and_then(&mut is_it))
    }

    /// Where a control is: left, top, width and height.
    ///
    /// # Panics
    /// If the log does not say.
    #[track_caller]
    #[must_use]
    pub fn place(&mut self, name: &str) -> [f64; 4] {
        let place = self.log.place(name);
        place.unwrap_or_else(|| panic!("no place of {name}\n{}", self.log.tail()))
    }

    /// Where a share of the image, across and down, is on the canvas, in points, while the whole image is shown.
    ///
    /// # Panics
    /// If the log does not say.
    #[track_caller]
    #[must_use]
    pub fn on_film(&mut self, share: [f64; 2]) -> [f64; 2] {
        let size = self.frame("a size", |f| Some([f["size"][0].as_f64()?, f["size"][1].as_f64()?]));
        let [left, top, width, height] = self.place("canvas");
        let scale = (width / size[0]).min(height / size[1]);
        let along = |i: usize, from: f64, room: f64| from + 0.5 * room + (share[i] - 0.5) * size[i] * scale;
        [along(0, left, width), along(1, top, height)]
    }

    /// The memory that the process holds, in bytes, as the system counts it.
    #[must_use]
    pub fn memory(&self) -> Option<u64> {
        let text = fs::read_to_string(format!("/proc/{}/status", self.process.id())).ok()?;
        let line = text.lines().find(|line| line.starts_with("VmRSS:"))?;
        line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| kib * 1024)
    }

    /// Stretches of machine code that the process has made, as drivers in software do for every shader.
    ///
    /// # Panics
    /// If the system does not say.
    #[must_use]
    pub fn compiled(&self) -> usize {
        let maps =
            fs::read_to_string(format!("/proc/{}/maps", self.process.id())).expect("the process is there");
        let is_made = |line: &&str| {
            let words: Vec<&str> = line.split_whitespace().collect();
            words.len() == 5 && words[1].contains('x')
        };
        maps.lines().filter(is_made).count()
    }

    /// Processor time of the whole process and of the thread that has the window, in ticks of the system's clock.
    ///
    /// # Panics
    /// If the system does not say.
    #[must_use]
    pub fn cpu_ticks(&self) -> [u64; 2] {
        let id = self.process.id();
        [format!("/proc/{id}/stat"), format!("/proc/{id}/task/{id}/stat")].map(|path| {
            let text = fs::read_to_string(path).expect("the process is there");
            // After the name, which may hold anything.
            let rest = text.rsplit_once(')').expect("a name").1;
            let numbers = rest.split_whitespace().skip(11).take(2);
            numbers.map(|n| n.parse::<u64>().expect("a number")).sum()
        })
    }

    /// The number of its process.
    #[must_use]
    pub fn process(&self) -> u32 {
        self.process.id()
    }

    /// Whether the process is still there.
    ///
    /// # Panics
    /// If the system does not know.
    pub fn is_running(&mut self) -> bool {
        self.process.try_wait().expect("a child").is_none()
    }

    /// Waits for the end: how long after the log's last line, and whether all was well.
    ///
    /// # Panics
    /// If it does not end.
    #[track_caller]
    pub fn end(&mut self) -> (Duration, bool) {
        self.wait("it closing", |line| (line["event"] == "closing").then_some(()));
        let begin = Instant::now();
        while begin.elapsed() < PATIENCE {
            if let Some(status) = self.process.try_wait().expect("a child") {
                return (begin.elapsed(), status.success());
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        panic!("it does not end");
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
