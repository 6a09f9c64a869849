//! Parameters: their values and their priors.

use formula::catalogue::catalogue;
use serde_json::{Value, json};
use shared::channel::Channel;
use shared::experiment::Scatter;
use shared::model::effects::parameter_name;
use shared::parameters::{self, BaseParameter, RING_TRANSFER};

use super::shape::{above, either, needing, number, pair, said, table, text};

const ANY: f64 = f64::INFINITY;
/// A parameter of an effect, of a wheel, of noise: a name with a dot.
const DOTTED: &str = r"^[^.]+\.[^.]+(\.[^.]+)?$";

/// The distribution of a parameter, or its fixed value.
pub(super) fn definition() -> Value {
    let distributions = ["uniform", "loguniform", "normal", "lognormal", "half_normal"];
    let mut distribution = table(
        "one distribution, and bounds where it has none of its own",
        [
            ("uniform", pair("lower and upper bound")),
            (
                "loguniform",
                pair("lower and upper bound; uniform in the logarithm"),
            ),
            ("normal", pair("mean and standard deviation")),
            (
                "lognormal",
                pair("median, and the factor that is one standard deviation"),
            ),
            (
                "half_normal",
                above("scale of the upper half of a normal around 0", 0.0),
            ),
            ("bounds", pair("lower and upper bound of the other distributions")),
        ],
    );
    distribution["oneOf"] = distributions
        .map(|name| json!({ "required": [name] }))
        .into_iter()
        .collect();
    either(
        "a number fixes the parameter; a table is the density of its prior",
        vec![number("the fixed value", -ANY, ANY), distribution],
    )
}

/// The table `[priors]` of a job.
pub(super) fn priors() -> Value {
    let mut priors = table("priors, and fixed parameters", known().map(prior_of));
    let of_posterior = [
        (
            "posterior",
            text("the posterior.csv of a finished calibration: the joint prior of what is not stated here"),
        ),
        (
            "transfer",
            number(
                "factor of the covariance of that posterior, 1 without it",
                1.0,
                ANY,
            ),
        ),
        (
            "moduli",
            text("\"reference\", or \"literal\": its draws are turned into k_c, k_phi and n first"),
        ),
    ];
    for (key, shape) in of_posterior {
        priors["properties"][key] = shape;
    }
    let prior = json!({ "$ref": "#/definitions/prior" });
    priors["patternProperties"] = json!({ DOTTED: prior });
    // A model that is not ours has parameters of its own; the job says which.
    priors["additionalProperties"] = prior;
    priors
}

/// The table `[discovery.priors]`.
pub(super) fn of_candidates() -> Value {
    let of_effects = of_effects().chain(plain());
    table("priors of what a search may add", of_effects.map(prior_of))
}

/// Fixed values by name, as the table `[model]` and a file of parameters have them.
pub(super) fn values() -> impl Iterator<Item = (String, Value)> {
    known().map(|known| (known.name, number(&known.words, known.lower, known.upper)))
}

/// Values of any parameter whose name has a dot.
pub(super) fn dotted_values() -> Value {
    json!({ DOTTED: { "type": "number" } })
}

/// The names that a table admits: its keys, and names with a dot.
pub(super) fn names_of(table: &Value) -> Value {
    let keys: Vec<&String> = table["properties"]
        .as_object()
        .into_iter()
        .flat_map(|keys| keys.keys())
        .collect();
    json!({ "anyOf": [{ "enum": keys }, { "pattern": DOTTED }] })
}

/// A file of parameters: `name = value`.
pub(super) fn file_of_values() -> Value {
    let mut values = table("values of parameters, for forward runs", values());
    values["patternProperties"] = dotted_values();
    // A model that is not ours has parameters of its own.
    values["additionalProperties"] = json!({ "type": "number" });
    values
}

/// The prior that an effect file gives a parameter.
pub(super) fn of_own_effect() -> Value {
    needing(
        table(
            "a parameter of the formulas",
            [
                ("unit", text("SI unit, as \"m/s\"; \"1\" of a pure number")),
                (
                    "neutral",
                    number("value at which the effect is absent; marks a strength", -ANY, ANY),
                ),
                (
                    "typical",
                    number("value at which tables show the effect", -ANY, ANY),
                ),
                (
                    "prior",
                    said(
                        json!({ "allOf": [{ "$ref": "#/definitions/prior" }] }),
                        "what holds where the job does not state the parameter",
                    ),
                ),
            ],
        ),
        &["unit", "prior"],
    )
}

/// A parameter that jobs may name.
struct Known {
    name: String,
    words: String,
    lower: f64,
    upper: f64,
}

impl From<&BaseParameter> for Known {
    fn from(base: &BaseParameter) -> Self {
        let BaseParameter {
            name,
            unit,
            lower,
            upper,
            default,
            prior,
        } = *base;
        let otherwise = match (default, prior) {
            (Some(value), _) => format!("; {value} where nothing is said"),
            (None, Some(prior)) => format!("; {prior} where nothing is said"),
            (None, None) => String::new(),
        };
        let words = format!("[{unit}]{}{otherwise}", range(lower, upper));
        Known {
            name: name.to_owned(),
            words,
            lower,
            upper,
        }
    }
}

fn range(lower: f64, upper: f64) -> String {
    match (lower.is_finite(), upper.is_finite()) {
        (true, true) => format!(", {lower} to {upper}"),
        (true, false) => format!(", at least {lower}"),
        (false, true) => format!(", at most {upper}"),
        (false, false) => String::new(),
    }
}

/// The parameters of our models, of the catalogue's effects, and of noise.
fn known() -> impl Iterator<Item = Known> {
    let noise = Channel::ALL.map(|channel| (parameters::noise_parameter(channel), channel.unit()));
    let scatter = Scatter::ALL.map(|scatter| (parameters::scatter_parameter(scatter), "1"));
    let noise = noise.into_iter().chain(scatter).map(|(name, unit)| Known {
        name,
        words: format!("standard deviation [{unit}]; only where [noise] says \"unknown\""),
        lower: 0.0,
        upper: ANY,
    });
    let ring = Known {
        name: RING_TRANSFER.to_owned(),
        words: "logarithm of the ratio of tan phi under the ring to that under the wheel".to_owned(),
        lower: -2.0,
        upper: 2.0,
    };
    // Of models that hold one parameter at different values, the usual comes first.
    let mut seen = std::collections::BTreeSet::new();
    let ours = parameters::model_parameters()
        .filter(move |base| seen.insert(base.name))
        .map(Known::from);
    ours.chain(of_effects()).chain(noise).chain([ring])
}

fn of_effects() -> impl Iterator<Item = Known> {
    let of = |effect: &'static formula::Effect| {
        effect.parameters.iter().map(move |parameter| Known {
            name: parameter_name(effect, parameter, None),
            words: format!(
                "[{}] {}; prior where nothing is said: {}",
                parameter.unit, effect.summary, parameter.prior
            ),
            lower: -ANY,
            upper: ANY,
        })
    };
    catalogue().iter().flat_map(of)
}

/// Parameters of our models that a search may free.
fn plain() -> impl Iterator<Item = Known> {
    job::PLAIN_PARAMETERS.into_iter().map(|plain| Known {
        name: plain.name.to_owned(),
        words: format!("{}; prior where nothing is said: {}", plain.summary, plain.prior),
        lower: -ANY,
        upper: ANY,
    })
}

fn prior_of(known: Known) -> (String, Value) {
    let prior = json!({ "allOf": [{ "$ref": "#/definitions/prior" }] });
    (known.name, said(prior, &known.words))
}
