//! The whole search, on models that are linear in all but a threshold, with known truth.

use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::setup::{best_effects, conclude, data, effect, marginal, noise, normal};
use discovery::{
    Candidate, Conclusion, DETECTED, EvidenceMethod, LawCandidate, OutsideLaw, ProposedRuns, QueriedModel,
    Query, Reduction, SearchSettings, SearchTask, SearchVerdict,
};
use statistics::rng::Stream;
use statistics::{Datum, Distribution, ErrorSd, Likelihood, Prior};

const SD: f64 = 0.1;
/// Eight levels of x, each with three values of w.
const LEVELS: usize = 8;
const OF_LEVEL: usize = 3;
pub(crate) const DATA: usize = LEVELS * OF_LEVEL;

pub(crate) fn x(i: usize) -> f64 {
    (i / OF_LEVEL) as f64 / (LEVELS - 1) as f64 * 2.0 - 1.0
}

pub(crate) fn w(i: usize) -> f64 {
    (i % OF_LEVEL) as f64 - 1.0
}

fn curve(name: &str) -> Candidate {
    Candidate::new(name, vec![normal(1.0); 5], (0..5).collect())
}

/// Effects of the library: three powers of x, and one that the base absorbs.
pub(crate) const SQUARE: usize = 0;
const CUBE: usize = 1;
pub(crate) const WIDTH: usize = 2;
pub(crate) const CONSTANT: usize = 3;
pub(crate) const LIBRARY: usize = 4;
/// Laws outside it: a curve over x with a step, a curve over w with a line.
const OVER_X: usize = LIBRARY;
const STEP: usize = LIBRARY + 1;
pub(crate) const OVER_W: usize = LIBRARY + 2;

fn library() -> Vec<Candidate> {
    let names = ["square", "cube", "width", "constant"];
    names.map(|name| effect(name, normal(1.0))).to_vec()
}

fn laws() -> Vec<LawCandidate> {
    let threshold = marginal(Distribution::Uniform {
        lower: -1.0,
        upper: 1.0,
    });
    vec![
        LawCandidate {
            curve: curve("x"),
            forms: vec![Candidate::new("x step", vec![normal(1.0), threshold], vec![0])],
            is_description: false,
        },
        LawCandidate {
            curve: curve("w"),
            forms: vec![effect("w line", normal(1.0))],
            is_description: false,
        },
    ]
}

/// Hat functions of five knots from -1 to 1.
fn hat(k: usize, x: f64) -> f64 {
    let knot = k as f64 / 2.0 - 1.0;
    (1.0 - 2.0 * (x - knot).abs()).max(0.0)
}

/// The change that a candidate makes at x and w.
pub(crate) fn added(k: usize, parameters: &[f64], x: f64, w: f64) -> f64 {
    match k {
        SQUARE => parameters[0] * x * x,
        CUBE => parameters[0] * x * x * x,
        WIDTH => parameters[0] * w * x,
        CONSTANT => parameters[0],
        OVER_X => (0..5).map(|j| parameters[j] * hat(j, x)).sum(),
        STEP => parameters[0] * f64::from(u8::from(x > parameters[1])),
        OVER_W => (0..5).map(|j| parameters[j] * hat(j, w)).sum(),
        _ => parameters[0] * w,
    }
}

pub(crate) fn length(k: usize) -> usize {
    match k {
        OVER_X | OVER_W => 5,
        STEP => 2,
        _ => 1,
    }
}

/// The prediction of a model with these effects.
fn predict(effects: &[usize], theta: &[f64], x: f64, w: f64) -> f64 {
    let mut value = theta[0] + theta[1] * x;
    let mut parameters = &theta[2..];
    for &k in effects {
        value += added(k, parameters, x, w);
        parameters = &parameters[length(k)..];
    }
    value
}

/// Proposed runs, at x = 0 and x = 2, w = 0.
const PROPOSED: [f64; 2] = [0.0, 2.0];

pub(crate) fn answer(query: &Query) -> Vec<f64> {
    let (effects, theta) = match &query.model {
        QueriedModel::With(effects) => (effects.clone(), query.theta.clone()),
        // The base's last parameter is a cube of its own in one test.
        QueriedModel::Without(..) => (Vec::new(), query.theta.clone()),
    };
    if query.is_proposed {
        return PROPOSED
            .iter()
            .map(|&x| predict(&effects, &theta, x, 0.0))
            .collect();
    }
    (0..DATA).map(|i| predict(&effects, &theta, x(i), w(i))).collect()
}

