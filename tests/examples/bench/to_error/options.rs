//! What is asked for on the command line.

use std::path::PathBuf;
use std::process::Command;

use crate::rig;

const USAGE: &str = "\
cargo xtask bench to-error --base FOTON [--new FOTON]
    --base-options WORDS, --new-options WORDS   for `foton render`, such as \"--guide off\"
    --scenes NAME,…            of assets and tests/scenes, or files
    --seconds N (10)           processor seconds of the base program, whose error then is the goal
    --seeds N (3)              seeds of photons
    --width N (160), --spp N (16)
    --reference FOTON [base], --reference-options WORDS, --reference-seconds N (20 times --seconds)
    --mitsuba PYTHON           reference by the path tracer of Mitsuba 3 in that Python, with --mitsuba-spp N (4096)
    --json FILE (target/bench/to-error.json)";

const SCENES: &str = "glass-and-ring,ring,pool,box-spheres,furnace,cornell-spheres,ring-glass,sun-on-small-ball,lamp-behind-gap,\
                      room-with-blinds,wide-ground";

/// A foton, and options of its own for `foton render`.
#[derive(Clone, Default)]
pub(super) struct Program {
    pub(super) path: PathBuf,
    pub(super) options: Vec<String>,
    /// Whether photons can have a seed of their own.
    pub(super) has_photon_seed: bool,
}

/// What is asked for.
pub(super) struct Options {
    pub(super) base: Program,
    pub(super) new: Program,
    pub(super) reference: Program,
    pub(super) scenes: Vec<String>,
    pub(super) seconds: f64,
    pub(super) reference_seconds: f64,
    pub(super) seeds: u64,
    pub(super) width: u32,
    pub(super) samples: u32,
    pub(super) mitsuba: Option<PathBuf>,
    pub(super) mitsuba_samples: u32,
    pub(super) json: PathBuf,
}

impl Options {
    pub(super) fn parse(arguments: &[String]) -> Result<Self, String> {
        let (mut base, mut new, mut reference) = (Program::default(), Program::default(), Program::default());
        let mut options = Self {
            base: Program::default(),
            new: Program::default(),
            reference: Program::default(),
            scenes: words(SCENES, ','),
            seconds: 10.0,
            reference_seconds: 0.0,
            seeds: 3,
            width: 160,
            samples: 16,
            mitsuba: None,
            mitsuba_samples: 4096,
            json: rig::target().join("bench/to-error.json"),
        };
        let mut arguments = arguments.iter();
        while let Some(name) = arguments.next() {
            let value = arguments.next().ok_or_else(|| format!("{name} without a value\n{USAGE}"))?;
            match name.as_str() {
                "--base" => base.path = value.into(),
                "--base-options" => base.options = words(value, ' '),
                "--new" => new.path = value.into(),
                "--new-options" => new.options = words(value, ' '),
                "--reference" => reference.path = value.into(),
                "--reference-options" => reference.options = words(value, ' '),
                "--scenes" => options.scenes = words(value, ','),
                "--seconds" => options.seconds = number(name, value)?,
                "--reference-seconds" => options.reference_seconds = number(name, value)?,
                "--seeds" => options.seeds = number(name, value)? as u64,
                "--width" => options.width = number(name, value)? as u32,
                "--spp" => options.samples = number(name, value)? as u32,
                "--mitsuba" => options.mitsuba = Some(value.into()),
                "--mitsuba-spp" => options.mitsuba_samples = number(name, value)? as u32,
                "--json" => options.json = value.into(),
                _ => return Err(format!("no option {name}\n{USAGE}")),
            }
        }
        if base.path.as_os_str().is_empty() {
            return Err(USAGE.to_owned());
        }
        if options.reference_seconds == 0.0 {
            options.reference_seconds = 20.0 * options.seconds;
        }
        [options.base, options.new, options.reference] =
            [&base, &new, &reference].map(|program| program.or(&base)).map(Program::looked_at);
        Ok(options)
    }

    /// Whether all errors are those of photons alone.
    pub(super) fn shares_eye_samples(&self) -> bool {
        let all = [&self.base, &self.new, &self.reference];
        all.iter().all(|program| program.has_photon_seed) && self.mitsuba.is_none()
    }
}

impl Program {
    /// Itself, at the place of another if it has none.
    fn or(&self, other: &Self) -> Self {
        let own = !self.path.as_os_str().is_empty();
        Self { path: if own { self.path.clone() } else { other.path.clone() }, ..self.clone() }
    }

    /// With what it says of itself.
    fn looked_at(self) -> Self {
        let help = Command::new(&self.path).args(["render", "--help"]).output();
        let has = help.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).contains("--photon-seed"));
        Self { has_photon_seed: has, ..self }
    }

    /// The options that give a seed to photons, and one to eye samples that all have in common where the program can do that.
    pub(super) fn seeds(&self, photons: u64) -> Vec<String> {
        let photons = photons.to_string();
        if self.has_photon_seed {
            return ["--seed", "1", "--photon-seed", &photons].map(str::to_owned).to_vec();
        }
        vec!["--seed".to_owned(), photons]
    }
}

fn words(text: &str, separator: char) -> Vec<String> {
    text.split(separator).map(str::trim).filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

fn number(name: &str, value: &str) -> Result<f64, String> {
    value.parse().ok().filter(|n| *n >= 1.0).ok_or_else(|| format!("{name} {value}: no number from 1 on"))
}
