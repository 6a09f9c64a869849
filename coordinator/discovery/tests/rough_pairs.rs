//! Two missing effects of a rough model without a low-fidelity model, whose evaluations are expensive.

use std::cell::Cell;

use crate::setup::{self, data, effect, normal};
use discovery::{ProposedRuns, QueriedModel, SearchSettings, SearchTask, Smoothness};
use statistics::rng::Stream;
use statistics::{Likelihood, Prior};

const DATA: usize = 48;
const LIBRARY: usize = 30;
const SD: f64 = 0.2;
const SCATTER: f64 = 0.03;
/// The missing effects with their strengths.
const TRUTH: [(usize, f64); 2] = [(4, 1.4), (17, -1.1)];

/// The change at a datum by a unit of an effect's strength.
fn change(k: usize, i: usize) -> f64 {
    let x = i as f64 / (DATA - 1) as f64;
    libm::cos((2.0 + 1.3 * k as f64) * x + k as f64)
}

#[test]
fn beyond_a_combination_the_model_is_asked_for_the_best_candidates_alone() {
    let noise = Stream::new(5, 0, 0, 0).normals(DATA);
    let measured = |i: usize| {
        let changes = TRUTH.iter().map(|(k, strength)| strength * change(*k, i));
        0.5 + changes.sum::<f64>() + SD * noise[i]
    };
    let values: Vec<f64> = (0..DATA).map(measured).collect();
    let task = SearchTask {
        prior: Prior::new(vec![normal(1.0)]),
        likelihood: Likelihood::new(data(&values, SD)).unwrap(),
        library: (0..LIBRARY)
            .map(|k| effect(&k.to_string(), normal(1.0)))
            .collect(),
        laws: Vec::new(),
        strengths: Vec::new(),
        reductions: Vec::new(),
        levels: Vec::new(),
        conditions: Vec::new(),
        proposed: ProposedRuns::default(),
        suspected_errors: Vec::new(),
        max_effects: 2,
        settings: SearchSettings {
            smoothness: Smoothness::Rough,
            has_numerical_noise: true,
            ..SearchSettings::default()
        },
    };
    let of_pairs = Cell::new(0);
    let conclusion = setup::conclude(task, false, |query| {
        let QueriedModel::With(effects) = &query.model else {
            panic!("nothing is dropped");
        };
        of_pairs.set(of_pairs.get() + usize::from(effects.len() == 2));
        let theta = &query.theta;
        let key = theta
            .iter()
            .fold(0, |key: u64, t| key.rotate_left(7) ^ t.to_bits());
        let jumps = Stream::new(3, 0, key, 0).normals(DATA);
        let predicted = |i: usize| {
            let changes = effects.iter().zip(&theta[1..]);
            // An effect saturates, so that its change beyond a combination is not quite that beyond the base.
            let strength = |strength: &f64| strength / (1.0 + 0.05 * strength * strength);
            let changes = changes.map(|(&k, s)| strength(s) * change(k, i));
            theta[0] + changes.sum::<f64>() + SCATTER * jumps[i]
        };
        Some((0..DATA).map(predicted).collect())
    });
    let mut effects = conclusion.combination.clone();
    effects.sort_unstable();
    assert_eq!(effects, TRUTH.map(|(k, _)| k));
    // The screens of two strengths beyond three combinations alone would cost 174.
    let asked = of_pairs.get();
    assert!((10..150).contains(&asked), "{asked} evaluations of pairs");
}
