//! JSON schemas of the tables of a job, derived from the types that read them.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use crate::table::algorithm_settings::AlgorithmName;
use crate::table::sampler::ALGORITHMS;

/// The schema of `[sampler]`: the keys of every algorithm in one table, as editors complete it.
pub fn sampler_schema() -> Value {
    let names = ALGORITHMS.map(|algorithm| algorithm.name);
    let mut of_keys: BTreeMap<&str, Vec<(&str, Value)>> = BTreeMap::new();
    for algorithm in &ALGORITHMS {
        let schema = (algorithm.schema)().to_value();
        for key in (algorithm.keys)() {
            let property = resolved(&schema, &schema["properties"][key]);
            of_keys
                .entry(key)
                .or_default()
                .push((algorithm.name.name(), property));
        }
    }
    let mut properties = json!({ "algorithm": {
        "type": "string", "enum": names, "default": AlgorithmName::Tmcmc, "description": "how parameters are found"
    } });
    for (key, of_algorithms) in of_keys {
        properties[key] = merged(&of_algorithms);
    }
    json!({
        "type": "object",
        "description": "the algorithm and its settings",
        "properties": properties,
        "additionalProperties": false,
    })
}

/// A property with what it refers to in its place, and without the null that TOML does not have.
fn resolved(schema: &Value, property: &Value) -> Value {
    let mut whole = property.clone();
    let parts = [&property["anyOf"], &property["allOf"]];
    let parts = parts.into_iter().filter_map(Value::as_array).flatten();
    for part in parts.chain([property]) {
        let Some(name) = part["$ref"].as_str() else {
            continue;
        };
        let known = schema
            .pointer(name.trim_start_matches('#'))
            .unwrap_or(&Value::Null);
        for (key, value) in known.as_object().into_iter().flatten() {
            if whole[key].is_null() {
                whole[key] = value.clone();
            }
        }
    }
    if let Some(whole) = whole.as_object_mut() {
        let is_reference = |key: &str| ["$ref", "anyOf", "allOf"].contains(&key);
        let is_no_default = |key: &str, value: &Value| key == "default" && value.is_null();
        whole.retain(|key, value| !(is_reference(key) || is_no_default(key, value)));
        if let Some(kinds) = whole.get_mut("type")
            && let Some(kind) = kinds
                .as_array()
                .and_then(|kinds| kinds.iter().find(|kind| *kind != "null"))
        {
            *kinds = kind.clone();
        }
    }
    whole
}

/// The property of a key that several algorithms take: the widest bounds, and what differs in words.
fn merged(of_algorithms: &[(&str, Value)]) -> Value {
    let [(_, first), rest @ ..] = of_algorithms else {
        return Value::Null;
    };
    let mut one = first.clone();
    for (_, other) in rest {
        for (key, is_wider) in [
            ("minimum", f64::lt as fn(&f64, &f64) -> bool),
            ("maximum", f64::gt),
        ] {
            let bounds = (one[key].as_f64(), other[key].as_f64());
            if let (Some(now), Some(new)) = bounds
                && is_wider(&new, &now)
            {
                one[key] = other[key].clone();
            }
        }
    }
    let differs = |key: &str| rest.iter().any(|(_, other)| other[key] != first[key]);
    if let Some(table) = one.as_object_mut()
        && differs("default")
    {
        table.remove("default");
    }
    one["description"] = words(of_algorithms, differs("default")).into();
    one
}

/// The descriptions of a key that several algorithms take, each with the algorithms that it is about.
fn words(of_algorithms: &[(&str, Value)], with_default: bool) -> String {
    let mut by_words: Vec<(String, Vec<&str>)> = Vec::new();
    for (name, property) in of_algorithms {
        let mut words = property["description"].as_str().unwrap_or_default().to_owned();
        if let Some(default) = property.get("default").filter(|_| with_default) {
            words += &format!(" Default {default}.");
        }
        match by_words.iter_mut().find(|(known, _)| *known == words) {
            Some((_, names)) => names.push(name),
            None => by_words.push((words, vec![name])),
        }
    }
    let about = |(words, names): &(String, Vec<&str>)| match names.len() == ALGORITHMS.len() {
        true => words.clone(),
        false => format!("{}: {words}", names.join(", ")),
    };
    let words: Vec<String> = by_words.iter().map(about).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows of the tables of a section of docs/job.md, each as its cells.
    fn rows(section: &str) -> Vec<Vec<String>> {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/job.md");
        let text = std::fs::read_to_string(path).unwrap();
        let (_, rest) = text.split_once(&format!("\n### {section}\n")).unwrap();
        let lines = rest.lines().take_while(|line| !line.starts_with("###"));
        let rows = lines.filter(|line| line.starts_with("| `"));
        let cells = |row: &str| {
            row.trim_matches('|')
                .split(" | ")
                .map(|cell| cell.trim().to_owned())
                .collect()
        };
        rows.map(cells).collect()
    }

    /// A number as the documents write it: `10,000`, but `1000`.
    fn written(number: &Value) -> String {
        let text = number.to_string();
        match text.len() {
            5.. if number.is_u64() => {
                let (head, tail) = text.split_at(text.len() - 3);
                format!(
                    "{},{tail}",
                    written(&head.parse::<u64>().unwrap().into()).replace("1000", "1,000")
                )
            }
            _ => text.replace(',', ", "),
        }
    }

    #[test]
    fn the_document_has_the_keys_defaults_and_bounds_of_the_sampler() {
        let rows = rows("[sampler]");
        let row = |key: &str| {
            let row = rows.iter().find(|row| row[0] == format!("`{key}`"));
            row.unwrap_or_else(|| panic!("no row of {key}"))
        };
        for algorithm in &ALGORITHMS {
            let name = algorithm.name.name();
            let stated = row(&format!("\"{name}\""));
            let keys = (algorithm.keys)().iter().filter(|key| **key != "seed");
            let keys: Vec<String> = keys.map(|key| format!("`{key}`")).collect();
            assert_eq!(stated[2], keys.join(", "), "{name}");
            let schema = (algorithm.schema)().to_value();
            for key in (algorithm.keys)() {
                let property = resolved(&schema, &schema["properties"][key]);
                let [_, _, usual, meaning] = &row(key)[..] else {
                    panic!("{key}")
                };
                if let Some(default) = property.get("default") {
                    assert!(usual.contains(&written(default)), "{key}: {usual}, {default}");
                }
                for place in [&property, &property["items"]] {
                    let bounds = [&place["minimum"], &place["maximum"]];
                    // Whatever is counted is at least 0 or 1.
                    let bounds = bounds
                        .into_iter()
                        .filter(|bound| bound.is_number() && bound.as_u64().is_none_or(|count| count > 1));
                    for bound in bounds {
                        let words = format!("{} {meaning}", row(key)[1]);
                        assert!(words.contains(&written(bound)), "{key}: {words}, {bound}");
                    }
                }
            }
        }
        let schema = sampler_schema();
        let known = schema["properties"].as_object().unwrap();
        let stated = rows.iter().map(|row| row[0].trim_matches('`'));
        let stated: std::collections::BTreeSet<&str> = stated.filter(|key| !key.starts_with('"')).collect();
        assert_eq!(stated, known.keys().map(String::as_str).collect());
    }
}
