//! The conclusion of a discovery: its verdict with everything that is reported beside it (step 13).

use crate::chi_square::{FitChiSquare, residuals};
use crate::effect_search::ranking::EffectRanking;
use crate::laplace::draws::draws;
use crate::laplace::fit::LaplaceFit;
use crate::probability::DETECTED;
use crate::stages::claimable_law::ClaimableLaw;
use crate::stages::formula_fit::FormulaFit;
use crate::stages::held_back::held_back;
use crate::stages::hypotheses::{FittedReplacement, Hypotheses};
use crate::stages::law_curve::LawCurve;
use crate::stages::law_forms::{self, WeighedForm};
use crate::stages::law_places::LawPlaces;
use crate::stages::next_run::{InformativeRun, RunChoice};
use crate::stages::noise_support::unsupported_noise;
use crate::stages::prior_sensitivity::{AlternativePrior, alternative_priors};
use crate::stages::replacement::{self, Replacement};
use crate::stages::scored_fit::ScoredFit;
use crate::stages::shared_errors::{JudgedError, judged_errors};
use crate::stages::state::SearchState;
use crate::stages::verdict::{NAMED, SearchVerdict};
use crate::stages::weighing::{WeighedSet, Weighing};
use crate::task::SearchTask;
use statistics::likelihood::Likelihood;

/// Number of posterior draws of a model, and the numbers of their random streams, which follow those of the open explanations.
const DRAWS: usize = 33;
const BASE_STREAM: u64 = 1000;
const BEST_STREAM: u64 = 1001;

/// A model with posterior draws of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct PosteriorModel {
    /// The effects added to the base.
    pub effects: Vec<usize>,
    /// Draws of all parameters by Laplace's approximation, the mode first.
    pub draws: Vec<Vec<f64>>,
}

impl PosteriorModel {
    /// Draws from the posterior of a model.
    ///
    /// # Arguments
    /// - `fit`: of the model; `None` leaves it without draws. `stream`: number of the random streams.
    fn new(task: &SearchTask, effects: Vec<usize>, fit: Option<&LaplaceFit>, stream: u64) -> Self {
        let draws = fit.map(|fit| draws(fit, &task.likelihood, task.settings.seed, stream, DRAWS));
        Self {
            effects,
            draws: draws.unwrap_or_default(),
        }
    }
}

/// A law outside the library.
#[derive(Debug, Clone, PartialEq)]
pub struct OutsideLaw {
    /// Index of the law in the task.
    pub law: usize,
    /// Index of the candidate: the best form of the law, or its curve.
    pub candidate: usize,
    /// Log evidence over that of the base.
    pub log_bayes_factor: f64,
    /// The most probable laws, this one among them, by falling probability among all laws: they tell where the law may act.
    pub places: Vec<(usize, f64)>,
    /// The curve and every fitted form of the law: the claimed one, then the others by falling Bayes factor.
    pub forms: Vec<WeighedForm>,
    /// The knots of its curve with their covariance; `None` where the curve was not fitted beyond the effects of this explanation.
    pub curve: Option<LawCurve>,
    /// Formulas of the curve that were fitted through the model, by falling Bayes factor; none of a model with numerical noise.
    pub formulas: Vec<FormulaFit>,
    /// Log predictive density of left-out levels over that of the base, and over that of the library's best.
    pub left_out_nats: [f64; 2],
}

impl OutsideLaw {
    fn new(
        law: &ClaimableLaw,
        places: &LawPlaces,
        formulas: &[FormulaFit],
        likelihood: &Likelihood,
        misfit: f64,
    ) -> Self {
        Self {
            law: law.law,
            candidate: law.candidate,
            log_bayes_factor: law.log_bayes_factor,
            places: places.leading(law.law),
            forms: law_forms::weighed(&law.forms, &law.fit, likelihood, misfit),
            curve: law.curve.as_ref().map(|curve| curve.with_misfit(misfit)),
            formulas: formulas.to_vec(),
            left_out_nats: law.left_out,
        }
    }
}

impl OutsideLaw {
    /// Returns the laws that a claim states: this one, if it has more than 0.9 of the probability, otherwise all places.
    pub fn stated(&self) -> Vec<usize> {
        let is_told = |place: &&(usize, f64)| place.0 == self.law && place.1 > NAMED;
        match self.places.iter().find(is_told) {
            Some((law, _)) => vec![*law],
            None => self.places.iter().map(|(law, _)| *law).collect(),
        }
    }
}

