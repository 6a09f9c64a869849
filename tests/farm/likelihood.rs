//! Error models through the whole farm: heavy tails, discrepancy, scatter of the soil, plates and rings.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::study;
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;
use serde_json::Value;

use super::point_fit::fit;

fn likelihood(keys: &str) -> Job {
    let small = Job::small();
    let job = format!("{}[likelihood]\n{keys}\n", small.job);
    Job { job, ..small }
}

/// Summary without what differs from run to run.
fn timeless(mut summary: Value) -> Value {
    summary["calibrations"][0]["wall_s"] = Value::Null;
    summary
}

#[test]
fn an_error_model_of_nothing_changes_no_number() {
    let (_, plain) = study(&Job::small());
    let zero = likelihood("kind = \"gaussian\"\ndiscrepancy = 0.0")
        .in_experiment("[noise]", "[noise]\nrun_scatter = 0.0\nplate_scatter = 0.3");
    let (text, summary) = study(&zero);
    assert_eq!(timeless(summary), timeless(plain));
    assert!(!text.contains("noise sds in each condition"), "{text}");
}

#[test]
fn each_error_model_is_said_and_widens_the_intervals() {
    let covered = |summary: &Value, rows: &str| {
        let coverage = &summary["calibrations"][0]["coverage90"][rows];
        coverage.as_f64().expect("a share")
    };
    let (_, plain) = study(&Job::small());
    let scatter =
        |value: &str| Job::small().in_experiment("[noise]", &format!("[noise]\nrun_scatter = {value}"));
    for (job, words) in [
        (
            likelihood("kind = \"student_t\""),
            "Student's t with 5 degrees of freedom",
        ),
        (likelihood("discrepancy = 2.0"), "may be off by 2 noise sds"),
        (
            likelihood("discrepancy = \"unknown\""),
            "m of each channel is marginalised over 17 values from 0.25 to 64, uniform in log m",
        ),
        (scatter("0.1"), "scatters from run to run, relative sd 0.1;"),
    ] {
        let (text, summary) = study(&job);
        assert!(text.contains(words), "{words} in\n{text}");
        assert_eq!(summary["status"], "finished");
        for rows in ["fit", "holdout"] {
            let (wider, usual) = (covered(&summary, rows), covered(&plain, rows));
            assert!(wider >= usual, "{words}: {rows} {wider} below {usual}");
        }
        assert_eq!(
            text.contains("probability of each m"),
            words.contains("marginalised")
        );
    }
    let (_, summary) = study(&scatter("\"unknown\""));
    let scatter = &summary["calibrations"][0]["parameters"]["noise.run_scatter"];
    // The data have no scatter, so that the posterior mean is far below the prior mean of 0.16.
    assert!(scatter["mean"].as_f64().is_some_and(|m| m < 0.05), "{scatter}");
}

/// A fit also needs derivatives, which are read back from the store.
#[test]
fn killing_the_coordinator_amid_a_fit_with_scatter_changes_no_byte() {
    let job = fit().in_experiment("[noise]", "[noise]\nrun_scatter = 0.05");
    let job = Job {
        job: format!(
            "{}[likelihood]\nkind = \"student_t\"\ndiscrepancy = \"unknown\"\n",
            job.job
        ),
        ..job
    };
    let result = |service: &Service, id: i64| {
        let mut summary = service.result(id, "summary");
        summary["point_estimates"][0]["wall_s"] = Value::Null;
        format!("{summary:#}")
    };
    let expected = {
        let service = Service::start(&["--local-workers", "1"]);
        let id = service.calibrate(&job);
        result(&service, id)
    };
    let mut service = Service::start(&[]);
    let id = service.submit(&job);
    let _worker = service.worker("worker", 1);
    until("progress", || service.evaluations(id).filter(|&n| n >= 5));
    service.crash();
    service.wait_for(id, "finished");
    same(&result(&service, id), &expected);
    assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
}

/// Returns readings of Bekker's law at `k_c` = 2e4, `k_phi` = 1e7, n = 1, each test off by its own few per cent.
fn plates() -> String {
    let mut csv = "test,plate_radius_m,sinkage_m,pressure_pa\n".to_owned();
    for (test, (radius, shift)) in [
        (0.03, 1.03),
        (0.03, 0.98),
        (0.06, 0.97),
        (0.06, 1.02),
        (0.12, 1.01),
        (0.12, 0.99),
    ]
    .into_iter()
    .enumerate()
    {
        for i in 1..=8 {
            let z = 0.003 * f64::from(i);
            let wiggle = if i % 2 == 0 { 1.01 } else { 0.99 };
            let p = (2e4 / radius + 1e7) * z * shift * wiggle;
            csv += &format!("t{test},{radius},{z},{p}\n");
        }
    }
    csv
}

