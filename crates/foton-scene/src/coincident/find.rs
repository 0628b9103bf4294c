//! Finds what lies in one another when a scene is built.

use foton_math::Cancelled;
use foton_math::glam::DVec3;
use rayon::prelude::*;

use super::sheet::{Face, Sheet, coincide, tolerance};
use crate::build::{BuildOptions, BuildStep};
use crate::scene::Scene;

use super::share::{Coincidences, MAX_NEAR, Share};

/// The largest number of partners that are recorded for a primitive.
const MAX_PARTNERS: usize = 16;

impl Coincidences {
    /// Finds all pairs.
    pub(crate) fn find(scene: &Scene, options: &BuildOptions<'_>) -> Result<Self, Cancelled> {
        let accel = &scene.accel;
        let (primitives, shape_of) = (accel.primitives(), |i: usize| scene.shape_of(i));
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
        if pairs.is_empty() {
            return Ok(Self::default());
        }
        let count = scene.shapes.len();
        let (mut shared, mut gaps) = (vec![Share::default(); primitives.len()], vec![0f32; count]);
        let mut shapes = Vec::with_capacity(pairs.len());
        for (number, pair) in pairs.into_iter().enumerate() {
            gauge.item(number)?;
            let [a, b] = pair.map(|i| i as usize);
            let gap = 2.0 * tolerance(&primitives[a], &primitives[b]) as f32;
            let normal = |i: usize| Sheet::of(&primitives[i], primitives[i].bounds().max.as_dvec3()).normal;
            let agree = normal(a).dot(normal(b)) > 0.0;
            for (i, other) in [(a, b), (b, a)] {
                shared[i].any = true;
                for outward in [false, true] {
                    shared[i].unsettled[usize::from(outward)] |= !scene.counts(i, other, outward, agree);
                }
                gaps[shape_of(i) as usize] = gaps[shape_of(i) as usize].max(gap);
            }
            let mut pair = pair.map(|i| shape_of(i as usize));
            pair.sort_unstable();
            shapes.push((pair, agree));
        }
        shapes.sort_unstable();
        shapes.dedup();
        shapes.retain(|([a, b], _)| a != b);
        Ok(Self { shared, shapes, gaps })
    }
}
