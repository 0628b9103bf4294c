//! The folder of a sweep: the reference, a part for each finished job, pictures, tables and page. Files appear whole.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use foton_film::{Image, Metadata, ToneMap, atomic_write, read_exr, write_exr, write_png};
use foton_input::{Limit, Named, read_file};
use foton_integrator::Ppm;
use foton_math::Rgb;

use super::plan::Job;
use super::reference::{Known, Reference};
use super::run::Picture;
use super::table::{self, Point};
use super::{SweepError, io_error};
use crate::plot::short;
use crate::{Pair, heat, scale_top};

/// What the reference is, in its file's metadata.
const ORIGIN: &str = "foton:origin";

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
        Ok(store)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn part(&self, job: &Job, table: &str) -> PathBuf {
        self.path(&format!("parts/{:08}-{table}.csv", job.photons))
    }

    /// What a job found, if it is finished.
    pub(crate) fn points(&self, job: &Job) -> Result<Option<Vec<Point>>, SweepError> {
        let path = self.part(job, "summary");
        let Some(text) = read(&path)? else { return Ok(None) };
        table::read_summary(&text).map(Some).ok_or(SweepError::Table { path })
    }

    /// Keeps what a job found. The summary comes last: where it is, all is.
    pub(crate) fn finish(&self, job: &Job, runs: &str, points: &[Point]) -> Result<(), SweepError> {
        write(&self.part(job, "runs"), &(table::runs_heading() + runs))?;
        write(&self.part(job, "summary"), &(table::summary_heading() + &table::summary(points)))
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

    /// Keeps a reference of the sweep's own.
    pub(crate) fn keep_reference(&self, reference: &Reference) -> Result<(), SweepError> {
        let mut metadata = Metadata::default();
        metadata.set(ORIGIN, &reference.origin);
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
            write_exr(&self.path("reference-classes.exr"), &image, &[], &metadata)?;
        }
        // Of the reference, of the one with twice its radius, and that one's luminance.
        let Known { luminance, variance } = reference.wide.as_ref().unwrap_or(&reference.fine);
        let image = of(&|p| [reference.fine.variance[p], variance[p], luminance[p]]);
        write_exr(&self.path("reference-variance.exr"), &image, &[], &metadata)?;
        // Last: where it is, all is.
        write_exr(&self.path("reference.exr"), &reference.image, &[], &metadata)?;
        Ok(())
    }

    /// The reference that was kept, if any.
    pub(crate) fn reference(&self, eye: &Ppm) -> Result<Option<Reference>, SweepError> {
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

    /// Keeps pictures at equal times and maps of their errors, all on one scale.
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

    /// The pictures that were kept, the reference first.
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
    Ok(atomic_write(path, |file| file.write_all(text.as_bytes()))?)
}
