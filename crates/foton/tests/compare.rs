//! `foton compare` from outside: figures, warnings, pictures, exit codes. Beside it, `foton measure`.

#[path = "measure/sweeps.rs"]
mod sweeps;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use foton_film::{Image, Metadata, ToneMap, read_exr, read_png, write_exr, write_png};
use foton_math::Rgb;
use serde_json::Value;

/// An empty folder that goes away with the value.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("foton-compare-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn exr(&self, name: &str, image: &Image) {
        write_exr(&self.0.join(name), image, &[], &Metadata::default()).unwrap();
    }

    fn png(&self, name: &str, image: &Image) {
        write_png(&self.0.join(name), image, ToneMap::Linear, 0.0, &Metadata::default()).unwrap();
    }

    fn text(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// A command of `foton` in this folder.
    fn foton(&self, command: &str, args: &[&str]) -> Output {
        let program = Path::new(env!("CARGO_BIN_EXE_foton"));
        Command::new(program).arg(command).args(args).current_dir(&self.0).output().unwrap()
    }

    fn compare(&self, args: &[&str]) -> Output {
        self.foton("compare", args)
    }

    /// Its JSON lines.
    fn events(&self, args: &[&str]) -> Vec<Value> {
        let output = self.compare(&[args, &["--json"]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        out(&output).lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Half as bright as [`reference`] in one of its two pixels.
fn image() -> Image {
    Image { width: 2, height: 1, pixels: vec![Rgb::splat(0.5), Rgb::splat(0.25)] }
}

fn reference() -> Image {
    Image { width: 2, height: 1, pixels: vec![Rgb::splat(0.5); 2] }
}

fn pair(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.exr("a.exr", &image());
    folder.exr("b.exr", &reference());
    folder
}

#[test]
fn the_table_has_the_figures_and_nothing_is_written() {
    let folder = pair("table");
    let output = folder.compare(&["a.exr", "b.exr"]);
    assert_eq!((output.status.code(), err(&output).as_str()), (Some(0), ""));
    let text = out(&output);
    // RMSE √(0.0625/2); relMSE 0.0625/0.26/2.
    for (name, figure) in
        [("mean A", "0.37500"), ("A / B", "0.75000"), ("RMSE", "0.17678"), ("relMSE", "0.12019")]
    {
        let line =
            text.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("{name}: {text}"));
        assert_eq!(line.matches(figure).count(), 4, "{text}");
    }
    assert!(text.contains("2 × 1 pixels") && text.contains("\nFLIP "), "{text}");
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 2);
}

#[test]
fn json_is_one_object() {
    let folder = pair("json");
    let events = folder.events(&["a.exr", "b.exr"]);
    let [event] = events.as_slice() else { panic!("{events:?}") };
    assert_eq!(event["event"], "compare");
    assert_eq!((&event["a"], &event["b"]), (&"a.exr".into(), &"b.exr".into()));
    let close = |value: &Value, expected: f64| {
        let found = value.as_f64().unwrap_or(f64::NAN);
        assert!((found - expected).abs() < 1e-6, "{found}, expected {expected}");
    };
    close(&event["rmse"]["all"], 0.031_25f64.sqrt());
    close(&event["rel_mse"]["rgb"][1], 0.031_25 / 0.26);
    close(&event["ratio"]["rgb"][2], 0.75);
    close(&event["mean_b"]["all"], 0.5);
    assert!(event["flip"].as_f64().unwrap() > 0.0);
    assert_eq!((&event["non_finite"]["left_out"], &event["output"]), (&0.into(), &Value::Null));
}

#[test]
fn a_black_reference_has_no_ratio() {
    let folder = pair("black");
    folder.exr("black.exr", &Image::black(2, 1));
    assert_eq!(folder.events(&["a.exr", "black.exr"])[0]["ratio"]["all"], Value::Null);
    let text = out(&folder.compare(&["a.exr", "black.exr"]));
    assert!(text.lines().any(|line| line.starts_with("A / B") && line.ends_with(" –")), "{text}");
}

#[test]
fn pixels_that_are_not_finite_are_warned_of_and_left_out() {
    let folder = pair("nan");
    let mut broken = image();
    broken.pixels[1].g = f32::NAN;
    folder.exr("nan.exr", &broken);
    let output = folder.compare(&["nan.exr", "b.exr"]);
    let message = err(&output);
    assert!(
        message.starts_with("warning: 1 pixel is left out of every figure: not finite in A: 1, in B: 0"),
        "{message}"
    );
    let events = folder.events(&["nan.exr", "b.exr"]);
    assert_eq!((&events[0]["event"], &events[1]["event"]), (&"warning".into(), &"compare".into()));
    assert_eq!((&events[1]["rmse"]["all"], &events[1]["non_finite"]["left_out"]), (&0.0.into(), &1.into()));
}

#[test]
fn a_picture_against_radiance_is_compared_with_a_warning() {
    let folder = pair("png");
    folder.png("b.png", &reference());
    let output = folder.compare(&["b.png", "b.exr"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(err(&output).contains("one image is a PNG picture"), "{}", err(&output));
    // Half a step of 8 bits.
    assert!(folder.events(&["b.png", "b.exr"])[1]["rmse"]["all"].as_f64().unwrap() < 0.005);
    assert!(err(&folder.compare(&["b.png", "b.png"])).contains("these are PNG pictures"));
}

#[test]
fn the_difference_is_written_as_colours_or_as_numbers() {
    let folder = pair("difference");
    let text = out(&folder.compare(&["a.exr", "b.exr", "-o", "d.png"]));
    // The relative error of the second pixel is √(0.0625/0.26) = 0.49.
    assert!(text.contains("wrote d.png: relative error, dark blue 0 to yellow 0.5"), "{text}");
    let picture = read_png(&folder.0.join("d.png")).unwrap();
    let (same, differs) = (picture.pixels[0], picture.pixels[1]);
    assert!(same.b > same.r && same.b > same.g && differs.r > 0.8 && differs.b < 0.1, "{picture:?}");

    let events = folder.events(&["a.exr", "b.exr", "-o", "d.exr"]);
    assert_eq!((&events[0]["output"], events[0]["scale_top"].as_f64()), (&"d.exr".into(), Some(0.5)));
    let (numbers, _) = read_exr(&folder.0.join("d.exr")).unwrap();
    assert_eq!(numbers.pixels, [Rgb::BLACK, Rgb::splat(-0.25)]);
}

#[test]
fn what_cannot_be_compared_exits_with_1_and_bad_usage_with_2() {
    let folder = pair("failures");
    folder.exr("large.exr", &Image::black(3, 2));
    let output = folder.compare(&["a.exr", "large.exr"]);
    assert_eq!((output.status.code(), out(&output).as_str()), (Some(1), ""));
    let message = err(&output);
    let expected = "A is 2 × 1 pixels, B is 3 × 2";
    assert!(message.contains(expected) && message.contains("large.exr"), "{message}");

    let output = folder.compare(&["a.exr", "none.exr"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(err(&output).starts_with("error: cannot read none.exr"), "{}", err(&output));
    assert_eq!(folder.compare(&["a.exr", "b.exr", "-o", "no/d.png"]).status.code(), Some(1));

    for bad in [&["a.exr"][..], &["a.exr", "b.jpg"], &["a.exr", "b.exr", "-o", "d.txt"], &[]] {
        assert_eq!(folder.compare(bad).status.code(), Some(2), "{bad:?}");
    }
}
