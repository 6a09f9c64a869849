//! Recordings as data: a run's history gives what its averages give. Histories of the model: what the likeliest parameters do
//! over time.

use std::fmt::Write;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run, worker};
use farm_tests::service::Service;
use farm_tests::text::same;
use serde_json::Value;
use shared::experiment::Experiment;
use shared::file::FileSet;

use super::spatial::column;

/// Returns the small job with grousers, whose first run has a column for a history; the channels' fields of that run.
fn job(channels: &str, history: &str) -> Job {
    let small = Job::small()
        .in_experiment(
            "grouser_count = 0",
            "grouser_count = 12\ngrouser_height_m = 0.009\ngrouser_thickness_m = 0.002",
        )
        .in_experiment("[soil.s]", "[soil.s]\n[protocol]\nmeasured_transient_s = 12.0");
    let lines = small.runs.lines().map(|line| match line {
        header if header.starts_with("run,") => format!("{header},history\n"),
        row if row.starts_with("r00,") => format!("r00,w,s,0.05,60.0,0.0095,0,1,{channels},fit,{history}\n"),
        row if row.starts_with('r') => format!("{row},\n"),
        comment => format!("{comment}\n"),
    });
    let runs = lines.collect();
    Job { runs, ..small }
}

/// Returns a minute at 10 Hz of a wheel that digs in and then oscillates with the passing grousers.
fn recording() -> String {
    let mut text = "t_s,drawbar_pull_n,torque_n_m,sinkage_m\n".to_owned();
    for k in 1..=600 {
        let t = 0.1 * f64::from(k);
        let (start, swing) = ((-t / 2.0).exp(), (t * 0.96).sin() + 0.2 * (t * 9.0).cos());
        let _ = writeln!(
            text,
            "{t:.1},{},{},{}",
            8.5 + 0.8 * swing - 8.0 * start,
            2.4 + 0.1 * swing + start,
            0.0055 + 0.0003 * swing - 0.005 * start
        );
    }
    text
}

/// Returns the `posterior.csv` that `run` leaves.
fn posterior(job: &Job) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(&folder.path().join("job")).display().to_string();
    let out = folder.path().join("out");
    run(coordinator(["run", &path, "--out", &out.display().to_string()])).success();
    std::fs::read_to_string(out.join("posterior.csv")).expect("posterior.csv")
}

#[test]
fn a_run_with_a_history_is_calibrated_as_with_its_averages_typed_in() {
    let recorded = job(",,,", "r00.csv").beside("r00.csv", recording());
    let files = FileSet {
        toml: recorded.experiment.clone(),
        files: [("runs.csv", recorded.runs.clone()), ("r00.csv", recording())]
            .map(|(name, text)| (name.to_owned(), text))
            .into(),
    };
    let averages = Experiment::parse("experiment.toml", &files).unwrap().runs[0].measured;
    let [Some(pull), Some(torque), Some(sinkage), None] = averages else {
        panic!("{averages:?}");
    };
    assert!((pull - 8.5).abs() < 0.1 && (torque - 2.4).abs() < 0.02 && (sinkage - 0.0055).abs() < 5e-5);
    let typed = job(&format!("{pull},{torque},{sinkage},"), "");
    let expected = posterior(&typed);
    assert!(expected.lines().count() > 50);
    assert_eq!(posterior(&recorded), expected);
    // Other averages give another posterior.
    let other = job(&format!("{},{torque},{sinkage},", pull + 5.0), "");
    assert_ne!(posterior(&other), expected);
}

#[test]
fn check_says_what_was_cut_and_averaged() {
    let folder = tempfile::tempdir().expect("a folder");
    let job = job(",,,", "r00.csv").beside("r00.csv", recording());
    let path = job.write(folder.path()).display().to_string();
    let text = run(coordinator(["check", &path])).success();
    // 2 pi 0.125 m / 12 at 9.5 mm/s / 0.95 = 10 mm/s: 6.545 s; seven of them fit into 48 s
    assert_contains!(
        text,
        "run r00: 600 samples of 0.100 s in r00.csv; low-pass 0.5 Hz, the first 120 (12 s) cut",
        "over 7 grouser periods of the last 45.81 s",
        "24 fit runs with 72 measurements"
    );
}

#[test]
fn a_wrong_history_is_refused_with_its_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = recording().replace("\n0.3,", "\n0.35,");
    let path = job(",,,", "r00.csv")
        .beside("r00.csv", text)
        .write(folder.path())
        .display()
        .to_string();
    let error = run(coordinator(["check", &path])).refusal();
    assert_contains!(error, "r00.csv line 4: t_s 0.35 s comes");
}

fn numbers(values: &Value) -> Vec<f64> {
    let values = values.as_array().expect("a list").iter();
    values.map(|v| v.as_f64().expect("a number")).collect()
}

