//! The scene of the view: its description with edits, the camera, what is chosen, and the scene built from them.

mod build;
mod chosen;
mod edits;
mod returning;
mod selection;
mod sensors;
#[cfg(test)]
mod tests;

use std::any::Any;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use foton_edit::{Camera, History, Item, Target, camera_xml, contents, focus_distance};
use foton_scene::Scene;
use foton_scene::description::{Crop, Projection, SceneDescription, SensorDescription};

use self::chosen::Chosen;
use super::cancels::Cancels;
use super::command::Source;
use super::frame::{SceneFacts, Selection, SensorFacts};
use super::gesture::Gesture;
use super::loader::{Ready, SavedScene};
use crate::metadata::SceneIdentity;

/// What a change asks of the render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effect {
    /// Nothing.
    None,
    /// Another scene is there: restart.
    Restart,
}

/// What is rendered: the same state is the same scene, seen from the same place.
#[derive(Clone)]
pub(super) struct SceneState {
    description: Arc<SceneDescription>,
    sensors: Vec<SensorDescription>,
}

impl PartialEq for SceneState {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.description, &other.description) && self.sensors == other.sensors
    }
}

/// What a selection is of: the description, the thing, and the camera that sees it.
type Shown = (Arc<SceneDescription>, Target, usize);

/// The camera of a sensor that was moved.
struct MovedCamera {
    /// Index of the sensor.
    sensor: usize,
    camera: Camera,
}

/// Whether any camera stands, spans or focuses otherwise.
fn are_elsewhere(sensors: &[SensorDescription], others: &[SensorDescription]) -> bool {
    let place = |s: &SensorDescription| (s.to_world, s.fov_degrees, s.lens);
    sensors.iter().map(place).ne(others.iter().map(place))
}

/// A scene under edit.
pub(super) struct EditableScene {
    source: Source,
    /// What the scene was read from.
    pub(super) files: Vec<PathBuf>,
    /// What the loader wants back when the scene is saved.
    pub(super) origin: Arc<dyn Any + Send + Sync>,
    identity: SceneIdentity,
    history: History,
    /// Cameras are no steps of the history: undoing a move does not turn the head.
    sensors: Vec<SensorDescription>,
    /// The history's description that the identity's hash is of: that of the file that was opened or saved last.
    opened: Arc<SceneDescription>,
    /// The sensors of that file: where cameras are reset to.
    opened_sensors: Vec<SensorDescription>,
    /// Those that were saved last.
    saved_sensors: Vec<SensorDescription>,
    /// The part of the image that is rendered, and of which sensor.
    region: Option<(usize, Crop)>,
    /// The camera of a sensor, once it was moved.
    moved: Option<MovedCamera>,
    chosen: Option<Chosen>,
    /// The selection as frames have it, and what it is of: the description, the thing and the camera.
    shown: RefCell<Option<(Shown, Selection)>>,
    /// The history's description with the sensors as they are.
    description: Arc<SceneDescription>,
    scene: Arc<Scene>,
    /// The history's description that the scene was built of, unless building a newer one was given up.
    built: Arc<SceneDescription>,
    /// Whether the scene is older than the description.
    is_stale: bool,
    cancels: Cancels,
    warnings: Arc<Vec<String>>,
    facts: Arc<SceneFacts>,
}

