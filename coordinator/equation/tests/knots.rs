//! Curves of few knots, and curves that cannot be searched.

use equation::{CurveError, Host, LocatedCurve, search};

use crate::setup::LIBRARY;

#[test]
fn a_law_that_bends_between_knots_is_found() {
    // The piecewise linear curve that is nearest to the law misses it by 8 sds at its first knot.
    let law = |x: f64| 1.0 - (-x / 0.15).exp();
    let knots: Vec<f64> = (0..5).map(|k| 0.02 + 0.245 * f64::from(k)).collect();
    let nearest = [0.2018, 0.884, 0.9678, 0.996, 0.9985];
    let mut covariance = [0.0; 25];
    (0..5).for_each(|k| covariance[6 * k] = 1e-4);
    let curve = LocatedCurve::of_knots(Host::Addition, &knots, &nearest, &covariance, false).unwrap();
    let answer = search(&curve, &LIBRARY);
    let by_text = |text: &str| {
        answer
            .formulas
            .iter()
            .find(|formula| formula.tree.to_string() == text)
            .unwrap()
    };
    let found = by_text("(1 - exp(c * x))");
    assert!(found.misfit < 2.0, "{}", found.misfit);
    assert!(
        (found.law(&curve, 0.3) - law(0.3)).abs() < 0.02,
        "{}",
        found.law(&curve, 0.3)
    );
    assert!((knots[0] - curve.range()[0]).abs() < 1e-12);
}

#[test]
fn a_curve_that_cannot_be_searched_is_refused() {
    let curve = |points: &[f64], covariance: &[f64]| {
        LocatedCurve::new(Host::Addition, points, &[1.0; 3], covariance)
            .map(|_| ())
            .unwrap_err()
    };
    let unit = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(curve(&[0.1, 0.1, 0.2], &unit), CurveError::Point { index: 1 });
    assert_eq!(
        curve(&[0.1, 0.2, f64::NAN], &unit),
        CurveError::Point { index: 2 }
    );
    assert_eq!(curve(&[0.1, 0.2, 0.3], &[1.0; 9]), CurveError::Covariance);
    assert!(matches!(
        curve(&[0.1, 0.2], &unit),
        CurveError::Lengths { points: 2, .. }
    ));
}
