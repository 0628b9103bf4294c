//! The end of a render: its images, in another place if need be, and what became of its light.

use std::path::{Path, PathBuf};

use foton_film::write_spare;
use foton_integrator::LayerKind;
use foton_session::snapshot::{self, Format};
use foton_session::{SceneIdentity, Session, checkpoint};

use crate::console::{Console, Failure};

/// Writes the last images and says so.
pub(crate) fn finish(
    session: &Session,
    files: &[(PathBuf, Format)],
    layers: &[LayerKind],
    identity: &SceneIdentity,
    mut outputs: Vec<String>,
    console: &Console,
) -> Result<(), Failure> {
    let fault = |passes: Option<u64>| {
        let panic = session.panic().cloned().map(|panic| Failure::Panicked { panic, passes });
        panic.or_else(|| {
            session.not_finite().cloned().map(|place| Failure::NotFinite { place: Box::new(place), passes })
        })
    };
    if session.render().passes() == 0 {
        // Without a fault it was interrupted twice in the first pass: there is no picture yet.
        return Err(fault(None).unwrap_or(Failure::Interrupted("rendering the first pass")));
    }
    if let Some(panic) = session.panic().filter(|p| !p.leaves_the_image_whole()) {
        return Err(Failure::Panicked { panic: panic.clone(), passes: None });
    }
    // One that cannot be written does not keep the others from it.
    let mut unwritten = None;
    for (path, format) in files {
        match snapshot::write(path, *format, session.render(), layers, identity) {
            Ok(()) => outputs.push(path.display().to_string()),
            Err(error) => {
                match rescue(path, *format, session, layers, identity) {
                    Some((what, spare)) => {
                        console.warning(&format!("{error}; the {what} is {} instead", spare.display()));
                        outputs.push(spare.display().to_string());
                    }
                    None => console.warning(&format!("{error}; nor can it be written anywhere else")),
                }
                if let Some(earlier) = unwritten.replace(error) {
                    console.warning(&earlier.to_string());
                }
            }
        }
    }
    console.losses(session.render());
    console.starved_emitters(session.render());
    console.done(session, &outputs);
    if let Some(error) = unwritten {
        return Err(error.into());
    }
    fault(Some(session.render().passes())).map_or(Ok(()), Err)
}

/// Writes an image that cannot be written where it was asked for beside that place, or into the system's folder for temporary files:
/// hours of rendering are not lost with a folder. What an image cannot hold is left out; the state of the render comes last. Says what
/// was written and where; `None` where there is no room for any.
fn rescue(
    path: &Path,
    format: Format,
    session: &Session,
    layers: &[LayerKind],
    identity: &SceneIdentity,
) -> Option<(&'static str, PathBuf)> {
    let render = session.render();
    let image = write_spare(path, |path| snapshot::write(path, format, render, layers, identity));
    let image = image.or_else(|| {
        let path = path.with_extension("exr");
        write_spare(&path, |path| snapshot::write(path, Format::Exr, render, &[], identity))
    });
    let state = || {
        let path = path.with_extension("checkpoint");
        write_spare(&path, |path| {
            checkpoint::write(path, render, session.elapsed(), session.rays(), identity)
        })
    };
    image.map(|image| ("image", image)).or_else(|| Some(("state of the render", state()?)))
}
