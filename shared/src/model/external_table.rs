//! The keys of `[model]` that describe an external model.

use std::collections::BTreeSet;

use super::error::ModelError;
use super::external::{ExternalModel, ExternalParameter, ExternalSource, RunInput};
use super::kind::ModelKind;
use crate::channel::Channel;
use crate::file::{number, unknown_word};
use crate::parameters;

/// The default of the maximum time of a run `[s]`.
const TIME_S: f64 = 60.0;
/// The upper bound of a run's maximum time: a day `[s]`.
const MAX_TIME_S: f64 = 86_400.0;
/// The default of a program's address space \[MB\].
const MEMORY_MB: u64 = 4096;
/// The maximum number of inputs, parameters or outputs.
const MAX_NAMES: usize = 100;

/// The names of the keys.
pub(super) const KEYS: [&str; 9] = [
    "program",
    "url",
    "model",
    "version",
    "inputs",
    "parameters",
    "outputs",
    "time_s",
    "memory_mb",
];

/// Reads the keys in `[model]`; [`ModelError`] names every key that is missing or wrong, with its value and the allowed values.
pub(super) fn external(kind: ModelKind, table: &toml::Table) -> Result<ExternalModel, ModelError> {
    let mut wrong: Vec<String> = Vec::new();
    let (needed, foreign): (&[&str], &[&str]) = match kind {
        ModelKind::Command => (&["program"], &["url", "model"]),
        _ => (&["url", "model"], &["program", "memory_mb"]),
    };
    let kind_name = kind.name();
    for key in foreign.iter().filter(|key| table.contains_key(**key)) {
        wrong.push(format!("{key} has no meaning with kind = \"{kind_name}\""));
    }
    let mut text = |key: &str| match table.get(key) {
        Some(toml::Value::String(text)) if !text.trim().is_empty() => text.clone(),
        Some(other) => {
            wrong.push(format!("{key} = {other} must be a text in quotes"));
            String::new()
        }
        None => {
            wrong.push(format!("kind = \"{kind_name}\" needs {key}"));
            String::new()
        }
    };
    let texts: Vec<String> = needed.iter().map(|key| text(key)).collect();
    let version = text("version");
    let mut check = |checked: Result<(), String>| wrong.extend(checked.err());
    let source = match texts.as_slice() {
        [url, model] => {
            check(is_url(url));
            check(is_word("model", model));
            ExternalSource::Umbridge {
                url: url.trim_end_matches('/').to_owned(),
                model: model.clone(),
            }
        }
        texts => {
            let program = texts.first().cloned().unwrap_or_default();
            check(is_file_name(&program));
            ExternalSource::Command { program }
        }
    };
    check(is_word("version", &version));
    let mut names = |key: &str| {
        let read = names(kind_name, key, table);
        read.unwrap_or_else(|message| {
            wrong.push(message);
            Vec::new()
        })
    };
    let (inputs, parameters, outputs) = (names("inputs"), names("parameters"), names("outputs"));
    let mut read_inputs: Vec<RunInput> = Vec::new();
    for name in &inputs {
        match name.parse() {
            Ok(input) => read_inputs.push(input),
            Err(_) => wrong.push(unknown_word(
                "input",
                name,
                RunInput::ALL.iter().map(|input| input.name()),
            )),
        }
    }
    let mut read_outputs = Vec::new();
    for name in &outputs {
        match Channel::ALL.into_iter().find(|channel| channel.column() == name) {
            Some(channel) => read_outputs.push(channel),
            None => wrong.push(unknown_word("output", name, Channel::ALL.map(Channel::column))),
        }
    }
    let mut read_parameters: Vec<ExternalParameter> = Vec::new();
    for text in &parameters {
        match ExternalParameter::read(text) {
            Some(parameter) => match check_free(&parameter.name) {
                Ok(()) => read_parameters.push(parameter),
                Err(message) => wrong.push(message),
            },
            None => wrong.push(format!(
                "parameters: \"{text}\" needs its unit, as in \"{text} [Pa]\"; \"{text} [1]\" has none"
            )),
        }
    }
    let distinct: BTreeSet<&str> = read_parameters.iter().map(|p| p.name.as_str()).collect();
    if distinct.len() < read_parameters.len() {
        wrong.push("parameters: a name appears twice".to_owned());
    }
    let mut limit = |key: &str, default: f64, max: f64, unit: &str| match table.get(key) {
        None => default,
        Some(value) => match number(value).filter(|v| *v > 0.0 && *v <= max) {
            Some(value) => value,
            None => {
                wrong.push(format!(
                    "{key} = {value} {unit} must be > 0 {unit} and at most {max} {unit}"
                ));
                default
            }
        },
    };
    let time_s = limit("time_s", TIME_S, MAX_TIME_S, "s");
    let memory_mb = limit("memory_mb", MEMORY_MB as f64, 1e9, "MB");
    if !wrong.is_empty() {
        return Err(ModelError::Invalid(wrong.join("; ")));
    }
    Ok(ExternalModel {
        source,
        version,
        inputs: read_inputs,
        parameters: read_parameters,
        outputs: read_outputs,
        time_s,
        memory_mb: (kind == ModelKind::Command).then(|| memory_mb.ceil() as u64),
    })
}

