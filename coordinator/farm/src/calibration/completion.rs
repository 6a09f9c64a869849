//! The results of a calibration: what they count, what follows from them, what is stored.

use inference::TellProgress;
use shared::api::CalibrationState;
use shared::outcome::Observables;
use statistics::{LikelihoodError, LogLikelihood};

use super::engine::{CalibrationResult, EvaluationScore};
use super::faults::NOBODY;
use super::final_draws::{FinalDraws, final_draws};
use super::process::Calibration;
use super::second_answer::{Answer, SecondAnswers, StoredAnswer};
use super::simulation_result::SimulationResult;
use crate::lease::{Completion, LeaseQueue};
use job::AlgorithmSettings;
use record::{EvaluationKey, EvaluationRow, Fact, Kept};

/// A message that is no result: the calibration and the reason.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ResultError {
    /// The observables do not have one entry per run.
    #[error("the observables of evaluation {evaluation} do not cover the {runs} conditions of the variant")]
    WrongShape {
        /// The evaluation.
        evaluation: u64,
        /// How many entries are expected.
        runs: usize,
    },
    /// A subchain's end where none was asked for, or none where one was, or one that cannot be.
    #[error("the result of evaluation {evaluation} does not answer what its lease asked for")]
    OtherQuestion {
        /// The evaluation.
        evaluation: u64,
    },
}

impl Calibration {
    /// Takes the result of an evaluation; late duplicates change nothing.
    ///
    /// Returns the facts to store, in order, and whether the result counted.
    ///
    /// # Errors
    /// [`ResultError`] for a result that does not fit its variant: the worker's fault, nothing is recorded.
    pub fn complete(
        &mut self,
        evaluation: u64,
        computed: impl Into<SimulationResult>,
        worker: &str,
    ) -> Result<(Vec<Fact>, bool), ResultError> {
        let computed = computed.into();
        if let Err(error) = self.check_shape(evaluation, &computed) {
            self.forget_verification(evaluation);
            return Err(error);
        }
        let answer = Answer {
            worker: worker.to_owned(),
            fingerprint: computed.fingerprint(),
        };
        match self.queue.complete(evaluation) {
            Completion::First => {}
            Completion::Duplicate | Completion::Unknown => {
                return Ok((self.compare(evaluation, answer), false));
            }
        }
        let asked = self
            .theta(evaluation)
            .expect("the queue holds only evaluations asked for");
        let theta = computed.end.as_ref().map_or(asked, |end| &end.theta).to_vec();
        let fingerprint = answer.fingerprint;
        let rejected = computed.is_refused();
        let SimulationResult { end, outcome } = computed;
        let scored = if self.draws.is_some() || self.engine.discovery().is_some() {
            Ok(None)
        } else {
            outcome.as_ref().map(|o| self.score(o, &theta)).transpose()
        };
        let log_likelihood = match scored {
            Ok(scored) => scored,
            Err(error) => {
                let mut facts = Vec::new();
                self.finish(CalibrationState::Failed, Some(error.to_string()), &mut facts);
                return Ok((facts, false));
            }
        };
        let coarse = match &outcome {
            Some(Ok(observables)) if self.draws.is_none() => observables.coarse.clone(),
            _ => None,
        };
        let kept = self.kept(evaluation, outcome);
        let fitted = match &kept {
            Kept::Fitted(values) => Some(values.as_slice()),
            Kept::Scored | Kept::Whole(_) | Kept::Rejected(_) => None,
        };
        let scored = self.draws.is_none().then(|| EvaluationScore {
            // Where a subchain stayed there is nothing to score, and nothing is asked of the score.
            log_likelihood: log_likelihood.unwrap_or(LogLikelihood::Impossible),
            fitted,
            coarse: coarse.as_deref(),
            end: end.as_ref(),
        });
        let mut consequences = Vec::new();
        self.given_up += usize::from(worker == NOBODY);
        self.answered_first(evaluation, &answer);
        let is_confirmed = false;
        self.done
            .insert(evaluation, StoredAnswer { answer, is_confirmed });
        self.record(evaluation, rejected, scored, &mut consequences);
        let row = EvaluationRow {
            evaluation,
            theta,
            log_likelihood: log_likelihood.map(LogLikelihood::value).filter(|l| l.is_finite()),
            kept,
            coarse,
            end,
            fingerprint,
            worker: worker.to_owned(),
        };
        let mut facts = vec![Fact::Evaluated {
            calibration: self.identity.id,
            row,
        }];
        facts.append(&mut consequences);
        Ok((facts, true))
    }

