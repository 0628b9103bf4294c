//! Maps that outlive a render: as bytes, and back.

use std::fmt;
use std::sync::Arc;

use foton_transport::codec::{Reader, StateError, Writer};
use foton_transport::kd_tree::{KdTree, PACKED_BYTES, PackedPhoton};
use foton_transport::{Ledger, LightUse, Loss};

use super::directions::Directions;
use super::maps::{Account, Maps, Reach};

/// The maps of a scene, to be used again: by another render, for another camera, in another run.
#[derive(Clone)]
pub struct KeptMaps(pub(super) Arc<Maps>);

/// Each set of maps is only itself.
impl PartialEq for KeptMaps {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for KeptMaps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "KeptMaps({} + {} photons)", self.0.global.len(), self.0.caustic.len())
    }
}

impl KeptMaps {
    /// Photons of the global map.
    #[must_use]
    pub fn global_photons(&self) -> usize {
        self.0.global.len()
    }

    /// Photons of the caustic map.
    #[must_use]
    pub fn caustic_photons(&self) -> usize {
        self.0.caustic.len()
    }

    /// The longest path that they were made for, in edges.
    #[must_use]
    pub fn max_depth(&self) -> u32 {
        self.0.max_depth
    }

    /// A number that other photons hardly share.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        let trees = [&self.0.global, &self.0.caustic, &self.0.irradiance, &self.0.lit];
        // A few thousand photons tell.
        let some = trees.into_iter().flat_map(|tree| tree.nodes().iter().step_by(tree.len() / 1024 + 1));
        let bytes = some.flat_map(|photon| photon.to_bytes());
        bytes.fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
    }

    /// As they stand in a file.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let maps = &*self.0;
        let mut out = Writer::default();
        for tree in [&maps.global, &maps.caustic, &maps.irradiance, &maps.lit] {
            out.u64(tree.len() as u64);
            tree.nodes().iter().for_each(|photon| out.bytes(&photon.to_bytes()));
        }
        out.u64(maps.directions.len() as u64);
        maps.directions.iter().for_each(|directions| out.bytes(directions.bytes()));
        let Reach { global2, caustic2, lit2, irradiance_disc } = maps.reach;
        [global2, caustic2, lit2, irradiance_disc].iter().for_each(|&reach| out.f64(reach.into()));
        out.u64(maps.max_depth.into());
        out.u64(maps.neighbours.into());
        write_account(&maps.account, &mut out);
        out.finish()
    }

    /// Out of a file.
    ///
    /// # Errors
    /// When the bytes are no maps.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, StateError> {
        let mut input = Reader::new(bytes);
        let mut tree = || read_tree(&mut input);
        let (global, caustic, irradiance, lit) = (tree()?, tree()?, tree()?, tree()?);
        let count = input.count()?;
        let directions: Vec<Directions> =
            (0..count).map(|_| Ok(Directions::from_bytes(input.bytes()?))).collect::<Result<_, _>>()?;
        if directions.len() != irradiance.len() {
            return Err(StateError::Impossible);
        }
        let mut number =
            || input.finite().and_then(|x| if x >= 0.0 { Ok(x as f32) } else { Err(StateError::Impossible) });
        let reach =
            Reach { global2: number()?, caustic2: number()?, lit2: number()?, irradiance_disc: number()? };
        let mut small = || u32::try_from(input.u64()?).map_err(|_| StateError::Impossible);
        let (max_depth, neighbours) = (small()?, small()?);
        let account = read_account(&mut input)?;
        input.finish()?;
        let maps =
            Maps { global, caustic, irradiance, directions, lit, reach, max_depth, neighbours, account };
        Ok(Self(Arc::new(maps)))
    }
}

fn read_tree(input: &mut Reader<'_>) -> Result<KdTree, StateError> {
    let count = input.count()?;
    let nodes: Vec<PackedPhoton> = (0..count)
        .map(|_| PackedPhoton::from_bytes(&input.bytes::<PACKED_BYTES>()?).ok_or(StateError::Impossible))
        .collect::<Result<_, _>>()?;
    KdTree::from_nodes(nodes).ok_or(StateError::Impossible)
}

fn write_account(account: &Account, out: &mut Writer) {
    let Account { ledger, lights, losses, emitted, rays, left_out: _ } = account;
    let Ledger {
        emitted: power,
        absorbed,
        escaped,
        roulette,
        truncated,
        shading_normals,
        shading_gain,
        lost,
        dropped,
    } = *ledger;
    let powers = [power, absorbed, escaped, roulette, truncated, shading_normals, shading_gain, lost];
    powers.iter().for_each(|&x| out.f64(x));
    out.u64(dropped);
    out.u64(lights.len() as u64);
    for light in lights {
        [light.emitted, light.reached, light.dropped].iter().for_each(|&n| out.u64(n));
    }
    out.u64(losses.len() as u64);
    for loss in losses {
        out.f64(loss.truncated);
        out.u64(loss.dropped);
    }
    [emitted[0], emitted[1], *rays].iter().for_each(|&n| out.u64(n));
}

fn read_account(input: &mut Reader<'_>) -> Result<Account, StateError> {
    let mut power = || input.finite();
    let mut ledger = Ledger {
        emitted: power()?,
        absorbed: power()?,
        escaped: power()?,
        roulette: power()?,
        truncated: power()?,
        shading_normals: power()?,
        shading_gain: power()?,
        lost: power()?,
        dropped: 0,
    };
    ledger.dropped = input.count()?;
    let mut lights = Vec::new();
    for _ in 0..input.count()? {
        lights.push(LightUse { emitted: input.count()?, reached: input.count()?, dropped: input.count()? });
    }
    let mut losses = Vec::new();
    for _ in 0..input.count()? {
        losses.push(Loss { truncated: input.finite()?, dropped: input.count()? });
    }
    let emitted = [input.count()?, input.count()?];
    Ok(Account { ledger, lights, losses, emitted, rays: input.count()?, left_out: None })
}
