//! The sequence of stages, from the prior draws to the posterior sample.

use super::draws::WeightedSample;
use super::equilibrium::{Drift, is_alarming, pooled_z};
use super::particle::Particle;
use super::pool::{ChainState, Pool};
use super::record::{PosteriorSample, StageRecord};
use super::sampler::{Sampler, SamplerPhase, SamplerRound};
use super::settings::Algorithm;
use super::stage::Stage;
use super::transition::{Passage, Transition};
use crate::phase::RunPhase;
use crate::round::Proposal;
use crate::tell::InferenceFailure;
use statistics::log_likelihood::LogLikelihood;

/// Number of steps between two checks of a stage's equilibrium.
const BLOCK: usize = 5;

impl Sampler {
    /// Turns the prior draws into the first stage; draws that the model rejected are dropped, and the
    /// evidence multiplied by the surviving fraction.
    pub(super) fn finish_prior(
        &mut self,
        proposals: &[Proposal],
        results: Vec<LogLikelihood>,
    ) -> Result<SamplerPhase, InferenceFailure> {
        let draws = results.len();
        let (mut pool, mut sample) = (Pool::default(), WeightedSample::default());
        for (proposal, log_likelihood) in proposals.iter().zip(results) {
            let coordinates = self.prior.coordinates(&proposal.theta);
            let state = ChainState {
                log_prior: self.prior.log_density_of_coordinates(&coordinates),
                coordinates,
                log_likelihood,
            };
            sample.push(state.clone(), 0.0);
            if !log_likelihood.is_impossible() {
                pool.push(pool.states.len(), state);
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
        if self.settings.draws(self.prior.dimension()) {
            return self.begin_drawing(sample, pool);
        }
        let survival = self.evidence.survive(possible, draws);
        self.evidence.add(&pool, Vec::new(), 0.0);
        self.begin_stage(&pool, 1, 0.0, None, survival)
    }

    /// Starts the stage that follows a pool; `log_evidence` is the part of its increment that is known already.
    pub(super) fn begin_stage(
        &mut self,
        pool: &Pool,
        index: usize,
        exponent: f64,
        scale: Option<f64>,
        log_evidence: f64,
    ) -> Result<SamplerPhase, InferenceFailure> {
        let Transition { stage, weights, step } =
            Transition::new(pool, index, exponent, scale, &self.settings)?;
        self.passage = Passage {
            step,
            weight_cov: weights.cov,
            log_evidence,
        };
        Ok(RunPhase::Waiting(SamplerRound::Moves(Box::new(stage))))
    }

    /// Continues a stage, or ends it and starts the next or finishes.
    pub(super) fn after_step(&mut self, stage: Box<Stage>) -> Result<SamplerPhase, InferenceFailure> {
        let [min_moves, _] = self.settings.moves;
        let mut drift = None;
        if self.settings.algorithm == Algorithm::Tmcmc
            && stage.step >= min_moves
            && (stage.step - min_moves).is_multiple_of(BLOCK)
        {
            drift = Some(self.drift(&stage)).filter(|drift| drift.may_end());
        }
        if drift.is_none() && !stage.is_exhausted() {
            return Ok(RunPhase::Waiting(SamplerRound::Moves(stage)));
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
        // The draws of earlier stages only led to this one.
        let moved: Vec<&StageRecord> = self.stages.iter().filter(|stage| stage.scale > 0.0).collect();
        let drift_z = pooled_z(moved.iter().map(|stage| stage.drift_z));
        let weight_drift_z = pooled_z(moved.iter().map(|stage| stage.weight_drift_z));
        Ok(RunPhase::Done(Box::new(PosteriorSample {
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
            evaluations: self.count.evaluations as u64,
            rejected: self.count.rejected as u64,
        })))
    }

    /// Computes the drift of a stage: of its chains from start to end or, in the original sampler and in BASIS, of every particle
    /// from the leader of its chain. The chains have moved if they accepted one step each on average.
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
        Drift::new(&start, &end, &clusters, self.passage.step, moved)
    }

    /// Appends the record of a finished stage.
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
