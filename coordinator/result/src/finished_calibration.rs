//! A finished calibration with everything that the store kept of it.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use inference::Particle;
use job::Spec;
use record::{
    CalibrationRow, Dispute, EstimateRow, Prediction, PriorDraw, Repeats, StageRow, Subchains, Verified,
};
use shared::outcome::SimulatedHistory;
use statistics::{LogLikelihood, Marginal};

use crate::table::comparison::Comparison;
use crate::table::interpolation::Interpolations;

/// What a calibration ends with.
#[derive(Debug)]
pub enum Outcome {
    /// A sample of the posterior.
    Sampled(SampledPosterior),
    /// Draws of the normal approximation about a fit.
    Approximated {
        /// The most probable parameters.
        mode: EstimateRow,
        /// The equally weighted draws.
        draws: Vec<Particle>,
    },
    /// The most probable parameters alone.
    Estimated(EstimateRow),
}

/// A sample of the posterior, and how the sampler came to it.
#[derive(Debug)]
pub struct SampledPosterior {
    /// The equally weighted draws.
    pub draws: Vec<Particle>,
    /// The draws from the prior, then the populations at the end of the stages before the last.
    pub populations: Vec<Vec<Particle>>,
    /// The draws from the prior with what the model gave there.
    pub prior_draws: Vec<PriorDraw>,
    /// Its stages.
    pub stages: Vec<StageRow>,
    /// Counts of a metamodel; `None` without one.
    pub subchains: Option<Subchains>,
}

impl Outcome {
    /// The outcome by what the store kept.
    ///
    /// # Arguments
    /// - `estimate`: the most probable parameters, of a fit.
    /// - `sampled`: the draws, of a fit those of its normal approximation; with them, what only a sampler leaves.
    pub fn new(estimate: Option<EstimateRow>, sampled: SampledPosterior) -> Self {
        match estimate {
            None => Outcome::Sampled(sampled),
            Some(estimate) if sampled.draws.is_empty() => Outcome::Estimated(estimate),
            Some(mode) => Outcome::Approximated {
                mode,
                draws: sampled.draws,
            },
        }
    }
}

/// A finished calibration.
#[derive(Debug)]
pub struct FinishedCalibration {
    /// Its row in the store.
    pub row: CalibrationRow,
    /// Its specification.
    pub spec: Spec,
    /// Name of its experiment.
    pub experiment: String,
    /// What it ends with.
    pub outcome: Outcome,
    /// The model's values of the fitted measurements at the draw of the highest likelihood.
    pub likeliest_values: Option<Vec<f64>>,
    /// The final draws, simulated on every run; the first is the most probable particle, of a fit the only one.
    pub predictions: Vec<Prediction>,
    /// Simulated history of each fitted run at the likeliest parameters; `None` of a model without time.
    pub simulated_histories: Option<Vec<SimulatedHistory>>,
    /// Number of rejected parameter vectors of the sampler or the fit, by kind.
    pub rejections: BTreeMap<String, u64>,
    /// Number of failed leases by message.
    pub faults: BTreeMap<String, u64>,
    /// Number of evaluations that were given up after faults.
    pub given_up: u64,
    /// Evaluations that were answered in two ways.
    pub disputes: Vec<Dispute>,
    /// How far the results are verified by second workers.
    pub verified: Verified,
    /// How a model that is not ours answered what it was asked twice.
    pub repeats: Repeats,
    /// The held-out measurements as interpolated from the fitted ones, once somebody asks.
    pub interpolations: OnceLock<Interpolations>,
    /// Model against measurement, once somebody asks: the intervals of many runs and draws are dear.
    pub comparison: OnceLock<Comparison>,
}

impl FinishedCalibration {
    /// Names of the effects of its model.
    pub fn effects(&self) -> Vec<String> {
        let effects = &self.spec.fit_variant.effects;
        effects.iter().map(|effect| effect.name.clone()).collect()
    }

    /// The equally weighted draws of the posterior, of a fit those of its normal approximation; empty of a fit without one.
    pub fn posterior(&self) -> &[Particle] {
        match &self.outcome {
            Outcome::Sampled(sampled) => &sampled.draws,
            Outcome::Approximated { draws, .. } => draws,
            Outcome::Estimated(_) => &[],
        }
    }

    /// The point estimate; `None` where there are draws of the posterior.
    pub fn estimate(&self) -> Option<&EstimateRow> {
        match &self.outcome {
            Outcome::Estimated(estimate) => Some(estimate),
            Outcome::Sampled(_) | Outcome::Approximated { .. } => None,
        }
    }

