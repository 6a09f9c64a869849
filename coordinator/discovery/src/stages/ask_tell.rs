//! The ask-and-tell interface of a discovery: the queries of a round, and the answers, which select the next stage.

use crate::candidate::{Candidate, CandidateError};
use crate::effect_search::state::EffectSearch;
use crate::stages::branch::SearchBranch;
use crate::stages::conclusion::Conclusion;
use crate::stages::formula_fit::FormulaRequest;
use crate::stages::query::Query;
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;
use crate::task::SearchTask;
use inference::{InferenceFailure, Proposal, ProposalRound, TellError, TellProgress};
use statistics::likelihood::LikelihoodError;

/// An ask/tell search for the effects that a model is missing.
///
/// Its state is a function of the task and the told values, whatever their order within a round.
#[derive(Debug, Clone)]
pub struct DiscoverySearch {
    pub(super) state: SearchState,
    pub(super) stage: Stage,
    round: ProposalRound<Option<Vec<f64>>>,
    queries: Vec<Query>,
}

impl DiscoverySearch {
    /// Makes a search whose first round holds the starts of the base's fit.
    ///
    /// # Errors
    /// [`CandidateError`] if the base has no parameter or a candidate is ill-defined.
    pub fn new(task: SearchTask) -> Result<Self, CandidateError> {
        task.candidates().iter().try_for_each(Candidate::check)?;
        let search = EffectSearch::new(
            &task.prior,
            task.likelihood.clone(),
            &task.library,
            &task.settings,
        )?;
        let library = (0..task.library.len()).collect();
        let mut discovery = Self {
            stage: Stage::SingleEffects(SearchBranch::new(Vec::new(), library, search)),
            state: SearchState::new(task),
            round: ProposalRound::default(),
            queries: Vec::new(),
        };
        discovery.ask();
        Ok(discovery)
    }

