//! The search for the missing effect, on linear models whose evidence has a closed form.

use discovery::{Candidate, CandidateError, Engine, Finding, Method, Settings};
use nalgebra::{DMatrix, DVector};
use statistics::{Datum, Distribution, ErrorSd, Likelihood, Marginal};

const SD: f64 = 0.5;
const DATA: usize = 12;

fn normal(mean: f64, sd: f64) -> Marginal {
    Marginal::new(Distribution::Normal { mean, sd }, None).unwrap()
}

fn half_normal(scale: f64) -> Marginal {
    Marginal::new(Distribution::HalfNormal { scale }, None).unwrap()
}

fn effect(name: &str, prior: Marginal) -> Candidate {
    Candidate {
        name: name.into(),
        parameters: vec![prior],
        strengths: vec![0],
        neutral: 0.0,
    }
}

/// How the predictions change with each parameter: two of the base, then an effect's.
fn column(k: usize, i: usize) -> f64 {
    let x = i as f64 / 6.0 - 1.0;
    [
        1.0,
        x,
        x * x,
        x * x * x,
        x * x + 0.05 * x * x * x,
        1.0,
        x * x + 0.5 * x * x * x,
    ][k]
}

/// Two straight-line parameters with unit priors.
fn base() -> [Marginal; 2] {
    [normal(0.0, 1.0), normal(0.0, 1.0)]
}

fn measured(truth: &[(usize, f64)]) -> Vec<f64> {
    let noise = |i: usize| SD * [0.6, -1.1, 0.3, 1.4, -0.5, -0.2, 0.9, -1.3, 0.1, 0.8, -0.7, 0.2][i];
    let clean = |i: usize| truth.iter().map(|&(k, a)| a * column(k, i)).sum::<f64>();
    (0..DATA).map(|i| clean(i) + noise(i)).collect()
}

fn likelihood(values: &[f64]) -> Likelihood {
    let datum = |(run, &value): (usize, &f64)| Datum {
        run,
        channel: 0,
        value,
        sd: ErrorSd::Known(SD),
    };
    Likelihood::new(values.iter().enumerate().map(datum).collect()).unwrap()
}

/// Searches; the candidate k changes the predictions along column `columns[k]`.
fn search(values: &[f64], candidates: &[Candidate], columns: &[usize], backwards: bool) -> Finding {
    let mut engine = Engine::new(
        &base(),
        likelihood(values),
        candidates.to_vec(),
        &Settings::default(),
    )
    .unwrap();
    while engine.finding().is_none() {
        let pending: Vec<_> = engine.pending().collect();
        let mut order: Vec<usize> = (0..pending.len()).collect();
        if backwards {
            order.reverse();
        }
        for index in order {
            let request = &pending[index];
            let predict = |i: usize| {
                let own = request
                    .candidate
                    .map_or(0.0, |k| request.theta[2] * column(columns[k], i));
                request.theta[0] * column(0, i) + request.theta[1] * column(1, i) + own
            };
            let predicted: Vec<f64> = (0..DATA).map(predict).collect();
            engine.tell(index, Some(&predicted)).unwrap();
        }
    }
    engine.finding().unwrap().clone()
}

/// `ln N(y; 0, SD^2 I + sum_k scale_k^2 c_k c_k')`: the evidence of a linear model with normal priors.
fn log_evidence(values: &[f64], columns: &[(usize, f64)]) -> f64 {
    let covariance = DMatrix::from_fn(DATA, DATA, |i, j| {
        let noise = if i == j { SD * SD } else { 0.0 };
        let of = |&(k, scale): &(usize, f64)| scale * scale * column(k, i) * column(k, j);
        noise + columns.iter().map(of).sum::<f64>()
    });
    let y = DVector::from_column_slice(values);
    let cholesky = covariance.cholesky().unwrap();
    let log_determinant: f64 = (0..DATA).map(|i| 2.0 * libm::log(cholesky.l()[(i, i)])).sum();
    -0.5 * (y.dot(&cholesky.solve(&y)) + log_determinant + DATA as f64 * libm::log(std::f64::consts::TAU))
}

