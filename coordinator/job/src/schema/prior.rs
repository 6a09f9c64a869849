//! The schemas of parameters: their values and their priors.

use std::collections::BTreeSet;

use formula::catalogue::catalogue;
use serde_json::{Map, Value, json};
use shared::channel::Channel;
use shared::experiment::{RigError, Scatter};
use shared::model::effects::parameter_name;
use shared::parameters::{
    self, BaseParameter, RING_TRANSFER, TRANSIENT_ERROR_LENGTH, TRANSIENT_ERROR_SD, TRANSIENT_SCATTER,
};

use crate::plain_parameter::PLAIN_PARAMETERS;
use crate::table::prior_entry_error::DISTRIBUTIONS;

/// The pattern of the names of parameters of an effect, a wheel or the noise, which have a dot.
pub(super) const DOTTED: &str = r"^[^.]+\.[^.]+(\.[^.]+)?$";

/// Returns the schema of a prior: a distribution, or a fixed value.
pub fn prior() -> Value {
    let pair = |words: &str| json!({ "description": words, "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 });
    let distribution = json!({
        "description": "One distribution, and bounds if it has none itself.",
        "type": "object",
        "properties": {
            "uniform": pair("Lower and upper bound."),
            "loguniform": pair("Lower and upper bound; uniform in the logarithm."),
            "normal": pair("Mean and standard deviation."),
            "lognormal": pair("Median, and the factor that is one standard deviation."),
            "half_normal": {
                "description": "Scale of the upper half of a normal distribution around 0.", "type": "number", "exclusiveMinimum": 0,
            },
            "bounds": pair("Lower and upper bound of the other distributions."),
        },
        "additionalProperties": false,
        "oneOf": DISTRIBUTIONS.map(|name| json!({ "required": [name] })),
    });
    json!({
        "description": "A number fixes the parameter; a table is the density of its prior.",
        "anyOf": [{ "description": "Fixed value.", "type": "number" }, distribution],
    })
}

/// Returns the schema of the table `[priors]` of a job.
pub(super) fn priors() -> Value {
    let prior = json!({ "$ref": "#/definitions/prior" });
    let mut properties = priors_of(JobParameter::all());
    properties["posterior"] = json!({
        "description": "The posterior.csv of a finished calibration: the joint prior of the parameters that are not stated here.",
        "type": "string",
    });
    properties["transfer"] = json!({
        "description": "Factor of the covariance of that posterior; 1 if it is not stated.", "type": "number", "minimum": 1,
    });
    properties["moduli"] = json!({
        "description": "\"reference\", or \"literal\": the draws of that posterior are converted to k_c, k_phi and n first.",
        "type": "string",
    });
    json!({
        "description": "Priors, and fixed parameters.",
        "type": "object",
        "properties": properties,
        "patternProperties": { DOTTED: prior },
        // The names of an external model's parameters are stated by the job.
        "additionalProperties": prior,
    })
}

/// Returns the schema of the table `[discovery.priors]`.
pub(super) fn candidate_priors() -> Value {
    let plain = PLAIN_PARAMETERS.into_iter().map(|plain| JobParameter {
        name: plain.name.to_owned(),
        words: format!("{}; the default prior is {}", plain.summary, plain.prior),
        lower: f64::NEG_INFINITY,
        upper: f64::INFINITY,
    });
    json!({
        "description": "Priors of parameters that a search may add.",
        "type": "object",
        "properties": priors_of(JobParameter::of_effects().chain(plain)),
        "additionalProperties": false,
    })
}

/// Returns the names that a table admits: its keys, and names with a dot.
pub(super) fn names_of(table: &Value) -> Value {
    let keys: Vec<&String> = table["properties"]
        .as_object()
        .into_iter()
        .flat_map(Map::keys)
        .collect();
    json!({ "anyOf": [{ "enum": keys }, { "pattern": DOTTED }] })
}

/// Returns the schema of a file of parameters for forward runs: `name = value`.
pub fn parameters() -> Value {
    let values: Map<String, Value> = JobParameter::all()
        .map(|parameter| (parameter.name.clone(), parameter.value()))
        .collect();
    json!({
        "description": "Values of parameters, for forward runs.",
        "type": "object",
        "properties": values,
        "patternProperties": { DOTTED: { "type": "number" } },
        // The names of an external model's parameters are stated by its model file.
        "additionalProperties": { "type": "number" },
    })
}

fn priors_of(parameters: impl Iterator<Item = JobParameter>) -> Value {
    let prior = |parameter: JobParameter| {
        let prior = json!({ "description": parameter.words, "allOf": [{ "$ref": "#/definitions/prior" }] });
        (parameter.name, prior)
    };
    parameters.map(prior).collect::<Map<_, _>>().into()
}

/// A parameter that jobs may name.
pub(super) struct JobParameter {
    pub(super) name: String,
    words: String,
    lower: f64,
    upper: f64,
}

impl JobParameter {
    /// Returns the parameters of all forward models but external ones, of the catalogue's effects, and of the noise.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let noise = Channel::ALL.map(|channel| (parameters::noise_parameter(channel), channel.unit()));
        let scatter = Scatter::ALL.map(|scatter| (parameters::scatter_parameter(scatter), "1"));
        let rig = RigError::ALL.map(|error| (parameters::rig_parameter(error), error.unit()));
        let noise = noise
            .into_iter()
            .chain(scatter)
            .chain(rig)
            .map(|(name, unit)| JobParameter {
                name,
                words: format!("standard deviation [{unit}]; only if [noise] says \"unknown\""),
                lower: 0.0,
                upper: f64::INFINITY,
            });
        let transients = [
            (
                TRANSIENT_SCATTER,
                "standard deviation [m] of sinkages before the steady state between repeats; only with histories = true",
            ),
            (
                TRANSIENT_ERROR_SD,
                "standard deviation [m] of the model's error before the steady state, which repeats share; only with histories = true",
            ),
            (
                TRANSIENT_ERROR_LENGTH,
                "travel [m] over which the correlation of these errors decays by a factor e; only with histories = true",
            ),
        ];
        let transients = transients.map(|(name, words)| JobParameter {
            name: name.to_owned(),
            words: words.to_owned(),
            lower: 0.0,
            upper: f64::INFINITY,
        });
        let ring = JobParameter {
            name: RING_TRANSFER.to_owned(),
            words: "logarithm of the ratio of tan phi under the ring to tan phi under the wheel".to_owned(),
            lower: -2.0,
            upper: 2.0,
        };
        // Models may state different defaults of one parameter; the description has those of the first model.
        let mut seen = BTreeSet::new();
        let of_models = parameters::model_parameters()
            .filter(move |base| seen.insert(base.name))
            .map(JobParameter::from);
        of_models
            .chain(JobParameter::of_effects())
            .chain(noise)
            .chain(transients)
            .chain([ring])
    }

    /// Returns the parameters of the catalogue's effects.
    fn of_effects() -> impl Iterator<Item = Self> {
        let parameters = catalogue()
            .iter()
            .flat_map(|effect| effect.parameters.iter().map(move |parameter| (effect, parameter)));
        parameters.map(|(effect, parameter)| JobParameter {
            name: parameter_name(effect, parameter, None),
            words: format!(
                "[{}] {}; the default prior is {}",
                parameter.unit, effect.summary, parameter.prior
            ),
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
        })
    }

    /// Returns the schema of a value of the parameter.
    pub(super) fn value(&self) -> Value {
        let mut value = json!({ "description": self.words, "type": "number" });
        for (key, bound) in [("minimum", self.lower), ("maximum", self.upper)] {
            if bound.is_finite() {
                value[key] = json!(bound);
            }
        }
        value
    }
}

impl From<&BaseParameter> for JobParameter {
    fn from(base: &BaseParameter) -> Self {
        let BaseParameter {
            name,
            unit,
            lower,
            upper,
            default,
            prior,
        } = *base;
        let default = match (default, prior) {
            (Some(value), _) => format!("; {value} if it is not stated"),
            (None, Some(prior)) => format!("; the default prior is {prior}"),
            (None, None) => String::new(),
        };
        let range = match (lower.is_finite(), upper.is_finite()) {
            (true, true) => format!(", {lower} to {upper}"),
            (true, false) => format!(", at least {lower}"),
            (false, true) => format!(", at most {upper}"),
            (false, false) => String::new(),
        };
        JobParameter {
            name: name.to_owned(),
            words: format!("[{unit}]{range}{default}"),
            lower,
            upper,
        }
    }
}