/// The result of a search.
///
/// `complete`, `explained`, `remaining`, `chi_square_best` and `shared_errors` describe the best explanation: the replacement if one is
/// claimed, otherwise the law, the best combination, or the base if nothing was detected.
#[derive(Debug, Clone, PartialEq)]
pub struct Conclusion {
    /// The verdict that the data support.
    pub verdict: SearchVerdict,
    /// Index and normal score of a parameter of the best explanation: of the base, near the limit of the search, or a strength more than
    /// 5 sds out in its prior. Evidences then measure how each explanation relieves a prior, so no effect is claimed. `None` if there is
    /// none.
    pub implausible: Option<(usize, f64)>,
    /// Index and normal score of a strength in the base that is held back by its prior, where the leading effect changes the data alike:
    /// it would be more of the same, so it is not claimed. `None` if there is none.
    pub held_back: Option<(usize, f64)>,
    /// Indices of the inferred noise sds that are too uncertain for a claim; nothing is claimed then. Empty if nothing was
    /// detected.
    pub unsupported_noise: Vec<usize>,
    /// The single effects, with the probabilities of all explanations.
    pub ranking: EffectRanking,
    /// Log Bayes factor and probability of a law outside the library; `None`: not searched.
    pub not_in_library: Option<(f64, f64)>,
    /// Predicted values of the data by the best law outside the library; `None`: none was fitted.
    pub predicted_by_law: Option<Vec<f64>>,
    /// Every model that was compared, by falling probability.
    pub sets: Vec<WeighedSet>,
    /// The probabilities of all explanations under other priors.
    pub alternative_priors: Vec<AlternativePrior>,
    /// The effect to begin with, if the verdict is open but evidence and prediction agree on the best set.
    pub agreed: Option<usize>,
    /// Whether the best explanation fits the declared noise; `None` where the noise is not known.
    pub complete: Option<bool>,
    /// The share of the base's excess chi-square that the best explanation removes, 0 to 1; `None` without an excess or with
    /// unknown noise.
    pub explained: Option<f64>,
    /// Residual of each datum under the best explanation, in noise sds (declared and numerical); empty if it is complete or the
    /// noise unknown.
    pub remaining: Vec<f64>,
    /// Chi-square of the best explanation over its degrees of freedom, by which log Bayes factors are divided before they become
    /// probabilities; 1 where it fits.
    pub misfit: f64,
    /// The law outside the library, if that is the verdict.
    pub outside: Option<OutsideLaw>,
    /// The effects of the best combination.
    pub combination: Vec<usize>,
    /// Leading candidates in the place of effects of the base, by falling probability. One that is claimed is the verdict.
    pub replacements: Vec<Replacement>,
    /// Log Bayes factor of the base over each of its reductions; `None` where the reduction cannot be fitted.
    pub gains: Vec<Option<f64>>,
    /// Goodness of fit of the base.
    pub chi_square: Option<FitChiSquare>,
    /// Goodness of fit of the best explanation.
    pub chi_square_best: Option<FitChiSquare>,
    /// The base with posterior draws.
    pub base: PosteriorModel,
    /// The base with the law or the best combination.
    pub best: PosteriorModel,
    /// Runs to make next.
    pub next_runs: Vec<InformativeRun>,
    /// Index of each proposed run with its information when made alone \[nats\]; empty where no explanations are compared.
    pub information: Vec<(usize, f64)>,
    /// The errors that runs share, judged beside the best explanation.
    pub shared_errors: Vec<JudgedError>,
    /// Numerical noise sd of each channel by its index, in its unit, which counts as noise of the data; empty where it is
    /// negligible.
    pub numerical_noise_sds: Vec<f64>,
    /// Number of all evaluations; the ranking has those of the search for one effect.
    pub evaluations: usize,
}

/// The reasons for which a claim is withheld.
#[derive(Default)]
struct Objections {
    implausible: Option<(usize, f64)>,
    held_back: Option<(usize, f64)>,
    unsupported_noise: Vec<usize>,
}

