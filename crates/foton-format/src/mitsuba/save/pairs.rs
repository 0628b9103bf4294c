//! Which things of an edited scene are which things of its file.

use std::collections::{HashMap, HashSet};

use foton_scene::description::{SceneDescription, ShapeDescription};

use super::same;

/// For each thing of an edited list the one of the old list that it was; `None` for one that is new.
pub(super) struct Pairs(pub(super) Vec<Option<usize>>);

impl Pairs {
    /// Pairs by name, and those that have another name by what else they are.
    fn of<T>(old: &[T], new: &[T], name: impl Fn(&T) -> &str, is_like: impl Fn(&T, &T) -> bool) -> Self {
        let mut free: Vec<bool> = vec![true; old.len()];
        let mut take = |at: Option<usize>| {
            if let Some(at) = at {
                free[at] = false;
            }
            at
        };
        // The first of a name is the one that is meant; there may be very many instances.
        let mut named = HashMap::new();
        for (i, old) in old.iter().enumerate() {
            named.entry(name(old)).or_insert(i);
        }
        let by_name = |new: &T| named.get(name(new)).copied();
        let mut pairs: Vec<Option<usize>> = new.iter().map(|new| take(by_name(new))).collect();
        for (pair, new) in pairs.iter_mut().zip(new) {
            if pair.is_none() {
                let like = (0..old.len()).find(|&i| free[i] && is_like(&old[i], new));
                if let Some(like) = like {
                    free[like] = false;
                    *pair = Some(like);
                }
            }
        }
        Self(pairs)
    }

    pub(super) fn of_shapes(old: &SceneDescription, new: &SceneDescription) -> Self {
        let is_like =
            |a: &ShapeDescription, b: &ShapeDescription| same::same_geometry(&a.geometry, &b.geometry);
        Self::of(&old.shapes, &new.shapes, |s| &s.name, is_like)
    }

    pub(super) fn of_emitters(old: &SceneDescription, new: &SceneDescription) -> Self {
        Self::of(
            &old.emitters,
            &new.emitters,
            |e| &e.name,
            |a, b| same::same_emitter((old, &a.kind), (new, &b.kind)),
        )
    }

    pub(super) fn of_sensors(old: &SceneDescription, new: &SceneDescription) -> Self {
        Self::of(&old.sensors, &new.sensors, |s| &s.name, same::same_sensor)
    }

    /// Those of the old list that are gone.
    pub(super) fn gone(&self, old: usize) -> impl Iterator<Item = usize> {
        let there: HashSet<usize> = self.0.iter().flatten().copied().collect();
        (0..old).filter(move |i| !there.contains(i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_found_by_name_or_else_by_what_they_are() {
        let pairs = |old: &[(&str, u8)], new: &[(&str, u8)]| {
            let old: Vec<_> = old.iter().map(|(n, k)| ((*n).to_owned(), *k)).collect();
            let new: Vec<_> = new.iter().map(|(n, k)| ((*n).to_owned(), *k)).collect();
            Pairs::of(&old, &new, |t: &(String, u8)| t.0.as_str(), |a, b| a.1 == b.1).0
        };
        let old = [("a", 1), ("b", 2), ("c", 3)];
        assert_eq!(pairs(&old, &[("b", 9), ("c", 3), ("d", 4)]), [Some(1), Some(2), None]);
        assert_eq!(pairs(&old, &[("a", 1), ("e", 2), ("c", 3)]), [Some(0), Some(1), Some(2)]);
        assert_eq!(pairs(&old, &[("a", 1), ("a-2", 1)]), [Some(0), None]);
    }
}
