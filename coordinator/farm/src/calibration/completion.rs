//! The completion of evaluations: it checks and scores a result, and determines the facts to store and the next step.

use shared::api::CalibrationState;
use shared::outcome::Observables;
use statistics::{LikelihoodError, LogLikelihood};

use super::Calibration;
use super::final_draws::FinalDraws;
use super::phase::Phase;
use super::second_answer::{Answer, SecondAnswers};
use super::simulation_result::{ResultError, SimulationResult};
use super::witness::NOBODY;
use crate::lease::{Completion, LeaseQueue};
use job::AlgorithmSettings;
use record::{EvaluationKey, EvaluationRow, Fact, Kept, RejectionReason};

impl Calibration {
    /// Takes the result of an evaluation; a late duplicate is compared with the stored result and changes nothing else.
    ///
    /// Returns the facts to store, in order, and whether the result counted. After the last result of a round, a step is due
    /// ([`Calibration::step`], [`Calibration::take_step`]).
    ///
    /// # Errors
    /// [`ResultError`] for a result that does not fit its variant. The calibration is unchanged; the caller fails the lease.
    pub fn complete(
        &mut self,
        evaluation: u64,
        computed: SimulationResult,
        worker: &str,
    ) -> Result<(Vec<Fact>, bool), ResultError> {
        self.check(evaluation, &computed)?;
        Ok(self.take(evaluation, computed, worker))
    }

    /// Takes the result of an evaluation as [`Calibration::complete`] does, and asks a second worker for the same evaluation in order to
    /// compare their answers.
    ///
    /// # Errors
    /// The same as of [`Calibration::complete`].
    pub fn complete_verified(
        &mut self,
        evaluation: u64,
        computed: SimulationResult,
        worker: &str,
    ) -> Result<(Vec<Fact>, bool), ResultError> {
        self.check(evaluation, &computed)?;
        let is_trusted = self.witness.verification.rule.voting.trusts(worker);
        if self.witness.verification.is_on() && !is_trusted && self.queue.is_asked(evaluation) {
            self.ask_second(evaluation, None);
        }
        Ok(self.take(evaluation, computed, worker))
    }

    fn take(&mut self, evaluation: u64, computed: SimulationResult, worker: &str) -> (Vec<Fact>, bool) {
        let answer = Answer {
            worker: worker.to_owned(),
            fingerprint: computed.fingerprint(),
        };
        match self.queue.complete(evaluation) {
            Completion::First => {}
            Completion::Duplicate | Completion::Unknown => {
                return (self.compare(evaluation, answer), false);
            }
        }
        let row = match self.row(evaluation, computed, &answer) {
            Ok(row) => row,
            Err(error) => {
                let mut facts = Vec::new();
                self.finish(CalibrationState::Failed, Some(error.to_string()), &mut facts);
                return (facts, false);
            }
        };
        let mut consequences = Vec::new();
        self.answered_first(answer, evaluation);
        self.advance(&row, &mut consequences);
        let calibration = self.identity.id;
        let mut facts = vec![Fact::Evaluated { calibration, row }];
        facts.append(&mut consequences);
        (facts, true)
    }

    /// Checks that a result has the shape that its variant demands. A question of an earlier round is no longer known, so its result
    /// passes.
    fn check(&self, evaluation: u64, computed: &SimulationResult) -> Result<(), ResultError> {
        let Some(question) = self.question(evaluation) else {
            return Ok(());
        };
        let (Ok(observables), Some(variant)) = (&computed.0, self.variant(question.variant)) else {
            return Ok(());
        };
        if !observables.covers(variant) {
            let runs = variant.conditions.len();
            return Err(ResultError::WrongShape { evaluation, runs });
        }
        Ok(())
    }

    /// Makes the row that the store keeps and the engine is told.
    fn row(
        &self,
        evaluation: u64,
        computed: SimulationResult,
        answer: &Answer,
    ) -> Result<EvaluationRow, LikelihoodError> {
        let SimulationResult(outcome) = computed;
        let theta = self
            .theta(evaluation)
            .expect("the queue holds only evaluations asked for")
            .to_vec();
        let is_scored = self.phase.is_sampling() && self.engine.discovery().is_none();
        let log_likelihood = match is_scored {
            true => Some(self.spec.log_likelihood(outcome.as_ref().ok(), &theta)?),
            false => None,
        };
        Ok(EvaluationRow {
            evaluation,
            theta,
            log_likelihood: log_likelihood.map(LogLikelihood::value).filter(|l| l.is_finite()),
            kept: self.kept(evaluation, outcome),
            fingerprint: answer.fingerprint,
            worker: answer.worker.clone(),
        })
    }

    /// Returns the part of an outcome that is stored.
    fn kept(&self, evaluation: u64, outcome: Result<Observables, RejectionReason>) -> Kept {
        let searched = |observables: &Observables| {
            let particle = self.proposal(evaluation)?.particle;
            self.engine.discovery()?.values(particle, observables)
        };
        match outcome {
            Err(reason) => Kept::Rejected(reason.0),
            Ok(observables) if !self.phase.is_sampling() || self.engine.asks_final_draws() => {
                Kept::Whole(Box::new(observables))
            }
            Ok(observables) if self.keeps_values() => Kept::Fitted(
                searched(&observables).unwrap_or_else(|| self.spec.predicted_values(&observables)),
            ),
            Ok(_) => Kept::Scored,
        }
    }

