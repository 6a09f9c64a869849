//! A calibration on the thread of the caller, as predictions take it.

use std::sync::OnceLock;

use coordinator::embedded::Evaluate;
use farm::calibration::{CalibrationResult, SimulationResult};
use inference::Particle;
use job::{PREDICTION_DRAWS, Spec};
use prediction::{Answers, Question};
use record::{CalibrationRow, Membership, Prediction, Repeats, Role, Verified};
use result::{FinishedCalibration, Outcome, SampledPosterior};

use crate::calibration::calibrate;
use crate::error::StudyError;

/// Calibrates a specification.
pub(super) fn finished(spec: Spec) -> Result<FinishedCalibration, StudyError> {
    let calibration = calibrate(spec.clone())?;
    let Some(CalibrationResult::Posterior(posterior)) = calibration.engine().finding() else {
        return Err("the result of a calibration is not a posterior".into());
    };
    let draws = &posterior.particles;
    let score = |p: &Particle| p.log_likelihood.value() + p.log_prior;
    let best = draws
        .iter()
        .reduce(|a, b| if score(b) > score(a) { b } else { a });
    let best = best.ok_or("the posterior has no draw")?;
    let count = draws.len().min(PREDICTION_DRAWS - 1);
    let even = (0..count).map(|i| draws[i * draws.len() / count].theta.clone());
    let thetas = std::iter::once(best.theta.clone()).chain(even).collect();
    let mut calibration = at(spec, thetas)?;
    calibration.row.log_evidence = Some(posterior.log_evidence);
    calibration.outcome = Outcome::Sampled(sampled(draws.clone()));
    Ok(calibration)
}

/// Makes a calibration whose posterior is a list of parameter vectors, the most probable one first.
pub(super) fn at(spec: Spec, thetas: Vec<Vec<f64>>) -> Result<FinishedCalibration, StudyError> {
    let model = Evaluate::new(&spec.fit_variant)?;
    let prediction = |theta: Vec<f64>| -> Result<Prediction, StudyError> {
        let fit = SimulationResult::new(model.evaluate(spec.model_theta(&theta)))?.0;
        Ok(Prediction {
            theta,
            fit,
            holdout: None,
        })
    };
    let predictions = thetas.into_iter().map(prediction).collect::<Result<_, _>>()?;
    let membership = Membership {
        role: Role::Sample,
        parent: None,
        change: None,
    };
    Ok(FinishedCalibration {
        row: CalibrationRow::finished(1, membership),
        spec,
        experiment: "benchmark".into(),
        outcome: Outcome::Sampled(sampled(Vec::new())),
        emulator: None,
        likeliest_values: None,
        predictions,
        simulated_histories: None,
        rejections: Default::default(),
        faults: Default::default(),
        given_up: 0,
        disputes: Vec::new(),
        verified: Verified::default(),
        repeats: Repeats::default(),
        interpolations: OnceLock::new(),
        comparison: OnceLock::new(),
    })
}

fn sampled(draws: Vec<Particle>) -> SampledPosterior {
    SampledPosterior {
        draws,
        populations: Vec::new(),
        prior_draws: Vec::new(),
        stages: Vec::new(),
    }
}

/// Simulates what a model is asked on this thread.
pub(super) fn simulate(question: &Question) -> Result<Answers, String> {
    let answers = question.variants.iter().map(|variant| {
        let model = Evaluate::new(variant)?;
        let result = |theta: &Vec<f64>| {
            let result = SimulationResult::new(model.evaluate(theta)).map_err(|e| e.to_string())?;
            Ok::<_, String>(result.0)
        };
        question.thetas.iter().map(result).collect()
    });
    answers.collect()
}