#[test]
fn the_likeliest_parameters_of_a_rolling_wheel_leave_their_histories() {
    let rolling = Job::rolling().sampler(30, [1, 2], 5);
    let row = "r00,w,s,0.05,60.0,0.0095,0,1,8.4839442,2.4143027,0.0055360117,,fit";
    let job = Job {
        runs: rolling.runs.replace(",use\n", ",use,history\n"),
        ..rolling
    }
    .in_runs(row, "r00,w,s,0.05,60.0,0.0095,0,1,,2.4143027,,,fit,r00.csv")
    .in_runs("0.0051850208,,fit", "0.0051850208,,fit,")
    .in_experiment("[soil.s]", "[soil.s]\n[protocol]\nmeasured_transient_s = 12.0")
    .beside("r00.csv", recording().replace("torque_n_m", "wheel_load_n"));
    let service = Service::start(&[]);
    let id = service.submit(&job);
    let _worker = service.worker("a", 2);
    service.wait_for(id, "finished");
    let histories = service.result(id, "histories");
    let histories = histories.as_array().expect("a list");
    let named: Vec<String> = histories
        .iter()
        .map(|h| format!("{}/{}", h["channel"], h["run"]).replace('"', ""))
        .collect();
    let expected = "drawbar_pull/r00 drawbar_pull/r01 torque/r00 torque/r01 sinkage/r00 sinkage/r01";
    assert_eq!(named.join(" "), expected);
    let pull = &histories[0];
    assert_eq!(pull["unit"], "N");
    assert_eq!(pull["model"][0]["label"], "maximum likelihood");
    let recorded = column(&recording(), "drawbar_pull_n");
    assert_eq!(numbers(&pull["measured"]["raw"]), recorded);
    let filtered = numbers(&pull["measured"]["value"]);
    assert!(filtered.len() == recorded.len() && filtered != recorded);
    assert!((numbers(&pull["measured"]["t_s"])[599] - 60.0).abs() < 1e-9);
    assert!(histories[1]["measured"].is_null());

    // The histories have the bits of a forward run with the likeliest parameters.
    let csv = service.posterior_csv(id);
    let log_likelihood = column(&csv, "log_likelihood");
    let best = (0..log_likelihood.len()).fold(0, |a, b| {
        if log_likelihood[b] > log_likelihood[a] {
            b
        } else {
            a
        }
    });
    let header = csv.lines().next().expect("a header");
    let theta = header
        .split(',')
        .skip(2)
        .map(|name| format!("{name} = {}\n", column(&csv, name)[best]));
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(folder.path());
    let at = |name: &str| folder.path().join(name);
    std::fs::write(
        at("theta.toml"),
        format!("kappa = 0.0\n{}", theta.collect::<String>()),
    )
    .expect("a file");
    let mut command = worker(["simulate"]);
    command.arg(at("experiment.toml")).arg("--model").arg(path);
    command
        .arg("--parameters")
        .arg(at("theta.toml"))
        .arg("--out")
        .arg(at("out.csv"));
    run({
        command.arg("--histories").arg(at("histories"));
        command
    })
    .success();
    let forward = std::fs::read_to_string(at("histories/r01.csv")).expect("a history");
    let torque = &histories[3]["model"][0];
    assert_eq!(numbers(&torque["raw"]), column(&forward, "torque_n_m"));
    assert_eq!(numbers(&torque["t_s"]).len(), numbers(&torque["value"]).len());

    // A model with a steady state alone has no histories.
    let still = service.calibrate(&Job::small());
    let none = service.result(still, "histories");
    assert!(none.is_null(), "{none}");
    same(&service.posterior_csv(id), &csv);
}

/// The last simulation also computes the readings of rings and the derivatives by the soil's stiffness, which the likelihood needs.
#[test]
fn histories_do_not_replace_readings_of_rings_or_derivatives() {
    let job = Job::rolling()
        .sampler(30, [1, 2], 5)
        .in_experiment(
            "runs = \"runs.csv\"",
            "runs = \"runs.csv\"\nshear = \"rings.csv\"",
        )
        .in_experiment(
            "[noise]",
            "[noise]\nring_scatter = 0.12\nring_noise = 0.03\nrun_scatter = 0.05",
        )
        .beside(
            "rings.csv",
            "test,normal_stress_pa,shear_displacement_m,shear_stress_pa\nr,5000,0.08,2884.7\n",
        );
    let service = Service::start(&[]);
    let id = service.submit(&job);
    let _worker = service.worker("a", 2);
    service.wait_for(id, "finished");
    let diagnostics = service.result(id, "diagnostics");
    let data = diagnostics["residuals"].as_array().map_or(0, Vec::len);
    assert_eq!(data, 7, "{diagnostics}");
}
