//! What random bytes are fed into, and what must hold whatever they are: no panic, no hang, and no more memory than four times
//! the input and 64 MiB. The bytes of a picture count as it would be unpacked, but no further than its compression can go.
//!
//! Two drivers share this: `mutate`, which any stable compiler builds, and libFuzzer's targets.

mod gltf;
pub mod memory;
mod pbrt;
pub mod seeds;

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use foton_format::{OpenError, Opened, Options, read_str};
use foton_integrator::{Cancel, PpmSettings, RenderSettings};
use foton_scene::Scene;
use foton_session::{SceneIdentity, Session, checkpoint};

#[global_allocator]
static COUNTED: memory::Counted = memory::Counted;

/// What reads the bytes.
pub type Reader = fn(&[u8]) -> String;

/// Everything that is fuzzed: its name, and what reads. A reader says in a line how it ended, for drivers to tell runs apart.
pub const TARGETS: [(&str, Reader); 7] = [
    ("xml", xml),
    ("pbrt", pbrt_scene),
    ("obj", obj),
    ("ply", ply),
    ("image", image),
    ("gltf", gltf::read),
    ("checkpoint", read_checkpoint),
];

/// The longest that any input may take: these are inputs of kilobytes.
pub const TIME_LIMIT: Duration = Duration::from_secs(5);

/// Runs one input and panics where the bound on memory is broken.
///
/// # Panics
/// That is how drivers notice.
pub fn check(target: &str, data: &[u8]) -> String {
    let (_, reader) = TARGETS.iter().find(|(name, _)| *name == target).expect("a known target");
    // What is set up once is no part of the input's account.
    if target == "checkpoint" {
        GENUINE.with(|g| drop(g.borrow()));
    }
    let before = memory::restart();
    let said = reader(data);
    let took = memory::peak() - before;
    let bound = allowance(target, data);
    assert!(took <= bound, "{took} bytes were allocated for {} bytes, {bound} are allowed", data.len());
    said
}

/// [`check`], and that the input takes no longer than it may.
///
/// # Panics
/// That is how drivers notice.
pub fn check_with_time(target: &str, data: &[u8]) -> String {
    let timed = || {
        let begin = Instant::now();
        let said = check(target, data);
        (begin.elapsed(), said)
    };
    let (elapsed, said) = timed();
    if elapsed < TIME_LIMIT {
        return said;
    }
    // A second try tells a slow input from a busy machine.
    let (again, _) = timed();
    assert!(again < TIME_LIMIT, "{elapsed:?} and {again:?} for {} bytes", data.len());
    said
}

/// Bytes that an input may take.
fn allowance(target: &str, data: &[u8]) -> usize {
    let fixed = 64 << 20;
    match target {
        // 16 bytes a pixel while it is unpacked, of which a byte of the file can hold 1,032 × 8.
        "image" => fixed + 4 * data.len() + 16 * data.len() * 1032 * 8,
        _ => fixed + 4 * data.len(),
    }
}

fn no_files(_: &Path) -> std::io::Result<Vec<u8>> {
    Err(std::io::ErrorKind::NotFound.into())
}

/// Reads a scene, and builds it if it is one.
fn scene(xml: &str, files: &dyn Fn(&Path) -> std::io::Result<Vec<u8>>) -> String {
    outcome(read_str("f.xml", xml, files, &Options::default()))
}

/// How reading ended; what was read is built.
fn outcome(opened: Result<Opened, OpenError>) -> String {
    let said = match opened {
        Ok(Opened { description, warnings, .. }) => {
            let built = Scene::build(&description).map(|s| format!("{:?}", s.census()));
            format!("{built:?} {warnings:?}")
        }
        Err(error) => error.to_string(),
    };
    // Numbers, names and places are as many as inputs; what is said of them is not.
    said.chars().filter(|c| !c.is_ascii_digit()).take(400).collect()
}

/// A scene file, with files beside it that it may name.
pub fn xml(data: &[u8]) -> String {
    let Ok(text) = std::str::from_utf8(data) else { return "not UTF-8".into() };
    let files = |path: &Path| match path.to_str() {
        Some("f.xml") => Ok(data.to_vec()),
        Some(name) => seeds::file(name).ok_or_else(|| std::io::ErrorKind::NotFound.into()),
        None => no_files(path),
    };
    scene(text, &files)
}

