//! The entries of the history, and the thread that writes their files and keeps within the limit.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use foton_film::{Image, Metadata, WriteError, write_exr};
use foton_integrator::RenderSettings;
use foton_scene::description::{SceneDescription, SensorDescription};

use super::entry::HistoryEntry;
use super::rooms::Room;
use crate::checkpoint::Prepared;
use crate::engine::command::{Event, Region};
use crate::engine::teller::Teller;
use crate::metadata::SceneIdentity;

/// Entries that wait to be written; the engine waits with more, for each takes memory.
const WAITING: usize = 2;

/// A pass that was kept, with all that is needed to return to it.
#[derive(Clone)]
pub(crate) struct Kept {
    pub(crate) shown: HistoryEntry,
    pub(crate) description: Arc<SceneDescription>,
    pub(crate) sensors: Vec<SensorDescription>,
    pub(crate) settings: RenderSettings,
    pub(crate) region: Option<Region>,
    pub(crate) identity: SceneIdentity,
    /// The file of its state.
    pub(crate) state: PathBuf,
}

/// What is written of an entry.
pub(crate) struct Files {
    pub(crate) id: u64,
    pub(crate) picture: (PathBuf, Image, Metadata),
    pub(crate) state: (PathBuf, Prepared),
}

/// The history.
pub(crate) struct History {
    home: Option<PathBuf>,
    limit: u64,
    teller: Teller,
    unwritten: Arc<AtomicUsize>,
    kept: Vec<Kept>,
    /// What frames carry.
    shown: Arc<Vec<HistoryEntry>>,
    next: u64,
    /// Numbers of entries whose files are gone, and who says them.
    gone: Receiver<u64>,
    tell_gone: Sender<u64>,
    /// From the first entry on.
    writer: Option<Writer>,
}

struct Writer {
    files: Sender<Files>,
    room: Room,
    /// Whether what is being written is for nobody any more.
    is_over: Arc<AtomicBool>,
    /// Things that the end of the program waits for: one of them is that the folder is gone.
    unwritten: Arc<AtomicUsize>,
}

impl Drop for Writer {
    fn drop(&mut self) {
        // The thread ends by itself, with the file that it is at.
        self.is_over.store(true, Ordering::SeqCst);
        self.room.clear();
        self.unwritten.fetch_sub(1, Ordering::SeqCst);
    }
}

impl History {
    /// An empty one, whose files go into a folder in `home` and take `limit` bytes at most.
    /// The end of the program waits for as many things as `unwritten` says.
    pub(crate) fn new(
        home: Option<PathBuf>,
        limit: u64,
        teller: Teller,
        unwritten: Arc<AtomicUsize>,
    ) -> Self {
        let (tell_gone, gone) = unbounded();
        let (kept, shown) = (Vec::new(), Arc::default());
        Self { home, limit, teller, unwritten, kept, shown, next: 1, gone, tell_gone, writer: None }
    }

    /// The entries, the oldest first.
    pub(crate) fn shown(&mut self) -> Arc<Vec<HistoryEntry>> {
        self.mind_gone();
        Arc::clone(&self.shown)
    }

    /// Where the thread says that the files of an entry are gone; heard with the next [`History::shown`].
    pub(crate) fn gone(&self) -> &Receiver<u64> {
        &self.gone
    }

    pub(crate) fn get(&mut self, id: u64) -> Option<&Kept> {
        self.mind_gone();
        self.kept.iter().find(|kept| kept.shown.id == id)
    }

    /// Entries of a render, in their order.
    pub(crate) fn of_render(&self, render: u64) -> Vec<Kept> {
        self.kept.iter().filter(|kept| kept.shown.render == render).cloned().collect()
    }

