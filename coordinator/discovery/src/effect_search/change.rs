//! What candidates change of the predictions, as their screen beyond the base has found it.
//!
//! A screen of all candidates beyond each combination may cost a quarter of the evaluations of a search. A candidate changes the
//! predictions of a combination nearly as it changed those of the base, so this takes the place of the low-fidelity screen where there is
//! none, or where it shows nothing: it selects the candidates that are worth evaluations.

use crate::effect_search::screen_result::{Screened, screened};
use crate::effect_search::state::{CandidateState, EffectSearch, EvidenceEstimate};

/// The change that a candidate made beyond the base.
#[derive(Debug, Clone)]
pub(crate) struct CandidateChange {
    /// Coordinates of the candidate, each with the change of the predicted values there: one, or one for each of several strengths.
    steps: Vec<(Vec<f64>, Vec<f64>)>,
    /// Derivatives of the predicted values along the candidate's coordinates.
    columns: Vec<Vec<f64>>,
    /// Log of the mean Bayes factor over the shapes less that at the best shape.
    shape_gain: f64,
}

impl CandidateChange {
    /// Returns the change of a screened candidate; `None` for another model with the same parameters.
    fn new(state: &CandidateState, base_dimension: usize) -> Option<Self> {
        let (frame, screened) = (&state.frame, state.screened.as_ref()?);
        if frame.is_switch() {
            return None;
        }
        let own = |k: usize, coordinate: f64| {
            let mut position = screened.point.position.clone();
            position[k] = coordinate;
            position[base_dimension..].to_vec()
        };
        let mut columns = screened.columns[base_dimension..].to_vec();
        let steps = match frame.strength() {
            Some((k, neutral)) => {
                let step = screened.longest_step;
                let change = screened.change.iter().map(|change| change * step);
                // The derivatives along shapes are those at the best strength.
                let share = step / (screened.point.position[k] - neutral);
                columns
                    .iter_mut()
                    .flatten()
                    .for_each(|derivative| *derivative *= share);
                vec![(own(k, neutral + step), change.collect())]
            }
            None => {
                let strengths = frame.strengths.iter();
                let along =
                    |&(k, neutral): &(usize, f64)| (own(k, neutral + 1.0), screened.columns[k].clone());
                strengths.map(along).collect()
            }
        };
        Some(Self {
            steps,
            columns,
            shape_gain: screened.log_bayes_factor - screened.best_shape_log_bayes_factor,
        })
    }
}

impl EffectSearch {
    /// Returns the change of each candidate, as far as it was screened.
    pub(crate) fn changes(&self) -> Vec<Option<CandidateChange>> {
        let base = self.base_frame.dimension();
        let states = self.candidates.iter();
        let change = |state: &CandidateState| {
            let is_valid = !state.is_refused();
            is_valid.then(|| CandidateChange::new(state, base)).flatten()
        };
        states.map(change).collect()
    }

    /// Screens candidates by the changes that they made beyond another base. Where a low-fidelity model shows a change, that counts
    /// instead.
    pub(super) fn screen_by_changes(&mut self, changes: &[Option<CandidateChange>]) {
        let Some(base) = &self.base else { return };
        let (position, values) = (&base.fit.point.position, &base.fit.point.values);
        for (state, change) in self.candidates.iter_mut().zip(changes) {
            let Some(change) = change else { continue };
            let evaluated = change.steps.iter().map(|(own, by)| {
                let values = values.iter().zip(by).map(|(value, by)| value + by);
                ([position.as_slice(), own].concat(), Some(values.collect()))
            });
            let evaluated: Vec<_> = evaluated.collect();
            let Some(mut screened) = screened(&state.frame, base, &self.likelihood, &evaluated) else {
                continue;
            };
            for (k, column) in (position.len()..).zip(&change.columns) {
                if !state.frame.is_strength(k) {
                    screened.columns[k].clone_from(column);
                }
            }
            screened.log_bayes_factor += change.shape_gain;
            state.take_low_fidelity(screened);
        }
    }
}

impl CandidateState {
    /// Keeps the result of a screen without the model.
    pub(super) fn take_low_fidelity(&mut self, screened: Screened) {
        self.estimate = Some(EvidenceEstimate::of_screen(&screened));
        self.screened = Some(screened.as_of_model());
        self.low_fidelity = Some(screened);
    }
}
