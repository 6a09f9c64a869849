//! The expected information of runs not yet made.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::laplace::draws::draws;
use crate::laplace::evidence::log_sum_exp;
use crate::laplace::fit::LaplaceFit;
use crate::search::query::{QueriedModel, Query};
use crate::task::{ProposedRuns, SearchTask};
use statistics::rng::Stream;

/// Draws of each explanation.
const DRAWS: usize = 16;
/// Outcomes of a run that its information is averaged over, for each explanation.
const OUTCOMES: usize = 200;
/// Most runs that are proposed.
const MOST: usize = 3;
/// A run with less information is not proposed \[nats\].
const LEAST: f64 = 0.02;
/// A run distinguishes explanations whose predictions differ by more standard deviations.
const APART: f64 = 2.0;
/// Random streams of the outcomes, beside those of the posterior draws.
const STAGE: u64 = (1 << 43) + 1;

/// An explanation that remains open.
#[derive(Debug, Clone)]
pub(super) struct OpenHypothesis<'a> {
    /// Its effects beyond the base.
    pub(super) effects: Vec<usize>,
    pub(super) probability: f64,
    pub(super) fit: &'a LaplaceFit,
}

/// A run that would distinguish the explanations.
#[derive(Debug, Clone, PartialEq)]
pub struct InformativeRun {
    /// Index among the proposed runs.
    pub run: usize,
    /// Expected information on the explanations \[nats\].
    pub information_nats: f64,
    /// The most probable explanation and those that the run distinguishes from it: combinations of candidates, empty for the base.
    pub separates: Vec<Vec<usize>>,
}

/// An explanation with its posterior draws.
#[derive(Debug, Clone)]
struct DrawnHypothesis {
    effects: Vec<usize>,
    probability: f64,
    thetas: Vec<Vec<f64>>,
    /// The predicted values of each draw: each channel of the first run, then of the next.
    values: Vec<Vec<f64>>,
}

/// The comparison of the explanations on the proposed runs.
#[derive(Debug, Clone)]
pub(super) struct RunSelection {
    drawn: Vec<DrawnHypothesis>,
    proposed: ProposedRuns,
    seed: u64,
    is_told: bool,
}

/// The posterior predictive of one run, noise included.
struct RunPrediction {
    mean: DVector<f64>,
    factor: DMatrix<f64>,
    half_log_determinant: f64,
}

impl RunPrediction {
    /// Log density up to a constant that all share.
    fn log_density(&self, outcome: &DVector<f64>) -> f64 {
        let whitened = self
            .factor
            .solve_lower_triangular(&(outcome - &self.mean))
            .unwrap_or_else(|| outcome.clone());
        -0.5 * whitened.norm_squared() - self.half_log_determinant
    }
}

impl RunSelection {
    /// `None` with fewer than two explanations or without proposed runs.
    pub(super) fn new(task: &SearchTask, explanations: Vec<OpenHypothesis>) -> Option<Self> {
        if explanations.len() < 2 || task.proposed.values() == 0 {
            return None;
        }
        let seed = task.settings.seed;
        let drawn = explanations.into_iter().enumerate().map(|(number, explanation)| {
            let fit = explanation.fit;
            DrawnHypothesis {
                effects: explanation.effects,
                probability: explanation.probability,
                thetas: draws(fit, &task.likelihood, seed, number as u64, DRAWS),
                values: Vec::new(),
            }
        });
        Some(Self {
            drawn: drawn.collect(),
            proposed: task.proposed.clone(),
            seed,
            is_told: false,
        })
    }

