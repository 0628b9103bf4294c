//! What commands do.

use std::sync::Arc;

use foton_scene::description::SceneDescription;

use super::Worker;
use super::state::{Flow, ProbedPaths};
use crate::engine::command::{Command, Configuration, Event, SceneEdit};
use crate::engine::editable_scene::{EditableScene, Effect};
use crate::engine::kept::Subject;
use crate::engine::loader::Opening;
use crate::engine::render::LevelRender;

impl Worker {
    /// Does what a command asks for.
    pub(super) fn obey(&mut self, command: Command) {
        self.published.unseen = true;
        if command.ends_turntable() {
            self.end_turntable();
        }
        match command {
            Command::Open(source) => self.opening = Some(Opening::begin(&self.setup.loader, source)),
            Command::CancelOpen => self.opening = None,
            Command::Steer(change) => {
                self.plan.settings.change(change);
                if let Some(render) = self.current.render.as_mut().filter(|r| r.is_whole()) {
                    render.session_mut().render_mut().change(change);
                }
            }
            Command::Configure(configuration) => self.configure(&configuration),
            Command::Pause => {
                self.plan.flow = Flow::Steps(0);
                self.current.owes_a_pass = false;
            }
            Command::Resume => self.plan.flow = Flow::Run,
            Command::Step => {
                let left = if let Flow::Steps(n) = self.plan.flow { n } else { 0 };
                self.plan.flow = Flow::Steps(left + 1);
            }
            Command::Restart => self.restart(),
            Command::StopAt(rule) => self.plan.stop = rule,
            Command::Camera { gesture, moving } => {
                self.plan.moving = moving;
                let sensor = self.plan.settings.sensor;
                self.change_view(|scene| scene.gesture(sensor, gesture));
            }
            Command::Moving(moving) => self.plan.moving = moving,
            Command::ResetCamera => {
                self.plan.moving = false;
                let sensor = self.plan.settings.sensor;
                self.change_view(|scene| scene.reset_camera(sensor));
            }
            Command::Choose(film) => {
                let sensor = self.plan.settings.sensor;
                self.change_view(|scene| {
                    scene.choose(sensor, film);
                    Ok(Effect::None)
                });
            }
            Command::Select(target) => self.change_view(|scene| {
                scene.select(target);
                Ok(Effect::None)
            }),
            Command::Edit(edit) => self.edit(edit),
            Command::SetView(_) | Command::ShowPhotons(_) | Command::ShowPaths(_) | Command::Probe(_) => {
                self.look(&command);
            }
            Command::ResumeCheckpoint(path) => {
                self.restart();
                self.files.resuming = Some(path);
            }
            Command::Quit => {}
            _ => self.write_or_keep(command),
        }
    }

    /// What frames are to carry.
    fn look(&mut self, command: &Command) {
        match *command {
            Command::SetView(mode) => self.view.mode = mode,
            Command::ShowPhotons(on) => self.view.photons = on,
            Command::ShowPaths(on) => self.view.paths = on.then(ProbedPaths::default),
            Command::Probe(pixel) => self.view.probed = pixel,
            _ => {}
        }
    }

    /// Does what a command asks of files and of the history.
    fn write_or_keep(&mut self, command: Command) {
        match command {
            Command::Snapshot(folder) => self.snapshot(&folder),
            Command::SetLook(look) => self.files.look = look,
            Command::AutoSnapshots(folder) => self.files.auto_snapshots = folder,
            Command::SaveScene(path) => self.save_scene(&path),
            Command::KeepCheckpoint(path) => self.begin_checkpoint(&path),
            Command::Remember => self.remember(),
            Command::ReturnTo(id) => self.return_to_entry(id),
            Command::ExportFilm { of, folder } => self.export_film(of, &folder),
            Command::Turntable { steps, passes, folder } => self.begin_turntable(steps, passes, &folder),
            // A turntable that is ended has ended already, and all else is obeyed elsewhere.
            _ => {}
        }
    }

    fn configure(&mut self, configuration: &Configuration) {
        let before = self.plan.settings.sensor;
        configuration.apply(&mut self.plan.settings);
        if let Some(scene) = &self.scene {
            self.plan.settings.sensor = self.plan.settings.sensor.min(scene.sensors().len() - 1);
        }
        let sensor = self.plan.settings.sensor;
        // A region is one of an image, and that is another camera's then.
        let region = configuration.region.filter(|_| sensor == before).map(|region| (sensor, region));
        let set = self.scene.as_mut().map_or(Ok(Effect::None), |scene| scene.set_region(region));
        if let Err(message) = set {
            self.event(Event::Failed(message));
        }
        if self.plan.threads != configuration.threads {
            self.plan.threads = configuration.threads;
            self.current.pool = None;
        }
        self.current.kept.clear();
        self.restart();
    }

