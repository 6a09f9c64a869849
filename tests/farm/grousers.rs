//! Grousers that the quasi-static model rolls, from the key of the job to the likelihoods of the draws.

use std::f64::consts::TAU;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use scm::effects::{Active, Site};
use scm::quasi_static::{StraightGrousers, simulate_with_grousers};
use scm::{Averages, Condition, Soil, Wheel, bekker_moduli};

const GROUSERS: StraightGrousers = StraightGrousers {
    count: 12,
    height_m: 0.009,
    thickness_m: 0.002,
};

const SMOOTH: StraightGrousers = StraightGrousers { count: 0, ..GROUSERS };

/// Returns the small job with a wheel of the bare radius that has these grousers, and a value of the key.
fn job(key: &str) -> Job {
    Job::small()
        .in_experiment(
            "grouser_count = 0",
            "grouser_count = 12\ngrouser_height_m = 0.009\ngrouser_thickness_m = 0.002",
        )
        .in_job("wheel_radius_m = { uniform = [0.125, 0.155] }\n", "")
        .in_job(
            "kind = \"quasi_static\"",
            &format!("kind = \"quasi_static\"\n{key}"),
        )
        .sampler(30, [1, 2], 1)
}

/// Returns the rows of a CSV text by their columns' names.
fn rows(csv: &str) -> Vec<impl Fn(&str) -> Option<f64> + use<>> {
    let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<String> = lines
        .next()
        .unwrap_or_default()
        .split(',')
        .map(str::to_owned)
        .collect();
    let row = |line: &str| {
        let (header, cells): (Vec<String>, Vec<String>) =
            (header.clone(), line.split(',').map(str::to_owned).collect());
        move |name: &str| {
            let column = header
                .iter()
                .position(|h| h == name)
                .unwrap_or_else(|| panic!("no column {name}"));
            cells[column].parse().ok()
        }
    };
    lines.map(row).collect()
}

/// Returns the log-likelihood of a draw, computed with the crate of the physics.
fn log_likelihood(draw: &impl Fn(&str) -> Option<f64>, grousers: &StraightGrousers) -> f64 {
    let value = |name: &str| draw(name).expect("a number");
    let (k_c, k_phi) = bekker_moduli(value("log10_p_ref"), 0.0, value("n"));
    let soil = Soil {
        k_c,
        k_phi,
        n: value("n"),
        cohesion_pa: 0.0,
        friction_angle_rad: value("friction_angle_deg").to_radians(),
        shear_velocity_m_s: 0.001,
        gamma_exponent: 0.5,
    };
    let wheel = Wheel {
        radius_m: 0.125,
        width_m: 0.112,
        rig_radius_m: 0.125,
    };
    let runs = Job::small().runs;
    let fitted: String = runs
        .lines()
        .filter(|line| !line.ends_with(",holdout"))
        .map(|line| format!("{line}\n"))
        .collect();
    let mut sum = 0.0;
    for run in rows(&fitted) {
        let given = |name: &str| run(name).expect("a number");
        let condition = Condition {
            slip: given("slip"),
            wheel_load_n: given("wheel_load_n"),
            sled_speed_m_s: given("sled_speed_m_s"),
            slip_angle_rad: given("slip_angle_deg").to_radians(),
            pass: 1,
        };
        let (mut none, site) = (Active::default(), Site::default());
        let averages: Averages =
            simulate_with_grousers(&soil, &wheel, grousers, &condition, &mut none, &site).expect("a balance");
        for (channel, sd, simulated) in [
            ("drawbar_pull_n", 1.2, averages.drawbar_pull_n),
            ("torque_n_m", 0.15, averages.torque_n_m),
            ("sinkage_m", 4e-4, averages.sinkage_m),
        ] {
            let Some(measured) = run(channel) else { continue };
            let off = (measured - simulated) / sd;
            sum -= 0.5 * off * off + (sd * TAU.sqrt()).ln();
        }
    }
    sum
}

#[test]
fn a_farm_rolls_grousers_as_the_physics_does_when_a_job_says_so() {
    for (key, used, other) in [
        ("grousers = \"rolled\"", GROUSERS, SMOOTH),
        ("grousers = \"ignored\"", SMOOTH, GROUSERS),
    ] {
        let service = Service::start(&[]);
        let id = service.submit(&job(key));
        let _worker = service.worker("worker", 1);
        service.wait_for(id, "finished");
        let draws = rows(&service.posterior_csv(id));
        assert_eq!(draws.len(), 30);
        for draw in &draws {
            let got = draw("log_likelihood").expect("a number");
            let expected = log_likelihood(draw, &used);
            assert!(
                (got - expected).abs() < 1e-6 * expected.abs(),
                "{key}: {got} {expected}"
            );
            let there = log_likelihood(draw, &other);
            assert!((got - there).abs() > 10.0, "{key}: {got} {there}");
        }
    }
}

#[test]
fn what_does_not_roll_is_refused_before_anything_is_simulated() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |job: Job| {
        let path = job.write(folder.path());
        run(coordinator(["check".as_ref(), path.as_os_str()])).refusal()
    };
    let rolled = || job("grousers = \"rolled\"");
    let stated = "grouser_height_m = 0.009";
    for (job, message) in [
        (
            rolled().in_experiment(stated, "grouser_height_m = 0.009\ngrouser_angle_deg = 20.0"),
            "grousers = \"rolled\": wheel w: its grousers are not straight bars",
        ),
        (
            rolled().in_experiment(stated, "grouser_height_m = 0.13"),
            "grousers = \"rolled\": wheel w: grouser_height_m 0.13 m must be > 0 m and <= radius_m = 0.125 m",
        ),
        (
            rolled().in_job("[priors]", "effects = [\"elastic_rebound\"]\n[priors]"),
            "grousers = \"rolled\": effect elastic_rebound is soil that springs back",
        ),
        (
            job("grousers = \"on\""),
            "grousers = \"on\" must be \"ignored\" or \"rolled\"",
        ),
    ] {
        let error = refused(job);
        assert_contains!(error, message);
    }
}
