//! Run the rounds: list proposals, take their log-likelihoods, advance.

use super::equilibrium::{CORRELATION_LIMIT, Drift};
use super::evidence::Evidence;
use super::population::{Particle, Pool, Proposal, State};
use super::record::{Current, Failure, Posterior, Progress, StageRecord, TellError};
use super::settings::{Algorithm, Settings, SettingsError};
use super::stage::Stage;
use super::transition::Transition;
use crate::log_likelihood::LogLikelihood;
use crate::prior::Prior;
use crate::rng::Stream;

/// Steps between two looks at a stage's equilibrium.
const BLOCK: usize = 5;

/// An ask/tell sampler.
///
/// A round is a set of proposals that can be evaluated at the same time; the sampler advances when all have been
/// told. Its state is a function of prior, settings and the told values, whatever their order.
#[derive(Debug, Clone)]
pub struct Sampler {
    prior: Prior,
    settings: Settings,
    round: u64,
    pending: Vec<Proposal>,
    answers: Vec<Option<LogLikelihood>>,
    missing: usize,
    phase: Phase,
    prior_draws: Vec<Particle>,
    evidence: Evidence,
    passage: Passage,
    stages: Vec<StageRecord>,
    posterior: Option<Posterior>,
    evaluations: u64,
    rejected: u64,
}

/// How the stage in progress was reached.
#[derive(Debug, Clone, Copy, Default)]
struct Passage {
    /// Growth of the exponent.
    step: f64,
    weight_cov: f64,
    /// Part of the increment of the log-evidence that is known already.
    log_evidence: f64,
}

/// What the sampler is doing.
#[derive(Debug, Clone)]
enum Phase {
    /// Waiting for the prior draws, whose coordinates are held.
    Prior,
    Moving(Box<Stage>),
    Done,
    Failed(Failure),
}

impl Sampler {
    /// A sampler whose round 0 holds the prior draws.
    ///
    /// # Errors
    /// [`SettingsError`] names the setting, its value and its bound.
    pub fn new(prior: Prior, settings: Settings) -> Result<Self, SettingsError> {
        settings.check(prior.dimension())?;
        let pending: Vec<Proposal> = (0..settings.particles)
            .map(|particle| {
                let mut stream = Stream::new(settings.seed, 0, particle as u64, 0);
                Proposal {
                    particle,
                    theta: prior.sample(&mut stream),
                }
            })
            .collect();
        let mut sampler = Self {
            prior,
            settings,
            round: 0,
            pending: Vec::new(),
            answers: Vec::new(),
            missing: 0,
            phase: Phase::Prior,
            prior_draws: Vec::new(),
            evidence: Evidence::default(),
            passage: Passage::default(),
            stages: Vec::new(),
            posterior: None,
            evaluations: 0,
            rejected: 0,
        };
        sampler.ask(pending);
        Ok(sampler)
    }

    /// The prior.
    #[must_use]
    pub fn prior(&self) -> &Prior {
        &self.prior
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Number of completed rounds; (round, particle) names an evaluation for ever.
    #[must_use]
    pub fn round(&self) -> u64 {
        self.round
    }

    /// This round's proposals, by ascending particle, told or not.
    ///
    /// Those outside the prior's support are rejected at once and never listed. Empty only when the sampler has
    /// finished or failed.
    #[must_use]
    pub fn pending(&self) -> &[Proposal] {
        &self.pending
    }

    /// Whether a pending particle has been told.
    #[must_use]
    pub fn is_told(&self, particle: usize) -> bool {
        self.slot(particle)
            .is_some_and(|slot| self.answers[slot].is_some())
    }

    /// The finished stages.
    #[must_use]
    pub fn stages(&self) -> &[StageRecord] {
        &self.stages
    }

    /// The prior draws with their log-likelihoods, once round 0 is complete.
    #[must_use]
    pub fn prior_draws(&self) -> &[Particle] {
        &self.prior_draws
    }

    /// The result, once finished.
    #[must_use]
    pub fn posterior(&self) -> Option<&Posterior> {
        self.posterior.as_ref()
    }

    /// Why the sampler failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<Failure> {
        if let Phase::Failed(failure) = self.phase {
            Some(failure)
        } else {
            None
        }
    }

    /// Log-likelihoods told so far in completed rounds.
    #[must_use]
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Those of them that were impossible.
    #[must_use]
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    /// The stage in progress, for display; the last stage once finished.
    #[must_use]
    pub fn current(&self) -> Current {
        let (told, proposals) = (self.pending.len() - self.missing, self.pending.len());
        let mut current = Current {
            stage: 0,
            tempering_exponent: 0.0,
            step: 0,
            most_steps: 1,
            acceptance: None,
            told,
            proposals,
        };
        if let Phase::Moving(stage) = &self.phase {
            current.stage = stage.index;
            current.tempering_exponent = stage.exponent;
            current.step = stage.step;
            current.most_steps = stage.chains.iter().map(|chain| chain.length).max().unwrap_or(0);
            current.acceptance = stage.acceptance();
        } else if let Some(last) = self.stages.last() {
            current.stage = last.stage;
            current.tempering_exponent = last.tempering_exponent;
            current.step = last.steps;
            current.most_steps = last.steps;
            current.acceptance = Some(last.acceptance);
        }
        current
    }

