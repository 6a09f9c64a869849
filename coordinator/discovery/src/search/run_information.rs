//! The joint prediction of runs not yet made, and what they would tell about the explanations.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::laplace::evidence::log_sum_exp;
use statistics::rng::Stream;

/// Outcomes of a set of runs that its information is averaged over, for each explanation.
const OUTCOMES: usize = 200;
/// A run distinguishes explanations whose predictions differ by more standard deviations.
const APART: f64 = 2.0;
/// Random streams of the outcomes, beside those of the posterior draws.
const STAGE: u64 = (1 << 43) + 1;

/// What an explanation predicts: each channel of the first run, then of the next.
#[derive(Debug, Clone)]
pub(super) struct Prediction {
    pub(super) mean: Vec<f64>,
    /// The change by one standard deviation along each axis of the posterior.
    pub(super) columns: Vec<Vec<f64>>,
}

/// The predictions of all explanations.
pub(super) struct Predictive<'a> {
    /// With the probability of each.
    predictions: Vec<(f64, &'a Prediction)>,
    noise_sds: &'a [f64],
    /// Standard normal numbers of each outcome of each explanation.
    normals: Vec<Vec<Vec<f64>>>,
}

/// The predicted distribution of some runs, noise included.
struct JointNormal {
    mean: DVector<f64>,
    factor: DMatrix<f64>,
    half_log_determinant: f64,
}

impl JointNormal {
    /// Log density up to a constant that all share.
    fn log_density(&self, outcome: &DVector<f64>) -> f64 {
        -0.5 * self.whitened(&(outcome - &self.mean)).norm_squared() - self.half_log_determinant
    }

    fn whitened(&self, difference: &DVector<f64>) -> DVector<f64> {
        let whitened = self.factor.solve_lower_triangular(difference);
        whitened.unwrap_or_else(|| difference.clone())
    }
}

