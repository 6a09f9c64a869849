//! Universal kriging: a polynomial trend with a correlated remainder, fitted to all components at once.

use nalgebra::{Cholesky, DMatrix};

use super::trend::TrendDegree;

/// The hyperparameters of a fit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct KrigingSettings {
    /// Degree of the trend.
    pub degree: TrendDegree,
    /// Correlation length of the remainder, in sds of the target.
    pub length: f64,
    /// Variance of the scatter between neighbouring points, in variances of the remainder.
    pub nugget: f64,
}

/// Weight of the mean variance of the remainder beside the points about the place of a prediction.
const TYPICAL_WEIGHT: f64 = 1.0;

/// A prediction of the components at a point.
pub(crate) struct Interpolated {
    pub(crate) components: Vec<f64>,
    /// Variance of their smooth part, in variances of the remainder.
    pub(crate) smooth_variance: f64,
    /// Variance of the remainder, summed over components.
    pub(crate) remainder_variance: f64,
}

/// A fit of components by kriging.
///
/// A component at u is `sum_t b_t f_t(u) + sum_i a_i exp(-|u - u_i|^2 / (2 length^2))`.
#[derive(Debug, Clone)]
pub(crate) struct Kriging {
    pub(crate) settings: KrigingSettings,
    /// The training points, one after the other.
    points: Vec<f64>,
    dimension: usize,
    components: usize,
    /// b, by terms, then components.
    trend: Vec<f64>,
    /// a, by points, then components.
    weights: Vec<f64>,
    /// Square error of the prediction of each point from all other points, summed over components.
    left_out: Vec<f64>,
    /// The variance of the remainder that each of these errors suggests, summed over components.
    suggested: Vec<f64>,
    /// Its mean over the mass of the target.
    typical: f64,
    /// L of `K = L L'` by rows, the lower triangle alone.
    factor: Vec<f64>,
    /// `L^-1 F`, by points, then terms.
    half_terms: Vec<f64>,
    /// The factor of `F' K^-1 F` by rows, the lower triangle alone.
    normal_factor: Vec<f64>,
}

impl Kriging {
    /// Fits components at whitened points; `None` where the points do not determine the trend.
    ///
    /// With K the correlations, F the terms and `B = K^-1 - K^-1 F (F' K^-1 F)^-1 F' K^-1`, the weights are `a = B y` and the error
    /// of the prediction of a point from all other points is `a_i / B_ii`.
    ///
    /// # Arguments
    /// - `mass`: weights of the points, by the mass of the target about them.
    ///
    /// # Source
    /// Dubrule 1983, Math. Geol. 15:687, doi:10.1007/BF01033232. Checked by `tests::left_out_errors_are_those_of_separate_fits`.
    pub(crate) fn new(
        points: &[Vec<f64>],
        values: &[Vec<f64>],
        mass: &[f64],
        settings: KrigingSettings,
    ) -> Option<Self> {
        let (count, components) = (points.len(), values.first()?.len());
        let dimension = points.first()?.len();
        let terms = settings.degree.terms(dimension);
        if count < terms + 2 {
            return None;
        }
        let mut rows = Vec::with_capacity(count * terms);
        for u in points {
            settings.degree.extend_terms(u, &mut rows);
        }
        let terms_at_points = DMatrix::from_row_slice(count, terms, &rows);
        let values = DMatrix::from_fn(count, components, |i, k| values[i][k]);
        let factor = Cholesky::new(correlations(points, settings))?.unpack();
        let inverse = factor.solve_lower_triangular(&DMatrix::identity(count, count))?;
        let half_terms = factor.solve_lower_triangular(&terms_at_points)?;
        let half_values = factor.solve_lower_triangular(&values)?;
        let normal = Cholesky::new(half_terms.tr_mul(&half_terms))?;
        let trend = normal.solve(&half_terms.tr_mul(&half_values));
        let remainder = &half_values - &half_terms * &trend;
        let weights = factor.tr_solve_lower_triangular(&remainder)?;
        let projected = normal.l().solve_lower_triangular(&half_terms.transpose())? * &inverse;
        let diagonal = |i: usize| column_square(&inverse, i) - column_square(&projected, i);
        let squares = |i: usize| weights.row(i).norm_squared();
        let precisions: Vec<f64> = (0..count).map(|i| diagonal(i).max(f64::MIN_POSITIVE)).collect();
        let left_out = precisions.iter().enumerate().map(|(i, p)| squares(i) / (p * p));
        let suggested: Vec<f64> = precisions
            .iter()
            .enumerate()
            .map(|(i, p)| squares(i) / p)
            .collect();
        Some(Self {
            factor: lower_rows(&factor),
            half_terms: half_terms.transpose().as_slice().to_vec(),
            normal_factor: lower_rows(&normal.l()),
            settings,
            points: points.concat(),
            dimension,
            components,
            left_out: left_out.collect(),
            typical: weighted_mean(&suggested, mass),
            suggested,
            trend: trend.transpose().as_slice().to_vec(),
            weights: weights.transpose().as_slice().to_vec(),
        })
    }

