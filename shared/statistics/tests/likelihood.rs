//! The likelihood, compared with hand-computed numbers.

use nalgebra::{DMatrix, DVector};
use statistics::likelihood::{DISCREPANCY_LEVELS, MAX_DISCREPANCY, MIN_DISCREPANCY, discrepancy_levels};
use statistics::{
    CommonError, CommonErrorSize, Datum, Discrepancy, ErrorLaw, ErrorSd, Likelihood, LikelihoodError,
    LogLikelihood,
};

fn common(data: &[usize], size: CommonErrorSize) -> CommonError {
    let data = data.to_vec();
    CommonError { data, size }
}

fn sensitivity(sd: ErrorSd, derivative: usize) -> CommonErrorSize {
    CommonErrorSize::Sensitivity { sd, derivative }
}

const DISCREPANCY: CommonErrorSize = CommonErrorSize::Discrepancy { group: 0 };

/// Returns a likelihood of normal errors, all of whose data are in one group.
fn normal(data: &[Datum], common: &[CommonError], discrepancy: Discrepancy) -> Likelihood {
    let (data, common) = (data.to_vec(), common.to_vec());
    Likelihood::with_common(data, ErrorLaw::Gaussian, common, vec![discrepancy]).unwrap()
}

fn datum(run: usize, channel: usize, value: f64, sd: ErrorSd) -> Datum {
    Datum {
        run,
        channel,
        value,
        sd,
    }
}

#[test]
fn hand_numbers() {
    let data = vec![
        datum(0, 0, 10.0, ErrorSd::Known(2.0)),
        datum(0, 1, 1.0, ErrorSd::Inferred { parameter: 1 }),
        datum(3, 0, 7.0, ErrorSd::Known(2.0)),
    ];
    let likelihood = Likelihood::new(data).unwrap();
    // Residuals in sd: (10 - 8) / 2 = 1, (1 - 0.5) / 0.25 = 2, (7 - 7) / 2 = 0.
    let value = likelihood
        .log_likelihood(&[8.0, 0.5, 7.0], &[9.0, 0.25])
        .unwrap()
        .value();
    let expected = -1.5 * (2.0 * std::f64::consts::PI).ln() - 2.0 * 2.0_f64.ln() - 0.25_f64.ln() - 2.5;
    assert!((value - expected).abs() < 1e-12, "{value} {expected}");
}

/// With the normalisation, the best sd of residuals 1 and -1 is 1.
#[test]
fn the_best_noise_is_the_residuals_rms() {
    let noise = ErrorSd::Inferred { parameter: 0 };
    let likelihood = Likelihood::new(vec![datum(0, 0, 1.0, noise), datum(1, 0, -1.0, noise)]).unwrap();
    let value = |sd: f64| likelihood.log_likelihood(&[0.0, 0.0], &[sd]).unwrap().value();
    assert!(value(1.0) > value(0.9) && value(1.0) > value(1.1) && value(1.0) > value(100.0));
}

#[test]
fn values_that_are_not_numbers_are_refused() {
    assert!(Likelihood::new(vec![datum(0, 0, f64::NAN, ErrorSd::Known(1.0))]).is_err());
    assert!(Likelihood::new(vec![datum(0, 0, 1.0, ErrorSd::Known(0.0))]).is_err());
    let likelihood = Likelihood::new(vec![datum(2, 1, 1.0, ErrorSd::Inferred { parameter: 0 })]).unwrap();
    let error = likelihood.log_likelihood(&[f64::NAN], &[1.0]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "prediction NaN of run 2, channel 1 is not finite"
    );
    let missing = likelihood.log_likelihood(&[0.0], &[]);
    assert!(matches!(missing, Err(LikelihoodError::MissingParameter { .. })));
    let negative = likelihood.log_likelihood(&[0.0], &[-1.0]);
    assert!(matches!(negative, Err(LikelihoodError::Noise { .. })));
    let far = likelihood.log_likelihood(&[1e300], &[1e-10]);
    assert_eq!(far, Ok(LogLikelihood::Impossible));
}

const T5: ErrorLaw = ErrorLaw::StudentT {
    degrees_of_freedom: 5.0,
};

