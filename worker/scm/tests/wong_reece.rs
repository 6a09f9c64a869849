//! The stresses of Wong & Reece, compared with a slow integration in the angle that shares no code with the model: `std`
//! functions, midpoints, bisection.

use scm::effects::{Active, Site};
use scm::{Averages, Rejection, WongReece, quasi_static};

use crate::support::{Case, base};

const STEPS: u32 = 20_000;

fn simulate(case: &Case, law: &WongReece) -> Result<Averages, Rejection> {
    let (mut none, site) = (Active::default(), Site::default());
    quasi_static::simulate_wong_reece(&case.soil, &case.wheel, &case.condition, law, &mut none, &site)
}

/// Returns the law of this peak with a shear modulus `[m]`.
fn law(c1: f64, c2: f64, shear_modulus_m: f64) -> WongReece {
    WongReece {
        c1,
        c2,
        shear_modulus_m,
    }
}

/// The published model: gamma and the factor of the slip velocity are 1.
fn published(slip: f64, wheel_load_n: f64) -> Case {
    let mut case = base(slip, wheel_load_n, 30.0);
    (case.soil.gamma_exponent, case.soil.shear_velocity_m_s) = (0.0, 0.0);
    case
}

/// Load, drawbar pull and torque at a sinkage.
fn forces(case: &Case, law: &WongReece, sinkage: f64, steps: u32) -> [f64; 3] {
    let (soil, wheel, condition) = (&case.soil, &case.wheel, &case.condition);
    let (r, b, v) = (wheel.radius_m, wheel.width_m, condition.sled_speed_m_s);
    let entry = (1.0 - sinkage / r).acos();
    let peak = (law.c1 + law.c2 * condition.slip) * entry;
    let length = r * entry.sin();
    let k_star = soil.k_c * (length + b) / (length * b) + soil.k_phi;
    let step = entry / f64::from(steps);
    let mut total = [0.0; 3];
    for i in 0..steps {
        let angle = (f64::from(i) + 0.5) * step;
        let counts = if angle >= peak {
            angle
        } else {
            entry - angle / peak * (entry - peak)
        };
        let p = k_star * (r * (counts.cos() - entry.cos())).powf(soil.n);
        // dj = |omega R − v cos| dt, dt = d(angle)/omega; sliding in one direction
        let slid = r * (entry - angle) - v / case.omega() * (entry.sin() - angle.sin());
        let share = 1.0 - (-slid.abs() / law.shear_modulus_m).exp();
        let slides = (case.omega() * r - v * angle.cos()).signum();
        let tau = slides * share * (soil.cohesion_pa + p * soil.friction_angle_rad.tan());
        let area = r * b * step;
        total[0] += (p * angle.cos() + tau * angle.sin()) * area;
        total[1] += (tau * angle.cos() - p * angle.sin()) * area;
        total[2] += tau * r * area;
    }
    total
}

/// Sinkage by bisection; the load of a driven wheel rises with depth.
fn sinkage(case: &Case, law: &WongReece) -> f64 {
    let (mut low, mut high) = (0.0, 0.9 * case.wheel.radius_m);
    for _ in 0..44 {
        let middle = 0.5 * (low + high);
        match forces(case, law, middle, STEPS)[0] < case.condition.wheel_load_n {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

#[test]
fn driven_wheels_agree_with_an_independent_integration() {
    let mut worst = [0.0_f64; 3];
    for law in [
        law(0.4, 0.0, 0.01),
        law(0.43, 0.32, 0.02),
        law(0.18, 0.32, 0.005),
        law(0.0, 0.3, 0.01),
    ] {
        let runs = [
            (0.05, 60.0, 0.0, 0.0),
            (0.2, 150.0, 200.0, 2e4),
            (0.6, 100.0, 0.0, -1e4),
        ];
        for (slip, load, cohesion, k_c) in runs {
            let mut case = published(slip, load);
            (case.soil.cohesion_pa, case.soil.k_c) = (cohesion, k_c);
            let got = simulate(&case, &law).unwrap();
            let depth = sinkage(&case, &law);
            let [_, pull, torque] = forces(&case, &law, depth, STEPS);
            let deviations = [
                (got.sinkage_m / depth - 1.0).abs(),
                (got.drawbar_pull_n - pull).abs() / load,
                (got.torque_n_m - torque).abs() / (load * case.wheel.radius_m),
            ];
            for (largest, deviations) in worst.iter_mut().zip(deviations) {
                *largest = largest.max(deviations);
            }
        }
    }
    println!("largest deviation (dz/z, F/W, T/(W R)): {worst:?}");
    assert!(worst.iter().all(|&deviation| deviation < 1e-5), "{worst:?}");
}

#[test]
fn a_peak_farther_ahead_sinks_the_wheel_and_costs_pull() {
    let case = published(0.2, 150.0);
    let [low, middle, high] = [0.1, 0.3, 0.5].map(|c1| simulate(&case, &law(c1, 0.0, 0.01)).unwrap());
    assert!(low.sinkage_m < middle.sinkage_m && middle.sinkage_m < high.sinkage_m);
    assert!(low.drawbar_pull_n > middle.drawbar_pull_n && middle.drawbar_pull_n > high.drawbar_pull_n);
}

#[test]
fn skid_has_a_balance_and_the_line_of_the_peak_ends_where_it_leaves_the_contact() {
    let law = law(0.4, 0.3, 0.01);
    let skid = simulate(&published(-0.3, 100.0), &law).unwrap();
    assert!(skid.drawbar_pull_n < 0.0 && skid.residual_load_n.abs() < 1e-6);
    let steep = WongReece { c2: 1.0, ..law };
    let refused = simulate(&published(-0.5, 100.0), &steep).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "invalid parameter: c1 + c2 slip = -0.09999999999999998 (dimensionless) must be at least 0 and below 1"
    );
}

#[test]
fn a_sideways_wheel_is_resisted() {
    let law = law(0.4, 0.3, 0.01);
    let mut case = published(0.2, 100.0);
    let straight = simulate(&case, &law).unwrap();
    case.condition.slip_angle_rad = 0.3;
    let sideways = simulate(&case, &law).unwrap();
    assert!(straight.lateral_force_n.abs() < 1e-12 && sideways.lateral_force_n > 5.0);
    assert!(sideways.drawbar_pull_n < straight.drawbar_pull_n);
}
