//! Edits as the window asks for them, and those that change which things a scene has.

use std::sync::Arc;

use foton_edit::{Edit, Make, Site, Target, UpAxis, anchor, focus_distance};
use foton_math::glam::DVec3;
use foton_scene::description::{Projection, SceneDescription};

use super::chosen::Chosen;
use super::sensors::standing;
use super::{EditableScene, Effect};
use crate::engine::command::SceneEdit;

/// How large a new thing is: its half, as a share of half the view.
const NEW_SIZE: f64 = 0.16;

/// How far a copy is from what it is of, as a share of its distance.
const BESIDE: f64 = 0.08;

impl EditableScene {
    /// Makes an edit, seen by a camera.
    pub(in crate::engine) fn obey(&mut self, sensor: usize, edit: SceneEdit) -> Result<Effect, String> {
        match edit {
            SceneEdit::BeginDrag { handle, film, reach } => {
                self.begin_drag(sensor, handle, film, reach);
                Ok(Effect::None)
            }
            SceneEdit::DragTo { film, snap } => self.drag_to(film, snap),
            SceneEdit::EndDrag { film, snap } => self.end_drag(film, snap),
            SceneEdit::CancelDrag => self.cancel_drag(),
            SceneEdit::Nudge { steps, mode } => self.nudge(sensor, steps, mode),
            SceneEdit::AimAt(film) => self.aim_at(sensor, film),
            SceneEdit::SetField { field, value, done } => self.set_field(field, value, done),
            SceneEdit::OwnMaterial => self.own_material(),
            SceneEdit::Remake { make, name, all } => self.remake(make, name, all),
            SceneEdit::Rename { target, name } => self.rename(target, name),
            SceneEdit::Hide { target, hide } => self.restructure(&Edit::Hide { target, hide }),
            SceneEdit::Duplicate(target) => {
                let by = self.beside(sensor, target).to_array();
                self.restructure(&Edit::Duplicate { target, by })
            }
            SceneEdit::Delete(target) => self.restructure(&Edit::Delete(target)),
            SceneEdit::Add(thing) => {
                let site = self.site(sensor);
                self.restructure(&Edit::Add { thing, site })
            }
            // Read first, on a thread of its own.
            SceneEdit::Import(_) => Ok(Effect::None),
            SceneEdit::Undo => self.undo(),
            SceneEdit::Redo => self.redo(),
        }
    }

    /// Makes an edit of which things there are, in a step of its own. What it made is selected; what was selected stays selected, if it
    /// is still there.
    pub(super) fn restructure(&mut self, edit: &Edit) -> Result<Effect, String> {
        let before = Arc::clone(&self.description);
        let (next, made) = edit.apply_and_select(&before).map_err(|cause| cause.to_string())?;
        let sensors = std::mem::replace(&mut self.sensors, next.sensors.clone());
        self.history.begin(edit.name(&before));
        let effect = self.take(next);
        if effect.is_err() {
            self.sensors = sensors;
            self.history.cancel();
            self.refresh();
            return effect;
        }
        self.history.commit();
        if sensors.len() != self.sensors.len() {
            self.moved = None;
        }
        self.refresh_facts();
        self.chosen = match made {
            Some(target) => Some(Chosen::new(&self.description, target, None)),
            None => self.chosen.take().and_then(|chosen| chosen.found_in(&before, &self.description)),
        };
        effect
    }

    /// Another name is no other picture: nothing is built and the render goes on.
    fn rename(&mut self, target: Target, name: String) -> Result<Effect, String> {
        if self.is_stale {
            return self.restructure(&Edit::Rename { target, name });
        }
        let (before, edit) = (Arc::clone(&self.description), Edit::Rename { target, name });
        let next = edit.apply(&before).map_err(|cause| cause.to_string())?;
        self.sensors.clone_from(&next.sensors);
        self.history.record_naming(edit.name(&before), next);
        Ok(self.renamed())
    }

    /// Takes names that the history has now.
    pub(super) fn renamed(&mut self) -> Effect {
        let before = Arc::clone(&self.description);
        self.sensors = standing(&self.history.current().sensors, &self.sensors);
        self.built = Arc::clone(self.history.current());
        self.refresh();
        self.chosen = self.chosen.take().and_then(|chosen| chosen.found_in(&before, &self.description));
        Effect::None
    }

    fn remake(&mut self, make: Make, name: String, all: bool) -> Result<Effect, String> {
        match self.chosen.as_ref().map(|c| c.target) {
            Some(Target::Shape(shape)) => self.edit(&Edit::Remake { shape, make, name, all }),
            _ => Ok(Effect::None),
        }
    }

    /// Adds the shapes of a model, by the name of its file.
    pub(in crate::engine) fn import(
        &mut self,
        sensor: usize,
        name: String,
        from: Arc<SceneDescription>,
    ) -> Result<Effect, String> {
        let site = self.site(sensor);
        self.restructure(&Edit::Import { name, from, site })
    }

    /// Where a new thing goes: what is in the middle of the image.
    fn site(&self, sensor: usize) -> Site {
        let seen = &self.sensors[sensor];
        let distance = focus_distance(&self.scene, sensor);
        let forward = seen.to_world.matrix3.z_axis.normalize_or(DVec3::Z);
        let half = NEW_SIZE
            * match seen.projection {
                Projection::Perspective => distance * (0.5 * seen.fov_degrees.to_radians()).tan(),
                Projection::Orthographic => seen.to_world.matrix3.x_axis.length(),
            };
        Site {
            at: (seen.to_world.translation + forward * distance).to_array(),
            half,
            up: UpAxis::guess(seen),
        }
    }

    /// From a thing to where its copy goes: to the right in the image.
    fn beside(&self, sensor: usize, target: Target) -> DVec3 {
        let seen = &self.sensors[sensor].to_world;
        let Some(middle) = anchor(&self.description, target) else { return DVec3::ZERO };
        let right = -seen.matrix3.x_axis.normalize_or(DVec3::X);
        let reach = match self.sensors[sensor].projection {
            Projection::Perspective => middle.distance(seen.translation),
            Projection::Orthographic => 2.0 * seen.matrix3.x_axis.length(),
        };
        right * (reach * BESIDE)
    }
}
