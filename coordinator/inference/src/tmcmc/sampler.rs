//! Run the rounds: list proposals, take their log-likelihoods, advance.

use std::sync::Arc;

use super::equilibrium::{Drift, is_alarming, pooled_z};
use super::evaluation::EvaluationResult;
use super::evidence::Evidence;
use super::particle::Particle;
use super::record::{PosteriorSample, StageRecord};
use super::settings::{Algorithm, TmcmcSettings, TmcmcSettingsError};
use super::stage::Stage;
use super::transition::Transition;
use crate::round::{InferenceFailure, Proposal, ProposalRound, TellError, TellProgress};
use statistics::likelihood::Likelihood;
use statistics::metamodel::{ChainState, Metamodel, MetamodelStage, Pool};
use statistics::prior::Prior;
use statistics::rng::Stream;

/// Steps between two looks at a stage's equilibrium; one with a metamodel, whose steps hold many moves.
const BLOCK: usize = 5;

/// An ask/tell sampler.
///
/// A round is a set of proposals that can be evaluated at the same time; the sampler advances when all have
/// been told. Its state is a function of prior, settings and the told values, whatever their order.
#[derive(Debug, Clone)]
pub struct Sampler {
    pub(super) prior: Prior,
    pub(super) settings: TmcmcSettings,
    /// What a metamodel scores its predictions with; `None`: there is none.
    pub(super) likelihood: Option<Likelihood>,
    pub(super) round: ProposalRound<EvaluationResult>,
    pub(super) phase: SamplerPhase,
    pub(super) evidence: Evidence,
    pub(super) passage: Passage,
    pub(super) stages: Vec<StageRecord>,
    pub(super) posterior: Option<PosteriorSample>,
    pub(super) evaluations: u64,
    pub(super) rejected: u64,
}

/// How the stage in progress was reached.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Passage {
    /// Growth of the exponent.
    step: f64,
    weight_cov: f64,
    /// Part of the increment of the log-evidence that is known already.
    log_evidence: f64,
}

/// What the sampler is doing.
#[derive(Debug, Clone)]
pub(super) enum SamplerPhase {
    /// Waiting for the prior draws, whose coordinates are held.
    Prior,
    Moving(Box<Stage>),
    Done,
    Failed(InferenceFailure),
}

impl Sampler {
    /// A sampler whose round 0 holds the prior draws.
    ///
    /// # Errors
    /// [`TmcmcSettingsError`] names the setting, its value and its bound.
    pub fn new(prior: Prior, settings: TmcmcSettings) -> Result<Self, TmcmcSettingsError> {
        settings.check(prior.dimension())?;
        let pending: Vec<Proposal> = (0..settings.particles)
            .map(|particle| {
                let mut stream = Stream::new(settings.seed, 0, particle as u64, 0);
                Proposal::plain(particle, prior.sample(&mut stream))
            })
            .collect();
        let mut sampler = Self {
            prior,
            settings,
            likelihood: None,
            round: ProposalRound::default(),
            phase: SamplerPhase::Prior,
            evidence: Evidence::default(),
            passage: Passage::default(),
            stages: Vec::new(),
            posterior: None,
            evaluations: 0,
            rejected: 0,
        };
        sampler.round.ask(pending);
        Ok(sampler)
    }

    /// A sampler whose chains are moved by a metamodel between evaluations.
    ///
    /// # Arguments
    /// - `settings`: of [`Algorithm::Tmcmc`]; `metamodel_moves` of 0 is a sampler without.
    /// - `likelihood`: scores what the metamodel predicts; the answers have to be scored by the same.
    ///
    /// # Errors
    /// [`TmcmcSettingsError`] names the setting, its value and its bound.
    pub fn with_metamodel(
        prior: Prior,
        settings: TmcmcSettings,
        likelihood: Likelihood,
    ) -> Result<Self, TmcmcSettingsError> {
        let mut sampler = Self::new(prior, settings)?;
        sampler.likelihood = (settings.metamodel_moves > 0).then_some(likelihood);
        Ok(sampler)
    }

