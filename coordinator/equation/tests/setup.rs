//! Curves of known laws.

use std::sync::LazyLock;

use equation::{Answer, FormulaLibrary, Host, LocatedCurve, search};

/// The formulas of a variable with a unit.
pub(crate) static LIBRARY: LazyLock<FormulaLibrary> = LazyLock::new(|| FormulaLibrary::new(7, false));

/// A curve of 25 points from 0.04 to 1, with errors of both signs whose root mean square is the sd.
pub(crate) fn curve(host: Host, sd: f64, law: impl Fn(f64) -> f64) -> LocatedCurve {
    let points: Vec<f64> = (1..=25).map(|i| 0.04 * f64::from(i)).collect();
    // An irrational rotation leaves no trend in the errors.
    let error = |i: usize| sd * std::f64::consts::SQRT_2 * (2.399_963 * (i * i) as f64).sin();
    let values: Vec<f64> = points
        .iter()
        .enumerate()
        .map(|(i, x)| law(*x) + error(i))
        .collect();
    let mut covariance = vec![0.0; 625];
    (0..25).for_each(|i| covariance[26 * i] = sd * sd);
    LocatedCurve::new(host, &points, &values, &covariance).unwrap()
}

/// The answer, with the structure of the simplest member of its best class.
pub(crate) fn answer(curve: &LocatedCurve) -> (Answer, String) {
    let answer = search(curve, &LIBRARY);
    let simplest = answer.formulas[answer.simplest(&answer.classes[0])]
        .tree
        .to_string();
    (answer, simplest)
}