#[track_caller]
fn near(given: f64, expected: f64) {
    assert!(
        (given - expected).abs() < 1e-5 * expected.abs().max(1.0),
        "{given}, not {expected}"
    );
}

const BASE: [(usize, f64); 2] = [(0, 1.0), (1, 1.0)];

#[test]
fn evidence_of_a_linear_extension_is_exact() {
    let values = measured(&[(0, 0.7), (2, 1.5)]);
    let finding = search(&values, &[effect("square", normal(0.0, 2.0))], &[2], false);
    let expected = log_evidence(&values, &[BASE[0], BASE[1], (2, 2.0)]) - log_evidence(&values, &BASE);
    let judged = finding.of(Some(0)).unwrap();
    // The screen is exact too: the model is linear in the strength.
    near(judged.log_bayes_factor, expected);
    near(judged.screen_log_bayes_factor, expected);
    assert_eq!(judged.method, Method::Confirmed);
}

#[test]
fn draws_agree_with_the_closed_form_where_two_effects_are_close() {
    let values = measured(&[(0, 0.7), (2, 0.8), (6, 0.8)]);
    let candidates = [
        effect("square", half_normal(2.0)),
        effect("skewed square", half_normal(2.0)),
    ];
    let finding = search(&values, &candidates, &[2, 6], false);
    for (k, column) in [(0, 2), (1, 6)] {
        let expected = half_normal_evidence(&values, column, 2.0) - log_evidence(&values, &BASE);
        let judged = finding.of(Some(k)).unwrap();
        assert_eq!(judged.method, Method::Sampled);
        // At least 60 effective draws of either model: 0.13 nats each.
        let missed = (judged.log_bayes_factor - expected).abs();
        assert!(
            missed < 0.4 && missed > 0.0,
            "{} for {expected}",
            judged.log_bayes_factor
        );
    }
}

/// The integral over a half-normal strength, by the trapezoidal rule.
fn half_normal_evidence(values: &[f64], k: usize, scale: f64) -> f64 {
    let steps = 20_000;
    let width = 10.0 * scale / f64::from(steps);
    let density = |n: i32| {
        let a = width * f64::from(n);
        let rest: Vec<f64> = values
            .iter()
            .enumerate()
            .map(|(i, y)| y - a * column(k, i))
            .collect();
        let prior =
            libm::log(2.0 / scale) - 0.5 * libm::log(std::f64::consts::TAU) - 0.5 * (a / scale).powi(2);
        let weight = if n == 0 || n == steps { 0.5 } else { 1.0 };
        weight * width * libm::exp(log_evidence(&rest, &BASE) + prior)
    };
    libm::log((0..=steps).map(density).sum())
}

#[test]
fn a_strength_of_one_sign_is_truncated_exactly_on_either_side_of_zero() {
    for (truth, at_bound) in [(1.5, false), (-0.8, true)] {
        let values = measured(&[(0, 0.7), (2, truth)]);
        let finding = search(&values, &[effect("square", half_normal(2.0))], &[2], false);
        let expected = half_normal_evidence(&values, 2, 2.0) - log_evidence(&values, &BASE);
        let judged = finding.of(Some(0)).unwrap();
        near(judged.log_bayes_factor, expected);
        near(judged.screen_log_bayes_factor, expected);
        assert_eq!(judged.at_bound[2], at_bound);
        assert_eq!(judged.theta[2].abs() < 1e-12, at_bound);
    }
}

/// Square, cube, all but the square again, and the base's own constant.
fn four() -> ([Candidate; 4], [usize; 4]) {
    let names = ["square", "cube", "likeness", "constant"];
    (names.map(|name| effect(name, normal(0.0, 1.0))), [2, 3, 4, 5])
}