/// Data of a truth, with noise that is the same in every test.
pub(crate) fn measured(truth: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let noise = Stream::new(7, 0, 0, 0).normals(DATA);
    (0..DATA).map(|i| truth(x(i), w(i)) + SD * noise[i]).collect()
}

pub(crate) fn task(values: &[f64]) -> SearchTask {
    SearchTask {
        prior: Prior::new(vec![normal(1.0), normal(1.0)]),
        likelihood: Likelihood::new(data(values, SD)).unwrap(),
        library: library(),
        laws: laws(),
        strengths: Vec::new(),
        reductions: Vec::new(),
        levels: (0..LEVELS)
            .map(|level| (level * OF_LEVEL..(level + 1) * OF_LEVEL).collect())
            .collect(),
        conditions: Vec::new(),
        proposed: ProposedRuns {
            runs: PROPOSED.len(),
            beyond: vec![0.0; PROPOSED.len()],
            channels: vec![0],
            noise_sds: vec![SD],
        },
        suspected_errors: Vec::new(),
        max_effects: 3,
        settings: SearchSettings::default(),
    }
}

/// Runs a search to its end, the last query of each round told first if `backwards`.
fn search(task: SearchTask, backwards: bool, answer: impl Fn(&Query) -> Vec<f64>) -> Conclusion {
    conclude(task, backwards, |query| Some(answer(query)))
}

fn find(truth: impl Fn(f64, f64) -> f64) -> Conclusion {
    search(task(&measured(truth)), false, answer)
}

/// Checks that the forms of a claimed law are these, in this order, and that their probabilities are a distribution.
#[track_caller]
fn ranked(law: &OutsideLaw, candidates: &[usize]) {
    let forms: Vec<usize> = law.forms.iter().map(|form| form.candidate).collect();
    assert_eq!((forms.as_slice(), forms[0]), (candidates, law.candidate));
    assert!(
        (law.forms[0].log_bayes_factor - law.log_bayes_factor).abs() < 1e-9,
        "{law:?}"
    );
    let mut others = law.forms[1..].windows(2);
    assert!(others.all(|pair| pair[0].log_bayes_factor >= pair[1].log_bayes_factor));
    let sum: f64 = law.forms.iter().map(|form| form.probability).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    assert_eq!(law.forms[0].class, 1);
}

/// Checks that the curve of a law over w, without its prior, is a line of this slope within its covariance.
#[track_caller]
fn check_line(law: &OutsideLaw, slope: f64) {
    let curve = law.curve.as_ref().unwrap();
    let covariance = |k: usize, l: usize| curve.covariance[5 * k + l];
    for k in [0, 2] {
        let rise = curve.knots[k + 2] - curve.knots[k];
        let sd = (covariance(k, k) + covariance(k + 2, k + 2) - 2.0 * covariance(k, k + 2)).sqrt();
        assert!(sd < 0.1 && (rise - slope).abs() < 3.0 * sd, "{rise}, sd {sd}");
    }
    // No datum lies at the second knot: its prior is five times as wide as that of the curve.
    assert!((covariance(1, 1) - 25.0).abs() < 1e-6);
}

#[test]
fn a_law_and_an_effect_that_act_together_are_fitted_together() {
    let line_over_w = OVER_W + 1;
    let conclusion = find(|x, w| 0.3 + 0.5 * x + 1.2 * x * x + 0.8 * w);
    let mut best = conclusion.sets[0].effects.clone().unwrap();
    best.sort_unstable();
    assert_eq!(best, [SQUARE, line_over_w]);
    // All good sets have both; the law explains more alone, so it is claimed first, with its parameters beside the effect.
    assert_eq!(conclusion.verdict, SearchVerdict::NotInLibrary);
    let law = conclusion.outside.unwrap();
    assert_eq!(law.candidate, line_over_w);
    // The curve was fitted beside the effect, too.
    ranked(&law, &[line_over_w, OVER_W]);
    check_line(&law, 0.8);
    assert!(
        (law.forms[0].parameters[0] - 0.8).abs() < 0.1,
        "{:?}",
        law.forms[0].parameters
    );
    assert!(
        law.left_out_nats.iter().all(|nats| *nats > DETECTED),
        "{:?}",
        law.left_out_nats
    );
    assert_eq!(conclusion.complete, Some(true));
    assert!(conclusion.explained.unwrap() > 0.99 && conclusion.remaining.is_empty());
    let sum: f64 = conclusion.sets.iter().map(|set| set.probability).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
}