/// The declared sd is the scale: f(0) of t with 5 degrees of freedom is 8 / (3 sqrt(5) pi) over the scale.
#[test]
fn a_t_of_one_datum_has_its_hand_number() {
    let data = [0, 1].map(|run| datum(run, 0, 1.0, ErrorSd::Known(2.0))).to_vec();
    let likelihood = Likelihood::with_common(data, T5, Vec::new(), vec![Discrepancy::None]).unwrap();
    let value = |m: f64| likelihood.log_likelihood(&[m, 1.0], &[]).unwrap().value();
    let centre = (8.0 / (3.0 * 5.0_f64.sqrt() * std::f64::consts::PI) / 2.0).ln();
    assert!((value(1.0) - 2.0 * centre).abs() < 1e-12);
    // A residual of three scales: (1 + 9/5)^-3.
    assert!((value(7.0) - 2.0 * centre + 3.0 * 2.8_f64.ln()).abs() < 1e-12);
}

/// Returns three runs of two channels: runs 0 and 1 repeat a condition, run 2 has a different one.
///
/// Data: channel 0 of every run, then channel 1 of every run. Each run has a sensitivity, each (condition, channel) a discrepancy.
fn three_runs(scatter: ErrorSd) -> (Vec<Datum>, Vec<CommonError>) {
    let sds = [0.5, 0.7, 0.5, 0.1, 0.1, 0.2];
    let values = [10.0, 11.0, 7.0, 1.0, 1.3, 0.8];
    let data = (0..6).map(|i| datum(i % 3, i / 3, values[i], ErrorSd::Known(sds[i])));
    let runs = (0..3).map(|run| common(&[run, run + 3], sensitivity(scatter, 0)));
    let conditions = [&[0, 1][..], &[2], &[3, 4], &[5]].map(|members| common(members, DISCREPANCY));
    (data.collect(), runs.chain(conditions).collect())
}

const PREDICTED: [f64; 6] = [10.4, 10.4, 6.5, 1.1, 1.1, 0.9];
const SENSITIVITIES: [f64; 6] = [-3.0, -3.5, -2.0, 0.4, 0.5, 0.3];

/// Returns the covariance, assembled term by term.
fn dense(data: &[Datum], tau: f64, m: f64) -> DMatrix<f64> {
    let sd = |i: usize| match data[i].sd {
        ErrorSd::Known(sd) => sd,
        ErrorSd::Inferred { .. } => f64::NAN,
    };
    let condition = |i: usize| data[i].run / 2;
    DMatrix::from_fn(6, 6, |i, j| {
        let mut s = if i == j { sd(i) * sd(i) } else { 0.0 };
        if data[i].run == data[j].run {
            s += tau * tau * SENSITIVITIES[i] * SENSITIVITIES[j];
        }
        if condition(i) == condition(j) && data[i].channel == data[j].channel {
            let members: Vec<usize> = (0..6)
                .filter(|&k| condition(k) == condition(i) && data[k].channel == data[i].channel)
                .collect();
            let squares: f64 = members.iter().map(|&k| sd(k) * sd(k)).sum();
            s += m * m * squares / members.len() as f64;
        }
        s
    })
}

/// Normal density of all data, or t density of some, by determinant and inverse.
fn density(covariance: &DMatrix<f64>, data: &[Datum], members: &[usize], nu: Option<f64>) -> f64 {
    let k = members.len();
    let part = DMatrix::from_fn(k, k, |i, j| covariance[(members[i], members[j])]);
    let r = DVector::from_fn(k, |i, _| data[members[i]].value - PREDICTED[members[i]]);
    let q = (r.transpose() * part.clone().try_inverse().unwrap() * &r)[(0, 0)];
    let (count, pi) = (k as f64, std::f64::consts::PI);
    match nu {
        None => -0.5 * (count * (2.0 * pi).ln() + part.determinant().ln() + q),
        Some(nu) => {
            let gamma = |x: f64| libm::lgamma(x);
            gamma(0.5 * (nu + count))
                - gamma(0.5 * nu)
                - 0.5 * count * (nu * pi).ln()
                - 0.5 * part.determinant().ln()
                - 0.5 * (nu + count) * (1.0 + q / nu).ln()
        }
    }
}

fn values() -> Vec<f64> {
    [PREDICTED, SENSITIVITIES].concat()
}

