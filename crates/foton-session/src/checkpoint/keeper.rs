//! A checkpoint file that follows a render: written every so often, and at the end in another place if need be.

use std::path::{Path, PathBuf};
use std::time::Duration;

use foton_film::{WriteError, check_writable, write_spare};
use foton_integrator::Render;

use super::write;
use crate::metadata::SceneIdentity;
use crate::session::Session;

/// Keeps a checkpoint file up to date.
#[derive(Debug)]
pub struct Keeper {
    path: PathBuf,
    /// The scene of the render, whatever is opened or edited next.
    scene: SceneIdentity,
    every: Duration,
    /// How long the render had taken when it was last written, or could not be.
    tried: Duration,
    /// How long the render had taken that is in the file.
    stored: Option<Duration>,
}

/// Why the last state of a render is not in its checkpoint, and where it is instead.
#[derive(Debug)]
pub struct Unwritten {
    /// What was wrong with the checkpoint's own place.
    pub cause: WriteError,
    /// The file that has the state; `None` where no place had room for it.
    pub spare: Option<PathBuf>,
}

impl Keeper {
    /// Of a render that has taken `elapsed`; the file is written for the first time once it has taken `every` more.
    #[must_use]
    pub fn new(path: &Path, scene: SceneIdentity, every: Duration, elapsed: Duration) -> Self {
        Self { path: path.to_owned(), scene, every, tried: elapsed, stored: None }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// How much of a render that has taken `elapsed` is not in the file; `None` before it is written for the first time.
    #[must_use]
    pub fn age(&self, elapsed: Duration) -> Option<Duration> {
        self.stored.map(|stored| elapsed.saturating_sub(stored))
    }

    /// Whether a render that has taken `elapsed` is to be written.
    #[must_use]
    pub fn is_due(&self, elapsed: Duration) -> bool {
        elapsed.saturating_sub(self.tried) >= self.every
    }

    /// Writes a render as it stands, with the time and the rays that it has taken.
    ///
    /// # Errors
    /// [`WriteError`] with the path. The file then has the state before, and the next try is due as if it had succeeded.
    pub fn write(&mut self, render: &Render, elapsed: Duration, rays: u64) -> Result<(), WriteError> {
        self.tried = elapsed;
        check_writable(&self.path)?;
        write(&self.path, render, elapsed, rays, &self.scene)?;
        self.stored = Some(elapsed);
        Ok(())
    }

    /// Writes the last state of a render, in another place if need be, for no later one makes up for it. Does nothing where the
    /// file has that state already, and where a fault ended the render: hit points may then be half-way between two passes, and
    /// the checkpoint before is the one to resume.
    ///
    /// # Errors
    /// [`Unwritten`] when the file itself cannot be written.
    pub fn write_last(&mut self, session: &Session) -> Result<(), Unwritten> {
        let has_failed = session.panic().is_some() || session.not_finite().is_some();
        let (render, elapsed) = (session.render(), session.elapsed());
        if has_failed || render.passes() == 0 || self.stored == Some(elapsed) {
            return Ok(());
        }
        self.write(render, elapsed, session.rays()).map_err(|cause| {
            let state = |path: &Path| write(path, render, elapsed, session.rays(), &self.scene);
            Unwritten { cause, spare: write_spare(&self.path, state) }
        })
    }
}
