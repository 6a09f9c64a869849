//! Errors that are autocorrelated along the travel, compared with their kernel.

use nalgebra::{DMatrix, DVector};
use statistics::{
    CommonError, CommonErrorSize, Datum, Discrepancy, ErrorLaw, ErrorSd, Likelihood, LikelihoodError,
};

/// Travel of the four data of one history [m]; the last two stand at one coordinate.
const TRAVEL_M: [f64; 4] = [0.1, 0.25, 0.7, 0.7];
/// Indices of the history among the data; datum 2 belongs to a different run.
const HISTORY: [usize; 4] = [0, 1, 3, 4];
const VALUES: [f64; 5] = [1.0, 1.4, -3.0, 0.6, 0.9];
const NOISE: [f64; 5] = [0.2, 0.3, 0.5, 0.1, 0.25];
const PREDICTED: [f64; 5] = [0.7, 0.9, -2.8, 1.1, 1.0];
/// Theta: an unrelated parameter, the sd, the correlation length [m].
const THETA: [f64; 3] = [9.0, 0.6, 0.4];
const SD: ErrorSd = ErrorSd::Inferred { parameter: 1 };
const LENGTH_M: ErrorSd = ErrorSd::Inferred { parameter: 2 };

fn data() -> Vec<Datum> {
    let datum = |i: usize| Datum {
        run: usize::from(i == 2),
        channel: 0,
        value: VALUES[i],
        sd: ErrorSd::Known(NOISE[i]),
    };
    (0..5).map(datum).collect()
}

fn likelihood(sd: ErrorSd, length_m: ErrorSd) -> Result<Likelihood, LikelihoodError> {
    let errors = CommonError::of_history(&HISTORY, &TRAVEL_M, sd, length_m)?;
    Likelihood::with_common(data(), ErrorLaw::Gaussian, errors, Vec::new())
}

fn inferred() -> Likelihood {
    likelihood(SD, LENGTH_M).unwrap()
}

/// Returns the covariance of all data, from the kernel.
fn covariance() -> DMatrix<f64> {
    let travel_m = |i: usize| HISTORY.iter().position(|&h| h == i).map(|k| TRAVEL_M[k]);
    let [_, sd, length_m] = THETA;
    DMatrix::from_fn(5, 5, |i, j| {
        let noise = if i == j { NOISE[i] * NOISE[i] } else { 0.0 };
        match (travel_m(i), travel_m(j)) {
            (Some(a), Some(b)) => noise + sd * sd * (-(a - b).abs() / length_m).exp(),
            _ => noise,
        }
    })
}

/// Returns the normal density of some data by determinant and inverse.
fn density(members: &[usize], predicted: &[f64]) -> f64 {
    let covariance = covariance();
    let k = members.len();
    let part = DMatrix::from_fn(k, k, |i, j| covariance[(members[i], members[j])]);
    let r = DVector::from_fn(k, |i, _| VALUES[members[i]] - predicted[members[i]]);
    let distance = r.dot(&(part.clone().try_inverse().unwrap() * &r));
    -0.5 * (k as f64 * (2.0 * std::f64::consts::PI).ln() + part.determinant().ln() + distance)
}

#[test]
fn a_history_has_the_density_of_its_kernel() {
    let value = inferred().log_likelihood(&PREDICTED, &THETA).unwrap().value();
    let expected = density(&[0, 1, 2, 3, 4], &PREDICTED);
    assert!((value - expected).abs() < 1e-10, "{value} {expected}");
    let known = likelihood(ErrorSd::Known(THETA[1]), ErrorSd::Known(THETA[2])).unwrap();
    let known = known.log_likelihood(&PREDICTED, &[]).unwrap().value();
    assert!((known - value).abs() < 1e-12, "{known} {value}");
    let variances = inferred().error_variances(&PREDICTED, &THETA).unwrap();
    let densities = inferred().log_densities(&PREDICTED, &THETA).unwrap();
    for i in 0..5 {
        assert!(
            (variances[i] - covariance()[(i, i)]).abs() < 1e-12,
            "{variances:?}"
        );
        assert!(
            (densities[i] - density(&[i], &PREDICTED)).abs() < 1e-12,
            "{densities:?}"
        );
    }
}

