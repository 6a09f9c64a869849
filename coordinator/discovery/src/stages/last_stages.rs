//! Steps 12 and 13, the last stages: the leading sets predict left-out levels, and the runs to make next are chosen.

use crate::stages::conclusion::Conclusion;
use crate::stages::cross_validation::{ComparedModel, CrossValidation};
use crate::stages::next_run::{RunChoice, RunSelection};
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;
use crate::stages::weighing::Weighing;

impl SearchState {
    /// Lets the leading sets predict left-out levels, if the evidence leaves several.
    pub(super) fn predictions(&self) -> Stage {
        let weighing = Weighing::new(&self.task, &self.hypotheses);
        let Some(base) = self.hypotheses.base_fit() else {
            return self.formulas();
        };
        let leading = weighing.leading(&self.hypotheses);
        if leading.len() < 2 {
            return self.formulas();
        }
        let mut models: Vec<ComparedModel> = vec![(Vec::new(), 0, base)];
        models.extend(leading.iter().map(|set| self.compared(set)));
        let validation = self.validated(&models);
        let sets = leading.iter().map(|set| set.effects.clone()).collect();
        Stage::Predictions(sets, validation)
    }

    /// Keeps the predictive densities of the sets.
    pub(super) fn after_predictions(&mut self, sets: &[Vec<usize>], validation: &CrossValidation) -> Stage {
        let gains = validation.gains().unwrap_or_default();
        // A measurement is left out once for each condition whose level it belongs to.
        let left_out: usize = self.task.levels.iter().map(Vec::len).sum();
        let times = (left_out as f64 / self.task.likelihood.data().len() as f64).max(1.0);
        // The first gain is that of the base.
        let predictive = sets
            .iter()
            .cloned()
            .zip(gains.into_iter().skip(1).map(|gain| gain / times));
        self.hypotheses.predictive = predictive.collect();
        self.formulas()
    }

    /// Compares the open explanations on the runs that the rig could make.
    pub(super) fn next_runs(&self) -> Stage {
        let open = Weighing::new(&self.task, &self.hypotheses).open(&self.hypotheses);
        match RunSelection::new(&self.task, open) {
            Some(runs) => Stage::NextRuns(runs),
            None => self.done(RunChoice::default()),
        }
    }

    /// Ends the discovery.
    pub(super) fn done(&self, choice: RunChoice) -> Stage {
        Stage::Done(Box::new(Conclusion::new(self, choice)))
    }
}