/// Returns readings of rings at c = 500 Pa, Phi = 30 deg, K = 12 mm.
fn shear() -> String {
    let mut csv = "test,normal_stress_pa,shear_displacement_m,shear_stress_pa\n".to_owned();
    for (test, (sigma, shift)) in [(5e3, 1.01), (2e4, 0.99), (4e4, 1.0)].into_iter().enumerate() {
        for i in 1..=10 {
            let j = 0.004 * f64::from(i);
            let tau = (500.0 + sigma * (30.0_f64).to_radians().tan()) * (1.0 - (-j / 0.012).exp()) * shift;
            csv += &format!("r{test},{sigma},{j},{tau}\n");
        }
    }
    csv
}

const BEVAMETER: &str = r#"experiment = "experiment.toml"
[model]
kind = "quasi_static"
effects = ["janosi_hanamoto"]
[priors]
log10_p_ref = { uniform = [4.0, 6.0] }
kappa = { uniform = [-0.9, 1.0] }
n = { uniform = [0.6, 1.6] }
friction_angle_deg = { uniform = [10.0, 50.0] }
cohesion_pa = { uniform = [0.0, 5000.0] }
"janosi_hanamoto.shear_modulus_m" = { lognormal = [0.01, 2.5] }
"bevameter.ln_transfer" = 0.0
[sampler]
algorithm = "lm"
"#;

#[test]
fn plates_and_rings_alone_are_fitted_without_a_wheel() {
    let job = Job {
        experiment: "plates = \"plates.csv\"\nshear = \"shear.csv\"\n[soil.s]\n".into(),
        job: BEVAMETER.into(),
        runs: String::new(),
        attached: Vec::new(),
    };
    let job = job.beside("plates.csv", plates()).beside("shear.csv", shear());
    let (text, summary) = study(&job);
    assert_contains!(
        text,
        "48 readings in 6 tests of plates",
        "30 readings in 3 tests of rings"
    );
    let estimate = &summary["point_estimates"][0];
    for (name, truth) in [
        // (2e4 / 0.03 + 1e7) 0.01; 2e4 / (1e7 0.03)
        ("log10_p_ref", 5.028_028_7),
        ("kappa", 0.066_667),
        ("n", 1.0),
        ("friction_angle_deg", 30.0),
        ("cohesion_pa", 500.0),
        ("janosi_hanamoto.shear_modulus_m", 0.012),
    ] {
        let (value, sd) = (&estimate["parameters"][name], &estimate["sd"][name]);
        let (value, sd) = (value.as_f64().expect("a value"), sd.as_f64().expect("an sd"));
        assert!(
            (value - truth).abs() < 3.0 * sd,
            "{name} = {value} +- {sd}, not {truth}"
        );
    }
    // The same readings are sampled with every scatter unknown.
    let sampled = job
        .in_job("algorithm = \"lm\"", "particles = 80\nmoves = [3, 6]")
        .in_experiment(
            "[soil.s]",
            "[soil.s]\n[noise]\nplate_scatter = \"unknown\"\nplate_noise = \"unknown\"\nring_scatter = \"unknown\"\nring_noise = \"unknown\"",
        );
    let (text, summary) = study(&sampled);
    assert_contains!(text, "relative sd unknown from test to test");
    let noise = &summary["calibrations"][0]["parameters"]["noise.plate_noise"]["mean"];
    assert!(
        noise.as_f64().is_some_and(|x| (0.005..0.03).contains(&x)),
        "{noise}"
    );
    assert_eq!(summary["calibrations"][0]["error"]["fit"], Value::Null);
}

/// Beside wheel runs the transfer is a free parameter, which a ring that disagrees with the wheel shifts.
#[test]
fn a_ring_beside_wheels_has_a_transfer() {
    let job = Job::small().in_experiment(
        "runs = \"runs.csv\"",
        "runs = \"runs.csv\"\nshear = \"shear.csv\"",
    );
    let csv: String = shear()
        .lines()
        .filter(|line| line.starts_with("test") || line.contains(",0.04,"))
        .map(|line| format!("{line}\n"))
        .collect();
    let (text, summary) = study(&job.beside("shear.csv", csv));
    assert_contains!(text, "3 readings in 3 tests of rings");
    let transfer = &summary["calibrations"][0]["parameters"]["bevameter.ln_transfer"];
    let (mean, sd) = (&transfer["mean"], &transfer["sd"]);
    // tan 27.87 deg is 0.53 on the wheel's side; the rings say tan 30 deg and a cohesion on top.
    assert!(mean.as_f64().is_some_and(|m| m > 0.02), "{transfer}");
    assert!(sd.as_f64().is_some_and(|s| s < 0.1), "{transfer}");
}
