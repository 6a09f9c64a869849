//! The schema of the table `[sampler]`, merged from the schemas of all algorithms.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use crate::table::algorithm_settings::AlgorithmName;
use crate::table::sampler::ALGORITHMS;

/// Returns the schema of `[sampler]`: the keys of every algorithm in one table.
pub(super) fn sampler() -> Value {
    let names = ALGORITHMS.map(|algorithm| algorithm.name);
    let mut by_key: BTreeMap<&str, Vec<(&str, Value)>> = BTreeMap::new();
    for algorithm in &ALGORITHMS {
        let schema = (algorithm.schema)();
        for key in (algorithm.keys)() {
            let property = schema["properties"][key].clone();
            by_key
                .entry(key)
                .or_default()
                .push((algorithm.name.name(), property));
        }
    }
    let mut properties = json!({ "algorithm": {
        "type": "string", "enum": names, "default": AlgorithmName::Tmcmc, "description": "Algorithm that finds the parameters."
    } });
    for (key, variants) in by_key {
        properties[key] = merged(&variants);
    }
    json!({
        "type": "object",
        "description": "The algorithm and its settings.",
        "properties": properties,
        "additionalProperties": false,
    })
}

/// Merges the property of a key that several algorithms take: with the widest bounds, and differences stated in the description.
fn merged(variants: &[(&str, Value)]) -> Value {
    let [(_, first), rest @ ..] = variants else {
        return Value::Null;
    };
    let mut merged = first.clone();
    for (_, other) in rest {
        for (key, is_wider) in [
            ("minimum", f64::lt as fn(&f64, &f64) -> bool),
            ("maximum", f64::gt),
        ] {
            let bounds = (merged[key].as_f64(), other[key].as_f64());
            if let (Some(now), Some(new)) = bounds
                && is_wider(&new, &now)
            {
                merged[key] = other[key].clone();
            }
        }
    }
    let differs = |key: &str| rest.iter().any(|(_, other)| other[key] != first[key]);
    if let Some(table) = merged.as_object_mut()
        && differs("default")
    {
        table.remove("default");
    }
    merged["description"] = description(variants, differs("default")).into();
    merged
}

/// Joins the descriptions of a key that several algorithms take, each with the names of its algorithms.
fn description(variants: &[(&str, Value)], with_default: bool) -> String {
    let mut by_words: Vec<(String, Vec<&str>)> = Vec::new();
    for (name, property) in variants {
        let mut words = property["description"].as_str().unwrap_or_default().to_owned();
        if let Some(default) = property.get("default").filter(|_| with_default) {
            words += &format!(" Default {default}.");
        }
        match by_words.iter_mut().find(|(stated, _)| *stated == words) {
            Some((_, names)) => names.push(name),
            None => by_words.push((words, vec![name])),
        }
    }
    let with_names = |(words, names): &(String, Vec<&str>)| match names.len() == ALGORITHMS.len() {
        true => words.clone(),
        false => format!("{}: {words}", names.join(", ")),
    };
    let words: Vec<String> = by_words.iter().map(with_names).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the rows of the tables of a section of docs/job.md, each as its cells.
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

    /// Returns a number as the documents write it: `10,000`, but `1000`.
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
            let schema = (algorithm.schema)();
            for key in (algorithm.keys)() {
                let property = &schema["properties"][key];
                let [_, _, usual, meaning] = &row(key)[..] else {
                    panic!("{key}")
                };
                if let Some(default) = property.get("default") {
                    assert!(usual.contains(&written(default)), "{key}: {usual}, {default}");
                }
                for place in [property, &property["items"]] {
                    let bounds = [&place["minimum"], &place["maximum"]];
                    // The document does not state that a count is at least 0 or 1.
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
        let schema = sampler();
        let keys = schema["properties"].as_object().unwrap();
        let stated = rows.iter().map(|row| row[0].trim_matches('`'));
        let stated: std::collections::BTreeSet<&str> = stated.filter(|key| !key.starts_with('"')).collect();
        assert_eq!(stated, keys.keys().map(String::as_str).collect());
    }
}
