//! The turntable: the camera goes once around what it looks at, in steps, and a PNG of each is written after so many passes.

use std::f64::consts::TAU;
use std::num::NonZeroU32;
use std::path::Path;

use foton_scene::description::SensorDescription;

use super::film::Film;
use crate::engine::command::{Event, Gesture};
use crate::engine::worker::Worker;
use crate::metadata;

/// One that turns.
pub(in crate::engine) struct Turntable {
    steps: NonZeroU32,
    passes: u64,
    done: u32,
    film: Film,
    /// Cameras as they were.
    before: Vec<SensorDescription>,
}

impl Turntable {
    /// Frames that are written, and all.
    pub(in crate::engine) fn progress(&self) -> [u32; 2] {
        [self.done, self.steps.get()]
    }
}

impl Worker {
    /// Begins to turn, from the camera as it is.
    pub(in crate::engine) fn begin_turntable(&mut self, steps: NonZeroU32, passes: u64, folder: &Path) {
        self.end_turntable();
        let Some(scene) = &self.scene else {
            return self.event(Event::Failed("there is no scene to turn around".to_owned()));
        };
        let (name, before) = (format!("{}-turntable", scene.facts().title()), scene.sensors().to_vec());
        match Film::new(folder, &name, self.files.look, &self.setup.ffmpeg) {
            Ok(film) => {
                self.turntable = Some(Turntable { steps, passes: passes.max(1), done: 0, film, before });
                self.plan.flow = crate::engine::worker::Flow::Run;
                self.restart();
            }
            Err(message) => self.event(Event::Failed(message)),
        }
    }

    /// Gives the turntable up, if one turns. Its frames stay.
    pub(in crate::engine) fn end_turntable(&mut self) {
        if let Some(turntable) = self.turntable.take() {
            let [done, all] = turntable.progress();
            self.event(Event::Notice(format!("The turntable ended after {done} of {all} frames")));
            self.put_back(turntable);
        }
    }

    /// After a pass of the whole picture: writes the frame if it is due, and turns.
    pub(in crate::engine) fn turn(&mut self) {
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
