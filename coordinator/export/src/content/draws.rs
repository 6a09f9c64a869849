//! Draws of the parameters, and how they came about.

use inference::Particle;
use record::StageRow;
use result::FinishedCalibration;

use crate::inference_data::VariableGroup;
use crate::variable::{Values, Variable};

/// Chains of a population: its draws are exchangeable.
const CHAINS: usize = 1;

/// The labels of chain and draw.
pub(super) fn draw_labels(draws: Vec<i64>) -> Vec<Variable> {
    vec![
        Variable::labels("chain", Values::Whole(vec![0])),
        Variable::labels("draw", Values::Whole(draws)),
    ]
}

/// Numbers from 0.
pub(super) fn numbers(count: usize) -> Vec<i64> {
    (0_i64..).take(count).collect()
}

/// One variable for each parameter.
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

/// The equally weighted draws of the posterior.
pub(super) fn posterior(calibration: &FinishedCalibration) -> VariableGroup {
    let draws = calibration
        .posterior()
        .iter()
        .map(|sample| sample.theta.as_slice());
    parameters("posterior", calibration, draws)
}

/// The draws from the prior that the sampler began with; none of a normal approximation.
pub(super) fn prior(calibration: &FinishedCalibration) -> VariableGroup {
    let draws = calibration.prior_draws().iter().map(|draw| draw.theta.as_slice());
    parameters("prior", calibration, draws)
}

/// The density of each draw, and the stages of the sampler.
pub(super) fn sample_stats(calibration: &FinishedCalibration) -> VariableGroup {
    let draws = calibration.posterior();
    let dims = [("chain", CHAINS), ("draw", draws.len())];
    let of_draw = |name: &str, meaning: &str, value: &dyn Fn(&Particle) -> f64| {
        let values = draws.iter().map(value).collect();
        Variable::new(name, &dims, "", meaning, Values::Real(values))
    };
    let log_likelihood = |draw: &Particle| draw.log_likelihood.value();
    let stages = calibration.stages();
    let along = [("stage", stages.len())];
    let of_stage = |name: &str, meaning: &str, value: &dyn Fn(&StageRow) -> f64| {
        let values = stages.iter().map(value).collect();
        Variable::new(name, &along, "", meaning, Values::Real(values))
    };
    let meaning = match calibration.approximated() {
        Some(_) => {
            "log-likelihood of the linearised model, which the normal approximation is of; that of the model itself is in the group log_likelihood"
        }
        None => "log-likelihood",
    };
    let mut coords = draw_labels(numbers(draws.len()));
    let stage_numbers = stages.iter().map(|stage| i64::from(stage.stage)).collect();
    coords.push(Variable::labels("stage", Values::Whole(stage_numbers)));
    VariableGroup {
        name: "sample_stats".to_owned(),
        coords,
        data_vars: vec![
            of_draw(
                "lp",
                "log-density of the posterior, without its constant",
                &|draw| log_likelihood(draw) + draw.log_prior,
            ),
            of_draw("log_likelihood", meaning, &log_likelihood),
            of_draw("log_prior", "log-density of the prior", &|draw| draw.log_prior),
            of_stage("tempering_exponent", "power of the likelihood", &|stage| {
                stage.tempering_exponent
            }),
            of_stage(
                "acceptance",
                "acceptance rate of the moves; of independent draws, their effective share",
                &|stage| stage.acceptance,
            ),
            of_stage("ess", "effective sample size of the weights", &|stage| stage.ess),
            of_stage("log_evidence_increment", "share of the log-evidence", &|stage| {
                stage.log_evidence_increment
            }),
            Variable::new(
                "evaluations",
                &along,
                "",
                "evaluations spent",
                Values::Whole(
                    stages
                        .iter()
                        .map(|stage| stage.evaluations.cast_signed())
                        .collect(),
                ),
            ),
        ],
    }
}