#[test]
fn what_nothing_explains_is_left() {
    // Neither an effect nor a law follows a zigzag.
    let zigzag = |x: f64, w: f64| if libm::cos(20.0 * x * w) > 0.0 { 0.5 } else { -0.5 };
    let conclusion = find(|x, w| 0.3 + 0.5 * x + 1.2 * x * x + zigzag(x, w));
    assert_eq!(conclusion.complete, Some(false));
    assert_eq!(conclusion.remaining.len(), DATA);
    let squares: f64 = conclusion.remaining.iter().map(|r| r * r).sum();
    assert!((squares - conclusion.chi_square_best.unwrap().value).abs() < 1e-6 * squares);
}

#[test]
fn where_nothing_is_hidden_nothing_is_claimed_and_no_law_is_searched() {
    let conclusion = find(|x, _| 0.3 + 0.5 * x);
    assert_eq!(conclusion.verdict, SearchVerdict::NothingDetectable);
    assert!(conclusion.not_in_library.is_none() && conclusion.outside.is_none());
    assert!(conclusion.next_runs.is_empty());
    assert_eq!(conclusion.ranking.cannot_exclude, [CONSTANT]);
}

#[test]
fn one_effect_is_named() {
    let conclusion = find(|x, _| 0.3 + 0.5 * x + 1.5 * x * x);
    assert_eq!(conclusion.verdict, SearchVerdict::Named(SQUARE));
    assert_eq!(conclusion.combination, [SQUARE]);
    assert!(conclusion.chi_square.unwrap().p() < 0.001 && conclusion.chi_square_best.unwrap().p() > 0.05);
}

#[test]
fn where_the_prior_all_but_excludes_the_best_fit_nothing_is_claimed() {
    let values = measured(|x, _| 0.3 + 0.5 * x + 0.8 * x * x);
    let conclude = |slope: Distribution| {
        let mut task = task(&values);
        task.prior = Prior::new(vec![normal(1.0), marginal(slope)]);
        // A substitute for the slope beside the square.
        task.laws = Vec::new();
        task.library[CUBE].excludes = vec![task.library[SQUARE].name.clone()];
        search(task, false, answer)
    };
    let narrow = conclude(Distribution::Normal { mean: 0.0, sd: 0.03 });
    assert_eq!(narrow.verdict, SearchVerdict::Undecided);
    assert!(narrow.agreed.is_none());
    let (parameter, sds) = narrow.implausible.unwrap();
    assert!(parameter == 1 && sds > 6.5, "{parameter} {sds}");
    // The support of a range ends where the user declared it.
    let bounded = conclude(Distribution::Uniform {
        lower: -1.0,
        upper: 0.45,
    });
    assert_eq!(bounded.verdict, SearchVerdict::Named(SQUARE));
    assert_eq!(bounded.implausible, None);
}

#[test]
fn every_explanation_has_its_predicted_values() {
    let conclusion = find(|x, _| 0.3 + 0.5 * x + 0.8 * x * x);
    for effect in &conclusion.ranking.effects {
        let query = Query {
            model: QueriedModel::With(effect.candidate.into_iter().collect()),
            is_proposed: false,
            is_low_fidelity: false,
            theta: effect.theta.clone(),
        };
        let fitted = effect.method > EvidenceMethod::Screen;
        assert!(!fitted || effect.predicted == answer(&query), "{effect:?}");
        assert_eq!(effect.predicted.len(), answer(&query).len());
    }
}

#[test]
fn two_effects_are_found_together() {
    let conclusion = find(|x, w| 0.3 + 0.8 * x * x + 0.7 * w * x);
    assert_eq!(best_effects(&conclusion), [SQUARE, WIDTH]);
    assert!(
        matches!(conclusion.verdict, SearchVerdict::Named(SQUARE | WIDTH)),
        "{:?}",
        conclusion.verdict
    );
    let sum: f64 = conclusion.ranking.effects.iter().map(|j| j.probability).sum();
    let outside = conclusion.not_in_library.map_or(0.0, |(_, p)| p);
    assert!((sum + outside - 1.0).abs() < 1e-9, "{sum} {outside}");
}

