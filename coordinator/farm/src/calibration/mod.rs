//! A calibration in progress, which combines sampler or fit, likelihood and leases.
//!
//! This module is pure: it takes outcomes and returns facts to store. A result of a living worker and one that is replayed from the store
//! pass through the same code, so a restart arrives at the same state.
//!
//! # Layout
//! - `mod`: [`Calibration`], and the evaluations that it asks for.
//! - `completion`: the consequences of a result. [`replay`]: the same for stored results.
//! - `phase`, `final_draws`: the progress of a calibration. `variants`: the model variants that it evaluates.
//! - `engine`: sampler, fit, evolution or search. `step`: what it computes between two rounds. `outline`: what is known of it
//!   meanwhile. `stepping`: the calibration between two rounds.
//! - `faults`: failed attempts at evaluations.
//! - `witness`, `comparison`, `second_answer`, `verification`: whether answers of two workers agree.
//! - `question`, `simulation_result`: the question of a lease, and its result.

mod comparison;
mod completion;
mod engine;
mod faults;
mod final_draws;
mod outline;
mod phase;
mod question;
pub mod replay;
mod second_answer;
mod simulation_result;
mod step;
mod stepping;
mod variants;
mod verification;
mod witness;

use std::collections::BTreeMap;
use std::sync::Arc;

use inference::Proposal;
use shared::api::CalibrationState;
use shared::file::FileSet;
use shared::model::ModelVariant;

use self::phase::Phase;
use self::step::DueStep;
use self::variants::Variants;
use crate::lease::{LeaseQueue, SlowLease};
use job::{AlgorithmSettings, Spec};
use record::{EvaluationKey, EvaluationRow, Fact, SealKey};
use search::{DiscoveryError, SearchModels};

pub use engine::{BeginError, CalibrationEngine, CalibrationResult};
pub use question::Question;
pub use second_answer::{Answer, SecondAnswers, Undecided, Verdict};
pub use simulation_result::{ResultError, SimulationResult};
pub use step::{Step, Stepped};
pub use verification::{Verification, VerificationRule};
pub use witness::Witness;

/// The largest number of effects that a search looks for together.
pub const MAX_EFFECTS_TOGETHER: usize = 3;

/// The place of a calibration in the store.
#[derive(Debug, Clone)]
pub struct CalibrationIdentity {
    /// Id in the store.
    pub id: i64,
    /// Name for lists.
    pub name: String,
    /// The study it belongs to.
    pub study: i64,
    /// The experiment it is about.
    pub experiment: i64,
}

/// What a calibration has cost so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cost {
    /// Wall time spent `[ms]`.
    pub busy_ms: u64,
    /// Evaluations completed, over all stages.
    pub evaluations: u64,
    /// The number of these that the model rejected.
    pub rejected: u64,
    /// Simulations completed: evaluations, and those of held-out runs.
    pub simulations: u64,
}

/// A calibration in progress.
#[derive(Debug)]
pub struct Calibration {
    /// Identity of the calibration.
    pub identity: CalibrationIdentity,
    /// Specification of the calibration.
    pub spec: Arc<Spec>,
    /// State of the calibration.
    pub state: CalibrationState,
    /// The reason of a pause or a failure.
    pub message: Option<String>,
    /// Version of the equations and the effects, pinned by the first result.
    pub model_version: Option<String>,
    /// The evaluations of the present round, and the workers that hold them.
    pub queue: LeaseQueue,
    /// Cost of the calibration so far.
    pub cost: Cost,
    /// The record of the workers that answered.
    pub witness: Witness,
    engine: CalibrationEngine,
    phase: Phase,
    /// The step between two rounds, if it is due or being taken. Meanwhile the engine is an outline.
    due: Option<DueStep>,
    variants: Variants,
    /// The workers of failed leases by evaluation, kept over a restart.
    failed: BTreeMap<u64, Vec<String>>,
    /// The whole results of the present round, if the engine asks for draws that may be the posterior as they are.
    drawn: BTreeMap<u64, EvaluationRow>,
}

