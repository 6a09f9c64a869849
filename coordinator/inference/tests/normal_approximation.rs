//! Draws and evidence of the normal approximation against closed forms and quadrature.

use crate::setup::{correlated_pair, end, marginal, normal, uniform};
use inference::lm::{LmFit, LmSettings};
use inference::point_estimate::ModeEstimate;
use statistics::likelihood::{CommonError, CommonErrorSize, ErrorLaw};
use statistics::{Datum, Distribution, ErrorSd, Likelihood, Prior};

fn datum(run: usize, value: f64, sd: f64) -> Datum {
    Datum {
        run,
        channel: 0,
        value,
        sd: ErrorSd::Known(sd),
    }
}

fn fit(prior: Prior, likelihood: Likelihood, model: impl Fn(&[f64]) -> Vec<f64>) -> ModeEstimate {
    let settings = LmSettings {
        draws: 4000,
        ..LmSettings::default()
    };
    let fit = LmFit::new(prior, likelihood, settings).unwrap();
    let ended = end(fit, |theta| Some(model(theta)), |_, _| ());
    ended.estimate().unwrap().clone()
}

fn moments(estimate: &ModeEstimate, parameter: usize) -> (f64, f64) {
    let draws = &estimate.approximation.as_ref().unwrap().draws;
    assert_eq!(draws.len(), 4000);
    let values: Vec<f64> = draws.iter().map(|draw| draw.theta[parameter]).collect();
    inference::diagnostics::mean_and_sd(&values).unwrap()
}

#[track_caller]
fn near(computed: f64, expected: f64, tolerance: f64) {
    assert!(
        (computed - expected).abs() <= tolerance,
        "{computed}, not {expected}"
    );
}

/// A prior N(0, R) and a datum of a + 2 b: the covariance of datum and parameters is C w, its variance w' C w + e^2.
#[test]
fn draws_of_a_linear_model_have_its_closed_form_and_evidence() {
    let (rho, value, sd) = (-0.7, 1.5, 0.4);
    let likelihood = Likelihood::new(vec![datum(0, value, sd)]).unwrap();
    let estimate = fit(correlated_pair(rho), likelihood, |theta| {
        vec![theta[0] + 2.0 * theta[1]]
    });
    let covariance = [1.0 + 2.0 * rho, rho + 2.0];
    let variance = covariance[0] + 2.0 * covariance[1] + sd * sd;
    for (k, covariance_with_datum) in covariance.into_iter().enumerate() {
        let (mean, spread) = moments(&estimate, k);
        near(mean, covariance_with_datum * value / variance, 0.05);
        near(
            spread,
            (1.0 - covariance_with_datum * covariance_with_datum / variance).sqrt(),
            0.05,
        );
    }
    let log_evidence = -0.5 * (2.0 * std::f64::consts::PI * variance).ln() - 0.5 * value * value / variance;
    near(estimate.approximation.unwrap().log_evidence, log_evidence, 1e-6);
}

/// A prior uniform over [0, 1] and a datum two sds below it: the mode is the bound, the density falls from there.
#[test]
fn draws_stay_within_bounds_where_the_mode_is_at_one() {
    let (value, sd) = (-1.0, 0.5);
    let likelihood = Likelihood::new(vec![datum(0, value, sd)]).unwrap();
    let estimate = fit(Prior::new(vec![uniform(0.0, 1.0)]), likelihood, |theta| {
        vec![theta[0]]
    });
    assert!(estimate.at_bound[0]);
    let grid = (0..10_000).map(|k| (f64::from(k) + 0.5) * 1e-4);
    let density =
        |x: f64| (-0.5 * ((x - value) / sd).powi(2)).exp() / (sd * (2.0 * std::f64::consts::PI).sqrt());
    let evidence: f64 = grid.clone().map(density).sum::<f64>() * 1e-4;
    let mean: f64 = grid.map(|x| x * density(x)).sum::<f64>() * 1e-4 / evidence;
    near(moments(&estimate, 0).0, mean, 0.05);
    let approximation = estimate.approximation.unwrap();
    // A flank is not quite a normal's.
    near(approximation.log_evidence, evidence.ln(), 0.4);
    assert!(
        approximation
            .draws
            .iter()
            .all(|draw| (0.0..=1.0).contains(&draw.theta[0]))
    );
}

/// Six groups of four data, each group shifted by an error of its own whose sd is inferred.
#[test]
fn the_sd_of_common_errors_is_inferred_with_the_parameter() {
    let shifts = [0.5, -0.7, 0.2, 0.9, -0.4, -0.3];
    let data: Vec<Datum> = (0..24)
        .map(|i| datum(i, 3.0 + shifts[i / 4] + 0.1 * [1.0, -1.0, 0.5, -0.5][i % 4], 0.1))
        .collect();
    let common = (0..6).map(|group| CommonError {
        data: (4 * group..4 * group + 4).collect(),
        size: CommonErrorSize::Shift(ErrorSd::Inferred { parameter: 1 }),
    });
    let likelihood = Likelihood::with_common(data, ErrorLaw::Gaussian, common.collect(), Vec::new()).unwrap();
    let half_normal = marginal(Distribution::HalfNormal { scale: 1.0 });
    let prior = Prior::new(vec![normal(0.0, 10.0), half_normal]);
    let estimate = fit(prior.clone(), likelihood.clone(), |theta| vec![theta[0]; 24]);
    let (mut evidence, mut mean_sd) = (0.0, 0.0);
    for i in 0..300 {
        for j in 0..300 {
            let theta = [1.5 + 0.01 * (f64::from(i) + 0.5), 0.01 * (f64::from(j) + 0.5)];
            let scored = likelihood.log_likelihood(&[theta[0]; 24], &theta).unwrap();
            let density = (scored.value() + prior.log_density(&theta)).exp() * 1e-4;
            evidence += density;
            mean_sd += density * theta[1];
        }
    }
    let (mean, _) = moments(&estimate, 1);
    // The posterior of a sd has a longer tail than a normal score.
    near(mean, mean_sd / evidence, 0.2);
    near(estimate.approximation.unwrap().log_evidence, evidence.ln(), 0.4);
}
