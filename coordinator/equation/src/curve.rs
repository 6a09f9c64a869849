//! A located law as a curve: values at points with their covariance, and how much of the curve the data leave open.

use nalgebra::{DMatrix, DVector};

/// Knots of the piecewise linear curve that says how well a curve of many points is known.
const KNOTS: usize = 5;
/// Points at which formulas are compared.
const POINTS: usize = 81;
/// Points between two knots at which a formula counts.
const BETWEEN: usize = 4;
/// Share of a row's greatest weight that counts as 0.
const NEGLIGIBLE: f64 = 1e-12;

/// What a law does to the quantity on which it acts; at strength 0 it does nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Host {
    /// It is a factor, which must be positive; values are logarithms of the factor.
    Factor,
    /// It is added.
    Addition,
}

/// A curve that cannot be searched.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// Too few points, or lists of other lengths.
    #[error(
        "curve has {points} points, {values} values and {covariances} covariances; must have 3 points or more, as many values and their square"
    )]
    Lengths {
        /// Number of points.
        points: usize,
        /// Number of values.
        values: usize,
        /// Number of covariances.
        covariances: usize,
    },
    /// A number is NaN or infinite, or points do not rise.
    #[error("point {index} of the curve must be finite, and above the one before")]
    Point {
        /// Index of the point.
        index: usize,
    },
    /// The covariance is not positive definite.
    #[error("covariance of the curve must be positive definite")]
    Covariance,
}

/// A curve with its covariance.
#[derive(Debug, Clone)]
pub struct LocatedCurve {
    pub(crate) host: Host,
    /// The greatest magnitude of the variable, to three digits, by which it is divided.
    pub(crate) scale: f64,
    /// Points over the scale.
    pub(crate) points: Vec<f64>,
    pub(crate) values: Vec<f64>,
    /// Rows that turn values at the points into independent numbers with sd 1, each without its zeros in front and behind.
    whitening: Vec<Row>,
    pub(crate) whitened: Vec<f64>,
    /// Points over the scale at which formulas are compared.
    pub(crate) grid: Vec<f64>,
    /// Posterior sd of the curve at these points.
    pub(crate) sds: Vec<f64>,
    /// Root mean square of the values.
    pub(crate) size: f64,
}

/// A row of a matrix from its first number that is not 0.
#[derive(Debug, Clone)]
struct Row {
    first: usize,
    weights: Vec<f64>,
}

impl Row {
    fn new(weights: &[f64]) -> Self {
        let size = weights
            .iter()
            .fold(0.0_f64, |size, weight| size.max(weight.abs()));
        let counts = |weight: &f64| weight.abs() > NEGLIGIBLE * size;
        let first = weights.iter().position(counts).unwrap_or(0);
        let last = weights.iter().rposition(counts).unwrap_or(0);
        Self {
            first,
            weights: weights[first..=last].to_vec(),
        }
    }
}

impl LocatedCurve {
    /// Makes a curve of values that were measured at points.
    ///
    /// # Arguments
    /// - `points`: of the variable, rising. `values`: of the law, for a factor its logarithm. `covariance`: of the values, row by row.
    ///
    /// # Errors
    /// [`CurveError`].
    pub fn new(host: Host, points: &[f64], values: &[f64], covariance: &[f64]) -> Result<Self, CurveError> {
        let covariance = checked(points, values, covariance)?;
        let inverse = inverse_root(&covariance)?;
        let count = points.len();
        let knots = if count <= 2 * KNOTS { count } else { KNOTS };
        let of_knots = if knots == count {
            covariance
        } else {
            let basis = DMatrix::from_fn(count, knots, |i, k| hat(k, knots, i as f64 / (count - 1) as f64));
            let whitened = &inverse * basis;
            let precision = (whitened.transpose() * whitened).cholesky();
            precision.ok_or(CurveError::Covariance)?.inverse()
        };
        Ok(Self::assembled(host, points, values, &inverse, &of_knots))
    }

    /// Makes a curve of the knots of a piecewise linear curve that was fitted to something else. A formula counts by the piecewise linear
    /// curve that is nearest to it, because data between the knots shaped the fitted one, too.
    ///
    /// # Arguments
    /// - `knots`: values of the variable, rising. `values`, `covariance`: as of [`new`](Self::new), of the knots.
    /// - `is_logarithmic`: whether the curve is linear in the logarithm of the variable; the first knot is then positive.
    ///
    /// # Errors
    /// [`CurveError`].
    pub fn of_knots(
        host: Host,
        knots: &[f64],
        values: &[f64],
        covariance: &[f64],
        is_logarithmic: bool,
    ) -> Result<Self, CurveError> {
        let covariance = checked(knots, values, covariance)?;
        if is_logarithmic && knots[0] <= 0.0 {
            return Err(CurveError::Point { index: 0 });
        }
        let last = BETWEEN * (knots.len() - 1);
        let place = |i: usize| i as f64 / BETWEEN as f64;
        let basis = DMatrix::from_fn(last + 1, knots.len(), |i, k| {
            (1.0 - (place(i) - k as f64).abs()).max(0.0)
        });
        let points: Vec<f64> = (0..=last)
            .map(|i| {
                let left = (i / BETWEEN).min(knots.len() - 2);
                let share = place(i) - left as f64;
                match is_logarithmic {
                    true => knots[left] * libm::pow(knots[left + 1] / knots[left], share),
                    false => knots[left] + share * (knots[left + 1] - knots[left]),
                }
            })
            .collect();
        let nearest = (basis.transpose() * &basis)
            .cholesky()
            .ok_or(CurveError::Covariance)?;
        let projection = nearest.inverse() * basis.transpose();
        let between = &basis * DVector::from_column_slice(values);
        let whitening = inverse_root(&covariance)? * projection;
        Ok(Self::assembled(
            host,
            &points,
            between.as_slice(),
            &whitening,
            &covariance,
        ))
    }

