//! The formulas that a law's curve may follow, as they are recorded, with their effect files.

use std::fmt::Write;

use discovery::LawCurve;
use equation::{
    Answer, FittedFormula, FormulaClass, FormulaLibrary, FormulaParameter, FormulaText, Host, Limit,
    LocatedCurve, ParameterKind, answer, fits, splitting,
};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use record::{LawFormula, LawFormulas, SplittingCondition};

use super::dependence::{Dependence, SOURCE};
use super::range::rounded;

/// The largest number of nodes that a formula has, without its strength.
const SIZE: usize = 7;
/// The leading classes are recorded until they have this probability together, or are so many.
const RECORDED: f64 = 0.95;
const MAX_RECORDED: usize = 5;
/// A condition splits two classes that differ there by more \[standard deviations\].
const SPLIT: f64 = 2.0;
/// Digits of fitted values.
const DIGITS: usize = 4;
/// Where a formula is undefined at 0, the variable is held at this share of its lowest value.
const LEAST: f64 = 0.01;

/// Searches the formulas of a law; `None` where its curve determines nothing.
///
/// The evidence of a formula is that of the curve's knots with their covariance, not of the measurements. Checked by
/// `tests::a_curve_of_a_known_law_has_its_formula`.
pub(crate) fn formulas(dependence: &Dependence, curve: &LawCurve) -> Option<LawFormulas> {
    let host = match dependence.addition_sd {
        None => Host::Factor,
        Some(_) => Host::Addition,
    };
    let range = dependence.range;
    let (knots, values) = (range.knots(), &curve.knots);
    let curve = LocatedCurve::of_knots(host, &knots, values, &curve.covariance, range.is_logarithmic).ok()?;
    let library = FormulaLibrary::new(SIZE, dependence.variable().unit_name() == "1");
    let count = library.formulas().count();
    let fitted = (0..count)
        .into_par_iter()
        .map(|formula| fits(&curve, &library, formula));
    let fitted: Vec<_> = fitted.collect();
    let answer = answer(&curve, fitted.into_iter().flatten());
    let mut recorded: Vec<&FormulaClass> = Vec::new();
    for class in answer.classes.iter().take(MAX_RECORDED) {
        if recorded.iter().map(|class| class.probability).sum::<f64>() < RECORDED {
            recorded.push(class);
        }
    }
    let (first, second) = (answer.classes.first()?, answer.classes.get(1));
    let leading = |class: &FormulaClass| &answer.formulas[answer.simplest(class)];
    let split = second.and_then(|second| splitting(&curve, leading(first), leading(second)));
    let split = split.filter(|split| split.sds > SPLIT);
    let sum: f64 = recorded.iter().map(|class| class.probability).sum();
    let classes = recorded.iter().enumerate();
    Some(LawFormulas {
        classes: classes
            .map(|(place, class)| recorded_class(dependence, &curve, &answer, class, place + 1))
            .collect(),
        others: (1.0 - sum).max(0.0),
        fitted: count as u64,
        splitting: split.map(|split| SplittingCondition {
            at: rounded(split.at, 3),
            unit: dependence.variable().unit_name().to_owned(),
            laws: split.laws.map(|law| rounded(law, DIGITS)),
            sds: split.sds,
        }),
    })
}

/// Records a class.
///
/// # Arguments
/// - `number`: of the class, from 1, in the name of its effect.
fn recorded_class(
    dependence: &Dependence,
    curve: &LocatedCurve,
    answer: &Answer,
    class: &FormulaClass,
    number: usize,
) -> record::FormulaClass {
    let simplest = answer.simplest(class);
    let others = class.members.iter().copied().filter(|k| *k != simplest);
    let recorded = |k: usize| LawFormula {
        formula: text(dependence, curve, &answer.formulas[k]).with_values(DIGITS),
        probability: answer.formulas[k].probability,
    };
    let formula = &answer.formulas[simplest];
    record::FormulaClass {
        probability: class.probability,
        members: std::iter::once(simplest).chain(others).map(recorded).collect(),
        above: limit(dependence, formula.limit_above(curve), "large"),
        below: formula
            .limit_below(curve)
            .map(|below| limit(dependence, below, "small")),
        effect_file: effect_file(dependence, &text(dependence, curve, formula), number),
    }
}