#[test]
fn blocks_match_a_dense_density() {
    for (law, nu) in [(ErrorLaw::Gaussian, None), (T5, Some(5.0))] {
        let (data, common) = three_runs(ErrorSd::Inferred { parameter: 1 });
        let covariance = dense(&data, 0.3, 2.0);
        // The condition of runs 0 and 1 with both channels is one block, run 2 another.
        let blocks = [&[0, 1, 3, 4][..], &[2, 5]];
        let expected: f64 = blocks
            .iter()
            .map(|members| density(&covariance, &data, members, nu))
            .sum();
        let likelihood =
            Likelihood::with_common(data.clone(), law, common, vec![Discrepancy::Known(2.0)]).unwrap();
        let sensitive: Vec<usize> = likelihood.sensitive().iter().map(|s| s.datum).collect();
        assert_eq!(sensitive, [0, 1, 2, 3, 4, 5]);
        let value = likelihood.log_likelihood(&values(), &[9.0, 0.3]).unwrap().value();
        assert!((value - expected).abs() < 1e-10, "{value} {expected}");
        if nu.is_none() {
            let whole = density(&covariance, &data, &[0, 1, 2, 3, 4, 5], None);
            assert!((value - whole).abs() < 1e-10, "{value} {whole}");
        }
    }
}

/// A known discrepancy uses the factored covariance, an unknown one the sums of a common shift.
#[test]
fn a_common_shift_has_the_density_of_its_covariance() {
    let sds = [0.4, 1.0, 2.5, 0.7, 0.7];
    let data: Vec<Datum> = [1.0, -2.0, 4.0, 0.3, 0.9]
        .iter()
        .zip(sds)
        .enumerate()
        .map(|(run, (&value, sd))| datum(run, 0, value, ErrorSd::Known(sd)))
        .collect();
    let common = [common(&[0, 1, 2], DISCREPANCY), common(&[3, 4], DISCREPANCY)];
    let predicted = [0.2, 0.1, -0.5, 0.0, 30.0];
    for law in [ErrorLaw::Gaussian, T5] {
        let value = |discrepancy| {
            let likelihood =
                Likelihood::with_common(data.clone(), law, common.to_vec(), vec![discrepancy]).unwrap();
            likelihood.log_likelihood(&predicted, &[]).unwrap().value()
        };
        let levels = discrepancy_levels()
            .into_iter()
            .map(|m| value(Discrepancy::Known(m)));
        let levels: Vec<f64> = levels.collect();
        let highest = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = levels.iter().map(|v| libm::exp(v - highest)).sum();
        let expected = highest + libm::log(sum / levels.len() as f64);
        let unknown = value(Discrepancy::Unknown);
        assert!((unknown - expected).abs() < 1e-9, "{unknown} {expected}");
    }
}

/// Runs 0 and 1 share a preparation, run 2 has a different one: two errors along different derivatives couple the first two.
#[test]
fn errors_of_a_preparation_couple_its_runs() {
    let (data, _) = three_runs(ErrorSd::Known(0.0));
    let (stiffness, strength) = (0.2, 0.05);
    let strengths = [8.0, 9.0, 7.5, 1.2, 1.4, 0.9];
    let mut errors = Vec::new();
    for (derivative, sd) in [(0, stiffness), (1, strength)] {
        for members in [&[0, 1, 3, 4][..], &[2, 5]] {
            errors.push(common(members, sensitivity(ErrorSd::Known(sd), derivative)));
        }
    }
    let covariance = DMatrix::from_fn(6, 6, |i, j| {
        let noise = dense(&data, 0.0, 0.0)[(i, j)];
        let shared = data[i].run / 2 == data[j].run / 2;
        let errors = stiffness * stiffness * SENSITIVITIES[i] * SENSITIVITIES[j]
            + strength * strength * strengths[i] * strengths[j];
        noise + if shared { errors } else { 0.0 }
    });
    let likelihood = normal(&data, &errors, Discrepancy::None);
    let mut predicted = values();
    predicted.extend(strengths);
    assert_eq!(likelihood.values(), predicted.len());
    let value = likelihood.log_likelihood(&predicted, &[]).unwrap().value();
    let expected = density(&covariance, &data, &[0, 1, 2, 3, 4, 5], None);
    assert!((value - expected).abs() < 1e-10, "{value} {expected}");
    let (part, places) = likelihood.subset(&[1, 5]).unwrap();
    assert_eq!(places, [1, 5, 7, 11, 13, 17]);
    assert_eq!(part.values(), places.len());
}