impl EditableScene {
    pub(super) fn new(ready: Ready, cancels: Cancels) -> Self {
        let warnings = Arc::new(ready.warnings());
        let Ready { source, loaded, scene, .. } = ready;
        let description = Arc::new(loaded.description);
        let sensors = description.sensors.clone();
        let mut new = Self {
            source,
            identity: loaded.identity,
            files: loaded.files,
            origin: loaded.origin,
            history: History::new(Arc::clone(&description)),
            opened: Arc::clone(&description),
            opened_sensors: sensors.clone(),
            saved_sensors: sensors.clone(),
            sensors,
            region: None,
            moved: None,
            chosen: None,
            shown: RefCell::default(),
            description: Arc::clone(&description),
            scene,
            built: Arc::clone(&description),
            is_stale: false,
            cancels,
            warnings,
            facts: Arc::default(),
        };
        new.refresh_facts();
        new
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

    /// What is rendered, for comparison with what it was before or is afterwards; `None` while that is still to be built.
    pub(super) fn state(&self) -> Option<SceneState> {
        let state = || SceneState { description: Arc::clone(&self.built), sensors: self.sensors.clone() };
        (!self.is_stale).then(state)
    }

    /// The scene's name and hash; the name says if it is not as in the file that was opened or saved last.
    pub(super) fn identity(&self) -> SceneIdentity {
        let mut identity = self.identity.clone();
        if !self.is_as_opened() {
            identity.name.push_str(" (edited)");
        }
        identity
    }

    /// Whether what is seen is what the file says that was opened or saved last.
    pub(super) fn is_as_opened(&self) -> bool {
        let is_same = Arc::ptr_eq(self.history.current(), &self.opened);
        is_same && !are_elsewhere(&self.sensors, &self.opened_sensors)
    }

    /// Whether there is something that no file holds.
    fn is_edited(&self) -> bool {
        self.history.is_changed() || are_elsewhere(&self.sensors, &self.saved_sensors)
    }

    /// What was saved is the scene's file from here on, and what is seen is unedited.
    pub(super) fn saved(&mut self, path: &Path, saved: SavedScene) {
        self.history.mark_saved();
        self.saved_sensors.clone_from(&self.sensors);
        if let Some(reopened) = saved.reopened {
            self.opened = Arc::clone(self.history.current());
            self.opened_sensors.clone_from(&self.sensors);
            self.source = Source::File(path.to_owned());
            self.identity = reopened.identity;
            self.files = reopened.files;
            self.origin = reopened.origin;
        }
        self.refresh_facts();
    }

    /// Moves the camera of a sensor.
    pub(super) fn gesture(&mut self, sensor: usize, gesture: Gesture) -> Result<Effect, String> {
        let camera = match self.moved.take() {
            Some(moved) if moved.sensor == sensor => moved.camera,
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
            Gesture::Width(width) => moved.set_width(width),
            Gesture::Face(side) => moved.face(side),
            Gesture::Aperture(radius) => moved.set_aperture(radius),
            Gesture::FocusDistance(distance) => moved.set_focus(distance),
            Gesture::FocusAt(film) => match self.depth_at(sensor, film) {
                Some(depth) => moved.set_focus(depth),
                None => {
                    self.moved = Some(MovedCamera { sensor, camera });
                    return Err("there is nothing to focus on".to_owned());
                }
            },
        }
        let before = self.sensors[sensor].clone();
        self.sensors[sensor] = moved.applied_to(&before);
        let result = self.renew_sensors();
        if result.is_err() {
            self.sensors[sensor] = before;
        }
        let camera = if result.is_err() { camera } else { moved };
        self.moved = Some(MovedCamera { sensor, camera });
        result
    }

    /// Puts the camera back where the file has it.
    pub(super) fn reset_camera(&mut self, sensor: usize) -> Result<Effect, String> {
        self.moved = None;
        self.reset_sensor(sensor);
        self.renew_sensors()
    }

    /// Renders a part of a sensor's image alone, or all that the file asks for.
    pub(super) fn set_region(&mut self, region: Option<(usize, Crop)>) -> Result<Effect, String> {
        let before = std::mem::replace(&mut self.region, region);
        if before == region {
            return Ok(Effect::None);
        }
        let check = region.map_or(Ok(()), |(sensor, region)| self.sensors[sensor].clone().show_only(region));
        let renewed = check.and_then(|()| self.renew_sensors());
        if renewed.is_err() {
            self.region = before;
        }
        renewed
    }

    /// The part of the image that is rendered, if a person has chosen one.
    pub(super) fn region(&self) -> Option<Crop> {
        self.region.map(|(_, region)| region)
    }

    /// The sensors as they are rendered. The region is no part of the scene: it is saved in no file.
    pub(super) fn rendered_sensors(&self) -> Vec<SensorDescription> {
        let mut sensors = self.sensors.clone();
        if let Some((sensor, region)) = self.region
            && let Some(sensor) = sensors.get_mut(sensor)
        {
            // An image that was made smaller is rendered whole where the region is no longer inside.
            let _ = sensor.show_only(region);
        }
        sensors
    }

    /// The same scene with the sensors as they are now.
    fn renew_sensors(&mut self) -> Result<Effect, String> {
        let scene = self.scene.with_sensors(&self.rendered_sensors()).map_err(|cause| cause.to_string())?;
        self.scene = Arc::new(scene);
        self.refresh();
        Ok(Effect::Restart)
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
            width: (s.projection == Projection::Orthographic)
                .then(|| 2.0 * s.to_world.matrix3.x_axis.length()),
            lens: s.lens,
            size: [s.width, s.height],
            xml: camera_xml(s),
        };
        self.facts = Arc::new(SceneFacts {
            name: self.identity.name.clone(),
            title: self.source.title(),
            file: self.source.file().cloned(),
            sensors: self.sensors.iter().map(sensor).collect(),
            shapes: self.description.shapes.len(),
            radius: self.radius(),
            contents: self.listed(),
            is_edited: self.is_edited(),
            warnings: Arc::clone(&self.warnings),
            is_unsaved: self.history.is_changed(),
            undo: self.history.undo_name().map(str::to_owned),
            redo: self.history.redo_name().map(str::to_owned),
        });
    }

    /// The list of all things; the one that frames have already, where it is the same.
    fn listed(&self) -> Arc<Vec<Item>> {
        let now = contents(&self.description);
        if *self.facts.contents == now { Arc::clone(&self.facts.contents) } else { Arc::new(now) }
    }
}
