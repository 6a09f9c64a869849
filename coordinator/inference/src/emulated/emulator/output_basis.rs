//! The basis of the outputs: the few directions in which the outputs of the training points differ.

/// Length of a remainder, in error sds, below which the basis represents an output vector.
const TOLERANCE: f64 = 1e-4;

/// An orthonormal basis of centered and scaled outputs.
///
/// An output vector y has the components `c_k = sum_j q_kj (y_j - m_j) / s_j`.
#[derive(Debug, Clone)]
pub(crate) struct OutputBasis {
    mean: Vec<f64>,
    scales: Vec<f64>,
    /// Orthonormal rows.
    rows: Vec<Vec<f64>>,
}

impl OutputBasis {
    /// Makes the basis of output vectors by Gram-Schmidt orthogonalisation, the longest remainder first.
    ///
    /// # Arguments
    /// - `scales`: the unit of each output, > 0: the sd of its error.
    pub(crate) fn new(outputs: &[&[f64]], scales: Vec<f64>) -> Self {
        let count = outputs.len() as f64;
        let mut mean = vec![0.0; scales.len()];
        for y in outputs {
            for (sum, y) in mean.iter_mut().zip(*y) {
                *sum += y / count;
            }
        }
        let mut basis = Self {
            mean,
            scales,
            rows: Vec::new(),
        };
        let mut remainders: Vec<Vec<f64>> = outputs.iter().map(|y| basis.scaled(y)).collect();
        while basis.rows.len() < basis.scales.len() {
            let squares = remainders.iter().map(|r| dot(r, r)).enumerate();
            let longest = squares.max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((index, square)) = longest.filter(|(_, square)| *square > TOLERANCE * TOLERANCE) else {
                break;
            };
            let mut row = remainders[index].clone();
            for value in &mut row {
                *value /= square.sqrt();
            }
            // A second pass keeps the rows orthogonal to rounding.
            for earlier in &basis.rows {
                let along = dot(&row, earlier);
                subtract(&mut row, earlier, along);
            }
            let length = dot(&row, &row).sqrt();
            for value in &mut row {
                *value /= length;
            }
            for remainder in &mut remainders {
                let along = dot(remainder, &row);
                subtract(remainder, &row, along);
            }
            remainders[index].fill(0.0);
            basis.rows.push(row);
        }
        basis
    }

    /// Returns the components of an output vector.
    pub(crate) fn components(&self, outputs: &[f64]) -> Vec<f64> {
        let scaled = self.scaled(outputs);
        self.rows.iter().map(|row| dot(row, &scaled)).collect()
    }

    /// Returns the output vector of components.
    pub(crate) fn outputs(&self, components: &[f64]) -> Vec<f64> {
        let mut scaled = vec![0.0; self.mean.len()];
        for (row, &component) in self.rows.iter().zip(components) {
            subtract(&mut scaled, row, -component);
        }
        let pairs = scaled.iter().zip(&self.scales).zip(&self.mean);
        pairs.map(|((y, scale), mean)| mean + scale * y).collect()
    }

    fn scaled(&self, outputs: &[f64]) -> Vec<f64> {
        let values = outputs.iter().zip(&self.mean).zip(&self.scales);
        values.map(|((y, mean), scale)| (y - mean) / scale).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Subtracts a multiple of a row.
fn subtract(from: &mut [f64], row: &[f64], factor: f64) {
    for (value, row) in from.iter_mut().zip(row) {
        *value -= factor * row;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_return_from_fewer_components() {
        let output = |a: f64, b: f64| {
            (0..20)
                .map(|j| a * f64::from(j) + b * f64::from(j * j) + 3.0)
                .collect()
        };
        let outputs: Vec<Vec<f64>> = vec![
            output(1.0, 0.0),
            output(0.0, 1.0),
            output(0.5, -2.0),
            output(2.0, 2.0),
        ];
        let rows: Vec<&[f64]> = outputs.iter().map(Vec::as_slice).collect();
        let basis = OutputBasis::new(&rows, vec![0.1; 20]);
        assert_eq!(basis.rows.len(), 2);
        for y in &outputs {
            let back = basis.outputs(&basis.components(y));
            assert!(back.iter().zip(y).all(|(a, b)| (a - b).abs() < 1e-4), "{back:?}");
        }
    }
}
