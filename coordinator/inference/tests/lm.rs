//! Fits against closed forms, and on models with noise, ridges and rejections.

use crate::setup::{correlated_pair, data, end, lognormal, marginal, normal, uniform};
use inference::lm::{LmFit, LmSettings, LmSettingsError};
use inference::point_estimate::{ModeEstimate, StopReason};
use inference::{InferenceFailure, TellError, TellProgress};
use nalgebra::{DMatrix, DVector};
use statistics::{Distribution, ErrorSd, Likelihood, LikelihoodError, Marginal, Prior};

/// A model: one predicted value for each datum, or none.
type Model<'a> = &'a dyn Fn(&[f64]) -> Option<Vec<f64>>;

fn begin(prior: &[Marginal], likelihood: &Likelihood, settings: LmSettings) -> LmFit {
    LmFit::new(Prior::new(prior.to_vec()), likelihood.clone(), settings).unwrap()
}

fn from_one_start() -> LmSettings {
    LmSettings {
        starts: 1,
        ..LmSettings::default()
    }
}

fn fit(prior: &[Marginal], likelihood: &Likelihood, settings: LmSettings, model: Model) -> ModeEstimate {
    let ended = end(begin(prior, likelihood, settings), model, |_, _| ());
    ended.estimate().unwrap().clone()
}

#[track_caller]
fn near(computed: f64, expected: f64, tolerance: f64) {
    assert!(
        (computed - expected).abs() <= tolerance * expected.abs().max(1.0),
        "{computed}, not {expected}"
    );
}

/// Returns a straight line in three parameters at twelve places.
fn design() -> DMatrix<f64> {
    DMatrix::from_fn(12, 3, |i, k| {
        let x = i as f64 / 6.0 - 1.0;
        [1.0, x, x * x * x - 0.3 * x][k]
    })
}

fn linear(theta: &[f64]) -> Option<Vec<f64>> {
    let values = design() * DVector::from_column_slice(&theta[..3]);
    Some(values.iter().copied().collect())
}

/// Measurements around (2, -1, 0.5), off by a fixed pattern.
fn measured() -> Vec<f64> {
    let clean = linear(&[2.0, -1.0, 0.5]).unwrap();
    clean
        .iter()
        .enumerate()
        .map(|(i, y)| y + 0.2 * libm::sin(2.7 * i as f64 + 1.0))
        .collect()
}

#[test]
fn a_linear_model_with_normal_priors_has_its_closed_form() {
    let (means, sds) = ([1.0, 0.0, 1.0], [2.0, 0.5, 3.0]);
    let prior: Vec<Marginal> = means.iter().zip(sds).map(|(&m, s)| normal(m, s)).collect();
    let sd = |i: usize| 0.1 + 0.02 * i as f64;
    let likelihood = data(&measured(), |i| ErrorSd::Known(sd(i)));
    let estimate = fit(&prior, &likelihood, LmSettings::default(), &linear);

    // Precision P = A' W A + S^-2, mean P^-1 (A' W y + S^-2 m).
    let a = design();
    let weights = DMatrix::from_fn(12, 12, |i, j| if i == j { 1.0 / (sd(i) * sd(i)) } else { 0.0 });
    let prior_precision = DMatrix::from_fn(3, 3, |i, j| if i == j { 1.0 / (sds[i] * sds[i]) } else { 0.0 });
    let precision = a.transpose() * &weights * &a + &prior_precision;
    let right = a.transpose() * &weights * DVector::from_vec(measured())
        + &prior_precision * DVector::from_column_slice(&means);
    let covariance = precision.try_inverse().unwrap();
    let mean = &covariance * right;
    for i in 0..3 {
        near(estimate.theta[i], mean[i], 1e-8);
        near(estimate.sd(i).unwrap() / covariance[(i, i)].sqrt(), 1.0, 1e-8);
        for j in 0..3 {
            near(
                estimate.laplace.as_ref().unwrap().covariance[i][j] / covariance[(i, j)],
                1.0,
                1e-8,
            );
        }
    }
    assert_eq!(
        (estimate.stop, estimate.at_bound.as_slice()),
        (StopReason::Decrease, &[false; 3][..])
    );
    // Starts, differences, steps, differences at the optimum, and to both sides of it.
    assert_eq!(estimate.evaluations, 5 + 3 + 4 + 3 + 6);
    let expected = Prior::new(prior).log_density(&estimate.theta);
    near(estimate.log_prior, expected, 1e-12);
    near(
        estimate.log_likelihood,
        likelihood
            .log_likelihood(&linear(&estimate.theta).unwrap(), &estimate.theta)
            .unwrap()
            .value(),
        1e-12,
    );
}

