//! What a comparison came to, as a table and as JSON.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::course::text;
use super::curve::{Curve, MEASURES, Reached};
use super::options::Options;
use super::outcome::Outcome;

/// One scene by one measure.
struct Row {
    /// Of the base program after the processor seconds asked for.
    goal: f64,
    /// Of the new one after as many.
    new_error: f64,
    reached: Reached,
    /// The least and the largest processor time over seeds.
    range: [f64; 2],
}

impl Row {
    fn new(outcome: &Outcome, measure: usize, seconds: f64) -> Self {
        let (base, new) = (Curve::of_all(&outcome.base), Curve::of_all(&outcome.new));
        let goal = base.at(seconds, measure);
        let of_seeds = outcome.new.iter().map(|curve| curve.reaches(goal, measure).seconds());
        let range = of_seeds.fold([f64::INFINITY, 0.0], |[a, b], t| [t.min(a), t.max(b)]);
        Self { goal, new_error: new.at(seconds, measure), reached: new.reaches(goal, measure), range }
    }
}

/// A table a measure.
pub(super) fn print(outcomes: &[Outcome], options: &Options) {
    let seconds = options.seconds;
    println!(
        "{} pixels wide, {} eye samples a pixel, {} seeds; errors over the reference's mean\n",
        options.width, options.samples, options.seeds
    );
    println!("base: {}\nnew: {}", called(options, true), called(options, false));
    for (i, measure) in MEASURES.into_iter().enumerate() {
        println!("\n{measure}\n");
        println!(
            "| scene | base after {seconds} CPU s | new | new has the base's error after | ratio | over seeds | noise of the reference |"
        );
        println!("|---|---|---|---|---|---|---|");
        for outcome in outcomes {
            let Row { goal, new_error, reached, range } = Row::new(outcome, i, seconds);
            let (sign, needed) = (reached.sign(), reached.seconds());
            let [least, most] = range.map(|t| t / seconds);
            println!(
                "| {} | {goal:.4} | {new_error:.4} | {sign}{needed:.2} s | {sign}{:.3} | {least:.3}–{most:.3} | {:.4} |",
                outcome.scene,
                needed / seconds,
                outcome.noise[i]
            );
        }
    }
}

fn called(options: &Options, is_base: bool) -> String {
    let program = if is_base { &options.base } else { &options.new };
    format!("{} {}", program.path.display(), program.options.join(" "))
}

/// Figures and curves.
pub(super) fn write_json(path: &Path, outcomes: &[Outcome], options: &Options) -> Result<(), String> {
    let curves = |curves: &[Curve]| -> Value { curves.iter().map(|curve| json!(curve.0)).collect() };
    let measures = |outcome: &Outcome| -> Value {
        let of = |(i, name): (usize, &str)| {
            let row = Row::new(outcome, i, options.seconds);
            let figures = json!({
                "base_error": row.goal, "new_error": row.new_error, "new_seconds": row.reached.seconds(),
                "bound": row.reached.sign().trim(), "ratio": row.reached.seconds() / options.seconds,
                "seconds_over_seeds": row.range, "noise_of_reference": outcome.noise[i],
            });
            (name.to_owned(), figures)
        };
        Value::Object(MEASURES.into_iter().enumerate().map(of).collect())
    };
    let scenes: Value = outcomes
        .iter()
        .map(|o| json!({ "scene": o.scene, "measures": measures(o), "base": curves(&o.base), "new": curves(&o.new) }))
        .collect();
    let all = json!({
        "seconds": options.seconds, "width": options.width, "spp": options.samples, "seeds": options.seeds,
        "base": called(options, true), "new": called(options, false), "measures": MEASURES, "scenes": scenes,
    });
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.map_or(Ok(()), fs::create_dir_all).map_err(text)?;
    fs::write(path, format!("{all:#}\n")).map_err(text)
}
