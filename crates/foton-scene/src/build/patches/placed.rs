//! Patches of instances: those of the tree that they share, under other numbers at each place, and joined with what continues them there.

use std::collections::HashMap;

use foton_math::{Aabb, Cancelled};
use rayon::prelude::*;

use super::number::{LARGEST, Member, NUMBERS, Patch, along_curve};
use super::probe::{Continuation, probed};
use super::sets::Sets;
use crate::accel::Accel;
use crate::build::gauge::Gauge;
use crate::plane::triangle_normal;

/// Numbers that instances share.
const SHARED: usize = NUMBERS - LARGEST;

/// Free edges of instances that are probed: a forest of leaves has millions that continue nothing. Of more, none is.
const MAX_PROBED: usize = 1 << 17;

/// The patches of one instance.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlacedPatches {
    /// Whether it stores photons at all.
    stores: bool,
    /// What is added to the numbers in the tree.
    shift: u8,
    /// Patches that something continues at this place, by their number in the tree: what they are part of.
    joined: Vec<(u8, Patch)>,
}

impl PlacedPatches {
    /// What a triangle belongs to that has a patch in the tree.
    #[inline]
    pub(crate) fn of(&self, in_tree: Patch) -> Patch {
        if !self.stores {
            return Patch::default();
        }
        let turned = in_tree.key & 1;
        if let Some((_, patch)) = self.joined.iter().find(|(number, _)| *number == in_tree.key >> 1) {
            return Patch { key: patch.key ^ turned, ..*patch };
        }
        let number = usize::from(in_tree.key >> 1) + usize::from(self.shift);
        let number = LARGEST + 1 + number % SHARED;
        Patch { key: (number as u8) << 1 | turned, ..in_tree }
    }
}

/// The patches of each instance: those that are near each other differ, and all differ from the scene's own of the largest patches.
pub(super) fn placed(accel: &Accel, stores: impl Fn(u32) -> bool) -> Vec<PlacedPatches> {
    let instances = accel.instances();
    let all = instances.iter().fold(Aabb::EMPTY, |b, i| b.union(i.bounds));
    let mut order: Vec<usize> = (0..instances.len()).collect();
    order.sort_by_key(|&i| (along_curve(&instances[i].bounds, &all), i));
    let mut patches = vec![PlacedPatches::default(); instances.len()];
    let mut shift = 0;
    for i in order {
        let instance = &instances[i];
        patches[i] =
            PlacedPatches { stores: stores(instance.index(0)), shift: shift as u8, joined: Vec::new() };
        let count = instance.tree.patch_numbers;
        shift = (shift + if count.is_multiple_of(SHARED) { 1 } else { count }) % SHARED;
    }
    patches
}

/// What continues instances beyond the free edges of their meshes.
pub(super) fn beyond_instances(
    accel: &Accel,
    stores: &(impl Fn(u32) -> bool + Sync),
    gauge: &Gauge<'_>,
) -> Result<Vec<Continuation>, Cancelled> {
    let edges: usize = accel.instances().iter().map(|i| i.tree.free.len()).sum();
    if edges > MAX_PROBED {
        return Ok(Vec::new());
    }
    let of_instance = accel.instances().par_iter().filter(|i| gauge.check().is_ok() && stores(i.index(0)));
    let found = of_instance.flat_map_iter(|instance| {
        let free = instance.tree.free.iter();
        free.flat_map(|&(triangle, free)| probed(accel, instance.index(triangle as usize), free, stores))
    });
    let found = found.collect();
    gauge.check()?;
    Ok(found)
}

/// Patches of instances that something continues.
pub(super) struct Joined<'a> {
    accel: &'a Accel,
    /// By instance and number in the tree, which one it is.
    known: HashMap<(usize, u8), usize>,
    /// Instance and number in the tree.
    all: Vec<(usize, u8)>,
    members: Vec<Member>,
}

impl<'a> Joined<'a> {
    pub(super) fn new(accel: &'a Accel) -> Self {
        Self { accel, known: HashMap::new(), all: Vec::new(), members: Vec::new() }
    }

    /// The set that stands for a primitive, and whether its normal is turned against that of the set's member.
    pub(super) fn member(&mut self, primitive: u32, sets: &mut Sets) -> (u32, bool) {
        let Some((i, triangle)) = self.accel.placed(primitive) else { return (primitive, false) };
        let instance = &self.accel.instances()[i];
        let in_tree = instance.tree.patches[triangle];
        let (number, turned) = (in_tree.key >> 1, in_tree.key & 1 != 0);
        let first = self.accel.primitives().len();
        let known = *self.known.entry((i, number)).or_insert_with(|| {
            let normal = triangle_normal(instance.placed(triangle).corners).filter(|_| !in_tree.curved);
            self.members.push(Member { bounds: instance.bounds, normal });
            self.all.push((i, number));
            sets.add() as usize - first
        });
        ((first + known) as u32, turned)
    }

    pub(super) fn members(&self) -> &[Member] {
        &self.members
    }

    /// Enters what they were joined to.
    pub(super) fn enter(&self, patches: &[Patch], placed: &mut [PlacedPatches]) {
        for (&(instance, number), patch) in self.all.iter().zip(patches) {
            placed[instance].joined.push((number, *patch));
        }
    }
}
