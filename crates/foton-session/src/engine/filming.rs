//! Films: of the passes that were kept, and of the camera's way around what it looks at. They are finished beside the engine's work.

use std::f64::consts::TAU;
use std::num::NonZeroU32;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::thread;

use foton_film::read_exr;

use super::command::Event;
use super::gesture::Gesture;
use super::history::{Film, Kept, Turntable};
use super::worker::{Flow, Worker};
use crate::metadata;
use crate::snapshot::without_ending;

impl Worker {
    /// Writes the kept passes of a render as a film, beside the engine's work.
    pub(super) fn export_film(&mut self, of: u64, folder: &Path) {
        let Some(first) = self.history.get(of) else {
            return self.event(Event::Failed("the history does not have that pass any more".to_owned()));
        };
        let (render, name) = (first.shown.render, format!("{}-film", without_ending(&first.shown.scene)));
        let kept = self.history.of_render(render);
        let film = match Film::new(folder, &name, self.files.look, &self.setup.ffmpeg) {
            Ok(film) => film,
            Err(message) => return self.event(Event::Failed(message)),
        };
        let (teller, unwritten) = (self.teller.clone(), self.files.unwritten.clone());
        unwritten.fetch_add(1, Ordering::SeqCst);
        let work = move || {
            teller.tell(export(film, &kept));
            unwritten.fetch_sub(1, Ordering::SeqCst);
        };
        if let Err(error) = thread::Builder::new().name("film".to_owned()).spawn(work) {
            self.files.unwritten.fetch_sub(1, Ordering::SeqCst);
            self.event(Event::Failed(format!("cannot make a thread: {error}")));
        }
    }

    /// Finishes a film beside the engine's work.
    fn finish_film(&self, film: Film) {
        let (teller, unwritten) = (self.teller.clone(), self.files.unwritten.clone());
        unwritten.fetch_add(1, Ordering::SeqCst);
        let work = move || {
            teller.tell(film.finish());
            unwritten.fetch_sub(1, Ordering::SeqCst);
        };
        if thread::Builder::new().name("film".to_owned()).spawn(work).is_err() {
            self.files.unwritten.fetch_sub(1, Ordering::SeqCst);
        }
    }

    /// Begins to turn, from the camera as it is.
    pub(super) fn begin_turntable(&mut self, steps: NonZeroU32, passes: u64, folder: &Path) {
        self.end_turntable();
        let Some(scene) = &self.scene else {
            return self.event(Event::Failed("there is no scene to turn around".to_owned()));
        };
        let (name, before) =
            (format!("{}-turntable", without_ending(&scene.facts().title)), scene.sensors().to_vec());
        match Film::new(folder, &name, self.files.look, &self.setup.ffmpeg) {
            Ok(film) => {
                self.turntable = Some(Turntable { steps, passes: passes.max(1), done: 0, film, before });
                self.plan.flow = Flow::Run;
                self.restart();
            }
            Err(message) => self.event(Event::Failed(message)),
        }
    }

    /// Gives the turntable up, if one turns. Its frames stay.
    pub(super) fn end_turntable(&mut self) {
        if let Some(turntable) = self.turntable.take() {
            let [done, all] = turntable.progress();
            self.event(Event::Notice(format!("The turntable ended after {done} of {all} frames")));
            self.put_back(turntable);
        }
    }

    /// After a pass of the whole picture: writes the frame if it is due, and turns.
    pub(super) fn turn(&mut self) {
        let Some(mut turntable) = self.turntable.take() else { return };
        let Some((level, scene)) = self.rendered().filter(|(r, _)| r.render().passes() >= turntable.passes)
        else {
            self.turntable = Some(turntable);
            return;
        };
        let render = level.render();
        let metadata = metadata::of(render, &[], &scene.identity());
        if let Err(message) = turntable.film.add(&render.image(), metadata) {
            self.event(Event::Failed(format!("the turntable ends: {message}")));
            return self.put_back(turntable);
        }
        turntable.done += 1;
        if turntable.done == turntable.steps.get() {
            return self.put_back(turntable);
        }
        let yaw = TAU / f64::from(turntable.steps.get());
        let sensor = self.plan.settings.sensor;
        let turned =
            self.scene.as_mut().map(|scene| scene.gesture(sensor, Gesture::Orbit { yaw, pitch: 0.0 }));
        if let Some(Err(message)) = turned {
            self.event(Event::Failed(message));
            return self.put_back(turntable);
        }
        self.turntable = Some(turntable);
        self.restart();
    }

    /// Puts the camera back and finishes the film.
    fn put_back(&mut self, turntable: Turntable) {
        if let Some(scene) = &mut self.scene
            && let Err(message) = scene.put_back(turntable.before)
        {
            self.event(Event::Failed(message));
        }
        self.finish_film(turntable.film);
        self.restart();
    }
}

fn export(mut film: Film, kept: &[Kept]) -> Event {
    for kept in kept {
        let read = read_exr(&kept.shown.picture).map_err(|error| error.to_string());
        if let Err(message) = read.and_then(|(image, metadata)| film.add(&image, metadata)) {
            return Event::Failed(format!("the film ends early: {message}"));
        }
    }
    film.finish()
}
