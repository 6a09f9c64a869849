//! The search for one effect, on linear models whose evidence has a closed form.

use crate::setup::{data, effect, half_normal, normal, rank};
use discovery::{Candidate, CandidateError, EffectRanking, EffectSearch, EvidenceMethod, SearchSettings};
use nalgebra::{DMatrix, DVector};
use statistics::{Likelihood, Prior};

const SD: f64 = 0.5;
const DATA: usize = 12;

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
fn base() -> Prior {
    Prior::new(vec![normal(1.0), normal(1.0)])
}

fn measured(truth: &[(usize, f64)]) -> Vec<f64> {
    let noise = |i: usize| SD * [0.6, -1.1, 0.3, 1.4, -0.5, -0.2, 0.9, -1.3, 0.1, 0.8, -0.7, 0.2][i];
    let clean = |i: usize| truth.iter().map(|&(k, a)| a * column(k, i)).sum::<f64>();
    (0..DATA).map(|i| clean(i) + noise(i)).collect()
}

fn likelihood(values: &[f64]) -> Likelihood {
    Likelihood::new(data(values, SD)).unwrap()
}

fn begin(prior: &Prior, values: &[f64], candidates: &[Candidate]) -> Result<EffectSearch, CandidateError> {
    EffectSearch::new(prior, likelihood(values), candidates, &SearchSettings::default())
}

/// Searches candidates; candidate k changes the predictions along column `columns[k]`, a switch by that column.
fn search(values: &[f64], candidates: &[Candidate], columns: &[usize], backwards: bool) -> EffectRanking {
    search_from(&base(), values, candidates, columns, backwards)
}

/// Searches with another prior of the base.
fn search_from(
    prior: &Prior,
    values: &[f64],
    candidates: &[Candidate],
    columns: &[usize],
    backwards: bool,
) -> EffectRanking {
    rank(begin(prior, values, candidates).unwrap(), backwards, |request| {
        let predict = |i: usize| {
            let change = request.candidate.map_or(0.0, |k| {
                request.theta.get(2).unwrap_or(&1.0) * column(columns[k], i)
            });
            request.theta[0] * column(0, i) + request.theta[1] * column(1, i) + change
        };
        Some((0..DATA).map(predict).collect())
    })
}

/// `ln N(y; 0, SD^2 I + sum_k scale_k^2 c_k c_k')`: the evidence of a linear model with normal priors.
fn log_evidence(values: &[f64], columns: &[(usize, f64)]) -> f64 {
    let covariance = DMatrix::from_fn(DATA, DATA, |i, j| {
        let noise = if i == j { SD * SD } else { 0.0 };
        let term = |&(k, scale): &(usize, f64)| scale * scale * column(k, i) * column(k, j);
        noise + columns.iter().map(term).sum::<f64>()
    });
    normal_log_density(values, covariance)
}

