//! Effects that do little alone and much together, on a model that is linear in their strengths.

use crate::setup::{self, best_effects, data, effect, normal, pair_task};
use discovery::{Candidate, Conclusion, DETECTED, QueriedModel, Query};
use statistics::rng::Stream;
use statistics::{CommonError, CommonErrorSize, Discrepancy, ErrorLaw, Likelihood};

const DATA: usize = 24;
/// The model lacks the difference of these two; either alone is nearly the same parabola, which the model has.
const WAVY: usize = 0;
const PLAIN: usize = 1;
/// Number of steps in the data.
const STEPS: usize = 3;

fn x(i: usize) -> f64 {
    i as f64 / (DATA - 1) as f64 * 2.0 - 1.0
}

/// The change at x by a unit of a candidate's strength; candidates beyond the two are steps that explain a little each.
fn added(wave: f64, k: usize, x: f64) -> f64 {
    let parabola = x * x - 0.36;
    match k {
        WAVY => parabola + wave * libm::sin(9.0 * x),
        PLAIN => parabola,
        // The steps after the third repeat these.
        step => f64::from(u8::from(x > 0.4 * ((step - 2) % STEPS) as f64 - 0.4)),
    }
}

fn library(steps: usize) -> Vec<Candidate> {
    let candidate = |k: usize| effect(&k.to_string(), normal(1.0));
    (0..2 + steps).map(candidate).collect()
}

fn predict(wave: f64, query: &Query) -> Vec<f64> {
    let QueriedModel::With(effects) = &query.model else {
        panic!("nothing is dropped");
    };
    let theta = &query.theta;
    let at = |i: usize| {
        let strengths = effects.iter().zip(&theta[2..]);
        theta[0] + theta[1] * x(i) + strengths.map(|(&k, s)| s * added(wave, k, x(i))).sum::<f64>()
    };
    (0..DATA).map(at).collect()
}

/// Searches data of both effects at opposite strengths, and of the three steps.
fn conclude(wave: f64, sd: f64, has_discrepancy: bool) -> Conclusion {
    found_in(library(STEPS), wave, sd, has_discrepancy)
}

fn found_in(library: Vec<Candidate>, wave: f64, sd: f64, has_discrepancy: bool) -> Conclusion {
    let noise = Stream::new(11, 0, 0, 0).normals(DATA);
    let truth = |i: usize| {
        let steps: f64 = (2..2 + STEPS).map(|k| 2.5 * sd * added(wave, k, x(i))).sum();
        0.3 + 0.5 * x(i) + 2.5 * (added(wave, WAVY, x(i)) - added(wave, PLAIN, x(i))) + steps
    };
    let values: Vec<f64> = (0..DATA).map(|run| truth(run) + sd * noise[run]).collect();
    let each = |i: usize| CommonError {
        data: vec![i],
        size: CommonErrorSize::Discrepancy { group: 0 },
    };
    let (common, discrepancy) = if has_discrepancy {
        ((0..DATA).map(each).collect(), Discrepancy::Unknown)
    } else {
        (Vec::new(), Discrepancy::None)
    };
    let likelihood =
        Likelihood::with_common(data(&values, sd), ErrorLaw::Gaussian, common, vec![discrepancy]).unwrap();
    let task = pair_task(vec![normal(1.0), normal(1.0)], likelihood, library);
    setup::conclude(task, false, |query| Some(predict(wave, query)))
}

#[test]
fn two_effects_that_do_little_alone_are_found_together() {
    let conclusion = conclude(0.15, 0.1, false);
    for k in [WAVY, PLAIN] {
        let alone = conclusion.ranking.effect(Some(k)).unwrap().log_bayes_factor;
        assert!(alone < DETECTED, "{k}: {alone}");
    }
    assert_eq!(best_effects(&conclusion), [WAVY, PLAIN]);
}

#[test]
fn an_unknown_discrepancy_does_not_hide_what_two_effects_explain() {
    // Alone, one effect absorbs nothing, little, or much of the discrepancy.
    for wave in [0.15, 0.5, 0.8] {
        assert_eq!(best_effects(&conclude(wave, 0.01, true)), [WAVY, PLAIN], "{wave}");
    }
}

#[test]
fn a_family_is_found_where_others_seem_better() {
    // Copies of the steps crowd the two out of the beam.
    let mut library = library(4 * STEPS);
    assert_ne!(
        best_effects(&found_in(library.clone(), 0.15, 0.1, false)),
        [WAVY, PLAIN]
    );
    for k in [WAVY, PLAIN] {
        library[k].family = Some("parabola".into());
    }
    assert_eq!(best_effects(&found_in(library, 0.15, 0.1, false)), [WAVY, PLAIN]);
}
