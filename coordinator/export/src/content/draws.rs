//! Groups of draws: posterior, prior and statistics of the sampler.

use inference::Particle;
use record::StageRow;
use result::FinishedCalibration;

use crate::inference_data::VariableGroup;
use crate::variable::{Values, Variable};

/// Number of chains of a population: its draws are exchangeable.
const CHAINS: usize = 1;

pub(super) fn draw_labels(draws: Vec<i64>) -> Vec<Variable> {
    vec![
        Variable::labels("chain", Values::Whole(vec![0])),
        Variable::labels("draw", Values::Whole(draws)),
    ]
}

pub(super) fn numbers(count: usize) -> Vec<i64> {
    (0_i64..).take(count).collect()
}

fn parameters<'a>(
    name: &str,
    calibration: &FinishedCalibration,
    draws: impl ExactSizeIterator<Item = &'a [f64]> + Clone,
) -> VariableGroup {
    let count = draws.len();
    let parameters = calibration.spec.parameters.iter().enumerate();
    let variable = |(k, parameter): (usize, &job::FreeParameter)| {
        let values = draws.clone().map(|theta| theta[k]).collect();
        let dims = [("chain", CHAINS), ("draw", count)];
        Variable::new(&parameter.name, &dims, &parameter.unit, "", Values::Real(values))
    };
    VariableGroup {
        name: name.to_owned(),
        coords: draw_labels(numbers(count)),
        data_vars: parameters.map(variable).collect(),
    }
}

/// Returns the equally weighted draws of the posterior.
pub(super) fn posterior(calibration: &FinishedCalibration) -> VariableGroup {
    let draws = calibration
        .posterior()
        .iter()
        .map(|sample| sample.theta.as_slice());
    parameters("posterior", calibration, draws)
}

/// Returns the draws from the prior with which the sampler began; none for a normal approximation.
pub(super) fn prior(calibration: &FinishedCalibration) -> VariableGroup {
    let draws = calibration.prior_draws().iter().map(|draw| draw.theta.as_slice());
    parameters("prior", calibration, draws)
}

/// Returns the densities of each draw, and the stages of the sampler.
pub(super) fn sample_stats(calibration: &FinishedCalibration) -> VariableGroup {
    let draws = calibration.posterior();
    let dims = [("chain", CHAINS), ("draw", draws.len())];
    let draw_variable = |name: &str, meaning: &str, value: &dyn Fn(&Particle) -> f64| {
        let values = draws.iter().map(value).collect();
        Variable::new(name, &dims, "", meaning, Values::Real(values))
    };
    let log_likelihood = |draw: &Particle| draw.log_likelihood.value();
    let stages = calibration.stages();
    let along = [("stage", stages.len())];
    let stage_variable = |name: &str, meaning: &str, value: &dyn Fn(&StageRow) -> f64| {
        let values = stages.iter().map(value).collect();
        Variable::new(name, &along, "", meaning, Values::Real(values))
    };
    let meaning = match calibration.approximated() {
        Some(_) => {
            "log-likelihood of the linearised model, which the normal approximation is of; that of the model itself is in the group log_likelihood"
        }
        None => "log-likelihood",
    };
    let evaluations = stages.iter().map(|stage| stage.evaluations.cast_signed());
    let evaluations = Values::Whole(evaluations.collect());
    let mut coords = draw_labels(numbers(draws.len()));
    let stage_numbers = stages.iter().map(|stage| i64::from(stage.stage)).collect();
    coords.push(Variable::labels("stage", Values::Whole(stage_numbers)));
    VariableGroup {
        name: "sample_stats".to_owned(),
        coords,
        data_vars: vec![
            draw_variable(
                "lp",
                "log-density of the posterior, without its constant",
                &|draw| log_likelihood(draw) + draw.log_prior,
            ),
            draw_variable("log_likelihood", meaning, &log_likelihood),
            draw_variable("log_prior", "log-density of the prior", &|draw| draw.log_prior),
            stage_variable("tempering_exponent", "power of the likelihood", &|stage| {
                stage.tempering_exponent
            }),
            stage_variable(
                "acceptance",
                "acceptance rate of the moves; of independent draws, their effective share",
                &|stage| stage.acceptance,
            ),
            stage_variable("ess", "effective sample size of the weights", &|stage| stage.ess),
            stage_variable("log_evidence_increment", "share of the log-evidence", &|stage| {
                stage.log_evidence_increment
            }),
            Variable::new("evaluations", &along, "", "evaluations spent", evaluations),
        ],
    }
}
