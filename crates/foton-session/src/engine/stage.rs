//! The scene that is shown: its description with edits, the camera, what is chosen, and the scene built from them.

use std::any::Any;
use std::path::PathBuf;
use std::sync::Arc;

use foton_edit::{
    Camera, DragMode, DragPlane, Edit, FieldId, History, Outline, Segment, Target, UpAxis, Value, anchor,
    camera_xml, focus_distance, inspect, markers, pick_any,
};
use foton_integrator::Cancel;
use foton_math::glam::{DVec2, DVec3};
use foton_scene::description::{SceneDescription, SensorDescription};
use foton_scene::{BuildError, BuildOptions, Scene};

use super::command::{Gesture, Source};
use super::frame::{SceneFacts, Selection, SensorFacts};
use super::loader::Ready;
use crate::metadata::SceneIdentity;

/// A step of an arrow key, in pixels at the distance of what is chosen.
const NUDGE: f64 = 4.0;

/// Scenes of more triangles take too long to be built for every move of a hand: the outline goes with it, and the picture
/// follows when it lets go.
const MAX_LIVE_TRIANGLES: u64 = 100_000;

/// Scenes of fewer surfaces are built before anyone could give that up.
const QUICK: usize = 10_000;

/// What a change asks of the render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effect {
    /// Nothing.
    None,
    /// Another scene is there: start anew.
    Anew,
}

/// What is chosen, and how it is being dragged.
struct Chosen {
    target: Target,
    outline: Outline,
    /// From its middle to where it was picked, in world units: whatever moves it, a step back too, moves both.
    grip: DVec3,
    drag: Option<(DragPlane, [f64; 2])>,
}

impl Chosen {
    /// Where it was picked, now that the scene is as described.
    fn picked(&self, description: &SceneDescription) -> DVec3 {
        anchor(description, self.target).unwrap_or_default() + self.grip
    }
}

/// Whether any camera stands, or spans, otherwise.
fn are_elsewhere(sensors: &[SensorDescription], others: &[SensorDescription]) -> bool {
    let place = |s: &SensorDescription| (s.to_world, s.fov_degrees);
    sensors.iter().map(place).ne(others.iter().map(place))
}

/// A scene under edit.
pub(super) struct Stage {
    source: Source,
    /// What the scene was read from.
    pub(super) files: Vec<PathBuf>,
    /// What the loader wants back when the scene is saved.
    pub(super) origin: Arc<dyn Any + Send + Sync>,
    identity: SceneIdentity,
    history: History,
    /// Cameras are no steps of the history: undoing a move does not turn the head.
    sensors: Vec<SensorDescription>,
    /// The description as it was opened: what the identity's hash is of, and where cameras are reset to.
    opened: Arc<SceneDescription>,
    /// The sensors of the file that was opened or saved last.
    saved_sensors: Vec<SensorDescription>,
    /// The camera of a sensor, once it was moved.
    camera: Option<(usize, Camera)>,
    chosen: Option<Chosen>,
    /// The history's description with the sensors as they are.
    description: Arc<SceneDescription>,
    scene: Arc<Scene>,
    /// The history's description that the scene was built of, unless building a newer one was given up.
    built: Arc<SceneDescription>,
    /// Whether the scene is older than the description.
    is_stale: bool,
    /// Gives up building what is edited once something newer was asked for, and everything once the engine is to end.
    cancel: Cancel,
    quit: Cancel,
    facts: Arc<SceneFacts>,
}

impl Stage {
    pub(super) fn new(ready: Ready, [cancel, quit]: [Cancel; 2]) -> Self {
        let Ready { source, loaded, scene, .. } = ready;
        let description = Arc::new(loaded.description);
        let sensors = description.sensors.clone();
        let mut stage = Self {
            source,
            identity: loaded.identity,
            files: loaded.files,
            origin: loaded.origin,
            history: History::new(Arc::clone(&description)),
            opened: Arc::clone(&description),
            saved_sensors: sensors.clone(),
            sensors,
            camera: None,
            chosen: None,
            description: Arc::clone(&description),
            scene,
            built: Arc::clone(&description),
            is_stale: false,
            cancel,
            quit,
            facts: Arc::default(),
        };
        stage.refresh_facts();
        stage
    }

