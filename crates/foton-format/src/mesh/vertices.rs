//! Vertices that corners share.

use std::collections::HashMap;
use std::hash::Hash;

/// Vertices that corners share, found by short chains of those with the same position, and by their keys where there are more:
/// one position can have any number of normals and texture coordinates.
pub(crate) struct Vertices<K> {
    first: Vec<u32>,
    next: Vec<u32>,
    /// Vertices that stand in no chain.
    others: HashMap<K, u32>,
    /// What tells each vertex from others.
    pub(crate) keys: Vec<K>,
}

const NONE: u32 = u32::MAX;

/// The most vertices of a chain; those of real meshes have fewer.
const MAX_CHAIN: usize = 16;

impl<K: Copy + Eq + Hash> Vertices<K> {
    pub(crate) fn new(positions: usize) -> Self {
        let keys = Vec::with_capacity(positions);
        Self { first: vec![NONE; positions], next: Vec::new(), others: HashMap::new(), keys }
    }

    /// The vertex with that key, which has that position.
    pub(crate) fn index(&mut self, position: u32, key: K) -> u32 {
        let slot = &mut self.first[position as usize];
        let new = u32::try_from(self.keys.len()).unwrap_or(NONE);
        let (mut at, mut length) = (*slot, 0);
        while at != NONE {
            if self.keys[at as usize] == key {
                return at;
            }
            at = self.next[at as usize];
            length += 1;
        }
        if length < MAX_CHAIN {
            self.next.push(*slot);
            *slot = new;
        } else {
            let known = *self.others.entry(key).or_insert(new);
            if known != new {
                return known;
            }
            self.next.push(NONE);
        }
        self.keys.push(key);
        new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::obj::Corner;

    #[test]
    fn a_position_with_very_many_normals_is_read_in_linear_time() {
        let mut vertices = Vertices::new(2);
        let keys = (0..200_000_u32).map(|normal| Corner { position: 1, texture: 0, normal });
        let numbers: Vec<u32> = keys.clone().map(|key| vertices.index(1, key)).collect();
        assert!(numbers.iter().copied().eq(0..200_000));
        assert!(keys.map(|key| vertices.index(1, key)).eq(0..200_000));
        // No more are looked through one after the other.
        let mut chain = vec![vertices.first[1]];
        while let Some(&next) = vertices.next.get(chain[chain.len() - 1] as usize) {
            chain.push(next);
        }
        assert_eq!(chain.len(), MAX_CHAIN + 1);
    }
}
