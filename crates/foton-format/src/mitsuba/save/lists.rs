//! The lists of a scene in its document: what is still there and how it changed, what is new, what is gone.

use super::changes::Changes;
use super::pairs::Pairs;
use super::same;
use super::tree::Obstacle;
use crate::mitsuba::document::NodeId;

impl Changes<'_> {
    pub(super) fn sensors(&mut self, pairs: &Pairs) -> Result<(), Obstacle> {
        let (old, new) = (self.old, self.edited);
        let node = |changes: &Self, i: usize| {
            changes.own(changes.scene.nodes.sensors.get(i).copied(), "sensor", &old.sensors[i].name)
        };
        for (i, (pair, new)) in pairs.0.iter().zip(&new.sensors).enumerate() {
            let Some(was) = pair.map(|was| (was, &old.sensors[was])) else {
                self.add_sensor(new)?;
                continue;
            };
            if !same::same_sensor(was.1, new) {
                let node = node(self, was.0)?;
                self.sensor(node, was.1, new)?;
            }
            let number = if i == 0 { "sensor".to_owned() } else { format!("sensor-{}", i + 1) };
            self.name(
                self.scene.nodes.sensors.get(was.0).copied(),
                "sensor",
                (&number, &was.1.name),
                &new.name,
            )?;
        }
        for gone in pairs.gone(old.sensors.len()) {
            let node = node(self, gone)?;
            self.document.remove_element(node);
        }
        Ok(())
    }

    pub(super) fn shapes(&mut self, pairs: &Pairs) -> Result<(), Obstacle> {
        let (old, new) = (self.old, self.edited);
        for (i, (pair, shape)) in pairs.0.iter().zip(&new.shapes).enumerate() {
            let is_hidden = new.hidden.shapes.contains(&i);
            let Some(was) = *pair else {
                let node = self.add_shape(shape)?;
                self.document.set_hidden(node, is_hidden)?;
                continue;
            };
            let node = self.scene.nodes.shapes.get(was).copied();
            self.shape(node, &old.shapes[was], shape)?;
            self.name(node, "shape", (&format!("shape-{}", i + 1), &old.shapes[was].name), &shape.name)?;
            if old.hidden.shapes.contains(&was) != is_hidden {
                let node = self.own(node, "shape", &shape.name)?;
                self.document.set_hidden(node, is_hidden)?;
            }
        }
        for gone in pairs.gone(old.shapes.len()) {
            let node =
                self.own(self.scene.nodes.shapes.get(gone).copied(), "shape", &old.shapes[gone].name)?;
            self.document.remove_element(node);
        }
        Ok(())
    }

    pub(super) fn emitters(&mut self, pairs: &Pairs) -> Result<(), Obstacle> {
        let (old, new) = (self.old, self.edited);
        for (i, (pair, emitter)) in pairs.0.iter().zip(&new.emitters).enumerate() {
            let is_hidden = new.hidden.emitters.contains(&i);
            let Some(was) = *pair else {
                let node = self.add_emitter(emitter)?;
                self.document.set_hidden(node, is_hidden)?;
                continue;
            };
            let (node, before) = (self.scene.nodes.emitters.get(was).copied(), &old.emitters[was]);
            if !same::same_emitter((old, &before.kind), (new, &emitter.kind)) {
                let node = self.own(node, "emitter", &before.name)?;
                self.emitter(node, &before.kind, &emitter.kind)?;
            }
            let plugin =
                node.and_then(|n| self.document.element(n)?.attribute("type").map(|a| a.value.clone()));
            let number = format!("{}-{}", plugin.unwrap_or_default(), i + 1);
            self.name(node, "emitter", (&number, &before.name), &emitter.name)?;
            if old.hidden.emitters.contains(&was) != is_hidden {
                let node = self.own(node, "emitter", &emitter.name)?;
                self.document.set_hidden(node, is_hidden)?;
            }
        }
        for gone in pairs.gone(old.emitters.len()) {
            let node = self.scene.nodes.emitters.get(gone).copied();
            let node = self.own(node, "emitter", &old.emitters[gone].name)?;
            self.document.remove_element(node);
        }
        Ok(())
    }

    /// Gives an element its name, if it would be read under another one: one that has an id under its `old` name, others under their
    /// number.
    fn name(
        &mut self,
        node: Option<NodeId>,
        tag: &str,
        (number, old): (&str, &str),
        name: &str,
    ) -> Result<(), Obstacle> {
        let element = node.and_then(|n| self.document.element(n)).filter(|e| e.name == tag);
        // Those of included files keep theirs.
        let Some((node, element)) = node.zip(element) else { return Ok(()) };
        let read = if element.attribute("id").is_some() { old } else { number };
        if read != name {
            self.document.set_attribute(node, "id", &name.replace('$', "\\$"));
        }
        Ok(())
    }
}
