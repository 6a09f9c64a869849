//! The equilibrium of a stage: whether its chains have forgotten their start.

use crate::diagnostics::rank_correlation;

/// Rank correlation between start and end below which a stage counts as moved.
const CORRELATION_LIMIT: f64 = 0.3;

/// |z| of the drift below which a stage may end.
const DRIFT_LIMIT: f64 = 2.0;

/// |z| of the drift above which a stage is not in equilibrium.
const DRIFT_ALARM: f64 = 3.0;

/// The z-score of a change whose spread is unknown: alarming, and finite, so that JSON can hold it.
const DRIFT_UNKNOWN: f64 = 1e6;

/// The movement of the log-likelihoods of a stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drift {
    /// z-score of the mean change of the log-likelihood.
    pub(super) z: f64,
    /// z-score of the mean change of the incremental weight.
    pub(super) weight_z: f64,
    /// Rank correlation of the log-likelihoods at start and end; 1 if nothing moved.
    pub(super) correlation: f64,
}

impl Drift {
    /// Computes the drift of particles from `start` to `end`; particles of one cluster are dependent.
    ///
    /// `step` is the growth of the exponent before; `moved` decides where the log-likelihoods are all equal and have no ranks.
    pub(super) fn new(start: &[f64], end: &[f64], clusters: &[usize], step: f64, moved: bool) -> Self {
        let correlation = rank_correlation(start, end).unwrap_or(if moved { 0.0 } else { 1.0 });
        let max = start
            .iter()
            .chain(end)
            .fold(f64::NEG_INFINITY, |max, &l| max.max(l));
        let weight = |l: f64| libm::exp(step * (l - max));
        let pairs = || start.iter().zip(end);
        let changes: Vec<f64> = pairs().map(|(start, end)| end - start).collect();
        let gains: Vec<f64> = pairs()
            .map(|(&start, &end)| weight(end) - weight(start))
            .collect();
        Self {
            z: clustered_z(&changes, clusters),
            weight_z: clustered_z(&gains, clusters),
            correlation,
        }
    }

    /// Returns whether a stage may end here.
    pub(super) fn may_end(self) -> bool {
        self.correlation < CORRELATION_LIMIT
            && self.z.abs() < DRIFT_LIMIT
            && self.weight_z.abs() < DRIFT_LIMIT
    }

    /// Returns whether the stage forgot its start and did not drift.
    pub(super) fn is_equilibrated(self) -> bool {
        self.correlation < CORRELATION_LIMIT && !is_alarming(self.z) && !is_alarming(self.weight_z)
    }
}

/// Returns whether a z-score says that the target was not reached.
pub(super) fn is_alarming(z: f64) -> bool {
    z.abs() > DRIFT_ALARM
}

/// Computes the z-score of a drift over all stages, sum / sqrt(count), which may be significant although that of no single stage
/// is.
///
/// Chance drifts of neighbouring stages cancel in part (a stage that ends too high by chance is followed by a fall),
/// so this understates the drift.
pub(super) fn pooled_z(z: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = z.len().max(1) as f64;
    z.sum::<f64>() / count.sqrt()
}

/// Computes the z-score of the mean of paired changes whose members of one cluster may be dependent: `z = sum d_i / sqrt(sum_c
/// (sum_{i in c} (d_i - mean d))^2)`.
///
/// Chains that start from one ancestor share their start, so only clusters are independent. The start's own sampling error is
/// covered: a chain that forgets its start changes by (new - start), and the clusters' sums of the starts have the variance of
/// the weighted sample they were drawn from. 0 when nothing changes. Where the clusters do not show the spread (one cluster, or
/// all alike) the z-score is unbounded; it is then [`DRIFT_UNKNOWN`], with the sign of the change.
fn clustered_z(changes: &[f64], clusters: &[usize]) -> f64 {
    let total: f64 = changes.iter().sum();
    if total.abs() <= 0.0 || changes.is_empty() {
        return 0.0;
    }
    let mean = total / changes.len() as f64;
    let sums = cluster_sums(changes.iter().map(|d| d - mean), clusters);
    let variance: f64 = sums.iter().map(|sum| sum * sum).sum();
    let z = total / variance.sqrt();
    if z.abs() < DRIFT_UNKNOWN {
        z
    } else {
        DRIFT_UNKNOWN.copysign(total)
    }
}

/// Sums of `values` by cluster, indexed by cluster.
fn cluster_sums(values: impl Iterator<Item = f64>, clusters: &[usize]) -> Vec<f64> {
    let size = clusters.iter().max().map_or(0, |max| max + 1);
    let mut sums = vec![0.0; size];
    for (value, &cluster) in values.zip(clusters) {
        sums[cluster] += value;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::rng::Stream;

    #[test]
    fn z_of_independent_changes_is_the_usual_one() {
        // Mean 1, deviations -1, 1, 0: 3 / sqrt(2).
        let z = clustered_z(&[0.0, 2.0, 1.0], &[0, 1, 2]);
        assert!((z - 3.0 / 2.0_f64.sqrt()).abs() < 1e-12);
        assert!(clustered_z(&[0.0, 0.0], &[0, 1]).abs() < 1e-300);
    }

    /// Weighted sample, duplicates and all: the z-scores of 400 stages in equilibrium have unit variance.
    #[test]
    fn z_is_calibrated_for_resampled_populations() {
        let mut squares = 0.0;
        for replicate in 0..400 {
            let mut stream = Stream::new(5, 0, 0, replicate);
            // Target N(0, 1) from draws of N(0, 1.5^2); fresh ends.
            let draws: Vec<f64> = stream.normals(200).iter().map(|z| 1.5 * z).collect();
            let weights: Vec<f64> = draws
                .iter()
                .map(|x| libm::exp(-0.5 * x * x * (1.0 - 1.0 / 2.25)))
                .collect();
            let sum: f64 = weights.iter().sum();
            let weights: Vec<f64> = weights.iter().map(|w| w / sum).collect();
            let ancestors = super::super::transition::systematic(&weights, 200, stream.uniform());
            let ends = stream.normals(200);
            let changes: Vec<f64> = ancestors
                .iter()
                .zip(&ends)
                .map(|(&a, end)| end - draws[a])
                .collect();
            squares += clustered_z(&changes, &ancestors).powi(2);
        }
        let variance = squares / 400.0;
        assert!((0.7..1.2).contains(&variance), "{variance}");
    }
}
