//! Laws outside the catalogue in a study that goes on.

use farm_tests::job::Job;
use farm_tests::programs::study;
use farm_tests::workspace::{data, text};

/// The shear stress depends on two variables, of which one law has one: something is left after it.
fn of_two_variables() -> Job {
    let file = |name: &str| text(&data("law-of-two-variables").join(name));
    let job = Job {
        experiment: file("experiment.toml"),
        runs: file("runs.csv"),
        job: file("job.toml"),
        others: Vec::new(),
    };
    job.in_job("particles = 300", "algorithm = \"lm\"")
        .in_job("apply = \"auto\"", "apply = \"auto\"\nmax_effects = 2")
}

#[test]
fn a_model_with_a_law_is_searched_again_to_a_verdict() {
    let (_, summary) = study(&of_two_variables());
    assert_eq!(summary["status"], "finished");
    let rounds = summary["discovery"]["rounds"].as_array().expect("searches");
    assert_eq!(rounds[0]["verdict"], "not_in_library");
    let law = "scan_shear_v_t";
    assert_eq!(rounds[0]["given"], serde_json::json!([]));
    assert_eq!(rounds[1]["given"], serde_json::json!([law]));
    // An effect that the study has is not found a second time.
    for round in &rounds[1..] {
        let found = round["extension"]["file"]["name"].as_str().unwrap_or_default();
        assert_ne!(found, "shear_v_t.toml");
    }
}
