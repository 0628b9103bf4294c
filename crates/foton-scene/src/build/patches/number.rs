//! Numbers of patches, few enough for a photon to store: the largest have one of their own, and neighbours differ.

use foton_math::glam::Vec3;
use foton_math::{Aabb, Cancelled};

use super::sets::Sets;
use crate::build::gauge::Gauge;
use crate::plane::triangle_normal;
use crate::primitive::Primitive;

/// Normals of a patch that all have at least this cosine (0.26°) say that it is flat.
const FLAT_COSINE: f32 = 1.0 - 1e-5;

/// Numbers of patches, beside 0 for surfaces that store no photon.
pub(super) const NUMBERS: usize = 127;

/// Of more patches, this many of the largest have a number of their own; the others share the rest in the order of a space-filling
/// curve, so that neighbours differ. Instances share the rest, too.
pub(super) const LARGEST: usize = 64;

/// What a primitive belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Patch {
    /// Number of the patch in the high 7 bits, and in the lowest whether the primitive's normal is turned against the patch's.
    pub(crate) key: u8,
    /// Whether the patch leaves its tangent planes.
    pub(crate) curved: bool,
}

/// What patches consist of: the scene's own primitives, and behind them patches of instances.
pub(super) struct Members<'a> {
    pub(super) primitives: &'a [Primitive],
    pub(super) placed: &'a [Member],
}

/// A patch of an instance.
pub(super) struct Member {
    /// The box around it.
    pub(super) bounds: Aabb,
    /// Its normal, if it is flat.
    pub(super) normal: Option<Vec3>,
}

impl Members<'_> {
    fn len(&self) -> usize {
        self.primitives.len() + self.placed.len()
    }

    fn bounds(&self, i: usize) -> Aabb {
        let own = self.primitives.get(i).map(Primitive::bounds);
        own.unwrap_or_else(|| self.placed[i - self.primitives.len()].bounds)
    }

    fn normal(&self, i: usize) -> Option<Vec3> {
        match self.primitives.get(i) {
            Some(Primitive::Triangle(corners)) => triangle_normal(*corners),
            Some(Primitive::Disc { normal, .. }) => Some(*normal),
            Some(Primitive::Sphere { .. } | Primitive::Cylinder { .. }) => None,
            None => self.placed[i - self.primitives.len()].normal,
        }
    }
}

/// Numbers patches so that neighbours differ.
pub(super) fn number(
    members: &Members<'_>,
    stores: &impl Fn(u32) -> bool,
    sets: &mut Sets,
    has_instances: bool,
    gauge: &Gauge<'_>,
) -> Result<Vec<Patch>, Cancelled> {
    let stores = |i: usize| i >= members.primitives.len() || stores(i as u32);
    let root = |i: usize| gauge.check_at(i).map(|()| sets.root(i as u32));
    let roots: Vec<(u32, bool)> = (0..members.len()).map(root).collect::<Result<_, _>>()?;
    let mut boxes = vec![Aabb::EMPTY; members.len()];
    let mut curved = vec![false; members.len()];
    let mut patches: Vec<u32> = Vec::new();
    for (i, &(root, _)) in roots.iter().enumerate().filter(|(i, _)| stores(*i)) {
        gauge.check_at(i)?;
        let root = root as usize;
        if root == i {
            patches.push(i as u32);
        }
        boxes[root] = boxes[root].union(members.bounds(i));
        let normals = members.normal(i).zip(members.normal(root));
        let flat = normals.is_some_and(|(n, of_root)| n.dot(of_root).abs() > FLAT_COSINE);
        curved[root] |= !flat;
    }
    let mut number_of = vec![0u8; members.len()];
    if patches.len() > if has_instances { LARGEST } else { NUMBERS } {
        let size = |&i: &u32| boxes[i as usize].size().length_squared();
        patches.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
        let all = patches.iter().fold(Aabb::EMPTY, |b, &i| b.union(boxes[i as usize]));
        patches[LARGEST..].sort_by_key(|&i| (along_curve(&boxes[i as usize], &all), i));
    }
    for (place, &i) in patches.iter().enumerate() {
        let number = if place < LARGEST { place } else { LARGEST + (place - LARGEST) % (NUMBERS - LARGEST) };
        number_of[i as usize] = number as u8 + 1;
    }
    let patch = |(i, &(root, turned)): (usize, &(u32, bool))| {
        let (number, curved) = (number_of[root as usize], curved[root as usize]);
        if stores(i) { Patch { key: number << 1 | u8::from(turned), curved } } else { Patch::default() }
    };
    gauge.check()?;
    Ok(roots.iter().enumerate().map(patch).collect())
}

/// Place of a box's middle along Morton's curve through another box, in cubes: what is close in space is mostly close along it.
pub(super) fn along_curve(of: &Aabb, all: &Aabb) -> u64 {
    let share = (of.centre() - all.min) / all.size().max_element().max(f32::MIN_POSITIVE);
    let [x, y, z] = (share * 1023.0).clamp(Vec3::ZERO, Vec3::splat(1023.0)).to_array().map(|c| c as u64);
    (0..10).fold(0, |code, bit| {
        let at = |c: u64, place: u64| (c >> bit & 1) << (3 * bit + place);
        code | at(x, 0) | at(y, 1) | at(z, 2)
    })
}