    /// Collects what the search needs.
    ///
    /// # Arguments
    /// - `whitening`: turns values at the points into independent ones of sd 1. `of_knots`: covariance of evenly spaced knots.
    fn assembled(
        host: Host,
        points: &[f64],
        values: &[f64],
        whitening: &DMatrix<f64>,
        of_knots: &DMatrix<f64>,
    ) -> Self {
        let scale = short(points[points.len() - 1].abs().max(points[0].abs()));
        let points: Vec<f64> = points.iter().map(|x| x / scale).collect();
        let shares = (0..POINTS).map(|i| i as f64 / (POINTS - 1) as f64);
        let sd = |share: f64| {
            let weights = DVector::from_fn(of_knots.nrows(), |k, _| hat(k, of_knots.nrows(), share));
            weights.dot(&(of_knots * &weights)).sqrt()
        };
        let rows = whitening
            .row_iter()
            .map(|row| Row::new(&row.iter().copied().collect::<Vec<f64>>()));
        let mut curve = Self {
            host,
            scale,
            grid: shares.clone().map(|share| between(&points, share)).collect(),
            sds: shares.map(sd).collect(),
            size: (values.iter().map(|y| y * y).sum::<f64>() / values.len() as f64).sqrt(),
            points,
            values: values.to_vec(),
            whitening: rows.collect(),
            whitened: Vec::new(),
        };
        curve.whitened = curve.whiten(values);
        curve
    }

    /// Returns values divided by the root of the covariance: independent, with sd 1.
    pub(crate) fn whiten(&self, values: &[f64]) -> Vec<f64> {
        let product = |row: &Row| {
            let values = &values[row.first..];
            row.weights
                .iter()
                .zip(values)
                .map(|(weight, value)| weight * value)
                .sum()
        };
        self.whitening.iter().map(product).collect()
    }

    /// Returns the sd of the curve at a value of the variable within its range.
    #[must_use]
    pub fn sd(&self, at: f64) -> f64 {
        let grid = &self.grid;
        let at = at / self.scale;
        let right = grid.partition_point(|x| *x <= at).clamp(1, grid.len() - 1);
        let share = (at - grid[right - 1]) / (grid[right] - grid[right - 1]);
        self.sds[right - 1] + share * (self.sds[right] - self.sds[right - 1])
    }

    /// Returns the range of the variable.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        [self.points[0], self.points[self.points.len() - 1]].map(|x| x * self.scale)
    }
}

/// Returns a number to three digits, so that formulas in which it stands are short.
fn short(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Returns the place at a share of the way through a list, by straight lines.
fn between(points: &[f64], share: f64) -> f64 {
    let place = share * (points.len() - 1) as f64;
    let left = (place as usize).min(points.len() - 2);
    points[left] + (place - left as f64) * (points[left + 1] - points[left])
}

/// Returns the weight of an evenly spaced knot at a share of the way through a piecewise linear curve.
fn hat(knot: usize, knots: usize, share: f64) -> f64 {
    (1.0 - (share * (knots - 1) as f64 - knot as f64).abs()).max(0.0)
}

/// Checks points and values, and returns their covariance.
fn checked(points: &[f64], values: &[f64], covariance: &[f64]) -> Result<DMatrix<f64>, CurveError> {
    let count = points.len();
    if count < 3 || values.len() != count || covariance.len() != count * count {
        return Err(CurveError::Lengths {
            points: count,
            values: values.len(),
            covariances: covariance.len(),
        });
    }
    let rises = |i: usize| i == 0 || points[i] > points[i - 1];
    let is_good = |i: usize| points[i].is_finite() && values[i].is_finite() && rises(i);
    if let Some(index) = (0..count).find(|i| !is_good(*i)) {
        return Err(CurveError::Point { index });
    }
    Ok(DMatrix::from_row_slice(count, count, covariance))
}

/// Returns the inverse of a covariance's Cholesky factor.
fn inverse_root(covariance: &DMatrix<f64>) -> Result<DMatrix<f64>, CurveError> {
    let cholesky = covariance.clone().cholesky();
    cholesky
        .and_then(|cholesky| cholesky.l().try_inverse())
        .ok_or(CurveError::Covariance)
}
