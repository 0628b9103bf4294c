//! A union-find of primitives that also knows which way their normals point.

/// Disjoint sets of primitives, each of which knows whether its normal is turned against that of the set.
pub(super) struct Sets {
    parent: Vec<u32>,
    /// Whether turned against the parent.
    turned: Vec<bool>,
}

impl Sets {
    pub(super) fn new(primitives: usize) -> Self {
        Self { parent: (0..primitives as u32).collect(), turned: vec![false; primitives] }
    }

    /// Adds a set of one; its number.
    pub(super) fn add(&mut self) -> u32 {
        self.parent.push(self.parent.len() as u32);
        self.turned.push(false);
        self.parent.len() as u32 - 1
    }

    /// The set of a primitive, and whether it is turned against it.
    pub(super) fn root(&mut self, mut i: u32) -> (u32, bool) {
        let mut turned = false;
        while self.parent[i as usize] != i {
            let parent = self.parent[i as usize];
            // Halves the way for later look-ups.
            self.turned[i as usize] ^= self.turned[parent as usize];
            self.parent[i as usize] = self.parent[parent as usize];
            turned ^= self.turned[i as usize];
            i = self.parent[i as usize];
        }
        (i, turned)
    }

    pub(super) fn join(&mut self, a: u32, b: u32, turned: bool) {
        let ((a, a_turned), (b, b_turned)) = (self.root(a), self.root(b));
        if a != b {
            // The first primitive stands for the set: numbers do not depend on the order of joining.
            let (low, high) = (a.min(b), a.max(b));
            self.parent[high as usize] = low;
            self.turned[high as usize] = turned ^ a_turned ^ b_turned;
        }
    }
}