/// Three channels of 30 runs: every three runs repeat a condition, six sessions share an offset of each channel and one sensitivity.
#[test]
fn a_large_block_has_the_density_of_its_covariance() {
    let [runs, count] = [30, 90];
    let wave = |i: usize, k: f64| (1.7 * k * (i as f64 + 1.0)).sin();
    let data: Vec<Datum> = (0..count)
        .map(|i| {
            datum(
                i % runs,
                i / runs,
                wave(i, 1.0),
                ErrorSd::Known(0.5 + 0.1 * wave(i, 2.0)),
            )
        })
        .collect();
    let group = |members: &dyn Fn(&Datum) -> bool| -> Vec<usize> {
        (0..count).filter(|&i| members(&data[i])).collect()
    };
    let mut errors = Vec::new();
    for session in 0..6 {
        errors.push(common(
            &group(&|d| d.run % 6 == session),
            sensitivity(ErrorSd::Known(0.7), 0),
        ));
        for channel in 0..3 {
            let members = group(&|d| d.run % 6 == session && d.channel == channel);
            errors.push(common(
                &members,
                CommonErrorSize::Shift(ErrorSd::Known(0.3 + 0.2 * channel as f64)),
            ));
        }
    }
    for condition in 0..10 {
        for channel in 0..3 {
            let members = group(&|d| d.run / 3 == condition && d.channel == channel);
            errors.push(common(&members, DISCREPANCY));
        }
    }
    let values: Vec<f64> = (0..2 * count).map(|i| 0.5 * wave(i, 3.0)).collect();
    let m = 1.5;
    let likelihood = normal(&data, &errors, Discrepancy::Known(m));
    let sd = |i: usize| 0.5 + 0.1 * wave(i, 2.0);
    let mut covariance = DMatrix::from_diagonal(&DVector::from_fn(count, |i, _| sd(i) * sd(i)));
    for error in &errors {
        let squares: f64 = error.data.iter().map(|&i| sd(i) * sd(i)).sum();
        let size = |i: usize| match error.size {
            CommonErrorSize::Shift(ErrorSd::Known(sd)) => sd,
            CommonErrorSize::Discrepancy { .. } => m * (squares / error.data.len() as f64).sqrt(),
            _ => 0.7 * values[count + i],
        };
        for &i in &error.data {
            for &j in &error.data {
                covariance[(i, j)] += size(i) * size(j);
            }
        }
    }
    let residuals = DVector::from_fn(count, |i, _| data[i].value - values[i]);
    let cholesky = covariance.cholesky().unwrap();
    let distance = residuals.dot(&cholesky.solve(&residuals));
    let expected =
        -0.5 * (distance + cholesky.ln_determinant() + count as f64 * (2.0 * std::f64::consts::PI).ln());
    let value = likelihood.log_likelihood(&values, &[]).unwrap().value();
    assert!(
        (value - expected).abs() < 1e-9 * expected.abs(),
        "{value} {expected}"
    );
    let whitening = likelihood.whitening(&values, &[]).unwrap();
    let [c, d] = [4.0, 5.0].map(|k| (0..count).map(|i| wave(i, k)).collect::<Vec<f64>>());
    let curvature = whitening.curvature(&whitening.apply(&c), &whitening.apply(&d));
    let expected = DVector::from_vec(c).dot(&cholesky.solve(&DVector::from_vec(d)));
    assert!(
        (curvature - expected).abs() < 1e-9 * expected.abs().max(1.0),
        "{curvature} {expected}"
    );
}

#[test]
fn an_unknown_discrepancy_is_the_mean_over_its_values() {
    let (data, common) = three_runs(ErrorSd::Known(0.3));
    let unknown = normal(&data, &common, Discrepancy::Unknown);
    let levels = discrepancy_levels();
    assert_eq!(levels.len(), DISCREPANCY_LEVELS);
    assert!((levels[0] - MIN_DISCREPANCY).abs() < 1e-12);
    assert!((levels[DISCREPANCY_LEVELS - 1] - MAX_DISCREPANCY).abs() < 1e-12);
    let all = [0, 1, 2, 3, 4, 5];
    let densities: Vec<f64> = levels
        .iter()
        .map(|&m| density(&dense(&data, 0.3, m), &data, &all, None).exp())
        .collect();
    let sum: f64 = densities.iter().sum();
    let value = unknown.log_likelihood(&values(), &[]).unwrap().value();
    assert!((value - (sum / DISCREPANCY_LEVELS as f64).ln()).abs() < 1e-10);
    let weights = unknown.discrepancy_weights(&values(), &[]).unwrap().remove(0);
    for ((m, weight), (level, density)) in weights.into_iter().zip(levels.iter().zip(&densities)) {
        assert!((m - level).abs() < 1e-15 && (weight - density / sum).abs() < 1e-10);
    }
}