    pub(super) fn queries(&self) -> Vec<Query> {
        if self.is_told {
            return Vec::new();
        }
        let of = |drawn: &DrawnHypothesis| {
            let model = QueriedModel::With(drawn.effects.clone());
            let queries = drawn.thetas.iter().map(move |theta| Query {
                model: model.clone(),
                is_proposed: true,
                theta: theta.clone(),
            });
            queries.collect::<Vec<_>>()
        };
        self.drawn.iter().flat_map(of).collect()
    }

    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        self.is_told = true;
        let mut answers = answers.into_iter();
        for drawn in &mut self.drawn {
            let own = answers.by_ref().take(drawn.thetas.len());
            drawn.values = own.flatten().collect();
        }
    }

    /// The most informative runs, the best first.
    pub(super) fn best(&self) -> Vec<InformativeRun> {
        let mut runs: Vec<InformativeRun> = (0..self.proposed.runs)
            .filter_map(|run| self.information(run))
            .collect();
        runs.sort_by(|a, b| b.information_nats.total_cmp(&a.information_nats));
        runs.retain(|run| run.information_nats >= LEAST);
        let mut groups = Vec::new();
        runs.retain(|run| {
            let group = self.proposed.groups[run.run];
            let is_new = !groups.contains(&group);
            groups.push(group);
            is_new
        });
        runs.truncate(MOST);
        runs
    }

    /// The expected information of a run, `sum_m P_m E[ln p(y | m) - ln sum_k P_k p(y | k)]`, with normal predictives; `None` where an
    /// explanation cannot predict it.
    ///
    /// # Source
    /// Lindley 1956, doi:10.1214/aoms/1177728069.
    fn information(&self, run: usize) -> Option<InformativeRun> {
        let predicted: Option<Vec<RunPrediction>> = self
            .drawn
            .iter()
            .map(|drawn| self.predicted(drawn, run))
            .collect();
        let predicted = predicted?;
        let total: f64 = self.drawn.iter().map(|drawn| drawn.probability).sum();
        let shares: Vec<f64> = self.drawn.iter().map(|d| d.probability / total).collect();
        let mut nats = 0.0;
        for (m, own) in predicted.iter().enumerate() {
            let mut sum = 0.0;
            for k in 0..OUTCOMES {
                let z = Stream::new(self.seed, STAGE, m as u64, k as u64).normals(own.mean.len());
                let outcome = &own.mean + &own.factor * DVector::from_vec(z);
                let all = predicted.iter().zip(&shares);
                let all: Vec<f64> = all
                    .map(|(p, share)| libm::log(*share) + p.log_density(&outcome))
                    .collect();
                sum += own.log_density(&outcome) - log_sum_exp(all.into_iter());
            }
            nats += shares[m] * sum / OUTCOMES as f64;
        }
        let first = (0..shares.len()).reduce(|a, b| if shares[b] > shares[a] { b } else { a })?;
        let apart = |k: &usize| {
            let difference = &predicted[*k].mean - &predicted[first].mean;
            let distances = [*k, first].map(|i| {
                let whitened = predicted[i].factor.solve_lower_triangular(&difference);
                whitened.map_or(0.0, |w| w.norm())
            });
            distances[0].min(distances[1]) > APART
        };
        let others: Vec<usize> = (0..shares.len()).filter(|k| *k != first).collect();
        let far: Vec<usize> = others.iter().copied().filter(apart).collect();
        let named = if far.is_empty() { others } else { far };
        let separates = std::iter::once(first).chain(named);
        Some(InformativeRun {
            run,
            // A Monte Carlo mean may be negative where the information is zero.
            information_nats: nats.max(0.0),
            separates: separates.map(|k| self.drawn[k].effects.clone()).collect(),
        })
    }

    fn predicted(&self, drawn: &DrawnHypothesis, run: usize) -> Option<RunPrediction> {
        let channels = self.proposed.noise_sds.len();
        let of_run =
            |values: &Vec<f64>| DVector::from_column_slice(&values[run * channels..(run + 1) * channels]);
        let outcomes: Vec<DVector<f64>> = drawn.values.iter().map(of_run).collect();
        let count = outcomes.len() as f64;
        let mean = outcomes.iter().fold(DVector::zeros(channels), |sum, y| sum + y) / count;
        let mut covariance = DMatrix::from_diagonal(&DVector::from_iterator(
            channels,
            self.proposed.noise_sds.iter().map(|sd| sd * sd),
        ));
        for outcome in &outcomes {
            let off = outcome - &mean;
            covariance += &off * off.transpose() / count;
        }
        let factor = Cholesky::new(covariance)?.l();
        let half_log_determinant = (0..channels).map(|k| libm::log(factor[(k, k)])).sum();
        (!outcomes.is_empty()).then_some(RunPrediction {
            mean,
            factor,
            half_log_determinant,
        })
    }
}
