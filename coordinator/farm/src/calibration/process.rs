//! A calibration in progress: its state, and what it asks for.

use std::collections::BTreeMap;
use std::sync::Arc;

use inference::Proposal;
use shared::api::CalibrationState;
use shared::file::FileSet;
use shared::model::ModelVariant;
use statistics::{Metamodel, Subchain};

use super::engine::{BeginError, CalibrationEngine};
use super::final_draws::FinalDraws;
use super::question::Question;
use super::second_answer::{SecondAnswers, StoredAnswer};
use super::verification::Verification;
use crate::lease::{LeaseQueue, SlowLease};
use job::{AlgorithmSettings, Spec};
use record::EvaluationKey;
use search::{DiscoveryError, SearchModels};

/// Most effects that a search looks for together.
const EFFECTS_TOGETHER: usize = 3;

/// What the farm needs to know of a calibration besides its specification.
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

/// A calibration in progress.
#[derive(Debug)]
pub struct Calibration {
    /// Its identity.
    pub identity: CalibrationIdentity,
    /// Its specification.
    pub spec: Arc<Spec>,
    /// Its state.
    pub state: CalibrationState,
    /// Why it is paused or failed.
    pub message: Option<String>,
    /// Version of the equations and the effects, pinned by the first result.
    pub model_version: Option<String>,
    /// Evaluations asked for at present, and who holds them.
    pub queue: LeaseQueue,
    /// Wall time spent `[ms]`.
    pub busy_ms: u64,
    /// Evaluations completed, over all stages.
    pub evaluations: u64,
    /// Of these, refused by the model.
    pub rejected: u64,
    /// Simulations completed: evaluations, and those of held-out runs.
    pub simulations: u64,
    pub(super) engine: CalibrationEngine,
    /// What is evaluated while sampling, with its hash.
    pub(super) sampled: (String, ModelVariant),
    fit_hash: String,
    pub(super) holdout_hash: Option<String>,
    /// The fitted runs with the metamodel of the present stage: its number, the hash and the variant.
    stage_variant: Option<(usize, (String, ModelVariant))>,
    /// The fitted runs with their histories, and their hash; `None` of a model that knows no time.
    pub(super) histories: Option<(String, ModelVariant)>,
    /// Each holdout run by itself, with its hash; none before they are asked for.
    pub(super) apart: Vec<(String, ModelVariant)>,
    /// What the calibration ends with; `None` while sampling.
    pub(super) draws: Option<FinalDraws>,
    /// Answers of the present round.
    pub(super) done: BTreeMap<u64, StoredAnswer>,
    /// Evaluations of the present round that were given up after faults.
    pub(super) given_up: usize,
    /// The workers of failed leases by evaluation, kept over a restart.
    pub(super) failed: BTreeMap<u64, Vec<String>>,
    /// Which evaluations a second worker computes as well.
    pub verification: Verification,
    /// Evaluations that a second worker is asked for.
    pub second: SecondAnswers,
    /// Stored answers by worker that no other worker has confirmed.
    pub(super) unconfirmed: BTreeMap<String, u64>,
    /// Stored answers that another worker has confirmed.
    pub confirmed: u64,
    /// Whether results were dropped, so that numbers of evaluations have asked something else before.
    pub is_rewound: bool,
    /// Whether nothing is left but to compare answers.
    pub(super) is_concluded: bool,
    /// Workers found to compute wrongly, with the evaluation, since they were last asked for.
    pub(super) convicted: Vec<(String, u64)>,
}

impl Calibration {
    /// A fresh calibration; its first evaluations are draws from the prior.
    ///
    /// # Errors
    /// [`BeginError`]: the settings do not fit the prior, or this is a search, which [`Calibration::of`] begins.
    pub fn new(identity: CalibrationIdentity, spec: Arc<Spec>) -> Result<Self, BeginError> {
        Self::begin(identity, spec, None)
    }

