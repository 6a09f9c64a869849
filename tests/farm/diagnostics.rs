//! Diagnostics through the whole farm: each fault of the data raises its flag, and no other flag is raised.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::{items, word};
use farm_tests::programs::{coordinator, run};
use serde_json::Value;

/// Flags as (kind, channel, text), and what `diagnose` prints.
fn flags(job: Job) -> (Vec<(String, String, String)>, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.sampler(300, [5, 40], 1).write(&folder.path().join("job"));
    let out = folder.path().join("out").display().to_string();
    run(coordinator(["run", &path.display().to_string(), "--out", &out])).success();
    let text = run(coordinator(["diagnose", "--out", &out])).success();
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("summary.json");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let text_of = |flag: &Value, key: &str| word(&flag[key]).to_owned();
    let flags = items(&summary["flags"]);
    let flags = flags.map(|f| (text_of(f, "kind"), text_of(f, "channel"), text_of(f, "text")));
    (flags.collect(), text)
}

/// Returns the job with 8 N more drawbar pull in run r07.
fn with_outlier(job: Job) -> Job {
    job.in_runs(
        "r07,w,s,0.2,60.0,0.024,0,1,22.870089",
        "r07,w,s,0.2,60.0,0.024,0,1,30.870089",
    )
}

#[test]
fn a_job_with_nothing_wrong_has_no_flag_and_says_what_it_knows() {
    let (flags, text) = flags(Job::small());
    assert_eq!(flags, [], "{text}");
    assert_contains!(
        text,
        "every stage reached equilibrium",
        "the assumed errors explain the misfit",
        "the data determine n least",
        "torque         slip_x_sled_speed"
    );
}

/// The soil of these runs yields only after some shear displacement, while that of the model yields at once.
#[test]
fn shear_that_is_mobilised_late_leaves_a_trend_in_pull_or_torque() {
    let job = Job {
        runs: include_str!("../data/shear-mobilisation/runs.csv").into(),
        ..Job::small()
    };
    let (flags, text) = flags(job.in_job("normal = [30.0, 5.7]", "normal = [30.0, 1.5]"));
    let trends: Vec<_> = flags.iter().filter(|f| f.0 == "trend").collect();
    let words = ["at low slip", "at low speed", "slip times speed"];
    assert!(
        trends
            .iter()
            .any(|f| ["drawbar_pull", "torque"].contains(&&*f.1) && words.iter().any(|w| f.2.contains(w))),
        "{flags:?}\n{text}"
    );
}

#[test]
fn a_channel_without_information_is_named_with_its_numbers() {
    let (flags, _) = flags(Job::small().in_experiment("torque_n_m = 0.15", "torque_n_m = 20.0"));
    let words =
        "torque is uninformative: its declared error of 20 N m is 14 times the spread that the prior allows";
    assert_eq!(flags, [("no_information".into(), "torque".into(), words.into())]);
}

#[test]
fn an_outlier_is_named_with_its_run_and_channel() {
    let (flags, _) = flags(with_outlier(Job::small()));
    let outlier = flags.iter().find(|f| f.0 == "outlier").expect("an outlier");
    assert_eq!(outlier.1, "drawbar_pull");
    assert!(
        outlier.2.starts_with("drawbar pull of run r07 lies 7."),
        "{flags:?}"
    );
    assert!(
        flags.iter().all(|f| f.0 == "outlier" || f.0 == "chi2"),
        "{flags:?}"
    );
}

/// Inferred noise grows with the outlier, which still stands out from the other rows of the channel.
#[test]
fn an_outlier_is_found_where_the_noise_is_inferred() {
    let job = Job::small().in_experiment("drawbar_pull_n = 1.2", "drawbar_pull_n = \"unknown\"");
    let (flags, text) = flags(with_outlier(job));
    let found: Vec<(&str, &str)> = flags.iter().map(|f| (f.0.as_str(), f.1.as_str())).collect();
    assert_eq!(found, [("outlier", "drawbar_pull")], "{text}");
}

#[test]
fn errors_that_are_declared_too_small_fail_the_chi_square_of_their_channel() {
    let (flags, _) = flags(Job::small().in_experiment("sinkage_m = 0.0004", "sinkage_m = 0.0002"));
    assert!(
        flags.iter().any(|f| f.0 == "chi2" && f.1 == "sinkage"),
        "{flags:?}"
    );
    assert!(
        flags.iter().all(|f| f.1 != "torque" && f.1 != "drawbar_pull"),
        "{flags:?}"
    );
}

#[test]
fn a_prior_that_the_data_contradict_is_named() {
    let wrong = Job::small().in_job("normal = [30.0, 5.7]", "normal = [20.0, 1.5]");
    let (flags, _) = flags(wrong);
    assert!(flags.iter().all(|f| f.0 == "conflict"), "{flags:?}");
    assert!(
        flags
            .iter()
            .any(|f| f.2.contains("pull friction_angle_deg into the tail of its prior"))
    );
}

#[test]
fn refusals_are_shown_where_they_concentrate() {
    // The prior includes soil that is too soft to carry the wheel.
    let job = Job::small().in_job("uniform = [4.0, 5.6]", "uniform = [2.0, 5.6]");
    let (_, text) = flags(job);
    let words = text
        .lines()
        .find(|line| line.contains("draws from the prior have"));
    let words = words.unwrap_or_else(|| panic!("no region in\n{text}"));
    assert_contains!(words, "log10_p_ref below", "no_support");
    assert_contains!(text, "rejected (of drawn) in each fifth of the prior");
}