    /// The fit about which the draws are those of a normal approximation.
    pub fn approximated(&self) -> Option<&EstimateRow> {
        match &self.outcome {
            Outcome::Approximated { mode, .. } => Some(mode),
            Outcome::Sampled(_) | Outcome::Estimated(_) => None,
        }
    }

    /// The most probable parameters that a fit found, with draws about them or without.
    pub fn mode(&self) -> Option<&EstimateRow> {
        self.estimate().or(self.approximated())
    }

    fn sampled(&self) -> Option<&SampledPosterior> {
        match &self.outcome {
            Outcome::Sampled(sampled) => Some(sampled),
            Outcome::Approximated { .. } | Outcome::Estimated(_) => None,
        }
    }

    /// The stages of a sampler.
    pub fn stages(&self) -> &[StageRow] {
        self.sampled().map_or(&[], |sampled| &sampled.stages)
    }

    /// The draws from the prior that a sampler began with, then its populations at the end of the stages before the last.
    pub fn populations(&self) -> &[Vec<Particle>] {
        self.sampled().map_or(&[], |sampled| &sampled.populations)
    }

    /// The draws from the prior that a sampler began with.
    pub fn prior_draws(&self) -> &[PriorDraw] {
        self.sampled().map_or(&[], |sampled| &sampled.prior_draws)
    }

    /// Counts of a sampler's metamodel.
    pub fn subchains(&self) -> Option<Subchains> {
        self.sampled()?.subchains
    }

    /// The draw of the highest likelihood; the first of equals.
    pub fn likeliest(&self) -> Option<&Particle> {
        likeliest(self.posterior())
    }

    /// The predictions that results are made from: equally weighted draws, without the most probable particle, which is
    /// no random draw; of a fit, its one point.
    pub fn predictive_draws(&self) -> &[Prediction] {
        let first = usize::from(self.estimate().is_none()).min(self.predictions.len());
        &self.predictions[first..]
    }

    /// The most probable parameters: those that a fit with draws found, else those of the particle of the highest likelihood times
    /// prior, the first of equals.
    pub fn most_probable(&self) -> Option<Particle> {
        if let Some(mode) = self.approximated() {
            return Some(Particle {
                theta: mode.theta.clone(),
                log_likelihood: LogLikelihood::new(mode.log_likelihood).ok()?,
                log_prior: mode.log_prior,
            });
        }
        let score = |p: &Particle| p.log_likelihood.value() + p.log_prior;
        let best = |a, b| if score(b) > score(a) { b } else { a };
        self.posterior().iter().reduce(best).cloned()
    }

    /// The draws of one parameter.
    pub fn draws(&self, parameter: usize) -> Vec<f64> {
        self.posterior().iter().map(|s| s.theta[parameter]).collect()
    }
}

/// The population that a sampler begins with.
pub fn first_population(spec: &Spec, draws: &[PriorDraw]) -> Vec<Particle> {
    let prior = spec.prior();
    let score = |draw: &PriorDraw| {
        let values = draw.result.as_ref().ok()?;
        spec.likelihood.log_likelihood(values, &draw.theta).ok()
    };
    let particle = |draw: &PriorDraw| Particle {
        theta: draw.theta.clone(),
        log_likelihood: score(draw).unwrap_or(LogLikelihood::Impossible),
        log_prior: prior.log_density(&draw.theta),
    };
    draws.iter().map(particle).collect()
}

/// The draw of the highest likelihood; the first of equals.
pub fn likeliest(draws: &[Particle]) -> Option<&Particle> {
    let score = |p: &Particle| p.log_likelihood.value();
    let best = draws
        .iter()
        .reduce(|best, p| if score(p) > score(best) { p } else { best });
    best.filter(|p| !p.log_likelihood.is_impossible())
}

/// The mean of a prior; that of a symmetric one is integrated to zero but for rounding, which is not shown.
pub fn prior_mean(marginal: &Marginal) -> f64 {
    let mean = marginal.mean();
    if mean.abs() < 1e-12 * marginal.sd() {
        0.0
    } else {
        mean
    }
}

#[cfg(test)]
mod tests {
    use statistics::Distribution;

    use super::*;

    #[test]
    fn a_prior_about_zero_has_the_mean_zero() {
        let shown = |mean| prior_mean(&Marginal::new(Distribution::Normal { mean, sd: 0.2 }, None).unwrap());
        assert_eq!(shown(0.0).to_bits(), 0.0_f64.to_bits());
        assert!((shown(1e-6) - 1e-6).abs() < 1e-15);
    }
}
