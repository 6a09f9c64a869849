//! Time of one quasi-static run.

use divan::counter::ItemsCount;
use scm::{Condition, Soil, Wheel, quasi_static};

fn main() {
    divan::main();
}

fn wheel() -> Wheel {
    Wheel {
        radius_m: 0.125,
        width_m: 0.112,
        rig_radius_m: 0.125,
    }
}

fn soil() -> Soil {
    Soil {
        k_c: 0.0,
        k_phi: 1e7,
        n: 1.1,
        cohesion_pa: 0.0,
        friction_angle_rad: 30_f64.to_radians(),
        shear_velocity_m_s: 1e-3,
        gamma_exponent: 0.5,
    }
}

fn condition(slip: f64, slip_angle_deg: f64) -> Condition {
    Condition {
        slip,
        wheel_load_n: 100.0,
        sled_speed_m_s: 0.008,
        slip_angle_rad: slip_angle_deg.to_radians(),
        pass: 1,
    }
}

/// Drive at slip 0.2, skid with and without a sign change in the contact, and 30 degrees of slip angle.
#[divan::bench(args = [(0.2, 0.0), (-0.02, 0.0), (-0.5, 0.0), (0.2, 30.0)])]
fn one_run(bencher: divan::Bencher<'_, '_>, (slip, slip_angle_deg): (f64, f64)) {
    let (soil, wheel, condition) = (soil(), wheel(), condition(slip, slip_angle_deg));
    bencher.bench(|| {
        quasi_static::simulate(
            divan::black_box(&soil),
            divan::black_box(&wheel),
            divan::black_box(&condition),
        )
    });
}

/// 1000 parameter vectors from a prior, so that branch prediction cannot learn them.
#[divan::bench(args = ["drive", "skid", "cohesive_skid", "mixed"])]
fn batch_of_1000(bencher: divan::Bencher<'_, '_>, kind: &str) {
    let mut state = 1_u64;
    let mut uniform = |low: f64, high: f64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let runs: Vec<(Soil, Wheel, Condition)> = (0..1000)
        .map(|_| {
            let n = uniform(0.8, 2.0);
            let kappa = if kind == "mixed" { uniform(-0.6, 0.5) } else { 0.0 };
            let (k_c, k_phi) = scm::bekker_moduli(uniform(4.0, 5.6), kappa, n);
            let friction_angle_rad = uniform(11.5, 37.3).to_radians();
            let cohesion_pa = if kind == "cohesive_skid" { 300.0 } else { 0.0 };
            let shear_velocity_m_s = uniform(2e-4, 3e-3);
            let soil = Soil {
                k_c,
                k_phi,
                n,
                friction_angle_rad,
                shear_velocity_m_s,
                cohesion_pa,
                ..soil()
            };
            let slip = match kind {
                "drive" => uniform(0.05, 0.7),
                "skid" | "cohesive_skid" => uniform(-0.6, 0.0),
                _ => uniform(-0.6, 0.7),
            };
            let angle = if kind == "mixed" { uniform(0.0, 30.0) } else { 0.0 };
            let radius_m = uniform(0.125, 0.155);
            (soil, Wheel { radius_m, ..wheel() }, condition(slip, angle))
        })
        .collect();
    bencher.counter(ItemsCount::new(runs.len())).bench(|| {
        runs.iter()
            .filter_map(|(soil, wheel, condition)| quasi_static::simulate(soil, wheel, condition).ok())
            .map(|averages| averages.drawbar_pull_n)
            .sum::<f64>()
    });
}
