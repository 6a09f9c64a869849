//! The weighted points that a mixture is fitted to.

/// Share of the largest weight below which a point is left out of a fit.
const NEGLIGIBLE: f64 = 1e-6;

/// Points with weights that sum to one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WeightedPoints {
    pub(super) dimension: usize,
    /// One row of coordinates after the other.
    coordinates: Vec<f64>,
    /// ln of the density at each point to which a fit's density is compared.
    pub(super) references: Vec<f64>,
    pub(super) weights: Vec<f64>,
}

impl WeightedPoints {
    /// Leaves out points of negligible weight; the others' weights are scaled to a sum of one.
    pub(crate) fn new(
        dimension: usize,
        coordinates: Vec<f64>,
        references: Vec<f64>,
        weights: Vec<f64>,
    ) -> Self {
        let largest = weights.iter().copied().fold(0.0, f64::max);
        let kept = |weight: f64| weight > NEGLIGIBLE * largest;
        let rows = coordinates.chunks_exact(dimension).zip(&weights);
        let coordinates: Vec<f64> = rows
            .filter(|(_, weight)| kept(**weight))
            .flat_map(|(row, _)| row.iter().copied())
            .collect();
        let pairs = references.iter().zip(&weights);
        let references = pairs.filter(|(_, w)| kept(**w)).map(|(r, _)| *r).collect();
        let mut weights: Vec<f64> = weights.into_iter().filter(|weight| kept(*weight)).collect();
        let total: f64 = weights.iter().sum();
        for weight in &mut weights {
            *weight /= total;
        }
        Self {
            dimension,
            coordinates,
            references,
            weights,
        }
    }

    pub(super) fn row(&self, index: usize) -> &[f64] {
        &self.coordinates[index * self.dimension..(index + 1) * self.dimension]
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.coordinates.chunks_exact(self.dimension)
    }

    pub(super) fn effective_number(&self) -> f64 {
        1.0 / self.weights.iter().map(|w| w * w).sum::<f64>()
    }

    /// Returns every second point, from the first or the second on.
    pub(super) fn half(&self, first: usize) -> Self {
        let chosen = || (first..self.weights.len()).step_by(2);
        Self::new(
            self.dimension,
            chosen().flat_map(|i| self.row(i).iter().copied()).collect(),
            chosen().map(|i| self.references[i]).collect(),
            chosen().map(|i| self.weights[i]).collect(),
        )
    }
}