impl Calibration {
    /// Makes a new calibration; its first evaluations are draws from the prior.
    ///
    /// # Errors
    /// [`BeginError`]: the settings do not fit the prior, or this is a search, which [`Calibration::from_files`] begins.
    pub fn new(identity: CalibrationIdentity, spec: Arc<Spec>) -> Result<Self, BeginError> {
        Self::begin(identity, spec, None)
    }

    /// Makes a new calibration or search. A search for a missing effect makes its models from the texts of job and experiment.
    ///
    /// # Errors
    /// [`BeginError`]: the settings do not fit the prior, or a model of a search cannot be made.
    pub fn from_files(
        identity: CalibrationIdentity,
        spec: Arc<Spec>,
        job: &FileSet,
        experiment: &FileSet,
    ) -> Result<Self, BeginError> {
        let models = match spec.algorithm {
            AlgorithmSettings::Discover { .. } => {
                let models = SearchModels::new(job, experiment, MAX_EFFECTS_TOGETHER);
                Some(models.map_err(DiscoveryError::from)?)
            }
            AlgorithmSettings::Sample(_) | AlgorithmSettings::Fit(_) | AlgorithmSettings::Evolve(_) => None,
        };
        Self::begin(identity, spec, models)
    }

    fn begin(
        identity: CalibrationIdentity,
        spec: Arc<Spec>,
        models: Option<SearchModels>,
    ) -> Result<Self, BeginError> {
        let mut calibration = Calibration {
            identity,
            engine: CalibrationEngine::new(&spec, models)?,
            variants: Variants::new(&spec),
            spec,
            state: CalibrationState::Queued,
            message: None,
            model_version: None,
            queue: LeaseQueue::default(),
            cost: Cost::default(),
            witness: Witness::default(),
            phase: Phase::Sampling,
            due: None,
            failed: BTreeMap::new(),
            drawn: BTreeMap::new(),
        };
        calibration.ask();
        Ok(calibration)
    }

    /// Makes the calibration compare some of its answers with those of a second worker.
    ///
    /// An external model may give two answers on honest machines. Its workers evaluate it twice themselves, so its answers are not compared
    /// here.
    ///
    /// # Arguments
    /// - `rule`: which of the evaluations a second worker computes as well, and who counts as another worker.
    /// - `key`: the key of the calibration, which determines the verified evaluations.
    #[must_use]
    pub fn verified(mut self, rule: &VerificationRule, key: SealKey) -> Self {
        let mut rule = rule.clone();
        if self.spec.model.external.is_some() {
            rule.share = 0.0;
        }
        self.witness.verification = Verification { rule, key };
        self
    }

    /// Returns the engine, for its progress.
    pub fn engine(&self) -> &CalibrationEngine {
        &self.engine
    }

    /// Returns whether evaluations may be leased.
    pub fn is_open(&self) -> bool {
        matches!(self.state, CalibrationState::Queued | CalibrationState::Running)
    }

    /// Returns whether only comparisons of answers are left.
    pub fn is_concluded(&self) -> bool {
        matches!(self.phase, Phase::Comparing(_)) && !self.state.is_final()
    }

