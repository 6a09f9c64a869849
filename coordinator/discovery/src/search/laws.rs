//! The stages that search laws outside the library, and the last stages.

use crate::chi_square::{FURTHER_EFFECT, OUTSIDE_LAW};
use crate::effect_search::depth::{ALL_CURVES, CURVES, Depth, FORMS};
use crate::effect_search::state::EffectSearch;
use crate::laplace::evidence::log_sum_exp;
use crate::probability::DETECTED;
use crate::search::branch::SearchBranch;
use crate::search::conclusion::Conclusion;
use crate::search::cross_validation::{ComparedModel, CrossValidation};
use crate::search::hypotheses::FittedLaw;
use crate::search::next_run::{InformativeRun, RunSelection};
use crate::search::stage::Stage;
use crate::search::state::SearchState;
use crate::search::weighing::Weighing;

/// Laws whose simple forms are fitted and that are cross-validated, the best.
const LAWS: usize = 3;
/// A curve is kept where it beats the best simple form by more \[nats\].
const CURVE_BEATS_FORM: f64 = 5.0;

impl SearchState {
    /// Searches curves outside the library, if the library leaves misfit or needs several effects: one law may stand behind them.
    pub(super) fn curves(&mut self) -> Stage {
        let chi_square = self.hypotheses.chi_square(&self.task.likelihood);
        let detected = self.hypotheses.detected();
        let leaves_misfit = match (chi_square, detected) {
            (Some(chi), None) => chi.p() < OUTSIDE_LAW,
            (Some(chi), Some(best)) => best.effects.len() > 1 || chi.p() < FURTHER_EFFECT,
            (None, detected) => detected.is_some(),
        };
        let depth = if chi_square.is_some_and(|chi| chi.is_wrong()) {
            &ALL_CURVES
        } else {
            &CURVES
        };
        if !leaves_misfit || self.task.laws.is_empty() {
            return self.predictions();
        }
        let curves = (0..self.task.laws.len()).map(|law| self.task.curve(law));
        match self.branch(curves.collect(), depth) {
            Some(branch) => Stage::Curves(branch),
            None => self.predictions(),
        }
    }

    /// A search of some candidates beyond the base.
    fn branch(&self, candidates: Vec<usize>, depth: &'static Depth) -> Option<SearchBranch> {
        let own: Vec<_> = candidates
            .iter()
            .map(|&k| self.hypotheses.candidates[k].clone())
            .collect();
        let base = self.hypotheses.base.clone()?;
        let likelihood = self.task.likelihood.clone();
        let search = EffectSearch::beyond(base, likelihood, &own, depth, self.task.settings.seed);
        Some(SearchBranch::new(Vec::new(), candidates, search))
    }

    pub(super) fn after_curves(&mut self, branch: &SearchBranch) -> Stage {
        let law_of = |candidate| (0..self.task.laws.len()).find(|&law| self.task.curve(law) == candidate);
        let laws = branch.ranked().into_iter().filter_map(|(candidate, ranked)| {
            Some(FittedLaw {
                law: law_of(candidate)?,
                candidate,
                log_bayes_factor: ranked.log_bayes_factor,
                mean_log_bayes_factor: ranked.log_bayes_factor,
                fit: branch.search.fit_of(ranked.candidate?)?.clone(),
                left_out: None,
            })
        });
        let laws: Vec<FittedLaw> = laws.collect();
        let forms = laws.iter().take(LAWS).flat_map(|law| self.task.forms(law.law));
        let forms = forms.collect();
        self.hypotheses.laws = Some(laws);
        match self.branch(forms, &FORMS) {
            Some(branch) => Stage::Forms(branch),
            None => self.predictions(),
        }
    }

    pub(super) fn after_forms(&mut self, branch: &SearchBranch) -> Stage {
        let task = &self.task;
        let ranked = branch.ranked();
        let mut laws = self.hypotheses.laws.take().unwrap_or_default();
        for law in &mut laws {
            let own = task.forms(law.law);
            let forms: Vec<_> = ranked.iter().filter(|(k, _)| own.contains(k)).collect();
            let factors = forms.iter().map(|(_, form)| form.log_bayes_factor);
            let all = factors.chain([law.log_bayes_factor]);
            let count = 1.0 + own.len() as f64;
            law.mean_log_bayes_factor = log_sum_exp(all) - libm::log(count);
            let best = forms.first().and_then(|(k, form)| {
                let fit = branch.search.fit_of(form.candidate?)?;
                Some((*k, form.log_bayes_factor, fit))
            });
            if let Some((candidate, factor, fit)) = best
                && factor > law.log_bayes_factor - CURVE_BEATS_FORM
            {
                (law.candidate, law.log_bayes_factor, law.fit) = (candidate, factor, fit.clone());
            }
        }
        let handicap = |law: &FittedLaw| f64::from(u8::from(task.laws[law.law].is_description)) * DETECTED;
        let score = |law: &FittedLaw| law.log_bayes_factor - handicap(law);
        laws.sort_by(|a, b| score(b).total_cmp(&score(a)));
        self.hypotheses.laws = Some(laws);
        self.cross_validation(0)
    }

