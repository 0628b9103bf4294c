//! The folder of a sweep: the reference, a part for each finished job, pictures, tables and page. Files appear whole.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use foton_film::{
    Image, Metadata, ToneMap, WriteError, atomic_write, check_writable, read_exr, write_exr, write_png,
    write_spare,
};
use foton_input::{Limit, Named, read_file};
use foton_integrator::Render;
use foton_math::Rgb;

use super::error::{SweepError, io_error};
use super::plan::Job;
use super::reference::{Known, Reference};
use super::run::Picture;
use super::table::{self, Point};
use crate::plot::short;
use crate::{Pair, heat, scale_top};

/// What the reference is, in its file's metadata.
const ORIGIN: &str = "foton:origin";

/// Files that are in a folder and that a sweep there would write anew; `given`: with a reference from elsewhere.
#[must_use]
pub fn files_in(folder: &Path, given: bool) -> Vec<PathBuf> {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let is_ours = |inside: &str, name: &str| match inside {
        "parts" => {
            let stem = name.strip_suffix("-runs.csv").or_else(|| name.strip_suffix("-summary.csv"));
            stem.is_some_and(is_number)
        }
        "images" => {
            let stem = name.strip_suffix("-error.png").or_else(|| name.strip_suffix(".png"));
            ["list.txt", "reference.png"].contains(&name) || stem.is_some_and(is_number)
        }
        _ => TABLES.contains(&name) || (!given && REFERENCES.contains(&name)),
    };
    let mut found = Vec::new();
    for inside in ["", "parts", "images"] {
        let entries = fs::read_dir(folder.join(inside)).into_iter().flatten().flatten();
        let ours =
            entries.filter(|entry| entry.file_name().to_str().is_some_and(|name| is_ours(inside, name)));
        found.extend(ours.map(|entry| entry.path()));
    }
    found
}

/// What is written into the folder itself.
const TABLES: [&str; 4] = ["sweep.txt", "summary.csv", "runs.csv", "index.html"];
const REFERENCES: [&str; 3] = ["reference.exr", "reference-classes.exr", "reference-variance.exr"];

/// A folder that holds one sweep.
pub(crate) struct Store {
    folder: PathBuf,
}

/// A picture as the page shows it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shown {
    pub(crate) title: String,
    pub(crate) detail: String,
    /// PNG files.
    pub(crate) image: Vec<u8>,
    pub(crate) error: Option<Vec<u8>>,
}