/// Each channel of [`three_runs`] is a group. Alone, each has its own m; when the soil's scatter ties them, they share one.
#[test]
fn every_channel_has_a_separate_discrepancy() {
    let (data, mut common) = three_runs(ErrorSd::Known(0.0));
    for (error, group) in common[3..].iter_mut().zip([0, 0, 1, 1]) {
        error.size = CommonErrorSize::Discrepancy { group };
    }
    let build = |common: &[CommonError], groups: [Discrepancy; 2]| {
        Likelihood::with_common(data.clone(), ErrorLaw::Gaussian, common.to_vec(), groups.to_vec()).unwrap()
    };
    let unknown = [Discrepancy::Unknown; 2];
    let levels = discrepancy_levels();
    let density_of = |members: &[usize], m: f64| density(&dense(&data, 0.0, m), &data, members, None).exp();
    let mean =
        |members: &[usize]| levels.iter().map(|&m| density_of(members, m)).sum::<f64>() / levels.len() as f64;
    let apart = build(&common[3..], unknown);
    let value = apart.log_likelihood(&PREDICTED, &[]).unwrap().value();
    let expected = mean(&[0, 1, 2]).ln() + mean(&[3, 4, 5]).ln();
    assert!((value - expected).abs() < 1e-10, "{value} {expected}");
    let weights = apart.discrepancy_weights(&PREDICTED, &[]).unwrap();
    assert!((weights[0][3].1 - weights[1][3].1).abs() > 1e-4, "{weights:?}");
    let fixed = build(&common[3..], [Discrepancy::Unknown, Discrepancy::Known(2.0)]);
    let value = fixed.log_likelihood(&PREDICTED, &[]).unwrap().value();
    let expected = mean(&[0, 1, 2]).ln() + density_of(&[3, 4, 5], 2.0).ln();
    assert!((value - expected).abs() < 1e-10, "{value} {expected}");
    let tied = build(&common, unknown);
    let value = tied.log_likelihood(&values(), &[]).unwrap().value();
    let expected = mean(&[0, 1, 2, 3, 4, 5]).ln();
    assert!((value - expected).abs() < 1e-10, "{value} {expected}");
    let weights = tied.discrepancy_weights(&values(), &[]).unwrap();
    assert_eq!(weights[0], weights[1]);
}

#[test]
fn errors_of_size_zero_are_the_independent_ones() {
    let (data, mut common) = three_runs(ErrorSd::Known(0.0));
    common.truncate(3);
    let plain = Likelihood::new(data.clone()).unwrap();
    let zero = normal(&data, &common, Discrepancy::None);
    let expected = plain.log_likelihood(&PREDICTED, &[]).unwrap().value();
    let value = zero.log_likelihood(&values(), &[]).unwrap().value();
    assert!((value - expected).abs() < 1e-12, "{value} {expected}");
}

/// A common shift limits the information of a test: forty equal readings determine the level no better than the shift allows.
#[test]
fn a_common_shift_bounds_the_information_of_readings() {
    let data: Vec<Datum> = (0..40).map(|i| datum(i, 0, 0.3, ErrorSd::Known(0.03))).collect();
    let members: Vec<usize> = (0..40).collect();
    let shift = common(
        &members,
        CommonErrorSize::Shift(ErrorSd::Inferred { parameter: 0 }),
    );
    let likelihood = normal(&data, &[shift], Discrepancy::None);
    let value = |level: f64| likelihood.log_likelihood(&[level; 40], &[0.1]).unwrap().value();
    let variance = 0.1 * 0.1 + 0.03 * 0.03 / 40.0;
    assert!((value(0.3) - value(0.0) - 0.5 * 0.09 / variance).abs() < 1e-9);
}

