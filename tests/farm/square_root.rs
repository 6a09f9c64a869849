//! Effects that act like the square root of their strength near zero, where a fit that starts at one prior sd gets stuck.

use farm_tests::job::Job;
use farm_tests::json::float;
use farm_tests::programs::study;

/// Asserts that the truth is named, and that its log Bayes factor agrees with the sampler's within 1.5 nats.
#[track_caller]
fn named(job: &Job, truth: &str, sampled: f64) {
    let discovery = &study(job).1["discovery"];
    assert_eq!(discovery["verdict"], "named", "{discovery:#}");
    assert_eq!(discovery["chosen"], serde_json::json!([truth]));
    let effects = discovery["effects"].as_array().expect("a list");
    let effect = effects.iter().find(|e| e["name"] == truth).expect("the truth");
    let found = float(&effect["log_bayes_factor"]);
    assert!(
        (found - sampled).abs() < 1.5,
        "{found} by the search, {sampled} by the sampler"
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

/// A search from one prior sd gave log Bayes factors of 38 for the truth and 201 for a gain of the torque.
#[test]
fn a_flexible_rim_is_named() {
    named(&Job::data("flexible-rim"), "wheel_flexibility", 288.5);
}

/// A search from one prior sd gave a log Bayes factor of -8, and a probability of 0.97 for a law outside the catalogue.
#[test]
fn soil_that_springs_back_is_named() {
    named(&Job::data("elastic-soil"), "elastic_rebound", 54.7);
}
