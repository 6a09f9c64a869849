//! The factor of a block's covariance, with sums in a fixed order.

use super::low_rank_factor::LowRankFactor;
use super::spread::Spread;

/// Number of data above which a covariance with few common errors is factored by these.
const MAX_DENSE: usize = 64;

/// W of `S^-1 = W' W`.
#[derive(Debug, Clone)]
pub(super) enum CovarianceFactor {
    Dense(CholeskyFactor),
    LowRank(LowRankFactor),
}

impl CovarianceFactor {
    /// Factors the covariance of a block; `None` if that overflows.
    pub(super) fn new(spread: Spread) -> Option<Self> {
        let Spread { sds, common } = spread;
        if sds.len() > MAX_DENSE && common.len() < sds.len() {
            return LowRankFactor::new(sds, common).map(Self::LowRank);
        }
        CholeskyFactor::new(&sds, &common).map(Self::Dense)
    }

    /// Returns ln det S.
    pub(super) fn log_determinant(&self) -> f64 {
        match self {
            Self::Dense(factor) => factor.log_determinant(),
            Self::LowRank(factor) => factor.log_determinant(),
        }
    }

    /// Returns `W v`.
    pub(super) fn whiten(&self, v: Vec<f64>) -> Vec<f64> {
        match self {
            Self::Dense(factor) => factor.whiten(v),
            Self::LowRank(factor) => factor.whiten(v),
        }
    }
}

/// L of `S = L L'`, row by row.
#[derive(Debug, Clone)]
pub(super) struct CholeskyFactor {
    count: usize,
    rows: Vec<f64>,
}

impl CholeskyFactor {
    /// Factors `diag(d^2) + sum v v'`; `None` if that overflows.
    ///
    /// # Arguments
    /// - `sds`: d, each > 0.
    /// - `common`: each v as a list of (position, value).
    pub(super) fn new(sds: &[f64], common: &[Vec<(usize, f64)>]) -> Option<Self> {
        let count = sds.len();
        let mut rows = vec![0.0; count * count];
        for (i, sd) in sds.iter().enumerate() {
            rows[i * count + i] = sd * sd;
        }
        for error in common {
            for &(i, a) in error {
                for &(j, b) in error.iter().take_while(|(j, _)| *j <= i) {
                    rows[i * count + j] += a * b;
                }
            }
        }
        for j in 0..count {
            for i in j..count {
                let mut sum = rows[i * count + j];
                for k in 0..j {
                    sum -= rows[i * count + k] * rows[j * count + k];
                }
                rows[i * count + j] = if i > j {
                    sum / rows[j * count + j]
                } else if sum.is_finite() && sum > 0.0 {
                    sum.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(Self { count, rows })
    }

    /// Returns ln det S.
    pub(super) fn log_determinant(&self) -> f64 {
        let logs = (0..self.count).map(|i| libm::log(self.rows[i * self.count + i]));
        2.0 * logs.sum::<f64>()
    }

    /// Returns `L^-1 v`.
    pub(super) fn whiten(&self, mut v: Vec<f64>) -> Vec<f64> {
        for i in 0..self.count {
            let row = &self.rows[i * self.count..];
            let before: f64 = (0..i).map(|k| row[k] * v[k]).sum();
            v[i] = (v[i] - before) / row[i];
        }
        v
    }
}
