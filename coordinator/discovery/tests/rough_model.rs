//! The search of a rough model, whose evaluations are expensive, compared with the same model without its jumps.

use crate::setup::{data, effect, half_normal, normal, rank};
use discovery::{
    Candidate, EffectRanking, EffectRequest, EffectSearch, EvidenceMethod, RankedEffect, SearchSettings,
    Smoothness,
};
use statistics::rng::Stream;
use statistics::{CommonError, CommonErrorSize, Datum, Discrepancy, ErrorLaw, Likelihood, Prior};

const DATA: usize = 48;
const EFFECTS: usize = 30;
const SD: f64 = 0.2;
/// The jumps of the rough model's predictions.
const SCATTER: f64 = 0.05;
const STRENGTH: f64 = 1.5;

fn candidate(k: usize) -> Candidate {
    Candidate {
        has_low_fidelity: true,
        ..effect(&format!("effect {k}"), half_normal(1.0))
    }
}

/// A straight line, and an effect that saturates slowly.
fn predicted(theta: &[f64], effect: Option<usize>, smoothness: Smoothness) -> Vec<f64> {
    let key = theta
        .iter()
        .fold(0, |key: u64, t| key.rotate_left(7) ^ t.to_bits());
    let jumps = Stream::new(1, 0, key, 0).normals(DATA);
    let value = |i: usize| {
        let x = 2.0 * i as f64 / (DATA - 1) as f64 - 1.0;
        let change = effect.map_or(0.0, |k| {
            let shape = libm::cos((1.0 + 0.3 * k as f64) * (x + 1.0) + k as f64);
            theta[2] / (1.0 + 0.1 * theta[2]) * shape
        });
        let jump = match smoothness {
            Smoothness::Smooth => 0.0,
            Smoothness::Rough | Smoothness::Unknown => SCATTER * jumps[i],
        };
        theta[0] + theta[1] * x + change + jump
    };
    (0..DATA).map(value).collect()
}

fn data_of(truth: usize) -> Vec<Datum> {
    let noise = Stream::new(2, 0, truth as u64, 0).normals(DATA);
    let clean = predicted(&[0.4, -0.7, STRENGTH], Some(truth), Smoothness::Smooth);
    let values: Vec<f64> = clean
        .iter()
        .zip(&noise)
        .map(|(value, noise)| value + SD * noise)
        .collect();
    data(&values, SD)
}

fn search(truth: usize, smoothness: Smoothness) -> EffectRanking {
    searched(Likelihood::new(data_of(truth)).unwrap(), smoothness)
}

fn searched(likelihood: Likelihood, smoothness: Smoothness) -> EffectRanking {
    searched_as(likelihood, smoothness, smoothness)
}

/// The search of a model of one smoothness with the settings of another.
fn searched_as(likelihood: Likelihood, smoothness: Smoothness, declared: Smoothness) -> EffectRanking {
    let settings = SearchSettings {
        smoothness: declared,
        has_numerical_noise: declared != Smoothness::Smooth,
        ..SearchSettings::default()
    };
    run(likelihood, &settings, |request| {
        assert!(!request.is_low_fidelity);
        Some(predicted(&request.theta, request.candidate, smoothness))
    })
}

/// The search of a rough model with a low-fidelity model.
fn beside(truth: usize, low_fidelity: impl Fn(&EffectRequest) -> Option<Vec<f64>>) -> EffectRanking {
    let settings = SearchSettings {
        smoothness: Smoothness::Rough,
        has_numerical_noise: true,
        has_low_fidelity: true,
        ..SearchSettings::default()
    };
    let likelihood = Likelihood::new(data_of(truth)).unwrap();
    run(likelihood, &settings, |request| match request.is_low_fidelity {
        true => low_fidelity(request),
        false => Some(predicted(&request.theta, request.candidate, Smoothness::Rough)),
    })
}

/// A low-fidelity model whose predictions are a share of the model's, without its jumps and with an error of their own.
fn biased(theta: &[f64], effect: Option<usize>) -> Vec<f64> {
    let smooth = predicted(theta, effect, Smoothness::Smooth);
    smooth.iter().map(|value| 0.3 + 0.8 * value).collect()
}

fn run(
    likelihood: Likelihood,
    settings: &SearchSettings,
    answer: impl Fn(&EffectRequest) -> Option<Vec<f64>>,
) -> EffectRanking {
    let candidates: Vec<Candidate> = (0..EFFECTS).map(candidate).collect();
    let prior = Prior::new(vec![normal(1.0), normal(1.0)]);
    rank(
        EffectSearch::new(&prior, likelihood, &candidates, settings).unwrap(),
        false,
        answer,
    )
}

fn leader(ranking: &EffectRanking) -> &RankedEffect {
    ranking.ranked()[0]
}

#[test]
fn a_rough_model_is_searched_with_fewer_evaluations_and_names_the_same() {
    let (mut sparing, mut thorough) = (0, 0);
    for truth in [5, 7, 13, 22, 29] {
        let [smooth, rough] =
            [Smoothness::Smooth, Smoothness::Rough].map(|smoothness| search(truth, smoothness));
        assert_eq!(
            leader(&smooth).class,
            smooth.effect(Some(truth)).unwrap().class,
            "{truth}"
        );
        assert_eq!(
            leader(&rough).class,
            rough.effect(Some(truth)).unwrap().class,
            "{truth}"
        );
        // The measurement of the scatter is counted separately.
        let of_effects =
            |ranking: &EffectRanking| ranking.evaluations.to_confirm() - ranking.evaluations.base;
        sparing += of_effects(&rough);
        thorough += of_effects(&smooth);
    }
    assert!(4 * sparing < 3 * thorough, "{sparing} of {thorough}");
}

