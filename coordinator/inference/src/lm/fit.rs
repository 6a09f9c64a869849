//! The rounds of a fit: list proposals, take their predicted values, finish.

use super::damping::Damping;
use super::objective::{Column, FitPoint, Objective};
use super::settings::{LmSettings, LmSettingsError};
use super::stencil::{Sides, Stencil};
use crate::phase::{EvaluationCount, RunPhase};
use crate::point_estimate::{ModeEstimate, StopReason};
use crate::round::{Proposal, ProposalRound};
use crate::tell::{InferenceFailure, TellError, TellProgress};
use statistics::likelihood::Likelihood;
use statistics::prior::Prior;

/// Predicted values in the order of the data; `None` where the model rejected the parameters.
pub(super) type PredictedValues = Option<Vec<f64>>;

/// An ask/tell fit of the most probable parameters.
///
/// Its state is a function of prior, likelihood, settings and the told values, whatever their order within a round:
/// checked by `lm::the_order_within_a_round_does_not_matter`.
#[derive(Debug, Clone)]
pub struct LmFit {
    pub(super) objective: Objective,
    pub(super) settings: LmSettings,
    pub(super) round: ProposalRound<PredictedValues>,
    pub(super) phase: RunPhase<FitRound, ModeEstimate>,
    pub(super) best: Option<FitPoint>,
    /// The last known Jacobian: at the best point, or at one before it.
    pub(super) columns: Vec<Column>,
    pub(super) stencil: Stencil,
    /// The sides of the last differences.
    pub(super) sides: Sides,
    /// Steps of the differences along the axes.
    pub(super) lengths: Vec<f64>,
    pub(super) damping: Damping,
    /// Whether the last step decreased f too little to continue.
    pub(super) is_stagnant: bool,
    pub(super) steps: usize,
    pub(super) count: EvaluationCount,
}

/// The pending evaluations of a fit.
#[derive(Debug, Clone)]
pub(super) enum FitRound {
    Starts,
    Differences,
    /// Dampings and predicted decreases of the steps that are tried.
    Trials(Vec<(f64, f64)>),
}

impl LmFit {
    /// Makes a fit whose first round holds the prior mean and prior draws.
    ///
    /// # Arguments
    /// - `likelihood`: the data; their order is that of the values that [`LmFit::tell`] takes. A parameter that it names
    ///   as a noise sd is not the model's.
    ///
    /// # Errors
    /// [`LmSettingsError`] names the setting, its value and its bound.
    pub fn new(prior: Prior, likelihood: Likelihood, settings: LmSettings) -> Result<Self, LmSettingsError> {
        settings.check(prior.dimension())?;
        let objective = Objective::new(prior, likelihood);
        let mut optimiser = Self {
            columns: vec![None; objective.axes.len()],
            stencil: Stencil::new(&[], &[], &[]),
            objective,
            settings,
            round: ProposalRound::default(),
            phase: RunPhase::Waiting(FitRound::Starts),
            best: None,
            sides: Sides::One,
            lengths: Vec::new(),
            damping: Damping::default(),
            is_stagnant: false,
            steps: 0,
            count: EvaluationCount::default(),
        };
        optimiser.ask_starts();
        Ok(optimiser)
    }

    /// Returns the round in progress; its list of proposals is empty only when the fit has ended.
    #[must_use]
    pub fn round(&self) -> &ProposalRound<Option<Vec<f64>>> {
        &self.round
    }

    /// Returns the result, once finished.
    #[must_use]
    pub fn estimate(&self) -> Option<&ModeEstimate> {
        self.phase.result()
    }

    /// Returns why the fit failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        self.phase.failure()
    }

    /// Returns the number of evaluations in completed rounds.
    #[must_use]
    pub fn count(&self) -> EvaluationCount {
        self.count
    }

    /// Returns the number of steps so far.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Takes the predicted values of a pending proposal; the last one of a round advances the fit.
    ///
    /// # Arguments
    /// - `predicted`: the model's values as [`Likelihood::log_likelihood`] takes them; `None` where the model rejected the
    ///   parameters.
    ///
    /// # Errors
    /// [`TellError`] for an answer that was told before or is not pending, or with a wrong number of values or infinite ones. The
    /// fit is unchanged then.
    pub fn tell(&mut self, particle: usize, predicted: Option<&[f64]>) -> Result<TellProgress, TellError> {
        if let Some(values) = predicted {
            self.check(values)?;
        }
        let complete = self.round.tell(particle, predicted.map(<[f64]>::to_vec))?;
        if complete {
            self.advance();
        }
        Ok(self.phase.progress(complete))
    }

    fn check(&self, values: &[f64]) -> Result<(), TellError> {
        let (expected, given) = (self.objective.likelihood.values(), values.len());
        if expected != given {
            return Err(TellError::Length { expected, given });
        }
        Ok(self.objective.likelihood.check_values(values)?)
    }

    /// Completes a round and opens the next, unless the fit has ended.
    fn advance(&mut self) {
        let (proposals, answers) = self.round.complete();
        self.count.add(answers.iter().map(Option::is_none));
        match std::mem::replace(&mut self.phase, RunPhase::Waiting(FitRound::Starts)) {
            RunPhase::Waiting(FitRound::Starts) => self.after_starts(&proposals, &answers),
            RunPhase::Waiting(FitRound::Differences) => self.after_differences(answers),
            RunPhase::Waiting(FitRound::Trials(trials)) => self.after_trials(&trials, &proposals, &answers),
            ended @ (RunPhase::Done(_) | RunPhase::Failed(_)) => self.phase = ended,
        }
    }

    pub(super) fn remaining(&self) -> usize {
        self.settings.max_evaluations - self.count.evaluations
    }

    pub(super) fn ask(&mut self, awaited: FitRound, thetas: impl Iterator<Item = Vec<f64>>) {
        let proposals = thetas
            .enumerate()
            .map(|(particle, theta)| Proposal::new(particle, theta))
            .collect();
        self.round.ask(proposals);
        self.phase = RunPhase::Waiting(awaited);
    }

    pub(super) fn finish(&mut self, stop: StopReason) {
        let Some(point) = &self.best else { return };
        // A step that converged ends the fit even where the budget has no room for another Jacobian.
        let stop = if self.is_stagnant {
            StopReason::Decrease
        } else {
            stop
        };
        let mut estimate = self.objective.estimate(point, &self.columns, stop);
        estimate.evaluations = self.count.evaluations as u64;
        estimate.rejected = self.count.rejected as u64;
        if self.settings.draws > 0 {
            let draws = (self.settings.draws, self.settings.seed);
            estimate.approximation = self.objective.approximation(point, &self.columns, draws);
        }
        self.phase = RunPhase::Done(Box::new(estimate));
    }
}
