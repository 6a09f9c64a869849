//! Noise-free runs of another implementation, with laws that the base lacks: `reference/*.csv`.

use formula::Effect;
use formula::catalogue::find;
use scm::effects::Site;

use crate::support::{base, compiled, law};

/// Noise of the experiments: drawbar pull 1.2 N, torque 0.15 N m, sinkage 0.4 mm.
const NOISE_SD: [f64; 3] = [1.2, 0.15, 4e-4];

/// `k_phi`, n, friction angle `[deg]` and radius `[m]` behind an experiment.
type Truth = [f64; 4];

/// The largest difference from another implementation's runs, in units of the noise, by channel.
fn check(reference: &str, truth: Truth, effect: Option<(&Effect, Vec<f64>)>) {
    let (effect, values): (Option<&Effect>, Vec<_>) =
        effect.map_or((None, vec![]), |(e, v)| (Some(e), vec![v]));
    let effects = compiled(effect);
    let mut active = effects.activate(values);
    let mut worst = [0.0_f64; 3];
    let mut runs = 0;
    for line in reference.lines().filter(|line| !line.starts_with('#')).skip(1) {
        let numbers = line.split(',').map(|field| field.parse().expect("a number"));
        let row: Vec<f64> = numbers.collect();
        let mut case = base(row[0], row[1], truth[2]);
        (case.soil.k_phi, case.soil.n, case.wheel.radius_m) = (truth[0], truth[1], truth[3]);
        case.condition.sled_speed_m_s = row[2];
        let got = case
            .simulate_with(&mut active, &Site::default())
            .expect("support");
        let channels = [got.drawbar_pull_n, got.torque_n_m, got.sinkage_m];
        for (i, value) in channels.into_iter().enumerate() {
            let difference = (value - row[3 + i]).abs() / NOISE_SD[i];
            assert!(difference < 0.05, "channel {i} off by {difference} sd in {line}");
            worst[i] = worst[i].max(difference);
        }
        runs += 1;
    }
    assert_eq!(runs, 40);
    println!("largest difference in noise sd (F, T, z): {worst:?}");
}

#[test]
fn nothing_hidden_is_reproduced() {
    let (k_phi, n) = (6_241_438.514_219_137, 1.118_141_989_959_437_8);
    let truth = [k_phi, n, 27.871_432_958_177_856, 0.128_511_684_385_944_04];
    check(include_str!("../reference/nothing_hidden.csv"), truth, None);
}

#[test]
fn shear_mobilisation_is_reproduced() {
    let (k_phi, n) = (7_499_271.784_033_135, 1.114_937_276_875_423_5);
    let truth = [k_phi, n, 29.725_862_144_637_787, 0.129_152_900_659_868_29];
    let effect = (find("janosi_hanamoto").unwrap(), vec![0.01]);
    check(
        include_str!("../reference/shear_mobilisation.csv"),
        truth,
        Some(effect),
    );
}

#[test]
fn a_law_outside_the_catalogue_is_reproduced() {
    let (k_phi, n) = (7_209_486.480_966_817, 1.001_560_169_645_988);
    let truth = [k_phi, n, 26.748_561_584_503_463, 0.132_403_959_773_935_04];
    let law = law("shear = \"if(slip > 0.3, 0.8 * tau, tau)\"");
    let runs = include_str!("../reference/outside_the_catalogue.csv");
    check(runs, truth, Some((&law, vec![])));
}

#[test]
fn a_law_that_jumps_within_the_contact_is_reproduced() {
    let (k_phi, n) = (8_570_204.410_774_18, 1.066_063_084_089_199);
    let truth = [k_phi, n, 30.636_840_746_130_21, 0.134_399_645_778_520_2];
    let law = law("pressure = \"if(position > 0.5, 1.8 * p, p)\"");
    check(
        include_str!("../reference/undetectable.csv"),
        truth,
        Some((&law, vec![])),
    );
}