#[test]
fn probabilities_sum_to_one_and_follow_the_prior_over_classes() {
    let values = measured(&[(0, 0.3), (3, 0.4)]);
    let (candidates, columns) = four();
    let finding = search(&values, &candidates, &columns, false);
    let sum: f64 = finding.judged.iter().map(|j| j.probability).sum();
    near(sum, 1.0);
    // Four candidates in three classes: a half for none, a sixth for each class.
    let none = finding.of(None).unwrap().probability;
    let square = finding.of(Some(0)).unwrap();
    let cube = finding.of(Some(1)).unwrap();
    near(cube.probability / none, libm::exp(cube.log_bayes_factor) / 3.0);
    near(
        square.probability / none,
        libm::exp(square.log_bayes_factor) / 6.0,
    );
    let held: f64 = finding.credible_set.iter().map(|c| finding.of_class(*c)).sum();
    let without_last = held - finding.of_class(*finding.credible_set.last().unwrap());
    assert!(held >= 0.95 && without_last < 0.95, "{held} {without_last}");
}

#[test]
fn what_the_data_cannot_tell_apart_is_one_class_and_the_truth_is_found() {
    let values = measured(&[(0, 0.3), (2, 2.0)]);
    let (candidates, columns) = four();
    let finding = search(&values, &candidates, &columns, false);
    let class = |k: usize| finding.of(Some(k)).unwrap().class;
    assert_eq!(class(0), class(2));
    assert!(class(0) != class(1) && class(1) != class(3) && class(0) != 0);
    assert!(finding.of_class(class(0)) > 0.9);
    assert_eq!(finding.credible_set, [class(0)]);
}

#[test]
fn what_the_base_absorbs_cannot_be_excluded() {
    let values = measured(&[(0, 0.3)]);
    let (mut candidates, columns) = four();
    // Weaker than the noise even before the base is fitted again.
    candidates[1].parameters[0] = normal(0.0, 0.1);
    let finding = search(&values, &candidates, &columns, false);
    assert_eq!(finding.cannot_exclude, [1, 3]);
}

#[test]
fn the_order_within_a_round_does_not_matter() {
    let values = measured(&[(0, 0.3), (3, 1.0)]);
    let (candidates, columns) = four();
    assert_eq!(
        search(&values, &candidates, &columns, false),
        search(&values, &candidates, &columns, true)
    );
}

#[test]
fn a_candidate_that_the_model_always_refuses_is_named_and_not_judged() {
    let candidates = vec![
        effect("square", normal(0.0, 1.0)),
        effect("cube", normal(0.0, 1.0)),
    ];
    let values = measured(&[(0, 0.3)]);
    let mut engine = Engine::new(&base(), likelihood(&values), candidates, &Settings::default()).unwrap();
    while engine.finding().is_none() {
        for (index, request) in engine.pending().collect::<Vec<_>>().iter().enumerate() {
            let own = |i: usize| request.candidate.map_or(0.0, |_| request.theta[2] * column(2, i));
            let line = |i: usize| request.theta[0] + request.theta[1] * column(1, i) + own(i);
            let predicted: Vec<f64> = (0..DATA).map(line).collect();
            let answer = (request.candidate != Some(1)).then_some(predicted);
            engine.tell(index, answer.as_deref()).unwrap();
        }
    }
    let finding = engine.finding().unwrap();
    assert_eq!(finding.refused, [1]);
    assert!(finding.of(Some(1)).is_none() && finding.of(Some(0)).is_some());
}

#[test]
fn what_cannot_be_searched_for_is_refused_with_its_reason() {
    let begin = |candidates: Vec<Candidate>| {
        Engine::new(
            &base(),
            likelihood(&measured(&[])),
            candidates,
            &Settings::default(),
        )
        .map(drop)
    };
    let mut broken = effect("square", normal(0.0, 1.0));
    broken.strengths = vec![1];
    assert!(matches!(
        begin(vec![broken.clone()]),
        Err(CandidateError::NoStrength { parameters: 1, .. })
    ));
    broken.strengths = vec![0];
    broken.neutral = f64::NAN;
    assert!(matches!(begin(vec![broken]), Err(CandidateError::Neutral { .. })));
}
