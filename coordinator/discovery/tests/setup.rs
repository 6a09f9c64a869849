//! Priors, candidates, data and runs that several tests share.

use discovery::{
    Candidate, Conclusion, DiscoverySearch, EffectRanking, EffectRequest, EffectSearch, ProposedRuns, Query,
    SearchSettings, SearchTask,
};
use inference::TellProgress;
use statistics::{Datum, Distribution, ErrorSd, Likelihood, Marginal, Prior};

pub(crate) fn marginal(distribution: Distribution) -> Marginal {
    Marginal::new(distribution, None).unwrap()
}

/// A normal prior of mean 0.
pub(crate) fn normal(sd: f64) -> Marginal {
    marginal(Distribution::Normal { mean: 0.0, sd })
}

pub(crate) fn half_normal(scale: f64) -> Marginal {
    marginal(Distribution::HalfNormal { scale })
}

/// A prior of an inferred noise sd.
pub(crate) fn noise() -> Marginal {
    marginal(Distribution::Lognormal {
        median: 0.2,
        factor: 3.0,
    })
}

/// An effect with one strength.
pub(crate) fn effect(name: &str, prior: Marginal) -> Candidate {
    Candidate::new(name, vec![prior], vec![0])
}

/// One datum of each run, with a declared sd.
pub(crate) fn data(values: &[f64], sd: f64) -> Vec<Datum> {
    let datum = |(run, &value): (usize, &f64)| Datum {
        run,
        channel: 0,
        value,
        sd: ErrorSd::Known(sd),
    };
    values.iter().enumerate().map(datum).collect()
}

/// A search of at most two effects of a library, without laws and proposed runs.
pub(crate) fn pair_task(prior: Vec<Marginal>, likelihood: Likelihood, library: Vec<Candidate>) -> SearchTask {
    SearchTask {
        prior: Prior::new(prior),
        likelihood,
        library,
        laws: Vec::new(),
        strengths: Vec::new(),
        reductions: Vec::new(),
        levels: Vec::new(),
        conditions: Vec::new(),
        proposed: ProposedRuns::default(),
        suspected_errors: Vec::new(),
        max_effects: 2,
        settings: SearchSettings::default(),
    }
}

/// The effects of the best combination, in order.
pub(crate) fn best_effects(conclusion: &Conclusion) -> Vec<usize> {
    let mut effects = conclusion.combination.clone();
    effects.sort_unstable();
    effects
}

/// The indices of a round in the order in which they are told.
fn order(count: usize, backwards: bool) -> Vec<usize> {
    let indices = 0..count;
    if backwards {
        indices.rev().collect()
    } else {
        indices.collect()
    }
}

/// Runs a search for one effect to its end, the last request of each round told first if `backwards`.
pub(crate) fn rank(
    mut search: EffectSearch,
    backwards: bool,
    answer: impl Fn(&EffectRequest) -> Option<Vec<f64>>,
) -> EffectRanking {
    while search.ranking().is_none() {
        let pending: Vec<EffectRequest> = search.pending().collect();
        for index in order(pending.len(), backwards) {
            search.tell(index, answer(&pending[index]).as_deref()).unwrap();
        }
    }
    search.ranking().unwrap().clone()
}

/// Runs a discovery to its end, the last query of each round told first if `backwards`.
pub(crate) fn conclude(
    task: SearchTask,
    backwards: bool,
    answer: impl Fn(&Query) -> Option<Vec<f64>>,
) -> Conclusion {
    let mut search = DiscoverySearch::new(task).unwrap();
    loop {
        if let Some(conclusion) = search.conclusion() {
            return conclusion.clone();
        }
        if search.wanted_formulas().is_some() {
            search.offer_formulas(Vec::new()).unwrap();
        }
        for index in order(search.pending().len(), backwards) {
            let values = answer(search.query(index).unwrap());
            let progress = search.tell(index, values.as_deref()).unwrap();
            assert!(!matches!(progress, TellProgress::Failed(_)));
        }
    }
}