#[test]
fn candidates_that_exclude_each_other_make_no_combination() {
    let mut task = task(&measured(|x, w| 0.3 + 0.8 * x * x + 0.7 * w * x));
    task.library[WIDTH].excludes = vec![task.library[SQUARE].name.clone()];
    let conclusion = search(task, false, answer);
    let both = |effects: &[usize]| effects.contains(&SQUARE) && effects.contains(&WIDTH);
    assert!(!both(&conclusion.combination), "{:?}", conclusion.combination);
}

#[test]
fn a_step_outside_the_library_is_found_with_its_form() {
    let conclusion = find(|x, _| 0.3 + 0.5 * x + if x > 0.3 { 0.9 } else { 0.0 });
    assert_eq!(conclusion.verdict, SearchVerdict::NotInLibrary);
    let law = conclusion.outside.unwrap();
    assert_eq!((law.law, law.candidate), (0, STEP));
    ranked(&law, &[STEP, OVER_X]);
    // A piecewise linear curve is no step.
    assert_eq!(law.forms[1].class, 2);
    assert!(
        (law.forms[0].parameters[0] - 0.9).abs() < 0.15,
        "{:?}",
        law.forms[0].parameters
    );
    assert!(
        law.left_out_nats.iter().all(|nats| *nats > 0.0),
        "{:?}",
        law.left_out_nats
    );
}

#[test]
fn a_law_that_every_good_explanation_has_is_claimed() {
    // A zigzag, which no effect or law follows, leaves room for effects beside the step.
    let zigzag = |x: f64, w: f64| if libm::cos(20.0 * x * w) > 0.0 { 1.0 } else { -1.0 };
    // The step alone is the most probable explanation; then the step beside two effects is.
    for (step, cube, rough) in [(2.5, 0.0, 0.1), (2.5, 0.3, 0.15)] {
        let at = |x: f64| if x > 0.3 { step } else { 0.0 };
        let conclusion = find(|x, w| 0.3 + 0.5 * x + cube * x * x * x + at(x) + rough * zigzag(x, w));
        let beside = conclusion.sets.iter().find(|set| set.effects.is_some()).unwrap();
        assert!(beside.effects.as_ref().unwrap().contains(&STEP) && beside.probability > 0.1);
        assert_eq!(
            conclusion.verdict,
            SearchVerdict::NotInLibrary,
            "{:?}",
            conclusion.sets
        );
        assert_eq!(conclusion.outside.unwrap().candidate, STEP);
    }
}

#[test]
fn an_effect_is_not_named_where_its_strength_is_far_out_in_its_prior() {
    let truth = |x: f64, w: f64| 0.3 + 0.5 * x + 1.2 * w * x;
    let mut narrow = task(&measured(truth));
    narrow.laws.clear();
    let named = search(narrow.clone(), false, answer);
    assert_eq!(
        (named.verdict, named.implausible),
        (SearchVerdict::Named(WIDTH), None)
    );
    narrow.library[WIDTH].parameters = vec![normal(0.2)];
    let withheld = search(narrow, false, answer);
    let (place, sds) = withheld.implausible.unwrap();
    assert_eq!((withheld.verdict, place), (SearchVerdict::Undecided, 2));
    assert!((5.0..7.0).contains(&sds), "{sds}");
}

#[test]
fn a_second_effect_of_the_class_of_one_that_the_model_has_is_more_of_it() {
    let values = measured(|x, _| 0.3 + 0.45 * x);
    let conclude = |strengths: Vec<usize>| {
        let mut task = task(&values);
        // The slope is an effect whose prior holds it back; the candidate adds to it.
        task.prior = Prior::new(vec![
            normal(1.0),
            marginal(Distribution::Normal { mean: 0.0, sd: 0.1 }),
        ]);
        task.strengths = strengths;
        task.laws = Vec::new();
        task.library = vec![effect("slope again", normal(1.0))];
        search(task, false, |query| {
            let QueriedModel::With(effects) = &query.model else {
                panic!("{query:?}");
            };
            let slope = query.theta[1] + effects.first().map_or(0.0, |_| query.theta[2]);
            let at = |x: f64| query.theta[0] + slope * x;
            if query.is_proposed {
                PROPOSED.iter().map(|x| at(*x)).collect()
            } else {
                (0..DATA).map(|i| at(x(i))).collect()
            }
        })
    };
    let unrelated = conclude(Vec::new());
    assert_eq!(
        (unrelated.verdict, unrelated.held_back),
        (SearchVerdict::Named(0), None)
    );
    let same = conclude(vec![1]);
    assert_eq!((same.verdict, same.agreed), (SearchVerdict::Undecided, None));
    let (strength, sds) = same.held_back.unwrap();
    assert!(strength == 1 && (3.5..4.5).contains(&sds), "{strength} {sds}");
}

