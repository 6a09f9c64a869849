//! Exchanges of effects of one class, on a model that scatters.

use discovery::{Conclusion, QueriedModel, Query, SearchSettings, Smoothness};
use statistics::rng::Stream;

use crate::search::{CONSTANT, SQUARE, WIDTH, answer, measured, task};
use crate::setup;

/// The width again, in place of the constant.
const TWIN: usize = CONSTANT;
const SCATTER: f64 = 0.03;

/// The model refuses square and twin together far from the truth, so that no step of a search leads there.
fn refused(effects: &[usize], theta: &[f64]) -> bool {
    let strength = |candidate: usize| Some(theta[2 + effects.iter().position(|k| *k == candidate)?]);
    let pair = strength(SQUARE).zip(strength(TWIN));
    pair.is_some_and(|(square, twin)| !(0.55..0.97).contains(&square) || !(0.5..0.95).contains(&twin))
}

fn conclude(scatter: f64) -> Conclusion {
    let mut task = task(&measured(|x, w| 0.3 + 0.8 * x * x + 0.7 * w * x));
    task.laws = Vec::new();
    task.library[TWIN].name = "twin".into();
    task.settings = SearchSettings {
        smoothness: Smoothness::Rough,
        has_numerical_noise: true,
        ..SearchSettings::default()
    };
    setup::conclude(task, false, |query| {
        let QueriedModel::With(effects) = &query.model else {
            return None;
        };
        let as_width = effects.iter().map(|&k| if k == TWIN { WIDTH } else { k });
        let alike = Query {
            model: QueriedModel::With(as_width.collect()),
            ..query.clone()
        };
        let key = query
            .theta
            .iter()
            .fold(0, |key: u64, t| key.rotate_left(7) ^ t.to_bits());
        let values = answer(&alike);
        let jumps = Stream::new(3, 0, key, 0).normals(values.len());
        let jumping = values
            .iter()
            .zip(jumps)
            .map(|(value, jump)| value + scatter * jump);
        (!refused(effects, &query.theta)).then(|| jumping.collect())
    })
}

#[test]
fn an_effect_of_the_best_set_s_class_is_fitted_in_its_place() {
    let nats = |conclusion: &Conclusion, pair: [usize; 2]| {
        let mut sets = conclusion.sets.iter();
        let is_pair = |effects: &Vec<usize>| effects.len() == 2 && pair.iter().all(|k| effects.contains(k));
        let set = sets.find(|set| set.effects.as_ref().is_some_and(is_pair));
        set.map(|set| set.log_bayes_factor)
    };
    let rough = conclude(SCATTER);
    let [best, twin] = [WIDTH, TWIN].map(|k| nats(&rough, [SQUARE, k]).unwrap());
    assert!((best - twin).abs() < 5.0, "{best} and {twin}");
    // A model without numerical noise needs no exchanges.
    let smooth = conclude(0.0);
    assert!(nats(&smooth, [SQUARE, WIDTH]).is_some());
    assert_eq!(nats(&smooth, [SQUARE, TWIN]), None);
}
