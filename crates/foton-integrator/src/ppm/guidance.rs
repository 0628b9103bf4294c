//! Guided emission: which photons are noted, and when cells are learnt from them.

use foton_scene::Sources;
use foton_transport::camera_paths::{EyePaths, GlossIndex};
use foton_transport::codec::{Reader, StateError, Writer};
use foton_transport::guide::{Cells, Samples, Training, Worth, WorthPoints, grow, is_training_pass};
use foton_transport::photon_map::Chunk;

/// Where the photons of the next pass start, and what is known of those before.
pub(crate) struct Guidance {
    cells: Cells,
    /// Those of the pass before, where cells have been learnt from it.
    cells_before: Option<Cells>,
    /// What light is worth where; `None` without guidance.
    worth: Option<Worth>,
    samples: Samples,
}

impl Guidance {
    /// Photons start as their emitters shine; if `guided`, until the first training pass.
    pub(super) fn new(sources: &Sources, eye: &EyePaths, guided: bool) -> Self {
        let mut points = WorthPoints::default();
        if guided {
            add_points(&mut points, eye);
        }
        Self::over(sources, guided.then_some(points))
    }

    /// The same by points that stand for what is seen; without them photons are not guided.
    pub(super) fn over(sources: &Sources, points: Option<WorthPoints>) -> Self {
        Self {
            cells: Cells::unguided(sources),
            cells_before: None,
            worth: points.map(Worth::over),
            samples: Samples::default(),
        }
    }

    /// Whether photons have been guided, or will be.
    pub(super) const fn is_on(&self) -> bool {
        self.worth.is_some()
    }

    pub(super) const fn cells(&self) -> &Cells {
        &self.cells
    }

    /// Where photons started: those of the pass under way, or of the one before.
    pub(super) fn cells_of(&self, is_under_way: bool) -> &Cells {
        self.cells_before.as_ref().filter(|_| !is_under_way).unwrap_or(&self.cells)
    }

    /// What the pass of so many photons, which follows so many others, has to note.
    pub(super) fn training(&self, before: u64, photons: u64) -> Option<Training<'_>> {
        let worth = self.worth.as_ref().filter(|_| is_training_pass(before))?;
        Some(Training { worth, stride: Samples::stride(photons) })
    }

    /// A pass begins: nothing of one that was discarded stays.
    pub(super) fn begin_pass(&mut self) {
        self.samples.clear();
    }

    /// A batch has been traced.
    pub(super) fn take(&mut self, chunks: &mut [Chunk]) {
        chunks.iter_mut().for_each(|chunk| self.samples.take(std::mem::take(&mut chunk.samples)));
    }

    /// The pass that follows so many others is complete.
    pub(super) fn learn(&mut self, before: u64, sources: &Sources) {
        self.cells_before = None;
        if self.worth.is_some() && is_training_pass(before) {
            let learnt = grow(&mut self.samples, sources);
            self.cells_before = Some(std::mem::replace(&mut self.cells, learnt));
            self.samples = Samples::default();
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let before = self.cells_before.as_ref().map_or(0, Cells::bytes);
        self.cells.bytes() + before + self.worth.as_ref().map_or(0, Worth::bytes) + self.samples.held()
    }

    /// The largest number of bytes that the guidance of passes of so many photons takes.
    pub(super) const fn max_bytes(photons: u64, emitters: usize) -> u64 {
        let lasting = Worth::MAX_BYTES + 2 * Cells::max_bytes(emitters);
        lasting as u64 + Samples::bytes(photons)
    }

    pub(super) fn write(&self, out: &mut Writer) {
        self.cells.write(out);
    }

    pub(super) fn read(&mut self, input: &mut Reader<'_>, emitters: usize) -> Result<(), StateError> {
        self.cells = Cells::read(input, emitters)?;
        Ok(())
    }
}

/// Adds what eye samples have found to points that stand for what is seen.
pub(super) fn add_points(points: &mut WorthPoints, eye: &EyePaths) {
    let is_specular = |gloss: GlossIndex| eye.gloss.get(gloss.get()).is_some_and(|gloss| gloss.specular);
    points.add(&eye.hit_points, |hit_point| hit_point.gloss.is_some_and(is_specular));
}