    /// The folder for files, and the number of the next entry.
    pub(crate) fn place(&mut self) -> Result<(PathBuf, u64), String> {
        if self.writer.is_none() {
            self.writer = Some(self.begin()?);
        }
        let room = self.writer.as_ref().map_or_else(PathBuf::new, |writer| writer.room.path().to_owned());
        let id = self.next;
        self.next += 1;
        Ok((room, id))
    }

    fn begin(&self) -> Result<Writer, String> {
        let home = self.home.clone().unwrap_or_else(|| std::env::temp_dir().join("foton-history"));
        let failed = |cause: std::io::Error| {
            format!("the history has no place in {}: {cause}", foton_input::shown_path(&home))
        };
        let room = Room::new(&home).map_err(failed)?;
        let (files, to_write) = bounded(WAITING);
        let (limit, teller, tell_gone) = (self.limit, self.teller.clone(), self.tell_gone.clone());
        let is_over = Arc::new(AtomicBool::new(false));
        let ended = Arc::clone(&is_over);
        let work = move || write_all(&to_write, limit, &tell_gone, &teller, &ended);
        thread::Builder::new().name("history".to_owned()).spawn(work).map_err(failed)?;
        self.unwritten.fetch_add(1, Ordering::SeqCst);
        Ok(Writer { files, room, is_over, unwritten: Arc::clone(&self.unwritten) })
    }

    /// Forgets all of it, with its files.
    pub(crate) fn end(&mut self) {
        self.writer = None;
    }

    /// Takes an entry whose files are still to be written.
    pub(crate) fn add(&mut self, kept: Kept, files: Files) {
        self.kept.push(kept);
        self.renew();
        if let Some(writer) = &self.writer {
            // The thread ends with the history.
            let _ = writer.files.send(files);
        }
    }

    /// Forgets entries whose files are gone.
    fn mind_gone(&mut self) {
        let gone: Vec<u64> = self.gone.try_iter().collect();
        if !gone.is_empty() {
            self.kept.retain(|kept| !gone.contains(&kept.shown.id));
            self.renew();
        }
    }

    fn renew(&mut self) {
        self.shown = Arc::new(self.kept.iter().map(|kept| kept.shown.clone()).collect());
    }
}

/// Writes entries as they come, and removes the oldest where all together are too large.
fn write_all(
    to_write: &Receiver<Files>,
    limit: u64,
    gone: &Sender<u64>,
    teller: &Teller,
    is_over: &AtomicBool,
) {
    let mut there: VecDeque<(u64, [PathBuf; 2], u64)> = VecDeque::new();
    for files in to_write {
        let (id, paths) = (files.id, [files.picture.0.clone(), files.state.0.clone()]);
        let written = write(files);
        if is_over.load(Ordering::SeqCst) {
            return remove(&paths);
        }
        if let Err(error) = written {
            remove(&paths);
            let _ = gone.send(id);
            teller.tell(Event::Failed(format!("the history lacks a pass: {error}")));
            continue;
        }
        let bytes = paths.iter().map(|path| fs::metadata(path).map_or(0, |found| found.len())).sum();
        there.push_back((id, paths, bytes));
        let mut removed = 0;
        while there.iter().map(|(_, _, bytes)| bytes).sum::<u64>() > limit {
            let Some((id, paths, _)) = there.pop_front() else { break };
            remove(&paths);
            let _ = gone.send(id);
            removed += 1;
        }
        if removed > 0 {
            teller.tell(Event::Notice(format!(
                "The history keeps within {:.1} GB: the oldest passes ({removed}) were removed",
                limit as f64 / f64::from(1 << 30)
            )));
        }
        teller.wake();
    }
}

fn write(files: Files) -> Result<(), WriteError> {
    let (path, image, metadata) = &files.picture;
    write_exr(path, image, &[], metadata)?;
    let (path, state) = files.state;
    state.write(&path)
}

fn remove(paths: &[PathBuf; 2]) {
    let remove = |path: &Path| drop(fs::remove_file(path));
    paths.iter().for_each(|path| remove(path));
}
