//! `job.toml`.

use inference::evolution::{CmaEsSettings, GaSettings};
use inference::lm::LmSettings;
use inference::{MAX_PARTICLES, TmcmcSettings};
use job::AlgorithmName;
use serde_json::{Value, json};
use shared::channel::Channel;

use super::model::{is_external, model};
use super::prior;
use super::shape::{either, flag, list, named, number, one_of, pair, said, table, text, usual, whole};

const ANY: f64 = f64::INFINITY;

/// The whole file.
pub(super) fn job() -> Value {
    let one = json!({ "$ref": "#/definitions/model" });
    let priors = json!({ "$ref": "#/definitions/priors" });
    let mut of_several = model();
    of_several["properties"]["priors"] = said(json!({ "allOf": [priors] }), "priors of this model alone");
    of_several["else"] = json!({ "propertyNames": prior::names_of(&of_several) });
    let several = json!({ "type": "array", "items": of_several, "minItems": 2, "maxItems": 8 });
    let questions = job::Question::names();
    let mut job = table(
        "a calibration",
        [
            ("experiment", text("file of the experiment, beside the job")),
            (
                "accept",
                list(
                    "what looks odd and is meant",
                    one_of("a question", questions.iter().map(String::as_str)),
                ),
            ),
            ("model", one),
            (
                "models",
                said(several, "several models to compare, in place of [model]"),
            ),
            ("priors", priors),
            ("sampler", sampler()),
            ("discovery", discovery()),
            ("likelihood", likelihood()),
            ("figures", figures()),
        ],
    );
    job["oneOf"] = json!([{ "required": ["model"] }, { "required": ["models"] }]);
    let foreign = json!({ "anyOf": [
        { "properties": { "model": is_external() }, "required": ["model"] },
        { "properties": { "models": { "contains": is_external() } }, "required": ["models"] }
    ] });
    job["if"] = foreign;
    job["else"] =
        json!({ "properties": { "priors": { "propertyNames": prior::names_of(&prior::priors()) } } });
    job["definitions"] = json!({ "model": model(), "priors": prior::priors(), "prior": prior::definition() });
    job
}

fn sampler() -> Value {
    let (sample, fit) = (TmcmcSettings::default(), LmSettings::default());
    let (ga, cma_es) = (GaSettings::default(), CmaEsSettings::default());
    let algorithms = AlgorithmName::STATED.map(AlgorithmName::name);
    table(
        "the algorithm and its settings",
        [
            (
                "algorithm",
                usual(
                    one_of("how parameters are found", algorithms),
                    AlgorithmName::Tmcmc.name(),
                ),
            ),
            (
                "seed",
                usual(whole("seed of all random numbers", 0, None), sample.seed),
            ),
            (
                "particles",
                usual(
                    whole(
                        "size of the population, and draws of a stage",
                        0,
                        Some(MAX_PARTICLES as u64),
                    ),
                    sample.particles,
                ),
            ),
            (
                "stages",
                one_of(
                    "tmcmc: independent draws from a mixture, or Metropolis moves",
                    ["draws", "moves"],
                ),
            ),
            (
                "components",
                usual(
                    whole("tmcmc: most components of the mixture", 1, Some(256)),
                    sample.components,
                ),
            ),
            (
                "moves",
                pair_of_whole("least and most Metropolis steps per particle in a stage"),
            ),
            (
                "metamodel_moves",
                usual(
                    whole(
                        "scm: steps of a corrected quasi_static model between two evaluations",
                        0,
                        None,
                    ),
                    sample.metamodel_moves,
                ),
            ),
            (
                "point_estimates",
                list(
                    "fits of the same job beside the sample",
                    one_of(
                        "an algorithm",
                        AlgorithmName::POINT_ESTIMATES.map(AlgorithmName::name),
                    ),
                ),
            ),
            (
                "starts",
                usual(whole("lm: points of the first round", 1, None), fit.starts),
            ),
            (
                "max_evaluations",
                whole(
                    &format!(
                        "lm, cma-es: most evaluations; {} of lm, {} of cma-es",
                        fit.max_evaluations, cma_es.max_evaluations
                    ),
                    1,
                    None,
                ),
            ),
            (
                "difference_step",
                usual(
                    number("lm: shortest difference, in prior widths", 0.0, 0.5),
                    fit.difference_step,
                ),
            ),
            (
                "population",
                whole(
                    &format!("ga, cma-es: individuals of a generation; {} of ga", ga.population),
                    4,
                    None,
                ),
            ),
            (
                "generations",
                usual(whole("ga: most generations", 2, Some(100_000)), ga.generations),
            ),
            (
                "restarts",
                usual(whole("cma-es: most restarts", 0, Some(20)), cma_es.restarts),
            ),
        ],
    )
}

fn pair_of_whole(words: &str) -> Value {
    let mut shape = pair(words);
    shape["items"] = json!({ "type": "integer", "minimum": 1 });
    shape
}

fn discovery() -> Value {
    table(
        "the search for a missing effect",
        [
            (
                "apply",
                usual(one_of("who decides", ["off", "ask", "auto"]), "off"),
            ),
            (
                "max_effects",
                usual(whole("most effects that \"auto\" adds", 1, Some(10)), 3),
            ),
            (
                "other_kind",
                usual(flag("whether the other kind of model is tried too"), false),
            ),
            ("priors", prior::of_candidates()),
        ],
    )
}

fn likelihood() -> Value {
    let words = "model inadequacy per condition, in noise standard deviations";
    let of_one = || {
        either(
            words,
            vec![number("known", 0.0, ANY), one_of("inferred", ["unknown"])],
        )
    };
    let channels = Channel::ALL.map(Channel::name);
    let by_channel = table("of each channel", channels.map(|channel| (channel, of_one())));
    let of_all = usual(
        either(
            words,
            vec![
                number("known", 0.0, ANY),
                one_of("inferred", ["unknown"]),
                by_channel,
            ],
        ),
        0.0,
    );
    let keys = [
        (
            "kind",
            usual(one_of("law of the errors", ["gaussian", "student_t"]), "gaussian"),
        ),
        (
            "degrees_of_freedom",
            number("of student_t; 5 where nothing is said", 1.0, ANY),
        ),
        ("discrepancy", of_all),
    ];
    let keys = keys.into_iter().map(|(key, shape)| (key.to_owned(), shape));
    let quoted = channels.map(|channel| (format!("discrepancy.{channel}"), of_one()));
    table("how measurements scatter around the model", keys.chain(quoted))
}

fn figures() -> Value {
    let value = json!({ "type": "number" });
    table(
        "pictures",
        [(
            "reference",
            named("what an independent test says of parameters", value),
        )],
    )
}
