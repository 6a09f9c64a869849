//! `worker simulate`: forward runs against another implementation of the model.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{self, Ended};
use farm_tests::workspace::{data, text};

/// Noise of the experiment: drawbar pull `[N]`, torque [N m], sinkage `[m]`.
const NOISE_SD: [f64; 3] = [1.2, 0.15, 4e-4];
const CHANNELS: [&str; 3] = ["drawbar_pull_n", "torque_n_m", "sinkage_m"];

fn simulate(out: &Path, more: &[&str]) -> Ended {
    let file = |name: &str| data("nothing-hidden").join(name).display().to_string();
    let mut command = programs::worker(["simulate", &file("experiment.toml")]);
    command.args([
        "--model",
        &file("model.toml"),
        "--parameters",
        &file("parameters.toml"),
    ]);
    command.arg("--out").arg(out).args(more);
    programs::run(command)
}

/// Returns the three channels of each run, in the order of the file.
fn channels(csv: &str) -> Vec<(String, [f64; 3])> {
    let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let position = |name: &str| {
        header
            .iter()
            .position(|h| *h == name)
            .unwrap_or_else(|| panic!("no column {name}"))
    };
    let (run, columns) = (position("run"), CHANNELS.map(position));
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            (
                cells[run].to_owned(),
                columns.map(|c| cells[c].parse().expect("a number")),
            )
        })
        .collect()
}

#[test]
fn forward_runs_reproduce_another_implementation_within_a_twentieth_of_the_noise() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("runs.csv");
    simulate(&out, &[]).success();
    let got = channels(&text(&out));
    let expected = channels(&text(&data("nothing-hidden/noise_free.csv")));
    assert_eq!(expected.len(), 40);
    assert_eq!(got.len(), 40);
    for ((run, got), (name, expected)) in got.iter().zip(&expected) {
        assert_eq!(run, name);
        for c in 0..3 {
            let off = (got[c] - expected[c]).abs() / NOISE_SD[c];
            assert!(
                off < 0.05,
                "{run}: {} {} is {off:.3} sd from {}",
                CHANNELS[c],
                got[c],
                expected[c]
            );
        }
    }
}

#[test]
fn a_forward_run_has_the_columns_and_conditions_of_its_experiment() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("runs.csv");
    simulate(&out, &[]).success();
    let written = text(&out);
    let given = text(&data("nothing-hidden/runs.csv"));
    let conditions = |csv: &str| -> Vec<String> {
        let rows = csv.lines().filter(|line| !line.starts_with('#')).skip(1);
        rows.map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let numbers = cells[3..8]
                .iter()
                .map(|cell| cell.parse::<f64>().expect("a number").to_string());
            let ends = [cells[0], cells[1], cells[2], cells[12]].map(str::to_owned);
            ends.into_iter().chain(numbers).collect::<Vec<_>>().join(" ")
        })
        .collect()
    };
    let header = |csv: &str| csv.lines().find(|line| !line.starts_with('#')).map(str::to_owned);
    assert_eq!(header(&written), header(&given));
    assert_eq!(conditions(&written), conditions(&given));
}

#[test]
fn simulated_noise_is_reproducible_and_has_the_declared_sd() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    simulate(&path("clean"), &[]).success();
    for (name, seed) in [("a", "7"), ("again", "7"), ("b", "8")] {
        simulate(&path(name), &["--noise-seed", seed]).success();
    }
    assert_eq!(text(&path("a")), text(&path("again")));
    assert_ne!(text(&path("a")), text(&path("b")));
    let clean = channels(&text(&path("clean")));
    for c in 0..3 {
        let noise: Vec<f64> = ["a", "b"]
            .iter()
            .flat_map(|name| channels(&text(&path(name))))
            .zip(clean.iter().chain(&clean))
            .map(|((_, noisy), (_, clean))| (noisy[c] - clean[c]) / NOISE_SD[c])
            .collect();
        // 80 standard normal draws: mean within 0.45 (4 standard errors), variance within 0.64 of 1 (4 of 0.16).
        let mean = noise.iter().sum::<f64>() / noise.len() as f64;
        let variance = noise.iter().map(|e| e * e).sum::<f64>() / noise.len() as f64;
        assert_eq!(noise.len(), 80);
        assert!(mean.abs() < 0.45, "{}: mean {mean}", CHANNELS[c]);
        assert!(
            (variance - 1.0).abs() < 0.64,
            "{}: variance {variance}",
            CHANNELS[c]
        );
    }
}

#[test]
fn simulated_runs_are_read_by_their_own_experiment() {
    let folder = tempfile::tempdir().unwrap();
    let small = Job::small();
    let header = small.runs.lines().find(|line| line.starts_with("run,")).unwrap();
    let more = |line: &str| match line {
        comment if comment.starts_with('#') => comment.to_owned(),
        line if line == header => format!("{line},lateral_force_n_sd,order,prepared,session,zero,operator"),
        line if line.starts_with("r00") => format!("{line},0.5,1,bed 1,day 1,tare 1,Ada"),
        line => format!("{line},,2,bed 2,day 2,,"),
    };
    let runs: String = small.runs.lines().map(|line| more(line) + "\n").collect();
    // The second job has the noise of a channel in one row alone, and preparations.
    let prepared = "sinkage_m = 0.0004\npreparation_scatter = 0.05";
    let jobs = [
        Job::small(),
        Job { runs, ..small }.in_experiment("sinkage_m = 0.0004", prepared),
    ];
    for (k, job) in jobs.into_iter().enumerate() {
        let folder = folder.path().join(k.to_string());
        let job = job.write(&folder);
        let at = |name: &str| folder.join(name).display().to_string();
        let mut command = programs::worker(["simulate", &at("experiment.toml"), "--noise-seed", "7"]);
        for (flag, file) in [("--model", "model.toml"), ("--parameters", "parameters.toml")] {
            command.arg(flag).arg(data("nothing-hidden").join(file));
        }
        command.arg("--out").arg(at("runs.csv"));
        programs::run(command).success();
        let output = programs::run(programs::coordinator(["check", &job.display().to_string()])).success();
        assert_contains!(output, "24 fit runs with 7");
        let lateral: Vec<String> = text(&folder.join("runs.csv"))
            .lines()
            .skip(1)
            .map(|line| line.split(',').nth(11).unwrap_or_default().to_owned())
            .collect();
        assert_eq!(lateral.iter().filter(|cell| !cell.is_empty()).count(), k);
    }
}
