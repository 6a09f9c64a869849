//! Laws outside the catalogue in a study that continues its search.

use farm_tests::job::Job;
use farm_tests::json::word;
use farm_tests::programs::study;

#[test]
fn a_model_with_a_law_is_searched_again_to_a_verdict() {
    // The shear stress depends on two variables, of which a law has one, so that a misfit is left after the law.
    let job = Job::data("law-of-two-variables")
        .in_job("particles = 300", "algorithm = \"lm\"")
        .in_job("apply = \"auto\"", "apply = \"auto\"\nmax_effects = 2");
    let (_, summary) = study(&job);
    assert_eq!(summary["status"], "finished");
    let rounds = summary["discovery"]["rounds"].as_array().expect("searches");
    assert_eq!(rounds[0]["verdict"], "not_in_library");
    let law = "scan_shear_v_t";
    assert_eq!(rounds[0]["given"], serde_json::json!([]));
    assert_eq!(rounds[1]["given"], serde_json::json!([law]));
    // An effect that the study has is not found a second time.
    for round in &rounds[1..] {
        let found = word(&round["extension"]["file"]["name"]);
        assert_ne!(found, "shear_v_t.toml");
    }
}
