//! The enumeration.

use std::collections::BTreeSet;

use equation::{End, FormulaLibrary, Link};

use crate::setup::LIBRARY;

fn texts(library: &FormulaLibrary) -> BTreeSet<String> {
    library.formulas().map(ToString::to_string).collect()
}

#[test]
fn families_are_listed_once() {
    let texts = texts(&LIBRARY);
    assert_eq!(texts.len(), LIBRARY.counts().iter().sum::<usize>());
    for listed in [
        "x",
        "(x)^c",
        "exp(c * x)",
        "(1 - exp(c * x))",
        "tanh(c * x)",
        "x / ((c + x))",
        "exp(c * ((c + x))^2)",
        "if(x > c, 1, 0)",
    ] {
        assert!(texts.contains(listed), "{listed}");
    }
    // A constant factor is the strength, log(c x^c) = c + c log x, exp(c + x) has a factor, and constants have either sign.
    for redundant in [
        "c * x",
        "log((x)^c)",
        "exp((c + c * x))",
        "((x)^c)^c",
        "(c * x)^c",
        "exp(if(x > c, 1, 0))",
        "(1 + if(x > c, 1, 0))",
        "x / ((c - x))",
    ] {
        assert!(!texts.contains(redundant), "{redundant}");
    }
}

#[test]
fn a_variable_with_a_unit_enters_no_function_without_a_scale() {
    let with_unit = texts(&LIBRARY);
    let pure = texts(&FormulaLibrary::new(7, true));
    for text in ["exp(x)", "(1 + x)", "x / ((1 - x))", "tanh(x)"] {
        assert!(!with_unit.contains(text) && pure.contains(text), "{text}");
    }
    assert!(with_unit.is_subset(&pure));
}

#[test]
fn laws_of_a_variable_with_a_unit_have_no_sine() {
    assert_eq!(LIBRARY.formulas().count(), 1284);
    assert!(!texts(&LIBRARY).iter().any(|text| text.contains("sin(")));
}

#[test]
fn corrections_vanish_at_their_end() {
    let at_zero = FormulaLibrary::of_corrections(6, Link::Vanishing(End::Zero));
    let listed = texts(&at_zero);
    for text in ["x", "(x)^c", "exp(c * x)", "log((1 + c * x))", "sin(c * x) / (x)"] {
        assert!(listed.contains(text), "{text}");
    }
    // The value at the end is taken off, log x has none, and a summand changes nothing.
    for text in ["(1 - exp(c * x))", "log(x)", "(c + exp(c * x))"] {
        assert!(!listed.contains(text), "{text}");
    }
    let to_infinity = texts(&FormulaLibrary::of_corrections(
        6,
        Link::Normalised(End::Infinity),
    ));
    assert!(!to_infinity.contains("x") && !to_infinity.contains("exp(c * x)"));
    assert!(to_infinity.contains("exp(c / (x))"));
}
