//! What commands do.

use super::Worker;
use super::state::Flow;
use crate::engine::command::{Command, Configuration, Event, SceneEdit};
use crate::engine::editable_scene::{EditableScene, Effect};
use crate::engine::loader::Opening;

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
            Command::Pause => self.plan.flow = Flow::Steps(0),
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
                self.change_scene(|scene| scene.gesture(sensor, gesture));
            }
            Command::Moving(moving) => self.plan.moving = moving,
            Command::ResetCamera => {
                self.plan.moving = false;
                let sensor = self.plan.settings.sensor;
                self.change_scene(|scene| scene.reset_camera(sensor));
            }
            Command::Choose(film) => {
                let sensor = self.plan.settings.sensor;
                self.change_scene(|scene| {
                    scene.choose(sensor, film);
                    Ok(Effect::None)
                });
            }
            Command::Edit(edit) => self.edit(edit),
            Command::SetView(mode) => self.view.mode = mode,
            Command::ShowPhotons(on) => self.view.photons = on,
            Command::Probe(pixel) => self.view.probed = pixel,
            Command::Snapshot(folder) => self.snapshot(&folder),
            Command::SetLook(look) => self.files.look = look,
            Command::AutoSnapshots(folder) => self.files.auto_snapshots = folder,
            Command::Remember => self.remember(),
            Command::ReturnTo(id) => self.return_to(id),
            Command::ExportFilm { of, folder } => self.export_film(of, &folder),
            Command::Turntable { steps, passes, folder } => self.begin_turntable(steps, passes, &folder),
            Command::EndTurntable => {}
            Command::SaveScene(path) => self.save_scene(&path),
            Command::KeepCheckpoint(path) => self.begin_checkpoint(&path),
            Command::ResumeCheckpoint(path) => {
                self.restart();
                self.files.resuming = Some(path);
            }
            Command::Quit => {}
        }
    }

    fn configure(&mut self, configuration: &Configuration) {
        configuration.apply(&mut self.plan.settings);
        if let Some(scene) = &self.scene {
            self.plan.settings.sensor = self.plan.settings.sensor.min(scene.sensors().len() - 1);
        }
        let sensor = self.plan.settings.sensor;
        let region = configuration.region.map(|region| (sensor, region));
        let set = self.scene.as_mut().map_or(Ok(Effect::None), |scene| scene.set_region(region));
        if let Err(message) = set {
            self.event(Event::Failed(message));
        }
        if self.plan.threads != configuration.threads {
            self.plan.threads = configuration.threads;
            self.current.pool = None;
        }
        self.restart();
    }

    /// Restarts the render.
    pub(in crate::engine) fn restart(&mut self) {
        self.leave_checkpoint();
        self.files.resuming = None;
        self.files.resuming_as = None;
        self.current.render = None;
        self.current.number += 1;
        self.current.refused = false;
        // There is always a pass to look at, paused or not.
        if self.plan.flow == Flow::Steps(0) {
            self.plan.flow = Flow::Steps(1);
        }
    }

    /// Changes the scene, and restarts where that changes the picture.
    fn change_scene(&mut self, change: impl FnOnce(&mut EditableScene) -> Result<Effect, String>) {
        let Some(scene) = &mut self.scene else { return };
        match change(scene) {
            Ok(Effect::Restart) => self.restart(),
            Ok(Effect::None) => {}
            Err(message) => self.event(Event::Failed(message)),
        }
    }

    fn edit(&mut self, edit: SceneEdit) {
        let sensor = self.plan.settings.sensor;
        match edit {
            SceneEdit::BeginDrag { .. } | SceneEdit::DragTo(_) | SceneEdit::SetField { done: false, .. } => {
                self.plan.moving = true;
            }
            _ => self.plan.moving = false,
        }
        self.change_scene(|scene| match edit {
            SceneEdit::BeginDrag { film, mode } => {
                scene.begin_drag(sensor, film, mode);
                Ok(Effect::None)
            }
            SceneEdit::DragTo(film) => scene.drag_to(film),
            SceneEdit::EndDrag(film) => scene.end_drag(film),
            SceneEdit::CancelDrag => scene.cancel_drag(),
            SceneEdit::Nudge { steps, mode } => scene.nudge(sensor, steps, mode),
            SceneEdit::SetField { field, value, done } => scene.set_field(field, value, done),
            SceneEdit::OwnMaterial => scene.own_material(),
            SceneEdit::Undo => scene.undo(),
            SceneEdit::Redo => scene.redo(),
        });
    }
}