impl Objections {
    /// Collects the objections to a claim. A base that needs a parameter far out in its prior is none: a missing effect has this
    /// consequence.
    ///
    /// # Arguments
    /// - `explanation`: the fit of the law or combination that may be claimed, with its members.
    fn new(
        task: &SearchTask,
        hypotheses: &Hypotheses,
        weighing: &Weighing,
        explanation: Option<(&LaplaceFit, &[usize])>,
        supported: SearchVerdict,
    ) -> Self {
        let base = hypotheses.base_fit();
        // The effect that may be named or added.
        let leading = match supported {
            SearchVerdict::Named(k) => Some(k),
            SearchVerdict::Class(class) => weighing.ranking.leader_of(class),
            SearchVerdict::Undecided => weighing.agreed(),
            SearchVerdict::NothingDetectable | SearchVerdict::NotInLibrary => None,
        };
        let leading = leading.and_then(|k| Some(&hypotheses.single(k)?.fit));
        // A name is withheld for the strength of what it names; other members only accompany it.
        let is_claimed = |member: usize| match supported {
            SearchVerdict::Named(k) => member == k,
            SearchVerdict::Class(class) => weighing.ranking.is_in_class(member, class),
            _ => true,
        };
        let explanation = explanation.filter(|_| supported != SearchVerdict::NothingDetectable);
        let names_effect = supported != SearchVerdict::NotInLibrary;
        Self {
            implausible: explanation.and_then(|(fit, members)| {
                let position = &fit.point.position;
                let strength = || {
                    task.implausible_strength(fit, members, is_claimed)
                        .filter(|_| names_effect)
                };
                fit.frame.implausible(position).or_else(strength)
            }),
            held_back: base
                .zip(leading)
                .and_then(|(base, with)| held_back(task, base, with)),
            unsupported_noise: match (base, explanation) {
                (Some(base), Some((best, _))) => {
                    let [base, best] = [base, best].map(|fit| ScoredFit::new(task, fit));
                    unsupported_noise(&task.conditions, base, best)
                }
                _ => Vec::new(),
            },
        }
    }

    fn any(&self) -> bool {
        self.implausible.is_some() || self.held_back.is_some() || !self.unsupported_noise.is_empty()
    }
}

/// The misfit that an explanation leaves, measured by the declared noise.
struct Remainder {
    complete: Option<bool>,
    explained: Option<f64>,
    residuals: Vec<f64>,
}

impl Remainder {
    fn new(base: Option<ScoredFit>, best: Option<ScoredFit>) -> Self {
        let chi_square = |model: ScoredFit| FitChiSquare::of_declared_noise(model.fit, model.likelihood);
        let (before, after) = (base.and_then(chi_square), best.and_then(chi_square));
        let excess = before.map(|chi| chi.excess()).filter(|excess| *excess > 0.0);
        let left = after.map(|chi| chi.excess().max(0.0));
        let incomplete = best.filter(|_| after.is_some_and(|chi| !chi.is_complete()));
        Self {
            complete: after.map(|chi| chi.is_complete()),
            explained: excess
                .zip(left)
                .map(|(excess, left)| (1.0 - left / excess).max(0.0)),
            residuals: incomplete.map_or(Vec::new(), |model| residuals(model.fit, model.likelihood)),
        }
    }
}

/// Returns the errors that runs share, judged beside the best explanation; an inferred sd is numbered as the parameters of the base.
///
/// # Arguments
/// - `best`: the best explanation. `claimed`: the replacement, if it is that.
fn shared_errors(
    task: &SearchTask,
    best: Option<ScoredFit>,
    claimed: Option<&FittedReplacement>,
) -> Vec<JudgedError> {
    let mut errors = best.map_or(Vec::new(), |model| judged_errors(&task.suspected_errors, model));
    if let Some(claimed) = claimed {
        let kept = &task.reductions[claimed.reduction].parameters;
        for error in &mut errors {
            error.source = error.source.in_base(kept);
        }
    }
    errors
}