#[test]
fn a_curved_valley_is_followed_to_its_end() {
    // Rosenbrock's valley as residuals: 10 (y - x^2) and 1 - x, from the far side of its bend.
    let likelihood = data(&[0.0, 1.0], |_| ErrorSd::Known(1.0));
    let model = |theta: &[f64]| Some(vec![10.0 * (theta[1] - theta[0] * theta[0]), theta[0]]);
    let prior = [uniform(-4.4, 2.0), uniform(-2.0, 4.0)];
    let estimate = fit(&prior, &likelihood, from_one_start(), &model);
    assert_eq!(estimate.stop, StopReason::Decrease);
    near(estimate.theta[0], 1.0, 1e-3);
    near(estimate.theta[1], 1.0, 2e-3);
    // J = [[-20, 10], [1, 0]]: variances 1 and 4.01.
    near(estimate.sd(0).unwrap(), 1.0, 1e-2);
    near(estimate.sd(1).unwrap(), 4.01_f64.sqrt(), 1e-2);
    assert!(estimate.evaluations <= 120, "{}", estimate.evaluations);
}

#[test]
fn a_parameter_at_its_bound_is_reported_and_the_others_make_the_best_of_it() {
    // The data want -1 for the second parameter, the prior ends at -0.5.
    let prior = [normal(0.0, 10.0), uniform(-0.5, 3.0), normal(0.0, 10.0)];
    let likelihood = data(&measured(), |_| ErrorSd::Known(0.1));
    let estimate = fit(&prior, &likelihood, LmSettings::default(), &linear);
    assert_eq!(estimate.theta[1].to_bits(), (-0.5_f64).to_bits());
    assert_eq!(estimate.at_bound, [false, true, false]);
    assert_eq!(estimate.sd(1), None);
    // With the second parameter at -0.5 the other two have the closed form.
    let a = design();
    let two = DMatrix::from_fn(12, 2, |i, k| a[(i, 2 * k)]);
    let rest = DVector::from_vec(measured()) + 0.5 * a.column(1);
    let precision = two.transpose() * &two * 100.0 + DMatrix::identity(2, 2) * 0.01;
    let covariance = precision.try_inverse().unwrap();
    let mean = &covariance * (two.transpose() * rest * 100.0);
    for (k, parameter) in [0, 2].into_iter().enumerate() {
        near(estimate.theta[parameter], mean[k], 1e-8);
        near(
            estimate.sd(parameter).unwrap() / covariance[(k, k)].sqrt(),
            1.0,
            1e-8,
        );
    }
}

#[test]
fn a_bound_in_the_way_of_the_first_steps_is_left_again() {
    // From the far corner the first parabola points over the bound of y; the answer lies inside.
    let likelihood = data(&[0.5, 1.3], |_| ErrorSd::Known(0.01));
    let model = |theta: &[f64]| Some(vec![theta[0] * theta[1], theta[0] + theta[1] * theta[1]]);
    let prior = [uniform(0.0, 4.0), uniform(0.0, 2.0)];
    let estimate = fit(&prior, &likelihood, from_one_start(), &model);
    assert_eq!(estimate.at_bound, [false, false]);
    let values = model(&estimate.theta).unwrap();
    near(values[0], 0.5, 1e-4);
    near(values[1], 1.3, 1e-4);
}

#[test]
fn noise_has_its_closed_form() {
    // Residuals are known once the one model parameter is at the mean: its prior is as good as a fixed value.
    let values = [0.3, -0.8, 1.1, 0.2, -0.5, 0.9, -1.3, 0.4];
    let model = |theta: &[f64]| Some(vec![theta[0]; 8]);
    let count = 8.0;
    let noise = |marginal| {
        let likelihood = data(&values, |_| ErrorSd::Inferred { parameter: 1 });
        fit(
            &[normal(0.0, 1e-7), marginal],
            &likelihood,
            LmSettings::default(),
            &model,
        )
    };
    let squares: f64 = values.iter().map(|v| v * v).sum();
    let flat = noise(uniform(0.0, 5.0));
    near(flat.theta[1], (squares / count).sqrt(), 1e-8);
    // f'' along ln sd is 2 n there.
    near(flat.sd(1).unwrap(), flat.theta[1] / (2.0 * count).sqrt(), 1e-8);
    let log_flat = noise(marginal(Distribution::Loguniform {
        lower: 1e-3,
        upper: 10.0,
    }));
    near(log_flat.theta[1], (squares / (count + 1.0)).sqrt(), 1e-8);
    // n - S/v + v/s^2 = 0 for the variance v.
    let scale = 0.4_f64;
    let half = noise(marginal(Distribution::HalfNormal { scale }));
    let s2 = scale * scale;
    let variance = 0.5 * s2 * (-count + (count * count + 4.0 * squares / s2).sqrt());
    near(half.theta[1], variance.sqrt(), 1e-8);
    // Lognormal: n - S/sd^2 + (ln sd - ln median) / (ln factor)^2 + 1 = 0.
    let sd = noise(lognormal(0.3, 1.5)).theta[1];
    let pull = (libm::log(sd) - libm::log(0.3)) / (libm::log(1.5) * libm::log(1.5));
    near(count - squares / sd / sd + pull + 1.0, 0.0, 1e-8);
    let bounded = Marginal::new(Distribution::Normal { mean: 0.2, sd: 0.1 }, Some([0.1, 0.3]));
    let bounded = noise(bounded.unwrap());
    assert_eq!(
        (bounded.theta[1].to_bits(), bounded.at_bound[1], bounded.sd(1)),
        (0.3_f64.to_bits(), true, None)
    );
}