/// Writes a formula over the variable, which is held where the formula ends.
fn text(dependence: &Dependence, curve: &LocatedCurve, formula: &FittedFormula) -> FormulaText {
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

/// Writes where a law tends to: `tends to a factor of 0.7 for a large j`.
fn limit(dependence: &Dependence, limit: Limit, end: &str) -> String {
    let variable = dependence.depends_on.name();
    let side = |sign: f64| match (dependence.addition_sd, sign < 0.0) {
        (None, _) => "the factor",
        (Some(_), false) => "the addition",
        (Some(_), true) => "the subtraction",
    };
    let number = |value: f64| shared::limit::number(rounded(value, 3));
    match limit {
        Limit::Value(value) => match dependence.addition_sd {
            None => format!("tends to a factor of {} for a {end} {variable}", number(value)),
            Some(_) if dependence.unit() == "1" => {
                format!("tends to {} for a {end} {variable}", number(value))
            }
            Some(_) => format!(
                "tends to {} {} for a {end} {variable}",
                number(value),
                dependence.unit()
            ),
        },
        Limit::Power { exponent, sign } => {
            format!(
                "{} goes with {variable}^{} for a {end} {variable}",
                side(sign),
                number(exponent)
            )
        }
        Limit::Logarithm { sign } => {
            format!("{} changes more slowly than any power of {variable}", side(sign))
        }
        Limit::Exponential { sign } => format!("{} grows exponentially with {variable}", side(sign)),
        Limit::Ends(at) => match dependence.variable().unit_name() {
            "1" => format!("is undefined from {variable} = {} on", number(at)),
            unit => format!("is undefined from {variable} = {} {unit} on", number(at)),
        },
    }
}

/// Returns the effect file of a formula. Its priors are as wide as those of the search of formulas.
fn effect_file(dependence: &Dependence, text: &FormulaText, number: usize) -> String {
    let mut file = format!(
        "name = \"{}_formula_{number}\"\nsummary = \"{} follows a formula of the {}\"\nsource = \"{SOURCE}\"\n{} = \"{}\"\n",
        dependence.name(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::read;
    use crate::law::dependence::dependences;
    use formula::Effect;

    /// A dependence of the experiment, and the curve of a law at its knots with this sd.
    fn located(name: &str, sd: f64, law: impl Fn(f64) -> f64) -> (Dependence, LawCurve) {
        let (_, _, experiment) = read("tests/data/shear-mobilisation");
        let mut all = dependences(&experiment).into_iter();
        let dependence = all.find(|dependence| dependence.name() == name).unwrap();
        let knots: Vec<f64> = dependence.range.knots().into_iter().map(law).collect();
        let covariance = (0..25).map(|i| if i % 6 == 0 { sd * sd } else { 0.0 });
        (
            dependence,
            LawCurve {
                knots,
                covariance: covariance.collect(),
            },
        )
    }

    #[test]
    fn a_curve_of_a_known_law_has_its_formula() {
        let (dependence, curve) = located("shear_v_t", 0.003, |v| -0.2 * (1.0 + v / 0.0005).ln());
        let formulas = formulas(&dependence, &curve).unwrap();
        let shown = || format!("{:?}", formulas.classes);
        let members = formulas.classes.iter().flat_map(|class| &class.members);
        let mut members = members.map(|member| member.formula.as_str());
        assert!(
            members.any(|formula| formula.starts_with("tau * (1 + v_t / 0.000")),
            "{}",
            shown()
        );
        let sum: f64 = formulas.classes.iter().map(|class| class.probability).sum();
        assert!((sum + formulas.others - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_sentence_names_the_leading_classes_and_what_splits_them() {
        let class = |formula: &str, probability: f64| record::FormulaClass {
            probability,
            members: vec![LawFormula {
                formula: formula.into(),
                probability,
            }],
            above: "tends to a factor of 0.7 for a large j".into(),
            below: None,
            effect_file: String::new(),
        };
        let of = |classes: Vec<record::FormulaClass>| LawFormulas {
            others: 1.0 - classes.iter().map(|class| class.probability).sum::<f64>(),
            classes,
            fitted: 1509,
            splitting: Some(SplittingCondition {
                at: 0.04,
                unit: "m".into(),
                laws: [0.7, 0.5],
                sds: 3.25,
            }),
        };
        assert_eq!(
            of(vec![class("tau * f(j)", 0.6), class("tau * g(j)", 0.25), class("tau * h(j)", 0.05)]).words("shear displacement"),
            Some(
                "as a formula the curve is one of: tau * f(j) (P 0.60; tends to a factor of 0.7 for a large j); or tau * g(j) (P 0.25; \
                 tends to a factor of 0.7 for a large j); or another (P 0.15); the first two differ most at a shear displacement of 0.04 m \
                 (0.7 and 0.5, 3.2 sds): a run there would split them"
                    .into()
            )
        );
        assert_eq!(
            of(vec![class("tau * f(j)", 0.97), class("tau * g(j)", 0.02)]).words("shear displacement"),
            Some(
                "as a formula the curve is tau * f(j) (P 0.97; tends to a factor of 0.7 for a large j)"
                    .into()
            )
        );
    }

    #[test]
    fn every_effect_file_is_read_and_absent_without_its_strength() {
        for (name, sd) in [
            ("shear_j", 0.05),
            ("pressure_z", 0.1),
            ("drawbar_pull_slip", 1.0),
            ("shear_slip", 0.02),
        ] {
            let (dependence, curve) = located(name, sd, |x| -0.4 * x / (x + 0.1));
            let formulas = formulas(&dependence, &curve).unwrap();
            for class in &formulas.classes {
                let effect = Effect::read(&class.effect_file);
                let effect = effect.unwrap_or_else(|e| panic!("{e}: {}", class.effect_file));
                assert!(
                    effect
                        .program(dependence.acts_on.hook(), Default::default())
                        .is_some()
                );
                let strengths = effect.parameters.iter().filter(|p| p.neutral.is_some());
                assert_eq!(strengths.count(), 1);
            }
            let words = formulas.words(dependence.depends_on.words()).unwrap();
            assert!(words.starts_with("as a formula the curve is "), "{words}");
        }
    }
}