    /// Checks that a result answers what is asked for at present; of what is not, nothing is known.
    fn check_shape(&self, evaluation: u64, computed: &SimulationResult) -> Result<(), ResultError> {
        if self.theta(evaluation).is_none() {
            return Ok(());
        }
        let subchain = self.subchain(evaluation).is_some();
        let moves = self.spec.algorithm.metamodel_moves();
        if !computed.answers(subchain, moves, || self.spec.prior()) {
            return Err(ResultError::OtherQuestion { evaluation });
        }
        let searched = self.searched(evaluation).and_then(|(hash, _)| self.variant(hash));
        let variant = match (self.key(evaluation), &self.spec.holdout_variant, &self.histories) {
            _ if searched.is_some() => searched.unwrap_or(&self.spec.fit_variant),
            (EvaluationKey::Prediction { holdout: true, .. }, Some(variant), _) => variant,
            (EvaluationKey::HoldoutRun { run, .. }, ..) => {
                self.apart.get(run).map_or(&self.spec.fit_variant, |(_, own)| own)
            }
            (EvaluationKey::Likeliest, _, Some((_, variant))) => variant,
            (EvaluationKey::Sampling { .. }, ..) => &self.sampled.1,
            _ => &self.spec.fit_variant,
        };
        let values = self.spec.likelihood.values();
        match &computed.outcome {
            Some(Ok(observables))
                if !observables.covers(variant)
                    || observables.coarse.as_ref().is_some_and(|c| c.len() != values) =>
            {
                let runs = variant.conditions.len();
                Err(ResultError::WrongShape { evaluation, runs })
            }
            _ => Ok(()),
        }
    }

    /// The log-likelihood of an outcome.
    fn score(
        &self,
        outcome: &Result<Observables, String>,
        theta: &[f64],
    ) -> Result<LogLikelihood, LikelihoodError> {
        let Ok(observables) = outcome else {
            return Ok(LogLikelihood::Impossible);
        };
        let values = self.spec.predicted_values(observables);
        match self.spec.likelihood.log_likelihood(&values, theta) {
            // A draw from the tail of a prior that reaches zero: such a sd says something about theta, not about the model.
            Err(LikelihoodError::Noise { .. }) => Ok(LogLikelihood::Impossible),
            scored => scored,
        }
    }