    /// Restarts the render.
    pub(in crate::engine) fn restart(&mut self) {
        self.end_render();
        self.current.render = None;
        self.current.owes_a_pass = self.plan.flow == Flow::Steps(0);
    }

    /// The render is no longer the one under way.
    fn end_render(&mut self) {
        self.leave_checkpoint();
        self.files.resuming = None;
        self.files.resuming_as = None;
        self.current.starting = None;
        self.current.subject = None;
        self.current.owes_a_pass = false;
        self.current.number += 1;
        self.current.refused = false;
    }

    /// Changes the camera, and restarts where that changes the picture.
    fn change_view(&mut self, change: impl FnOnce(&mut EditableScene) -> Result<Effect, String>) {
        let Some(scene) = &mut self.scene else { return };
        match change(scene) {
            Ok(Effect::Restart) => self.restart(),
            Ok(Effect::None) => {}
            Err(message) => self.event(Event::Failed(message)),
        }
    }

    /// Changes the scene. Where that changes the picture, the render is kept for when the change is undone, and the one from before goes
    /// on, if there is one of the scene as it is now.
    fn change_scene(&mut self, change: impl FnOnce(&mut EditableScene) -> Result<Effect, String>) {
        let Some(scene) = &mut self.scene else { return };
        let sensor = self.plan.settings.sensor;
        let camera = scene.sensors()[sensor].name.clone();
        let changed = change(scene);
        // The camera is still the same one, wherever it is in the list.
        self.plan.settings.sensor = scene.sensor_named(&camera, sensor);
        match changed {
            Ok(Effect::Restart) => {}
            Ok(Effect::None) => {
                // Other names are another description of what is rendered.
                self.current.subject = self.current.subject.take().and_then(|_| self.subject());
                return;
            }
            Err(message) => return self.event(Event::Failed(message)),
        }
        // As long as the checkpoint is not written, the render is the one under way.
        self.leave_checkpoint();
        let render = self.current.render.take().filter(|r| r.is_whole() && r.render().passes() > 0);
        if let (Some(render), Some(subject)) = (render, self.current.subject.take()) {
            self.keep(subject, render);
        }
        match self.subject().and_then(|now| Some((self.current.kept.take(&now)?, now))) {
            Some((render, now)) => {
                self.return_to(render);
                self.current.subject = Some(now);
            }
            None => self.restart(),
        }
    }

    /// What is rendered.
    pub(super) fn subject(&self) -> Option<Subject> {
        let scene = self.scene.as_ref()?;
        let configuration = Configuration::of(&self.plan.settings, self.plan.threads, scene.region());
        Some(Subject { scene: scene.state()?, configuration })
    }

    fn keep(&mut self, subject: Subject, render: LevelRender) {
        // The next render takes about as much as this one.
        let room = self.setup.memory_limit.map(|limit| limit - render.render().bytes() as f64);
        let gone = self.current.kept.put(subject, render, room);
        if gone > 0 {
            let renders = if gone == 1 { "a render" } else { "renders" };
            self.event(Event::Notice(format!(
                "No memory to keep {renders} from before an edit: undo restarts it"
            )));
        }
    }

    /// Goes on with a render from before an edit, paused or not.
    fn return_to(&mut self, mut render: LevelRender) {
        self.end_render();
        render.steer(&self.plan.settings);
        self.current.render = Some(render);
    }

    fn edit(&mut self, edit: SceneEdit) {
        let sensor = self.plan.settings.sensor;
        match edit {
            // A large file takes a while; the render goes on.
            SceneEdit::Import(path) => self.opening = Some(Opening::import(&self.setup.loader, path)),
            edit => {
                self.plan.moving = self.scene.is_some() && edit.is_moving();
                self.change_scene(|scene| scene.obey(sensor, edit));
            }
        }
    }

    /// Adds a model that was read to the scene.
    pub(super) fn add_model(&mut self, name: String, model: Arc<SceneDescription>) {
        let sensor = self.plan.settings.sensor;
        self.change_scene(|scene| scene.import(sensor, name, model));
    }
}
