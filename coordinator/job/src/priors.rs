//! The entries of `[priors]`.

use std::collections::BTreeSet;

use formula::{Effect, Parameter};
use shared::channel::Channel;
use shared::experiment::Scatter;
use shared::file::{FileError, number, unknown_word};
use shared::model::EffectSet;
use shared::model::effects::parameter_name;
use shared::parameters::{self, NOISE_PREFIX, ParameterBounds, behind};
use statistics::{Distribution, Marginal};

/// A parameter with a prior.
#[derive(Debug, Clone)]
pub struct FreeParameter {
    /// Name, with its unit where it has one.
    pub name: String,
    /// Unit for tables and axes.
    pub unit: String,
    /// Prior density.
    pub marginal: Marginal,
}

/// One line of `[priors]`, as written.
#[derive(Debug)]
pub struct PriorEntry {
    /// The parameter.
    pub name: String,
    /// Line in the job file.
    pub line: usize,
    /// A number, or a table with one distribution.
    pub value: toml::Value,
}

/// What an entry means.
pub(super) enum Parsed {
    Fixed(f64),
    Free(FreeParameter),
}

const DISTRIBUTIONS: [&str; 5] = ["uniform", "loguniform", "normal", "lognormal", "half_normal"];

impl PriorEntry {
    /// Reads the entry and checks it against the parameter's physical bounds.
    pub(super) fn parse(&self, wheels: &BTreeSet<&str>, effects: &EffectSet) -> Result<Parsed, String> {
        self.check_quotes(wheels, effects)?;
        let quantity = quantity(&self.name, wheels, effects)?;
        if let Some(value) = number(&self.value) {
            if self.name.starts_with(NOISE_PREFIX) {
                return Err(format!(
                    "{} is fixed in the experiment's [noise], not here",
                    self.name
                ));
            }
            return Ok(Parsed::Fixed(value));
        }
        let marginal = marginal(&self.value, &quantity).map_err(|e| format!("{}: {e}", self.name))?;
        Ok(Parsed::Free(FreeParameter {
            name: self.name.clone(),
            unit: quantity.unit,
            marginal,
        }))
    }

    /// A dotted name without quotes is a table of tables to TOML; says so where one was probably meant.
    fn check_quotes(&self, wheels: &BTreeSet<&str>, effects: &EffectSet) -> Result<(), String> {
        let Some(table) = self.value.as_table() else {
            return Ok(());
        };
        let of_effect = |key: &str| {
            let own = effects.iter().chain(formula::catalogue::catalogue());
            own.filter(|e| e.name == self.name)
                .any(|e| e.parameter(key).is_some())
        };
        let dotted = |key: &&String| {
            let of_noise = Channel::ALL.iter().any(|c| c.column() == *key)
                || Scatter::ALL.iter().any(|s| s.key() == *key);
            let of_ring = parameters::RING_TRANSFER == format!("{}.{key}", self.name);
            wheels.contains(key.as_str()) || of_noise || of_ring || of_effect(key)
        };
        match table.keys().find(dotted) {
            None => Ok(()),
            Some(key) => Err(format!("write the name in quotes: \"{}.{key}\"", self.name)),
        }
    }
}

impl Parsed {
    /// What the file of an effect says of a parameter that the job does not mention, but for its name there.
    pub(super) fn of_effect(name: &str, parameter: &Parameter) -> Result<Parsed, String> {
        if let Some(value) = number(&parameter.prior) {
            return Ok(Parsed::Fixed(value));
        }
        let quantity = ParameterBounds {
            unit: parameter.unit.clone(),
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
        };
        let marginal = marginal(&parameter.prior, &quantity)
            .map_err(|e| format!("prior of parameter {}: {e}", parameter.name))?;
        Ok(Parsed::Free(FreeParameter {
            name: name.to_owned(),
            unit: quantity.unit,
            marginal,
        }))
    }
}

/// Checks what a user's effect file says of its parameters.
///
/// # Errors
/// [`FileError`] with the line of the parameter.
pub fn check_own(file: &str, effect: &Effect) -> Result<(), FileError> {
    for parameter in &effect.parameters {
        Parsed::of_effect(&parameter.name, parameter).map_err(|e| FileError::at(file, parameter.line, e))?;
    }
    Ok(())
}

/// The parameters of an effect that its file leaves free, by their names in a job.
///
/// # Errors
/// A sentence that names the parameter.
pub fn free_parameters(effect: &Effect) -> Result<Vec<FreeParameter>, String> {
    let mut free = Vec::new();
    for parameter in &effect.parameters {
        let name = parameter_name(effect, parameter, None);
        if let Parsed::Free(parameter) = Parsed::of_effect(&name, parameter)? {
            free.push(parameter);
        }
    }
    Ok(free)
}

