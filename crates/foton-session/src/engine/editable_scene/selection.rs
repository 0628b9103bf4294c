//! What is selected in a scene, and what a person does to it: drags, steps of keys, fields, undo.

use std::sync::Arc;

use foton_edit::{
    DragMode, Edit, FieldId, Gizmo, Handle, Pull, Segment, Target, UpAxis, Value, inspect, markers, nudge,
    pick, pick_any,
};
use foton_math::glam::DVec3;
use foton_scene::description::SceneDescription;

use super::chosen::{Chosen, Drag};
use super::{EditableScene, Effect};
use crate::engine::frame::Selection;

/// A step of an arrow key, in pixels at the distance of what is chosen.
const NUDGE: f64 = 4.0;

/// Scenes of more triangles take too long to be built for every move of a hand: the outline goes with it, and the picture
/// follows when it lets go.
const MAX_LIVE_TRIANGLES: u64 = 100_000;

impl EditableScene {
    /// Selects what is seen at a film position; nothing where nothing is.
    pub(in crate::engine) fn choose(&mut self, sensor: usize, film: Option<[f64; 2]>) {
        // A click is for what is seen now, however long that takes.
        if self.is_stale && self.build(&self.cancels.quit.clone()).is_err() {
            return;
        }
        let picked = film.and_then(|film| pick_any(&self.scene, &self.description, sensor, film));
        self.chosen = picked.map(|p| Chosen::new(&self.description, p.target, Some(DVec3::from(p.position))));
    }

    /// Selects a shape, light or camera, if it is there.
    pub(in crate::engine) fn select(&mut self, target: Option<Target>) {
        let there = target.filter(|target| inspect(&self.description, *target).is_some());
        self.shown.take();
        self.chosen = there.map(|target| Chosen::new(&self.description, target, None));
    }

    fn gizmo(&self, chosen: &Chosen, sensor: usize) -> Option<Gizmo> {
        let picked = Some(chosen.picked(&self.description));
        Gizmo::new(&self.description, chosen.target, sensor, picked)
    }

    /// Takes hold of a handle of what is selected, at a film position.
    pub(super) fn begin_drag(&mut self, sensor: usize, handle: Handle, film: [f64; 2], reach: f64) {
        let Some(chosen) = &self.chosen else { return };
        let Some(gizmo) = self.gizmo(chosen, sensor) else { return };
        let (target, pull) = (chosen.target, Pull::new(gizmo, handle, film, reach));
        let name = pull.edit(target, film, false).name(&self.description);
        self.history.begin(name);
        if let Some(chosen) = &mut self.chosen {
            chosen.drag = Some(Drag { pull, words: String::new() });
        }
    }

    /// Drags what is held to a film position, or its outline alone where the scene is large.
    pub(super) fn drag_to(&mut self, film: [f64; 2], snap: bool) -> Result<Effect, String> {
        let Some(next) = self.dragged(film, snap)? else { return Ok(Effect::None) };
        if self.scene.census().triangles <= MAX_LIVE_TRIANGLES {
            return self.take(next);
        }
        self.history.proceed(next);
        self.refresh();
        Ok(Effect::None)
    }