    /// Cross-validates the law of a rank, if it is a detection.
    fn cross_validation(&mut self, rank: usize) -> Stage {
        let laws = self.hypotheses.laws.as_deref().unwrap_or_default();
        let law = laws.get(rank).filter(|_| rank < LAWS);
        let law = law.filter(|law| law.log_bayes_factor > DETECTED);
        let (Some(law), Some(base)) = (law, self.hypotheses.base_fit()) else {
            return self.predictions();
        };
        let parameters = |k: usize| self.hypotheses.candidates[k].parameters.len();
        let library = self.hypotheses.best().map_or((Vec::new(), 0, base), |best| {
            let last = best.effects.last().map_or(0, |&k| parameters(k));
            (best.effects.clone(), last, &best.fit)
        });
        let of_law = (vec![law.candidate], parameters(law.candidate), &law.fit);
        let fits = [(Vec::new(), 0, base), library, of_law];
        let validation = CrossValidation::new(&self.task.likelihood, &self.task.levels, &fits);
        Stage::CrossValidation(rank, validation)
    }

    pub(super) fn after_cross_validation(&mut self, rank: usize, validation: &CrossValidation) -> Stage {
        // Over the base, and over the library's best.
        let gains = validation.gains().and_then(|gains| match gains.as_slice() {
            &[base, library, law] => Some([law - base, law - library]),
            _ => None,
        });
        if let Some(law) = self.hypotheses.laws.as_mut().and_then(|laws| laws.get_mut(rank)) {
            law.left_out = gains;
        }
        let passes =
            gains.is_some_and(|[over_base, over_library]| over_base > DETECTED && over_library > 0.0);
        if passes {
            self.hypotheses.confirmed = Some(rank);
            return self.predictions();
        }
        self.cross_validation(rank + 1)
    }

    /// Predicts left-out levels by the leading sets, where the evidence leaves several.
    fn predictions(&self) -> Stage {
        let weighing = Weighing::new(&self.task, &self.hypotheses);
        let Some(base) = self.hypotheses.base_fit() else {
            return self.next_runs();
        };
        let leading = weighing.leading(&self.hypotheses);
        if leading.len() < 2 {
            return self.next_runs();
        }
        let mut models: Vec<ComparedModel> = vec![(Vec::new(), 0, base)];
        for set in &leading {
            let last = set.effects.last();
            let own = last.map_or(0, |&k| self.hypotheses.candidates[k].parameters.len());
            models.push((set.effects.clone(), own, &set.fit));
        }
        let validation = CrossValidation::new(&self.task.likelihood, &self.task.levels, &models);
        let sets = leading.iter().map(|set| set.effects.clone()).collect();
        Stage::Predictions(sets, validation)
    }

    pub(super) fn after_predictions(&mut self, sets: &[Vec<usize>], validation: &CrossValidation) -> Stage {
        let gains = validation.gains().unwrap_or_default();
        // A measurement is left out once with the level of each of its conditions.
        let left_out: usize = self.task.levels.iter().map(Vec::len).sum();
        let times = (left_out as f64 / self.task.likelihood.data().len() as f64).max(1.0);
        // The base comes first.
        let of_sets = sets
            .iter()
            .cloned()
            .zip(gains.into_iter().skip(1).map(|gain| gain / times));
        self.hypotheses.predictive = of_sets.collect();
        self.next_runs()
    }

    fn next_runs(&self) -> Stage {
        let open = Weighing::new(&self.task, &self.hypotheses).open(&self.hypotheses);
        match RunSelection::new(&self.task, open) {
            Some(runs) => Stage::NextRuns(runs),
            None => self.done(Vec::new()),
        }
    }

    pub(super) fn done(&self, next_runs: Vec<InformativeRun>) -> Stage {
        Stage::Done(Box::new(Conclusion::new(self, next_runs)))
    }
}
