//! The processor time that one foton needs to the error of another: `cargo xtask bench to-error --base PATH --new PATH`.
//!
//! Both programs render each scene with the same eye samples and several seeds of photons, in turns. Times are processor seconds of the
//! whole process, read from outside, so that other programs change little; needs Linux.

mod course;
mod curve;
mod options;
mod outcome;
mod reference;
mod scenes;
mod table;

use std::path::Path;

use course::course;
use curve::Curve;
use options::Options;
use outcome::Outcome;
use reference::Reference;
use scenes::SceneFile;

/// Renders and prints the table; `arguments` follow the word `to-error`.
pub(crate) fn print(arguments: &[String]) {
    if let Err(why) = run(arguments) {
        eprintln!("{why}");
        std::process::exit(2);
    }
}

fn run(arguments: &[String]) -> Result<(), String> {
    let options = Options::parse(arguments)?;
    if !options.shares_eye_samples() {
        println!(
            "One of the programs has no --photon-seed, or the reference is another program's: eye samples differ from the \
             reference's, and their noise is in all errors.\n"
        );
    }
    let mut outcomes = Vec::new();
    for name in &options.scenes {
        let Some(scene) = SceneFile::find(name)? else {
            println!("{name}: no such scene here");
            continue;
        };
        outcomes.push(measure(&scene, &options)?);
        // A scene takes minutes: what is there already is kept.
        table::write_json(&options.json, &outcomes, &options)?;
    }
    table::print(&outcomes, &options);
    println!("\ncurves: {}", options.json.display());
    Ok(())
}

fn measure(scene: &SceneFile, options: &Options) -> Result<Outcome, String> {
    let reference = Reference::load_or_render(scene, options)?;
    let mut outcome =
        Outcome { scene: scene.name.clone(), base: Vec::new(), new: Vec::new(), noise: reference.noise() };
    for seed in 1..=options.seeds {
        let turns = [(true, &options.base, &mut outcome.base), (false, &options.new, &mut outcome.new)];
        for (is_base, program, curves) in turns {
            // A new program that is slower also gets to the goal.
            let seconds = if is_base { 1.0 } else { 1.25 } * options.seconds;
            let points = course(program, scene, options, seed, seconds)?;
            let errors = |(seconds, image)| (seconds, curve::errors(&image, &reference.image));
            let curve = Curve(points.into_iter().map(errors).collect());
            eprintln!("{}, seed {seed}, {}: {curve}", scene.name, shown(&program.path));
            curves.push(curve);
        }
    }
    Ok(outcome)
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}
