//! How far two pictures are apart, pixel by pixel; worked out once for each two.

use std::sync::Arc;

use foton_film::{Image, Plane};

/// The difference of two pictures.
pub(crate) struct Difference {
    of: [Arc<Image>; 2],
    /// |L − L'| in luminance.
    pub(crate) plane: Arc<Plane<f32>>,
}

impl Difference {
    /// Of two pictures; `None` where they are not of one size.
    pub(crate) fn new(a: &Arc<Image>, b: &Arc<Image>) -> Option<Self> {
        let (width, height) = (a.width, a.height);
        if (width, height) != (b.width, b.height) {
            return None;
        }
        let apart = a.pixels.iter().zip(&b.pixels).map(|(a, b)| (a.luminance() - b.luminance()).abs());
        let plane = Arc::new(Plane { width, height, values: apart.collect() });
        Some(Self { of: [Arc::clone(a), Arc::clone(b)], plane })
    }

    /// Whether it is of these two.
    pub(crate) fn is_of(&self, a: &Arc<Image>, b: &Arc<Image>) -> bool {
        Arc::ptr_eq(&self.of[0], a) && Arc::ptr_eq(&self.of[1], b)
    }
}