    /// Predicts the components at a whitened point.
    ///
    /// The variance of the smooth part is `1 - k' K^-1 k + t' (F' K^-1 F)^-1 t` with `t = f - F' K^-1 k`, in variances of the remainder.
    /// The latter is that of the left-out errors of the points about u, weighted by `exp(-|u - u_i|^2 / d)` in d dimensions: a model
    /// is often harder to predict in the tails of a target than where its mass is.
    pub(crate) fn predict(&self, u: &[f64]) -> Interpolated {
        let mut terms = Vec::with_capacity(self.trend.len() / self.components.max(1));
        self.settings.degree.extend_terms(u, &mut terms);
        let mut correlations = Vec::with_capacity(self.points.len() / self.dimension);
        let mut sums = vec![0.0; self.components];
        for (term, row) in terms.iter().zip(self.trend.chunks_exact(self.components.max(1))) {
            add(&mut sums, *term, row);
        }
        let scale = -0.5 / (self.settings.length * self.settings.length);
        let (mut remainder, mut weight) = (TYPICAL_WEIGHT * self.typical, TYPICAL_WEIGHT);
        let points = self.points.chunks_exact(self.dimension).zip(&self.suggested);
        for ((point, suggested), row) in points.zip(self.weights.chunks_exact(self.components.max(1))) {
            let square = square_distance(point, u);
            let correlation = libm::exp(scale * square);
            add(&mut sums, correlation, row);
            correlations.push(correlation);
            let nearness = libm::exp(-square / self.dimension as f64);
            remainder += nearness * suggested;
            weight += nearness;
        }
        let solved = solve_lower(&self.factor, correlations);
        for (half, row) in solved.iter().zip(self.half_terms.chunks_exact(terms.len())) {
            add(&mut terms, -half, row);
        }
        let explained: f64 = solved.iter().map(|x| x * x).sum();
        let unknown: f64 = solve_lower(&self.normal_factor, terms)
            .iter()
            .map(|x| x * x)
            .sum();
        Interpolated {
            components: sums,
            smooth_variance: (1.0 - explained).max(0.0) + unknown,
            remainder_variance: remainder / weight,
        }
    }

    /// Returns the mean square error of predictions of a point from all other points, summed over components, with a weight
    /// for each point.
    pub(crate) fn left_out_error(&self, weights: &[f64]) -> f64 {
        weighted_mean(&self.left_out, weights)
    }
}

fn weighted_mean(values: &[f64], weights: &[f64]) -> f64 {
    dot(values, weights) / weights.iter().sum::<f64>()
}

fn correlations(points: &[Vec<f64>], settings: KrigingSettings) -> DMatrix<f64> {
    let scale = -0.5 / (settings.length * settings.length);
    let mut matrix = DMatrix::identity(points.len(), points.len());
    for i in 0..points.len() {
        matrix[(i, i)] += settings.nugget;
        for j in 0..i {
            matrix[(i, j)] = libm::exp(scale * square_distance(&points[i], &points[j]));
        }
    }
    matrix
}

