//! The expected information of proposed runs on the explanations, from their joint prediction (step 13).

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::laplace::evidence::log_sum_exp;
use statistics::rng::Stream;

/// Number of simulated outcomes, for each explanation, over which the information is averaged.
const OUTCOMES: usize = 200;
/// A run distinguishes two explanations whose predictions differ by more standard deviations than this.
const APART: f64 = 2.0;
/// Probability above which an explanation is claimed.
const SETTLED: f64 = 0.9;
/// Random streams of the outcomes, beside those of the posterior draws.
const STAGE: u64 = (1 << 43) + 1;

/// The prediction of an explanation: each channel of the first run, then of the next.
#[derive(Debug, Clone)]
pub(super) struct Prediction {
    pub(super) mean: Vec<f64>,
    /// The change by one standard deviation along each axis of the posterior.
    pub(super) columns: Vec<Vec<f64>>,
}

/// The predictions of all explanations, with the random numbers of their simulated outcomes.
pub(super) struct Predictive<'a> {
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
    /// Returns the log density up to a constant common to all explanations.
    fn log_density(&self, outcome: &DVector<f64>) -> f64 {
        -0.5 * self.whitened(&(outcome - &self.mean)).norm_squared() - self.half_log_determinant
    }

    fn whitened(&self, difference: &DVector<f64>) -> DVector<f64> {
        let whitened = self.factor.solve_lower_triangular(difference);
        whitened.unwrap_or_else(|| difference.clone())
    }
}

impl<'a> Predictive<'a> {
    /// Draws the random numbers of the simulated outcomes.
    ///
    /// # Arguments
    /// - `predictions`: probability and prediction of each explanation. `max_runs`: largest number of runs made together.
    pub(super) fn new(
        predictions: Vec<(f64, &'a Prediction)>,
        noise_sds: &'a [f64],
        max_runs: usize,
        seed: u64,
    ) -> Self {
        let total: f64 = predictions.iter().map(|(probability, _)| probability).sum();
        let outcomes = |m: usize| {
            let outcomes = (0..OUTCOMES as u64)
                .map(|k| Stream::new(seed, STAGE, m as u64, k).normals(max_runs * noise_sds.len()));
            outcomes.collect()
        };
        Self {
            normals: (0..predictions.len()).map(outcomes).collect(),
            predictions: predictions
                .into_iter()
                .map(|(p, prediction)| (p / total, prediction))
                .collect(),
            noise_sds,
        }
    }

    /// Returns the expected information of runs made together, `sum_m P_m E_m[ln p(y | m) - ln sum_k P_k p(y | k)]`, where p is
    /// normal with the covariance of noise and parameters. All runs share the parameters, so a run whose prediction depends on
    /// them as that of another run adds little.
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
            .map(|(_, prediction)| self.normal(prediction, runs))
            .collect();
        let normals = normals?;
        let mut nats = 0.0;
        for (m, normal) in normals.iter().enumerate() {
            let mut sum = 0.0;
            for z in &self.normals[m] {
                let z = DVector::from_column_slice(&z[..normal.mean.len()]);
                let outcome = &normal.mean + &normal.factor * z;
                let all = normals.iter().zip(&self.predictions);
                let all = all.map(|(normal, (share, _))| libm::log(*share) + normal.log_density(&outcome));
                let all: Vec<f64> = all.collect();
                sum += all[m] - libm::log(self.predictions[m].0) - log_sum_exp(all.into_iter());
            }
            nats += self.predictions[m].0 * sum / OUTCOMES as f64;
        }
        Some(nats)
    }

