//! Numbers of patches, few enough for a photon to store: the largest have one of their own, and neighbours differ.

use foton_math::glam::Vec3;
use foton_math::{Aabb, Cancelled};

use super::sets::Sets;
use crate::build::gauge::Gauge;
use crate::primitive::Primitive;

/// Normals of a patch that all have at least this cosine (0.26°) say that it is flat.
const FLAT_COSINE: f32 = 1.0 - 1e-5;

/// Numbers of patches, beside 0 for surfaces that store no photon.
const NUMBERS: usize = 127;

/// Of more patches, this many of the largest have a number of their own; the others share the rest in the order of a space-filling
/// curve, so that neighbours differ.
const LARGEST: usize = 64;

/// What a primitive belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Patch {
    /// Number of the patch in the high 7 bits, and in the lowest whether the primitive's normal is turned against the patch's.
    pub(crate) key: u8,
    /// Whether the patch leaves its tangent planes.
    pub(crate) curved: bool,
}

/// Numbers patches so that neighbours differ.
pub(super) fn number(
    primitives: &[Primitive],
    stores: &impl Fn(usize) -> bool,
    sets: &mut Sets,
    gauge: &Gauge<'_>,
) -> Result<Vec<Patch>, Cancelled> {
    let root = |i: usize| gauge.check_at(i).map(|()| sets.root(i as u32));
    let roots: Vec<(u32, bool)> = (0..primitives.len()).map(root).collect::<Result<_, _>>()?;
    let mut boxes = vec![Aabb::EMPTY; primitives.len()];
    let mut curved = vec![false; primitives.len()];
    let normal = |i: usize| match primitives[i] {
        Primitive::Triangle(corners) => crate::plane::triangle_normal(corners),
        Primitive::Disc { normal, .. } => Some(normal),
        Primitive::Sphere { .. } | Primitive::Cylinder { .. } => None,
    };
    let mut patches: Vec<u32> = Vec::new();
    for (i, &(root, _)) in roots.iter().enumerate().filter(|(i, _)| stores(*i)) {
        gauge.check_at(i)?;
        let root = root as usize;
        if root == i {
            patches.push(i as u32);
        }
        boxes[root] = boxes[root].union(primitives[i].bounds());
        let flat = normal(i).zip(normal(root)).is_some_and(|(n, of_root)| n.dot(of_root).abs() > FLAT_COSINE);
        curved[root] |= !flat;
    }
    let mut number_of = vec![0u8; primitives.len()];
    if patches.len() > NUMBERS {
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
fn along_curve(of: &Aabb, all: &Aabb) -> u64 {
    let share = (of.centre() - all.min) / all.size().max_element().max(f32::MIN_POSITIVE);
    let [x, y, z] = (share * 1023.0).clamp(Vec3::ZERO, Vec3::splat(1023.0)).to_array().map(|c| c as u64);
    (0..10).fold(0, |code, bit| {
        let at = |c: u64, place: u64| (c >> bit & 1) << (3 * bit + place);
        code | at(x, 0) | at(y, 1) | at(z, 2)
    })
}