impl<'a> Predictive<'a> {
    /// # Arguments
    /// - `predictions`: of each explanation, with its probability. `most`: runs that are looked at together.
    pub(super) fn new(
        predictions: Vec<(f64, &'a Prediction)>,
        noise_sds: &'a [f64],
        most: usize,
        seed: u64,
    ) -> Self {
        let total: f64 = predictions.iter().map(|(probability, _)| probability).sum();
        let of = |m: usize| {
            let outcomes = (0..OUTCOMES as u64)
                .map(|k| Stream::new(seed, STAGE, m as u64, k).normals(most * noise_sds.len()));
            outcomes.collect()
        };
        Self {
            normals: (0..predictions.len()).map(of).collect(),
            predictions: predictions.into_iter().map(|(p, own)| (p / total, own)).collect(),
            noise_sds,
        }
    }

    /// The expected information of runs made together, `sum_m P_m E_m[ln p(y | m) - ln sum_k P_k p(y | k)]`, with p the normal whose
    /// covariance is that of noise and parameters. The parameters are those of all runs, so of two runs that a parameter moves
    /// together the second tells little.
    ///
    /// # Returns
    /// Nats; `None` where a covariance is not positive definite.
    ///
    /// # Source
    /// Lindley 1956, doi:10.1214/aoms/1177728069.
    pub(super) fn information(&self, runs: &[usize]) -> Option<f64> {
        let normals: Option<Vec<JointNormal>> = self
            .predictions
            .iter()
            .map(|(_, own)| self.normal(own, runs))
            .collect();
        let normals = normals?;
        let mut nats = 0.0;
        for (m, own) in normals.iter().enumerate() {
            let mut sum = 0.0;
            for z in &self.normals[m] {
                let z = DVector::from_column_slice(&z[..own.mean.len()]);
                let outcome = &own.mean + &own.factor * z;
                let all = normals.iter().zip(&self.predictions);
                let all = all.map(|(normal, (share, _))| libm::log(*share) + normal.log_density(&outcome));
                let all: Vec<f64> = all.collect();
                sum += all[m] - libm::log(self.predictions[m].0) - log_sum_exp(all.into_iter());
            }
            nats += self.predictions[m].0 * sum / OUTCOMES as f64;
        }
        Some(nats)
    }

    /// The most probable explanation and those that a run distinguishes from it, all others if none.
    pub(super) fn separated(&self, run: usize) -> Vec<usize> {
        let normals: Option<Vec<JointNormal>> = self
            .predictions
            .iter()
            .map(|(_, own)| self.normal(own, &[run]))
            .collect();
        let share = |k: usize| self.predictions[k].0;
        let first = (0..self.predictions.len()).reduce(|a, b| if share(b) > share(a) { b } else { a });
        let (Some(normals), Some(first)) = (normals, first) else {
            return Vec::new();
        };
        let apart = |k: &usize| {
            let difference = &normals[*k].mean - &normals[first].mean;
            [*k, first]
                .iter()
                .all(|&i| normals[i].whitened(&difference).norm() > APART)
        };
        let others: Vec<usize> = (0..self.predictions.len()).filter(|k| *k != first).collect();
        let far: Vec<usize> = others.iter().copied().filter(apart).collect();
        let named = if far.is_empty() { others } else { far };
        std::iter::once(first).chain(named).collect()
    }

    fn normal(&self, prediction: &Prediction, runs: &[usize]) -> Option<JointNormal> {
        let channels = self.noise_sds.len();
        let size = runs.len() * channels;
        let of_runs = |values: &Vec<f64>| {
            let own = runs
                .iter()
                .flat_map(|run| &values[run * channels..(run + 1) * channels]);
            DVector::from_iterator(size, own.copied())
        };
        let noise = runs.iter().flat_map(|_| self.noise_sds).map(|sd| sd * sd);
        let mut covariance = DMatrix::from_diagonal(&DVector::from_iterator(size, noise));
        for column in &prediction.columns {
            let column = of_runs(column);
            covariance += &column * column.transpose();
        }
        let factor = Cholesky::new(covariance)?.l();
        Some(JointNormal {
            mean: of_runs(&prediction.mean),
            half_log_determinant: (0..size).map(|k| libm::log(factor[(k, k)])).sum(),
            factor,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The information of runs on two equally probable explanations.
    fn information(predictions: [&Prediction; 2], runs: &[usize]) -> f64 {
        let predictions = predictions.map(|own| (0.3, own)).to_vec();
        let predictive = Predictive::new(predictions, &[1.0], 2, 1);
        predictive.information(runs).expect("the noise has a covariance")
    }

    fn prediction(mean: [f64; 3], columns: &[[f64; 3]]) -> Prediction {
        Prediction {
            mean: mean.to_vec(),
            columns: columns.iter().map(|column| column.to_vec()).collect(),
        }
    }

    #[test]
    fn information_lies_between_none_and_that_of_the_answer() {
        let near = prediction([0.0; 3], &[[1.0; 3]]);
        assert!(information([&near, &near], &[0, 1]).abs() < 1e-12);
        let far = prediction([30.0, 0.0, 0.0], &[[1.0; 3]]);
        assert!((information([&near, &far], &[0]) - std::f64::consts::LN_2).abs() < 1e-6);
        assert!(information([&near, &far], &[1]).abs() < 1e-12);
    }

    #[test]
    fn a_copy_of_a_run_adds_less_than_one_that_another_parameter_moves() {
        // Explanations that differ by 3 in each run; one unknown offset moves runs 0 and 1, another one run 2.
        let columns = [[5.0, 5.0, 0.0], [0.0, 0.0, 5.0]];
        let [a, b] = [[0.0; 3], [3.0; 3]].map(|mean| prediction(mean, &columns));
        let alone = information([&a, &b], &[0]);
        let [copy, other] = [[0, 1], [0, 2]].map(|runs| information([&a, &b], &runs) - alone);
        assert!(copy < 0.2 * other, "{copy} {other}");
    }

    #[test]
    fn an_unknown_strength_takes_the_information_of_a_difference() {
        let [a, b] = [0.0, 3.0].map(|mean| prediction([mean; 3], &[]));
        let unsure = prediction([3.0; 3], &[[6.0; 3]]);
        assert!(information([&a, &unsure], &[0]) < information([&a, &b], &[0]) - 0.1);
    }
}