    /// Returns the probability that a run raises one explanation above [`SETTLED`], over the same outcomes as the information; 0 where a
    /// covariance is not positive definite.
    ///
    /// Checked by `tests::a_run_settles_what_it_tells_apart`.
    pub(super) fn settles(&self, run: usize) -> f64 {
        let normals: Option<Vec<JointNormal>> = self
            .predictions
            .iter()
            .map(|(_, prediction)| self.normal(prediction, &[run]))
            .collect();
        let Some(normals) = normals else {
            return 0.0;
        };
        let mut probability = 0.0;
        for (m, normal) in normals.iter().enumerate() {
            let is_settled = |z: &&Vec<f64>| {
                let outcome =
                    &normal.mean + &normal.factor * DVector::from_column_slice(&z[..normal.mean.len()]);
                let all = normals.iter().zip(&self.predictions);
                let all: Vec<f64> = all
                    .map(|(normal, (share, _))| libm::log(*share) + normal.log_density(&outcome))
                    .collect();
                let highest = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                highest - log_sum_exp(all.into_iter()) > libm::log(SETTLED)
            };
            let settled = self.normals[m].iter().filter(is_settled).count();
            probability += self.predictions[m].0 * settled as f64 / OUTCOMES as f64;
        }
        probability
    }

    /// Returns the most probable explanation and those that a run distinguishes from it; all others if it distinguishes none.
    pub(super) fn separated(&self, run: usize) -> Vec<usize> {
        let normals: Option<Vec<JointNormal>> = self
            .predictions
            .iter()
            .map(|(_, prediction)| self.normal(prediction, &[run]))
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
        let rivals: Vec<usize> = (0..self.predictions.len()).filter(|k| *k != first).collect();
        let far: Vec<usize> = rivals.iter().copied().filter(apart).collect();
        let named = if far.is_empty() { rivals } else { far };
        std::iter::once(first).chain(named).collect()
    }

    /// Returns the joint prediction of some runs by one explanation.
    fn normal(&self, prediction: &Prediction, runs: &[usize]) -> Option<JointNormal> {
        let channels = self.noise_sds.len();
        let size = runs.len() * channels;
        let selected = |values: &Vec<f64>| {
            let chosen = runs
                .iter()
                .flat_map(|run| &values[run * channels..(run + 1) * channels]);
            DVector::from_iterator(size, chosen.copied())
        };
        let noise = runs.iter().flat_map(|_| self.noise_sds).map(|sd| sd * sd);
        let mut covariance = DMatrix::from_diagonal(&DVector::from_iterator(size, noise));
        for column in &prediction.columns {
            let column = selected(column);
            covariance += &column * column.transpose();
        }
        let factor = Cholesky::new(covariance)?.l();
        Some(JointNormal {
            mean: selected(&prediction.mean),
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
        let predictions = predictions.map(|prediction| (0.3, prediction)).to_vec();
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
    fn a_run_settles_what_it_tells_apart() {
        let [a, b] = [[0.0; 3], [30.0, 0.0, 1.0]].map(|mean| prediction(mean, &[]));
        let predictive = Predictive::new(vec![(0.5, &a), (0.5, &b)], &[1.0], 1, 1);
        assert!((predictive.settles(0) - 1.0).abs() < 1e-12);
        assert!(predictive.settles(1) < 1e-12);
        // The odds exceed 9 where y - 1/2 is beyond ln 9: with a probability of (1 - Phi(2.70) + 1 - Phi(1.70)).
        let share = predictive.settles(2);
        assert!((share - 0.048).abs() < 0.04, "{share}");
    }

    #[test]
    fn a_copy_of_a_run_adds_less_than_one_that_another_parameter_moves() {
        // Explanations that differ by 3 in each run; one unknown offset moves runs 0 and 1, another one run 2.
        let columns = [[5.0, 5.0, 0.0], [0.0, 0.0, 5.0]];
        let [a, b] = [[0.0; 3], [3.0; 3]].map(|mean| prediction(mean, &columns));
        let alone = information([&a, &b], &[0]);
        let [copy, different] = [[0, 1], [0, 2]].map(|runs| information([&a, &b], &runs) - alone);
        assert!(copy < 0.2 * different, "{copy} {different}");
    }

    #[test]
    fn an_unknown_strength_takes_the_information_of_a_difference() {
        let [a, b] = [0.0, 3.0].map(|mean| prediction([mean; 3], &[]));
        let unsure = prediction([3.0; 3], &[[6.0; 3]]);
        assert!(information([&a, &unsure], &[0]) < information([&a, &b], &[0]) - 0.1);
    }
}
