//! Formulas whose evidence comes from other data than the curve.

use equation::{FormulaText, Host, WeighedFit, fits, ranked};

use crate::setup::{LIBRARY, curve};

fn all(curve: &equation::LocatedCurve) -> Vec<WeighedFit> {
    let count = LIBRARY.formulas().count();
    ranked((0..count).flat_map(|formula| fits(curve, &LIBRARY, formula)))
}

#[test]
fn the_prior_of_a_formula_is_a_density() {
    let curve = curve(Host::Addition, 0.05, |x| 0.8 * (1.0 - (-x / 0.3).exp()));
    let fits = all(&curve);
    let text = |fit: &WeighedFit| FormulaText::new(&curve, fit.formula(), "q", "x").formula;
    let mut saturation = fits.iter();
    let saturation = saturation.find(|fit| text(fit) == "q + strength * (1 - exp(-x / scale))");
    let saturation = saturation.unwrap();
    // With nothing to turn, the evidence is the log density of the priors.
    let density = |strength: f64, scale: f64| {
        let refitted = saturation.refitted(&curve, &[strength, scale], 0.0, 0.0);
        refitted.map_or(0.0, |fit| fit.formula().log_evidence.exp())
    };
    let (step, count) = (0.1, 120);
    let nodes = || (-count..=count).map(|i| step * f64::from(i));
    let integral: f64 = nodes()
        .flat_map(|u| nodes().map(move |t| (u, t)))
        .map(|(u, t)| density(u.sinh(), t.exp()) * u.cosh() * t.exp() * step * step)
        .sum();
    // The other sign of the constant has the other half.
    assert!((integral - 0.5).abs() < 0.01, "{integral}");
}

#[test]
fn an_evidence_is_that_with_the_priors_of_the_curve() {
    let curve = curve(Host::Factor, 0.05, |x| 0.8 * x / (x + 0.3));
    for fit in &all(&curve)[..50] {
        let text = FormulaText::new(&curve, fit.formula(), "q", "x");
        let values: Vec<f64> = text.parameters.iter().map(|parameter| parameter.value).collect();
        let at = |log_evidence: f64, log_prior: f64| {
            let refitted = fit.refitted(&curve, &values, log_evidence, log_prior);
            refitted.unwrap().formula().log_evidence
        };
        // Narrower priors at the same values make the same evidence if they raised it by their density.
        assert!((at(3.0, -1.0) - at(5.0, 1.0)).abs() < 1e-12, "{}", text.formula);
    }
}
