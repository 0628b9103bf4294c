//! The total error of each method after the same processor time, antialiasing included: `cargo xtask bench methods --foton PATH`.
//!
//! Whatever a method's passes renew, its seeds renew all of it: eye samples, gloss and photons. References are long renders that follow new
//! eye samples in each pass, so that theirs hardly count.

use std::path::PathBuf;

use foton_film::Image;
use foton_measure::{Pair, without_bright_emitters};

use super::course::course;
use super::curve::{Curve, MEASURES};
use super::options::{Options, Program};
use super::reference::Reference;
use super::scenes::SceneFile;

const USAGE: &str = "\
cargo xtask bench methods --foton FOTON
    --methods NAME,…           with options for `foton render` behind a colon, such as \"ppm:--spp 16\"
    --scenes NAME,…            of assets and tests/scenes, or files
    --seconds N,… (10,60)      processor seconds after which errors are told
    --seeds N (3), --width N (160)
    --reference WORDS (--integrator sppm), --reference-seconds N (600)";

/// Renders and prints the table; `arguments` follow the word `methods`.
pub(crate) fn print(arguments: &[String]) {
    if let Err(why) = run(arguments) {
        eprintln!("{why}");
        std::process::exit(2);
    }
}

struct Wishes {
    foton: PathBuf,
    methods: Vec<(String, Vec<String>)>,
    scenes: Vec<String>,
    seconds: Vec<f64>,
    seeds: u64,
    width: u32,
    reference: Vec<String>,
    reference_seconds: f64,
}

fn run(arguments: &[String]) -> Result<(), String> {
    let wishes = parse(arguments)?;
    println!(
        "{} pixels wide, {} seeds; root mean square of luminance over the mean, without bright emitters and the brightest 0.5 % of the rest\n",
        wishes.width, wishes.seeds
    );
    let names: Vec<String> = wishes
        .methods
        .iter()
        .flat_map(|(name, _)| wishes.seconds.iter().map(move |s| format!("{name}, {s} s")))
        .collect();
    println!("| scene | {} | noise of the reference |", names.join(" | "));
    println!("|---|{}---|", "---|".repeat(names.len()));
    for name in &wishes.scenes {
        let Some(scene) = SceneFile::find(name)? else {
            println!("{name}: no such scene here");
            continue;
        };
        let reference =
            Reference::load_or_render(&scene, &wishes.options(&wishes.reference, wishes.reference_seconds))?;
        let counts = without_bright_emitters(&emitters(&wishes, &scene)?, &reference.image);
        let mut cells = Vec::new();
        for (method, words) in &wishes.methods {
            let curve = curve(&wishes, &scene, (&reference.image, &counts), method, words)?;
            cells.extend(wishes.seconds.iter().map(|s| format!("{:.4}", curve.at(*s, 0))));
        }
        let noise = reference.noise_where(|run, image| error(run, image, &counts));
        println!("| {} | {} | {noise:.4} |", scene.name, cells.join(" | "));
    }
    Ok(())
}

/// The errors of a method over processor seconds, root mean squares over seeds.
fn curve(
    wishes: &Wishes,
    scene: &SceneFile,
    (reference, counts): (&Image, &[bool]),
    method: &str,
    words: &[String],
) -> Result<Curve, String> {
    let longest = wishes.seconds.iter().copied().fold(0.0, f64::max);
    let options = wishes.options(words, longest);
    let mut curves = Vec::new();
    for seed in 1..=wishes.seeds {
        let points = course(&options.base, scene, &options, seed, 1.05 * longest)?;
        let errors =
            |(seconds, image): (f64, Image)| (seconds, [error(&image, reference, counts); MEASURES.len()]);
        curves.push(Curve(points.into_iter().map(errors).collect()));
        eprintln!("{}, {method}, seed {seed}: {}", scene.name, curves[curves.len() - 1]);
    }
    Ok(Curve::of_all(&curves))
}

fn error(image: &Image, reference: &Image, counts: &[bool]) -> f64 {
    Pair::new(image, reference).map_or(f64::NAN, |pair| pair.trimmed_rmse(|pixel| counts[pixel]))
}

/// What is seen of emitters, directly.
fn emitters(wishes: &Wishes, scene: &SceneFile) -> Result<Image, String> {
    let words = ["--integrator", "path", "--max-depth", "1"].map(str::to_owned);
    let options = wishes.options(&words, 1.0);
    let points = course(&options.base, scene, &options, 1, 1.0)?;
    points.into_iter().last().map(|(_, image)| image).ok_or_else(|| "no image".to_owned())
}

impl Wishes {
    /// Those of a course of one program for so long.
    fn options(&self, words: &[String], seconds: f64) -> Options {
        let program = Program { path: self.foton.clone(), options: words.to_vec(), has_photon_seed: false };
        Options {
            base: program.clone(),
            new: program.clone(),
            reference: program,
            scenes: Vec::new(),
            seconds,
            reference_seconds: seconds,
            seeds: self.seeds,
            width: self.width,
            samples: None,
            mitsuba: None,
            mitsuba_samples: 0,
            json: PathBuf::new(),
        }
    }
}

fn parse(arguments: &[String]) -> Result<Wishes, String> {
    let words = |text: &str, separator| -> Vec<String> {
        text.split(separator).map(str::trim).filter(|w| !w.is_empty()).map(str::to_owned).collect()
    };
    let method = |text: String| {
        let (name, options) = text.split_once(':').unwrap_or((&text, ""));
        let options = format!("--integrator {name} {options}");
        (text.clone(), words(&options, ' '))
    };
    let methods = |text: &str| words(text, ',').into_iter().map(method).collect::<Vec<_>>();
    let mut wishes = Wishes {
        foton: PathBuf::new(),
        methods: methods("ppm,sppm,path,photon-map"),
        scenes: words("box-spheres,cornell-diffuse,cornell-spheres,furnace,glass-and-ring,pool,ring", ','),
        seconds: vec![10.0, 60.0],
        seeds: 3,
        width: 160,
        reference: words("--integrator sppm", ' '),
        reference_seconds: 600.0,
    };
    let number = |text: &str| text.parse::<f64>().map_err(|_| format!("{text}: no number\n{USAGE}"));
    let mut arguments = arguments.iter();
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("{name} without a value\n{USAGE}"))?;
        match name.as_str() {
            "--foton" => wishes.foton = value.into(),
            "--methods" => wishes.methods = methods(value),
            "--scenes" => wishes.scenes = words(value, ','),
            "--seconds" => {
                wishes.seconds = words(value, ',').iter().map(|s| number(s)).collect::<Result<_, _>>()?;
            }
            "--seeds" => wishes.seeds = number(value)? as u64,
            "--width" => wishes.width = number(value)? as u32,
            "--reference" => wishes.reference = words(value, ' '),
            "--reference-seconds" => wishes.reference_seconds = number(value)?,
            _ => return Err(format!("no option {name}\n{USAGE}")),
        }
    }
    if wishes.foton.as_os_str().is_empty() { Err(USAGE.to_owned()) } else { Ok(wishes) }
}