    /// Returns the question of an evaluation; `None` for an evaluation that is not in the present round.
    pub fn question(&self, evaluation: u64) -> Option<Question<'_>> {
        let theta = self.theta(evaluation)?;
        let (variant, theta) = match self.searched(evaluation) {
            Some(searched) => searched,
            None => {
                let variant = match self.key(evaluation) {
                    // They are kept whole, so that they are not simulated again as final draws.
                    EvaluationKey::Sampling { .. } if self.engine.asks_final_draws() => self.variants.fit(),
                    key => self.variants.for_key(key)?,
                };
                (variant, self.spec.model_theta(theta))
            }
        };
        Some(Question { variant, theta })
    }

    /// Returns the variant with a hash, if this calibration uses it.
    pub fn variant(&self, hash: &str) -> Option<&ModelVariant> {
        let searched = || self.engine.discovery()?.variant(hash);
        let repeated = || self.witness.second.variant(hash);
        self.variants.get(hash).or_else(searched).or_else(repeated)
    }

    /// Asks a second worker for an evaluation of the present round. Questions of earlier rounds are no longer known.
    ///
    /// # Arguments
    /// - `slow`: the slow lease beside which the second worker is asked, so that the first answer is enough. Without one, the answers are
    ///   compared.
    pub fn ask_second(&mut self, evaluation: u64, slow: Option<&SlowLease>) {
        let Some(question) = self.question(evaluation) else {
            return;
        };
        let (hash, theta) = (question.variant.to_owned(), question.theta.to_vec());
        let question = Question {
            variant: &hash,
            theta: &theta,
        };
        let variant = self.variant(&hash).cloned();
        self.witness.second.ask(evaluation, question, variant, slow);
    }

    /// Stops asking beside slow leases that have ended, or whose evaluations are suspects, because a suspect may have only one holder. An
    /// evaluation that has been leased anew is not slow yet.
    pub fn drop_idle_seconds(&mut self) {
        let queue = &self.queue;
        self.witness.second.drop_idle(|evaluation, slow| {
            queue.lease_of(evaluation) == Some(slow) && !queue.is_suspect(evaluation)
        });
    }

    /// Changes the state and adds the fact to store.
    pub fn change_state(&mut self, state: CalibrationState, message: Option<String>, facts: &mut Vec<Fact>) {
        self.state = state;
        self.message.clone_from(&message);
        facts.push(Fact::State {
            calibration: self.identity.id,
            state,
            message,
            busy_ms: self.cost.busy_ms,
        });
    }

    /// Returns the variant and the parameters of a search's evaluation; `None` for other algorithms.
    fn searched(&self, evaluation: u64) -> Option<(&str, &[f64])> {
        let particle = self.proposal(evaluation)?.particle;
        self.engine.discovery()?.lease(particle)
    }

    /// Returns the purpose of an evaluation.
    fn key(&self, evaluation: u64) -> EvaluationKey {
        EvaluationKey::from_number(evaluation, self.spec.algorithm.width())
    }

    /// Returns the whole parameter vector of an evaluation of the present round.
    fn theta(&self, evaluation: u64) -> Option<&[f64]> {
        match (self.key(evaluation), self.phase.draws()) {
            (
                EvaluationKey::Prediction { draw, .. } | EvaluationKey::HoldoutRun { draw, .. },
                Some(draws),
            ) => draws.thetas.get(draw).map(Vec::as_slice),
            (EvaluationKey::Likeliest, Some(draws)) => draws.likeliest.as_deref(),
            _ => self.proposal(evaluation).map(|p| p.theta.as_slice()),
        }
    }

    /// Returns the proposal of an evaluation of the present round, while sampling.
    fn proposal(&self, evaluation: u64) -> Option<&Proposal> {
        let pending = self.engine.pending();
        match self.key(evaluation) {
            EvaluationKey::Sampling { round, particle }
                if self.phase.is_sampling() && round == self.engine.round() =>
            {
                let place = pending.binary_search_by_key(&particle, |p| p.particle).ok()?;
                Some(&pending[place])
            }
            _ => None,
        }
    }

    /// Begins a round.
    fn ask(&mut self) {
        self.witness.begin_round();
        self.drawn.clear();
        self.fill_queue();
    }

    /// Fills the queue with the evaluations of the present round.
    fn fill_queue(&mut self) {
        let keys: Vec<EvaluationKey> = match &self.phase {
            Phase::Sampling => {
                let round = self.engine.round();
                let key = |p: &Proposal| EvaluationKey::Sampling {
                    round,
                    particle: p.particle,
                };
                self.engine.pending().iter().map(key).collect()
            }
            Phase::FinalDraws(draws) => draws.keys(self.spec.holdout_variant.is_some()),
            Phase::RefusedRuns(draws) => {
                self.variants.split_holdout(self.spec.holdout_variant.as_ref());
                draws.keys_of_refused(self.variants.holdout_runs())
            }
            Phase::Comparing(_) => return,
        };
        let particles = self.spec.algorithm.width();
        let failed = |evaluation| self.failed.get(&evaluation).cloned().unwrap_or_default();
        self.queue
            .ask(keys.into_iter().map(|key| key.number(particles)), failed);
    }
}
