//! The values of a law outside the library along its variable, and its file for the user.

use std::collections::BTreeMap;

use formula::effect::EffectError;
use formula::variable::Variables;
use formula::{Effect, Variable};

use super::dependence::Dependence;
use super::range::rounded;

/// Points of a curve.
const POINTS: usize = 41;

/// The error of an effect file that has no curve.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CurveError {
    /// The text is not an effect file.
    #[error(transparent)]
    File(#[from] EffectError),
    /// A parameter has no value.
    #[error("parameter {parameter} has no value")]
    NoValue {
        /// `EFFECT.PARAMETER`.
        parameter: String,
    },
    /// The effect acts on another quantity.
    #[error("effect {effect} does not act on {hook}")]
    NoHook {
        /// The effect.
        effect: String,
        /// The quantity.
        hook: &'static str,
    },
    /// The formula needs the state of each node.
    #[error("effect {effect} differs from node to node")]
    PerNode {
        /// The effect.
        effect: String,
    },
    /// A value is NaN or infinite.
    #[error("effect {effect}: {value} at {variable} = {x} {unit} must be finite")]
    NotFinite {
        /// The effect.
        effect: String,
        /// The value.
        value: f64,
        /// The variable.
        variable: &'static str,
        /// The value of the variable at which it is not finite.
        x: f64,
        /// The unit of the variable.
        unit: &'static str,
    },
}

/// Returns the factor on a stress, or the addition to a channel in its SI unit, at 41 points over the range of the variable:
/// pairs of variable and value, from the formula itself.
///
/// # Arguments
/// - `effect_text`: an effect file that acts on the quantity of the dependence.
/// - `parameters`: by their names in a job, `EFFECT.PARAMETER`.
///
/// # Errors
/// [`CurveError`]. Checked by `tests::the_knots_carry_a_known_curve` and `form::tests::forms_are_what_their_names_say`.
pub(crate) fn curve(
    effect_text: &str,
    parameters: &BTreeMap<String, f64>,
    dependence: &Dependence,
) -> Result<Vec<[f64; 2]>, CurveError> {
    let effect = Effect::read(effect_text)?;
    let name = || effect.name.clone();
    let value = |name: &str| {
        let name = format!("{}.{name}", effect.name);
        let value = parameters.get(&name).copied();
        value.ok_or(CurveError::NoValue { parameter: name })
    };
    let values = effect.parameters.iter().map(|p| value(&p.name));
    let values: Vec<f64> = values.collect::<Result<_, CurveError>>()?;
    let hook = dependence.acts_on.hook();
    let program = effect
        .program(hook, Variables::default())
        .ok_or_else(|| CurveError::NoHook {
            effect: name(),
            hook: hook.name(),
        })?;
    let mut variables = [0.0; Variable::COUNT];
    if dependence.addition_sd.is_none() {
        // A stress of 1 Pa becomes the factor.
        variables[hook.target() as usize] = 1.0;
    }
    let mut scalars = Vec::new();
    let mut curve = Vec::with_capacity(POINTS);
    for x in dependence.range.points(POINTS) {
        variables[dependence.variable() as usize] = x;
        let before = variables[hook.target() as usize];
        let after = program
            .settle(&variables, &values, &mut scalars)
            .ok_or_else(|| CurveError::PerNode { effect: name() })?;
        let value = match dependence.addition_sd {
            None => after,
            Some(_) => after - before,
        };
        if !value.is_finite() {
            return Err(CurveError::NotFinite {
                effect: name(),
                value,
                variable: dependence.depends_on.name(),
                x,
                unit: dependence.variable().unit_name(),
            });
        }
        curve.push([x, value]);
    }
    Ok(curve)
}

/// Returns an effect file with the most probable value of each parameter in a comment.
///
/// # Arguments
/// - `best`: by their names in a job, `EFFECT.PARAMETER`; a parameter without a value has no comment.
pub(crate) fn with_values(effect_text: &str, best: &BTreeMap<String, f64>) -> String {
    let comment = |line: &str| {
        let parameter = line.strip_prefix("[parameters.")?.split_once(']')?.0;
        let (_, value) = best
            .iter()
            .find(|(name, _)| name.rsplit('.').next() == Some(parameter))?;
        Some(format!("# most probable value: {:?}\n", rounded(*value, 4)))
    };
    let lines = effect_text.lines();
    lines
        .map(|line| format!("{}{line}\n", comment(line).unwrap_or_default()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{read, text};
    use crate::law::dependence::dependences;
    use crate::law::range::KNOTS;

    #[test]
    fn the_knots_carry_a_known_curve() {
        let (_, _, experiment) = read("tests/data/shear-mobilisation");
        let values = [0.3, -0.2, 0.5, 0.0, -0.4];
        for dependence in dependences(&experiment) {
            let candidate = dependence.curve();
            let (text, effect) = text(&candidate);
            let parameters: BTreeMap<String, f64> = (0..KNOTS)
                .map(|i| (format!("{}.a{i}", effect.name), values[i]))
                .collect();
            let shown = curve(text, &parameters, &dependence).unwrap();
            for (i, knot) in dependence.range.knots().into_iter().enumerate() {
                let [x, y] = shown[10 * i];
                let expected = match dependence.addition_sd {
                    None => libm::exp(values[i]),
                    Some(_) => values[i],
                };
                assert!(
                    (x - knot).abs() <= 1e-12 * knot.abs(),
                    "{}: {x} {knot}",
                    dependence.name()
                );
                assert!(
                    (y - expected).abs() < 1e-6,
                    "{}: {y} {expected}",
                    dependence.name()
                );
                // halfway to the next knot the curve is halfway
                if let Some(next) = values.get(i + 1) {
                    let halfway = f64::midpoint(values[i], *next);
                    let expected = dependence.addition_sd.map_or(libm::exp(halfway), |_| halfway);
                    assert!(
                        (shown[10 * i + 5][1] - expected).abs() < 1e-6,
                        "{}",
                        dependence.name()
                    );
                }
            }
        }
    }
}
