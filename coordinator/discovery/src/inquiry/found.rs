//! Sets of effects and laws outside the library, as they are found.

use crate::candidate::Candidate;
use crate::chi_square::ChiSquare;
use crate::descent::Descent;
use crate::finding::Finding;
use statistics::likelihood::Likelihood;

/// What the steps have found so far.
#[derive(Debug, Clone)]
pub(super) struct Found {
    /// All candidates.
    pub(super) candidates: Vec<Candidate>,
    /// The base's fit with its log-evidence.
    pub(super) base: Option<(Descent, f64)>,
    /// The search for one effect.
    pub(super) singles: Option<Finding>,
    /// Sets of effects by falling Bayes factor, single ones among them.
    pub(super) sets: Vec<Set>,
    /// Log Bayes factor of the model over itself without each effect that may be dropped; `None` where that fits nowhere.
    pub(super) gains: Vec<Option<f64>>,
    /// Laws outside the library by falling Bayes factor, one for each pair that was fitted; `None`: not looked for.
    pub(super) laws: Option<Vec<Law>>,
    /// Which of them holds on data left out.
    pub(super) confirmed: Option<usize>,
    /// Evaluations when the effect had a name.
    pub(super) to_name: usize,
}

/// Effects that act together.
#[derive(Debug, Clone)]
pub(super) struct Set {
    /// In the order in which their parameters follow the base's.
    pub(super) effects: Vec<usize>,
    /// Over the base.
    pub(super) log_bayes_factor: f64,
    pub(super) fit: Descent,
}

/// A law outside the library.
#[derive(Debug, Clone)]
pub(super) struct Law {
    pub(super) pair: usize,
    /// The candidate that tells it best: a form, or the curve.
    pub(super) candidate: usize,
    pub(super) log_bayes_factor: f64,
    /// Mean of the Bayes factors of curve and forms, in logarithm.
    pub(super) mean_log_bayes_factor: f64,
    pub(super) fit: Descent,
    /// Log predictive density of data left out over that of the base and of the best set of the library.
    pub(super) left_out: Option<[f64; 2]>,
}

/// Each further effect must be worth so much \[nats\]: what the choice among the library costs.
const COST_OF_CHOICE: f64 = 5.0;

impl Found {
    pub(super) fn new(candidates: Vec<Candidate>) -> Self {
        Self {
            candidates,
            base: None,
            singles: None,
            sets: Vec::new(),
            gains: Vec::new(),
            laws: None,
            confirmed: None,
            to_name: 0,
        }
    }

    /// The base's fit.
    pub(super) fn fit(&self) -> Option<&Descent> {
        self.base.as_ref().map(|(fit, _)| fit)
    }

    /// Adds a set unless the same was found with more evidence.
    pub(super) fn add(&mut self, set: Set) {
        let key = |set: &Set| {
            let mut effects = set.effects.clone();
            effects.sort_unstable();
            effects
        };
        let same = self.sets.iter_mut().find(|other| key(other) == key(&set));
        match same {
            Some(other) if other.log_bayes_factor < set.log_bayes_factor => *other = set,
            Some(_) => {}
            None => self.sets.push(set),
        }
        self.sets
            .sort_by(|a, b| b.log_bayes_factor.total_cmp(&a.log_bayes_factor));
    }

    /// The best set, each effect beyond the first weighed by what its choice costs.
    pub(super) fn best_set(&self) -> Option<&Set> {
        let score = |set: &Set| set.log_bayes_factor - COST_OF_CHOICE * (set.effects.len() as f64 - 1.0);
        self.sets
            .iter()
            .reduce(|best, set| if score(set) > score(best) { set } else { best })
    }

    /// How well the best of the library fits, or the base where nothing beats it.
    pub(super) fn best_chi_square(&self, likelihood: &Likelihood, least: f64) -> Option<ChiSquare> {
        let best = self.best_set().filter(|set| set.log_bayes_factor > least);
        ChiSquare::of(best.map(|set| &set.fit).or(self.fit())?, likelihood)
    }
}
