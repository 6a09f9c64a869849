//! Formulas as text.

use equation::{End, FormulaLibrary, FormulaText, Host, Link, ParameterKind, fits, ranked, search};
use formula::expression::Expression;
use formula::unit::Unit;

use crate::setup::{LIBRARY, answer, curve};

#[test]
fn a_formula_gives_the_law_that_was_fitted() {
    for (host, quantity, neutral) in [(Host::Addition, "N", 0.0), (Host::Factor, "Pa", 1.0)] {
        let curve = curve(host, 0.05, |x| 0.8 * x / (x + 0.3));
        for formula in &answer(&curve).0.formulas[..200] {
            let text = FormulaText::new(&curve, formula, "q", "x");
            let unit = |kind: ParameterKind| match (kind, host) {
                (ParameterKind::Strength, Host::Addition) => quantity,
                (ParameterKind::Scale | ParameterKind::Shift | ParameterKind::Threshold, _) => "m",
                _ => "1",
            };
            let parameters = text.parameters.iter().map(|p| (p.name.clone(), unit(p.kind)));
            let names = [("q".to_owned(), quantity), ("x".to_owned(), "m")]
                .into_iter()
                .chain(parameters);
            let names: Vec<(String, Unit)> = names
                .map(|(name, unit)| (name, Unit::parse(unit).unwrap()))
                .collect();
            let read =
                Expression::read(&text.formula, &names).unwrap_or_else(|e| panic!("{}: {e}", text.formula));
            for at in [0.05, 0.4, 0.9] {
                let mut values = vec![neutral, at];
                values.extend(text.parameters.iter().map(|parameter| parameter.value));
                let (found, expected) = (read.value(&values), formula.law(&curve, at));
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{} at {at}: {found}, {expected}",
                    text.formula
                );
            }
        }
    }
}

#[test]
fn parameters_determine_a_formula() {
    for host in [Host::Addition, Host::Factor] {
        let mut checked = 0;
        let curve = curve(host, 0.05, |x| 0.8 * x / (x + 0.3));
        let count = LIBRARY.formulas().count();
        let fits = (0..count).flat_map(|formula| fits(&curve, &LIBRARY, formula));
        for fit in &ranked(fits)[..200] {
            let text = FormulaText::new(&curve, fit.formula(), "q", "x");
            // Another strength and other constants than the fitted ones, near them.
            let parameters = text.parameters.iter().map(|parameter| 1.02 * parameter.value);
            let parameters: Vec<f64> = parameters.collect();
            let Some(refitted) = fit.refitted(&curve, &parameters, -1.0, 0.0) else {
                continue;
            };
            checked += 1;
            let written = FormulaText::new(&curve, refitted.formula(), "q", "x");
            assert_eq!(written.formula, text.formula);
            for (parameter, expected) in written.parameters.iter().zip(parameters) {
                assert!(
                    (parameter.value - expected).abs() < 1e-9 * expected.abs(),
                    "{}: {parameter:?} {expected}",
                    text.formula
                );
            }
        }
        assert!(checked > 150, "{checked}");
    }
}

#[test]
fn the_magnitude_of_the_variable_cancels_in_a_ratio() {
    let curve = curve(Host::Addition, 0.05, |x| 0.8 * x / (x + 0.3));
    let answer = answer(&curve).0;
    let formulas = answer.formulas.iter();
    let mut texts = formulas.map(|formula| FormulaText::new(&curve, formula, "q", "x").formula);
    assert!(texts.any(|text| text == "q + strength * x / (x + shift)"));
}

#[test]
fn values_stand_in_the_place_of_names() {
    let curve = curve(Host::Addition, 0.01, |x| -3.0 * (1.0 - (-x / 0.22).exp()));
    let (answer, _) = answer(&curve);
    let text = FormulaText::new(&curve, &answer.formulas[0], "torque", "slip");
    assert_eq!(text.formula, "torque + strength * (1 - exp(-slip / scale))");
    assert_eq!(text.with_values(1), "torque - 3 * (1 - exp(-slip / 0.2))");
}

#[test]
fn a_correction_is_written_less_its_value_at_the_end() {
    let curve = curve(Host::Addition, 0.01, |x| (-x / 0.4).exp() - 1.0);
    let written = |link: Link| {
        let answer = search(&curve, &FormulaLibrary::of_corrections(4, link));
        FormulaText::new(&curve, &answer.formulas[0], "gain", "x").with_values(1)
    };
    assert_eq!(
        written(Link::Vanishing(End::Zero)),
        "gain + 1 * (exp(-x / 0.4) - 1)"
    );
    assert_eq!(
        written(Link::Normalised(End::Zero)),
        "gain + 1 * (exp(-x / 0.4) / 1 - 1)"
    );
}
