//! The entries of `[priors]`.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

use formula::{Effect, Parameter};
use shared::channel::Channel;
use shared::experiment::{RigError, Scatter};
use shared::file::{FileError, number, unknown_word};
use shared::model::effects::parameter_name;
use shared::model::{EffectSet, ParameterScope};
use shared::parameters::{self, BaseParameter, NOISE_PREFIX, ParameterBounds, TRANSIENT_ERRORS, behind};
use statistics::{Distribution, Marginal};

use super::prior_entry_error::{DISTRIBUTIONS, PriorEntryError};

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
#[derive(Debug, Clone)]
pub struct PriorEntry {
    /// The parameter.
    pub name: String,
    /// Line in the job's file; `None` for an entry that was added to the value.
    pub line: Option<usize>,
    /// Whether it is a table with a header, `[priors.NAME]`.
    pub(crate) has_header: bool,
    /// A number, or a table with one distribution.
    pub value: toml::Value,
}

/// The default priors of the models' parameters, by their texts.
static USUAL_PRIORS: LazyLock<BTreeMap<&'static str, toml::Value>> = LazyLock::new(|| {
    let value = |prior: &'static str| {
        prior
            .parse()
            .unwrap_or_else(|_| toml::Value::String(prior.to_owned()))
    };
    let texts = parameters::model_parameters().filter_map(|parameter| parameter.prior);
    texts.map(|prior| (prior, value(prior))).collect()
});

/// A parsed entry: a number or a prior.
pub(crate) enum ParsedPrior {
    Fixed(f64),
    Free(FreeParameter),
}

impl PriorEntry {
    /// Returns an error of this entry of a job.
    pub(crate) fn error(&self, job: &str, message: String) -> FileError {
        match self.line {
            Some(line) => FileError::at(job, line, message),
            None => FileError::whole(job, message),
        }
    }

    /// Reads the entry and checks it against the parameter's physical bounds.
    pub(crate) fn parse(&self, scope: &ParameterScope) -> Result<ParsedPrior, PriorEntryError> {
        self.check_quotes(scope.wheels, scope.effects)?;
        let quantity = quantity(&self.name, scope)?;
        if let Some(value) = number(&self.value) {
            if self.name.starts_with(NOISE_PREFIX) {
                return Err(PriorEntryError::FixedNoise(self.name.clone()));
            }
            return Ok(ParsedPrior::Fixed(value));
        }
        let marginal = marginal(&self.value, &quantity).map_err(|e| e.in_parameter(&self.name))?;
        Ok(ParsedPrior::Free(FreeParameter {
            name: self.name.clone(),
            unit: quantity.unit,
            marginal,
        }))
    }

    /// Checks for a dotted name without quotes, which TOML reads as a table of tables.
    fn check_quotes(&self, wheels: &BTreeSet<&str>, effects: &EffectSet) -> Result<(), PriorEntryError> {
        let Some(table) = self.value.as_table() else {
            return Ok(());
        };
        let is_effect = |key: &str| {
            let known = effects.iter().chain(formula::catalogue::catalogue());
            known
                .filter(|e| e.name == self.name)
                .any(|e| e.parameter(key).is_some())
        };
        let dotted = |key: &&String| {
            let is_noise = Channel::ALL.iter().any(|c| c.column() == *key)
                || Scatter::ALL.iter().any(|s| s.key() == *key)
                || RigError::find(key).is_some();
            let is_ring = parameters::RING_TRANSFER == format!("{}.{key}", self.name);
            wheels.contains(key.as_str()) || is_noise || is_ring || is_effect(key)
        };
        match table.keys().find(dotted) {
            None => Ok(()),
            Some(key) => Err(PriorEntryError::Unquoted {
                name: self.name.clone(),
                key: key.clone(),
            }),
        }
    }
}

impl ParsedPrior {
    /// Returns the default prior of a parameter of the model that the job does not state; `None` if the model has none.
    pub(crate) fn usual(parameter: &BaseParameter) -> Option<Result<FreeParameter, PriorEntryError>> {
        let value = USUAL_PRIORS.get(parameter.prior?)?;
        let quantity = ParameterBounds::from(parameter);
        let free = |marginal| FreeParameter {
            name: parameter.name.to_owned(),
            unit: quantity.unit.clone(),
            marginal,
        };
        let marginal = marginal(value, &quantity).map_err(|e| e.in_parameter(parameter.name));
        Some(marginal.map(free))
    }

    /// Returns the value or prior that an effect's file states for a parameter that the job does not state.
    pub(crate) fn from_effect(name: &str, parameter: &Parameter) -> Result<ParsedPrior, PriorEntryError> {
        if let Some(value) = number(&parameter.prior) {
            return Ok(ParsedPrior::Fixed(value));
        }
        let quantity = ParameterBounds {
            unit: parameter.unit.clone(),
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
        };
        let marginal = marginal(&parameter.prior, &quantity)
            .map_err(|e| e.in_parameter(format!("prior of parameter {}", parameter.name)))?;
        Ok(ParsedPrior::Free(FreeParameter {
            name: name.to_owned(),
            unit: quantity.unit,
            marginal,
        }))
    }
}

/// Checks the values and priors of the parameters of a user's effect file.
///
/// # Errors
/// [`FileError`] with the line of the parameter.
pub fn check_effect(file: &str, effect: &Effect) -> Result<(), FileError> {
    for parameter in &effect.parameters {
        ParsedPrior::from_effect(&parameter.name, parameter)
            .map_err(|e| FileError::at(file, parameter.line, e.to_string()))?;
    }
    Ok(())
}