#[test]
fn a_rough_model_that_contradicts_the_data_is_confirmed_thoroughly_with_a_discrepancy_too() {
    let confirmation = |misfit: f64, discrepancy: bool| {
        let mut data = data_of(13);
        for (i, datum) in data.iter_mut().enumerate() {
            datum.value += if i.is_multiple_of(2) { misfit } else { -misfit };
        }
        let likelihood = if discrepancy {
            let size = CommonErrorSize::Discrepancy { group: 0 };
            let common = CommonError {
                data: (0..DATA).collect(),
                size,
            };
            Likelihood::with_common(
                data,
                ErrorLaw::Gaussian,
                vec![common],
                vec![Discrepancy::Known(2.0)],
            )
        } else {
            Likelihood::new(data)
        };
        let ranking = searched(likelihood.unwrap(), Smoothness::Rough);
        ranking.evaluations.confirmation
    };
    let fits = confirmation(0.0, false);
    for discrepancy in [false, true] {
        let contradicts = confirmation(0.6, discrepancy);
        assert!(contradicts > 2 * fits, "{discrepancy}: {contradicts} and {fits}");
    }
}

#[test]
fn what_is_out_of_reach_is_screened_alone_and_its_probability_is_small_by_either_search() {
    let truth = 13;
    let [smooth, rough] = [Smoothness::Smooth, Smoothness::Rough].map(|smoothness| search(truth, smoothness));
    let screened = || {
        rough
            .effects
            .iter()
            .filter(|e| e.method == EvidenceMethod::Screen)
    };
    assert!(screened().count() > EFFECTS / 2, "{}", screened().count());
    assert!(smooth.effects.iter().all(|e| e.method > EvidenceMethod::Screen));
    for effect in screened() {
        let thorough = smooth.effect(effect.candidate).unwrap();
        assert!(
            effect.probability < 1e-4 && thorough.probability < 1e-4,
            "{:?}: {} and {}",
            effect.candidate,
            effect.probability,
            thorough.probability
        );
    }
}

#[test]
fn a_model_of_unknown_smoothness_is_searched_as_its_scatter_says() {
    let ranking =
        |smoothness, declared| searched_as(Likelihood::new(data_of(13)).unwrap(), smoothness, declared);
    let rough = ranking(Smoothness::Rough, Smoothness::Unknown);
    assert_eq!(rough, ranking(Smoothness::Rough, Smoothness::Rough));
    let [smooth, thorough] =
        [Smoothness::Unknown, Smoothness::Smooth].map(|declared| ranking(Smoothness::Smooth, declared));
    assert!(smooth.evaluations.to_confirm() > rough.evaluations.to_confirm());
    for effect in &smooth.effects {
        let reference = thorough.effect(effect.candidate).unwrap();
        assert_eq!(effect.method, reference.method, "{:?}", effect.candidate);
        let difference = effect.log_bayes_factor - reference.log_bayes_factor;
        assert!(difference.abs() < 0.1, "{:?}: {difference}", effect.candidate);
    }
}

#[test]
fn a_low_fidelity_model_saves_evaluations_of_the_model_and_the_same_is_named() {
    let (mut with, mut without) = (0, 0);
    for truth in [5, 7, 13, 22, 29] {
        let alone = search(truth, Smoothness::Rough);
        let beside = beside(truth, |request| Some(biased(&request.theta, request.candidate)));
        let class_of_truth = beside.effect(Some(truth)).unwrap().class;
        assert_eq!(leader(&beside).class, class_of_truth, "{truth}");
        let [with_it, without_it] = [&beside, &alone].map(|ranking| leader(ranking).log_bayes_factor);
        assert!(with_it > 0.85 * without_it, "{truth}: {with_it} and {without_it}");
        with += beside.evaluations.screen + beside.evaluations.refinement;
        without += alone.evaluations.screen + alone.evaluations.refinement;
    }
    assert!(2 * with < without, "{with} of {without}");
}

#[test]
fn a_low_fidelity_model_that_answers_nothing_changes_nothing() {
    assert_eq!(beside(13, |_| None), search(13, Smoothness::Rough));
}

#[test]
fn what_the_low_fidelity_model_does_not_show_is_screened_on_the_model() {
    let truth = 13;
    let blind = beside(truth, |request| {
        let seen = request.candidate.filter(|k| *k != truth);
        Some(biased(&request.theta, seen))
    });
    assert_eq!(leader(&blind).class, blind.effect(Some(truth)).unwrap().class);
}

#[test]
fn where_the_base_meets_rejected_parameters_no_effect_is_tried_beyond_them() {
    const REJECTED_FROM: f64 = 0.25;
    let truth = 13;
    let settings = SearchSettings {
        smoothness: Smoothness::Rough,
        has_numerical_noise: true,
        ..SearchSettings::default()
    };
    let likelihood = Likelihood::new(data_of(truth)).unwrap();
    let rejected = std::cell::RefCell::new(std::collections::BTreeMap::new());
    let ranking = run(likelihood, &settings, |request| {
        if request.theta[0] > REJECTED_FROM {
            *rejected.borrow_mut().entry(request.candidate).or_insert(0) += 1;
            return None;
        }
        Some(predicted(&request.theta, request.candidate, Smoothness::Rough))
    });
    assert_eq!(leader(&ranking).class, ranking.effect(Some(truth)).unwrap().class);
    let rejected = rejected.into_inner();
    assert!(rejected[&None] > 0, "the base leads to rejected parameters");
    // A confirmed candidate is also tried from other starts, so that it does not count here.
    let of_screened = rejected.iter().filter(|(candidate, _)| {
        let effect = ranking.effect(**candidate);
        effect.is_some_and(|effect| effect.method < EvidenceMethod::Refined)
    });
    assert_eq!(of_screened.count(), 0, "{rejected:?}");
}
