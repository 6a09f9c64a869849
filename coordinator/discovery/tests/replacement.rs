//! Replacements of an effect that the base has by a better one, on linear models.

use discovery::{Conclusion, QueriedModel, Query, Reduction, SearchTask, SearchVerdict};
use statistics::Prior;

use crate::search::{DATA, LIBRARY, SQUARE, added, measured, task, w, x};
use crate::setup::{conclude, normal};

/// The change that the effect of the base makes: it resembles the square.
fn wrong(x: f64, w: f64) -> f64 {
    x * x + 0.4 * w * w
}

pub(crate) fn answer(query: &Query) -> Vec<f64> {
    let (effects, base) = match &query.model {
        QueriedModel::With(effects) => (effects, 3),
        QueriedModel::Without(_, effects) => (effects, 2),
    };
    let predict = |x: f64, w: f64| {
        let (own, further) = query.theta.split_at(base);
        let of_base = own.get(2).map_or(0.0, |strength| strength * wrong(x, w));
        let changes = effects.iter().zip(further);
        let change = changes.map(|(&k, strength)| added(k, &[*strength], x, w));
        own[0] + own[1] * x + of_base + change.sum::<f64>()
    };
    match query.is_proposed {
        true => [0.0, 2.0].map(|x| predict(x, 0.0)).to_vec(),
        false => (0..DATA).map(|i| predict(x(i), w(i))).collect(),
    }
}

/// Returns the search beyond a base that has the wrong effect.
pub(crate) fn wrong_base(truth: impl Fn(f64, f64) -> f64, substitutes: Vec<usize>) -> SearchTask {
    let mut task = task(&measured(truth));
    task.prior = Prior::new(vec![normal(1.0); 3]);
    task.laws.clear();
    task.reductions = vec![Reduction {
        parameters: vec![0, 1],
        substitutes,
    }];
    task
}

/// Searches beyond a base that has the wrong effect.
fn find(truth: impl Fn(f64, f64) -> f64, substitutes: Vec<usize>) -> Conclusion {
    conclude(wrong_base(truth, substitutes), false, |query| Some(answer(query)))
}

#[test]
fn a_better_effect_takes_the_place_of_one_that_was_added_wrongly() {
    let truth = |x: f64, _: f64| 0.3 + 0.5 * x + 0.9 * x * x;
    let conclusion = find(truth, (0..LIBRARY).collect());
    let claimed = conclusion.claimed_replacement();
    let claimed = claimed.unwrap_or_else(|| panic!("{:?}", conclusion.replacements));
    assert_eq!((claimed.reduction, claimed.candidate), (0, SQUARE));
    assert_eq!(conclusion.verdict, SearchVerdict::Named(SQUARE));
    // The stated chi-square is that of the replacement, which has as many parameters as the base.
    let (base, best) = (
        conclusion.chi_square.unwrap(),
        conclusion.chi_square_best.unwrap(),
    );
    assert!(best.value < base.value && conclusion.complete == Some(true));
    assert!(
        (best.degrees_of_freedom - base.degrees_of_freedom).abs() < 0.1,
        "{best:?} {base:?}"
    );
    assert!(
        claimed.log_bayes_factor > 10.0 && claimed.probability > 0.9,
        "{claimed:?}"
    );
    // The model may not have the square without its own effect.
    assert!(find(truth, Vec::new()).replacements.is_empty());
}

#[test]
fn an_effect_that_acts_beside_another_is_not_replaced() {
    let truth = |x: f64, w: f64| 0.3 + 0.5 * x + 0.9 * wrong(x, w) + 0.8 * x * x;
    let conclusion = find(truth, (0..LIBRARY).collect());
    assert_eq!(conclusion.verdict, SearchVerdict::Named(SQUARE));
    assert!(conclusion.claimed_replacement().is_none());
    assert!(
        conclusion.replacements[0].probability < 0.01,
        "{:?}",
        conclusion.replacements
    );
}

#[test]
fn where_nothing_more_is_missing_nothing_is_replaced() {
    let truth = |x: f64, w: f64| 0.3 + 0.5 * x + 0.9 * wrong(x, w);
    let conclusion = find(truth, (0..LIBRARY).collect());
    assert_eq!(conclusion.verdict, SearchVerdict::NothingDetectable);
    assert!(conclusion.replacements.is_empty());
}