/// Checks an effect that a search is to try: it needs a strength, and priors that hold.
///
/// # Errors
/// [`FileError`] of the file, with the line of a parameter.
pub fn check_candidate(file: &str, effect: &Effect) -> Result<(), FileError> {
    check_effect(file, effect)?;
    match effect
        .parameters
        .iter()
        .any(|parameter| parameter.neutral.is_some())
    {
        true => Ok(()),
        false => {
            let message = "a law that a search tries needs a strength: a parameter with `neutral`";
            Err(FileError::whole(file, message.to_owned()))
        }
    }
}

/// Returns the parameters of an effect that its file leaves free, by their names in a job.
///
/// # Errors
/// [`PriorEntryError`] names the parameter.
pub fn free_parameters(effect: &Effect) -> Result<Vec<FreeParameter>, PriorEntryError> {
    let mut free = Vec::new();
    for parameter in &effect.parameters {
        let name = parameter_name(effect, parameter, None);
        if let ParsedPrior::Free(parameter) = ParsedPrior::from_effect(&name, parameter)? {
            free.push(parameter);
        }
    }
    Ok(free)
}

/// Returns the prior density that a table describes, within the quantity's physical bounds.
pub(crate) fn marginal(value: &toml::Value, quantity: &ParameterBounds) -> Result<Marginal, PriorEntryError> {
    let ParameterBounds { unit, lower, upper } = quantity;
    let (lower, upper, unit) = (*lower, *upper, behind(unit));
    let table = value.as_table().ok_or(PriorEntryError::NotATable)?;
    let distribution = distribution(table)?;
    let stated = table
        .get("bounds")
        .map(|value| pair("bounds", value))
        .transpose()?;
    let within = |[a, b]: [f64; 2], stated: bool| match a < lower || b > upper {
        false => Ok(()),
        true => Err(PriorEntryError::OutOfRange {
            stated,
            a,
            b,
            unit: unit.clone(),
            lower,
            upper,
        }),
    };
    if let Distribution::Uniform { lower: a, upper: b } | Distribution::Loguniform { lower: a, upper: b } =
        distribution
    {
        within([a, b], false)?;
    }
    if let Some(bounds) = stated {
        within(bounds, true)?;
    }
    // A prior without stated bounds has the bounds of the quantity.
    let bounds = stated.or(match distribution {
        Distribution::Uniform { .. } | Distribution::Loguniform { .. } => None,
        Distribution::Normal { .. } => Some([lower, upper]),
        Distribution::Lognormal { .. } | Distribution::HalfNormal { .. } => Some([lower.max(0.0), upper]),
    });
    Ok(Marginal::new(distribution, bounds)?)
}

/// Returns the unit and the physical bounds of a parameter.
fn quantity(name: &str, scope: &ParameterScope) -> Result<ParameterBounds, PriorEntryError> {
    let Some(column) = name.strip_prefix(NOISE_PREFIX) else {
        return Ok(shared::model::lookup(name, scope)?);
    };
    let unit = match Channel::ALL.into_iter().find(|c| c.column() == column) {
        Some(channel) => channel.unit(),
        None if TRANSIENT_ERRORS.contains(&name) => "m",
        None if Scatter::ALL.iter().any(|s| s.key() == column) => "1",
        None => match RigError::find(column) {
            Some(error) => error.unit(),
            None => {
                let rig = RigError::ALL.map(RigError::key);
                let known = Channel::ALL.map(Channel::column).into_iter();
                let known = known.chain(Scatter::ALL.map(Scatter::key));
                let known = known.chain(rig.iter().map(String::as_str));
                let transient = TRANSIENT_ERRORS.iter();
                let known = known.chain(transient.filter_map(|name| name.strip_prefix(NOISE_PREFIX)));
                return Err(PriorEntryError::Unknown(unknown_word("noise", column, known)));
            }
        },
    };
    Ok(ParameterBounds {
        unit: unit.to_owned(),
        lower: 0.0,
        upper: f64::INFINITY,
    })
}

fn distribution(table: &toml::Table) -> Result<Distribution, PriorEntryError> {
    let mut found = table.iter().filter(|(key, _)| *key != "bounds");
    let Some((key, value)) = found.next() else {
        return Err(PriorEntryError::NoDistribution);
    };
    if let Some((second, _)) = found.next() {
        return Err(match DISTRIBUTIONS.contains(&second.as_str()) {
            true => PriorEntryError::TwoDistributions(key.clone(), second.clone()),
            false => {
                let known = DISTRIBUTIONS.into_iter().chain(["bounds"]);
                PriorEntryError::Unknown(unknown_word("key", second, known))
            }
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
                return Err(arguments("half_normal", value, "one number, its scale, is"));
            }
        },
        other => {
            let unknown = unknown_word("distribution", other, DISTRIBUTIONS);
            return Err(PriorEntryError::Unknown(unknown));
        }
    })
}

fn pair(key: &str, value: &toml::Value) -> Result<[f64; 2], PriorEntryError> {
    let numbers: Option<Vec<f64>> = value.as_array().and_then(|a| a.iter().map(number).collect());
    match numbers.as_deref() {
        Some(&[a, b]) => Ok([a, b]),
        _ => Err(arguments(key, value, "two numbers are")),
    }
}

fn arguments(key: &str, value: &toml::Value, expected: &'static str) -> PriorEntryError {
    PriorEntryError::Arguments {
        key: key.to_owned(),
        value: value.to_string(),
        expected,
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
