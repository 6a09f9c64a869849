//! The sequence of stages of independent draws, to the posterior sample or to moves.

use super::draws::{
    Anchor, DrawStage, DrawStart, Fit, Forecast, ImportanceWeights, Standing, WeightedSample, next_exponent,
};
use super::evidence::Evidence;
use super::particle::Particle;
use super::pool::Pool;
use super::record::{PosteriorSample, StageRecord};
use super::sampler::{Sampler, SamplerPhase, SamplerRound};
use super::transition::tooth;
use crate::phase::RunPhase;
use crate::tell::InferenceFailure;

/// Absolute z-score of the difference between the last stage's draws and the prediction of the stage before, at and above which the draws
/// are not trusted. Earlier stages only lead to the last one, and raise no alarm. Weights have heavier tails than a normal variable: over
/// 180 runs with right answers the largest is 5.2.
const DISAGREEMENT: f64 = 6.0;

/// Relative difference of two numbers below which they count as equal.
const ROUNDING: f64 = 1e-9;

impl Sampler {
    /// Starts the first stage from the prior draws; `pool` holds those that the model accepted.
    pub(super) fn begin_drawing(
        &mut self,
        sample: WeightedSample,
        pool: Pool,
    ) -> Result<SamplerPhase, InferenceFailure> {
        let survivors = Some([pool.states.len(), sample.states.len()]);
        let anchor = Anchor {
            pool,
            exponent: 0.0,
            log_evidence: 0.0,
            variance: 0.0,
            survivors,
        };
        self.begin_draws(DrawStart {
            index: 1,
            anchor,
            sample,
            fit: None,
        })
    }

    /// Continues a stage of draws, ends it, or resorts to moves.
    pub(super) fn after_draws(
        &mut self,
        mut stage: Box<DrawStage>,
    ) -> Result<SamplerPhase, InferenceFailure> {
        let weights = stage.sample.weights(stage.exponent);
        let particles = self.settings.particles;
        let continues = match (stage.standing(weights.as_ref(), particles), weights) {
            (Standing::Done, Some(weights)) => return self.end_draws(*stage, &weights),
            (Standing::More(count), _) => {
                stage.ask_more(count);
                true
            }
            (Standing::Refit, _) => {
                stage.refit(&self.prior, &self.settings);
                true
            }
            (Standing::Retreat, _) => stage.retreat(&self.prior, &self.settings),
            (Standing::Missed, _) | (Standing::Done, None) => false,
        };
        if continues {
            Ok(RunPhase::Waiting(SamplerRound::Draws(stage)))
        } else {
            self.fall_back(&stage.start, stage.evaluations)
        }
    }

    fn begin_draws(&mut self, start: DrawStart) -> Result<SamplerPhase, InferenceFailure> {
        let components = start.fit.as_ref().map_or(self.settings.components, Fit::size);
        let exponent = next_exponent(&start.sample, start.anchor.exponent, components);
        if exponent <= start.anchor.exponent {
            return self.fall_back(&start, 0);
        }
        match DrawStage::new(start, exponent, &self.prior, &self.settings) {
            Ok(stage) => Ok(RunPhase::Waiting(SamplerRound::Draws(Box::new(stage)))),
            Err(start) => self.fall_back(&start, 0),
        }
    }

    /// Moves the particles of the last stage instead; `evaluations` were spent on draws that missed.
    fn fall_back(&mut self, start: &DrawStart, evaluations: u64) -> Result<SamplerPhase, InferenceFailure> {
        let anchor = &start.anchor;
        let log_evidence = match anchor.survivors {
            Some([survivors, draws]) => self.evidence.survive(survivors, draws),
            None => {
                self.evidence = Evidence::from_estimate(anchor.log_evidence, anchor.variance);
                0.0
            }
        };
        self.evidence.add(&anchor.pool, Vec::new(), 0.0);
        let mut phase = self.begin_stage(&anchor.pool, start.index, anchor.exponent, None, log_evidence)?;
        if let RunPhase::Waiting(SamplerRound::Moves(stage)) = &mut phase {
            stage.evaluations = evaluations;
        }
        Ok(phase)
    }

    /// Records a finished stage of draws; begins the next, or finishes.
    fn end_draws(
        &mut self,
        stage: DrawStage,
        weights: &ImportanceWeights,
    ) -> Result<SamplerPhase, InferenceFailure> {
        let tooth = tooth(self.settings.seed, stage.start.index);
        let pool = stage.sample.resampled(weights, self.settings.particles, tooth);
        let variance = weights.log_mean_variance() + stage.proposal.inside_variance;
        let record = self.record_draws(&stage, weights, &pool);
        self.stages.push(record);
        if stage.exponent < 1.0 {
            let anchor = Anchor {
                pool,
                exponent: stage.exponent,
                log_evidence: weights.log_mean,
                variance,
                survivors: None,
            };
            return self.begin_draws(DrawStart {
                index: stage.start.index + 1,
                anchor,
                sample: stage.sample,
                fit: Some(stage.fit),
            });
        }
        let last = self.stages.last();
        Ok(RunPhase::Done(Box::new(PosteriorSample {
            particles: last.map(|last| last.population.clone()).unwrap_or_default(),
            log_evidence: weights.log_mean,
            log_evidence_se: variance.sqrt(),
            drift_z: last.map_or(0.0, |last| last.drift_z),
            weight_drift_z: last.map_or(0.0, |last| last.weight_drift_z),
            equilibrated: last.is_none_or(|last| last.equilibrated),
            evaluations: self.count.evaluations as u64,
            rejected: self.count.rejected as u64,
        })))
    }

    fn record_draws(&self, stage: &DrawStage, weights: &ImportanceWeights, pool: &Pool) -> StageRecord {
        let Forecast {
            log_likelihood: expected,
            log_evidence,
            log_evidence_variance,
        } = stage.forecast;
        let measured = stage.sample.mean_log_likelihood(weights);
        // Log-likelihoods that are all equal differ by rounding alone.
        let rounding = ROUNDING * (1.0 + measured.mean.abs());
        let z = |change: f64, variance: f64| {
            if change.abs() > rounding && variance > 0.0 {
                change / variance.sqrt()
            } else {
                0.0
            }
        };
        let drift_z = z(
            measured.mean - expected.mean,
            measured.variance + expected.variance,
        );
        let weight_drift_z = z(
            weights.log_mean - log_evidence,
            weights.log_mean_variance() + stage.proposal.inside_variance + log_evidence_variance,
        );
        let worst = drift_z.abs().max(weight_drift_z.abs());
        let equilibrated = stage.exponent < 1.0 || worst < DISAGREEMENT;
        StageRecord {
            stage: stage.start.index,
            tempering_exponent: stage.exponent,
            acceptance: weights.share(),
            drift_z,
            weight_drift_z,
            correlation: 0.0,
            steps: stage.rounds,
            log_evidence_increment: weights.log_mean - stage.start.anchor.log_evidence,
            weight_cov: weights.cov(),
            ess: weights.ess,
            scale: 0.0,
            evaluations: stage.evaluations,
            equilibrated,
            population: pool
                .states
                .iter()
                .map(|state| Particle::new(state, &self.prior))
                .collect(),
        }
    }
}
