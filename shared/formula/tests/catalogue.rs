//! The catalogue's files.

use std::collections::BTreeSet;

use formula::catalogue::catalogue;

/// The names of the effects, as results and jobs have them.
const NAMES: &str = "janosi_hanamoto shear_velocity_scale interface_friction adhesion rate_dependent_pressure \
    elastic_rebound multipass_hardening slip_sinkage slip_digging bulldozing buried_side_wall lug_thrust wheel_flexibility hard_pan \
    density_gradient side_wall_friction sled_tare sled_drag drawbar_pull_gain torque_gain sinkage_offset load_transfer \
    load_scale bearing_torque bearing_friction bin_slope end_wall peak_pressure_angle pressure_distribution_shape edge_loss \
    small_diameter reece_pressure saturating_pressure moisture friction_rate_weakening stick_slip slip_radius_error \
    stress_dependent_friction gravity_scaling slip_softened_pressure drift_stiffness drift_drawbar_pull_zero drift_torque_zero \
    drift_sinkage_zero drift_lateral_force_zero skid_sinkage lateral_slip_sinkage stretched_mobilisation side_bulldozing side_drag \
    wheel_radius_error wheel_width_error";

#[test]
fn every_effect_is_there_once_under_its_name() {
    let expected: BTreeSet<&str> = NAMES.split_whitespace().collect();
    let names: BTreeSet<&str> = catalogue().iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, expected);
    assert_eq!(catalogue().len(), 52);
}

#[test]
fn every_strength_has_a_typical_value_that_is_not_neutral() {
    for effect in catalogue() {
        assert!(
            !effect.summary.is_empty() && !effect.source.is_empty(),
            "{}",
            effect.name
        );
        let strengths: Vec<_> = effect.parameters.iter().filter(|p| p.neutral.is_some()).collect();
        assert!(!strengths.is_empty(), "{} has no strength", effect.name);
        for strength in strengths {
            assert!(
                strength.typical.is_some() && strength.typical != strength.neutral,
                "{}.{}",
                effect.name,
                strength.name
            );
        }
    }
}