impl Store {
    /// Makes the folder, or refuses one of another sweep.
    pub(crate) fn open(folder: &Path, identity: &str) -> Result<Self, SweepError> {
        for folder in [folder, &folder.join("parts"), &folder.join("images")] {
            if folder.exists() && !folder.is_dir() {
                return Err(io_error(folder)(ErrorKind::NotADirectory.into()));
            }
            fs::create_dir_all(folder).map_err(io_error(folder))?;
        }
        let store = Self { folder: folder.to_owned() };
        let path = store.path("sweep.txt");
        match read(&path)? {
            Some(there) if there.trim_end() == identity => {}
            Some(there) => {
                return Err(SweepError::OtherSweep {
                    folder: folder.to_owned(),
                    there: there.trim_end().to_owned(),
                    now: identity.to_owned(),
                });
            }
            None => write(&path, &format!("{identity}\n"))?,
        }
        // Before a minute is spent on what could not be written.
        for name in ["runs.csv", "summary.csv", "index.html", "parts/_", "images/_"] {
            check_writable(&store.path(name))?;
        }
        Ok(store)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn part(&self, job: &Job, table: &str) -> PathBuf {
        self.path(&format!("parts/{}-{table}.csv", job.name()))
    }

    /// What a job found, if it is finished.
    pub(crate) fn points(&self, job: &Job) -> Result<Option<Vec<Point>>, SweepError> {
        let path = self.part(job, "summary");
        let Some(text) = read(&path)? else { return Ok(None) };
        table::read_summary(&text).map(Some).ok_or(SweepError::Table { path })
    }

    /// Writes what a job found. The summary comes last: where it is, all is.
    pub(crate) fn finish(&self, job: &Job, runs: &str, points: &[Point]) -> Result<(), SweepError> {
        let runs = table::runs_heading() + runs;
        let summary = table::summary_heading() + &table::summary(points);
        let summary_path = self.part(job, "summary");
        if let Err(error) = write_or_rescue(&self.part(job, "runs"), |path| write_text(path, &runs)) {
            // Both are worth having, but not one of them in its place.
            write_spare(&summary_path, |path| write_text(path, &summary));
            return Err(error);
        }
        write_or_rescue(&summary_path, |path| write_text(path, &summary))
    }

    /// Joins the parts of all finished jobs; returns the tables.
    pub(crate) fn tables(&self, jobs: &[Job]) -> Result<Vec<PathBuf>, SweepError> {
        let mut sorted: Vec<&Job> = jobs.iter().collect();
        sorted.sort_by_key(|job| job.photons);
        let headings = [("summary", table::summary_heading()), ("runs", table::runs_heading())];
        let mut paths = Vec::new();
        for (name, heading) in headings {
            let mut text = heading.clone();
            for job in &sorted {
                if self.part(job, "summary").is_file() {
                    let part = read(&self.part(job, name))?.unwrap_or_default();
                    text += part.strip_prefix(&heading).unwrap_or_default();
                }
            }
            let path = self.path(&format!("{name}.csv"));
            write(&path, &text)?;
            paths.push(path);
        }
        Ok(paths)
    }

    /// Writes the page.
    pub(crate) fn page(&self, html: &str) -> Result<PathBuf, SweepError> {
        let path = self.path("index.html");
        write(&path, html)?;
        Ok(path)
    }

    /// Writes a reference of the sweep's own.
    pub(crate) fn write_reference(&self, reference: &Reference) -> Result<(), SweepError> {
        let mut metadata = Metadata::default();
        metadata.set(ORIGIN, &reference.origin);
        let path = self.path("reference.exr");
        // Last: where it is, all is.
        match self.write_moments(reference, &metadata) {
            Ok(()) => write_or_rescue(&path, |path| write_exr(path, &reference.image, &[], &metadata)),
            Err(cause) => Err(rescue(cause, &path, |path| write_exr(path, &reference.image, &[], &metadata))),
        }
    }

    /// What a reference has beside its image.
    fn write_moments(&self, reference: &Reference, metadata: &Metadata) -> Result<(), WriteError> {
        let (width, height) = (reference.image.width, reference.image.height);
        let of = |pixel: &dyn Fn(usize) -> [f64; 3]| Image {
            width,
            height,
            pixels: (0..reference.fine.variance.len())
                .map(|p| Rgb::from_array(pixel(p).map(|v| v as f32)))
                .collect(),
        };
        if let Some(classes) = &reference.classes {
            let image = of(&|p| [classes[0][p], classes[1][p], classes[2][p]]);
            write_exr(&self.path("reference-classes.exr"), &image, &[], metadata)?;
        }
        // Of the reference, of the one with twice its radius, and that one's luminance.
        let Known { luminance, variance } = reference.wide.as_ref().unwrap_or(&reference.fine);
        let image = of(&|p| [reference.fine.variance[p], variance[p], luminance[p]]);
        write_exr(&self.path("reference-variance.exr"), &image, &[], metadata)
    }

    /// The reference that an earlier run wrote, if any.
    pub(crate) fn reference(&self, eye: &Render) -> Result<Option<Reference>, SweepError> {
        if !self.path("reference.exr").is_file() {
            return Ok(None);
        }
        let (image, metadata) = read_exr(&self.path("reference.exr"))?;
        let (classes, _) = read_exr(&self.path("reference-classes.exr"))?;
        let (variance, _) = read_exr(&self.path("reference-variance.exr"))?;
        for other in [&classes, &variance, &eye.image()] {
            Pair::new(other, &image)?;
        }
        let channel =
            |image: &Image, of: fn(&Rgb) -> f32| image.pixels.iter().map(|p| f64::from(of(p))).collect();
        let classes = [channel(&classes, |p| p.r), channel(&classes, |p| p.g), channel(&classes, |p| p.b)];
        let wide = Known { luminance: channel(&variance, |p| p.b), variance: channel(&variance, |p| p.g) };
        let variance = channel(&variance, |p| p.r);
        let origin = metadata.get(ORIGIN).unwrap_or_default().to_owned();
        Ok(Reference::new(eye, image, Some(classes), (Some(variance), Some(wide)), origin))
    }

    /// Writes pictures at equal times and maps of their errors, all on one scale.
    pub(crate) fn pictures(&self, pictures: &[Picture], reference: &Image) -> Result<(), SweepError> {
        if pictures.is_empty() {
            return Ok(());
        }
        let plain = Metadata::default();
        let mut maps = Vec::new();
        for picture in pictures {
            maps.push(Pair::new(&picture.image, reference)?.relative_error());
        }
        let mut tops: Vec<f32> = maps.iter().map(scale_top).collect();
        tops.sort_unstable_by(f32::total_cmp);
        let top = tops[tops.len() / 2];
        write_png(&self.path("images/reference.png"), reference, ToneMap::default(), 0.0, &plain)?;
        let mut list = format!(
            "reference\tReference\terror maps: 0 to {} of the pixel's own light\n",
            short(top.into())
        );
        for (i, (picture, map)) in pictures.iter().zip(&maps).enumerate() {
            let name = format!("{i:02}");
            let image = self.path(&format!("images/{name}.png"));
            write_png(&image, &picture.image, ToneMap::default(), 0.0, &plain)?;
            let error = self.path(&format!("images/{name}-error.png"));
            write_png(&error, &heat(map, top), ToneMap::Linear, 0.0, &plain)?;
            list += &format!(
                "{name}\t{}\terror {:.2} % at {} s\n",
                picture.configuration,
                100.0 * picture.error,
                short(picture.cpu)
            );
        }
        write(&self.path("images/list.txt"), &list)
    }

    /// The pictures that were written, the reference first.
    pub(crate) fn read_pictures(&self) -> Result<Vec<Shown>, SweepError> {
        let Some(list) = read(&self.path("images/list.txt"))? else { return Ok(Vec::new()) };
        let bytes = |name: &str| {
            let path = self.path(&format!("images/{name}.png"));
            read_file(&path, Named::ByFile, Limit::NONE, &|| false).map_err(io_error(&path))
        };
        let mut shown = Vec::new();
        for line in list.lines() {
            let mut fields = line.split('\t');
            let [name, title, detail] = std::array::from_fn(|_| fields.next().unwrap_or_default());
            // Pictures stand in the page: only those of this folder.
            if !name.bytes().all(|b| b.is_ascii_alphanumeric()) {
                continue;
            }
            let error = if name == "reference" { None } else { Some(bytes(&format!("{name}-error"))?) };
            shown.push(Shown { title: title.into(), detail: detail.into(), image: bytes(name)?, error });
        }
        Ok(shown)
    }
}

/// The text of a file; `None` where there is none.
fn read(path: &Path) -> Result<Option<String>, SweepError> {
    let text = read_file(path, Named::ByFile, Limit::NONE, &|| false)
        .and_then(|bytes| String::from_utf8(bytes).map_err(|_| ErrorKind::InvalidData.into()));
    match text {
        Ok(text) => Ok(Some(text)),
        Err(cause) if cause.kind() == ErrorKind::NotFound => Ok(None),
        Err(cause) => Err(io_error(path)(cause)),
    }
}

fn write(path: &Path, text: &str) -> Result<(), SweepError> {
    Ok(write_text(path, text)?)
}

fn write_text(path: &Path, text: &str) -> Result<(), WriteError> {
    atomic_write(path, |file| file.write_all(text.as_bytes()))
}

/// Writes what took long to find, elsewhere if it cannot be written where it belongs; the error then says where.
fn write_or_rescue(path: &Path, write: impl Fn(&Path) -> Result<(), WriteError>) -> Result<(), SweepError> {
    write(path).map_err(|cause| rescue(cause, path, write))
}

fn rescue(cause: WriteError, path: &Path, write: impl Fn(&Path) -> Result<(), WriteError>) -> SweepError {
    match write_spare(path, write) {
        Some(spare) => SweepError::Rescued { cause, spare },
        None => cause.into(),
    }
}

#[cfg(test)]
mod tests {
    use foton_integrator::RenderSettings;