/// Memory that reading a scene of pbrt may take: a file of kilobytes may ask for any number of instances and triangles.
const PBRT_MEMORY: u64 = 16 << 20;

/// A scene of pbrt, with files beside it that it may name.
pub fn pbrt_scene(data: &[u8]) -> String {
    let files = |path: &Path| match path.to_str() {
        Some("f.pbrt") => Ok(data.to_vec()),
        Some(name) => {
            pbrt::file(name).or_else(|| seeds::file(name)).ok_or_else(|| std::io::ErrorKind::NotFound.into())
        }
        None => no_files(path),
    };
    let options = Options {
        memory: Some(PBRT_MEMORY),
        allow_missing: data.len().is_multiple_of(2),
        ..Options::default()
    };
    outcome(foton_format::open_from(Path::new("f.pbrt"), &files, &options))
}

fn as_mesh(kind: &str, data: &[u8]) -> String {
    let xml = format!(
        "<scene version='3.0.0'><sensor type='perspective'/>\
         <shape type='{kind}'><string name='filename' value='m'/></shape></scene>"
    );
    let files = |path: &Path| if path == Path::new("m") { Ok(data.to_vec()) } else { no_files(path) };
    scene(&xml, &files)
}

/// An OBJ file.
pub fn obj(data: &[u8]) -> String {
    as_mesh("obj", data)
}

/// A PLY file; STL, OFF and `.serialized` share the bounds and are fed from here too.
pub fn ply(data: &[u8]) -> String {
    if data.starts_with(b"OFF") || data.get(1..4) == Some(b"OFF") {
        return by_path("off", data);
    }
    let kind = if data.starts_with(&[0x1c, 0x04]) {
        "serialized"
    } else if data.starts_with(b"ply") {
        "ply"
    } else {
        "stl"
    };
    as_mesh(kind, data)
}

/// A mesh file that is a scene of its own.
fn by_path(extension: &str, data: &[u8]) -> String {
    let path = scratch(extension);
    if std::fs::write(&path, data).is_err() {
        return "no place to write".into();
    }
    let said = match foton_format::open(&path, &Options::default()) {
        Ok(opened) => format!("{:?}", Scene::build(&opened.description).map(|s| format!("{:?}", s.census()))),
        Err(error) => error.diagnostics().iter().map(|fault| fault.message.clone()).collect(),
    };
    said.chars().filter(|c| !c.is_ascii_digit()).take(400).collect()
}

/// Where inputs lie that are read by path.
fn scratch(extension: &str) -> PathBuf {
    let folder =
        if Path::new("/dev/shm").is_dir() { PathBuf::from("/dev/shm") } else { std::env::temp_dir() };
    folder.join(format!("foton-fuzz-{}.{extension}", std::process::id()))
}

/// Sums the chunks of a PNG file anew, so that what the sums guard is reached as well.
fn sum_chunks(png: &mut [u8]) {
    let mut at = 8;
    while let Some(head) = png.get(at..at + 8) {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let Some(chunk) = png.get(at + 4..(at + 8).saturating_add(length)) else { return };
        let sum = !chunk.iter().fold(!0u32, |crc, byte| {
            (0..8)
                .fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 })
        });
        let Some(place) = png.get_mut(at + 8 + length..at + 12 + length) else { return };
        place.copy_from_slice(&sum.to_be_bytes());
        at += 12 + length;
    }
}

/// A picture: as a texture, and by the readers of `foton compare`.
pub fn image(data: &[u8]) -> String {
    let path = scratch("image");
    let mut data = data.to_vec();
    if data.starts_with(b"\x89PNG") && !data.len().is_multiple_of(4) {
        sum_chunks(&mut data);
    }
    if std::fs::write(&path, data).is_err() {
        return "no place to write".into();
    }
    let xml = format!(
        "<scene version='3.0.0'><sensor type='perspective'/><texture type='bitmap'>\
         <string name='filename' value='{}'/></texture></scene>",
        path.display()
    );
    let files = |path: &Path| std::fs::read(path);
    let said = scene(&xml, &files);
    let kind = |result: Result<(), foton_film::ReadError>| match result {
        Ok(()) => "read".to_owned(),
        Err(error) => error.to_string().chars().filter(|c| !c.is_ascii_digit()).collect(),
    };
    let exr = kind(foton_film::read_exr(&path).map(|_| ()));
    let png = kind(foton_film::read_png(&path).map(|_| ()));
    format!("{said} {exr} {png}")
}

