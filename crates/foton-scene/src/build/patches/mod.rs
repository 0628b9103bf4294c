//! Which primitives continue each other. A photon on one counts for a hit point on the other; a photon on any other surface
//! does not, however close that is.
//!
//! A *patch* is a set of primitives joined at their edges where the surface goes on at less than about 84°: the triangles of a
//! mesh, whether or not its file shares their vertices, and rectangles that abut. A crease or fold as sharp as that ends a patch,
//! and so does a card that lies on a floor. Names of shapes and groups of files play no part.
//!
//! Triangles with equal vertices are joined at once. What then still has a free edge is probed: a ray just beyond the edge finds
//! what lies flush with it. Patches of a mesh that several shapes share are found once, in its own space; only its free edges are probed
//! at each place.

mod edges;
mod number;
mod placed;
mod probe;
mod sets;
mod side;

use foton_math::Cancelled;
use rayon::prelude::*;

use super::gauge::{BuildOptions, BuildStep};
use crate::accel::Accel;
use crate::primitive::Primitive;
use edges::join_equal_edges;
pub(crate) use number::Patch;
use number::{Members, number};
pub(crate) use placed::PlacedPatches;
use placed::{Joined, beyond_instances, placed};
use probe::{Continuation, probed};
use sets::Sets;

/// The patches of a scene, or of a mesh.
pub(super) struct Patches {
    /// Of the scene's own primitives, in the tree's order.
    pub(super) own: Vec<Patch>,
    /// Of each instance.
    pub(super) placed: Vec<PlacedPatches>,
    /// Triangles with edges that nothing continues, a bit for each edge.
    pub(super) free: Vec<(u32, u8)>,
}

/// Finds the patches of those primitives that `stores` picks by their index.
pub(super) fn find(
    accel: &Accel,
    stores: impl Fn(u32) -> bool + Sync,
    options: &BuildOptions<'_>,
) -> Result<Patches, Cancelled> {
    let primitives = accel.primitives();
    let gauge = options.step(BuildStep::Patches, 2 * primitives.len());
    let mut sets = Sets::new(primitives.len());
    let mut free: Vec<u8> = vec![0b111; primitives.len()];
    join_equal_edges(primitives, &stores, &mut sets, &mut free, &gauge)?;
    // What is left of a loop over threads once it is cancelled has nothing to do.
    let mut found: Vec<Continuation> = (0..primitives.len())
        .into_par_iter()
        .filter(|&i| gauge.item(i).is_ok() && gauge.check().is_ok() && stores(i as u32))
        .flat_map_iter(|i| probed(accel, i as u32, free[i], &stores))
        .collect();
    found.extend(beyond_instances(accel, &stores, &gauge)?);
    let mut joined = Joined::new(accel);
    for (i, found) in found.into_iter().enumerate() {
        gauge.check_at(i)?;
        if let Some(free) = free.get_mut(found.primitive as usize) {
            *free &= !(1 << found.side);
        }
        let [one, other] = [found.primitive, found.other].map(|i| joined.member(i, &mut sets));
        sets.join(one.0, other.0, found.turned ^ one.1 ^ other.1);
    }
    let members = Members { primitives, placed: joined.members() };
    let mut own = number(&members, &stores, &mut sets, !accel.instances().is_empty(), &gauge)?;
    let mut placed = placed(accel, &stores);
    joined.enter(&own.split_off(primitives.len()), &mut placed);
    let is_open =
        |&(i, free): &(u32, u8)| free != 0 && matches!(primitives[i as usize], Primitive::Triangle(_));
    Ok(Patches { own, placed, free: (0..).zip(free).filter(is_open).collect() })
}
