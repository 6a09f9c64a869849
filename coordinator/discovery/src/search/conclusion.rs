//! The conclusion of a search.

use crate::chi_square::{FitChiSquare, residuals};
use crate::effect_search::ranking::EffectRanking;
use crate::laplace::draws::draws;
use crate::laplace::fit::LaplaceFit;
use crate::probability::DETECTED;
use crate::search::hypotheses::FittedLaw;
use crate::search::next_run::{InformativeRun, RunChoice};
use crate::search::noise_support::unsupported_noise;
use crate::search::state::SearchState;
use crate::search::verdict::SearchVerdict;
use crate::search::weighing::{WeighedSet, Weighing};
use crate::task::SearchTask;

/// Most of the library's chi-square excess that a law outside the library may leave.
const MOST_LEFT: f64 = 0.25;
/// Posterior draws of a model, and their random streams, after those of the open explanations.
const DRAWS: usize = 33;
const OF_BASE: u64 = 1000;
const OF_BEST: u64 = 1001;

/// A model with posterior draws of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct PosteriorModel {
    /// Its effects beyond the base.
    pub effects: Vec<usize>,
    /// Draws of the base's parameters and theirs by Laplace's approximation, the mode first.
    pub draws: Vec<Vec<f64>>,
}

/// A law outside the library.
#[derive(Debug, Clone, PartialEq)]
pub struct OutsideLaw {
    /// Index of the law in the task.
    pub law: usize,
    /// Its form, or its curve.
    pub candidate: usize,
    /// Log evidence over that of the base.
    pub log_bayes_factor: f64,
    /// Its most probable parameters.
    pub parameters: Vec<f64>,
    /// Log predictive density of left-out levels over that of the base and of the library's best.
    pub left_out_nats: [f64; 2],
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Conclusion {
    /// What the data support.
    pub verdict: SearchVerdict,
    /// The parameter of the base that the best explanation puts near the limit of the search, by its index, with its normal score:
    /// evidences then measure how each explanation relieves that prior, and nothing is claimed. `None` without one.
    pub implausible: Option<(usize, f64)>,
    /// The inferred noise sds, by their parameters of the base, that are not known well enough for a claim: nothing is claimed then. Empty
    /// where nothing was detected.
    pub unsupported_noise: Vec<usize>,
    /// The single effects, with the probabilities of all explanations.
    pub ranking: EffectRanking,
    /// Log Bayes factor and probability of a law outside the library; `None`: not searched.
    pub not_in_library: Option<(f64, f64)>,
    /// Predicted values of the data by the best law outside the library; `None`: none was fitted.
    pub predicted_by_law: Option<Vec<f64>>,
    /// Every model that was compared, by falling probability.
    pub sets: Vec<WeighedSet>,
    /// The effect with which to begin, where the verdict is open but evidence and prediction agree on the best set.
    pub agreed: Option<usize>,
    /// Whether the best explanation leaves nothing to explain by the declared noise; `None` where the noise is not known.
    pub complete: Option<bool>,
    /// The share of the base's excess chi-square that the best explanation takes away, 0 to 1; `None` without an excess, and where the
    /// noise is not known.
    pub explained: Option<f64>,
    /// What the best explanation leaves of each datum, in noise sds (declared and numerical); empty where it is complete or the noise is not known.
    pub remaining: Vec<f64>,
    /// Chi-square of the best explanation over its degrees of freedom, by which log Bayes factors are divided before they become
    /// probabilities; 1 where it fits.
    pub misfit: f64,
    /// The law outside the library, if that is the verdict.
    pub outside: Option<OutsideLaw>,
    /// The effects of the best combination.
    pub combination: Vec<usize>,
    /// Log Bayes factor of the base over each of its reductions; `None` where that cannot be fitted.
    pub gains: Vec<Option<f64>>,
    /// Goodness of fit of the base.
    pub chi_square: Option<FitChiSquare>,
    /// Goodness of fit of the best explanation.
    pub chi_square_best: Option<FitChiSquare>,
    /// The base.
    pub base: PosteriorModel,
    /// The base with the law or the best combination.
    pub best: PosteriorModel,
    /// Runs to make next.
    pub next_runs: Vec<InformativeRun>,
    /// Index of each proposed run with what it would tell by itself \[nats\]; empty where no explanations are compared.
    pub information: Vec<(usize, f64)>,
    /// Scatter of the model's predictions about a smooth function of its parameters, which counts as noise: an sd for each channel by its
    /// index, in its unit; empty where it is negligible.
    pub numerical_noise_sds: Vec<f64>,
    /// All evaluations; those of the search for one effect stand in the ranking.
    pub evaluations: usize,
}

/// Whether a law explains the misfit of the library's best: it fits, or leaves little of the excess.
fn explains(task: &SearchTask, of_library: Option<FitChiSquare>, law: &FittedLaw) -> bool {
    match (of_library, FitChiSquare::of(&law.fit, &task.likelihood)) {
        (Some(library), Some(own)) => !own.is_wrong() || own.excess() < MOST_LEFT * library.excess(),
        _ => true,
    }
}

impl Conclusion {
    pub(super) fn new(state: &SearchState, choice: RunChoice) -> Self {
        let SearchState {
            task,
            hypotheses,
            evaluations,
            numerical_noise_sds,
            ..
        } = state;
        let weighing = Weighing::new(task, hypotheses);
        let chi_square = |fit: &LaplaceFit| FitChiSquare::of(fit, &task.likelihood);
        let of_library = hypotheses.detected_of_library(task.library.len());
        let of_library = of_library.map(|best| &best.fit).or(hypotheses.base_fit());
        let law = hypotheses.confirmed_law();
        let law = law.filter(|law| explains(task, of_library.and_then(chi_square), law));
        let supported = SearchVerdict::new(
            task,
            &weighing,
            hypotheses,
            law,
            hypotheses.is_incomplete(&task.likelihood),
        );
        let law = law.filter(|_| supported == SearchVerdict::NotInLibrary);
        let detected = hypotheses.detected();
        let base = hypotheses.base_fit();
        let (effects, fit) = match (law, detected) {
            (Some(law), _) => (vec![law.candidate], Some(&law.fit)),
            (None, Some(best)) => (best.effects.clone(), Some(&best.fit)),
            (None, None) => (Vec::new(), base),
        };
        // A parameter that only the base needs far out is how a missing effect shows.
        let explained_by = law.map(|law| &law.fit).or(detected.map(|best| &best.fit));
        let implausible = explained_by
            .filter(|_| supported != SearchVerdict::NothingDetectable)
            .and_then(|fit| fit.frame.implausible(&fit.point.position));
        let unsupported_noise = match (base, explained_by) {
            (Some(base), Some(best)) if supported != SearchVerdict::NothingDetectable => {
                unsupported_noise(task, base, best)
            }
            _ => Vec::new(),
        };
        let is_withheld = implausible.is_some() || !unsupported_noise.is_empty();
        let verdict = match supported {
            claim if is_withheld && claim.is_claim() => SearchVerdict::Undecided,
            supported => supported,
        };
        let model = |effects: Vec<usize>, fit: Option<&LaplaceFit>, number: u64| PosteriorModel {
            effects,
            draws: fit.map_or(Vec::new(), |fit| {
                draws(fit, &task.likelihood, task.settings.seed, number, DRAWS)
            }),
        };
        let known = |fit: &LaplaceFit| FitChiSquare::of_known_noise(fit, &task.likelihood);
        let (before, after) = (base.and_then(known), fit.and_then(known));
        let excess = before.map(|chi| chi.excess()).filter(|excess| *excess > 0.0);
        let left = after.map(|chi| chi.excess().max(0.0));
        let incomplete = fit.filter(|_| after.is_some_and(|chi| !chi.is_complete()));
        Self {
            verdict,
            implausible,
            unsupported_noise,
            remaining: incomplete.map_or(Vec::new(), |fit| residuals(fit, &task.likelihood)),
            complete: after.map(|chi| chi.is_complete()),
            explained: excess
                .zip(left)
                .map(|(excess, left)| (1.0 - left / excess).max(0.0)),
            agreed: weighing
                .agreed()
                .filter(|_| verdict == SearchVerdict::Undecided && !is_withheld),
            ranking: weighing.ranking,
            not_in_library: weighing.not_in_library,
            predicted_by_law: hypotheses.laws.as_ref().and_then(|scan| {
                let law = scan.laws.get(scan.confirmed.unwrap_or(0))?;
                Some(law.fit.point.values.clone())
            }),
            sets: weighing.sets,
            misfit: weighing.misfit,
            outside: law
                .filter(|_| verdict == SearchVerdict::NotInLibrary)
                .map(|law| OutsideLaw {
                    law: law.law,
                    candidate: law.candidate,
                    log_bayes_factor: law.log_bayes_factor,
                    parameters: law.fit.theta()[task.prior.dimension()..].to_vec(),
                    left_out_nats: law.left_out.unwrap_or([0.0; 2]),
                }),
            combination: detected.map_or(Vec::new(), |best| best.effects.clone()),
            gains: hypotheses.gains.clone(),
            chi_square: base.and_then(chi_square),
            chi_square_best: law.map_or_else(
                || hypotheses.chi_square(&task.likelihood),
                |law| chi_square(&law.fit),
            ),
            base: model(Vec::new(), base, OF_BASE),
            best: model(effects, fit, OF_BEST),
            next_runs: choice.runs,
            information: choice.alone,
            numerical_noise_sds: numerical_noise_sds.clone(),
            evaluations: *evaluations,
        }
    }

    /// The reductions without which the base loses no detectable evidence: effects that may be dropped.
    pub fn redundant(&self) -> impl Iterator<Item = usize> {
        let gains = self.gains.iter().enumerate();
        gains
            .filter(|(_, gain)| gain.is_some_and(|gain| gain < DETECTED))
            .map(|(k, _)| k)
    }
}
