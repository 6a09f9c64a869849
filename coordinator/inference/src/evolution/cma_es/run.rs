//! One run of CMA-ES from a start, until it converges or is lost.

use std::collections::VecDeque;

use super::rates::Rates;
use super::search_distribution::SearchDistribution;
use crate::evolution::individual::Individual;
use crate::evolution::prior_space::PriorSpace;
use statistics::rng::Stream;

/// First standard deviation along every axis, in prior widths: 0.3 of the range of a uniform prior.
const FIRST_STEP: f64 = 1.0;
/// A run ends when its standard deviations are below this, in prior widths: no simulation resolves such differences,
/// and the thinnest ridge, between the literal moduli of Bekker's law, is 1e-5 wide.
const SHORTEST: f64 = 1e-7;
/// A run ends when its step exceeds this, in prior widths: it has left the prior.
const LONGEST: f64 = 1e4;
/// A run ends when the condition number of its covariance exceeds this: rounding dominates.
const THINNEST: f64 = 1e14;
/// A run ends after this many consecutive generations that the model rejected as a whole.
const LOST: usize = 5;

/// One run of CMA-ES from a start, until it converges or is lost.
#[derive(Debug, Clone)]
pub(super) struct CmaEsRun {
    distribution: SearchDistribution,
    rates: Rates,
    population: usize,
    /// Draws of the pending generation, before they are put within the bounds.
    draws: Vec<Vec<f64>>,
    /// Best log-posterior of the last generations, the newest last.
    recent: VecDeque<f64>,
    /// Consecutive generations that the model rejected as a whole.
    rejected: usize,
    /// Best log-posterior of the run.
    pub(super) best: f64,
    pub(super) end: Option<End>,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// The run converged.
    Converged,
    /// The model rejected every individual of several generations, or the run left the prior.
    Lost,
}

impl CmaEsRun {
    pub(super) fn new(start: &[f64], population: usize) -> Self {
        Self {
            distribution: SearchDistribution::new(start, FIRST_STEP),
            rates: Rates::new(start.len(), population),
            population,
            draws: Vec::new(),
            recent: VecDeque::new(),
            rejected: 0,
            best: f64::NEG_INFINITY,
            end: None,
        }
    }

    pub(super) fn population(&self) -> usize {
        self.population
    }

    /// Draws a generation; its positions within the bounds.
    pub(super) fn draw(&mut self, space: &PriorSpace, seed: u64, generation: u64) -> Vec<Vec<f64>> {
        let dimension = space.dimension();
        self.draws = (0..self.population)
            .map(|k| {
                let normals = Stream::new(seed, generation, k as u64, 1).normals(dimension);
                self.distribution.draw(&normals)
            })
            .collect();
        self.draws.iter().map(|draw| space.inside(draw)).collect()
    }

    /// Updates the distribution by the evaluated generation, and ends the run if it is over.
    pub(super) fn accept(&mut self, generation: &[Individual], tolerance: f64) {
        let mut values: Vec<f64> = generation
            .iter()
            .filter(|individual| individual.is_possible())
            .map(Individual::log_posterior)
            .collect();
        values.sort_by(|a, b| b.total_cmp(a));
        let (Some(&best), Some(&worst)) = (values.first(), values.last()) else {
            self.rejected += 1;
            if self.rejected >= LOST {
                self.end = Some(End::Lost);
            }
            return;
        };
        self.rejected = 0;
        self.best = self.best.max(best);
        self.update(generation, &values);
        self.judge(best, best - worst, tolerance);
    }

    fn update(&mut self, generation: &[Individual], values: &[f64]) {
        // A standard deviation beyond a bound costs half of the generation's range.
        let spread = values[0] - values[values.len() / 2];
        let penalty = spread.max(f64::MIN_POSITIVE) / self.distribution.mean_variance();
        let mut ranked: Vec<(f64, Option<&[f64]>)> = generation
            .iter()
            .zip(&self.draws)
            .map(|(individual, draw)| {
                let pairs = individual.position.iter().zip(draw);
                let beyond: f64 = pairs.map(|(inside, t)| (inside - t) * (inside - t)).sum();
                let value = individual.log_posterior() - penalty * beyond;
                (value, individual.is_possible().then_some(draw.as_slice()))
            })
            .collect();
        // The sort is stable: among equals the one listed first stays first.
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
        let better: Vec<Option<&[f64]>> = ranked.into_iter().map(|(_, draw)| draw).collect();
        self.distribution.update(&self.rates, &better);
    }

    fn judge(&mut self, best: f64, range: f64, tolerance: f64) {
        let dimension = self.distribution.mean.len();
        let window = 10 + (30 * dimension).div_ceil(self.population);
        self.recent.push_back(best);
        if self.recent.len() > window {
            self.recent.pop_front();
        }
        let lowest = self
            .recent
            .iter()
            .fold(f64::INFINITY, |low, &value| low.min(value));
        let highest = self
            .recent
            .iter()
            .fold(f64::NEG_INFINITY, |high, &value| high.max(value));
        let flat = self.recent.len() == window && highest - lowest < tolerance && range < tolerance;
        let widest = self.distribution.widest();
        if flat || widest < SHORTEST || self.distribution.condition() > THINNEST {
            self.end = Some(End::Converged);
        } else if widest.is_nan() || widest > LONGEST {
            self.end = Some(End::Lost);
        }
    }
}