    /// Returns what the search is doing, in words.
    #[must_use]
    pub fn doing(&self) -> &'static str {
        self.stage.doing()
    }

    /// Returns the number of completed rounds.
    #[must_use]
    pub fn round(&self) -> u64 {
        self.round.number()
    }

    /// Returns the parameter vectors of this round, numbered from 0.
    #[must_use]
    pub fn pending(&self) -> &[Proposal] {
        self.round.pending()
    }

    /// Returns the query of a parameter vector of this round.
    #[must_use]
    pub fn query(&self, index: usize) -> Option<&Query> {
        self.queries.get(index)
    }

    /// Returns the number of values that answer a query.
    fn expected(&self, query: &Query) -> usize {
        if query.is_proposed {
            self.state.task.proposed.values()
        } else {
            self.state.task.likelihood.values()
        }
    }

    /// Takes the values that answer a query; the last one of a round advances the search.
    ///
    /// # Arguments
    /// - `values`: as [`Likelihood::log_likelihood`](statistics::Likelihood::log_likelihood) takes them; on proposed runs, each
    ///   channel of each run. `None` where the model rejected the parameters.
    ///
    /// # Errors
    /// [`TellError`] for an answer that was told before or never asked for, or with a wrong number of values or infinite ones. The
    /// search is unchanged then.
    pub fn tell(&mut self, index: usize, values: Option<&[f64]>) -> Result<TellProgress, TellError> {
        if let (Some(values), Some(query)) = (values, self.queries.get(index)) {
            let (expected, given) = (self.expected(query), values.len());
            if expected != given {
                return Err(TellError::Length { expected, given });
            }
            if query.is_proposed {
                if let Some(&value) = values.iter().find(|v| !v.is_finite()) {
                    return Err(LikelihoodError::Prediction {
                        run: 0,
                        channel: 0,
                        value,
                    }
                    .into());
                }
            } else {
                self.state.task.likelihood.check_values(values)?;
            }
        }
        let complete = self.round.tell(index, values.map(<[f64]>::to_vec))?;
        if complete {
            let (_, answers) = self.round.complete();
            let of_model = self.queries.iter().filter(|query| !query.is_low_fidelity);
            self.state.evaluations += of_model.count();
            self.queries.clear();
            self.stage.take(answers);
            self.ask();
        }
        Ok(match self.stage {
            _ if !complete => TellProgress::Waiting,
            _ => self.progress(),
        })
    }

    /// Returns where the search is between two rounds.
    fn progress(&self) -> TellProgress {
        match self.stage {
            Stage::Done(_) => TellProgress::Finished,
            Stage::Failed(failure) => TellProgress::Failed(failure),
            _ => TellProgress::NextRound,
        }
    }

    /// Returns the law of which the search wants formulas. It has no pending query until they are offered.
    #[must_use]
    pub fn wanted_formulas(&self) -> Option<&FormulaRequest> {
        match &self.stage {
            Stage::AwaitsFormulas(request) => Some(request),
            _ => None,
        }
    }

    /// Takes formulas of the law that [`wanted_formulas`](Self::wanted_formulas) returns, as candidates, whose indices follow those of
    /// the task. They are fitted through the model, and change neither the verdict nor a probability of an effect or a law. Without a
    /// wanted law, nothing happens. Checked by `formulas::the_formula_that_acts_is_the_most_probable`.
    ///
    /// # Errors
    /// [`CandidateError`] if a candidate is ill-defined; the search is unchanged then.
    pub fn offer_formulas(&mut self, formulas: Vec<Candidate>) -> Result<TellProgress, CandidateError> {
        formulas.iter().try_for_each(Candidate::check)?;
        if let Some(request) = self.wanted_formulas().cloned() {
            self.stage = self.state.fit_formulas(request, formulas);
            self.ask();
        }
        Ok(self.progress())
    }

    /// Returns the result; `None` while the search is running, and where it failed.
    #[must_use]
    pub fn conclusion(&self) -> Option<&Conclusion> {
        match &self.stage {
            Stage::Done(conclusion) => Some(conclusion),
            _ => None,
        }
    }

    /// Returns why the search failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        match self.stage {
            Stage::Failed(failure) => Some(failure),
            _ => None,
        }
    }

    /// Begins the next round of this stage, or of the next stage that has queries.
    fn ask(&mut self) {
        while !matches!(
            self.stage,
            Stage::AwaitsFormulas(_) | Stage::Done(_) | Stage::Failed(_)
        ) {
            let queries = self.stage.queries();
            if !queries.is_empty() {
                let proposals = queries.iter().enumerate();
                let proposals = proposals.map(|(i, query)| Proposal::new(i, query.theta.clone()));
                let proposals = proposals.collect();
                self.round.ask(proposals);
                self.queries = queries;
                return;
            }
            self.next_stage();
        }
    }

    /// Keeps the results of the stage, and begins the next.
    fn next_stage(&mut self) {
        let state = &mut self.state;
        self.stage = match &self.stage {
            Stage::SingleEffects(branch) => state.after_single_effects(branch),
            Stage::BaseReduction(branches) => state.after_base_reduction(branches),
            Stage::Families(branches) => state.after_families(branches),
            Stage::BeamSearch(size, branches) => state.after_beam_search(*size, branches),
            Stage::BackwardElimination(branches) => state.after_backward_elimination(branches),
            Stage::Exchanges(round, branches) => state.after_exchanges(*round, branches),
            Stage::Curves(branch) => state.after_curves(branch),
            Stage::Forms(branch) => state.after_forms(branch),
            Stage::CrossValidation(rank, validation) => state.after_cross_validation(*rank, validation),
            Stage::EffectsBesideLaw(size, branches) => state.after_effects_beside_law(*size, branches),
            Stage::LawElimination(branches) => state.after_law_elimination(branches),
            Stage::LawSubstitutes(branches) => state.after_law_substitutes(branches),
            Stage::LawForms(law, branch) => state.after_law_forms(*law, branch),
            Stage::LawBesideEffects(effects, validation) => {
                state.after_law_beside_effects(effects, validation)
            }
            Stage::Replacements(branches) => state.after_replacements(branches),
            Stage::Predictions(sets, validation) => state.after_predictions(sets, validation),
            Stage::Formulas(first, branch) => state.after_formulas(*first, branch),
            Stage::NextRuns(runs) => state.done(runs.best()),
            Stage::AwaitsFormulas(_) | Stage::Done(_) | Stage::Failed(_) => return,
        };
    }
}