/// Reads a list of distinct names.
fn names(kind: &str, key: &str, table: &toml::Table) -> Result<Vec<String>, String> {
    let Some(value) = table.get(key) else {
        return Err(format!(
            "kind = \"{kind}\" needs {key}: a list of names in quotes"
        ));
    };
    let word = |v: &toml::Value| v.as_str().map(str::to_owned);
    let list: Option<Vec<String>> = value.as_array().and_then(|list| list.iter().map(word).collect());
    let Some(list) = list else {
        return Err(format!("{key} = {value} must be a list of names in quotes"));
    };
    if list.is_empty() || list.len() > MAX_NAMES {
        return Err(format!("{key}: {} names must be 1 to {MAX_NAMES}", list.len()));
    }
    let distinct: BTreeSet<&String> = list.iter().collect();
    match distinct.len() == list.len() {
        true => Ok(list),
        false => Err(format!("{key}: a name appears twice")),
    }
}

/// Checks that a name is not used by an effect, a noise or a key of `[model]`.
fn check_free(name: &str) -> Result<(), String> {
    let is_word = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && name.len() <= 60;
    if !is_word {
        return Err(format!(
            "parameters: \"{name}\" must begin with a letter and consist of at most 60 letters, digits and _"
        ));
    }
    let taken = KEYS.contains(&name)
        || [
            "kind",
            "effects",
            "effect_files",
            "wheel_radius_m",
            "none",
            "noise",
            "bevameter",
        ]
        .contains(&name)
        || name.parse::<RunInput>().is_ok()
        || parameters::SPATIAL.iter().any(|spatial| spatial.name == name)
        || formula::catalogue::find(name).is_some();
    match taken {
        true => Err(format!("parameters: \"{name}\" has another meaning in a job")),
        false => Ok(()),
    }
}

/// Checks a part of a version: it has no space and none of the signs that separate parts.
fn is_word(key: &str, text: &str) -> Result<(), String> {
    let fits = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    match text.len() <= 60 && text.chars().all(fits) {
        true => Ok(()),
        false => Err(format!(
            "{key} = \"{text}\" must consist of at most 60 letters, digits, \".\", \"_\" and \"-\""
        )),
    }
}

fn is_file_name(program: &str) -> Result<(), String> {
    let is_foreign = |c: char| c.is_control() || "/\\ ".contains(c);
    match program.contains(is_foreign) || program.starts_with('.') || program.len() > 100 {
        true => Err(format!(
            "program = {program:?} must be the name of a file without its folder, arguments and control characters: where it lies, the worker's operator says by --allow-model"
        )),
        false => Ok(()),
    }
}

fn is_url(url: &str) -> Result<(), String> {
    let rest = url.strip_prefix("http://").or(url.strip_prefix("https://"));
    match rest.is_some_and(|host| !host.is_empty())
        && !url.contains(|c: char| c.is_whitespace() || c.is_control())
        && url.len() <= 150
    {
        true => Ok(()),
        false => Err(format!("url = {url:?} must be as in \"http://localhost:4242\"")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROGRAM: &str = "program = \"wheel.py\"\nversion = \"1\"\ninputs = [\"slip\", \"wheel_load_n\"]\n\
        parameters = [\"n\", \"stiffness [Pa]\"]\noutputs = [\"drawbar_pull_n\"]\n";

    const SERVER: &str = "url = \"http://h:1/\"\nmodel = \"wheel\"";

    fn read(kind: ModelKind, text: &str) -> Result<ExternalModel, String> {
        external(kind, &text.parse().unwrap()).map_err(|e| e.to_string())
    }

    #[test]
    fn a_program_has_its_limits_and_its_layout() {
        let model = read(ModelKind::Command, PROGRAM).unwrap();
        assert_eq!(model.memory_mb, Some(MEMORY_MB));
        assert_eq!(model.inputs, [RunInput::Slip, RunInput::WheelLoadN]);
        assert_eq!(model.source.name(), "wheel.py");
    }

    #[test]
    fn all_mistakes_are_reported_together() {
        let text = PROGRAM
            .replace("wheel.py", "/bin/sh -c")
            .replace("slip", "slipp")
            .replace(" [Pa]", "")
            + "time_s = -1\nurl = \"x\"\n";
        let message = read(ModelKind::Command, &text).unwrap_err();
        for part in [
            "url has no meaning with kind = \"command\"",
            "program = \"/bin/sh -c\" must be the name of a file",
            "unknown input \"slipp\"; the nearest known is \"slip\"",
            "\"stiffness\" needs its unit",
            "time_s = -1 s must be > 0 s",
        ] {
            assert!(message.contains(part), "{part}: {message}");
        }
    }

    #[test]
    fn a_server_is_its_url_and_the_model_there() {
        let text = PROGRAM.replace("program = \"wheel.py\"", SERVER);
        let model = read(ModelKind::Umbridge, &text).unwrap();
        assert_eq!(model.source.name(), "http://h:1 wheel");
        assert_eq!(model.memory_mb, None);
        let error = read(ModelKind::Umbridge, &text.replace("http://h:1/", "h:1")).unwrap_err();
        assert!(error.contains("http://localhost:4242"), "{error}");
    }

    #[test]
    fn no_name_has_control_characters() {
        let text = PROGRAM.replace("wheel.py", "wheel\\u0000.py");
        let error = read(ModelKind::Command, &text).unwrap_err();
        let message = r#"program = "wheel\0.py" must be the name of a file"#;
        assert!(error.contains(message), "{error}");
        let server = SERVER.replace(":1/", "\\u0000");
        let text = PROGRAM.replace("program = \"wheel.py\"", &server);
        let error = read(ModelKind::Umbridge, &text).unwrap_err();
        assert!(error.contains(r#"url = "http://h\0" must be"#), "{error}");
    }

    #[test]
    fn parameters_take_no_name_that_has_another_meaning() {
        for taken in ["slip", "bulldozing", "time_s", "flow_fraction"] {
            let error = read(ModelKind::Command, &PROGRAM.replace("stiffness", taken)).unwrap_err();
            assert!(error.contains("another meaning"), "{taken}: {error}");
        }
    }
}
