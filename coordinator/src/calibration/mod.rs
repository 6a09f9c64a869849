//! A calibration in progress: the one place where sampler or fit, likelihood and leases meet.
//!
//! Pure: it is told outcomes and answers with facts to store. The same [`Calibration::complete`] serves a
//! living worker and a replay from the store, so a restart cannot take another path.

mod computed;
mod draws;
mod engine;
mod replay;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use inference::Proposal;
use shared::api::CalibrationState;
use shared::file::FileSet;
use shared::model::ModelVariant;
use shared::outcome::Observables;
use statistics::{LogLikelihood, Metamodel, Subchain};

use crate::lease::{Completion, Queue};
use crate::missing_effect::{InvestigationError, Models};
use job::{Method, Spec};
use record::{EvaluationKey, EvaluationRow, Fact, Kept};

pub use computed::{Computed, result_of};
use draws::{FinalDraws, final_draws};
use engine::Scored;
pub use engine::{BeginError, Engine, Finding};
pub use replay::ReplayError;

/// Most effects that a search looks for together.
const EFFECTS_TOGETHER: usize = 3;

/// What the farm needs to know of a calibration besides its specification.
#[derive(Debug, Clone)]
pub struct Identity {
    /// Id in the store.
    pub id: i64,
    /// Name for lists.
    pub name: String,
    /// The study it belongs to.
    pub study: i64,
    /// The experiment it is about.
    pub experiment: i64,
}

/// A calibration in progress.
#[derive(Debug)]
pub struct Calibration {
    /// Who it is.
    pub identity: Identity,
    /// What it is about.
    pub spec: Arc<Spec>,
    /// Where it stands.
    pub state: CalibrationState,
    /// Why it is paused or failed.
    pub message: Option<String>,
    /// Version of the equations and the effects, pinned by the first lease.
    pub model_version: Option<String>,
    /// Evaluations asked for at present, and who holds them.
    pub queue: Queue,
    /// Wall time spent `[ms]`.
    pub busy_ms: u64,
    /// Evaluations completed, over all stages.
    pub evaluations: u64,
    /// Of these, refused by the model.
    pub rejected: u64,
    engine: Engine,
    fit_hash: String,
    holdout_hash: Option<String>,
    /// The fitted runs with the metamodel of the present stage: its number, the hash and the variant.
    stage_variant: Option<(usize, (String, ModelVariant))>,
    /// What is simulated once more for its histories, with its hash; `None` of a model that knows no time.
    histories: Option<(String, ModelVariant)>,
    /// What the calibration ends with; `None` while sampling.
    draws: Option<FinalDraws>,
    /// Evaluations of the present round that are done.
    done: BTreeSet<u64>,
    /// Failed leases by evaluation, kept over a restart.
    failed: BTreeMap<u64, u32>,
}

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

/// What an evaluation is leased with.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// Hash of the variant.
    pub variant: &'a str,
    /// The parameters: those of the model, of a subchain all.
    pub theta: &'a [f64],
    /// The subchain that starts there.
    pub subchain: Option<Subchain>,
}

impl Calibration {
    /// A fresh calibration; its first evaluations are draws from the prior.
    ///
    /// # Errors
    /// [`BeginError`]: the settings do not fit the prior, or this is a search, which [`Calibration::of`] begins.
    pub fn new(identity: Identity, spec: Arc<Spec>) -> Result<Self, BeginError> {
        Self::begin(identity, spec, None)
    }

    /// The same, with the texts that a search for a missing effect makes its models from.
    ///
    /// # Errors
    /// As those of [`Calibration::new`], or a model of a search cannot be made.
    pub fn of(
        identity: Identity,
        spec: Arc<Spec>,
        job: &FileSet,
        experiment: &FileSet,
    ) -> Result<Self, BeginError> {
        let models = match spec.method {
            Method::Discover { .. } => {
                let models = Models::new(job, experiment, EFFECTS_TOGETHER);
                Some(models.map_err(InvestigationError::from)?)
            }
            Method::Sample(_) | Method::Fit(_) | Method::Evolve(_) => None,
        };
        Self::begin(identity, spec, models)
    }

