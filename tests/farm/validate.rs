//! `coordinator validate`: levels left out in turn, in a folder beside the run's.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::{float, whole};
use farm_tests::programs::{call, coordinator, run};
use serde_json::Value;

/// Runs the small job; its folder.
fn calibrated(folder: &Path) -> String {
    let job = Job::small().in_job("moves = [2, 4]", "point_estimates = [\"lm\"]\nmoves = [2, 4]");
    let job = job.write(&folder.join("job")).display().to_string();
    let out = folder.join("out").display().to_string();
    run(coordinator(["run", &job, "--out", &out])).success();
    out
}

fn validate(out: &str, factor: &str, more: &[&str]) -> farm_tests::programs::Ended {
    let all = [&["validate", "1", "--leave-out", factor, "--out", out], more].concat();
    run(coordinator(all))
}

#[test]
fn every_level_is_predicted_from_the_others_and_a_second_call_prints_what_is_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = calibrated(folder.path());
    let text = validate(&out, "slip", &["--format", "json"]).success();
    let validation: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(validation["calibration"], 1);
    assert_eq!(validation["leave_out"], "slip");
    assert_eq!(validation["algorithm"], "lm");
    let levels = validation["levels"].as_array().expect("levels");
    assert!(levels.len() >= 2, "{text}");
    let runs: usize = levels
        .iter()
        .map(|l| l["level"]["runs"].as_array().map_or(0, Vec::len))
        .sum();
    assert_eq!(
        runs, 24,
        "the fitted runs, each once; held-out ones judge nothing"
    );
    for level in levels {
        assert_eq!(level["refused"], Value::Null);
        let judged = &level["judgement"];
        assert_eq!(judged["model"]["all"]["unpredicted"], 0);
        assert!(judged["with_interval"].as_u64() > Some(0));
    }
    let total = &validation["total"];
    assert_eq!(total["model"]["drawbar_pull"]["runs"], 24);
    // These runs have no hidden effect, so that the model predicts an unseen slip to within the noise. Interpolation does not.
    let noise = |key: &str| float(&total[key]["all"]["rmse_fixed_sigma"]);
    assert!((0.7..1.5).contains(&noise("model")), "{total}");
    assert!(noise("interpolation") > 2.0 * noise("model"), "{total}");
    let inside = whole(&total["inside"]);
    assert!((58..=72).contains(&inside), "{inside} of 72");

    // The validation has a separate folder, and the study of the run has no further member.
    let list = |at: &str| run(coordinator(["list", "--out", at])).success().lines().count();
    let (of_run, of_validation) = (list(&out), list(&format!("{out}/validation-1")));
    assert_eq!(of_validation, 1 + levels.len(), "a line for each, and the title");
    let file = Path::new(&out).join("validation-1").join("slip.json");
    assert_eq!(std::fs::read_to_string(&file).expect("the file"), text);
    let again = validate(&out, "slip", &["--format", "json"]).success();
    assert_eq!(again, text);
    assert_eq!(list(&format!("{out}/validation-1")), of_validation);
    assert_eq!(list(&out), of_run);
    let table = validate(&out, "slip", &[]).success();
    assert_contains!(
        table,
        "slip left out in turn, calibrated by lm on the rest",
        "\nleft out ",
        "\nall  "
    );
}

#[test]
fn what_cannot_be_left_out_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = calibrated(folder.path());
    for (factor, reason) in [
        (
            "wheel",
            "all 24 fitted runs are at wheel w: nothing is left to predict it from",
        ),
        (
            "angle",
            "all 24 fitted runs are at slip angle 0.0 deg: nothing is left to predict it from",
        ),
    ] {
        let output = validate(&out, factor, &[]).refusal();
        assert_contains!(output, reason);
    }
    let output = call(
        "coordinator validate 1 --leave-out slip --url http://127.0.0.1:9",
        &[],
    )
    .refusal();
    assert_contains!(output, "validate needs --out");
}
