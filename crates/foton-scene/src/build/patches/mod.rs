//! Which primitives continue each other. A photon on one counts for a hit point on the other; a photon on any other surface
//! does not, however close that is.
//!
//! A *patch* is a set of primitives joined at their edges where the surface goes on at less than about 84°: the triangles of a
//! mesh, whether or not its file shares their vertices, and rectangles that abut. A crease or fold as sharp as that ends a patch,
//! and so does a card that lies on a floor. Names of shapes and groups of files play no part.
//!
//! Triangles with equal vertices are joined at once. What then still has a free edge is probed: a ray just beyond the edge finds
//! what lies flush with it.

mod edges;
mod number;
mod probe;
mod sets;
mod side;

use foton_math::Cancelled;
use rayon::prelude::*;

use super::gauge::{BuildOptions, BuildStep};
use crate::accel::Accel;
use edges::join_equal_edges;
pub(crate) use number::Patch;
use number::number;
use probe::{Continuation, probed};
use sets::Sets;

/// Finds the patches of those primitives that `stores` picks, in the tree's order.
pub(super) fn find(
    accel: &Accel,
    stores: impl Fn(usize) -> bool + Sync,
    options: &BuildOptions<'_>,
) -> Result<Vec<Patch>, Cancelled> {
    let primitives = accel.primitives();
    let gauge = options.step(BuildStep::Patches, 2 * primitives.len());
    let mut sets = Sets::new(primitives.len());
    let mut free: Vec<u8> = vec![0b111; primitives.len()];
    join_equal_edges(primitives, &stores, &mut sets, &mut free, &gauge)?;
    // What is left of a loop over threads once it is cancelled has nothing to do.
    let found: Vec<Continuation> = (0..primitives.len())
        .into_par_iter()
        .filter(|&i| gauge.item(i).is_ok() && gauge.check().is_ok() && stores(i))
        .flat_map_iter(|i| probed(accel, i, free[i], &stores))
        .collect();
    for (i, found) in found.into_iter().enumerate() {
        gauge.check_at(i)?;
        sets.join(found.primitive, found.other, found.turned);
    }
    number(primitives, &stores, &mut sets, &gauge)
}
