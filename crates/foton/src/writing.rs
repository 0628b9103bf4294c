//! The end of a render: its images, in another place if need be, and what became of its light.

use std::path::{Path, PathBuf};

use foton_film::{WriteError, write_new, write_spare};
use foton_integrator::{LayerKind, Render};
use foton_session::snapshot::{self, Format, Look};
use foton_session::{SceneIdentity, Session, Shown, checkpoint};

use crate::console::{Console, Failure};

/// What images hold beside the radiance of a render.
pub(crate) struct Content<'a> {
    /// Layers of an EXR.
    pub(crate) layers: &'a [LayerKind],
    /// What of the render they show.
    pub(crate) shown: Shown,
    /// How a PNG shows radiance.
    pub(crate) look: Look,
    /// The scene.
    pub(crate) identity: &'a SceneIdentity,
}

impl Content<'_> {
    /// Writes an image of a render as it stands.
    pub(crate) fn write(&self, path: &Path, format: Format, render: &Render) -> Result<(), WriteError> {
        snapshot::write(path, format, (render, &self.shown), self.layers, self.look, self.identity)
    }
}

/// An image to write.
pub(crate) struct Output {
    pub(crate) path: PathBuf,
    pub(crate) format: Format,
    /// Whether nothing may be written over: the name was chosen by the program, and nothing of its own has it yet.
    pub(crate) is_new: bool,
}

impl Output {
    pub(crate) fn write(&self, content: &Content<'_>, render: &Render) -> Result<(), WriteError> {
        let write = |path: &Path| content.write(path, self.format, render);
        if self.is_new { write_new(&self.path, write) } else { write(&self.path) }
    }
}

/// Writes the last images and says so.
pub(crate) fn finish(
    session: &Session,
    files: &[Output],
    content: &Content<'_>,
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
    for file in files {
        match file.write(content, session.render()) {
            Ok(()) => outputs.push(file.path.display().to_string()),
            Err(error) => {
                match rescue(&file.path, file.format, session, content) {
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
    content: &Content<'_>,
) -> Option<(&'static str, PathBuf)> {
    let render = session.render();
    let image = write_spare(path, |path| content.write(path, format, render));
    let image = image.or_else(|| {
        let path = path.with_extension("exr");
        let bare = Content { layers: &[], shown: content.shown.clone(), ..*content };
        write_spare(&path, |path| bare.write(path, Format::Exr, render))
    });
    let state = || {
        let path = path.with_extension("checkpoint");
        write_spare(&path, |path| {
            checkpoint::write(path, render, session.elapsed(), session.rays(), content.identity)
        })
    };
    image.map(|image| ("image", image)).or_else(|| Some(("state of the render", state()?)))
}
