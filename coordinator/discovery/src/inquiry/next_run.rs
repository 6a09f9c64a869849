//! Which run would tell the remaining explanations apart.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::asked::{Asked, Model};
use super::task::{Proposed, Task};
use crate::descent::Descent;
use crate::evidence::log_sum_exp;
use statistics::likelihood::Likelihood;
use statistics::rng::Stream;

/// Draws of each explanation.
const DRAWS: usize = 16;
/// Outcomes of a run that its information is averaged over, for each explanation.
const OUTCOMES: usize = 200;
/// Most runs that are proposed.
const MOST: usize = 3;
/// A run that tells less is not worth its sand \[nats\].
const LEAST: f64 = 0.02;
/// Explanations whose predictions differ by more standard deviations are told apart by a run.
const APART: f64 = 2.0;
/// Streams of the draws and of the outcomes.
const STAGE: u64 = 1 << 43;

/// An explanation that remains.
#[derive(Debug, Clone)]
pub(super) struct Explanation<'a> {
    /// Its effects beyond the base.
    pub(super) effects: Vec<usize>,
    pub(super) probability: f64,
    pub(super) fit: &'a Descent,
}

/// A proposed run.
#[derive(Debug, Clone, PartialEq)]
pub struct NextRun {
    /// Which of the proposed runs.
    pub run: usize,
    /// Expected information on which explanation holds \[nats\].
    pub information_nats: f64,
    /// The explanations that it tells from the most probable one, and that one: sets of candidates; none for the base.
    pub separates: Vec<Vec<usize>>,
}

/// One explanation with its draws.
#[derive(Debug, Clone)]
struct Drawn {
    effects: Vec<usize>,
    probability: f64,
    thetas: Vec<Vec<f64>>,
    /// The values that the model gave, each a channel of a run.
    values: Vec<Vec<f64>>,
}

/// Draws of the explanations on the proposed runs.
#[derive(Debug, Clone)]
pub(super) struct NextRuns {
    drawn: Vec<Drawn>,
    proposed: Proposed,
    seed: u64,
    is_told: bool,
}

/// What an explanation predicts of one run: mean and covariance, noise included.
struct Predicted {
    mean: DVector<f64>,
    factor: DMatrix<f64>,
    half_log_determinant: f64,
}

impl Predicted {
    /// ln density but for the constant that all have.
    fn log_density(&self, outcome: &DVector<f64>) -> f64 {
        let whitened = self
            .factor
            .solve_lower_triangular(&(outcome - &self.mean))
            .unwrap_or_else(|| outcome.clone());
        -0.5 * whitened.norm_squared() - self.half_log_determinant
    }
}

/// Draws of a fit's posterior by Laplace's approximation, those that the prior allows. The mode itself is the first: where few draws
/// are possible it still speaks.
pub(super) fn draws(
    fit: &Descent,
    likelihood: &Likelihood,
    seed: u64,
    number: u64,
    count: usize,
) -> Vec<Vec<f64>> {
    let factor = Cholesky::new(fit.parabola(likelihood).hessian).map(|c| c.inverse());
    let factor = factor.and_then(Cholesky::new).map(|c| c.l());
    let mode = DVector::from_column_slice(&fit.point.position);
    let draw = |k: usize| {
        let z = Stream::new(seed, STAGE, number, k as u64).normals(mode.len());
        let moved = factor.as_ref().map(|l| l * DVector::from_vec(z))?;
        let position: Vec<f64> = (&mode + moved).iter().copied().collect();
        fit.frame.holds(&position).then(|| fit.frame.theta(&position))
    };
    let first = std::iter::once(fit.frame.theta(&fit.point.position));
    first.chain((1..count).filter_map(draw)).collect()
}

impl NextRuns {
    /// `None` where nothing is open: fewer than two explanations, or no run that could be made.
    pub(super) fn new(task: &Task, explanations: Vec<Explanation>) -> Option<Self> {
        if explanations.len() < 2 || task.proposed.values() == 0 {
            return None;
        }
        let seed = task.settings.seed;
        let drawn = explanations.into_iter().enumerate().map(|(number, explanation)| {
            let fit = explanation.fit;
            Drawn {
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

    pub(super) fn wanted(&self) -> Vec<Asked> {
        if self.is_told {
            return Vec::new();
        }
        let of = |drawn: &Drawn| {
            let model = Model::With(drawn.effects.clone());
            let asked = drawn.thetas.iter().map(move |theta| Asked {
                model: model.clone(),
                is_proposed: true,
                theta: theta.clone(),
            });
            asked.collect::<Vec<_>>()
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
    pub(super) fn best(&self) -> Vec<NextRun> {
        let mut runs: Vec<NextRun> = (0..self.proposed.runs)
            .filter_map(|run| self.judge(run))
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

    /// The expected information of a run, `sum_m P_m E[ln p(y | m) - ln sum_k P_k p(y | k)]`, each explanation's outcomes taken to be
    /// normal about the mean of its draws; `None` where an explanation cannot predict it.
    fn judge(&self, run: usize) -> Option<NextRun> {
        let predicted: Option<Vec<Predicted>> = self
            .drawn
            .iter()
            .map(|drawn| self.predicted(drawn, run))
            .collect();
        let predicted = predicted?;
        let total: f64 = self.drawn.iter().map(|drawn| drawn.probability).sum();
        let shares: Vec<f64> = self.drawn.iter().map(|d| d.probability / total).collect();
        let mut information = 0.0;
        for (m, own) in predicted.iter().enumerate() {
            let mut sum = 0.0;
            for k in 0..OUTCOMES {
                let z = Stream::new(self.seed, STAGE + 1, m as u64, k as u64).normals(own.mean.len());
                let outcome = &own.mean + &own.factor * DVector::from_vec(z);
                let all = predicted.iter().zip(&shares);
                let all: Vec<f64> = all
                    .map(|(p, share)| libm::log(*share) + p.log_density(&outcome))
                    .collect();
                sum += own.log_density(&outcome) - log_sum_exp(all.into_iter());
            }
            information += shares[m] * sum / OUTCOMES as f64;
        }
        let first = (0..shares.len()).reduce(|a, b| if shares[b] > shares[a] { b } else { a })?;
        let apart = |k: &usize| {
            let difference = &predicted[*k].mean - &predicted[first].mean;
            let wider = [*k, first].map(|i| {
                let whitened = predicted[i].factor.solve_lower_triangular(&difference);
                whitened.map_or(0.0, |w| w.norm())
            });
            wider[0].min(wider[1]) > APART
        };
        let others: Vec<usize> = (0..shares.len()).filter(|k| *k != first).collect();
        let far: Vec<usize> = others.iter().copied().filter(apart).collect();
        let named = if far.is_empty() { others } else { far };
        let separates = std::iter::once(first).chain(named);
        Some(NextRun {
            run,
            // An average over draws may come out below zero where nothing is told apart.
            information_nats: information.max(0.0),
            separates: separates.map(|k| self.drawn[k].effects.clone()).collect(),
        })
    }

    fn predicted(&self, drawn: &Drawn, run: usize) -> Option<Predicted> {
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
        (!outcomes.is_empty()).then_some(Predicted {
            mean,
            factor,
            half_log_determinant,
        })
    }
}
