//! `job.toml`.

use serde_json::{Value, json};
use shared::channel::Channel;

use super::model::{is_external, model};
use super::prior;
use super::shape::{either, flag, list, named, number, one_of, said, table, text, usual, whole};

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
            ("sampler", job::sampler_schema()),
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