    /// Takes the log-likelihood of a pending particle; the last one of a round advances the sampler.
    ///
    /// # Errors
    /// [`TellError::AlreadyTold`] and [`TellError::NotPending`]; the sampler is then unchanged.
    pub fn tell(&mut self, particle: usize, value: LogLikelihood) -> Result<Progress, TellError> {
        let round = self.round;
        let slot = self
            .slot(particle)
            .ok_or(TellError::NotPending { round, particle })?;
        if self.answers[slot].is_some() {
            return Err(TellError::AlreadyTold { round, particle });
        }
        self.answers[slot] = Some(value);
        self.missing -= 1;
        Ok(if self.missing > 0 {
            Progress::Waiting
        } else {
            self.advance()
        })
    }

    /// Position of a particle among the pending proposals.
    fn slot(&self, particle: usize) -> Option<usize> {
        self.pending
            .binary_search_by_key(&particle, |proposal| proposal.particle)
            .ok()
    }

    /// Lists proposals.
    fn ask(&mut self, proposals: Vec<Proposal>) {
        self.missing = proposals.len();
        self.answers = vec![None; proposals.len()];
        self.pending = proposals;
    }

    /// Completes rounds until proposals are pending or the sampler has ended.
    fn advance(&mut self) -> Progress {
        let stages = self.stages.len();
        loop {
            let answers: Vec<LogLikelihood> = self.answers.drain(..).flatten().collect();
            self.round += 1;
            self.evaluations += answers.len() as u64;
            self.rejected += answers.iter().filter(|answer| answer.is_impossible()).count() as u64;
            let proposals = std::mem::take(&mut self.pending);
            let next = match std::mem::replace(&mut self.phase, Phase::Done) {
                Phase::Prior => self.finish_prior(&proposals, &answers),
                Phase::Moving(mut stage) => {
                    stage.accept(&answers);
                    self.after_step(stage)
                }
                ended @ (Phase::Done | Phase::Failed(_)) => Ok(ended),
            };
            self.phase = next.unwrap_or_else(Phase::Failed);
            match &mut self.phase {
                Phase::Moving(stage) => {
                    let proposals = stage.propose(&self.prior, self.settings.seed);
                    self.ask(proposals);
                }
                Phase::Failed(failure) => return Progress::Failed(*failure),
                Phase::Prior | Phase::Done => return Progress::Finished,
            }
            if !self.pending.is_empty() {
                return if self.stages.len() > stages {
                    Progress::StageFinished
                } else {
                    Progress::NextRound
                };
            }
        }
    }

    /// Turns the prior draws into the first stage; draws that the model rejected are dropped, and the evidence
    /// multiplied by the surviving fraction.
    fn finish_prior(&mut self, proposals: &[Proposal], answers: &[LogLikelihood]) -> Result<Phase, Failure> {
        let mut pool = Pool::default();
        for (proposal, &log_likelihood) in proposals.iter().zip(answers) {
            let theta = proposal.theta.clone();
            let log_prior = self.prior.log_density(&theta);
            self.prior_draws.push(Particle {
                theta,
                log_likelihood,
                log_prior,
            });
            if !log_likelihood.is_impossible() {
                let coordinates = self.prior.coordinates(&proposal.theta);
                let log_prior = self.prior.log_density_of_coordinates(&coordinates);
                pool.push(
                    pool.states.len(),
                    State {
                        coordinates,
                        log_prior,
                        log_likelihood,
                    },
                );
            }
        }
        let (possible, draws, needed) = (pool.states.len(), answers.len(), self.prior.dimension() + 2);
        if possible == 0 {
            return Err(Failure::AllImpossible { draws });
        }
        if possible < needed {
            return Err(Failure::TooFewPossible {
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
    ) -> Result<Phase, Failure> {
        let Transition { stage, weights, step } =
            Transition::new(pool, index, exponent, scale, &self.settings)?;
        self.passage = Passage {
            step,
            weight_cov: weights.cov,
            log_evidence,
        };
        Ok(Phase::Moving(Box::new(stage)))
    }

    /// Goes on with a stage, or ends it and starts the next or the posterior.
    fn after_step(&mut self, stage: Box<Stage>) -> Result<Phase, Failure> {
        let [least, _] = self.settings.moves;
        let mut drift = None;
        if self.settings.algorithm == Algorithm::Tmcmc
            && stage.step >= least
            && (stage.step - least).is_multiple_of(BLOCK)
        {
            drift = Some(Drift::of(&stage.chains, self.passage.step)).filter(|drift| drift.is_settled());
        }
        if drift.is_none() && !stage.is_exhausted() {
            return Ok(Phase::Moving(stage));
        }
        let drift = drift.unwrap_or_else(|| Drift::of(&stage.chains, self.passage.step));
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
        self.posterior = Some(Posterior {
            particles: self
                .stages
                .last()
                .map(|last| last.population.clone())
                .unwrap_or_default(),
            log_evidence: self.evidence.log,
            log_evidence_se: self.evidence.standard_error(),
            equilibrated: self.stages.iter().all(|stage| stage.equilibrated),
            evaluations: self.evaluations,
            rejected: self.rejected,
        });
        Ok(Phase::Done)
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
        let (population, moved): (Vec<&State>, bool) = match self.settings.algorithm {
            Algorithm::Tmcmc => (
                stage.chains.iter().map(|chain| &chain.current).collect(),
                drift.correlation < CORRELATION_LIMIT,
            ),
            Algorithm::ChingChen2007 => (stage.pool.states.iter().collect(), true),
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
            equilibrated: moved && !drift.is_alarming(),
            population: population
                .into_iter()
                .map(|state| state.particle(&self.prior))
                .collect(),
        });
    }
}