    /// Lets go at a film position; where no scene can be made of that, all is as it was.
    pub(super) fn end_drag(&mut self, film: [f64; 2], snap: bool) -> Result<Effect, String> {
        let drag = self.chosen.as_ref().and_then(|c| Some((c.target, c.drag.as_ref()?.pull)));
        let Some((target, pull)) = drag else { return Ok(Effect::None) };
        if pull.edit(target, film, snap).is_nothing() {
            return self.cancel_drag();
        }
        let Some(next) = self.dragged(film, snap)? else { return Ok(Effect::None) };
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

    /// The description with what is held dragged to a film position.
    fn dragged(&mut self, film: [f64; 2], snap: bool) -> Result<Option<SceneDescription>, String> {
        let Some(chosen) = &mut self.chosen else { return Ok(None) };
        let Some(Drag { pull, words }) = &mut chosen.drag else { return Ok(None) };
        *words = pull.words(film, snap);
        let edit = pull.edit(chosen.target, film, snap);
        edit.apply(self.history.base()).map(Some).map_err(|cause| cause.to_string())
    }

    /// Turns the selected light to what is seen at a film position.
    pub(super) fn aim_at(&mut self, sensor: usize, film: [f64; 2]) -> Result<Effect, String> {
        let Some(target) = self.chosen.as_ref().map(|c| c.target) else { return Ok(Effect::None) };
        let seen = pick(&self.scene, sensor, film).ok_or("there is nothing to aim at")?;
        self.edit(&Edit::Aim { target, at: seen.position })
    }

    /// Puts what is held back.
    pub(super) fn cancel_drag(&mut self) -> Result<Effect, String> {
        if let Some(chosen) = &mut self.chosen {
            chosen.drag = None;
        }
        let is_as_before = Arc::ptr_eq(self.history.base(), self.history.current());
        self.history.cancel();
        if is_as_before {
            self.refresh_facts();
            return Ok(Effect::None);
        }
        self.rebuild()
    }

    /// Moves what is chosen by steps of a few pixels, which way `mode` says.
    pub(super) fn nudge(&mut self, sensor: usize, steps: [f64; 2], mode: DragMode) -> Result<Effect, String> {
        let Some(chosen) = &self.chosen else { return Ok(Effect::None) };
        let picked = chosen.picked(&self.description).to_array();
        let s = &self.sensors[sensor];
        let by = nudge(s, UpAxis::guess(s), picked, steps.map(|n| n * NUDGE), mode);
        let edit = Edit::Move { target: chosen.target, by };
        self.edit(&edit)
    }

    /// Sets a field of what is chosen. A control that is still being dragged is not `done`: all of it is one step.
    pub(super) fn set_field(&mut self, field: FieldId, value: Value, done: bool) -> Result<Effect, String> {
        let Some(chosen) = &self.chosen else { return Ok(Effect::None) };
        let edit = Edit::SetField { target: chosen.target, field, value };
        if matches!(chosen.target, Target::Sensor(_)) {
            return self.restructure(&edit);
        }
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

    pub(super) fn edit(&mut self, edit: &Edit) -> Result<Effect, String> {
        let next = edit.apply(self.history.current()).map_err(|cause| cause.to_string())?;
        self.history.begin(edit.name(&self.description));
        let effect = self.take(next);
        self.history.commit();
        self.refresh_facts();
        effect
    }

    /// Takes the last step back.
    pub(super) fn undo(&mut self) -> Result<Effect, String> {
        let keeps_picture = !self.is_stale && self.history.undoes_naming();
        if self.history.undo().is_none() {
            return Ok(Effect::None);
        }
        if keeps_picture { Ok(self.renamed()) } else { self.rebuild() }
    }

    /// Makes the step again that was taken back last.
    pub(super) fn redo(&mut self) -> Result<Effect, String> {
        let keeps_picture = !self.is_stale && self.history.redoes_naming();
        if self.history.redo().is_none() {
            return Ok(Effect::None);
        }
        if keeps_picture { Ok(self.renamed()) } else { self.rebuild() }
    }

    /// What is selected, as the window shows it. Frames ask for it often, and sizes of large meshes take a while: it is made again only
    /// where something changed.
    pub(in crate::engine) fn selection(&self, sensor: usize) -> Option<Selection> {
        let chosen = self.chosen.as_ref()?;
        let words = chosen.drag.as_ref().map(|d| d.words.clone()).filter(|words| !words.is_empty());
        let key = (Arc::clone(&self.description), chosen.target, sensor);
        let mut shown = self.shown.borrow_mut();
        let is_known = shown
            .as_ref()
            .is_some_and(|(known, _)| Arc::ptr_eq(&known.0, &key.0) && (known.1, known.2) == (key.1, key.2));
        if !is_known {
            let selection = Selection {
                target: chosen.target,
                inspection: inspect(&self.description, chosen.target)?,
                outline: chosen.outline.segments(&self.description, sensor),
                gizmo: self.gizmo(chosen, sensor),
                drag: None,
            };
            *shown = Some((key, selection));
        }
        shown.as_ref().map(|(_, selection)| Selection { drag: words, ..selection.clone() })
    }

    /// Where lights without a surface are.
    pub(in crate::engine) fn light_markers(&self, sensor: usize) -> Vec<Segment> {
        markers(&self.description, sensor).into_iter().flat_map(|(_, marker)| marker).collect()
    }
}