#[test]
fn whitened_slopes_are_those_of_the_density() {
    let (data, common) = three_runs(ErrorSd::Known(0.3));
    let mut loose = data.clone();
    loose.push(datum(9, 0, 2.0, ErrorSd::Known(0.4)));
    let direction = [0.3, -0.2, 0.5, 0.1, -0.4, 0.2, 0.7];
    let at = |t: f64| {
        let mut v: Vec<f64> = PREDICTED.iter().copied().chain([1.5]).collect();
        for (value, d) in v.iter_mut().zip(direction) {
            *value += t * d;
        }
        v.extend(SENSITIVITIES);
        v
    };
    for law in [ErrorLaw::Gaussian, T5] {
        for discrepancy in [Discrepancy::Known(2.0), Discrepancy::Unknown] {
            let likelihood =
                Likelihood::with_common(loose.clone(), law, common.clone(), vec![discrepancy]).unwrap();
            let value = |t: f64| likelihood.log_likelihood(&at(t), &[]).unwrap().value();
            let slope = (value(1e-5) - value(-1e-5)) / 2e-5;
            let whitening = likelihood.whitening(&at(0.0), &[]).unwrap();
            let applied = whitening.apply(&direction);
            let applied_slope = whitening.slope(&applied);
            let bound = 1e-6 * slope.abs().max(1.0);
            assert!(
                (applied_slope - slope).abs() < bound,
                "{law:?}: {applied_slope} {slope}"
            );
            assert!(whitening.curvature(&applied, &applied) > 0.0);
        }
    }
}

#[test]
fn a_common_shift_is_whitened_by_its_mean_precision() {
    let data = [(2.0, 0.3), (1.4, 0.5), (-0.7, 0.2), (0.1, 0.4), (0.8, 0.4)];
    let data = data.map(|(value, sd)| datum(0, 0, value, ErrorSd::Known(sd)));
    let shifts = [&[0, 1, 3][..], &[2], &[4]].map(|members| common(members, DISCREPANCY));
    let with = |discrepancy| normal(&data, &shifts, discrepancy);
    let (values, c, d) = ([0.2; 5], [0.3, -0.2, 0.5, 0.1, -0.4], [1.0, 0.4, -0.3, 0.2, 0.9]);
    let products = |likelihood: &Likelihood| {
        let whitening = likelihood.whitening(&values, &[]).unwrap();
        let (c, d) = (whitening.apply(&c), whitening.apply(&d));
        [whitening.slope(&c), whitening.curvature(&c, &d)]
    };
    let unknown = with(Discrepancy::Unknown);
    let levels = unknown.discrepancy_weights(&values, &[]).unwrap().remove(0);
    let mut expected = [0.0; 2];
    for (m, probability) in levels {
        let products_at_level = products(&with(Discrepancy::Known(m)));
        for (sum, product) in expected.iter_mut().zip(products_at_level) {
            *sum += probability * product;
        }
    }
    for (actual, expected) in products(&unknown).into_iter().zip(expected) {
        let bound = 1e-12 * expected.abs().max(1.0);
        assert!((actual - expected).abs() < bound, "{actual} {expected}");
    }
}

#[test]
fn error_models_that_mean_nothing_are_refused() {
    let (data, errors) = three_runs(ErrorSd::Known(0.3));
    let no_freedom = ErrorLaw::StudentT {
        degrees_of_freedom: 0.0,
    };
    let (normal_law, none) = (ErrorLaw::Gaussian, Discrepancy::None);
    let beyond = vec![common(&[2, 6], DISCREPANCY)];
    let negative = Discrepancy::Known(-1.0);
    for (law, errors, discrepancy, message) in [
        (
            no_freedom,
            Vec::new(),
            none,
            "degrees_of_freedom = 0 is not a finite number above 0",
        ),
        (
            normal_law,
            errors.clone(),
            negative,
            "discrepancy = -1 is not a finite number above 0",
        ),
        (
            normal_law,
            beyond,
            none,
            "a common error names datum 6 of 6, or names it twice",
        ),
    ] {
        let refused = Likelihood::with_common(data.clone(), law, errors, vec![discrepancy]);
        assert_eq!(refused.unwrap_err().to_string(), message);
    }
    let likelihood = normal(&data, &errors, Discrepancy::Known(1.0));
    let short = likelihood.log_likelihood(&PREDICTED, &[]).unwrap_err();
    assert_eq!(short.to_string(), "6 predicted values, 12 are expected");
    let mut infinite = values();
    infinite[7] = f64::INFINITY;
    assert!(likelihood.log_likelihood(&infinite, &[]).is_err());
    infinite[7] = 1e200;
    let far = likelihood.log_likelihood(&infinite, &[]);
    assert_eq!(far, Ok(LogLikelihood::Impossible));
}

