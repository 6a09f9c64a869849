//! The soil, the wheel and the condition of unit tests, and pseudo-random numbers.

use crate::{Condition, Soil, Wheel};

/// Cohesionless sand of 0.5 rad.
pub(crate) const SOIL: Soil = Soil {
    k_c: 0.0,
    k_phi: 1e7,
    n: 1.1,
    cohesion_pa: 0.0,
    friction_angle_rad: 0.5,
    shear_velocity_m_s: 1e-3,
    gamma_exponent: 0.5,
};

/// A wheel of 125 mm by 112 mm.
pub(crate) const WHEEL: Wheel = Wheel {
    radius_m: 0.125,
    width_m: 0.112,
    rig_radius_m: 0.125,
};

/// 100 N at slip 0.2, straight ahead.
pub(crate) const CONDITION: Condition = Condition {
    slip: 0.2,
    wheel_load_n: 100.0,
    sled_speed_m_s: 0.01,
    slip_angle_rad: 0.0,
    pass: 1,
};

/// A linear congruential generator (Knuth's MMIX constants).
pub(crate) struct Draws(pub(crate) u64);

impl Draws {
    /// Draws a uniform number.
    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        let multiplied = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = multiplied.wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Draws a nearly normal number: the sum of twelve uniform numbers.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform(-0.5, 0.5)).sum()
    }
}