impl Conclusion {
    pub(super) fn new(state: &SearchState, choice: RunChoice) -> Self {
        let (task, hypotheses) = (&state.task, &state.hypotheses);
        let likelihood = &task.likelihood;
        let weighing = Weighing::new(task, hypotheses);
        let (supported, law) = SearchVerdict::supported(task, hypotheses, &weighing);
        let law = law.filter(|_| supported == SearchVerdict::NotInLibrary);
        let (base, detected) = (hypotheses.base_fit(), hypotheses.detected());
        let explanation = law
            .as_ref()
            .map(|law| &law.fit)
            .or(detected.map(|best| &best.fit));
        let combination = detected.map_or(Vec::new(), |best| best.effects.clone());
        let effects = law
            .as_ref()
            .map_or_else(|| combination.clone(), |law| law.effects.clone());
        let replacements = replacement::weighed(task, hypotheses, &weighing);
        let claimed = replacements.iter().find(|replacement| replacement.is_claimed);
        let claimed =
            claimed.and_then(|claimed| hypotheses.replacement(claimed.reduction, claimed.candidate));
        // What speaks against the best set does not speak against the replacement that is more probable.
        let objections = match claimed {
            Some(_) => Objections::default(),
            None => {
                let explanation = explanation.map(|fit| (fit, effects.as_slice()));
                Objections::new(task, hypotheses, &weighing, explanation, supported)
            }
        };
        let places = LawPlaces::new(task, hypotheses, &weighing);
        let is_withheld = objections.any();
        let verdict = match claimed {
            Some(replacement) => SearchVerdict::Named(replacement.candidate),
            None if is_withheld && supported.is_claim() => SearchVerdict::Undecided,
            None => supported,
        };
        let scored = |fit| ScoredFit::new(task, fit);
        let replacement = claimed.map(FittedReplacement::scored);
        let best = replacement.or(explanation.or(base).map(scored));
        let remainder = Remainder::new(base.map(scored), best);
        let chi_square = |model: ScoredFit| FitChiSquare::of_fit(model.fit, model.likelihood);
        Self {
            verdict,
            implausible: objections.implausible,
            held_back: objections.held_back,
            unsupported_noise: objections.unsupported_noise,
            remaining: remainder.residuals,
            complete: remainder.complete,
            explained: remainder.explained,
            agreed: weighing
                .agreed()
                .filter(|_| verdict == SearchVerdict::Undecided && !is_withheld),
            alternative_priors: alternative_priors(task, hypotheses, weighing.misfit),
            ranking: weighing.ranking,
            not_in_library: weighing.not_in_library,
            predicted_by_law: hypotheses.laws.as_ref().and_then(|scan| {
                let law = scan.laws.get(scan.confirmed.unwrap_or(0))?;
                Some(law.fit.point.values.clone())
            }),
            sets: weighing.sets,
            misfit: weighing.misfit,
            outside: law
                .as_ref()
                .filter(|_| verdict == SearchVerdict::NotInLibrary)
                .map(|law| OutsideLaw::new(law, &places, &hypotheses.formulas, likelihood, weighing.misfit)),
            combination,
            replacements,
            gains: hypotheses.gains(),
            chi_square: base.map(scored).and_then(chi_square),
            chi_square_best: best.and_then(chi_square),
            base: PosteriorModel::new(task, Vec::new(), base, BASE_STREAM),
            best: PosteriorModel::new(task, effects, explanation.or(base), BEST_STREAM),
            next_runs: choice.runs,
            information: choice.alone,
            shared_errors: shared_errors(task, best, claimed),
            numerical_noise_sds: state.numerical_noise_sds.clone(),
            evaluations: state.evaluations,
        }
    }

    /// The probability of an explanation under each other prior; `None`: nothing is missing.
    pub fn under_other_priors(&self, candidate: Option<usize>) -> impl Iterator<Item = f64> {
        let priors = self.alternative_priors.iter();
        priors.filter_map(move |prior| {
            let mut effects = prior.effects.iter();
            effects
                .find(|(k, _)| *k == candidate)
                .map(|(_, probability)| *probability)
        })
    }

    /// The probability of a law outside the library under each other prior.
    pub fn law_under_other_priors(&self) -> impl Iterator<Item = f64> {
        self.alternative_priors
            .iter()
            .filter_map(|prior| prior.not_in_library)
    }

    /// Returns the replacement that is claimed.
    pub fn claimed_replacement(&self) -> Option<&Replacement> {
        self.replacements
            .iter()
            .find(|replacement| replacement.is_claimed)
    }

    /// The reductions that cost no detectable evidence: their effects may be dropped.
    pub fn redundant(&self) -> impl Iterator<Item = usize> {
        let gains = self.gains.iter().enumerate();
        gains
            .filter(|(_, gain)| gain.is_some_and(|gain| gain < DETECTED))
            .map(|(k, _)| k)
    }
}
