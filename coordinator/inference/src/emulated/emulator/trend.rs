//! The trend of an emulator: a polynomial in the whitened coordinates.

/// The degree of the trend.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum TrendDegree {
    /// A constant and the coordinates.
    Linear,
    /// These, and all products of two coordinates.
    Quadratic,
}

impl TrendDegree {
    /// Returns the number of terms in a number of dimensions.
    pub(crate) fn terms(self, dimension: usize) -> usize {
        match self {
            Self::Linear => 1 + dimension,
            Self::Quadratic => (dimension + 1) * (dimension + 2) / 2,
        }
    }

    /// Appends the terms at a point.
    pub(crate) fn extend_terms(self, u: &[f64], terms: &mut Vec<f64>) {
        terms.push(1.0);
        terms.extend_from_slice(u);
        if self == Self::Quadratic {
            for (i, first) in u.iter().enumerate() {
                terms.extend(u[i..].iter().map(|second| first * second));
            }
        }
    }
}
