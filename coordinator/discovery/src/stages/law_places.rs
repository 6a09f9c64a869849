//! The places where a law may act: a quantity, and the variable that it depends on.

use std::collections::BTreeMap;

use crate::stages::hypotheses::Hypotheses;
use crate::stages::weighing::Weighing;
use crate::task::SearchTask;

/// The places are listed until they have this probability together.
const LISTED: f64 = 0.95;

/// The probabilities of all laws, each by the sets that have it.
pub(super) struct LawPlaces {
    of_laws: BTreeMap<usize, f64>,
}

impl LawPlaces {
    /// Sums the probabilities of the sets with each law. Laws without effects are one set, whose evidence is their mean; each law has its
    /// share of that mean.
    pub(super) fn new(task: &SearchTask, hypotheses: &Hypotheses, weighing: &Weighing) -> Self {
        let scan = hypotheses.laws.iter();
        let shares = scan.flat_map(|scan| scan.shares(task.laws.len(), weighing.misfit));
        let shares: Vec<(usize, f64)> = shares.map(|(law, share)| (law.law, share)).collect();
        let mut of_laws = BTreeMap::new();
        let mut add = |law: usize, probability: f64| *of_laws.entry(law).or_insert(0.0) += probability;
        for set in &weighing.sets {
            match &set.effects {
                None => {
                    for (law, share) in &shares {
                        add(*law, set.probability * share);
                    }
                }
                Some(effects) => {
                    for law in effects.iter().filter_map(|k| task.law_of(*k)) {
                        add(law, set.probability);
                    }
                }
            }
        }
        Self { of_laws }
    }

    /// Returns the probability of the laws that contradict a law: they change another quantity.
    ///
    /// # Arguments
    /// - `law`: index of the law in the task.
    pub(super) fn rival_probability(&self, task: &SearchTask, law: usize) -> f64 {
        let curve = &task.laws[law].curve;
        let is_rival = |other: usize| other != law && !task.laws[other].curve.shares_quantity(curve);
        let rivals = self.of_laws.iter().filter(|(other, _)| is_rival(**other));
        rivals.map(|(_, probability)| probability).sum()
    }

    /// Returns the most probable laws, by falling probability among all laws: as many as have 0.95 of it together, and a given law.
    ///
    /// # Arguments
    /// - `law`: index of the law in the task.
    pub(super) fn leading(&self, law: usize) -> Vec<(usize, f64)> {
        let of_all: f64 = self.of_laws.values().sum();
        let mut shares: Vec<(usize, f64)> = self
            .of_laws
            .iter()
            .map(|(law, probability)| (*law, probability / of_all.max(f64::MIN_POSITIVE)))
            .collect();
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut before = 0.0;
        shares.retain(|(other, share)| {
            let is_listed = before < LISTED || *other == law;
            before += share;
            is_listed
        });
        shares
    }
}
