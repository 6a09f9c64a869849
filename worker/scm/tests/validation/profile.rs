//! Independent integration of the pressure along a smooth wheel: Bekker in front of the axle, unloading behind it.

use crate::scene::Track;

/// Number of points of the midpoint rule on either side of the axle; the pressure vanishes at its ends with powers above 1,
/// so that the error is below 1e-7.
const POINTS: u32 = 4000;

/// Pressure along the contact if it is uniform across the wheel (exponent of the distribution 0).
///
/// In front `p = k z(x)^n`; behind, the soil rises along its elastic line: `p = p_0 − K_e (h(x) − h(0))`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Profile {
    radius: f64,
    width: f64,
    modulus: f64,
    exponent: f64,
    elastic: f64,
    pub(super) sinkage: f64,
}

impl Profile {
    /// Returns the profile whose pressure alone carries the load: no friction, or shear that acts horizontally.
    pub(super) fn in_balance(track: &Track) -> Self {
        let case = &track.case;
        let mut profile = Self {
            radius: case.wheel.radius_m,
            width: case.wheel.width_m,
            modulus: case.soil.k_phi,
            exponent: case.soil.n,
            elastic: track.ground.elastic_stiffness_pa_m,
            sinkage: 0.0,
        };
        let (mut low, mut high) = (0.0, profile.radius);
        for _ in 0..60 {
            profile.sinkage = 0.5 * (low + high);
            let carried = profile.sum(|_, force| force);
            if carried < case.condition.wheel_load_n {
                low = profile.sinkage;
            } else {
                high = profile.sinkage;
            }
        }
        profile
    }

    /// Height of the rim above its lowest point `[m]`.
    fn height(&self, x: f64) -> f64 {
        self.radius - (self.radius * self.radius - x * x).sqrt()
    }

    /// Pressure under the axle `[Pa]`.
    fn max_pressure(&self) -> f64 {
        self.modulus * self.sinkage.powf(self.exponent)
    }

    /// End of the contact when the rim is at a height `[m]`.
    fn end(&self, height: f64) -> f64 {
        (self.radius * self.radius - (self.radius - height).powi(2)).sqrt()
    }

    /// Sum, from the front to the rear, over pieces of the contact: place `[m]` and force of the pressure `[N]`.
    pub(super) fn sum(&self, mut piece: impl FnMut(f64, f64) -> f64) -> f64 {
        let (front, rear) = (
            self.end(self.sinkage),
            self.end(self.max_pressure() / self.elastic),
        );
        let mut total = 0.0;
        let share = |i: u32| (f64::from(i) + 0.5) / f64::from(POINTS);
        for i in 0..POINTS {
            let x = front * (1.0 - share(i));
            let p = self.modulus * (self.sinkage - self.height(x)).powf(self.exponent);
            total += piece(x, p * self.width * front / f64::from(POINTS));
        }
        for i in 0..POINTS {
            let x = -rear * share(i);
            let p = self.max_pressure() - self.elastic * self.height(x);
            total += piece(x, p * self.width * rear / f64::from(POINTS));
        }
        total
    }

    /// Compaction resistance: the work of pressing less the recovered work, per length of the track `[N]`.
    pub(super) fn resistance(&self) -> f64 {
        let pressed = self.modulus * self.sinkage.powf(self.exponent + 1.0) / (self.exponent + 1.0);
        let given_back = self.max_pressure() * self.max_pressure() / (2.0 * self.elastic);
        self.width * (pressed - given_back)
    }

    /// Length of a piece `[m]` at a place: pieces in front and behind differ.
    pub(super) fn piece(&self, x: f64) -> f64 {
        let end = if x > 0.0 {
            self.end(self.sinkage)
        } else {
            self.end(self.max_pressure() / self.elastic)
        };
        end / f64::from(POINTS)
    }
}