fn normal_log_density(values: &[f64], covariance: DMatrix<f64>) -> f64 {
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

/// A fit ends where a step gains less than 0.01 nats, on either side of the difference.
#[track_caller]
fn fitted(given: f64, expected: f64) {
    assert!((given - expected).abs() < 0.02, "{given}, not {expected}");
}

const BASE: [(usize, f64); 2] = [(0, 1.0), (1, 1.0)];

/// The evidence where each of three other widths of a strength's prior has a fifth of the probability.
fn mixed(evidence: impl Fn(f64) -> f64) -> f64 {
    let parts = [(0.4, 1.0), (0.2, 4.0), (0.2, 0.25), (0.2, 0.0625)];
    libm::log(
        parts
            .iter()
            .map(|&(weight, scale)| weight * libm::exp(evidence(scale)))
            .sum(),
    )
}

#[test]
fn evidence_of_a_linear_extension_is_exact() {
    let values = measured(&[(0, 0.7), (2, 1.5)]);
    let ranking = search(&values, &[effect("square", normal(2.0))], &[2], false);
    let with = |scale: f64| log_evidence(&values, &[BASE[0], BASE[1], (2, 2.0 * scale)]);
    let expected = mixed(with) - log_evidence(&values, &BASE);
    let ranked = ranking.effect(Some(0)).unwrap();
    // The screen is exact too: the model is linear in the strength.
    fitted(ranked.log_bayes_factor, expected);
    near(ranked.screen_log_bayes_factor, expected);
    assert_eq!(ranked.method, EvidenceMethod::Confirmed);
}

#[test]
fn correlations_of_the_prior_count() {
    let values = measured(&[(0, 0.7), (1, 0.9), (2, 1.0)]);
    let prior = base()
        .correlated(vec![0, 1], &[vec![1.0, -0.8], vec![-0.8, 1.0]])
        .unwrap();
    let ranking = search_from(&prior, &values, &[effect("square", normal(2.0))], &[2], false);
    // c0 z0 + c1 (-0.8 z0 + 0.6 z1): the same model with independent z along other columns.
    let evidence = |strength: &[(usize, f64)]| {
        let covariance = DMatrix::from_fn(DATA, DATA, |i, j| {
            let noise = if i == j { SD * SD } else { 0.0 };
            let first = |i: usize| column(0, i) - 0.8 * column(1, i);
            let second = |i: usize| 0.6 * column(1, i);
            let term = |&(k, scale): &(usize, f64)| scale * scale * column(k, i) * column(k, j);
            noise + first(i) * first(j) + second(i) * second(j) + strength.iter().map(term).sum::<f64>()
        });
        normal_log_density(&values, covariance)
    };
    let expected = mixed(|scale| evidence(&[(2, 2.0 * scale)])) - evidence(&[]);
    fitted(ranking.effect(Some(0)).unwrap().log_bayes_factor, expected);
}

#[test]
fn a_switch_has_the_evidence_of_its_model() {
    let switch = Candidate {
        parameters: Vec::new(),
        strengths: Vec::new(),
        ..effect("other square", normal(1.0))
    };
    for (truth, is_better) in [(1.0, true), (0.0, false)] {
        let values = measured(&[(0, 0.7), (2, truth)]);
        let without: Vec<f64> = values.iter().enumerate().map(|(i, y)| y - column(2, i)).collect();
        let expected = log_evidence(&without, &BASE) - log_evidence(&values, &BASE);
        let ranking = search(&values, std::slice::from_ref(&switch), &[2], false);
        let ranked = ranking.effect(Some(0)).unwrap();
        fitted(ranked.log_bayes_factor, expected);
        near(ranked.screen_log_bayes_factor, expected);
        assert_eq!((ranked.probability > 0.5, ranked.theta.len()), (is_better, 2));
    }
}

#[test]
fn a_limit_is_in_the_class_of_its_parameter() {
    let limit = Candidate {
        parameters: Vec::new(),
        strengths: Vec::new(),
        limit_of: Some("square".to_owned()),
        ..effect("limit", normal(1.0))
    };
    let values = measured(&[(0, 0.7), (6, 1.0)]);
    let candidates = [
        effect("skewed square", normal(2.0)),
        effect("square", normal(2.0)),
        limit,
    ];
    // The limit changes the predictions as the skewed square does.
    let ranking = search(&values, &candidates, &[6, 3, 6], false);
    let class = |k: usize| ranking.effect(Some(k)).unwrap().class;
    assert_eq!(class(2), class(1));
    assert_ne!(class(2), class(0));
}

#[test]
fn importance_sampling_agrees_with_the_closed_form_where_two_effects_are_close() {
    let values = measured(&[(0, 0.7), (2, 0.8), (6, 0.8)]);
    let candidates = [
        effect("square", half_normal(2.0)),
        effect("skewed square", half_normal(2.0)),
    ];
    let ranking = search(&values, &candidates, &[2, 6], false);
    for (k, column) in [(0, 2), (1, 6)] {
        let expected =
            mixed(|scale| half_normal_evidence(&values, column, 2.0 * scale)) - log_evidence(&values, &BASE);
        let ranked = ranking.effect(Some(k)).unwrap();
        assert_eq!(ranked.method, EvidenceMethod::Sampled);
        // At least 60 effective draws of either model: 0.13 nats each.
        let missed = (ranked.log_bayes_factor - expected).abs();
        assert!(
            missed < 0.4 && missed > 0.0,
            "{} for {expected}",
            ranked.log_bayes_factor
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
        let ranking = search(&values, &[effect("square", half_normal(2.0))], &[2], false);
        let expected =
            mixed(|scale| half_normal_evidence(&values, 2, 2.0 * scale)) - log_evidence(&values, &BASE);
        let ranked = ranking.effect(Some(0)).unwrap();
        fitted(ranked.log_bayes_factor, expected);
        near(ranked.screen_log_bayes_factor, expected);
        assert_eq!(ranked.at_bound[2], at_bound);
        assert_eq!(ranked.theta[2].abs() < 1e-12, at_bound);
    }
}

/// Square, cube, all but the square again, and the base's own constant.
fn four() -> ([Candidate; 4], [usize; 4]) {
    let names = ["square", "cube", "likeness", "constant"];
    (names.map(|name| effect(name, normal(1.0))), [2, 3, 4, 5])
}

/// The classes of the credible set, the most probable first.
fn credible(ranking: &EffectRanking) -> Vec<usize> {
    let credible = ranking.effects.iter().filter(|e| e.is_credible);
    let mut classes: Vec<usize> = credible.map(|e| e.class).collect();
    classes.sort_by(|a, b| {
        ranking
            .class_probability(*b)
            .total_cmp(&ranking.class_probability(*a))
    });
    classes.dedup();
    classes
}

#[test]
fn probabilities_sum_to_one_and_follow_the_prior_over_classes() {
    let values = measured(&[(0, 0.3), (3, 0.4)]);
    let (candidates, columns) = four();
    let ranking = search(&values, &candidates, &columns, false);
    let sum: f64 = ranking.effects.iter().map(|j| j.probability).sum();
    near(sum, 1.0);
    // Four candidates in three classes: a half for none, a sixth for each class.
    let none = ranking.effect(None).unwrap().probability;
    let square = ranking.effect(Some(0)).unwrap();
    let cube = ranking.effect(Some(1)).unwrap();
    near(cube.probability / none, libm::exp(cube.log_bayes_factor) / 3.0);
    near(
        square.probability / none,
        libm::exp(square.log_bayes_factor) / 6.0,
    );
    let credible = credible(&ranking);
    let held: f64 = credible.iter().map(|c| ranking.class_probability(*c)).sum();
    let without_last = held - ranking.class_probability(*credible.last().unwrap());
    assert!(held >= 0.95 && without_last < 0.95, "{held} {without_last}");
}

#[test]
fn effects_that_the_data_cannot_distinguish_form_one_class_and_the_truth_is_found() {
    let values = measured(&[(0, 0.5), (2, 3.0)]);
    let (candidates, columns) = four();
    let ranking = search(&values, &candidates, &columns, false);
    let class = |k: usize| ranking.effect(Some(k)).unwrap().class;
    assert_eq!(class(0), class(2));
    assert!(class(0) != class(1) && class(1) != class(3) && class(0) != 0);
    assert!(ranking.class_probability(class(0)) > 0.9);
    assert_eq!(credible(&ranking), [class(0)]);
}

#[test]
fn effects_that_the_base_absorbs_cannot_be_excluded() {
    let values = measured(&[(0, 0.3)]);
    let (mut candidates, columns) = four();
    // Weaker than the noise even before the base is fitted again.
    candidates[1].parameters[0] = normal(0.1);
    let ranking = search(&values, &candidates, &columns, false);
    assert_eq!(ranking.cannot_exclude, [1, 3]);
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
fn a_candidate_that_the_model_always_rejects_is_listed_and_not_ranked() {
    let candidates = [effect("square", normal(1.0)), effect("cube", normal(1.0))];
    let search = begin(&base(), &measured(&[(0, 0.3)]), &candidates).unwrap();
    let ranking = rank(search, false, |request| {
        let change = |i: usize| request.candidate.map_or(0.0, |_| request.theta[2] * column(2, i));
        let line = |i: usize| request.theta[0] + request.theta[1] * column(1, i) + change(i);
        (request.candidate != Some(1)).then(|| (0..DATA).map(line).collect())
    });
    assert_eq!(ranking.refused, [1]);
    assert!(ranking.effect(Some(1)).is_none() && ranking.effect(Some(0)).is_some());
}

#[test]
fn a_candidate_without_a_strength_is_rejected_with_the_reason() {
    let begin =
        |candidate: &Candidate| begin(&base(), &measured(&[]), std::slice::from_ref(candidate)).map(drop);
    let mut broken = effect("square", normal(1.0));
    broken.strengths = vec![1];
    assert!(matches!(
        begin(&broken),
        Err(CandidateError::NoStrength { parameters: 1, .. })
    ));
    broken.strengths = vec![0];
    broken.neutral = f64::NAN;
    assert!(matches!(begin(&broken), Err(CandidateError::Neutral { .. })));
}
