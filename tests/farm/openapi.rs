//! The description of the interface: it says everything of every operation, its examples work, and what it has promised stays.

use std::collections::BTreeSet;

use farm_tests::json::{items, word};
use farm_tests::service::Service;
use farm_tests::workspace::{data, text};
use serde_json::{Value, json};

/// An operation of the description.
struct Operation {
    method: String,
    path: String,
    description: Value,
}

impl Operation {
    fn id(&self) -> &str {
        word(&self.description["operationId"])
    }

    fn example(&self) -> &Value {
        &self.description["requestBody"]["content"]["application/json"]["example"]
    }
}

fn operations(document: &Value) -> Vec<Operation> {
    let paths = document["paths"].as_object().expect("paths");
    let of_path = |(path, methods): (&String, &Value)| {
        let methods = methods.as_object().cloned().unwrap_or_default();
        let path = path.clone();
        methods.into_iter().map(move |(method, description)| Operation {
            method: method.to_uppercase(),
            path: path.clone(),
            description,
        })
    };
    paths.iter().flat_map(of_path).collect()
}

#[test]
fn the_operations_are_those_that_clients_rely_on() {
    let service = Service::start(&[]);
    let operations = operations(&service.client.json("/openapi.json"));
    let served: BTreeSet<String> = operations
        .iter()
        .map(|o| format!("{} {} {}", o.id(), o.method, o.path))
        .collect();
    let listed = text(&data("operations.txt"));
    let listed: BTreeSet<String> = listed.lines().map(str::to_owned).collect();
    let removed: Vec<_> = listed.difference(&served).collect();
    assert!(
        removed.is_empty(),
        "removed or renamed, which /v1 promises not to do: {removed:?}"
    );
    let added: Vec<_> = served.difference(&listed).collect();
    assert!(
        added.is_empty(),
        "new: add these to tests/data/operations.txt: {added:?}"
    );
    assert_eq!(served.len(), operations.len(), "two operations have one id");
}

#[test]
fn every_operation_says_everything() {
    let service = Service::start(&[]);
    let document = service.client.json("/openapi.json");
    let words = |value: &Value| value.as_str().is_some_and(|text| text.len() > 3);
    let tags = document["tags"].as_array().expect("tags");
    assert!(tags.iter().all(|tag| words(&tag["description"])));
    let mut silent = Vec::new();
    for operation in operations(&document) {
        let description = &operation.description;
        let mut lacks = |what: &str| silent.push(format!("{} {}: {what}", operation.method, operation.path));
        for key in ["summary", "description"] {
            if !words(&description[key]) {
                lacks(key);
            }
        }
        if !tags.iter().any(|tag| description["tags"] == json!([tag["name"]])) {
            lacks("one tag of the list");
        }
        for parameter in items(&description["parameters"]) {
            if !words(&parameter["description"]) {
                lacks(&format!("parameter {}", parameter["name"]));
            }
        }
        let responses = description["responses"].as_object().expect("responses");
        for (status, response) in responses {
            if !words(&response["description"]) {
                lacks(&format!("response {status}"));
            }
        }
        let is_answered = |kind: char| responses.keys().any(|status| status.starts_with(kind));
        if !is_answered('2') || !is_answered('4') {
            lacks("an answer that accepts or refuses");
        }
        if description.get("requestBody").is_some() && operation.example().is_null() {
            lacks("an example");
        }
    }
    assert!(silent.is_empty(), "{silent:#?}");
}

#[test]
fn the_examples_of_bodies_work_in_their_order() {
    let service = Service::start(&["--local-workers", "2"]);
    let document = service.client.json("/openapi.json");
    let mut examples: Vec<Operation> = operations(&document)
        .into_iter()
        .filter(|operation| !operation.example().is_null())
        .collect();
    let first = ["create_experiment", "create_calibration"];
    // These need the posterior.
    let last = ["predict", "decide", "follow", "stream"];
    examples.sort_by_key(|operation| {
        let is_last = last.contains(&operation.id());
        let place = first.iter().position(|id| *id == operation.id());
        place.unwrap_or(2 + usize::from(is_last))
    });
    assert!(examples.len() > 5);
    for operation in examples {
        if last.contains(&operation.id()) {
            service.wait_for(1, "finished");
        }
        let path = operation.path.replace("{id}", "1");
        let response = service.client.post(&path, operation.example());
        assert!(
            [200, 201].contains(&response.status),
            "{}: {} {}",
            operation.id(),
            response.status,
            response.body
        );
    }
}