/// The prior density that a table describes, within the quantity's physical bounds.
fn marginal(value: &toml::Value, quantity: &ParameterBounds) -> Result<Marginal, String> {
    let ParameterBounds { unit, lower, upper } = quantity;
    let (lower, upper, unit) = (*lower, *upper, behind(unit));
    let table = value.as_table().ok_or("a number or a table is expected")?;
    let distribution = distribution(table)?;
    let stated = table
        .get("bounds")
        .map(|value| pair("bounds", value))
        .transpose()?;
    if let Distribution::Uniform { lower: a, upper: b } | Distribution::Loguniform { lower: a, upper: b } =
        distribution
        && (a < lower || b > upper)
    {
        return Err(format!(
            "[{a}, {b}]{unit} leaves the admissible range [{lower}, {upper}]{unit}"
        ));
    }
    if let Some([a, b]) = stated
        && (a < lower || b > upper)
    {
        return Err(format!(
            "bounds [{a}, {b}]{unit} leave the admissible range [{lower}, {upper}]{unit}"
        ));
    }
    // A prior without bounds of its own ends where the quantity does.
    let bounds = stated.or(match distribution {
        Distribution::Uniform { .. } | Distribution::Loguniform { .. } => None,
        Distribution::Normal { .. } => Some([lower, upper]),
        Distribution::Lognormal { .. } | Distribution::HalfNormal { .. } => Some([lower.max(0.0), upper]),
    });
    Marginal::new(distribution, bounds).map_err(|e| e.to_string())
}

/// Unit and physical bounds of a parameter.
fn quantity(name: &str, wheels: &BTreeSet<&str>, effects: &EffectSet) -> Result<ParameterBounds, String> {
    let Some(column) = name.strip_prefix(NOISE_PREFIX) else {
        return Ok(shared::model::lookup(name, wheels, effects)?);
    };
    let unit = match Channel::ALL.into_iter().find(|c| c.column() == column) {
        Some(channel) => channel.unit(),
        None if Scatter::ALL.iter().any(|s| s.key() == column) => "1",
        None => {
            let known = Channel::ALL.map(Channel::column).into_iter();
            return Err(unknown_word(
                "noise",
                column,
                known.chain(Scatter::ALL.map(Scatter::key)),
            ));
        }
    };
    Ok(ParameterBounds {
        unit: unit.to_owned(),
        lower: 0.0,
        upper: f64::INFINITY,
    })
}

fn distribution(table: &toml::Table) -> Result<Distribution, String> {
    let mut found = table.iter().filter(|(key, _)| *key != "bounds");
    let Some((key, value)) = found.next() else {
        return Err(format!("no distribution; known are {}", DISTRIBUTIONS.join(", ")));
    };
    if let Some((second, _)) = found.next() {
        return Err(match DISTRIBUTIONS.contains(&second.as_str()) {
            true => format!("two distributions: {key} and {second}"),
            false => unknown_word("key", second, DISTRIBUTIONS.into_iter().chain(["bounds"])),
        });
    }
    let two = || pair(key, value);
    Ok(match key.as_str() {
        "uniform" => two().map(|[lower, upper]| Distribution::Uniform { lower, upper })?,
        "loguniform" => two().map(|[lower, upper]| Distribution::Loguniform { lower, upper })?,
        "normal" => two().map(|[mean, sd]| Distribution::Normal { mean, sd })?,
        "lognormal" => two().map(|[median, factor]| Distribution::Lognormal { median, factor })?,
        "half_normal" => match number(value) {
            Some(scale) => Distribution::HalfNormal { scale },
            None => {
                return Err(format!(
                    "half_normal = {value}: one number, its scale, is expected"
                ));
            }
        },
        other => return Err(unknown_word("distribution", other, DISTRIBUTIONS)),
    })
}

fn pair(key: &str, value: &toml::Value) -> Result<[f64; 2], String> {
    let numbers: Option<Vec<f64>> = value.as_array().and_then(|a| a.iter().map(number).collect());
    match numbers.as_deref() {
        Some(&[a, b]) => Ok([a, b]),
        _ => Err(format!("{key} = {value}: two numbers are expected")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_prior_of_the_catalogue_is_a_number_or_a_density() {
        for effect in formula::catalogue::catalogue() {
            for parameter in &effect.parameters {
                let quantity = ParameterBounds {
                    unit: parameter.unit.clone(),
                    lower: f64::NEG_INFINITY,
                    upper: f64::INFINITY,
                };
                let read =
                    number(&parameter.prior).is_some() || marginal(&parameter.prior, &quantity).is_ok();
                assert!(read, "{}.{}", effect.name, parameter.name);
            }
        }
    }
}