    /// Returns whether predicted values are kept in this round: because the engine is told them again at a restart, or because diagnostics
    /// compare draws from the prior with the posterior.
    fn keeps_values(&self) -> bool {
        let samples = matches!(self.spec.algorithm, AlgorithmSettings::Sample(_));
        self.spec.algorithm.is_told_values() || (samples && self.engine.round() == 0)
    }

    /// Updates counts, engine and phase after a completed evaluation. After the last one of a round, the step of the engine is due.
    pub(super) fn advance(&mut self, row: &EvaluationRow, facts: &mut Vec<Fact>) {
        self.count(row);
        if !self.phase.is_sampling() {
            self.note_refused(row);
            if self.witness.answered() == self.queue.len() {
                self.end_phase(facts);
            }
            return;
        }
        let EvaluationKey::Sampling { particle, .. } = self.key(row.evaluation) else {
            return;
        };
        let selected = match &row.kept {
            Kept::Whole(observables) => {
                self.drawn.insert(row.evaluation, row.clone());
                Some(self.spec.predicted_values(observables))
            }
            Kept::Scored | Kept::Fitted(_) | Kept::Rejected(_) => None,
        };
        if self.witness.answered() == self.queue.len() {
            let values = selected.or_else(|| row.kept.fitted().map(<[f64]>::to_vec));
            self.end_round(particle, row, values);
            return;
        }
        let values = selected.as_deref().or(row.kept.fitted());
        if let Err(error) = self.engine.tell(particle, row, values) {
            self.finish(CalibrationState::Failed, Some(error.to_string()), facts);
        }
    }

    fn count(&mut self, row: &EvaluationRow) {
        // The held-out runs of a draw do not count as a further parameter vector.
        let is_counted = !self.key(row.evaluation).is_of_holdout();
        self.cost.simulations += 1;
        self.cost.evaluations += u64::from(is_counted);
        self.cost.rejected += u64::from(is_counted && row.kept.is_rejected());
    }

    /// Asks for the final draws of an engine that has ended; a search has none.
    pub(super) fn end_sampling(&mut self, draws: Option<FinalDraws>, facts: &mut Vec<Fact>) {
        let Some(mut draws) = draws else {
            return self.end_phase(facts);
        };
        let calibration = self.identity.id;
        let taken_over = draws.take_over(&self.drawn, self.spec.algorithm.width());
        facts.extend(
            taken_over
                .into_iter()
                .map(|row| Fact::Evaluated { calibration, row }),
        );
        self.phase = Phase::FinalDraws(draws);
        self.ask();
    }

    /// Notes that the model rejects the holdout runs of a draw together, so that they are simulated one by one. This would not help with a
    /// single holdout run, or where machines failed.
    fn note_refused(&mut self, row: &EvaluationRow) {
        if let EvaluationKey::Prediction { draw, holdout: true } = self.key(row.evaluation)
            && row.kept.is_rejected()
            && row.worker != NOBODY
            && self.spec.holdout_runs.len() > 1
            && let Phase::FinalDraws(draws) = &mut self.phase
        {
            draws.refused.insert(draw);
        }
    }

    /// Begins the next phase, once the present one has all its answers.
    fn end_phase(&mut self, facts: &mut Vec<Fact>) {
        self.phase = std::mem::take(&mut self.phase).next();
        match self.phase {
            Phase::Comparing(_) => self.finish_if_compared(facts),
            Phase::Sampling | Phase::FinalDraws(_) | Phase::RefusedRuns(_) => self.ask(),
        }
    }

    /// Finishes a calibration that has no evaluations and no comparisons left.
    pub fn finish_if_compared(&mut self, facts: &mut Vec<Fact>) {
        if self.is_concluded() && self.witness.second.waiting() == 0 {
            self.finish(CalibrationState::Finished, None, facts);
            self.expire_values(facts);
        }
    }

    /// Says which predicted values were kept for a replay alone. Diagnostics compare those of draws from the prior with the posterior.
    fn expire_values(&self, facts: &mut Vec<Fact>) {
        let algorithm = &self.spec.algorithm;
        if !algorithm.is_told_values() {
            return;
        }
        let from = match algorithm {
            AlgorithmSettings::Sample(_) => algorithm.width() as u64,
            AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(_) | AlgorithmSettings::Discover { .. } => {
                0
            }
        };
        facts.push(Fact::ValuesExpired {
            calibration: self.identity.id,
            from,
        });
    }

    pub(super) fn finish(&mut self, state: CalibrationState, message: Option<String>, facts: &mut Vec<Fact>) {
        self.queue = LeaseQueue::default();
        self.witness.second = SecondAnswers::default();
        self.change_state(state, message, facts);
    }
}
