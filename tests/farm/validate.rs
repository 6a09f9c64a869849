//! `coordinator validate`: levels left out in turn, in a folder beside the run's.

use std::path::Path;

use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};
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
    assert_eq!(
        (&validation["calibration"], &validation["leave_out"]),
        (&1.into(), &"slip".into())
    );
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
    // Nothing is hidden in these runs, so the model predicts a slip that it has not seen to within its noise; interpolation does not.
    let noise = |of: &str| total[of]["all"]["rmse_fixed_sigma"].as_f64().expect("a number");
    assert!((0.7..1.5).contains(&noise("model")), "{total}");
    assert!(noise("interpolation") > 2.0 * noise("model"), "{total}");
    let inside = total["inside"].as_u64().expect("a count");
    assert!((58..=72).contains(&inside), "{inside} of 72");

    // In a folder of its own: the study of the run has no further member.
    let list = |at: &str| run(coordinator(["list", "--out", at])).success().lines().count();
    let (of_run, of_validation) = (list(&out), list(&format!("{out}/validation-1")));
    assert_eq!(of_validation, 1 + levels.len(), "a line for each, and the title");
    let file = Path::new(&out).join("validation-1").join("slip.json");
    assert_eq!(std::fs::read_to_string(&file).expect("the file"), text);
    let again = validate(&out, "slip", &["--format", "json"]).success();
    assert_eq!(
        (again, list(&format!("{out}/validation-1"))),
        (text, of_validation)
    );
    assert_eq!(list(&out), of_run);
    let table = validate(&out, "slip", &[]).success();
    for words in [
        "slip left out in turn, calibrated by lm on the rest",
        "\nleft out ",
        "\nall  ",
    ] {
        assert!(table.contains(words), "{words} in {table}");
    }
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
        let said = validate(&out, factor, &[]).refusal();
        assert!(said.contains(reason), "{said}");
    }
    let said = run(coordinator([
        "validate",
        "1",
        "--leave-out",
        "slip",
        "--url",
        "http://127.0.0.1:9",
    ]))
    .refusal();
    assert!(said.contains("validate needs --out"), "{said}");
}
