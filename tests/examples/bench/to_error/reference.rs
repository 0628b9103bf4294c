//! What images are compared with: two long renders with other photons, or one by Mitsuba 3. Kept in the target folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use foton_film::{Image, Metadata, read_exr, write_exr};

use super::course::{course, text};
use super::curve::{MEASURES, errors};
use super::options::Options;
use super::scenes::SceneFile;
use crate::rig;

/// Seeds of photons that no render under test has.
const SEEDS: [u64; 2] = [1_000_001, 1_000_002];

/// The image that others are compared with.
pub(super) struct Reference {
    pub(super) image: Image,
    runs: Vec<Image>,
}

impl Reference {
    pub(super) fn load_or_render(scene: &SceneFile, options: &Options) -> Result<Self, String> {
        let runs = match &options.mitsuba {
            Some(python) => vec![by_mitsuba(python, scene, options)?],
            None => SEEDS.map(|seed| by_foton(scene, options, seed)).into_iter().collect::<Result<_, _>>()?,
        };
        let mut image = runs[0].clone();
        for run in &runs[1..] {
            image.pixels.iter_mut().zip(&run.pixels).for_each(|(sum, p)| *sum += *p);
        }
        image.pixels.iter_mut().for_each(|p| *p *= 1.0 / runs.len() as f32);
        Ok(Self { image, runs })
    }

    /// About the error of the mean that is noise, by how two runs differ; 0 where there is one.
    pub(super) fn noise(&self) -> [f64; MEASURES.len()] {
        // Each run is half of their difference from the mean, and the mean of two is as far from the truth.
        if self.runs.len() < 2 { [0.0; MEASURES.len()] } else { errors(&self.runs[0], &self.image) }
    }
}

fn by_foton(scene: &SceneFile, options: &Options, seed: u64) -> Result<Image, String> {
    let program = &options.reference;
    let seconds = options.reference_seconds / SEEDS.len() as f64;
    let words = program.options.join(" ");
    let key = [
        &fs::read(&scene.path).map_err(text)?[..],
        &fs::read(&program.path).map_err(text)?,
        format!("{words} {seconds} {}", program.has_photon_seed).as_bytes(),
    ]
    .concat();
    let path = place(scene, options, &format!("{seed}-{:016x}", rig::fnv(key)))?;
    if !path.exists() {
        eprintln!("{}: reference, {seconds} processor seconds", scene.name);
        let points = course(program, scene, options, seed, seconds)?;
        let (_, image) = points.last().expect("a course has an image");
        write_exr(&path, image, &[], &Metadata::default()).map_err(text)?;
    }
    Ok(read_exr(&path).map_err(text)?.0)
}

fn by_mitsuba(python: &Path, scene: &SceneFile, options: &Options) -> Result<Image, String> {
    let samples = options.mitsuba_samples.to_string();
    let key = rig::fnv(fs::read(&scene.path).map_err(text)?);
    let path = place(scene, options, &format!("mitsuba-{samples}-{key:016x}"))?;
    if !path.exists() {
        eprintln!("{}: reference by Mitsuba, {samples} samples a pixel", scene.name);
        let [width, height] = scene.size(options.width).map(|n| n.to_string());
        let script = rig::root().join("tests/versus/reference.py");
        let mut command = Command::new(python);
        command.arg(script).arg(&scene.path).args([width, height, samples]).arg(&path);
        if !command.status().map_err(text)?.success() {
            return Err(format!("Mitsuba has not rendered {}", scene.path.display()));
        }
    }
    Ok(read_exr(&path).map_err(text)?.0)
}

fn place(scene: &SceneFile, options: &Options, key: &str) -> Result<PathBuf, String> {
    let folder = rig::target().join("bench/references");
    fs::create_dir_all(&folder).map_err(text)?;
    let [width, height] = scene.size(options.width);
    Ok(folder.join(format!("{}-{width}x{height}-spp{}-{key}.exr", scene.name, options.samples)))
}
