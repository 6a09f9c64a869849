//! Effects without published figures, and the distance slid in skid, compared with the slow integrator.

use crate::brute_force::{Law, NONE, deviation_with};
use crate::support::base;
use crate::validation::effects::{SITE, with_effect};

/// Effect, strength, value, and the equivalent law of the integrator.
const LAWS: [(&str, &str, f64, Law); 5] = [
    ("saturating_pressure", "saturation_per_m", 20.0, SATURATING),
    ("reece_pressure", "mixing_weight", 0.5, REECE),
    (
        "stress_dependent_friction",
        "angle_per_decade_deg",
        2.0,
        STRESS_DEPENDENT,
    ),
    ("janosi_hanamoto", "shear_modulus_m", 0.01, JANOSI_HANAMOTO),
    ("adhesion", "adhesion_pa", 500.0, ADHESION),
];

const SATURATING: Law = Law {
    pressure: |p, z, _, _| p / (1.0 + 20.0 * z),
    ..NONE
};

const REECE: Law = Law {
    pressure: |p, _, k_star, b_eff| p * (1400.0 * 9.81 * b_eff * 500.0 / (k_star * b_eff.powf(1.1))).sqrt(),
    ..NONE
};

const STRESS_DEPENDENT: Law = Law {
    limit: |tau_max, p, phi| {
        let angle = phi + (2.0 * (1e5 / p.max(1e3)).log10()).to_radians();
        tau_max + p * (angle.tan() - phi.tan())
    },
    ..NONE
};

const JANOSI_HANAMOTO: Law = Law {
    shear: |tau, slid| tau * (1.0 - (-slid / 0.01).exp()),
    ..NONE
};

const ADHESION: Law = Law {
    limit: |tau_max, _, _| tau_max + 500.0,
    ..NONE
};

#[test]
fn laws_agree_with_the_brute_force_integrator_in_drive_and_skid() {
    for (name, strength, value, law) in LAWS {
        for slip in [0.3, 0.02, -0.02, -0.3] {
            let case = base(slip, 100.0, 30.0);
            let got = with_effect(&case, name, strength, value, &SITE);
            let deviation = deviation_with(&case, law, &got).expect("support");
            // formulas with max() have kinks, and |v_t| has one where the rim changes from slip to skid
            assert!(
                deviation.iter().all(|d| *d < 1e-4),
                "{name}, {slip}: {deviation:?}"
            );
        }
    }
}

#[test]
fn the_law_of_the_integrator_is_not_idle() {
    let case = base(0.3, 100.0, 30.0);
    let without = case.simulate();
    for (name, _, _, law) in LAWS {
        let deviation = deviation_with(&case, law, &without).expect("support");
        assert!(deviation.iter().any(|d| *d > 1e-3), "{name}: {deviation:?}");
    }
}
