//! What the window shows of the default scene in its first seconds: each picture with the processor time until it was there, and its
//! error against the same eye samples with many photons.

use std::path::PathBuf;
use std::sync::Arc;

use foton_film::Image;
use foton_integrator::{Cancel, PpmSettings};
use foton_session::engine::{Command, Frame, Picture, Setup, Source};
use foton_session::{Engine, Session, StopRule};

use crate::answers::{DefaultScene, built, until};
use crate::rig;

/// Passes of the reference.
const REFERENCE: u64 = 64;
/// Passes that are watched.
const PASSES: u64 = 12;
/// The share of the pixels that counts: a few bright ones hold most of the error of a caustic.
const COUNTED: f64 = 0.995;

/// Root mean square of luminance, over the mean, of a picture of any size: one of fewer pixels is shown scaled up.
fn error(picture: &Image, reference: &Image) -> f64 {
    let at = |x: u32, y: u32| {
        let (x, y) = (x * picture.width / reference.width, y * picture.height / reference.height);
        picture.pixels[(y * picture.width + x) as usize]
    };
    let places = (0..reference.height).flat_map(|y| (0..reference.width).map(move |x| (x, y)));
    let luminances = reference.pixels.iter().map(|p| f64::from(p.luminance()));
    let mean = luminances.clone().sum::<f64>() / reference.pixels.len() as f64;
    let mut squares: Vec<f64> = places
        .zip(luminances)
        .map(|((x, y), reference)| (f64::from(at(x, y).luminance()) - reference).powi(2))
        .collect();
    squares.sort_by(f64::total_cmp);
    squares.truncate((COUNTED * squares.len() as f64) as usize);
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt() / mean
}

/// A picture as it was shown.
struct Shown {
    seconds: f64,
    passes: u64,
    picture: Arc<Image>,
}

fn shown() -> Vec<Shown> {
    let loader = DefaultScene(PpmSettings::default());
    let engine = Engine::spawn(Setup::new(Arc::new(loader), Box::new(|| ()), None)).expect("a thread");
    let before = rig::processor_seconds(std::process::id()).expect("Linux tells");
    engine.send(Command::StopAt(StopRule::passes(PASSES)));
    engine.send(Command::Open(Source::File(PathBuf::new())));
    let mut all: Vec<Shown> = Vec::new();
    until(&engine, &mut |frame: &Frame| {
        if let Some(Picture::Colour(picture)) = &frame.picture
            && all.last().is_none_or(|last| !Arc::ptr_eq(&last.picture, picture))
        {
            let seconds = rig::processor_seconds(std::process::id()).expect("Linux tells") - before;
            all.push(Shown { seconds, passes: frame.stats.passes, picture: Arc::clone(picture) });
        }
        frame.stats.passes >= PASSES
    });
    all
}

pub(crate) fn print() {
    let (loader, cancel) = (DefaultScene(PpmSettings::default()), Cancel::default());
    let all = shown();
    let mut whole = Session::start(built(), loader.settings(), None, &cancel).expect("starts");
    for _ in 0..REFERENCE {
        whole.advance(&cancel).expect("a pass");
    }
    let reference = whole.render().image();
    println!("| processor s | pixels | whole passes | error % |\n|---|---|---|---|");
    for Shown { seconds, passes, picture } in all {
        let (size, error) = ([picture.width, picture.height], 100.0 * error(&picture, &reference));
        println!("| {seconds:.1} | {}×{} | {passes} | {error:.0} |", size[0], size[1]);
    }
}
