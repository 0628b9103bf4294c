//! Finds what lies in one another when a scene is built.

use foton_math::Cancelled;
use foton_math::glam::DVec3;
use rayon::prelude::*;

use super::sheet::{Face, Sheet, coincide, tolerance};
use crate::build::{BuildOptions, BuildStep};
use crate::primitive::Primitive;
use crate::scene::Scene;

use super::share::{Coincidences, MAX_NEAR, Share};

/// The largest number of partners that are recorded for a primitive.
const MAX_PARTNERS: usize = 16;

impl Coincidences {
    /// Finds all pairs.
    pub(crate) fn find(scene: &Scene, options: &BuildOptions<'_>) -> Result<Self, Cancelled> {
        let accel = &scene.accel;
        let primitives = accel.primitives();
        let gauge = options.step(BuildStep::Coincidences, primitives.len());
        // Each is asked for by all that lies near it.
        let normals: Vec<DVec3> = primitives.par_iter().map(Face::normal_of).collect();
        let face = |i: usize| Face::of(&primitives[i], normals[i]);
        gauge.check()?;
        let mut pairs: Vec<[u32; 2]> = (0..primitives.len())
            .into_par_iter()
            .filter(|&i| gauge.item(i).is_ok() && gauge.check().is_ok())
            .flat_map_iter(|i| {
                let (mut partners, own) = (Vec::new(), face(i));
                // A small face on a large floor is found from its own side, whatever else lies near the floor.
                accel.for_each_near(&primitives[i].bounds(), MAX_NEAR, |j| {
                    if j != i && partners.len() < MAX_PARTNERS && coincide(&own, &face(j)) {
                        partners.push([i.min(j) as u32, i.max(j) as u32]);
                    }
                });
                partners
            })
            .collect();
        drop(normals);
        gauge.check()?;
        pairs.par_sort_unstable();
        pairs.dedup();
        let contacts: Vec<Contact> = (0..accel.instances().len())
            .into_par_iter()
            .filter(|_| gauge.check().is_ok())
            .flat_map_iter(|i| contacts(scene, i))
            .collect();
        gauge.check()?;
        if pairs.is_empty() && contacts.is_empty() {
            return Ok(Self::default());
        }
        let mut found = Self {
            shared: vec![Share::default(); primitives.len()],
            instances: vec![false; accel.instances().len()],
            shapes: Vec::with_capacity(pairs.len()),
            gaps: vec![0f32; scene.shapes.len()],
        };
        for (number, pair) in pairs.into_iter().enumerate() {
            gauge.item(number)?;
            found.enter(scene, pair);
        }
        for contact in contacts {
            found.instances[contact.instance] = true;
            found.shared[contact.primitive] = Share::UNSETTLED;
            let own = accel.instances()[contact.instance].primitive(contact.triangle);
            let shapes = [scene.parts[contact.primitive].shape, accel.instances()[contact.instance].shape];
            found.enter_shapes(shapes, &primitives[contact.primitive], &own);
        }
        found.shapes.sort_unstable();
        found.shapes.dedup();
        found.shapes.retain(|([a, b], _)| a != b);
        Ok(found)
    }

    /// Enters a pair of the scene's own primitives.
    fn enter(&mut self, scene: &Scene, pair: [u32; 2]) {
        let [first, second] = pair.map(|i| &scene.accel.primitives()[i as usize]);
        let agree = self.enter_shapes(pair.map(|i| scene.shape_of(i)), first, second);
        let [a, b] = pair;
        for (i, other) in [(a, b), (b, a)] {
            let share = &mut self.shared[i as usize];
            share.any = true;
            for outward in [false, true] {
                share.unsettled[usize::from(outward)] |= !scene.counts(i, other, outward, agree);
            }
        }
    }

    /// Enters that two shapes lie in one another by these primitives; whether those face the same way.
    fn enter_shapes(&mut self, shapes: [u32; 2], a: &Primitive, b: &Primitive) -> bool {
        let gap = 2.0 * tolerance(a, b) as f32;
        let normal = |p: &Primitive| Sheet::of(p, p.bounds().max.as_dvec3()).normal;
        let agree = normal(a).dot(normal(b)) > 0.0;
        let mut pair = shapes;
        pair.sort_unstable();
        for shape in pair {
            let known = &mut self.gaps[shape as usize];
            *known = known.max(gap);
        }
        self.shapes.push((pair, agree));
        agree
    }
}

/// A primitive of the scene's own that an instance lies in.
struct Contact {
    instance: usize,
    /// In the instance's tree.
    triangle: usize,
    primitive: usize,
}

/// The scene's own primitives that an instance lies in, each once: by the first of its triangles that does. Instances that lie in each
/// other are not looked for.
fn contacts(scene: &Scene, instance: usize) -> Vec<Contact> {
    let placed = &scene.accel.instances()[instance];
    let mut found = Vec::new();
    scene.accel.for_each_near(&placed.bounds, MAX_NEAR, |primitive| {
        let other = &scene.accel.primitives()[primitive];
        let face = Face::of(other, Face::normal_of(other));
        let (mut left, mut first) = (MAX_NEAR, None);
        placed.for_each_near(&other.bounds(), &mut left, |triangle| {
            let own = placed.primitive(triangle);
            if first.is_none() && coincide(&Face::of(&own, Face::normal_of(&own)), &face) {
                first = Some(triangle);
            }
        });
        found.extend(first.map(|triangle| Contact { instance, triangle, primitive }));
    });
    found
}