    /// Takes the answer for a pending particle, a log-likelihood or what a subchain came to; the last one of a round
    /// advances the sampler.
    ///
    /// # Errors
    /// [`TellError::AlreadyTold`], [`TellError::NotPending`] and [`TellError::NotAsked`]; the sampler is then unchanged.
    pub fn tell(
        &mut self,
        particle: usize,
        answer: impl Into<EvaluationResult>,
    ) -> Result<TellProgress, TellError> {
        let answer = answer.into();
        let moved = matches!(answer, EvaluationResult::Moved { .. });
        let asked = self.round.proposal(particle);
        if asked.is_some_and(|proposal| proposal.subchain.is_some() != moved) {
            let round = self.round.number();
            return Err(TellError::NotAsked { round, particle });
        }
        Ok(if self.round.tell(particle, answer)? {
            self.advance()
        } else {
            TellProgress::Waiting
        })
    }

    /// Completes rounds until proposals are pending or the sampler has ended.
    fn advance(&mut self) -> TellProgress {
        let stages = self.stages.len();
        loop {
            let (proposals, answers) = self.round.complete();
            self.evaluations += answers.iter().filter(|answer| answer.is_evaluated()).count() as u64;
            self.rejected += answers.iter().filter(|answer| answer.is_refused()).count() as u64;
            let next = match std::mem::replace(&mut self.phase, SamplerPhase::Done) {
                SamplerPhase::Prior => self.finish_prior(&proposals, answers),
                SamplerPhase::Moving(mut stage) => {
                    stage.accept(&self.prior, answers);
                    self.after_step(stage)
                }
                ended @ (SamplerPhase::Done | SamplerPhase::Failed(_)) => Ok(ended),
            };
            self.phase = next.unwrap_or_else(SamplerPhase::Failed);
            match &mut self.phase {
                SamplerPhase::Moving(stage) => {
                    let proposals = stage.propose(&self.prior, self.settings.seed);
                    self.round.ask(proposals);
                }
                SamplerPhase::Failed(failure) => return TellProgress::Failed(*failure),
                SamplerPhase::Prior | SamplerPhase::Done => return TellProgress::Finished,
            }
            if !self.round.pending().is_empty() {
                return if self.stages.len() > stages {
                    TellProgress::StageFinished
                } else {
                    TellProgress::NextRound
                };
            }
        }
    }

    /// Turns the prior draws into the first stage; draws that the model rejected are dropped, and the
    /// evidence multiplied by the surviving fraction.
    fn finish_prior(
        &mut self,
        proposals: &[Proposal],
        answers: Vec<EvaluationResult>,
    ) -> Result<SamplerPhase, InferenceFailure> {
        let draws = answers.len();
        let mut pool = Pool::default();
        for (proposal, answer) in proposals.iter().zip(answers) {
            if let EvaluationResult::Here { log_likelihood, pair } = answer
                && !log_likelihood.is_impossible()
            {
                let coordinates = self.prior.coordinates(&proposal.theta);
                let log_prior = self.prior.log_density_of_coordinates(&coordinates);
                pool.push(
                    pool.states.len(),
                    ChainState {
                        coordinates,
                        log_prior,
                        log_likelihood,
                        pair: pair.map(Arc::new),
                    },
                );
            }
        }
        let (possible, needed) = (pool.states.len(), self.prior.dimension() + 2);
        if possible == 0 {
            return Err(InferenceFailure::AllImpossible { draws });
        }
        if possible < needed {
            return Err(InferenceFailure::TooFewPossible {
                possible,
                draws,
                needed,
            });
        }
        let survival = self.evidence.survive(possible, draws);
        self.evidence.add(&pool, Vec::new(), 0.0);
        self.begin_stage(&pool, 1, 0.0, None, survival)
    }

    /// Starts the stage that follows a pool; `log_evidence` is already known of its increment.
    fn begin_stage(
        &mut self,
        pool: &Pool,
        index: usize,
        exponent: f64,
        scale: Option<f64>,
        log_evidence: f64,
    ) -> Result<SamplerPhase, InferenceFailure> {
        let Transition {
            mut stage,
            weights,
            step,
        } = Transition::new(pool, index, exponent, scale, &self.settings)?;
        stage.metamodel = self.learn(&stage, pool, &weights.normalised())?;
        self.passage = Passage {
            step,
            weight_cov: weights.cov,
            log_evidence,
        };
        Ok(SamplerPhase::Moving(Box::new(stage)))
    }

