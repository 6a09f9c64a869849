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
    /// Errors of the prediction of each point from all other points, by points, then components.
    left_out: Vec<f64>,
    /// Variance of the remainder of each component.
    pub(crate) variances: Vec<f64>,
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
    /// # Source
    /// Dubrule 1983, Math. Geol. 15:687, doi:10.1007/BF01033232. Checked by `tests::left_out_errors_are_those_of_separate_fits`.
    pub(crate) fn new(points: &[Vec<f64>], values: &[Vec<f64>], settings: KrigingSettings) -> Option<Self> {
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
        let degrees = (count - terms) as f64;
        let variances = (0..components).map(|k| remainder.column(k).norm_squared() / degrees);
        let left_out = (0..count).flat_map(|i| {
            let precision = diagonal(i).max(f64::MIN_POSITIVE);
            weights
                .row(i)
                .iter()
                .map(move |a| a / precision)
                .collect::<Vec<_>>()
        });
        Some(Self {
            factor: lower_rows(&factor),
            half_terms: half_terms.transpose().as_slice().to_vec(),
            normal_factor: lower_rows(&normal.l()),
            settings,
            points: points.concat(),
            dimension,
            components,
            left_out: left_out.collect(),
            variances: variances.collect(),
            trend: trend.transpose().as_slice().to_vec(),
            weights: weights.transpose().as_slice().to_vec(),
        })
    }

    /// Returns the components at a whitened point, and the variance of their smooth part in variances of the remainder,
    /// `1 - k' K^-1 k + t' (F' K^-1 F)^-1 t` with `t = f - F' K^-1 k`.
    pub(crate) fn predict(&self, u: &[f64]) -> (Vec<f64>, f64) {
        let mut terms = Vec::with_capacity(self.trend.len() / self.components.max(1));
        self.settings.degree.extend_terms(u, &mut terms);
        let mut correlations = Vec::with_capacity(self.points.len() / self.dimension);
        let mut sums = vec![0.0; self.components];
        for (term, row) in terms.iter().zip(self.trend.chunks_exact(self.components.max(1))) {
            add(&mut sums, *term, row);
        }
        let scale = -0.5 / (self.settings.length * self.settings.length);
        let points = self.points.chunks_exact(self.dimension);
        for (point, row) in points.zip(self.weights.chunks_exact(self.components.max(1))) {
            let correlation = libm::exp(scale * square_distance(point, u));
            add(&mut sums, correlation, row);
            correlations.push(correlation);
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
        (sums, (1.0 - explained).max(0.0) + unknown)
    }

    /// Returns the mean square error of predictions of a point from all other points, summed over components, with a weight
    /// for each point.
    pub(crate) fn left_out_error(&self, weights: &[f64]) -> f64 {
        let rows = self.left_out.chunks_exact(self.components.max(1));
        let squares = rows.map(|row| row.iter().map(|e| e * e).sum::<f64>());
        let total: f64 = weights.iter().sum();
        squares.zip(weights).map(|(e, w)| e * w).sum::<f64>() / total
    }
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
