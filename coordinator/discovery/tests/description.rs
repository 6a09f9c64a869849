//! Laws beside others that explain the data nearly as well: of another variable, and of the physics beside those of a measured channel.

use crate::search::{DATA, LIBRARY, added, measured, task, w, x};
use crate::setup::{conclude, marginal, normal};
use discovery::{Candidate, Conclusion, QueriedModel, Query};
use statistics::Distribution;

/// Size of the hidden step over x.
const STEP: f64 = 2.5;
/// The form of the second law: a step over x that also bends over w.
const BENT_STEP: usize = LIBRARY + 3;
/// Number of parameters of each candidate after the library: curve and step over x, curve and bent step.
const LENGTHS: [usize; 4] = [5, 2, 5, 2];

/// Predicts the data of a query.
///
/// # Arguments
/// - `bend`: change over w by the bent step, as a share of the step.
fn answer(query: &Query, bend: f64) -> Vec<f64> {
    let QueriedModel::With(effects) = &query.model else {
        panic!("nothing is dropped");
    };
    let at = |x: f64, w: f64| {
        let mut value = query.theta[0] + query.theta[1] * x;
        let mut parameters = &query.theta[2..];
        for &k in effects {
            value += match k {
                BENT_STEP => parameters[0] * (f64::from(u8::from(x > parameters[1])) + bend * w),
                _ => added(k, parameters, x, w),
            };
            parameters = &parameters[k.checked_sub(LIBRARY).map_or(1, |law| LENGTHS[law])..];
        }
        value
    };
    match query.is_proposed {
        true => vec![at(0.0, 0.0), at(2.0, 0.0)],
        false => (0..DATA).map(|i| at(x(i), w(i))).collect(),
    }
}

/// Searches a step over x with a law that has it, and another law whose step bends over w.
///
/// # Arguments
/// - `quantities`: what both laws change; laws without a quantity contradict each other.
fn find_with(quantities: &[&str], is_description: bool, bend: f64) -> Conclusion {
    let step = |x: f64| if x > 0.3 { STEP } else { 0.0 };
    let mut task = task(&measured(|x, _| 0.3 + 0.5 * x + step(x)));
    let threshold = marginal(Distribution::Uniform {
        lower: -1.0,
        upper: 1.0,
    });
    for law in &mut task.laws {
        law.curve.quantities = quantities.iter().map(ToString::to_string).collect();
    }
    task.laws[0].is_description = is_description;
    task.laws[1].forms = vec![Candidate::new("bent step", vec![normal(1.0), threshold], vec![0])];
    conclude(task, false, |query| Some(answer(query, bend)))
}

fn find(is_description: bool, bend: f64) -> Conclusion {
    find_with(&[], is_description, bend)
}

#[test]
fn laws_of_one_quantity_that_fit_alike_are_possible_places() {
    let places = |bend: f64| find_with(&["shear"], false, bend).outside.unwrap().places;
    let alike = places(0.0);
    let sum: f64 = alike.iter().map(|(_, probability)| probability).sum();
    assert!(alike.len() == 2 && (sum - 1.0).abs() < 1e-9, "{alike:?}");
    assert!(
        alike
            .iter()
            .all(|(_, probability)| (probability - 0.5).abs() < 0.1),
        "{alike:?}"
    );
    let told = places(0.1);
    assert!(told.len() == 1 && told[0].0 == 0 && told[0].1 > 0.95, "{told:?}");
}

#[test]
fn a_law_of_a_channel_is_claimed_only_where_no_law_of_a_stress_comes_near() {
    let claimed = |conclusion: Conclusion| conclusion.outside.map(|law| law.law);
    // The bend costs about 6 nats, and then 50.
    assert_eq!(claimed(find(false, 0.035)), Some(0));
    assert_eq!(claimed(find(true, 0.035)), None);
    assert_eq!(claimed(find(true, 0.1)), Some(0));
    // Without a bend both fit alike, and the law of a stress has higher prior odds.
    assert_eq!(claimed(find(true, 0.0)), Some(1));
}