#[test]
fn a_name_is_weighed_under_other_priors() {
    let probabilities = |strength: f64| -> Vec<f64> {
        let conclusion = find(|x, w| 0.3 + 0.5 * x + strength * w * x);
        conclusion.under_other_priors(Some(WIDTH)).collect()
    };
    let strong = probabilities(0.8);
    assert!(
        strong.len() == 4 && strong.iter().all(|p| *p > 0.99),
        "{strong:?}"
    );
    let weak = probabilities(0.12);
    // Narrower priors and lower odds of "nothing is missing" favour a weak effect.
    assert!(weak[0] > weak[1] && weak[2] > weak[3], "{weak:?}");
}

#[test]
fn a_law_that_fails_the_cross_validation_is_not_claimed() {
    // One level is off by itself: a curve follows it, and predicts nothing.
    let conclusion = find(|x, _| 0.3 + 0.5 * x + if (x - 1.0 / 7.0).abs() < 0.01 { 1.2 } else { 0.0 });
    assert_eq!(conclusion.verdict, SearchVerdict::Undecided);
    assert!(conclusion.outside.is_none() && conclusion.not_in_library.is_some());
}

#[test]
fn cross_validations_ask_nothing_of_the_base_twice() {
    let asked = RefCell::new(BTreeMap::<Vec<u64>, usize>::new());
    // No law predicts the level that is off: each that seems to explain it is compared with the base.
    let truth = |x: f64, _: f64| 0.3 + 0.5 * x + if (x - 1.0 / 7.0).abs() < 0.01 { 1.2 } else { 0.0 };
    search(task(&measured(truth)), false, |query| {
        if query.model == QueriedModel::With(Vec::new()) && !query.is_proposed {
            let theta = query.theta.iter().map(|x| x.to_bits()).collect();
            *asked.borrow_mut().entry(theta).or_default() += 1;
        }
        answer(query)
    });
    // The refits begin where the base's fit ended, with the shortest differences that it asked for. Without reuse each of the eight
    // levels would ask for them again, for each law: 25 times in all.
    let highest = asked.into_inner().into_values().max();
    assert_eq!(highest, Some(2));
}

/// Searches the data on x >= 0 alone.
fn found_on_half(truth: impl Fn(f64, f64) -> f64, has_laws: bool) -> Conclusion {
    let mut task = task(&measured(truth));
    if !has_laws {
        task.laws.clear();
    }
    let half: Vec<usize> = (DATA / 2..DATA).collect();
    let (part, _) = task.likelihood.subset(&half).unwrap();
    task.likelihood = part;
    task.levels.clear();
    search(task, false, |query| {
        let all = answer(query);
        if query.is_proposed {
            all
        } else {
            all[DATA / 2..].to_vec()
        }
    })
}

#[test]
fn open_effects_are_distinguished_by_the_run_where_their_predictions_differ() {
    // On x >= 0 alone, square and cube are hard to distinguish.
    let conclusion = found_on_half(|x, _| 0.3 + 0.5 * x + 2.0 * x * x, true);
    assert!(!matches!(
        conclusion.verdict,
        SearchVerdict::NothingDetectable | SearchVerdict::NotInLibrary
    ));
    let first = conclusion.next_runs.first().expect("something is open");
    assert_eq!(first.run, 1, "{:?}", conclusion.next_runs);
    let alone = conclusion.information.iter().find(|(run, _)| *run == first.run);
    assert_eq!(alone.map(|(_, nats)| *nats), Some(first.information_nats));
    let lowest = conclusion
        .information
        .iter()
        .map(|(_, nats)| *nats)
        .fold(f64::INFINITY, f64::min);
    assert!(lowest < first.information_nats, "{:?}", conclusion.information);
    assert!(first.information_nats > 0.1 && first.separates.len() > 1);
}

