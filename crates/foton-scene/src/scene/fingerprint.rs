//! A number for what light meets: the same for all scenes that differ by their cameras alone.

use std::fmt::{self, Write as _};

use super::Scene;

/// FNV-1a, 64 bits, of text that is never kept.
struct Hash(u64);

impl fmt::Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 = text.bytes().fold(self.0, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
        Ok(())
    }
}

impl Scene {
    /// Differs where surfaces, materials, textures or emitters do, not where cameras do: what is kept of light serves other cameras.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Hash(0xcbf2_9ce4_8422_2325);
        // Writing into a number never fails.
        let _ = write!(hash, "{:?}{:?}", self.normalisation, self.accel.primitives());
        let _ = write!(hash, "{:?}{:?}", self.parts, self.shapes);
        for instance in self.accel.instances() {
            let _ = write!(hash, "{:?}{}", instance.placement, instance.shape);
        }
        for tree in self.accel.mesh_trees() {
            let _ = write!(hash, "{:?}", tree.mesh);
        }
        let _ = write!(hash, "{:?}{:?}", self.vertex_normals, self.vertex_uvs);
        let _ = write!(hash, "{:?}{:?}{:?}", self.materials, self.textures, self.emitters);
        hash.0
    }
}
