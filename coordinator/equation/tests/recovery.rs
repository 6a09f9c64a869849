//! The law of a curve is found, and what cannot be told is said.

use equation::{Answer, End, FormulaLibrary, Host, Link, fits, search};

use crate::setup::{LIBRARY, answer, curve};

#[test]
fn a_saturating_addition_is_found() {
    let curve = curve(Host::Addition, 0.01, |x| 3.0 * (1.0 - (-x / 0.3).exp()));
    let (answer, simplest) = answer(&curve);
    assert_eq!(simplest, "(1 - exp(c * x))");
    assert!(answer.classes[0].probability > 0.9, "{:?}", answer.classes[0]);
}

#[test]
fn a_factor_with_an_inverse_power_is_found() {
    let curve = curve(Host::Factor, 0.01, |x| -0.6 * (1.0 + x / 0.2).ln());
    let (_, simplest) = answer(&curve);
    assert_eq!(simplest, "log((1 + c * x))");
}

#[test]
fn a_curve_that_is_hardly_known_has_no_certain_formula() {
    let curve = curve(Host::Addition, 0.3, |x| 1.0 - (-x / 0.3).exp());
    let (answer, _) = answer(&curve);
    assert!(answer.classes[0].probability < 0.9, "{:?}", answer.classes[0]);
    let sum: f64 = answer.classes.iter().map(|class| class.probability).sum();
    assert!((sum - 1.0).abs() < 1e-9);
}

#[test]
fn a_factor_that_would_be_negative_in_the_range_is_no_answer() {
    let curve = curve(Host::Factor, 0.02, |x| (1.0 - 0.9 * x).ln());
    let (answer, _) = answer(&curve);
    let mut laws = answer.formulas.iter().map(|formula| formula.law(&curve, 0.999));
    assert!(laws.all(|law| law > 0.0));
}

#[test]
fn the_order_of_the_fits_does_not_count() {
    let curve = curve(Host::Addition, 0.05, |x| x / (x + 0.2));
    let formulas = 0..LIBRARY.formulas().count();
    let backwards = formulas.rev().flat_map(|formula| fits(&curve, &LIBRARY, formula));
    let bits = |answer: &Answer| -> Vec<u64> {
        let formulas = answer.formulas.iter();
        formulas.map(|formula| formula.probability.to_bits()).collect()
    };
    let (one_way, backwards) = (answer(&curve).0, equation::answer(&curve, backwards));
    assert_eq!(bits(&one_way), bits(&backwards));
}

/// The formula of a correction that vanishes at 0, with its fit.
fn correction(link: Link, law: impl Fn(f64) -> f64) -> (String, usize, f64) {
    let library = FormulaLibrary::of_corrections(6, link);
    let curve = curve(Host::Addition, 0.01, law);
    let answer = search(&curve, &library);
    let best = &answer.formulas[answer.simplest(&answer.classes[0])];
    (best.tree.to_string(), best.parameters(), best.law(&curve, 1e-5))
}

#[test]
fn corrections_that_vanish_at_an_end_are_found() {
    let vanishing = Link::Vanishing(End::Zero);
    let (formula, parameters, at_end) = correction(vanishing, |x| 2.0 * ((-x / 0.4).exp() - 1.0));
    assert_eq!((formula.as_str(), parameters), ("exp(c * x)", 2));
    assert!(at_end.abs() < 1e-3, "{at_end}");
    let normalised = Link::Normalised(End::Zero);
    let (formula, parameters, at_end) = correction(normalised, |x| (x / 0.3).sin() / (x / 0.3) - 1.0);
    assert_eq!((formula.as_str(), parameters), ("sin(c * x) / (x)", 1));
    assert!(at_end.abs() < 1e-3, "{at_end}");
}