#[test]
fn model_parameters_and_noise_are_fitted_together() {
    // With a flat prior on the noise, the joint optimum has least squares and sd^2 = S / n.
    let prior = [
        uniform(-10.0, 10.0),
        uniform(-10.0, 10.0),
        uniform(-10.0, 10.0),
        uniform(0.0, 5.0),
    ];
    let likelihood = data(&measured(), |_| ErrorSd::Inferred { parameter: 3 });
    let estimate = fit(&prior, &likelihood, LmSettings::default(), &linear);
    let a = design();
    let inverse = (a.transpose() * &a).try_inverse().unwrap();
    let solution = &inverse * a.transpose() * DVector::from_vec(measured());
    let residuals = DVector::from_vec(measured()) - &a * &solution;
    let variance = residuals.norm_squared() / 12.0;
    near(estimate.theta[3], variance.sqrt(), 1e-8);
    for i in 0..3 {
        near(estimate.theta[i], solution[i], 1e-8);
        near(estimate.sd(i).unwrap(), (variance * inverse[(i, i)]).sqrt(), 1e-8);
    }
}

/// Noise of a grid: differs from one parameter vector to the next, and is the same when asked again.
fn grid_noise(theta: &[f64], i: usize) -> f64 {
    let bits = theta.iter().fold(i as u64 + 1, |hash, x| {
        (hash ^ x.to_bits())
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
            .rotate_left(29)
    });
    (bits >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
}

/// Returns three forces of a wheel-like curve at eight slips, without noise.
fn wheel(theta: &[f64]) -> Vec<f64> {
    let (stiffness, exponent, friction) = (theta[0], theta[1], theta[2]);
    (0..24)
        .map(|i| {
            let slip = f64::from(i / 3) / 8.0 + 0.05;
            let sinkage = libm::exp((4.0 - stiffness) / exponent);
            match i % 3 {
                0 => 100.0 * libm::tan(friction) * (1.0 - libm::exp(-8.0 * slip)) - 30.0 * sinkage,
                1 => 20.0 * libm::tan(friction) * (1.0 - libm::exp(-8.0 * slip)) + 4.0 * slip,
                _ => 20.0 * sinkage * (1.0 + 0.5 * slip),
            }
        })
        .collect()
}

#[test]
fn a_model_with_the_noise_of_a_grid_is_fitted_within_its_uncertainty() {
    let truth = [4.6, 1.1, 0.5];
    let prior = [uniform(4.0, 5.6), normal(1.1, 0.2), normal(0.55, 0.1)];
    let clean = wheel(&truth);
    let sd = |i: usize| ErrorSd::Known([1.0, 0.2, 0.4][i % 3]);
    let values: Vec<f64> = (0..24)
        .map(|i| {
            let ErrorSd::Known(sd) = sd(i) else {
                panic!("known")
            };
            clean[i] + sd * libm::sin(1.9 * i as f64)
        })
        .collect();
    let likelihood = data(&values, sd);
    let smooth = fit(&prior, &likelihood, LmSettings::default(), &|theta| {
        Some(wheel(theta))
    });
    assert_eq!(smooth.stop, StopReason::Decrease);
    let score = |theta: &[f64]| {
        let likely = likelihood.log_likelihood(&wheel(theta), theta).unwrap().value();
        likely + Prior::new(prior.to_vec()).log_density(theta)
    };
    // Along the ridge of stiffness and exponent the noise of 0.3 % looks like information over short steps. It makes
    // the log-posterior itself uncertain by some 0.3 nats; nothing that compares points can do better.
    for (share, loss, min_sd) in [(0.001, 0.2, 0.8), (0.003, 0.8, 0.4)] {
        let noisy = |theta: &[f64]| {
            let values = wheel(theta).into_iter().enumerate();
            Some(
                values
                    .map(|(i, v)| v * (1.0 + share * grid_noise(theta, i)))
                    .collect(),
            )
        };
        for seed in 3..=8 {
            let settings = LmSettings {
                seed,
                ..LmSettings::default()
            };
            let estimate = fit(&prior, &likelihood, settings, &noisy);
            let lost = score(&smooth.theta) - score(&estimate.theta);
            assert!(lost < loss, "{share}, seed {seed}: {lost} nats");
            for i in 0..3 {
                let ratio = estimate.sd(i).unwrap() / smooth.sd(i).unwrap();
                assert!(
                    (min_sd..1.3).contains(&ratio),
                    "{share}, seed {seed}, {i}: sd {ratio}"
                );
            }
            assert!(estimate.evaluations <= 200);
        }
    }
}

#[test]
fn rejections_around_the_start_turn_differences_round_and_shorten_steps() {
    let likelihood = data(&measured(), |_| ErrorSd::Known(0.1));
    let prior = [uniform(-3.0, 5.0), uniform(-4.0, 4.0), uniform(-3.0, 5.0)];
    // The prior mean is (1, 0, 1): right behind it on the first axis the model refuses; so it does further down the
    // second, where whole steps would lead, and close to the mean on both sides of the third.
    let wall = |theta: &[f64]| {
        let refused = (theta[0] > 1.0 && theta[0] < 1.2)
            || theta[1] < -1.2
            || ((theta[2] - 1.0).abs() > 0.02 && (theta[2] - 1.0).abs() < 0.1);
        (!refused).then(|| linear(theta)).flatten()
    };
    let free = fit(&prior, &likelihood, LmSettings::default(), &linear);
    let estimate = fit(&prior, &likelihood, from_one_start(), &wall);
    assert!(estimate.rejected >= 3, "{estimate:?}");
    for i in 0..3 {
        near(estimate.theta[i], free.theta[i], 1e-6);
    }
}

#[test]
fn a_fit_walled_in_on_one_axis_holds_it() {
    let likelihood = data(&measured(), |_| ErrorSd::Known(0.1));
    let prior = [uniform(-3.0, 5.0), uniform(-4.0, 4.0), uniform(-3.0, 5.0)];
    let slit = |theta: &[f64]| ((theta[1]).abs() < 1e-6).then(|| linear(theta)).flatten();
    let estimate = fit(&prior, &likelihood, from_one_start(), &slit);
    assert!(estimate.theta[1].abs() < 1e-6);
    assert_eq!(estimate.sd(1), None);
    assert!(estimate.sd(0).is_some() && estimate.sd(2).is_some());
}

#[test]
fn a_model_that_refuses_everything_fails_with_half_of_the_budget() {
    let likelihood = data(&[1.0], |_| ErrorSd::Known(0.1));
    let ended = end(
        begin(&[uniform(0.0, 1.0)], &likelihood, LmSettings::default()),
        |_| None,
        |_, _| (),
    );
    assert_eq!(
        ended.failure(),
        Some(InferenceFailure::AllImpossible { draws: 100 })
    );
    assert_eq!((ended.estimate(), ended.count().rejected), (None, 100));
}

#[test]
fn the_order_within_a_round_does_not_matter() {
    let prior = [
        uniform(4.0, 5.6),
        normal(1.1, 0.2),
        normal(0.55, 0.1),
        lognormal(1.0, 3.0),
    ];
    let values = wheel(&[4.9, 1.0, 0.6]);
    let likelihood = data(&values, |i| match i % 3 {
        0 => ErrorSd::Inferred { parameter: 3 },
        _ => ErrorSd::Known(0.1),
    });
    let model = |theta: &[f64]| {
        let values = wheel(theta).into_iter().enumerate();
        let noisy = values
            .map(|(i, v)| v * (1.0 + 0.003 * grid_noise(theta, i)))
            .collect();
        (theta[1] > 0.7).then_some(noisy)
    };
    let run = |order: &dyn Fn(u64, &mut Vec<usize>)| {
        let fit = end(begin(&prior, &likelihood, LmSettings::default()), model, order);
        format!("{:?}", fit.estimate().unwrap())
    };
    let forwards = run(&|_, _| ());
    assert_eq!(run(&|_, indices| indices.reverse()), forwards);
    assert_eq!(
        run(&|round, indices| {
            let by = round as usize % indices.len();
            indices.rotate_left(by);
        }),
        forwards
    );
    // Another seed starts elsewhere.
    let settings = LmSettings {
        seed: 2,
        ..LmSettings::default()
    };
    assert_ne!(
        begin(&prior, &likelihood, settings).round().pending(),
        begin(&prior, &likelihood, LmSettings::default())
            .round()
            .pending()
    );
}

#[test]
fn the_budget_is_never_exceeded_and_says_so() {
    let prior = [uniform(-4.4, 2.0), uniform(-2.0, 4.0)];
    let likelihood = data(&[0.0, 1.0], |_| ErrorSd::Known(1.0));
    let model = |theta: &[f64]| Some(vec![10.0 * (theta[1] - theta[0] * theta[0]), theta[0]]);
    for max_evaluations in 4..40 {
        let settings = LmSettings {
            max_evaluations,
            ..from_one_start()
        };
        let estimate = fit(&prior, &likelihood, settings, &model);
        assert!(estimate.evaluations <= max_evaluations as u64);
        assert_eq!(estimate.stop, StopReason::Budget, "{max_evaluations}");
        // Differences were affordable, so there is an uncertainty.
        assert!((0..2).all(|k| estimate.sd(k).is_some()));
    }
}

#[test]
fn what_fits_no_datum_is_refused_and_changes_nothing() {
    let likelihood = data(&[1.0, 2.0], |_| ErrorSd::Known(0.1));
    let mut fit = begin(&[uniform(0.0, 1.0)], &likelihood, LmSettings::default());
    assert_eq!(
        fit.tell(0, Some(&[1.0])),
        Err(TellError::Length {
            expected: 2,
            given: 1
        })
    );
    let refused = fit.tell(0, Some(&[1.0, f64::INFINITY]));
    assert_eq!(
        refused,
        Err(LikelihoodError::Prediction {
            run: 1,
            channel: 0,
            value: f64::INFINITY
        }
        .into())
    );
    assert!(!fit.round().is_told(0));
    assert_eq!(fit.tell(0, None), Ok(TellProgress::Waiting));
    assert_eq!(
        fit.tell(0, None),
        Err(TellError::AlreadyTold {
            round: 0,
            particle: 0
        })
    );
    assert_eq!(
        fit.tell(9, None),
        Err(TellError::NotPending {
            round: 0,
            particle: 9
        })
    );
}

#[test]
fn settings_that_cannot_work_are_refused() {
    let ok = LmSettings::default();
    let starts = LmSettings { starts: 0, ..ok };
    let budget = |max_evaluations| LmSettings {
        max_evaluations,
        ..ok
    };
    let too_few = LmSettingsError::TooFewEvaluations {
        max_evaluations: 13,
        min: 14,
        starts: 5,
        dimension: 8,
    };
    for (settings, dimension, expected) in [
        (ok, 0, Err(LmSettingsError::NoParameters)),
        (starts, 2, Err(LmSettingsError::NoStart)),
        (budget(13), 8, Err(too_few)),
        (budget(14), 8, Ok(())),
    ] {
        assert_eq!(settings.check(dimension), expected);
    }
    for difference_step in [0.0, -0.1, 0.6, f64::NAN] {
        let checked = LmSettings {
            difference_step,
            ..ok
        }
        .check(2);
        assert!(matches!(checked, Err(LmSettingsError::DifferenceStep { .. })));
    }
}

/// A prior N(0, R) and a datum of a + 2 b: the most probable point is C w d / (w' C w + e^2), the covariance C - C w w' C / (w' C
/// w + e^2).
#[test]
fn a_correlated_prior_counts_as_on_paper() {
    let (rho, datum, sd) = (-0.7, 1.5, 0.4);
    let likelihood = data(&[datum], |_| ErrorSd::Known(sd));
    let settings = LmSettings {
        starts: 2,
        ..LmSettings::default()
    };
    let begun = LmFit::new(correlated_pair(rho), likelihood, settings).unwrap();
    let ended = end(
        begun,
        |theta: &[f64]| Some(vec![theta[0] + 2.0 * theta[1]]),
        |_, _| (),
    );
    let estimate = ended.estimate().unwrap();
    let covariance = [1.0 + 2.0 * rho, rho + 2.0];
    let variance = covariance[0] + 2.0 * covariance[1] + sd * sd;
    for (k, covariance_with_datum) in covariance.into_iter().enumerate() {
        near(estimate.theta[k], covariance_with_datum * datum / variance, 1e-6);
        near(
            estimate.sd(k).unwrap(),
            (1.0 - covariance_with_datum * covariance_with_datum / variance).sqrt(),
            1e-4,
        );
    }
}
