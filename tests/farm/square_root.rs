//! Effects that act like a square root of their strength near zero: a fit from one prior standard deviation sticks.

use farm_tests::job::Job;
use farm_tests::programs::study;

/// The truth is named, and its log Bayes factor is the sampler's within a nat.
#[track_caller]
fn named(job: &Job, truth: &str, sampled: f64) {
    let discovery = &study(job).1["discovery"];
    assert_eq!(discovery["verdict"], "named", "{discovery:#}");
    assert_eq!(discovery["chosen"], serde_json::json!([truth]));
    let effects = discovery["effects"].as_array().expect("a list");
    let own = effects.iter().find(|e| e["name"] == truth).expect("the truth");
    let given = own["log_bayes_factor"].as_f64().expect("a number");
    assert!(
        (given - sampled).abs() < 1.5,
        "{given} by the search, {sampled} by the sampler"
    );
    let sets = discovery["sets"].as_array().expect("a list");
    let total: f64 = sets.iter().filter_map(|set| set["probability"].as_f64()).sum();
    assert!((total - 1.0).abs() < 1e-9, "{total}");
    let order: Vec<(f64, f64)> = sets
        .iter()
        .filter_map(|set| Some((set["probability"].as_f64()?, set["log_bayes_factor"].as_f64()?)))
        .collect();
    let falls = |a: &(f64, f64), b: &(f64, f64)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).is_ge();
    assert!(order.is_sorted_by(falls), "{order:?}");
}

/// Log Bayes factors of 38 and 201 for the truth and for a gain of the torque, before.
#[test]
fn a_flexible_rim_is_named() {
    let job = Job {
        experiment: include_str!("../data/flexible-rim/experiment.toml").into(),
        runs: include_str!("../data/flexible-rim/runs.csv").into(),
        job: include_str!("../data/flexible-rim/job.toml").into(),
        others: Vec::new(),
    };
    named(&job, "wheel_flexibility", 288.5);
}

/// A log Bayes factor of -8, and a law outside the catalogue with a probability of 0.97, before.
#[test]
fn soil_that_springs_back_is_named() {
    let job = Job {
        experiment: include_str!("../data/elastic-soil/experiment.toml").into(),
        runs: include_str!("../data/elastic-soil/runs.csv").into(),
        job: include_str!("../data/elastic-soil/job.toml").into(),
        others: Vec::new(),
    };
    named(&job, "elastic_rebound", 54.7);
}
