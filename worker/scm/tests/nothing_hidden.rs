//! Noise-free runs of another implementation, `reference/nothing_hidden.csv`.

use crate::support::{Case, base};
use scm::quasi_static;

const REFERENCE: &str = include_str!("reference/nothing_hidden.csv");
/// Noise of the experiment: drawbar pull 1.2 N, torque 0.15 N m, sinkage 0.4 mm.
const NOISE_SD: [f64; 3] = [1.2, 0.15, 4e-4];

fn case(slip: f64, wheel_load_n: f64, sled_speed_m_s: f64) -> Case {
    let mut case = base(slip, wheel_load_n, 27.871_432_958_177_856);
    case.soil.k_phi = 6_241_438.514_219_137;
    case.soil.n = 1.118_141_989_959_437_8;
    case.wheel.radius_m = 0.128_511_684_385_944_04;
    case.condition.sled_speed_m_s = sled_speed_m_s;
    case
}

#[test]
fn another_implementation_is_reproduced_within_a_twentieth_of_the_noise() {
    let mut worst = [0.0_f64; 3];
    let mut runs = 0;
    for line in REFERENCE.lines().filter(|line| !line.starts_with('#')).skip(1) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let case = case(row[0], row[1], row[2]);
        let got = quasi_static::simulate(&case.soil, &case.wheel, &case.condition).unwrap();
        for (i, value) in [got.drawbar_pull_n, got.torque_n_m, got.sinkage_m]
            .into_iter()
            .enumerate()
        {
            let difference = (value - row[3 + i]).abs() / NOISE_SD[i];
            assert!(difference < 0.05, "channel {i} off by {difference} sd in {line}");
            worst[i] = worst[i].max(difference);
        }
        runs += 1;
    }
    assert_eq!(runs, 40);
    println!("largest difference in noise sd (F, T, z): {worst:?}");
}