    pub(super) const fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    pub(super) const fn facts(&self) -> &Arc<SceneFacts> {
        &self.facts
    }

    pub(super) fn sensors(&self) -> &[SensorDescription] {
        &self.sensors
    }

    pub(super) const fn description(&self) -> &Arc<SceneDescription> {
        &self.description
    }

    /// The scene's name and hash; the name says if it is not as in the file that was opened, saved elsewhere or not.
    pub(super) fn identity(&self) -> SceneIdentity {
        let mut identity = self.identity.clone();
        if !self.is_as_opened() {
            identity.name.push_str(" (edited)");
        }
        identity
    }

    /// Whether what is seen is what the file that was opened says.
    pub(super) fn is_as_opened(&self) -> bool {
        let is_same = Arc::ptr_eq(self.history.current(), &self.opened);
        is_same && !are_elsewhere(&self.sensors, &self.opened.sensors)
    }

    /// Whether there is something that no file holds.
    fn is_edited(&self) -> bool {
        self.history.is_changed() || are_elsewhere(&self.sensors, &self.saved_sensors)
    }

    /// What was saved counts as unedited from here on.
    pub(super) fn saved(&mut self) {
        self.history.mark_saved();
        self.saved_sensors.clone_from(&self.sensors);
        self.refresh_facts();
    }

    /// Moves the camera of a sensor.
    pub(super) fn gesture(&mut self, sensor: usize, gesture: Gesture) -> Result<Effect, String> {
        let camera = match self.camera.take() {
            Some((of, camera)) if of == sensor => camera,
            _ => Camera::new(&self.sensors[sensor], focus_distance(&self.scene, sensor)),
        };
        let mut moved = camera.clone();
        match gesture {
            Gesture::Orbit { yaw, pitch } => moved.orbit(yaw, pitch),
            Gesture::Turn { yaw, pitch } => moved.look(yaw, pitch),
            Gesture::Pan { right, down } => moved.pan(&self.sensors[sensor], right, down),
            Gesture::Zoom(factor) => moved.zoom(factor),
            Gesture::Fly { forward, right, up } => {
                let step = moved.distance;
                moved.fly(forward * step, right * step, up * step);
            }
            Gesture::FieldOfView(degrees) => moved.set_fov(degrees),
        }
        let before = self.sensors[sensor].clone();
        self.sensors[sensor] = moved.applied_to(&before);
        let result = self.see_anew();
        if result.is_err() {
            self.sensors[sensor] = before;
        }
        self.camera = Some((sensor, if result.is_err() { camera } else { moved }));
        result
    }

    /// Puts the camera back where the file has it.
    pub(super) fn reset_camera(&mut self, sensor: usize) -> Result<Effect, String> {
        self.camera = None;
        self.sensors[sensor].clone_from(&self.opened.sensors[sensor]);
        self.see_anew()
    }

    /// The scene under other sensors.
    fn see_anew(&mut self) -> Result<Effect, String> {
        let scene = self.scene.with_sensors(&self.sensors).map_err(|cause| cause.to_string())?;
        self.scene = Arc::new(scene);
        self.refresh();
        Ok(Effect::Anew)
    }

    /// Chooses what is seen at a film position; nothing where nothing is.
    pub(super) fn choose(&mut self, sensor: usize, film: Option<[f64; 2]>) {
        // A click is for what is seen now, however long that takes.
        if self.is_stale && self.build(&self.quit.clone()).is_err() {
            return;
        }
        let picked = film.and_then(|film| pick_any(&self.scene, &self.description, sensor, film));
        self.chosen = picked.map(|picked| Chosen {
            target: picked.target,
            outline: Outline::new(&self.description, picked.target),
            grip: DVec3::from(picked.position) - anchor(&self.description, picked.target).unwrap_or_default(),
            drag: None,
        });
    }

    /// Takes hold of what is chosen, at a film position.
    pub(super) fn begin_drag(&mut self, sensor: usize, film: [f64; 2], mode: DragMode) {
        let up = UpAxis::guess(&self.sensors[sensor]);
        let Some(chosen) = &mut self.chosen else { return };
        let picked = chosen.picked(&self.description).to_array();
        let plane = DragPlane::new(&self.sensors[sensor], up, picked, mode);
        chosen.drag = Some((plane, film));
        let name = Edit::Move { target: chosen.target, by: [0.0; 3] }.name(&self.description);
        self.history.begin(name);
    }