    /// The same, with the texts that a search for a missing effect makes its models from.
    ///
    /// # Errors
    /// As those of [`Calibration::new`], or a model of a search cannot be made.
    pub fn of(
        identity: CalibrationIdentity,
        spec: Arc<Spec>,
        job: &FileSet,
        experiment: &FileSet,
    ) -> Result<Self, BeginError> {
        let models = match spec.algorithm {
            AlgorithmSettings::Discover { .. } => {
                let models = SearchModels::new(job, experiment, EFFECTS_TOGETHER);
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
        let engine = CalibrationEngine::new(&spec, models)?;
        let mut calibration = Calibration {
            identity,
            sampled: hashed(spec.sampled_variant()),
            fit_hash: spec.fit_variant.hash(),
            holdout_hash: spec.holdout_variant.as_ref().map(ModelVariant::hash),
            histories: spec.fit_variant.with_histories().map(hashed),
            spec,
            state: CalibrationState::Queued,
            message: None,
            model_version: None,
            queue: LeaseQueue::default(),
            busy_ms: 0,
            evaluations: 0,
            rejected: 0,
            simulations: 0,
            engine,
            stage_variant: None,
            apart: Vec::new(),
            draws: None,
            done: BTreeMap::new(),
            given_up: 0,
            failed: BTreeMap::new(),
            verification: Verification::OFF,
            second: SecondAnswers::default(),
            unconfirmed: BTreeMap::new(),
            confirmed: 0,
            is_rewound: false,
            is_concluded: false,
            convicted: Vec::new(),
        };
        calibration.ask();
        Ok(calibration)
    }

    /// What asks for evaluations, for progress.
    pub fn engine(&self) -> &CalibrationEngine {
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
            EvaluationKey::HoldoutRun { run, .. } => &self.apart.get(run)?.0,
            EvaluationKey::Likeliest => self.histories.as_ref().map_or(&self.fit_hash, |(hash, _)| hash),
            EvaluationKey::Prediction { .. } => &self.fit_hash,
            EvaluationKey::Sampling { .. } => &self.sampled.0,
        };
        Some(Question {
            variant,
            theta: self.spec.model_theta(theta),
            subchain: None,
        })
    }

    /// Asks a second worker for an evaluation that is asked for at present: of one that is not, nothing is known any more.
    ///
    /// # Arguments
    /// - `slow`: the lease that is too slow: the first answer is enough. Without one, the answers are compared.
    pub fn ask_second(&mut self, evaluation: u64, slow: Option<&SlowLease>) {
        let Some(question) = self.question(evaluation) else {
            return;
        };
        let (hash, theta) = (question.variant.to_owned(), question.theta.to_vec());
        let question = Question {
            variant: &hash,
            theta: &theta,
            subchain: question.subchain,
        };
        let variant = self.variant(&hash).cloned();
        self.second.ask(evaluation, question, variant, slow);
    }

    /// What an evaluation of a search is leased with; `None` of anything else.
    pub(super) fn searched(&self, evaluation: u64) -> Option<(&str, &[f64])> {
        let particle = self.proposal(evaluation)?.particle;
        self.engine.discovery()?.lease(particle)
    }

    /// What an evaluation is for.
    pub(super) fn key(&self, evaluation: u64) -> EvaluationKey {
        EvaluationKey::of(evaluation, self.spec.algorithm.width())
    }

    /// The variant of a hash, if it is one of this calibration's.
    pub fn variant(&self, hash: &str) -> Option<&ModelVariant> {
        match hash {
            h if h == self.sampled.0 => Some(&self.sampled.1),
            h if h == self.fit_hash => Some(&self.spec.fit_variant),
            h if Some(h) == self.holdout_hash.as_deref() => self.spec.holdout_variant.as_ref(),
            h => {
                let of_stage = self.stage_variant.iter().map(|(_, variant)| variant);
                let mut others = of_stage.chain(&self.histories).chain(&self.apart);
                let searched = || self.engine.discovery()?.variant(h);
                others
                    .find(|(own, _)| own == h)
                    .map(|(_, variant)| variant)
                    .or_else(searched)
                    .or_else(|| self.second.variant(h))
            }
        }
    }

    /// The whole parameter vector of an evaluation that is asked for at present; of a subchain, where it starts.
    pub(super) fn theta(&self, evaluation: u64) -> Option<&[f64]> {
        match (self.key(evaluation), &self.draws) {
            (
                EvaluationKey::Prediction { draw, .. } | EvaluationKey::HoldoutRun { draw, .. },
                Some(draws),
            ) => draws.thetas.get(draw).map(Vec::as_slice),
            (EvaluationKey::Likeliest, Some(draws)) => draws.likeliest.as_deref(),
            _ => self.proposal(evaluation).map(|p| p.theta.as_slice()),
        }
    }

    /// The proposal of an evaluation that is asked for at present, while sampling.
    pub(super) fn proposal(&self, evaluation: u64) -> Option<&Proposal> {
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
    pub(super) fn subchain(&self, evaluation: u64) -> Option<Subchain> {
        self.proposal(evaluation).and_then(|p| p.subchain)
    }

    /// Asks for the evaluations of the present round.
    pub(super) fn ask(&mut self) {
        self.prepare_stage();
        let particles = self.spec.algorithm.width();
        self.done.clear();
        self.given_up = 0;
        let failed = |evaluation| self.failed.get(&evaluation).cloned().unwrap_or_default();
        match &self.draws {
            Some(draws) if draws.apart => {
                let holdout = self.spec.holdout_variant.iter();
                self.apart = holdout.flat_map(ModelVariant::by_condition).map(hashed).collect();
                let runs = 0..self.apart.len();
                let keys = draws.refused.iter().flat_map(|&draw| {
                    runs.clone()
                        .map(move |run| EvaluationKey::HoldoutRun { draw, run })
                });
                self.queue.ask(keys.map(|key| key.number(particles)), failed);
            }
            Some(draws) => {
                let parts = if self.holdout_hash.is_some() { 2 } else { 1 };
                let keys = (0..draws.thetas.len()).flat_map(|draw| {
                    let part = move |holdout| EvaluationKey::Prediction { draw, holdout }.number(particles);
                    [false, true].into_iter().take(parts).map(part)
                });
                let likeliest = draws.likeliest.iter().map(|_| EvaluationKey::Likeliest);
                let keys = keys.chain(likeliest.map(|key| key.number(particles)));
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
                let variant = self.sampled.1.with_metamodel(metamodel);
                (metamodel.stage(), hashed(variant))
            });
        }
    }
}

/// A variant with its hash.
fn hashed(variant: ModelVariant) -> (String, ModelVariant) {
    (variant.hash(), variant)
}
