//! The three-dimensional model through the farm: forward runs with histories, and the same bytes on any number of threads.

use std::path::{Path, PathBuf};

use farm_tests::assert_contains;
use farm_tests::cylinder::Cylinder;
use farm_tests::job::Job;
use farm_tests::programs::{self, Ended};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::workspace::{root, text};

fn paper(file: &str) -> PathBuf {
    root().join("examples/paper").join(file)
}

/// Simulates the paper's rig and writes `runs.csv` and `histories/` into a folder.
fn simulate(folder: &Path, model: &Path) -> Ended {
    let mut command = programs::worker(["simulate"]);
    command.arg(paper("experiment.toml"));
    command.arg("--model").arg(model);
    command.arg("--parameters").arg(paper("base.toml"));
    command.arg("--out").arg(folder.join("runs.csv"));
    command.arg("--histories").arg(folder.join("histories"));
    programs::run(command)
}

/// Returns the numbers of a column of a CSV file.
pub(crate) fn column(csv: &str, name: &str) -> Vec<f64> {
    let mut lines = csv.lines();
    let header = lines.next().expect("a header");
    let position = header.split(',').position(|h| h == name).expect("the column");
    lines
        .map(|line| {
            let cell = line.split(',').nth(position).expect("a cell");
            cell.parse().expect("a number")
        })
        .collect()
}

#[test]
fn the_papers_rig_gives_averages_and_histories_of_fifty_seconds_at_10_hz() {
    let folder = tempfile::tempdir().unwrap();
    simulate(folder.path(), &paper("model.toml")).success();
    let runs = text(&folder.path().join("runs.csv"));
    let history = text(&folder.path().join("histories/s0.2.csv"));
    let time = column(&history, "t_s");
    assert_eq!(time.len(), 500);
    assert!((time[0] - 0.1).abs() < 1e-12 && (time[499] - 50.0).abs() < 1e-9);
    // The soil carries the wheel load at every time within the tolerance of the balance.
    assert!(
        column(&history, "wheel_load_n")
            .iter()
            .all(|w| (w - 100.0).abs() < 5.0)
    );
    // The time from grouser to grouser is 2 pi / 12 / omega = 6.545 s: the pull repeats after this time, and not after half of it.
    let pull = column(&history, "drawbar_pull_n");
    let after = |lag: usize| {
        let settled = &pull[200..];
        let mean = settled.iter().sum::<f64>() / settled.len() as f64;
        let pairs = settled.iter().zip(&settled[lag..]);
        pairs.map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>()
    };
    assert!(after(65) > 0.5 * after(0), "{} of {}", after(65), after(0));
    assert!(after(33) < after(65));
    // The averages are those of the last four whole periods, filtered: near the plain mean over them.
    let periods = &pull[500 - 4 * 65..];
    let mean = periods.iter().sum::<f64>() / periods.len() as f64;
    assert!(
        (column(&runs, "drawbar_pull_n")[0] - mean).abs() < 0.3,
        "{mean} {runs}"
    );
    assert!((column(&runs, "sinkage_m")[0] - 5.2e-3).abs() < 3e-4, "{runs}");
}

#[test]
fn a_model_without_time_refuses_histories_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("model.toml");
    std::fs::write(&model, "kind = \"quasi_static\"\n").unwrap();
    let error = simulate(folder.path(), &model).refusal();
    assert_contains!(
        error,
        "--histories: quasi_static has only a steady state; use kind = \"scm\""
    );
    assert!(!folder.path().join("runs.csv").exists());
}

#[test]
fn a_wheel_from_an_stl_file_rolls_like_the_rim_it_is_the_surface_of() {
    let averages = |experiment: &str, stl: Option<Vec<u8>>| {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("experiment.toml"), experiment).unwrap();
        std::fs::copy(paper("runs.csv"), at("runs.csv")).unwrap();
        if let Some(stl) = stl {
            std::fs::write(at("wheel.stl"), stl).unwrap();
        }
        let mut command = programs::worker(["simulate"]);
        command.arg(at("experiment.toml"));
        command.arg("--model").arg(paper("model.toml"));
        command.arg("--parameters").arg(paper("base.toml"));
        command.arg("--out").arg(at("out.csv"));
        programs::run(command).success();
        let out = text(&at("out.csv"));
        ["drawbar_pull_n", "torque_n_m", "sinkage_m"].map(|name| column(&out, name)[0])
    };
    let wheel = |more: &str| {
        format!(
            "runs = \"runs.csv\"\n[wheel.exomars]\nradius_m = 0.125\nwidth_m = 0.112\n{more}[soil.wf34]\nrepose_angle_deg = 32.0\n"
        )
    };
    let rim = averages(&wheel(""), None);
    let stl = Cylinder::smooth(180, 0.125, 0.112).binary_stl();
    let mesh = averages(&wheel("mesh = \"wheel.stl\"\n"), Some(stl));
    // With 180 facets the results agree within 1 %; the tests of the physics check the order of convergence.
    for (mesh, rim) in mesh.iter().zip(rim) {
        assert!((mesh / rim - 1.0).abs() < 0.01, "{mesh} {rim}");
    }
}

#[test]
fn a_calibration_of_the_rolling_wheel_is_the_same_on_one_thread_and_on_six() {
    let posterior = |workers: &[(&str, usize)]| {
        let service = Service::start(&[]);
        let id = service.submit(&Job::rolling().sampler(30, [1, 2], 5));
        let _workers: Vec<_> = workers
            .iter()
            .map(|(name, threads)| service.worker(name, *threads))
            .collect();
        service.wait_for(id, "finished");
        service.posterior_csv(id)
    };
    let expected = posterior(&[("alone", 1)]);
    assert_eq!(expected.lines().count(), 31);
    same(&posterior(&[("a", 2), ("b", 1), ("c", 3)]), &expected);
}
