//! Shear stress of a soil against a sliding surface.

/// Returns the strength of a soil under a normal pressure (Mohr–Coulomb).
///
/// `tau_max = c + p tan(phi)`
///
/// # Arguments
/// - `cohesion`: c `[Pa]`, ≥ 0. `tan_friction_angle`: tan(phi) `[–]`, ≥ 0. `pressure`: p `[Pa]`, ≥ 0.
///
/// # Returns
/// The largest shear stress `[Pa]`.
#[inline]
pub fn strength(cohesion: f64, tan_friction_angle: f64, pressure: f64) -> f64 {
    cohesion + pressure * tan_friction_angle
}

/// The shear-velocity law: the share of the strength that a slip velocity mobilises.
///
/// `tau = tau_max (1 − exp(−|v| / v0))` against the slip velocity v.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearVelocity {
    per_velocity: f64,
}

impl ShearVelocity {
    /// Returns the law with reference velocity v0 `[m/s]`, ≥ 0; with v0 = 0 any motion mobilises the whole strength.
    pub fn new(reference_velocity: f64) -> Self {
        // 1/0 would give 0 · ∞ for a point at rest; the largest number gives 0 there and ∞ elsewhere.
        Self {
            per_velocity: (1.0 / reference_velocity).min(f64::MAX),
        }
    }

    /// Returns the mobilised share of the strength per unit of slip velocity.
    ///
    /// `(1 − exp(−|v| / v0)) / |v|`: multiplied by `tau_max` and by a component of the velocity of the rim
    /// against the soil it gives that component of the shear stress. At |v| = 0 the components are zero.
    ///
    /// # Arguments
    /// - `speed`: |v| `[m/s]`, ≥ 0.
    ///
    /// # Returns
    /// `[s/m]`, ≥ 0 and finite.
    ///
    /// # Source
    /// Krenn & Hirzinger 2009, see [Literature](crate#literature). Depends on speed, unlike a displacement law.
    #[inline]
    pub fn mobilised_per_velocity(&self, speed: f64) -> f64 {
        let share = self.mobilised_in_motion(speed);
        share
            / if speed > f64::MIN_POSITIVE {
                speed
            } else {
                f64::MIN_POSITIVE
            }
    }

    /// Returns the mobilised share of the strength at a speed `[m/s]`: `1 − exp(−|v| / v0)`, and 0 at rest.
    #[inline]
    pub fn mobilised(&self, speed: f64) -> f64 {
        let share = self.mobilised_in_motion(speed);
        if speed > f64::MIN_POSITIVE { share } else { 0.0 }
    }

    #[inline]
    fn mobilised_in_motion(&self, speed: f64) -> f64 {
        // with v0 = 0 no exponential is needed; the branch is the same for every point of a loop
        if self.per_velocity < f64::MAX {
            1.0 - crate::elementary::exp(-speed * self.per_velocity)
        } else {
            1.0
        }
    }
}

/// The shear-displacement law: the share of the strength that a displacement along the surface mobilises.
///
/// `tau = tau_max (1 − exp(−j / K))` after the displacement j.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearDisplacement {
    per_displacement: f64,
}

impl ShearDisplacement {
    /// Returns the law with shear modulus K `[m]`, ≥ 0; with K = 0 any displacement mobilises the whole strength.
    pub fn new(modulus_m: f64) -> Self {
        // 0 · ∞ at zero displacement would be NaN, as for the velocity law
        Self {
            per_displacement: (1.0 / modulus_m).min(f64::MAX),
        }
    }

    /// Returns the mobilised share of the strength.
    ///
    /// `1 − exp(−j / K)`, one exponential.
    ///
    /// # Arguments
    /// - `displacement_m`: j `[m]`, ≥ 0.
    ///
    /// # Returns
    /// `[–]`, in [0, 1]; exactly 0 at j = 0, also with K = 0.
    ///
    /// # Validity
    /// Monotonic shearing: j is the total displacement since the surface touched the soil.
    ///
    /// # Source
    /// Janosi & Hanamoto 1961, see [Literature](crate#literature). Checked by this file's tests and `bevameter::strength_is_reached_by_way`.
    #[inline]
    pub fn mobilised(&self, displacement_m: f64) -> f64 {
        1.0 - crate::elementary::exp(-displacement_m * self.per_displacement)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stress_follows_the_velocity_law() {
        // 1 − 1/e of the strength at |v| = v0
        let law = ShearVelocity::new(1e-3);
        assert!((law.mobilised_per_velocity(1e-3) * 1e-3 - 0.632_120_558_828_557_7).abs() < 1e-15);
    }

    #[test]
    fn zero_reference_velocity_mobilises_everything_but_at_rest() {
        let law = ShearVelocity::new(0.0);
        assert!((law.mobilised_per_velocity(1e-9) * 1e-9 - 1.0).abs() < 1e-15);
        assert!((law.mobilised_per_velocity(0.0) * 0.0).abs() < f64::MIN_POSITIVE);
        assert!((law.mobilised(1e-9) - 1.0).abs() < f64::MIN_POSITIVE);
        assert!(law.mobilised(0.0).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn stress_follows_the_displacement_law() {
        // 1 − 1/e of the strength at j = K
        let law = ShearDisplacement::new(8e-3);
        assert!((law.mobilised(8e-3) - 0.632_120_558_828_557_7).abs() < 1e-15);
        assert!(law.mobilised(0.0).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn zero_modulus_mobilises_everything_but_before_any_displacement() {
        let law = ShearDisplacement::new(0.0);
        assert!((law.mobilised(1e-12) - 1.0).abs() < 1e-15);
        assert!(law.mobilised(0.0).abs() < f64::MIN_POSITIVE);
    }
}
