//! Schemas have the keys and words of the readers, which list them in the message about an unknown key or word.

use std::collections::BTreeSet;

use job::Job;
use serde_json::Value;
use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::model::ModelSettings;

use super::FileKind;

/// A word without a near known word.
const UNKNOWN: &str = "xqjxqjxqjxqjxqjxqjxqjxqjxqjxqjxqjxqjxqjxqjxqjxqj";

/// Returns the message about a file.
fn message(kind: FileKind, text: &str) -> String {
    let error = match kind {
        FileKind::Job => Job::parse("job.toml", text)
            .map(|_| ())
            .map_err(|e| e.to_string()),
        FileKind::Experiment => {
            let files = FileSet {
                toml: text.to_owned(),
                ..FileSet::default()
            };
            Experiment::parse("experiment.toml", &files)
                .map(|_| ())
                .map_err(|e| e.to_string())
        }
        FileKind::Decision => job::read_decision("decision.toml", text)
            .map(|_| ())
            .map_err(|e| e.to_string()),
        FileKind::Effect => formula::Effect::read(text).map(|_| ()).map_err(|e| e.to_string()),
        FileKind::Map => {
            let source = import::SourceFile {
                name: "runs.csv",
                bytes: b"a,b\n1,2\n",
                is_own: true,
            };
            let converted = import::convert(&source, ("map.toml", text), "runs");
            let complaints: Vec<String> = converted.complaints.iter().map(ToString::to_string).collect();
            Err(complaints.join("\n"))
        }
        FileKind::Model => {
            let table: toml::Table = text.parse().unwrap();
            ModelSettings::from_table(&table)
                .map(|_| ())
                .map_err(|e| e.to_string())
        }
        FileKind::Parameters => Ok(()),
    };
    error.expect_err(text)
}

/// Returns the known words that a message lists.
fn known_words(message: &str) -> BTreeSet<String> {
    let (_, list) = message
        .split_once("known are ")
        .unwrap_or_else(|| panic!("{message}"));
    let list = list.lines().next().unwrap_or_default();
    list.split(", ").map(str::to_owned).collect()
}

/// A table of a file: a file that ends with its head, and the place of its shape in the schema.
struct Place {
    kind: FileKind,
    head: &'static str,
    pointer: &'static str,
}

const fn place(kind: FileKind, head: &'static str, pointer: &'static str) -> Place {
    Place { kind, head, pointer }
}

const PLACES: [Place; 18] = [
    place(FileKind::Job, "", ""),
    place(
        FileKind::Job,
        "[model]\nkind = \"scm\"\n[sampler]\n",
        "/properties/sampler",
    ),
    place(
        FileKind::Job,
        "[model]\nkind = \"scm\"\n[discovery]\n",
        "/properties/discovery",
    ),
    place(
        FileKind::Job,
        "[model]\nkind = \"scm\"\n[likelihood]\n",
        "/properties/likelihood",
    ),
    place(
        FileKind::Job,
        "[model]\nkind = \"scm\"\n[figures]\n",
        "/properties/figures",
    ),
    place(FileKind::Experiment, "", ""),
    place(
        FileKind::Experiment,
        "[wheel.w]\nradius_m = 0.1\nwidth_m = 0.1\n",
        "/properties/wheel/additionalProperties",
    ),
    place(
        FileKind::Experiment,
        "[soil.s]\n",
        "/properties/soil/additionalProperties",
    ),
    place(FileKind::Experiment, "[rig]\n", "/properties/rig"),
    place(
        FileKind::Experiment,
        "[campaign]\ntitle = \"a\"\n",
        "/properties/campaign",
    ),
    place(
        FileKind::Experiment,
        "runs = \"r.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.1\n[soil.s]\n[noise]\n",
        "/properties/noise",
    ),
    place(
        FileKind::Experiment,
        "runs = \"r.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.1\n[soil.s]\n[protocol]\n",
        "/properties/protocol",
    ),
    place(
        FileKind::Effect,
        "name = \"a\"\nsummary = \"b\"\nsource = \"c\"\n",
        "",
    ),
    place(
        FileKind::Effect,
        "name = \"a\"\nsummary = \"b\"\nsource = \"c\"\n[parameters.p]\nunit = \"1\"\nprior = 1.0\n",
        "/properties/parameters/additionalProperties",
    ),
    place(FileKind::Map, "", ""),
    place(
        FileKind::Map,
        "[columns.slip]\ncolumn = \"a\"\n",
        "/properties/columns/properties/slip",
    ),
    place(FileKind::Map, "[recording]\n", "/properties/recording"),
    place(
        FileKind::Map,
        "[join.a]\n",
        "/properties/join/additionalProperties",
    ),
];

