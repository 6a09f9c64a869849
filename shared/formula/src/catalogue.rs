//! The effects that come with the program.

use std::sync::LazyLock;

use crate::effect::Effect;

/// The files, in the order in which effects follow each other at a hook: pressure, shear strength and its mobilisation,
/// wheel and rig, and last the errors of the instruments, offsets after gains.
const FILES: [&str; 52] = [
    include_str!("../catalogue/pressure_distribution_shape.toml"),
    include_str!("../catalogue/peak_pressure_angle.toml"),
    include_str!("../catalogue/slip_sinkage.toml"),
    include_str!("../catalogue/skid_sinkage.toml"),
    include_str!("../catalogue/lateral_slip_sinkage.toml"),
    include_str!("../catalogue/slip_digging.toml"),
    include_str!("../catalogue/rate_dependent_pressure.toml"),
    include_str!("../catalogue/multipass_hardening.toml"),
    include_str!("../catalogue/hard_pan.toml"),
    include_str!("../catalogue/density_gradient.toml"),
    include_str!("../catalogue/saturating_pressure.toml"),
    include_str!("../catalogue/reece_pressure.toml"),
    include_str!("../catalogue/small_diameter.toml"),
    include_str!("../catalogue/gravity_scaling.toml"),
    include_str!("../catalogue/slip_softened_pressure.toml"),
    include_str!("../catalogue/end_wall.toml"),
    include_str!("../catalogue/moisture.toml"),
    include_str!("../catalogue/drift_stiffness.toml"),
    include_str!("../catalogue/adhesion.toml"),
    include_str!("../catalogue/interface_friction.toml"),
    include_str!("../catalogue/stress_dependent_friction.toml"),
    include_str!("../catalogue/friction_rate_weakening.toml"),
    include_str!("../catalogue/side_wall_friction.toml"),
    include_str!("../catalogue/shear_velocity_scale.toml"),
    include_str!("../catalogue/janosi_hanamoto.toml"),
    include_str!("../catalogue/stretched_mobilisation.toml"),
    include_str!("../catalogue/stick_slip.toml"),
    include_str!("../catalogue/elastic_rebound.toml"),
    include_str!("../catalogue/wheel_flexibility.toml"),
    include_str!("../catalogue/wheel_radius_error.toml"),
    include_str!("../catalogue/wheel_width_error.toml"),
    include_str!("../catalogue/edge_loss.toml"),
    include_str!("../catalogue/slip_radius_error.toml"),
    include_str!("../catalogue/load_scale.toml"),
    include_str!("../catalogue/load_transfer.toml"),
    include_str!("../catalogue/lug_thrust.toml"),
    include_str!("../catalogue/bulldozing.toml"),
    include_str!("../catalogue/side_bulldozing.toml"),
    include_str!("../catalogue/side_drag.toml"),
    include_str!("../catalogue/buried_side_wall.toml"),
    include_str!("../catalogue/bin_slope.toml"),
    include_str!("../catalogue/sled_tare.toml"),
    include_str!("../catalogue/sled_drag.toml"),
    include_str!("../catalogue/bearing_torque.toml"),
    include_str!("../catalogue/bearing_friction.toml"),
    include_str!("../catalogue/drawbar_pull_gain.toml"),
    include_str!("../catalogue/torque_gain.toml"),
    include_str!("../catalogue/sinkage_offset.toml"),
    include_str!("../catalogue/drift_drawbar_pull_zero.toml"),
    include_str!("../catalogue/drift_torque_zero.toml"),
    include_str!("../catalogue/drift_sinkage_zero.toml"),
    include_str!("../catalogue/drift_lateral_force_zero.toml"),
];

static CATALOGUE: LazyLock<Vec<Effect>> = LazyLock::new(|| {
    let read = |text: &&str| Effect::read(text).expect("the catalogue's files are read by its tests");
    FILES.iter().map(read).collect()
});

/// Returns every effect of the catalogue, in the order in which effects follow each other at a hook.
pub fn catalogue() -> &'static [Effect] {
    &CATALOGUE
}

/// Returns an effect of the catalogue by name.
pub fn find(name: &str) -> Option<&'static Effect> {
    catalogue().iter().find(|effect| effect.name == name)
}
