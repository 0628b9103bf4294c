//! `foton compare`: how far an image is from its reference, as a table or JSON, and a picture of where.

use std::path::{Path, PathBuf};

use foton_film::{
    Image, Layer, LayerData, Metadata, ReadError, ToneMap, WriteError, check_writable, read_exr_within,
    read_png_within, write_exr, write_png,
};
use foton_measure::{Channels, Flip, Pair, heat, scale_top};
use foton_session::snapshot::Format;
use serde_json::{Value, json};

use crate::args::Compare;
use crate::console::{Console, Failure};
use crate::memory;

/// Of the memory that may be used, what reading one of the images may take: comparing them takes more.
const SHARE: f64 = 0.25;

/// Runs `foton compare`.
pub(crate) fn run(args: &Compare, console: &Console) -> Result<(), Failure> {
    args.output.as_ref().map_or(Ok(()), |(path, _)| check_writable(path))?;
    let (a, b) = (read(&args.a)?, read(&args.b)?);
    let pair = Pair::new(&a, &b).map_err(|cause| Failure::Compare {
        a: args.a.0.display().to_string(),
        b: args.b.0.display().to_string(),
        cause,
    })?;
    for message in cautions(args.a.1, args.b.1, &pair) {
        console.warning(&message);
    }
    let figures = Figures::of(&pair);
    let top = scale_top(&pair.relative_error());
    // What was found is said, whatever becomes of the picture.
    let written = args.output.as_ref().map(|(path, format)| write(path, *format, &pair, &figures.flip, top));
    let written = written.transpose();
    let output = args.output.as_ref().filter(|_| written.is_ok());
    if args.json {
        console.event(&as_json(args, output, &a, &pair, &figures, top));
    } else {
        for line in as_text(args, output, &a, &figures, top) {
            console.out(&line);
        }
    }
    Ok(written.map(drop)?)
}

/// The picture that was written, and how.
type Output<'a> = Option<&'a (PathBuf, Format)>;

fn read((path, format): &(PathBuf, Format)) -> Result<Image, ReadError> {
    let memory = memory::limit(None).map(|bytes| (bytes * SHARE) as u64);
    match format {
        Format::Exr => read_exr_within(path, memory).map(|(image, _)| image),
        Format::Png => read_png_within(path, memory),
    }
}

/// What makes the figures say less than they seem to.
fn cautions(a: Format, b: Format, pair: &Pair<'_>) -> Vec<String> {
    let mut found = Vec::new();
    match (a, b) {
        (Format::Exr, Format::Exr) => {}
        (Format::Png, Format::Png) => found.push(
            "these are PNG pictures, 8-bit, clipped and often tone-mapped: the figures are of what they show, not of \
             radiance"
                .to_owned(),
        ),
        _ => found.push(
            "one image is a PNG picture, 8-bit, clipped and often tone-mapped, the other is radiance: part of the \
             difference is only that"
                .to_owned(),
        ),
    }
    let n = pair.non_finite();
    if n.either > 0 {
        let verb = if n.either == 1 { "pixel is" } else { "pixels are" };
        found.push(format!(
            "{} {verb} left out of every figure: not finite in A: {}, in B: {}",
            n.either, n.a, n.b
        ));
    }
    found
}

/// All that is said of a pair.
struct Figures {
    mean_a: Channels,
    mean_b: Channels,
    ratio: Channels,
    rmse: Channels,
    rel_mse: Channels,
    flip: Flip,
}

impl Figures {
    fn of(pair: &Pair<'_>) -> Self {
        Self {
            mean_a: pair.mean_a(),
            mean_b: pair.mean_b(),
            ratio: pair.ratio(),
            rmse: pair.rmse(),
            rel_mse: pair.rel_mse(),
            flip: pair.flip(),
        }
    }
}

fn as_text(args: &Compare, output: Output<'_>, a: &Image, figures: &Figures, top: f32) -> Vec<String> {
    let row = |name: &str, c: &Channels| {
        let cells = c.rgb.iter().chain([&c.all]).map(|&v| cell(v));
        format!("{name:<8}{}", cells.collect::<String>())
    };
    let mut lines = vec![
        format!("A       {}", args.a.0.display()),
        format!("B       {} (the reference)", args.b.0.display()),
        format!("size    {} × {} pixels", a.width, a.height),
        String::new(),
        format!("{:<8}{:>12}{:>12}{:>12}{:>12}", "", "red", "green", "blue", "all"),
        row("mean A", &figures.mean_a),
        row("mean B", &figures.mean_b),
        row("A / B", &figures.ratio),
        row("RMSE", &figures.rmse),
        row("relMSE", &figures.rel_mse),
        format!("{:<44}{}", "FLIP", cell(figures.flip.mean)),
    ];
    if let Some((path, format)) = output {
        lines.push(String::new());
        lines.push(match format {
            Format::Png => format!(
                "wrote {}: relative error, dark blue 0 to yellow {top}; magenta is left out",
                path.display()
            ),
            Format::Exr => {
                format!("wrote {}: A − B, with the layers relative_error and flip", path.display())
            }
        });
    }
    lines
}

/// A figure in twelve columns; a dash where it is not finite.
fn cell(v: f64) -> String {
    if !v.is_finite() {
        format!("{:>12}", "–")
    } else if v == 0.0 || (1e-3..1e5).contains(&v.abs()) {
        format!("{v:>12.5}")
    } else {
        format!("{v:>12.3e}")
    }
}

fn as_json(
    args: &Compare,
    output: Output<'_>,
    a: &Image,
    pair: &Pair<'_>,
    figures: &Figures,
    top: f32,
) -> Value {
    let channels = |c: &Channels| json!({ "rgb": c.rgb, "all": c.all });
    let n = pair.non_finite();
    json!({
        "event": "compare",
        "a": args.a.0.display().to_string(),
        "b": args.b.0.display().to_string(),
        "width": a.width,
        "height": a.height,
        "non_finite": { "a": n.a, "b": n.b, "left_out": n.either },
        "mean_a": channels(&figures.mean_a),
        "mean_b": channels(&figures.mean_b),
        "ratio": channels(&figures.ratio),
        "rmse": channels(&figures.rmse),
        "rel_mse": channels(&figures.rel_mse),
        "flip": figures.flip.mean,
        "output": output.map(|(path, _)| path.display().to_string()),
        "scale_top": output.map(|_| top),
    })
}

/// Writes where the images differ: as colours, or as the numbers themselves.
fn write(path: &Path, format: Format, pair: &Pair<'_>, flip: &Flip, top: f32) -> Result<(), WriteError> {
    let error = pair.relative_error();
    match format {
        Format::Png => {
            let mut metadata = Metadata::default();
            metadata
                .set("foton:difference", "relative error sqrt(mean((A-B)^2/(B^2+0.01))), colours: viridis");
            metadata.set("foton:scale-top", top);
            write_png(path, &heat(&error, top), ToneMap::Linear, 0.0, &metadata)
        }
        Format::Exr => {
            let mut metadata = Metadata::default();
            metadata.set("foton:difference", "A - B");
            let layers = [("relative_error", error), ("flip", flip.map.clone())]
                .map(|(name, plane)| Layer { name: name.into(), channels: LayerData::F32(plane) });
            write_exr(path, &pair.difference(), &layers, &metadata)
        }
    }
}