/// A render to take checkpoints up in, and a checkpoint of it.
struct Genuine {
    session: Session,
    identity: SceneIdentity,
    bytes: Vec<u8>,
    state: Vec<u8>,
}

thread_local! {
    static GENUINE: RefCell<Genuine> = RefCell::new(genuine());
}

fn genuine() -> Genuine {
    let opened = read_str("f.xml", seeds::ROOM, &no_files, &Options::default()).expect("our own scene");
    let scene = std::sync::Arc::new(Scene::build(&opened.description).expect("our own scene"));
    let identity = SceneIdentity { name: "f.xml".into(), hash: 1 };
    let number = |n| std::num::NonZeroU32::new(n).expect("above zero");
    let settings = RenderSettings {
        samples_per_pixel: number(1),
        error: true,
        ppm: PpmSettings { photons_per_pass: number(500), first_pass: number(500), ..PpmSettings::default() },
        ..RenderSettings::default()
    };
    let cancel = Cancel::default();
    let mut session = Session::start(scene, settings, Some(1), &cancel).expect("starts");
    session.advance(&cancel).expect("not cancelled");
    let path = scratch("genuine");
    checkpoint::write(&path, session.render(), session.elapsed(), session.rays(), &identity)
        .expect("written");
    let bytes = std::fs::read(&path).expect("just written");
    let _ = std::fs::remove_file(path);
    let state = session.render().save();
    Genuine { session, identity, bytes, state }
}

/// Bytes before the text in a checkpoint: magic, version, four numbers, of which the first is the text's length.
const HEADER: usize = 8 + 4 + 4 * 8;

/// The genuine checkpoint and its state, for seeds.
pub fn genuine_checkpoint() -> (Vec<u8>, Vec<u8>) {
    GENUINE.with(|g| (g.borrow().bytes.clone(), g.borrow().state.clone()))
}

/// A checkpoint. After a first byte of 1 the rest is a state, which is packed, summed and headed as it should be, so that what
/// the checksum guards is reached as well; after any other byte the rest is the file.
pub fn read_checkpoint(data: &[u8]) -> String {
    let Some((first, rest)) = data.split_first() else { return "empty".into() };
    GENUINE.with(|genuine| {
        let mut genuine = genuine.borrow_mut();
        let file = if *first == 1 {
            let mut file = genuine.bytes[..HEADER - 8].to_vec();
            file.extend((rest.len() as u64).to_le_bytes());
            let text = genuine.bytes[12..20].iter().rev().fold(0, |n, &b| n << 8 | usize::from(b));
            file.extend(&genuine.bytes[HEADER..HEADER + text]);
            file.extend(zstd::bulk::compress(rest, 1).expect("memory"));
            let sum = file
                .iter()
                .fold(0xcbf2_9ce4_8422_2325, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
            file.extend(sum.to_le_bytes());
            file
        } else {
            rest.to_vec()
        };
        let path = scratch("checkpoint");
        if std::fs::write(&path, file).is_err() {
            return "no place to write".into();
        }
        let Genuine { session, identity, .. } = &mut *genuine;
        match checkpoint::resume(&path, session, identity, false) {
            // What was taken up must render.
            Ok(()) if session.render().settings().ppm.photons_per_pass.get() <= 1 << 16 => {
                let report = session.advance(&Cancel::default()).expect("not cancelled");
                let dark = session.render().image().pixels.iter().all(|p| p.is_black());
                format!("taken up, {} {dark}", report.floored > 0)
            }
            Ok(()) => "taken up".into(),
            Err(error) => error.to_string().chars().filter(|c| !c.is_ascii_digit()).collect(),
        }
    })
}
