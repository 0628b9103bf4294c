//! Options from their text.

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::{OsStringValueParser, TypedValueParser};
use foton_integrator::{Alpha, LayerKind, RadiusFloor, RadiusScale};
use foton_scene::description::Crop;
use foton_session::snapshot::Format;

use super::values::{ErrorWish, Radius};

/// Help that ends with a default.
pub(super) fn with_default(help: &str, default: impl std::fmt::Display) -> String {
    format!("{help}{default}]")
}

pub(super) fn alpha(s: &str) -> Result<Alpha, String> {
    s.parse().ok().and_then(Alpha::new).ok_or_else(|| "expected a number above 0 and up to 1".to_owned())
}

pub(super) fn radius_floor(s: &str) -> Result<RadiusFloor, String> {
    s.parse()
        .ok()
        .and_then(RadiusFloor::new)
        .ok_or_else(|| "expected a number of spacings, 0 or more".to_owned())
}

pub(super) fn radius(s: &str) -> Result<Radius, String> {
    let wish = match s.strip_prefix(['x', 'X', '×']) {
        Some(factor) => factor.parse().ok().and_then(RadiusScale::new).map(Radius::Footprint),
        None => s.parse().ok().filter(|r: &f64| *r > 0.0 && r.is_finite()).map(Radius::World),
    };
    wish.ok_or_else(|| "expected a length above 0 in world units, or a factor such as x0.5".to_owned())
}

/// Column, row, width and height.
pub(super) fn region(s: &str) -> Result<Crop, String> {
    let numbers: Option<Vec<u32>> = s.split(',').map(|n| n.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Crop { x, y, width, height }),
        _ => Err("expected X,Y,WIDTH,HEIGHT in pixels, such as 120,80,200,150".to_owned()),
    }
}

/// An exposure that leaves something to be seen.
pub(super) fn stops(s: &str) -> Result<f32, String> {
    let stops = s.parse().ok().filter(|stops: &f32| stops.abs() <= 60.0);
    stops.ok_or_else(|| "expected a number of stops from -60 to 60".to_owned())
}

/// A parser of file names, which need not be text.
pub(super) fn name<T: Clone + Send + Sync + 'static>(
    parse: impl Fn(PathBuf) -> Result<T, String> + Clone + Send + Sync + 'static,
) -> impl TypedValueParser<Value = T> {
    OsStringValueParser::new().try_map(move |name| parse(name.into()))
}

pub(super) fn exr(path: PathBuf) -> Result<PathBuf, String> {
    let fits = Format::of(&path) == Some(Format::Exr);
    fits.then_some(path)
        .ok_or_else(|| "expected a name that ends in .exr: only those hold radiance".to_owned())
}

pub(super) fn image(path: PathBuf) -> Result<(PathBuf, Format), String> {
    let format = Format::of(&path).ok_or_else(|| "expected a name that ends in .exr or .png".to_owned())?;
    Ok((path, format))
}

pub(super) fn xml(path: PathBuf) -> Result<PathBuf, String> {
    let fits = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("xml"));
    fits.then_some(path).ok_or_else(|| "expected a name that ends in .xml".to_owned())
}

pub(super) fn layer(s: &str) -> Result<LayerKind, String> {
    LayerKind::from_name(s).ok_or_else(|| {
        let names: Vec<_> = LayerKind::ALL.iter().map(|k| k.name()).collect();
        format!("expected any of {}", names.join(", "))
    })
}

pub(super) fn define(s: &str) -> Result<(String, String), String> {
    s.split_once('=')
        .filter(|(name, _)| !name.is_empty())
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .ok_or_else(|| "expected name=value".to_owned())
}

/// A number with one of the given units.
pub(super) fn with_unit(s: &str, units: &[(&str, f64)]) -> Option<f64> {
    let (unit, factor) = units.iter().find(|(unit, _)| s.ends_with(unit))?;
    let number: f64 = s.strip_suffix(unit)?.trim().parse().ok()?;
    (number > 0.0 && number.is_finite()).then_some(number * factor)
}

pub(super) fn error_wish(s: &str) -> Result<ErrorWish, String> {
    if s == "off" {
        return Ok(ErrorWish::Off);
    }
    with_unit(s, &[("%", 0.01), ("", 1.0)])
        .filter(|share| *share < 1.0)
        .map(ErrorWish::Below)
        .ok_or_else(|| "expected a share between 0 and 1, such as 2% or 0.02, or off".to_owned())
}

pub(super) fn duration(s: &str) -> Result<Duration, String> {
    with_unit(s, &[("ms", 1e-3), ("s", 1.0), ("m", 60.0), ("h", 3600.0), ("", 1.0)])
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "expected a time above 0, such as 90s, 10m or 1.5h".to_owned())
}

pub(super) fn bytes(s: &str) -> Result<u64, String> {
    let unit = |power: i32| 1024f64.powi(power);
    let units = [("K", unit(1)), ("M", unit(2)), ("G", unit(3)), ("T", unit(4)), ("", 1.0)];
    with_unit(s.trim_end_matches("iB"), &units)
        .map(|b| b as u64)
        .ok_or_else(|| "expected a size above 0, such as 800M or 8G (powers of 1024)".to_owned())
}