    fn begin(identity: Identity, spec: Arc<Spec>, models: Option<Models>) -> Result<Self, BeginError> {
        let engine = Engine::new(&spec, models)?;
        let mut calibration = Calibration {
            identity,
            fit_hash: spec.fit_variant.hash(),
            holdout_hash: spec.holdout_variant.as_ref().map(ModelVariant::hash),
            histories: spec
                .fit_variant
                .with_histories()
                .map(|variant| (variant.hash(), variant)),
            spec,
            state: CalibrationState::Queued,
            message: None,
            model_version: None,
            queue: Queue::default(),
            busy_ms: 0,
            evaluations: 0,
            rejected: 0,
            engine,
            stage_variant: None,
            draws: None,
            done: BTreeSet::new(),
            failed: BTreeMap::new(),
        };
        calibration.ask();
        Ok(calibration)
    }

    /// What asks for evaluations, for progress.
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// Whether evaluations may be leased.
    pub fn is_open(&self) -> bool {
        matches!(self.state, CalibrationState::Queued | CalibrationState::Running)
    }

    /// What an evaluation is leased with.
    pub fn question(&self, evaluation: u64) -> Option<Question<'_>> {
        let theta = self.theta(evaluation)?;
        if let Some((variant, theta)) = self.searched(evaluation) {
            return Some(Question {
                variant,
                theta,
                subchain: None,
            });
        }
        if let Some(subchain) = self.subchain(evaluation) {
            let (_, (variant, _)) = self.stage_variant.as_ref()?;
            return Some(Question {
                variant,
                theta,
                subchain: Some(subchain),
            });
        }
        let variant = match self.key(evaluation) {
            EvaluationKey::Prediction { holdout: true, .. } => self.holdout_hash.as_deref()?,
            EvaluationKey::Histories => &self.histories.as_ref()?.0,
            _ => &self.fit_hash,
        };
        Some(Question {
            variant,
            theta: self.spec.model_theta(theta),
            subchain: None,
        })
    }

    /// What an evaluation of a search is leased with; `None` of anything else.
    fn searched(&self, evaluation: u64) -> Option<(&str, &[f64])> {
        let particle = self.proposal(evaluation)?.particle;
        self.engine.investigation()?.lease(particle)
    }

    /// What an evaluation is for.
    fn key(&self, evaluation: u64) -> EvaluationKey {
        EvaluationKey::of(evaluation, self.spec.method.width())
    }

    /// The variant of a hash, if it is one of this calibration's.
    pub fn variant(&self, hash: &str) -> Option<&ModelVariant> {
        match hash {
            h if h == self.fit_hash => Some(&self.spec.fit_variant),
            h if Some(h) == self.holdout_hash.as_deref() => self.spec.holdout_variant.as_ref(),
            h => {
                let of_stage = self.stage_variant.iter().map(|(_, variant)| variant);
                let mut others = of_stage.chain(&self.histories);
                let searched = || self.engine.investigation()?.variant(h);
                others
                    .find(|(own, _)| own == h)
                    .map(|(_, variant)| variant)
                    .or_else(searched)
            }
        }
    }

    /// The whole parameter vector of an evaluation that is asked for at present; of a subchain, where it starts.
    fn theta(&self, evaluation: u64) -> Option<&[f64]> {
        match (self.key(evaluation), &self.draws) {
            (EvaluationKey::Prediction { draw, .. }, Some(draws)) => {
                draws.thetas.get(draw).map(Vec::as_slice)
            }
            (EvaluationKey::Histories, Some(draws)) => Some(&draws.likeliest),
            _ => self.proposal(evaluation).map(|p| p.theta.as_slice()),
        }
    }

    /// The proposal of an evaluation that is asked for at present, while sampling.
    fn proposal(&self, evaluation: u64) -> Option<&Proposal> {
        let pending = self.engine.pending();
        match self.key(evaluation) {
            EvaluationKey::Sampling { round, particle }
                if self.draws.is_none() && round == self.engine.round() =>
            {
                let place = pending.binary_search_by_key(&particle, |p| p.particle).ok()?;
                Some(&pending[place])
            }
            _ => None,
        }
    }

    /// The subchain that an evaluation asks for.
    fn subchain(&self, evaluation: u64) -> Option<Subchain> {
        self.proposal(evaluation).and_then(|p| p.subchain)
    }

    /// Asks for the evaluations of the present round.
    fn ask(&mut self) {
        self.prepare_stage();
        let particles = self.spec.method.width();
        self.done.clear();
        let failed = |evaluation| self.failed.get(&evaluation).copied().unwrap_or(0);
        match &self.draws {
            Some(draws) => {
                let parts = if self.holdout_hash.is_some() { 2 } else { 1 };
                let keys = (0..draws.thetas.len()).flat_map(|draw| {
                    let part = move |holdout| EvaluationKey::Prediction { draw, holdout }.number(particles);
                    [false, true].into_iter().take(parts).map(part)
                });
                let histories = self.histories.iter().map(|_| EvaluationKey::Histories);
                let keys = keys.chain(histories.map(|key| key.number(particles)));
                self.queue.ask(keys, failed);
            }
            None => {
                let round = self.engine.round();
                let keys = self.engine.pending().iter().map(|p| {
                    EvaluationKey::Sampling {
                        round,
                        particle: p.particle,
                    }
                    .number(particles)
                });
                self.queue.ask(keys, failed);
            }
        }
    }

    /// Makes the variant of the stage in progress, whose metamodel is frozen until the next one.
    fn prepare_stage(&mut self) {
        let metamodel = self.engine.metamodel();
        let stage = metamodel.map(Metamodel::stage);
        if self.stage_variant.as_ref().map(|(stage, ..)| *stage) != stage {
            self.stage_variant = metamodel.map(|metamodel| {
                let variant = self.spec.fit_variant.with_metamodel(metamodel);
                (metamodel.stage(), (variant.hash(), variant))
            });
        }
    }

    /// Takes the result of an evaluation; late duplicates change nothing.
    ///
    /// Returns the facts to store, in order, and whether the result counted.
    ///
    /// # Errors
    /// [`ResultError`] for a result that does not fit its variant: the worker's fault, nothing is recorded.
    pub fn complete(
        &mut self,
        evaluation: u64,
        computed: impl Into<Computed>,
        worker: &str,
    ) -> Result<(Vec<Fact>, bool), ResultError> {
        let computed = computed.into();
        self.check_shape(evaluation, &computed)?;
        match self.queue.complete(evaluation) {
            Completion::First => {}
            Completion::Duplicate | Completion::Unknown => {
                let fingerprint = computed.fingerprint();
                let (calibration, worker) = (self.identity.id, worker.to_owned());
                return Ok((
                    vec![Fact::Duplicate {
                        calibration,
                        evaluation,
                        fingerprint,
                        worker,
                    }],
                    false,
                ));
            }
        }
        let asked = self
            .theta(evaluation)
            .expect("the queue holds only evaluations asked for");
        let theta = computed.end.as_ref().map_or(asked, |end| &end.theta).to_vec();
        let fingerprint = computed.fingerprint();
        let rejected = computed.is_refused();
        let Computed { end, outcome } = computed;
        let scored = if self.draws.is_some() || self.engine.investigation().is_some() {
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
            Kept::Whole(_) | Kept::Refused(_) => None,
        };
        let scored = self.draws.is_none().then(|| Scored {
            // Where a subchain stayed there is nothing to score, and nothing is asked of the score.
            log_likelihood: log_likelihood.unwrap_or(LogLikelihood::Impossible),
            fitted,
            coarse: coarse.as_deref(),
            end: end.as_ref(),
        });
        let mut consequences = Vec::new();
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
    fn check_shape(&self, evaluation: u64, computed: &Computed) -> Result<(), ResultError> {
        if self.theta(evaluation).is_none() {
            return Ok(());
        }
        let subchain = self.subchain(evaluation).is_some();
        let moves = self.spec.method.metamodel_moves();
        if !computed.answers(subchain, moves, || self.spec.prior()) {
            return Err(ResultError::OtherQuestion { evaluation });
        }
        let searched = self.searched(evaluation).and_then(|(hash, _)| self.variant(hash));
        let variant = match (self.key(evaluation), &self.spec.holdout_variant, &self.histories) {
            _ if searched.is_some() => searched.unwrap_or(&self.spec.fit_variant),
            (EvaluationKey::Prediction { holdout: true, .. }, Some(variant), _) => variant,
            (EvaluationKey::Histories, _, Some((_, variant))) => variant,
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
    ) -> Result<LogLikelihood, statistics::LikelihoodError> {
        let Ok(observables) = outcome else {
            return Ok(LogLikelihood::Impossible);
        };
        let values = self.spec.predicted_values(observables);
        self.spec.likelihood.log_likelihood(&values, theta)
    }

    /// Lets a completed evaluation take effect on counts, engine and phase.
    fn record(&mut self, evaluation: u64, rejected: bool, scored: Option<Scored>, facts: &mut Vec<Fact>) {
        // A subchain that stayed where it was has evaluated nothing.
        let stayed = scored.is_some_and(|s| s.end.is_some_and(|end| end.accepted == 0));
        self.evaluations += u64::from(!stayed);
        self.rejected += u64::from(rejected);
        self.done.insert(evaluation);
        let Some(scored) = scored else {
            if self.done.len() == self.queue.len() {
                self.finish(CalibrationState::Finished, None, facts);
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
            Ok(inference::TellProgress::Waiting) => {}
            Ok(inference::TellProgress::NextRound | inference::TellProgress::StageFinished) => self.ask(),
            Ok(inference::TellProgress::Finished) => {
                let calibration = self.identity.id;
                match self.engine.finding() {
                    Some(Finding::Posterior(posterior)) => {
                        self.draws = Some(final_draws(posterior));
                        facts.push(Fact::Posterior {
                            calibration,
                            posterior: Box::new(posterior.clone()),
                        });
                    }
                    Some(Finding::Estimate(estimate)) => {
                        self.draws = Some(FinalDraws {
                            thetas: vec![estimate.theta.clone()],
                            likeliest: estimate.theta.clone(),
                        });
                        facts.push(Fact::Estimate {
                            calibration,
                            estimate: Box::new(estimate.clone()),
                        });
                    }
                    Some(Finding::Discovery(record)) => {
                        facts.push(Fact::Discovery { calibration, record });
                        return self.finish(CalibrationState::Finished, None, facts);
                    }
                    None => {}
                }
                self.ask();
            }
            Ok(inference::TellProgress::Failed(failure)) => {
                self.finish(CalibrationState::Failed, Some(failure.to_string()), facts);
            }
            Err(error) => self.finish(CalibrationState::Failed, Some(error.to_string()), facts),
        }
    }

    fn finish(&mut self, state: CalibrationState, message: Option<String>, facts: &mut Vec<Fact>) {
        self.queue = Queue::default();
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

    /// Records that a lease failed: kept over restarts; when the attempts are used up, the calibration pauses.
    pub fn lease_failed(&mut self, failure: &crate::lease::Failure, message: &str) -> Vec<Fact> {
        self.failed.insert(failure.evaluation, failure.attempt);
        let mut facts = vec![Fact::Fault {
            calibration: self.identity.id,
            evaluation: failure.evaluation,
            attempt: failure.attempt,
            worker: failure.worker.clone(),
            message: message.to_owned(),
        }];
        if failure.exhausted() {
            let theta = self
                .theta(failure.evaluation)
                .map(<[f64]>::to_vec)
                .unwrap_or_default();
            let message = format!(
                "evaluation {} at theta = {theta:?} failed on {} attempts, the last on worker {}: {message}",
                failure.evaluation, failure.attempt, failure.worker
            );
            self.change_state(CalibrationState::Paused, Some(message), &mut facts);
        }
        facts
    }

    /// Goes on after a pause; evaluations that had used up their attempts get new ones.
    pub fn resume(&mut self, facts: &mut Vec<Fact>) {
        // An attempt 0 in the list of faults: the new attempts outlive a restart.
        facts.extend(
            std::mem::take(&mut self.failed)
                .into_keys()
                .map(|evaluation| Fact::Fault {
                    calibration: self.identity.id,
                    evaluation,
                    attempt: 0,
                    worker: String::new(),
                    message: "given new attempts by a user".into(),
                }),
        );
        let done = std::mem::take(&mut self.done);
        self.ask();
        for &evaluation in &done {
            self.queue.complete(evaluation);
        }
        self.done = done;
        self.change_state(CalibrationState::Running, None, facts);
    }

    fn kept(&self, evaluation: u64, outcome: Option<Result<Observables, String>>) -> Kept {
        let searched = |observables: &Observables| {
            let particle = self.proposal(evaluation)?.particle;
            self.engine.investigation()?.values(particle, observables)
        };
        match outcome {
            None => Kept::Fitted(Vec::new()),
            Some(Err(reason)) => Kept::Refused(reason),
            Some(Ok(observables)) if self.draws.is_some() => Kept::Whole(Box::new(observables)),
            Some(Ok(observables)) => Kept::Fitted(
                searched(&observables).unwrap_or_else(|| self.spec.predicted_values(&observables)),
            ),
        }
    }
}