    /// Lets a completed evaluation take effect on counts, engine and phase.
    pub(super) fn record(
        &mut self,
        evaluation: u64,
        rejected: bool,
        scored: Option<EvaluationScore>,
        facts: &mut Vec<Fact>,
    ) {
        // A subchain that stayed where it was has evaluated nothing.
        let stayed = scored.is_some_and(|s| s.end.is_some_and(|end| end.accepted == 0));
        // Held-out runs of a draw are no further parameter vector.
        let counts = !self.key(evaluation).is_of_holdout() && !stayed;
        self.simulations += u64::from(!stayed);
        self.evaluations += u64::from(counts);
        self.rejected += u64::from(counts && rejected);
        let Some(scored) = scored else {
            if rejected {
                self.note_refused(evaluation);
            }
            if self.done.len() == self.queue.len() {
                self.after_draws(facts);
            }
            return;
        };
        let EvaluationKey::Sampling { particle, .. } = self.key(evaluation) else {
            return;
        };
        let stages = self.engine.stages().len();
        let progress = self.engine.tell(particle, scored);
        for record in &self.engine.stages()[stages..] {
            facts.push(Fact::Stage {
                calibration: self.identity.id,
                record: Box::new(record.clone()),
                busy_ms: self.busy_ms,
            });
        }
        match progress {
            Ok(TellProgress::Waiting) => {}
            Ok(TellProgress::NextRound | TellProgress::StageFinished) => self.ask(),
            Ok(TellProgress::Finished) => {
                let calibration = self.identity.id;
                match self.engine.finding() {
                    Some(CalibrationResult::Posterior(posterior)) => {
                        self.draws = Some(final_draws(&posterior.particles, None));
                        facts.push(Fact::Posterior {
                            calibration,
                            posterior: Box::new(posterior.clone()),
                        });
                    }
                    Some(CalibrationResult::Estimate(estimate)) => {
                        self.draws = Some(match &estimate.approximation {
                            Some(approximation) => final_draws(&approximation.draws, Some(&estimate.theta)),
                            None => FinalDraws::new(
                                vec![estimate.theta.clone()],
                                self.histories.is_some().then(|| estimate.theta.clone()),
                            ),
                        });
                        facts.push(Fact::Estimate {
                            calibration,
                            estimate: Box::new(estimate.clone()),
                        });
                    }
                    Some(CalibrationResult::Discovery(record)) => {
                        facts.push(Fact::Discovery { calibration, record });
                        return self.conclude(facts);
                    }
                    None => {}
                }
                self.ask();
            }
            Ok(TellProgress::Failed(failure)) => {
                self.finish(CalibrationState::Failed, Some(failure.to_string()), facts);
            }
            Err(error) => self.finish(CalibrationState::Failed, Some(error.to_string()), facts),
        }
    }

    /// Notes that the model refuses the holdout runs of a draw together. Where there is one alone, or where a machine failed,
    /// asking again would bring nothing.
    fn note_refused(&mut self, evaluation: u64) {
        let EvaluationKey::Prediction { draw, holdout: true } = self.key(evaluation) else {
            return;
        };
        let is_model_s = self
            .done
            .get(&evaluation)
            .is_some_and(|d| d.answer.worker != NOBODY);
        if let Some(draws) = self.draws.as_mut().filter(|_| is_model_s)
            && self.spec.holdout_runs.len() > 1
        {
            draws.refused.insert(draw);
        }
    }

    /// What follows when all that was asked for of the final draws is there.
    fn after_draws(&mut self, facts: &mut Vec<Fact>) {
        match &mut self.draws {
            Some(draws) if !draws.apart && !draws.refused.is_empty() => {
                draws.apart = true;
                self.ask();
            }
            _ => self.conclude(facts),
        }
    }

    pub(super) fn finish(&mut self, state: CalibrationState, message: Option<String>, facts: &mut Vec<Fact>) {
        self.queue = LeaseQueue::default();
        self.second = SecondAnswers::default();
        self.change_state(state, message, facts);
    }

    /// Changes the state and says so to the store.
    pub fn change_state(&mut self, state: CalibrationState, message: Option<String>, facts: &mut Vec<Fact>) {
        self.state = state;
        self.message.clone_from(&message);
        facts.push(Fact::State {
            calibration: self.identity.id,
            state,
            message,
            busy_ms: self.busy_ms,
        });
    }

    fn kept(&self, evaluation: u64, outcome: Option<Result<Observables, String>>) -> Kept {
        let searched = |observables: &Observables| {
            let particle = self.proposal(evaluation)?.particle;
            self.engine.discovery()?.values(particle, observables)
        };
        match outcome {
            None => Kept::Scored,
            Some(Err(reason)) => Kept::Rejected(reason),
            Some(Ok(observables)) if self.draws.is_some() => Kept::Whole(Box::new(observables)),
            Some(Ok(observables)) if self.keeps_values() => Kept::Fitted(
                searched(&observables).unwrap_or_else(|| self.spec.predicted_values(&observables)),
            ),
            Some(Ok(_)) => Kept::Scored,
        }
    }

    /// Whether predicted values are kept in this round: an engine is told them again, or the draws are from the prior, which
    /// diagnostics compare with the posterior.
    fn keeps_values(&self) -> bool {
        let samples = matches!(self.spec.algorithm, AlgorithmSettings::Sample(_));
        self.spec.algorithm.is_told_values() || (samples && self.engine.round() == 0)
    }
}