    /// Moves what is held to a film position, or the outline alone where the scene is large.
    pub(super) fn drag_to(&mut self, film: [f64; 2]) -> Result<Effect, String> {
        let Some(next) = self.dragged(film)? else { return Ok(Effect::None) };
        if self.scene.census().triangles <= MAX_LIVE_TRIANGLES {
            return self.take(next);
        }
        self.history.proceed(next);
        self.refresh();
        Ok(Effect::None)
    }

    /// Lets go at a film position; where no scene can be made of that, all is as it was.
    pub(super) fn end_drag(&mut self, film: [f64; 2]) -> Result<Effect, String> {
        let Some(next) = self.dragged(film)? else { return Ok(Effect::None) };
        let effect = self.take(next);
        if effect.is_err() {
            self.history.cancel();
            self.refresh();
        }
        self.history.commit();
        if let Some(chosen) = &mut self.chosen {
            chosen.drag = None;
        }
        self.refresh_facts();
        effect
    }

    /// The description with what is held at a film position.
    fn dragged(&self, film: [f64; 2]) -> Result<Option<SceneDescription>, String> {
        let Some(chosen) = &self.chosen else { return Ok(None) };
        let Some((plane, from)) = &chosen.drag else { return Ok(None) };
        let edit = Edit::Move { target: chosen.target, by: plane.translation(*from, film) };
        edit.apply(self.history.base()).map(Some).map_err(|cause| cause.to_string())
    }

    /// Puts what is held back.
    pub(super) fn cancel_drag(&mut self) -> Result<Effect, String> {
        if let Some(chosen) = &mut self.chosen {
            chosen.drag = None;
        }
        self.history.cancel();
        self.rebuild()
    }

    /// Moves what is chosen by steps of a few pixels, in the plane that `mode` says.
    pub(super) fn nudge(&mut self, sensor: usize, steps: [f64; 2], mode: DragMode) -> Result<Effect, String> {
        let Some(chosen) = &self.chosen else { return Ok(Effect::None) };
        let picked = chosen.picked(&self.description);
        let s = &self.sensors[sensor];
        let centre = DVec2::new(f64::from(s.width), f64::from(s.height)) * 0.5;
        let film = self.scene.sensors()[sensor]
            .project(self.scene.normalisation().point(picked))
            .map_or(centre, |(film, _)| film.as_dvec2());
        let plane = DragPlane::new(s, UpAxis::guess(s), picked.to_array(), mode);
        let by = plane.translation(film.to_array(), (film + DVec2::from(steps) * NUDGE).to_array());
        let edit = Edit::Move { target: chosen.target, by };
        self.edit(&edit)
    }

    /// Sets a field of what is chosen. A control that is still being dragged is not `done`: all of it is one step.
    pub(super) fn set_field(&mut self, field: FieldId, value: Value, done: bool) -> Result<Effect, String> {
        let Some(chosen) = &self.chosen else { return Ok(Effect::None) };
        let edit = Edit::SetField { target: chosen.target, field, value };
        let name = edit.name(self.history.base());
        if self.history.undo_name() != Some(&name) || !self.history.is_open() {
            self.history.begin(name);
        }
        let next = edit.apply(self.history.base()).map_err(|cause| cause.to_string());
        let effect = next.and_then(|next| self.take(next));
        if done || effect.is_err() {
            self.history.commit();
        }
        effect
    }

    /// Gives what is chosen a material of its own.
    pub(super) fn own_material(&mut self) -> Result<Effect, String> {
        match &self.chosen {
            Some(Chosen { target: Target::Shape(shape), .. }) => {
                self.edit(&Edit::OwnMaterial { shape: *shape })
            }
            _ => Ok(Effect::None),
        }
    }

    fn edit(&mut self, edit: &Edit) -> Result<Effect, String> {
        let next = edit.apply(self.history.current()).map_err(|cause| cause.to_string())?;
        self.history.begin(edit.name(&self.description));
        let effect = self.take(next);
        self.history.commit();
        self.refresh_facts();
        effect
    }

    pub(super) fn undo(&mut self) -> Result<Effect, String> {
        if self.history.undo().is_none() {
            return Ok(Effect::None);
        }
        self.rebuild()
    }