/// A history of 70 points with a shift: the block is larger than those that are factored densely.
#[test]
fn a_long_history_has_the_density_of_its_kernel() {
    let count = 70;
    let wave = |i: usize, k: f64| (1.7 * k * (i as f64 + 1.0)).sin();
    let travel_m: Vec<f64> = (0..count / 2).map(|i| 0.05 * i as f64).collect();
    let members: Vec<usize> = (0..count / 2).map(|k| 2 * k).collect();
    let data = (0..count).map(|i| Datum {
        run: 0,
        channel: i % 2,
        value: wave(i, 1.0),
        sd: ErrorSd::Known(0.3),
    });
    let mut errors = CommonError::of_history(&members, &travel_m, SD, LENGTH_M).unwrap();
    errors.push(CommonError {
        data: (0..count).collect(),
        size: CommonErrorSize::Shift(ErrorSd::Known(0.5)),
    });
    assert!(errors.len() < count);
    let likelihood = Likelihood::with_common(data.collect(), ErrorLaw::Gaussian, errors, Vec::new()).unwrap();
    let [_, sd, length_m] = THETA;
    let covariance = DMatrix::from_fn(count, count, |i, j| {
        let noise = if i == j { 0.09 } else { 0.0 };
        let kernel = match i % 2 + j % 2 {
            0 => sd * sd * (-(travel_m[i / 2] - travel_m[j / 2]).abs() / length_m).exp(),
            _ => 0.0,
        };
        noise + kernel + 0.25
    });
    let predicted: Vec<f64> = (0..count).map(|i| 0.5 * wave(i, 3.0)).collect();
    let r = DVector::from_fn(count, |i, _| wave(i, 1.0) - predicted[i]);
    let cholesky = covariance.cholesky().unwrap();
    let distance = r.dot(&cholesky.solve(&r));
    let expected =
        -0.5 * (distance + cholesky.ln_determinant() + count as f64 * (2.0 * std::f64::consts::PI).ln());
    let value = likelihood.log_likelihood(&predicted, &THETA).unwrap().value();
    assert!(
        (value - expected).abs() < 1e-9 * expected.abs(),
        "{value} {expected}"
    );
}

/// A subset without the first point, or without an inner one, keeps the covariance of its data.
#[test]
fn a_subset_of_a_history_has_its_marginal_density() {
    let whole = inferred();
    for kept in [&[1, 2, 3][..], &[0, 3, 4], &[0, 1, 4], &[2, 4], &[0, 1, 2, 3, 4]] {
        let (part, places) = whole.subset(kept).unwrap();
        assert_eq!(places, kept);
        let predicted: Vec<f64> = places.iter().map(|&place| PREDICTED[place]).collect();
        let value = part.log_likelihood(&predicted, &THETA).unwrap().value();
        let expected = density(kept, &PREDICTED);
        assert!((value - expected).abs() < 1e-10, "{kept:?}: {value} {expected}");
    }
    let (once, _) = whole.subset(&[1, 2, 3, 4]).unwrap();
    let (twice, _) = once.subset(&[1, 3]).unwrap();
    let value = twice
        .log_likelihood(&[PREDICTED[2], PREDICTED[4]], &THETA)
        .unwrap();
    assert!((value.value() - density(&[2, 4], &PREDICTED)).abs() < 1e-10);
    assert_eq!(whole.subset(&[0, 1, 2, 3, 4]).unwrap().0, whole);
}

#[test]
fn a_whitened_slope_of_a_history_is_that_of_its_density() {
    let direction = [0.3, -0.2, 0.5, 0.1, -0.4];
    let at = |t: f64| {
        let moved = PREDICTED.iter().zip(direction).map(|(value, d)| value + t * d);
        density(&[0, 1, 2, 3, 4], &moved.collect::<Vec<f64>>())
    };
    let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
    let whitening = inferred().whitening(&PREDICTED, &THETA).unwrap();
    let whitened = whitening.slope(&whitening.apply(&direction));
    assert!(
        (whitened - slope).abs() < 1e-6 * slope.abs(),
        "{whitened} {slope}"
    );
    let d = DVector::from_row_slice(&direction);
    let expected = d.dot(&(covariance().try_inverse().unwrap() * &d));
    let applied = whitening.apply(&direction);
    assert!((whitening.curvature(&applied, &applied) - expected).abs() < 1e-9 * expected);
}

