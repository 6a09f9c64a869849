//! The entries of `[priors]`.

use std::collections::BTreeSet;

use inference::{Distribution, Marginal};
use shared::channel::Channel;
use shared::file::unknown_word;
use shared::parameters::{self, NOISE_PREFIX};

/// A parameter with a prior.
#[derive(Debug, Clone)]
pub struct FreeParameter {
    /// Name, with its unit where it has one.
    pub name: String,
    /// Unit for tables and axes.
    pub unit: &'static str,
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
    pub(super) fn parse(&self, wheels: &BTreeSet<&str>) -> Result<Parsed, String> {
        self.check_quotes(wheels)?;
        let (unit, lower, upper) = bounds(&self.name, wheels)?;
        if let Some(value) = number(&self.value) {
            if self.name.starts_with(NOISE_PREFIX) {
                return Err(format!(
                    "{} is fixed in the experiment's [noise], not here",
                    self.name
                ));
            }
            return Ok(Parsed::Fixed(value));
        }
        let table = self
            .value
            .as_table()
            .ok_or_else(|| format!("{}: a number or a table is expected", self.name))?;
        let prefix = |e: String| format!("{}: {e}", self.name);
        let distribution = distribution(table).map_err(prefix)?;
        let stated = match table.get("bounds") {
            None => None,
            Some(value) => Some(pair("bounds", value).map_err(prefix)?),
        };
        if let Distribution::Uniform { lower: a, upper: b } | Distribution::Loguniform { lower: a, upper: b } =
            distribution
            && (a < lower || b > upper)
        {
            let what = format!("[{a}, {b}] {unit} leaves the admissible range [{lower}, {upper}] {unit}");
            return Err(prefix(what));
        }
        if let Some([a, b]) = stated
            && (a < lower || b > upper)
        {
            let what =
                format!("bounds [{a}, {b}] {unit} leave the admissible range [{lower}, {upper}] {unit}");
            return Err(prefix(what));
        }
        // A prior without bounds of its own ends where the quantity does.
        let bounds = stated.or(match distribution {
            Distribution::Uniform { .. } | Distribution::Loguniform { .. } => None,
            Distribution::Normal { .. } => Some([lower, upper]),
            Distribution::Lognormal { .. } | Distribution::HalfNormal { .. } => Some([lower.max(0.0), upper]),
        });
        let marginal = Marginal::new(distribution, bounds).map_err(|e| prefix(e.to_string()))?;
        Ok(Parsed::Free(FreeParameter {
            name: self.name.clone(),
            unit,
            marginal,
        }))
    }
}

impl PriorEntry {
    /// A dotted name without quotes is a table of tables to TOML; says so where one was probably meant.
    fn check_quotes(&self, wheels: &BTreeSet<&str>) -> Result<(), String> {
        let Some(table) = self.value.as_table() else {
            return Ok(());
        };
        let dotted = |key: &&String| {
            wheels.contains(key.as_str())
                || Channel::ALL.iter().any(|c| c.column() == *key)
                || parameters::EFFECTS
                    .iter()
                    .any(|p| p.name.split_once('.') == Some((&self.name, key)))
        };
        match table.keys().find(dotted) {
            None => Ok(()),
            Some(key) => Err(format!("write the name in quotes: \"{}.{key}\"", self.name)),
        }
    }
}

/// Unit and physical bounds of a parameter.
fn bounds(name: &str, wheels: &BTreeSet<&str>) -> Result<(&'static str, f64, f64), String> {
    if let Some(column) = name.strip_prefix(NOISE_PREFIX) {
        let channel = Channel::ALL.into_iter().find(|c| c.column() == column);
        return match channel {
            Some(channel) => Ok((channel.unit(), 0.0, f64::INFINITY)),
            None => Err(unknown_word("noise", column, Channel::ALL.map(Channel::column))),
        };
    }
    let base = parameters::lookup(name, wheels)?;
    Ok((base.unit, base.lower, base.upper))
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

fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}