    pub(super) fn redo(&mut self) -> Result<Effect, String> {
        if self.history.redo().is_none() {
            return Ok(Effect::None);
        }
        self.rebuild()
    }

    /// Makes `next` the description under edit, unless no scene can be made of it.
    fn take(&mut self, next: SceneDescription) -> Result<Effect, String> {
        let whole = SceneDescription { sensors: self.sensors.clone(), ..next.clone() };
        let built = self.scene_of(&whole, &self.cancel)?;
        self.history.proceed(next);
        self.refresh();
        self.renew(built);
        Ok(Effect::Anew)
    }

    /// The scene of a description; `None` where building it was given up.
    fn scene_of(&self, description: &SceneDescription, cancel: &Cancel) -> Result<Option<Scene>, String> {
        let is_quick = description.primitives() < QUICK;
        let cancel = if is_quick { Cancel::default() } else { cancel.clone() };
        match Scene::build_with(description, &BuildOptions { cancel, ..BuildOptions::default() }) {
            Ok(scene) => Ok(Some(scene)),
            Err(BuildError::Cancelled(_)) => Ok(None),
            Err(cause) => Err(cause.to_string()),
        }
    }

    /// The scene is now that of the history's description, if it was built.
    fn renew(&mut self, built: Option<Scene>) {
        self.is_stale = built.is_none();
        if let Some(scene) = built {
            self.scene = Arc::new(scene);
            self.built = Arc::clone(self.history.current());
        }
    }

    /// Whether building the scene of an edit was given up: [`Stage::freshen`] does it.
    pub(super) const fn is_stale(&self) -> bool {
        self.is_stale
    }

    /// Builds the scene of an edit, if that was given up before. Whether there is one, or else it was given up again.
    ///
    /// # Errors
    /// When no scene can be made of it: edits since the last one of which one was made are then taken back.
    pub(super) fn freshen(&mut self) -> Result<bool, String> {
        let message = match self.build(&self.cancel.clone()) {
            Ok(()) => return Ok(!self.is_stale),
            Err(message) => message,
        };
        while !Arc::ptr_eq(self.history.current(), &self.built) && self.history.undo().is_some() {}
        self.rebuild()?;
        Err(message)
    }

    /// Builds the scene of the description as it is, unless that is given up.
    fn build(&mut self, cancel: &Cancel) -> Result<(), String> {
        let built = self.scene_of(&self.description, cancel)?;
        self.renew(built);
        Ok(())
    }

    /// The scene of the history's description.
    fn rebuild(&mut self) -> Result<Effect, String> {
        self.refresh();
        self.build(&self.cancel.clone())?;
        if let Some(chosen) = &mut self.chosen {
            chosen.outline = Outline::new(&self.description, chosen.target);
        }
        Ok(Effect::Anew)
    }

    fn refresh(&mut self) {
        let current = SceneDescription::clone(self.history.current());
        self.description = Arc::new(SceneDescription { sensors: self.sensors.clone(), ..current });
        self.refresh_facts();
    }

    fn refresh_facts(&mut self) {
        let sensor = |s: &SensorDescription| SensorFacts {
            name: s.name.clone(),
            fov_degrees: s.fov_degrees,
            size: [s.width, s.height],
            xml: camera_xml(s),
        };
        self.facts = Arc::new(SceneFacts {
            name: self.identity.name.clone(),
            file: self.source.file().cloned(),
            sensors: self.sensors.iter().map(sensor).collect(),
            shapes: self.description.shapes.len(),
            is_edited: self.is_edited(),
            undo: self.history.undo_name().map(str::to_owned),
            redo: self.history.redo_name().map(str::to_owned),
        });
    }

    /// What is chosen, as the window shows it.
    pub(super) fn selection(&self, sensor: usize) -> Option<Selection> {
        let chosen = self.chosen.as_ref()?;
        Some(Selection {
            target: chosen.target,
            inspection: inspect(&self.description, chosen.target)?,
            outline: chosen.outline.segments(&self.description, sensor),
        })
    }

    /// Where lights without a surface are.
    pub(super) fn light_markers(&self, sensor: usize) -> Vec<Segment> {
        markers(&self.description, sensor).into_iter().flat_map(|(_, marker)| marker).collect()
    }
}

#[cfg(test)]
#[path = "stage_tests.rs"]
mod tests;
