//! A parameter at its limit, where the job holds another value: the search turns it to the limit.

use farm_tests::job::Job;
use farm_tests::programs::{run, study, worker};
use farm_tests::workspace::text;

#[test]
fn a_soil_without_a_reference_velocity_is_told_from_a_wrong_encoder_radius() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let quiet = Job::small()
        .in_experiment("drawbar_pull_n = 1.2", "drawbar_pull_n = 0.6")
        .in_experiment("torque_n_m = 0.15", "torque_n_m = 0.075")
        .in_experiment("sinkage_m = 0.0004", "sinkage_m = 0.0002");
    quiet.write(folder.path());
    std::fs::write(path("model.toml"), "kind = \"quasi_static\"\n").expect("a model");
    let truth = "k_c = 0.0\nk_phi = 6241438.5\nn = 1.118\nfriction_angle_deg = 27.87\nwheel_radius_m = 0.1285\nshear_velocity_m_s = 0.0\n";
    std::fs::write(path("parameters.toml"), truth).expect("parameters");
    let mut simulate = worker(["simulate", "--noise-seed", "1"]);
    simulate.arg(path("experiment.toml"));
    simulate.arg("--model").arg(path("model.toml"));
    simulate.arg("--parameters").arg(path("parameters.toml"));
    run({
        simulate.arg("--out").arg(path("simulated.csv"));
        simulate
    })
    .success();
    let job = Job {
        runs: text(&path("simulated.csv")),
        ..quiet
    }
    .in_job("shear_velocity_m_s = 0.001", "shear_velocity_m_s = 0.0005")
    .in_job(
        "algorithm = \"tmcmc\"\nparticles = 60\nmoves = [2, 4]",
        "algorithm = \"lm\"",
    )
    .in_job("[sampler]", "[discovery]\napply = \"auto\"\n[sampler]");
    let (_, summary) = study(&job);
    let rounds = summary["discovery"]["rounds"].as_array().expect("searches");
    assert_eq!(rounds[0]["verdict"], "named", "{}", rounds[0]["text"]);
    assert_eq!(rounds[0]["extension"]["effect"], "shear_velocity_zero");
    let words = rounds[0]["text"].as_str().expect("a sentence");
    let claim = "shear_velocity_m_s = 0.0 fits: the shear stress does not depend on the slip velocity (";
    assert!(words.starts_with(claim), "{words}");
    let is_wrong = |round: &serde_json::Value| round["extension"]["effect"] == "slip_radius_error";
    assert!(!rounds.iter().any(is_wrong), "{words}");
    let added = &summary["calibrations"][1]["effects"];
    assert_eq!(*added, serde_json::json!(["shear_velocity_zero"]));
}
