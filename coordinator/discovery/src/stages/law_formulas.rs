//! Formulas of the law that is claimed, fitted through the model. The caller makes them of the law's curve.

use crate::candidate::Candidate;
use crate::effect_search::depth::FORMULAS;
use crate::settings::Smoothness;
use crate::stages::branch::SearchBranch;
use crate::stages::formula_fit::{FormulaFit, FormulaRequest};
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;
use crate::stages::verdict::SearchVerdict;
use crate::stages::weighing::Weighing;

impl SearchState {
    /// Waits for formulas of the law that is claimed. A model with numerical noise is too expensive for them.
    pub(super) fn formulas(&self) -> Stage {
        let is_smooth = self.task.settings.smoothness == Smoothness::Smooth;
        let request = is_smooth.then(|| self.formula_request()).flatten();
        request.map_or_else(|| self.next_runs(), Stage::AwaitsFormulas)
    }

    fn formula_request(&self) -> Option<FormulaRequest> {
        let weighing = Weighing::new(&self.task, &self.hypotheses);
        let (verdict, law) = SearchVerdict::supported(&self.task, &self.hypotheses, &weighing);
        let law = law.filter(|_| verdict == SearchVerdict::NotInLibrary)?;
        let beside = law.effects.iter().copied().filter(|k| *k != law.candidate);
        Some(FormulaRequest {
            law: law.law,
            curve: law.curve?.with_misfit(weighing.misfit),
            effects: beside.collect(),
        })
    }

    /// Fits the offered formulas beyond the effects beside the law.
    pub(super) fn fit_formulas(&mut self, request: FormulaRequest, formulas: Vec<Candidate>) -> Stage {
        let candidates = &mut self.hypotheses.candidates;
        let first = candidates.len();
        candidates.extend(formulas);
        let offered = (first..candidates.len()).collect();
        match self.branch(request.effects, offered, &FORMULAS) {
            Some(branch) => Stage::Formulas(first, branch),
            None => self.next_runs(),
        }
    }

    /// Keeps the fits of the formulas, and begins the choice of runs.
    ///
    /// # Arguments
    /// - `first`: index of the first formula among the candidates.
    pub(super) fn after_formulas(&mut self, first: usize, branch: &SearchBranch) -> Stage {
        let misfit = self.hypotheses.misfit(&self.task.likelihood);
        let fits = branch.ranked().into_iter().filter_map(|(candidate, ranked)| {
            let fit = branch.search.fit_of(ranked.candidate?)?;
            Some(FormulaFit {
                formula: candidate - first,
                log_bayes_factor: ranked.log_bayes_factor / misfit,
                parameters: fit.theta()[branch.added_parameters(fit)].to_vec(),
            })
        });
        self.hypotheses.formulas = fits.collect();
        self.next_runs()
    }
}
