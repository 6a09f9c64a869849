//! A formula of a law as text over the names of its experiment, and as an effect file.

use std::fmt::Write;

use equation::{FittedFormula, FormulaParameter, FormulaText, Limit, LocatedCurve, ParameterKind};

use super::dependence::{Dependence, SOURCE};
use super::range::rounded;

/// Digits of fitted values.
pub(super) const DIGITS: usize = 4;
/// Where a formula is undefined at 0, the variable is held at this share of its lowest value.
const LEAST: f64 = 0.01;

/// Writes a formula over the variable, which is held where the formula ends.
pub(super) fn text(dependence: &Dependence, curve: &LocatedCurve, formula: &FittedFormula) -> FormulaText {
    let name = dependence.depends_on.name();
    let [lowest, highest] = curve.range();
    let mut variable = name.to_owned();
    if lowest > 0.0 && !formula.law(curve, 0.0).is_finite() {
        variable = format!("max({variable}, {:?})", rounded(LEAST * lowest, DIGITS));
    }
    if matches!(formula.limit_above(curve), Limit::Ends(_)) {
        variable = format!("min({variable}, {highest:?})");
    }
    FormulaText::new(curve, formula, dependence.target(), &variable)
}

/// Returns the effect file of a formula. Its priors are as wide as those of the search of formulas.
pub(super) fn effect_file(dependence: &Dependence, text: &FormulaText, name: &str) -> String {
    let mut file = format!(
        "name = \"{name}\"\nsummary = \"{} follows a formula of the {}\"\nsource = \"{SOURCE}\"\n{} = \"{}\"\n",
        dependence.acts_on.words(),
        dependence.depends_on.words(),
        dependence.acts_on.name(),
        text.formula,
    );
    for parameter in &text.parameters {
        let (unit, prior) = prior(dependence, parameter);
        let neutral = match parameter.kind {
            ParameterKind::Strength => "neutral = 0.0\n",
            _ => "",
        };
        // Writing to a text cannot fail.
        let _ = write!(
            file,
            "\n# most probable value: {:?}\n[parameters.{}]\nunit = \"{unit}\"\n{neutral}prior = {prior}\n",
            rounded(parameter.value, DIGITS),
            parameter.name,
        );
    }
    file
}

/// Returns unit and prior of a parameter.
fn prior(dependence: &Dependence, parameter: &FormulaParameter) -> (&'static str, String) {
    let (range, unit) = (dependence.range, dependence.variable().unit_name());
    let value = rounded(parameter.value, DIGITS);
    let normal = |sd: f64| format!("{{ normal = [{value:?}, {:?}] }}", rounded(sd, DIGITS));
    match parameter.kind {
        ParameterKind::Strength => {
            let sd = rounded(2.0 * value.abs(), DIGITS);
            (dependence.unit(), format!("{{ normal = [0.0, {sd:?}] }}"))
        }
        ParameterKind::Scale => (unit, format!("{{ lognormal = [{value:?}, 3.0] }}")),
        ParameterKind::Shift => (unit, normal(0.5 * (range.highest - range.lowest))),
        ParameterKind::Threshold => (
            unit,
            format!("{{ uniform = [{:?}, {:?}] }}", range.lowest, range.highest),
        ),
        ParameterKind::Exponent => ("1", normal(0.5)),
        ParameterKind::Factor => ("1", normal(value.abs().max(0.5))),
    }
}