/// Returns five data: one alone, a shift over two, a derivative over two more, a discrepancy over the first of these pairs.
fn entangled(discrepancy: Discrepancy) -> Likelihood {
    let data = [0, 1, 2, 3, 4].map(|i| datum(i, i % 2, i as f64, ErrorSd::Known(0.5 + 0.1 * i as f64)));
    let common = [
        common(
            &[1, 2],
            CommonErrorSize::Shift(ErrorSd::Inferred { parameter: 0 }),
        ),
        common(&[3, 4], sensitivity(ErrorSd::Known(0.3), 0)),
        common(&[1], DISCREPANCY),
    ];
    normal(&data, &common, discrepancy)
}

const ENTANGLED: [f64; 7] = [0.1, 0.9, 2.3, 3.0, 3.5, 2.0, -1.5];

#[test]
fn variances_are_the_diagonal_of_the_covariance() {
    let likelihood = entangled(Discrepancy::Known(2.0));
    let variances = likelihood.error_variances(&ENTANGLED, &[0.7]).unwrap();
    // Noise 0.5 ... 0.9; shift 0.7; twice the noise of datum 1; 0.3 times the derivatives 2 and -1.5.
    let expected = [0.25, 0.36 + 0.49 + 1.44, 0.49 + 0.49, 0.64 + 0.36, 0.81 + 0.2025];
    for (a, b) in variances.iter().zip(expected) {
        assert!((a - b).abs() < 1e-12, "{variances:?}");
    }
    let unknown = entangled(Discrepancy::Unknown);
    let weights = unknown.discrepancy_weights(&ENTANGLED, &[0.7]).unwrap();
    let squares: f64 = weights[0].iter().map(|(m, w)| w * m * m).sum();
    let variances = unknown.error_variances(&ENTANGLED, &[0.7]).unwrap();
    assert!((variances[1] - (0.36 + 0.49 + 0.36 * squares)).abs() < 1e-12);
}

#[test]
fn densities_of_single_data_are_those_of_their_variances() {
    let likelihood = entangled(Discrepancy::Known(2.0));
    let densities = likelihood.log_densities(&ENTANGLED, &[0.7]).unwrap();
    assert_eq!(densities.len(), 5);
    for (datum, &density) in densities.iter().enumerate() {
        let (alone, places) = likelihood.subset(&[datum]).unwrap();
        let values: Vec<f64> = places.iter().map(|&place| ENTANGLED[place]).collect();
        let expected = alone.log_likelihood(&values, &[0.7]).unwrap().value();
        assert!(
            (density - expected).abs() < 1e-12,
            "{datum}: {density} {expected}"
        );
    }
}

#[test]
fn a_subset_has_the_density_of_its_data_alone() {
    let whole = entangled(Discrepancy::Known(2.0));
    let (part, places) = whole.subset(&[0, 2, 4]).unwrap();
    assert_eq!(places, [0, 2, 4, 6]);
    let values: Vec<f64> = places.iter().map(|&p| ENTANGLED[p]).collect();
    // No common error remains: three independent normals with the variances of the whole.
    let density = |variance: f64, residual: f64| {
        -0.5 * (2.0 * std::f64::consts::PI * variance).ln() - 0.5 * residual * residual / variance
    };
    let expected = density(0.25, -0.1) + density(0.98, -0.3) + density(1.0125, 0.5);
    let actual = part.log_likelihood(&values, &[0.7]).unwrap().value();
    assert!((actual - expected).abs() < 1e-12, "{actual} {expected}");
    let all: Vec<usize> = (0..5).collect();
    assert_eq!(whole.subset(&all).unwrap().0, whole);
    let beyond = whole.subset(&[5]);
    assert!(matches!(
        beyond,
        Err(LikelihoodError::Membership { datum: 5, data: 5 })
    ));
}