/// Returns the lower triangle by rows.
fn lower_rows(matrix: &DMatrix<f64>) -> Vec<f64> {
    let places = (0..matrix.nrows()).flat_map(|i| (0..=i).map(move |j| (i, j)));
    places.map(|place| matrix[place]).collect()
}

/// Solves `L x = b` with the rows of the lower triangle.
fn solve_lower(factor: &[f64], mut values: Vec<f64>) -> Vec<f64> {
    let mut row = 0;
    for i in 0..values.len() {
        let (solved, rest) = values.split_at_mut(i);
        let factors = &factor[row..=row + i];
        rest[0] = (rest[0] - dot(&factors[..i], solved)) / factors[i];
        row += i + 1;
    }
    values
}

/// Returns the sum of products, in four partial sums that can be added at the same time.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (mut sums, chunks) = ([0.0; 4], a.len() / 4 * 4);
    for (a, b) in a[..chunks].chunks_exact(4).zip(b[..chunks].chunks_exact(4)) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a[chunks..].iter().zip(&b[chunks..]).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

fn column_square(matrix: &DMatrix<f64>, column: usize) -> f64 {
    matrix.column(column).iter().map(|x| x * x).sum()
}

pub(super) fn square_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

fn add(sums: &mut [f64], factor: f64, row: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(row) {
        *sum += factor * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTINGS: KrigingSettings = KrigingSettings {
        degree: TrendDegree::Linear,
        length: 1.5,
        nugget: 1e-3,
    };

    /// Points on a spiral, and two components that are no polynomials.
    fn data(count: usize) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let points: Vec<Vec<f64>> = (0..count)
            .map(|i| {
                let angle = i as f64;
                vec![0.2 * angle * libm::cos(angle), 0.2 * angle * libm::sin(angle)]
            })
            .collect();
        let values = points
            .iter()
            .map(|u| vec![libm::sin(2.0 * u[0]) + u[1], libm::exp(0.5 * u[1])]);
        let values = values.collect();
        (points, values)
    }

    #[test]
    fn left_out_errors_are_those_of_separate_fits() {
        let (points, values) = data(14);
        let all = Kriging::new(&points, &values, &[1.0; 14], SETTINGS).unwrap();
        for i in 0..points.len() {
            let rest = |rows: &[Vec<f64>]| [&rows[..i], &rows[i + 1..]].concat();
            let fit = Kriging::new(&rest(&points), &rest(&values), &[1.0; 13], SETTINGS).unwrap();
            let predicted = fit.predict(&points[i]);
            let square = square_distance(&predicted.components, &values[i]);
            assert!((all.left_out[i] - square).abs() < 1e-9 * square, "point {i}");
            let suggested = square / (predicted.smooth_variance + SETTINGS.nugget);
            assert!(
                (all.suggested[i] - suggested).abs() < 1e-9 * suggested,
                "point {i}"
            );
        }
    }

    #[test]
    fn predictions_are_surer_where_the_left_out_errors_are_small() {
        // A straight line on one side, a fast oscillation on the other.
        let points: Vec<Vec<f64>> = (-30..=30).map(|i| vec![0.2 * f64::from(i)]).collect();
        let value = |u: f64| if u > 0.0 { libm::sin(9.0 * u) } else { 0.0 };
        let values: Vec<Vec<f64>> = points.iter().map(|u| vec![value(u[0])]).collect();
        let fit = Kriging::new(&points, &values, &[1.0; 61], SETTINGS).unwrap();
        let variance = |u: f64| fit.predict(&[u]).remainder_variance;
        assert!(
            variance(-4.0) < 0.1 * variance(4.0),
            "{} {}",
            variance(-4.0),
            variance(4.0)
        );
    }
}
