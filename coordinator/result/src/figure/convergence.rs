//! Figure of the convergence of searches and sampler (the source paper's Fig. 5).

use inference::Particle;
use inference::diagnostics;
use job::AlgorithmName;

use super::axis_parameter::AxisParameter;
use crate::finished_calibration::FinishedCalibration;
use crate::point_estimate::{GenerationSummary, generations};

/// Maximum number of points of a population in the figure.
const POINTS: usize = 400;
/// The two parameters in which the source paper shows its samples.
const PAPER: [&str; 2] = ["n", "friction_angle_deg"];

/// Convergence of a search by generations.
#[derive(Debug, Clone, serde::Serialize, utoipa::ToSchema)]
pub struct SearchConvergence {
    /// Name of the algorithm.
    #[schema(value_type = String)]
    pub algorithm: AlgorithmName,
    /// Best and mean log-posterior after every generation, by evaluations.
    pub history: Vec<GenerationSummary>,
}

/// A stage of the sampler.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct StageConvergence {
    /// Number of the stage; 0 is the prior.
    pub stage: u32,
    /// Tempering exponent.
    pub tempering_exponent: f64,
    /// Number of evaluations up to the end of the stage.
    pub evaluations: u64,
    /// Log-likelihoods of the population; null if the model rejected every member.
    pub log_likelihood: Option<LogLikelihoodRange>,
}

/// Quantiles of the log-likelihoods of a population `[nats]`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct LogLikelihoodRange {
    /// 5 % quantile.
    pub q05: f64,
    /// Median.
    pub q50: f64,
    /// 95 % quantile.
    pub q95: f64,
    /// Maximum.
    pub highest: f64,
}

/// The populations of selected stages, in two parameters.
#[derive(Debug, Clone, serde::Serialize, utoipa::ToSchema)]
pub struct Populations {
    /// The two parameters.
    pub parameters: [AxisParameter; 2],
    /// The first, a middle and the last stage; at most 400 evenly selected points of each.
    pub stages: Vec<StagePopulation>,
}

/// The population of a stage.
#[derive(Debug, Clone, serde::Serialize, utoipa::ToSchema)]
pub struct StagePopulation {
    /// Number of the stage; 0 is the prior.
    pub stage: u32,
    /// Tempering exponent.
    pub tempering_exponent: f64,
    /// Values of both parameters.
    pub points: Vec<[f64; 2]>,
}

/// Returns the convergence of a search; `None` for a sample, and for a fit by steps, which keeps no history.
pub(super) fn search(calibration: &FinishedCalibration) -> Option<SearchConvergence> {
    let history = generations(&calibration.estimate()?.history);
    (!history.is_empty()).then(|| SearchConvergence {
        algorithm: calibration.spec.algorithm.algorithm_name(),
        history,
    })
}

/// A population with its stage, its tempering exponent and the evaluations up to its end.
struct Population<'a> {
    stage: u32,
    tempering_exponent: f64,
    evaluations: u64,
    samples: &'a [Particle],
}

/// Returns the populations in order, from the prior (stage 0) to the posterior.
fn all(calibration: &FinishedCalibration) -> Vec<Population<'_>> {
    let Some((prior, later)) = calibration.populations().split_first() else {
        return Vec::new();
    };
    let mut evaluations = prior.len() as u64;
    let mut populations = vec![Population {
        stage: 0,
        tempering_exponent: 0.0,
        evaluations,
        samples: prior,
    }];
    let later = later.iter().map(Vec::as_slice).chain([calibration.posterior()]);
    for (row, samples) in calibration.stages().iter().zip(later) {
        evaluations += row.evaluations;
        populations.push(Population {
            stage: row.stage,
            tempering_exponent: row.tempering_exponent,
            evaluations,
            samples,
        });
    }
    populations
}

/// Returns the convergence of each stage of a sampler.
pub(super) fn stages(calibration: &FinishedCalibration) -> Vec<StageConvergence> {
    let stage = |population: &Population| StageConvergence {
        stage: population.stage,
        tempering_exponent: population.tempering_exponent,
        evaluations: population.evaluations,
        log_likelihood: range(population.samples),
    };
    all(calibration).iter().map(stage).collect()
}

fn range(population: &[Particle]) -> Option<LogLikelihoodRange> {
    let values: Vec<f64> = population
        .iter()
        .map(|p| p.log_likelihood.value())
        .filter(|value| value.is_finite())
        .collect();
    let summary = diagnostics::summary(&values)?;
    Some(LogLikelihoodRange {
        q05: summary.q05,
        q50: summary.q50,
        q95: summary.q95,
        highest: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    })
}

/// Returns the populations of the first, a middle and the last stage, in the source paper's parameters if the job has both.
pub(super) fn populations(calibration: &FinishedCalibration) -> Option<Populations> {
    let free = &calibration.spec.parameters;
    let place = |name: &str| free.iter().position(|p| p.name == name);
    let [x, y] = match PAPER.map(place) {
        [Some(x), Some(y)] => [x, y],
        _ if free.len() > 1 => [0, 1],
        _ => return None,
    };
    let all = all(calibration);
    let last = all.len().checked_sub(1)?;
    let mut shown = vec![0, last / 2, last];
    shown.dedup();
    let stages = shown.into_iter().map(|i| {
        let population = &all[i];
        let every = population.samples.len().div_ceil(POINTS).max(1);
        StagePopulation {
            stage: population.stage,
            tempering_exponent: population.tempering_exponent,
            points: population
                .samples
                .iter()
                .step_by(every)
                .map(|s| [s.theta[x], s.theta[y]])
                .collect(),
        }
    });
    Some(Populations {
        parameters: [(&free[x]).into(), (&free[y]).into()],
        stages: stages.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn evaluations_add_up_and_every_population_has_its_range() {
        let stages = stages(&fixture::calibration());
        let evaluations: Vec<u64> = stages.iter().map(|s| s.evaluations).collect();
        assert_eq!(evaluations, [40, 520, 1000, 1480]);
        let range = stages[0].log_likelihood.unwrap();
        assert!(range.q05 < range.q50 && range.q50 < range.q95 && range.q95 <= range.highest);
    }

    #[test]
    fn a_middle_stage_stands_between_the_first_and_the_last() {
        let mut calibration = fixture::calibration();
        let populations = populations(&calibration).unwrap();
        let stages: Vec<u32> = populations.stages.iter().map(|s| s.stage).collect();
        assert_eq!(stages, [0, 1, 3]);
        assert_eq!(populations.parameters[1].unit, "deg");
        assert!(populations.stages.iter().all(|s| s.points.len() == 40));
        fixture::sampled(&mut calibration).populations.clear();
        assert!(super::populations(&calibration).is_none());
    }
}