#[test]
fn sd_and_correlation_length_are_read_at_their_places_among_the_kept_parameters() {
    let whole = inferred();
    let value = whole.log_likelihood(&PREDICTED, &THETA);
    let swapped = whole.with_parameters(&[2, 1]).unwrap();
    assert_eq!(swapped.log_likelihood(&PREDICTED, &[THETA[2], THETA[1]]), value);
    assert_eq!(whole.with_parameters(&[0, 1, 2]).unwrap(), whole);
    for (kept, parameter) in [([0, 2], 1), ([0, 1], 2)] {
        let refused = whole.with_parameters(&kept);
        assert_eq!(refused, Err(LikelihoodError::DroppedSd { parameter }));
    }
    for (sd, length_m) in [(SD, ErrorSd::Known(0.4)), (ErrorSd::Known(0.6), LENGTH_M)] {
        assert!(likelihood(sd, length_m).unwrap().entangles_unknown_sds());
    }
    let known = likelihood(ErrorSd::Known(0.6), ErrorSd::Known(0.4)).unwrap();
    assert!(!known.entangles_unknown_sds());
}

#[test]
fn numerical_noise_adds_to_the_noise_of_each_datum_of_a_history() {
    let scattered = inferred().with_numerical_noise(&[0.7]).unwrap();
    let variances = scattered.error_variances(&PREDICTED, &THETA).unwrap();
    for (i, variance) in variances.into_iter().enumerate() {
        let expected = covariance()[(i, i)] + 0.49;
        assert!((variance - expected).abs() < 1e-12, "{variance} {expected}");
    }
}

#[test]
fn a_history_without_autocorrelated_error_is_independent() {
    let none = likelihood(ErrorSd::Known(0.0), ErrorSd::Known(0.4)).unwrap();
    let value = none.log_likelihood(&PREDICTED, &[]).unwrap().value();
    let plain = Likelihood::new(data()).unwrap();
    let expected = plain.log_likelihood(&PREDICTED, &[]).unwrap().value();
    assert!((value - expected).abs() < 1e-12, "{value} {expected}");
}

#[test]
fn scales_out_of_bounds_are_refused() {
    let known = ErrorSd::Known;
    for length_m in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let refused = likelihood(known(0.6), known(length_m));
        assert!(
            matches!(refused, Err(LikelihoodError::Setting { .. })),
            "{length_m}"
        );
        let scored = inferred().log_likelihood(&PREDICTED, &[9.0, 0.6, length_m]);
        assert!(
            matches!(scored, Err(LikelihoodError::Setting { .. })),
            "{length_m}"
        );
    }
    for sd in [-0.1, f64::NAN, f64::INFINITY] {
        let refused = likelihood(known(sd), known(0.4));
        assert!(matches!(refused, Err(LikelihoodError::Setting { .. })), "{sd}");
        let scored = inferred().whitening(&PREDICTED, &[9.0, sd, 0.4]);
        assert!(matches!(scored, Err(LikelihoodError::Setting { .. })), "{sd}");
    }
    let message = likelihood(known(0.6), known(-0.1)).unwrap_err().to_string();
    assert_eq!(
        message,
        "correlation length of an autocorrelated error [m] = -0.1 is not a finite number above 0"
    );
    let missing = inferred().log_likelihood(&PREDICTED, &[9.0, 0.6]);
    assert!(matches!(
        missing,
        Err(LikelihoodError::MissingParameter { parameter: 2, .. })
    ));
}

#[test]
fn coordinates_that_are_no_travel_are_refused() {
    for travel_m in [[0.1, 0.05, 0.7, 0.7], [0.1, f64::NAN, 0.7, 0.7]] {
        let refused = CommonError::of_history(&HISTORY, &travel_m, SD, LENGTH_M);
        assert!(matches!(refused, Err(LikelihoodError::Setting { .. })));
    }
    let short = CommonError::of_history(&HISTORY, &TRAVEL_M[1..], SD, LENGTH_M);
    let expected = LikelihoodError::Distances {
        expected: 4,
        given: 3,
    };
    assert_eq!(short, Err(expected));
    let mut errors = CommonError::of_history(&HISTORY, &TRAVEL_M, SD, LENGTH_M).unwrap();
    errors[1].data.pop();
    let refused = Likelihood::with_common(data(), ErrorLaw::Gaussian, errors, vec![Discrepancy::None]);
    assert!(matches!(refused, Err(LikelihoodError::Distances { .. })));
}
