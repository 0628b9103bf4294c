//! The unit square in cells, each with a chance of its own, within which points are uniform.

use foton_math::glam::Vec2;

use crate::discrete::Discrete;

/// The unit square in rows of cells; a single one has no tables.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    rows: Discrete,
    columns: Vec<Discrete>,
    /// Cells in a row.
    width: usize,
}

impl Cells {
    /// Cells chosen in proportion to weights, which stand in rows of the same length.
    pub(super) fn new(weights: Vec<Vec<f64>>) -> Self {
        let width = weights.first().map_or(0, Vec::len);
        let rows = Discrete::new(weights.iter().map(|row| row.iter().sum()));
        Self { rows, columns: weights.into_iter().map(Discrete::new).collect(), width }
    }

    pub(super) fn sample(&self, u: Vec2) -> Vec2 {
        if self.rows.is_empty() {
            return u;
        }
        let (y, along_y) = self.rows.choose_and_rest(f64::from(u.y));
        let (x, along_x) = self.columns[y].choose_and_rest(f64::from(u.x));
        let size = [self.width as f64, self.columns.len() as f64];
        let at = [(x as f64 + along_x) / size[0], (y as f64 + along_y) / size[1]].map(|c| c as f32);
        Vec2::from(at).min(Vec2::splat(1.0 - f32::EPSILON))
    }

    /// The density of [`Cells::sample`].
    pub(super) fn density(&self, at: Vec2) -> f64 {
        if self.rows.is_empty() {
            return 1.0;
        }
        let cell = |at: f32, count: usize| ((at * count as f32) as usize).min(count - 1);
        let (x, y) = (cell(at.x, self.width), cell(at.y, self.columns.len()));
        if self.columns[y].is_empty() {
            return 0.0;
        }
        self.rows.probability(y) * self.columns[y].probability(x) * (self.width * self.columns.len()) as f64
    }
}
