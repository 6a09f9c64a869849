//! The soil, the wheel and the condition of this module's tests.

use super::{Ground, Scene, Shape};
use crate::effects::{Active, Site};
use crate::{Condition, Soil, Wheel};

/// Cohesionless sand of 0.5 rad.
pub(super) const SOIL: Soil = Soil {
    k_c: 0.0,
    k_phi: 1e7,
    n: 1.1,
    cohesion_pa: 0.0,
    friction_angle_rad: 0.5,
    shear_velocity_m_s: 1e-3,
    gamma_exponent: 0.5,
};

/// A wheel of 125 mm by 112 mm.
pub(super) const WHEEL: Wheel = Wheel {
    radius_m: 0.125,
    width_m: 0.112,
    rig_radius_m: 0.125,
};

/// 100 N at slip 0.2, straight ahead.
pub(super) const CONDITION: Condition = Condition {
    slip: 0.2,
    wheel_load_n: 100.0,
    sled_speed_m_s: 0.01,
    slip_angle_rad: 0.0,
    pass: 1,
};

/// The soil and the wheel with the rest of a scene.
pub(super) fn scene<'a>(ground: &'a Ground, shape: &'a Shape, effects: &'a Active<'a>) -> Scene<'a> {
    Scene {
        soil: &SOIL,
        ground,
        wheel: &WHEEL,
        shape,
        effects,
        site: Site::default(),
    }
}
