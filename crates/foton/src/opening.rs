//! Scenes from files: read and built within the memory that there is, with all that is to be said of them.

use std::path::Path;
use std::sync::Arc;

use foton_format::{Opened, Options, Progress, Severity};
use foton_integrator::{Cancel, MemoryEstimate, RenderSettings};
use foton_scene::description::{Crop, SceneDescription};
use foton_scene::{BuildOptions, Scene};
use foton_session::findings::{self, FindingKind};
use foton_session::{SceneIdentity, Session};

use crate::args::{ALL_SENSORS, ReadOptions, Size};
use crate::console::{Console, Failure};
use crate::interrupts::begin_step;
use crate::memory;
use crate::roles::Roles;

/// Reads a scene within that many bytes, or what the system leaves.
pub(crate) fn open(
    scene: &Path,
    read: &ReadOptions,
    memory: Option<u64>,
    console: &Console,
    cancel: &Cancel,
) -> Result<Opened, Failure> {
    begin_step("reading the scene");
    let progress = Progress::new(console.reading());
    let options = Options { progress, ..how_to_read(read, memory, cancel) };
    foton_format::open(scene, &options).map_err(Failure::of_open)
}

/// How a scene is read within that many bytes, or what the system leaves.
pub(crate) fn how_to_read(read: &ReadOptions, memory: Option<u64>, cancel: &Cancel) -> Options {
    Options {
        defines: read.defines.clone(),
        memory: memory::limit(memory).map(|b| b as u64),
        allow_missing: read.allow_missing,
        cancel: cancel.clone(),
        progress: Progress::default(),
    }
}

/// What a scene is built within.
#[derive(Clone, Copy, Default)]
pub(crate) struct Bounds {
    /// Size of the whole image in pixels; `None`: as the scene says.
    pub(crate) size: Option<Size>,
    /// The part of the sensor's image that is rendered; `None`: as the scene says.
    pub(crate) region: Option<Crop>,
    /// Bytes at most; `None`: what the system leaves.
    pub(crate) memory: Option<u64>,
}

/// Builds the scene, at another size if one is asked for and within that many bytes, and says what its file got wrong and what is
/// too far away for it, seen from a sensor.
pub(crate) fn build(
    mut opened: Opened,
    name: &str,
    sensor: usize,
    bounds: Bounds,
    console: &Console,
    cancel: &Cancel,
) -> Result<(Arc<Scene>, SceneIdentity), Failure> {
    begin_step("building the scene");
    for warning in &opened.warnings {
        console.diagnostic(warning);
    }
    let identity = SceneIdentity { name: name.to_owned(), hash: opened.source_hash };
    if let Some(Size { width, height }) = bounds.size {
        for sensor in &mut opened.description.sensors {
            sensor.resize(width, height);
        }
    }
    if let Some((region, sensor)) = bounds.region.zip(opened.description.sensors.get_mut(sensor)) {
        sensor.show_only(region).map_err(Failure::Region)?;
    }
    refuse_to_build(&opened.description, bounds.memory)?;
    let tell = console.building();
    let options = BuildOptions { cancel: cancel.clone(), tell: Some(&tell), ..BuildOptions::default() };
    let scene = Scene::build_with(&opened.description, &options)
        .map_err(|cause| Failure::of_build(&opened, name, &cause))?;
    for finding in findings::of_scene(&scene, sensor) {
        match finding.kind {
            FindingKind::FarAway => {
                let place = finding.place.as_deref();
                console.diagnostic(&opened.finding(Severity::Warning, name, place, finding.text));
            }
            _ => console.finding(&finding),
        }
    }
    Ok((Arc::new(scene), identity))
}

/// What a scene file is called in messages and in the metadata of images.
pub(crate) fn file_name(scene: &Path) -> String {
    scene.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Whether all sensors are asked for.
pub(crate) fn asks_for_all_sensors(opened: &Opened, name: Option<&str>) -> bool {
    name == Some(ALL_SENSORS) && opened.description.sensors.iter().all(|s| s.name != ALL_SENSORS)
}

/// The index of the sensor of that name; the first without one.
pub(crate) fn choose_sensor(opened: &Opened, name: Option<&str>) -> Result<usize, Failure> {
    let Some(name) = name else { return Ok(0) };
    let sensors = &opened.description.sensors;
    sensors.iter().position(|s| s.name == name).ok_or_else(|| Failure::Sensor {
        asked: name.to_owned(),
        known: sensors.iter().map(|s| s.name.clone()).collect(),
    })
}

/// Looks before it leaps: a render that would not fit is refused with the numbers.
pub(crate) fn refuse_beyond_memory(
    scene: &Scene,
    settings: &RenderSettings,
    threads: Option<usize>,
    asked: Option<u64>,
) -> Result<(), Failure> {
    let refusal = Session::estimate_memory(scene, settings, threads).refusal(memory::limit(asked));
    refusal.map_or(Ok(()), |why| Err(Failure::Memory(why)))
}

/// Refuses a scene whose building alone would take more than may be used: bytes asked for, or the system's.
pub(crate) fn refuse_to_build(description: &SceneDescription, asked: Option<u64>) -> Result<(), Failure> {
    let takes = description.build_bytes() as f64 + MemoryEstimate::PROGRAM_BYTES;
    match memory::limit(asked) {
        Some(limit) if takes > limit => Err(Failure::BuildMemory { takes, limit }),
        _ => Ok(()),
    }
}

/// Refuses to write to a file that the scene was read from.
pub(crate) fn refuse_two_roles(roles: Roles, opened: &Opened) -> Result<(), Failure> {
    roles.scene_reads(&opened.files).clash().map_or(Ok(()), |clash| Err(Failure::Roles(clash)))
}