#[test]
fn an_open_effect_is_compared_by_the_set_that_it_leads() {
    // The width acts beside either. The square is compared beside it, and so is the width itself; the cube leads no set but that of itself.
    let conclusion = found_on_half(
        |x, w| 0.3 + 0.5 * x + 2.0 * x * x + x * x * x + 0.3 * w * x,
        false,
    );
    let first = conclusion.next_runs.first().expect("something is open");
    let sets: Vec<Vec<usize>> = first
        .separates
        .iter()
        .map(|set| {
            let mut set = set.clone();
            set.sort_unstable();
            set
        })
        .collect();
    let expected: [&[usize]; 3] = [&[SQUARE, WIDTH], &[CUBE, WIDTH], &[CUBE]];
    assert_eq!(sets, expected);
}

#[test]
fn sets_that_a_law_leads_are_compared_by_further_runs() {
    // The law over w acts beside the square or the cube, which are hard to distinguish on x >= 0 alone.
    let conclusion = found_on_half(|x, w| 0.3 + 0.5 * x + 2.0 * x * x + 2.0 * w, true);
    let first = conclusion.next_runs.first().expect("something is open");
    let has_law = |set: &Vec<usize>| set.iter().any(|k| *k >= LIBRARY);
    assert!(
        first.separates.len() > 1 && first.separates.iter().all(has_law),
        "{:?}",
        first.separates
    );
}

#[test]
fn an_effect_of_the_model_without_evidence_is_redundant() {
    // The base has a square of its own, which the truth has or has not.
    let gain = |square: f64| {
        let mut task = task(&measured(|x, _| 0.3 + 0.5 * x + square * x * x));
        task.prior = Prior::new(vec![normal(1.0); 3]);
        task.library.remove(SQUARE);
        task.laws.clear();
        task.reductions = vec![Reduction {
            parameters: vec![0, 1],
            substitutes: Vec::new(),
        }];
        let conclusion = search(task, false, |query| {
            let value = |i: usize| {
                let t = &query.theta;
                let effect = match &query.model {
                    QueriedModel::Without(..) => 0.0,
                    QueriedModel::With(effects) => {
                        let shifted: Vec<usize> = effects.iter().map(|k| k + 1).collect();
                        let extra = shifted.first().map_or(0.0, |&k| added(k, &t[3..], x(i), w(i)));
                        t[2] * x(i) * x(i) + extra
                    }
                };
                t[0] + t[1] * x(i) + effect
            };
            if query.is_proposed {
                vec![0.0; 2]
            } else {
                (0..DATA).map(value).collect()
            }
        });
        let gain = conclusion.gains[0].unwrap();
        let redundant: Vec<usize> = conclusion.redundant().collect();
        assert_eq!(redundant, if gain < DETECTED { vec![0] } else { Vec::new() });
        gain
    };
    assert!(gain(0.8) > 20.0 && gain(0.0) < 0.0, "{} {}", gain(0.8), gain(0.0));
}

#[test]
fn the_order_within_a_round_does_not_matter() {
    let values = measured(|x, _| 0.3 + 0.5 * x + if x > 0.3 { 0.9 } else { 0.0 });
    let forwards = search(task(&values), false, answer);
    assert_eq!(forwards, search(task(&values), true, answer));
}

#[test]
fn inferred_noise_is_fitted_too() {
    let values = measured(|x, _| 0.3 + 0.5 * x + 1.0 * x * x);
    let mut task = task(&values);
    task.prior = Prior::new(vec![normal(1.0), normal(1.0), noise()]);
    let data = task.likelihood.data().iter().map(|d| Datum {
        sd: ErrorSd::Inferred { parameter: 2 },
        ..*d
    });
    task.likelihood = Likelihood::new(data.collect()).unwrap();
    let conclusion = search(task, false, |query| {
        let mut query = query.clone();
        query.theta.remove(2);
        answer(&query)
    });
    assert_eq!(conclusion.verdict, SearchVerdict::Named(SQUARE));
    assert!(
        conclusion.chi_square.is_none(),
        "the noise was inferred from the misfit"
    );
}
