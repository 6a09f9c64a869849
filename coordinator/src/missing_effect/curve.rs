//! What a law outside the library does along its variable, and its file for the user.

use std::collections::BTreeMap;

use formula::variable::Variables;
use formula::{Effect, Variable};

use super::range::rounded;
use super::scan::Pair;

/// Points of a curve that is shown.
const POINTS: usize = 41;

/// The factor on a stress, or what is added to a channel in its SI unit, at 41 points over the range of the variable: pairs of
/// variable and value, evaluated by the formula itself.
///
/// # Arguments
/// - `effect_text`: an effect file that acts on the pair's quantity.
/// - `parameters`: by their names in a job, `EFFECT.PARAMETER`.
///
/// # Errors
/// A sentence: the file is none, or does not act on the quantity, or a parameter has no value, or a value of the curve is not
/// finite. Checked by `scan::tests::the_knots_carry_a_known_curve` and `form::tests::forms_are_what_their_names_say`.
pub fn curve(
    effect_text: &str,
    parameters: &BTreeMap<String, f64>,
    pair: &Pair,
) -> Result<Vec<[f64; 2]>, String> {
    let effect = Effect::read(effect_text).map_err(|e| e.to_string())?;
    let value = |name: &str| {
        let name = format!("{}.{name}", effect.name);
        let value = parameters.get(&name).copied();
        value.ok_or_else(|| format!("parameter {name} has no value"))
    };
    let values = effect.parameters.iter().map(|p| value(&p.name));
    let values: Vec<f64> = values.collect::<Result<_, String>>()?;
    let hook = pair.acts_on.hook();
    let program = effect
        .program(hook, Variables::default())
        .ok_or_else(|| format!("effect {} does not act on {}", effect.name, hook.name()))?;
    let mut variables = [0.0; Variable::COUNT];
    if pair.addition_sd.is_none() {
        // what a stress of 1 Pa becomes is the factor
        variables[hook.target() as usize] = 1.0;
    }
    let mut scalars = Vec::new();
    let mut curve = Vec::with_capacity(POINTS);
    for x in pair.range.points(POINTS) {
        variables[pair.variable() as usize] = x;
        let before = variables[hook.target() as usize];
        let after = program
            .settle(&variables, &values, &mut scalars)
            .ok_or_else(|| format!("effect {} differs from node to node", effect.name))?;
        let value = match pair.addition_sd {
            None => after,
            Some(_) => after - before,
        };
        if !value.is_finite() {
            return Err(format!(
                "effect {}: {} at {} = {x} {} must be finite",
                effect.name,
                value,
                pair.depends_on.name(),
                pair.variable().unit_name()
            ));
        }
        curve.push([x, value]);
    }
    Ok(curve)
}

/// An effect file for the user, with a comment on the most probable value of each parameter.
///
/// # Arguments
/// - `best`: by their names in a job, `EFFECT.PARAMETER`; a parameter without one is left as it is.
pub fn written(effect_text: &str, best: &BTreeMap<String, f64>) -> String {
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