#[test]
fn a_table_has_the_keys_that_its_reader_knows() {
    for Place { kind, head, pointer } in PLACES {
        let schema = kind.schema();
        let table = schema.pointer(pointer).unwrap_or_else(|| panic!("{pointer}"));
        let keys: BTreeSet<String> = table["properties"].as_object().unwrap().keys().cloned().collect();
        let keys_of_reader = known_words(&message(kind, &format!("{head}{UNKNOWN} = 1\n")));
        assert_eq!(keys_of_reader, keys, "{} {pointer}", kind.name());
        assert_eq!(table["additionalProperties"], Value::Bool(false), "{pointer}");
    }
}

#[test]
fn a_model_has_the_keys_of_ours_and_of_others() {
    let ours = message(FileKind::Model, &format!("kind = \"scm\"\n{UNKNOWN} = 1\n"));
    let other = format!(
        "kind = \"command\"\nprogram = \"a\"\nversion = \"1\"\ninputs = [\"slip\"]\nparameters = [\"n\"]\noutputs = [\"torque_n_m\"]\n{UNKNOWN} = 1\n"
    );
    let mut keys_of_reader = known_words(&ours);
    keys_of_reader.extend(known_words(&message(FileKind::Model, &other)));
    let schema = FileKind::Model.schema();
    let keys = schema["properties"]
        .as_object()
        .unwrap()
        .keys()
        .filter(|key| !key.contains('.'));
    assert_eq!(keys_of_reader, keys.cloned().collect());
}

/// Returns the words that a shape takes, and a wrong one in the notation of TOML.
fn words<'a>(shape: &'a Value) -> Option<(Vec<&'a str>, String)> {
    let strings = |words: &'a Value| {
        words
            .as_array()
            .map(|words| words.iter().filter_map(Value::as_str).collect())
    };
    let quoted = || format!("\"{UNKNOWN}\"");
    if let Some(words) = shape.get("enum").and_then(strings) {
        return Some((words, quoted()));
    }
    if let Some(words) = shape.pointer("/items/enum").and_then(strings) {
        return Some((words, format!("[{}]", quoted())));
    }
    let either = shape.get("anyOf")?.as_array()?.iter();
    let words: Vec<&str> = either
        .filter_map(|shape| strings(shape.get("enum")?))
        .flatten()
        .collect();
    (!words.is_empty()).then(|| (words, quoted()))
}

#[test]
fn a_word_of_a_schema_is_one_of_those_that_its_reader_names() {
    let mut checked = 0;
    let model = place(FileKind::Model, "", "");
    for Place { kind, head, pointer } in PLACES.into_iter().chain([model]) {
        let schema = kind.schema();
        let table = schema.pointer(pointer).unwrap();
        for (key, shape) in table["properties"].as_object().unwrap() {
            let Some((words, wrong)) = words(shape) else {
                continue;
            };
            if kind == FileKind::Job && head.is_empty() && key == "models" {
                continue;
            }
            // A separator is judged where its file is read, and nothing is joined here.
            if head.starts_with("[join.") && key == "separator" {
                continue;
            }
            let head = match (kind, key.as_str()) {
                (FileKind::Model, "kind") => "",
                (FileKind::Model, "inputs" | "outputs") => {
                    "kind = \"command\"\nprogram = \"a\"\nversion = \"1\"\nparameters = [\"n\"]\n"
                }
                (FileKind::Model, _) => "kind = \"scm\"\n",
                _ => head,
            };
            let error = message(kind, &format!("{head}{key} = {wrong}\n"));
            for word in &words {
                assert!(
                    error.contains(word),
                    "{} {key}: {word} is not in: {error}",
                    kind.name()
                );
            }
            checked += words.len();
        }
    }
    assert!(checked > 100, "{checked}");
}
