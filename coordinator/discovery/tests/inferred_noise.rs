//! Claims on noise that is inferred with the misfit.

use discovery::{Conclusion, Query, SearchTask, SearchVerdict};
use statistics::{Datum, ErrorSd, Likelihood, Prior};

use super::search::{SQUARE, answer, measured, task};
use super::setup::{self, noise, normal};

/// The parameter of the base that is the inferred sd.
const NOISE: usize = 2;

/// The search for a square on every second datum, 12 in all.
///
/// # Arguments
/// - `is_known`: whether the sd of a datum, by its number among the twelve, is declared. `conditions`: the data of each condition.
fn conclude(is_known: impl Fn(usize) -> bool, conditions: Vec<Vec<usize>>) -> Conclusion {
    let values = measured(|x, _| 0.3 + 0.5 * x + 1.6 * x * x);
    let whole = task(&values);
    let kept = || (0..values.len()).step_by(2);
    let data = kept().enumerate().map(|(place, i)| Datum {
        sd: match is_known(place) {
            true => whole.likelihood.data()[i].sd,
            false => ErrorSd::Inferred { parameter: NOISE },
        },
        ..whole.likelihood.data()[i]
    });
    let task = SearchTask {
        prior: Prior::new(vec![normal(1.0), normal(1.0), noise()]),
        likelihood: Likelihood::new(data.collect()).unwrap(),
        levels: Vec::new(),
        conditions,
        ..whole
    };
    setup::conclude(task, false, |query| {
        let mut model = query.clone();
        model.theta.remove(NOISE);
        let values = answer(&model);
        Some(match query {
            Query {
                is_proposed: true, ..
            } => values,
            _ => kept().map(|i| values[i]).collect(),
        })
    })
}

#[test]
fn an_effect_is_named_on_inferred_noise_only_with_data_or_repeats_enough() {
    // Twelve data less three fitted parameters leave the sd uncertain by 24 %.
    let alone: Vec<Vec<usize>> = (0..12).map(|place| vec![place]).collect();
    let few = conclude(|_| false, alone.clone());
    assert_eq!(few.verdict, SearchVerdict::Undecided);
    assert_eq!(few.unsupported_noise, [NOISE]);
    assert_eq!(few.agreed, None);
    assert!(
        few.sets[0].effects.as_deref() == Some(&[SQUARE][..]),
        "{:?}",
        few.sets
    );
    // Three repeats show the noise by themselves, two do not.
    let repeated = |count: usize| {
        let mut conditions = alone.clone();
        for place in 0..count {
            conditions[place] = vec![place, 11 - place];
            conditions[11 - place].clear();
        }
        conclude(|_| false, conditions)
    };
    assert_eq!(repeated(2).verdict, SearchVerdict::Undecided);
    let named = repeated(3);
    assert_eq!(named.verdict, SearchVerdict::Named(SQUARE));
    assert!(named.unsupported_noise.is_empty());
}

#[test]
fn data_of_declared_noise_support_what_they_show_by_themselves() {
    let alone: Vec<Vec<usize>> = (0..12).map(|place| vec![place]).collect();
    let half = conclude(|place| place % 2 == 0, alone.clone());
    assert_eq!(half.verdict, SearchVerdict::Named(SQUARE));
    // In the middle of the range a square is nearly constant, so declared noise there shows nothing of it.
    let middle = conclude(|place| place == 5 || place == 6, alone);
    assert_eq!(middle.verdict, SearchVerdict::Undecided);
    assert_eq!(middle.unsupported_noise, [NOISE]);
}
