//! Which candidates are asked for beyond one of two missing effects.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use crate::setup::{self, best_effects, data, effect, normal, pair_task};
use discovery::{QueriedModel, Smoothness};
use statistics::Likelihood;
use statistics::rng::Stream;

const DATA: usize = 48;
const SD: f64 = 0.2;
/// Scatter of a rough model.
const SCATTER: f64 = 0.03;
/// The missing effects with their strengths.
const TRUTH: [(usize, f64); 2] = [(4, 1.4), (17, -1.1)];

/// A search, as it ended.
struct Searched {
    /// The effects of the best combination, in order.
    effects: Vec<usize>,
    /// The pair of each evaluation of two effects; the second was searched beyond the first.
    pairs: Vec<[usize; 2]>,
}

/// The change at a datum by a unit of an effect's strength.
fn change(k: usize, i: usize) -> f64 {
    let x = i as f64 / (DATA - 1) as f64;
    libm::cos((2.0 + 1.3 * k as f64) * x + k as f64)
}

/// Searches a library of this many effects.
fn search(library: usize, smoothness: Smoothness) -> Searched {
    let is_rough = smoothness == Smoothness::Rough;
    let noise = Stream::new(5, 0, 0, 0).normals(DATA);
    let measured = |i: usize| {
        let changes = TRUTH.iter().map(|(k, strength)| strength * change(*k, i));
        0.5 + changes.sum::<f64>() + SD * noise[i]
    };
    let values: Vec<f64> = (0..DATA).map(measured).collect();
    let library = (0..library)
        .map(|k| effect(&k.to_string(), normal(1.0)))
        .collect();
    let likelihood = Likelihood::new(data(&values, SD)).unwrap();
    let mut task = pair_task(vec![normal(1.0)], likelihood, library);
    task.settings.smoothness = smoothness;
    task.settings.has_numerical_noise = is_rough;
    let pairs = RefCell::new(Vec::new());
    let conclusion = setup::conclude(task, false, |query| {
        let QueriedModel::With(effects) = &query.model else {
            panic!("nothing is dropped");
        };
        if let [first, second] = effects[..] {
            pairs.borrow_mut().push([first, second]);
        }
        let theta = &query.theta;
        let key = theta
            .iter()
            .fold(0, |key: u64, t| key.rotate_left(7) ^ t.to_bits());
        let jumps = Stream::new(3, 0, key, 0).normals(DATA);
        let scatter = if is_rough { SCATTER } else { 0.0 };
        let predicted = |i: usize| {
            let changes = effects.iter().zip(&theta[1..]);
            // An effect saturates, so that its change beyond a combination is not quite that beyond the base.
            let strength = |strength: &f64| strength / (1.0 + 0.05 * strength * strength);
            let changes = changes.map(|(&k, s)| strength(s) * change(k, i));
            theta[0] + changes.sum::<f64>() + scatter * jumps[i]
        };
        Some((0..DATA).map(predicted).collect())
    });
    Searched {
        effects: best_effects(&conclusion),
        pairs: pairs.into_inner(),
    }
}

#[test]
fn of_a_rough_model_the_best_candidates_alone_are_evaluated() {
    let Searched { effects, pairs } = search(30, Smoothness::Rough);
    assert_eq!(effects, TRUTH.map(|(k, _)| k));
    let of_pairs = pairs.len();
    // The screens of two strengths beyond three combinations alone would cost 174.
    assert!((10..150).contains(&of_pairs), "{of_pairs} evaluations of pairs");
}

#[test]
fn of_a_large_library_the_most_promising_candidates_alone_are_evaluated() {
    let Searched { effects, pairs } = search(90, Smoothness::Smooth);
    assert_eq!(effects, TRUTH.map(|(k, _)| k));
    let mut beyond: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for [first, second] in pairs {
        beyond.entry(first).or_default().insert(second);
    }
    let counts: Vec<usize> = beyond.values().map(BTreeSet::len).collect();
    assert_eq!(counts.iter().max(), Some(&48), "{counts:?}");
}
