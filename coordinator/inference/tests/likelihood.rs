//! Check the likelihood against hand numbers.

use inference::{Datum, GaussianLikelihood, LikelihoodError, LogLikelihood, Sd};

fn datum(run: usize, channel: usize, value: f64, sd: Sd) -> Datum {
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
        datum(0, 0, 10.0, Sd::Known(2.0)),
        datum(0, 1, 1.0, Sd::Inferred { parameter: 1 }),
        datum(3, 0, 7.0, Sd::Known(2.0)),
    ];
    let likelihood = GaussianLikelihood::new(data).unwrap();
    // Residuals in sd: (10 - 8) / 2 = 1, (1 - 0.5) / 0.25 = 2, (7 - 7) / 2 = 0.
    let predicted = |run: usize, channel: usize| match (run, channel) {
        (0, 0) => 8.0,
        (0, 1) => 0.5,
        _ => 7.0,
    };
    let value = likelihood
        .log_likelihood(predicted, &[9.0, 0.25])
        .unwrap()
        .value();
    let expected = -1.5 * (2.0 * std::f64::consts::PI).ln() - 2.0 * 2.0_f64.ln() - 0.25_f64.ln() - 2.5;
    assert!((value - expected).abs() < 1e-12, "{value} {expected}");
}

/// The normalisation lets an inferred noise find its level: the best sd of residuals 1 and -1 is 1.
#[test]
fn the_best_noise_is_the_residuals_rms() {
    let noise = Sd::Inferred { parameter: 0 };
    let likelihood =
        GaussianLikelihood::new(vec![datum(0, 0, 1.0, noise), datum(1, 0, -1.0, noise)]).unwrap();
    let value = |sd: f64| likelihood.log_likelihood(|_, _| 0.0, &[sd]).unwrap().value();
    assert!(value(1.0) > value(0.9) && value(1.0) > value(1.1) && value(1.0) > value(100.0));
}

#[test]
fn what_is_not_a_number_is_refused() {
    assert!(GaussianLikelihood::new(vec![datum(0, 0, f64::NAN, Sd::Known(1.0))]).is_err());
    assert!(GaussianLikelihood::new(vec![datum(0, 0, 1.0, Sd::Known(0.0))]).is_err());
    let likelihood = GaussianLikelihood::new(vec![datum(2, 1, 1.0, Sd::Inferred { parameter: 0 })]).unwrap();
    let error = likelihood.log_likelihood(|_, _| f64::NAN, &[1.0]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "prediction NaN of run 2, channel 1 is not finite"
    );
    assert!(matches!(
        likelihood.log_likelihood(|_, _| 0.0, &[]),
        Err(LikelihoodError::MissingParameter { .. })
    ));
    assert!(matches!(
        likelihood.log_likelihood(|_, _| 0.0, &[-1.0]),
        Err(LikelihoodError::Noise { .. })
    ));
    assert_eq!(
        likelihood.log_likelihood(|_, _| 1e300, &[1e-10]),
        Ok(LogLikelihood::Impossible)
    );
}