    /// The metamodel of a stage, from the pool that it begins with.
    fn learn(
        &self,
        stage: &Stage,
        pool: &Pool,
        weights: &[f64],
    ) -> Result<Option<Arc<Metamodel>>, InferenceFailure> {
        let Some(likelihood) = &self.likelihood else {
            return Ok(None);
        };
        let purpose = MetamodelStage {
            seed: self.settings.seed,
            stage: stage.index,
            exponent: stage.exponent,
            moves: self.settings.metamodel_moves,
            prior: &self.prior,
            likelihood,
        };
        let metamodel = Metamodel::learn(&purpose, pool, weights, &stage.mixture);
        Ok(metamodel.map_err(InferenceFailure::Metamodel)?.map(Arc::new))
    }

    /// Goes on with a stage, or ends it and starts the next or the posterior.
    fn after_step(&mut self, stage: Box<Stage>) -> Result<SamplerPhase, InferenceFailure> {
        let [least, _] = self.settings.moves;
        let mut drift = None;
        if self.settings.algorithm == Algorithm::Tmcmc
            && stage.step >= least
            && (stage.step - least).is_multiple_of(if stage.metamodel.is_some() { 1 } else { BLOCK })
        {
            drift = Some(self.drift(&stage)).filter(|drift| drift.is_settled());
        }
        if drift.is_none() && !stage.is_exhausted() {
            return Ok(SamplerPhase::Moving(stage));
        }
        let drift = drift.unwrap_or_else(|| self.drift(&stage));
        self.record(&stage, drift);
        if stage.exponent < 1.0 {
            return self.begin_stage(
                &stage.pool,
                stage.index + 1,
                stage.exponent,
                Some(stage.scale),
                0.0,
            );
        }
        let drift_z = pooled_z(self.stages.iter().map(|stage| stage.drift_z));
        let weight_drift_z = pooled_z(self.stages.iter().map(|stage| stage.weight_drift_z));
        self.posterior = Some(PosteriorSample {
            particles: self
                .stages
                .last()
                .map(|last| last.population.clone())
                .unwrap_or_default(),
            log_evidence: self.evidence.log,
            log_evidence_se: self.evidence.standard_error(),
            drift_z,
            weight_drift_z,
            equilibrated: self.stages.iter().all(|stage| stage.equilibrated)
                && !is_alarming(drift_z)
                && !is_alarming(weight_drift_z),
            evaluations: self.evaluations,
            rejected: self.rejected,
        });
        Ok(SamplerPhase::Done)
    }

    /// Drift of a stage: of its chains from start to end or, after Ching and Chen, of every particle from the
    /// leader of its chain (with one step, as BASIS has, they are the same). The chains have moved if they
    /// accepted one step each on average.
    fn drift(&self, stage: &Stage) -> Drift {
        let chains = &stage.chains;
        let moved = stage.accepted >= chains.len() as u64;
        let (members, end): (Vec<usize>, Vec<f64>) = if self.settings.algorithm.keeps_every_step() {
            (stage.pool.chains.clone(), stage.pool.log_likelihoods())
        } else {
            let end = chains.iter().map(|chain| chain.current.log_likelihood.value());
            ((0..chains.len()).collect(), end.collect())
        };
        let start: Vec<f64> = members.iter().map(|&chain| chains[chain].start.value()).collect();
        let clusters: Vec<usize> = members.iter().map(|&chain| chains[chain].ancestor).collect();
        Drift::of(&start, &end, &clusters, self.passage.step, moved)
    }

    /// Files a finished stage.
    fn record(&mut self, stage: &Stage, drift: Drift) {
        let Passage {
            step,
            weight_cov,
            log_evidence,
        } = self.passage;
        let ancestors = stage.chains.iter().map(|chain| chain.ancestor).collect();
        let log_evidence_increment = log_evidence + self.evidence.add(&stage.pool, ancestors, step);
        let population: Vec<&ChainState> = if self.settings.algorithm.keeps_every_step() {
            stage.pool.states.iter().collect()
        } else {
            stage.chains.iter().map(|chain| &chain.current).collect()
        };
        self.stages.push(StageRecord {
            stage: stage.index,
            tempering_exponent: stage.exponent,
            acceptance: stage.acceptance().unwrap_or(0.0),
            drift_z: drift.z,
            weight_drift_z: drift.weight_z,
            correlation: drift.correlation,
            steps: stage.step,
            log_evidence_increment,
            weight_cov,
            ess: self.settings.particles as f64 / (1.0 + weight_cov * weight_cov),
            scale: stage.scale,
            evaluations: stage.evaluations,
            equilibrated: drift.is_equilibrated(),
            population: population
                .into_iter()
                .map(|state| Particle::new(state, &self.prior))
                .collect(),
        });
    }
}