    use super::super::plan::{Configuration, jobs};
    use super::*;

    #[test]
    fn what_took_long_is_elsewhere_when_the_folder_has_vanished() {
        let folder = std::env::temp_dir().join(format!("foton-measure-{}-gone", std::process::id()));
        let store = Store::open(&folder, "a sweep").expect("a folder");
        let jobs = jobs(&Configuration::of(&RenderSettings::default()));
        store.finish(&jobs[0], "a,run\n", &[]).expect("written");
        fs::remove_dir_all(&folder).expect("ours");
        let part = store.part(&jobs[0], "runs");
        let error = store.finish(&jobs[0], "a,run\n", &[]).expect_err("no folder");
        let said = error.to_string();
        let SweepError::Rescued { spare, .. } = error else { panic!("{said}") };
        let inside = folder.join("parts");
        let expected = format!(
            "cannot write {}: the folder {} does not exist; it is {} instead",
            part.display(),
            inside.display(),
            spare.display()
        );
        assert_eq!(said, expected);
        assert!(fs::read_to_string(&spare).expect("rescued").ends_with("a,run\n"));
        // Its summary is beside it, under the same number.
        let name = spare.file_name().expect("a name").to_string_lossy().replace("runs", "summary");
        assert!(fs::read_to_string(spare.with_file_name(&name)).is_ok(), "{name}");
        for file in [spare.clone(), spare.with_file_name(name)] {
            fs::remove_file(file).expect("ours");
        }
    }

    #[test]
    fn only_what_a_sweep_writes_anew_counts_as_its_own() {
        let folder = std::env::temp_dir().join(format!("foton-measure-{}-own", std::process::id()));
        for inside in ["parts", "images"] {
            fs::create_dir_all(folder.join(inside)).expect("a folder");
        }
        let own = ["index.html", "parts/00000500-runs.csv", "images/03-error.png", "images/reference.png"];
        let others =
            ["scene.xml", "parts/gem.obj", "images/wood.png", "parts/index.html", "images/a-error.png"];
        for name in own.iter().chain(&others).chain(&["reference.exr"]) {
            fs::write(folder.join(name), "").expect("written");
        }
        let names = |given: bool| {
            let mut names: Vec<PathBuf> = files_in(&folder, given);
            names.sort();
            names
        };
        let mut expected: Vec<PathBuf> = own.iter().map(|name| folder.join(name)).collect();
        expected.sort();
        assert_eq!(names(true), expected);
        expected.push(folder.join("reference.exr"));
        expected.sort();
        assert_eq!(names(false), expected);
        fs::remove_dir_all(&folder).expect("ours");
    }
}
